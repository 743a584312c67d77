//! `windfall calibrate`: arguments.

use crate::args::figures::FigureArguments;
use crate::args::format::Format;
use clap::{Args, ValueHint};
use std::path::PathBuf;

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
    #[arg(value_name = "DIR", value_hint = ValueHint::DirPath)]
    pub directory: PathBuf,
    /// Ways to calibrate in place of the campaign's; may be repeated
    #[arg(long = "way", value_parser = ["waveform", "features", "design"], value_name = "WAY")]
    pub ways: Vec<String>,
    /// The fitted waveforms, the family of equally good laws and the surfaces
    #[command(flatten)]
    pub drawn: FigureArguments,
    /// Write all tables as CSV and text into this directory
    #[arg(long, value_name = "DIR", value_hint = ValueHint::DirPath)]
    pub tables: Option<PathBuf>,
    /// Write the calibrated law as a law card
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub card: Option<PathBuf>,
    /// Intervals from the profile of the sum of squares, which takes longer, in place of ±1.96 sd
    #[arg(long)]
    pub profile: bool,
    /// Threads; all cores if left out
    #[arg(long, value_name = "N")]
    pub threads: Option<usize>,
    /// Form of the result
    #[arg(long, value_enum, default_value_t = Format::Text)]
    pub format: Format,
}
