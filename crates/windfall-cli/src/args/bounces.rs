//! `windfall bounces`: arguments.

use crate::args::format::Shown;
use clap::Args;
use windfall_drop::intervals::request::BouncesRequest;

/// `windfall bounces`
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  windfall bounces --intervals '0.547, 0.412, 0.314, 0.245 s'
  windfall bounces drops.csv --resolution '21 us'
      a drop in each row: columns drop, drop_height_cm, t1_s, t2_s, t3_s
  windfall bounces stopwatch/*.csv --each-column
      exports of a phone's acoustic stopwatch: a column \"Interval (s)\" in each
  windfall bounces drops.csv --format csv > impacts.csv
      every impact with its speed, for `windfall regress` and `windfall compare`

Intervals are from impact to impact. A blank cell is an impact that was not noticed: \
restitution is not taken across it.")]
pub struct BouncesArguments {
    #[command(flatten)]
    pub request: BouncesRequest,
    #[command(flatten)]
    pub shown: Shown,
}
