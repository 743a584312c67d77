//! `windfall calibrate`: arguments.

use crate::args::format::Shown;
use clap::{Args, ValueHint};
use std::path::PathBuf;
use windfall_drop::calibrate::run::CalibrateRequest;

/// `windfall calibrate`
#[derive(Debug, Args)]
#[command(
    after_help = "Works on a campaign of kind \"drop\" (`windfall new drop DIR`). The law and its \
free parameters stand in campaign.toml under [fit], ranges and targets under [calibrate]. Peaks and \
intervals that someone has read off already may stand in impacts.csv: peak_force_1_N, interval_1_ms, \
peak_force_2_N … (their uncertainties: peak_force_1_sd_N …).

Results go to standard output and to DIR/results.sqlite.

Examples:
  windfall calibrate my-drops
  windfall calibrate my-drops --way features --format json
  windfall calibrate my-drops --way design --tables tables --figures figures
      central composite design, surfaces, desirability optimum, verification
  windfall calibrate my-drops --way waveform --card law.toml
      the law with its uncertainty in one file: `windfall card show --file law.toml`"
)]
pub struct CalibrateArguments {
    /// The campaign directory
    #[arg(default_value = ".", value_name = "DIR", value_hint = ValueHint::DirPath)]
    pub directory: PathBuf,
    #[command(flatten)]
    pub request: CalibrateRequest,
    #[command(flatten)]
    pub shown: Shown,
}
