//! `windfall fit`: arguments.

use crate::args::format::Format;
use clap::{Args, ValueHint};
use std::path::PathBuf;
use windfall_campaign::impacts::shard::{Part, Shard};
use windfall_campaign::pipeline::request::FitRequest;
use windfall_campaign::recording::request::RecordingRequest;

/// `windfall fit`
#[derive(Debug, Args)]
#[command(
    after_help = "Results of a campaign go to standard output and to DIR/results.sqlite; impacts whose \
recording and options have not changed are answered from there.

Exit status: 0 when at least one impact was fitted (what failed is reported), 1 when none was, \
2 when the request or the campaign is wrong.

Examples:
  windfall fit my-campaign
  windfall fit my-campaign --law hertz --law kuwabara-kono --format json
  windfall fit my-campaign --law 'power-law' --free n
  windfall fit my-campaign --law kuwabara-kono --card law.toml
      the median fruit as a law card: `windfall simulate impact --law law.toml …`
  windfall fit my-campaign/raw/apple-7.csv
      one recording of a campaign
  windfall fit my-campaign --quantities displacement,rate,force --weights inverse-mean
      the cost function and the weights of the 2003 pendulum study
  windfall fit my-campaign --intervals profile
      intervals that follow the likelihood, in place of estimate ± t × deviation
  windfall fit my-campaign --intervals posterior --detail fits
      residuals, covariances and draws of each fit: `arviz.from_json(\"fits/….json\")`
  windfall fit my-campaign --out fits.parquet
      the table of results for pandas, polars, DuckDB or R, with units in its metadata
  windfall fit my-campaign --shard 3/64 --out parts/3.parquet
      the third of 64 parts, on a machine of its own; all parts in one folder are one table
  find my-campaign/raw -newer last | windfall fit my-campaign --only - --out new.parquet
      the recordings that another program names
  windfall fit my-campaign --watch
      while you measure: each new recording is listed by [files] names, fitted and shown
  windfall fit impact.csv --rig pendulum --inertia '0.01435 kg m^2' --arm '0.505 m' \\
      --mass '0.11 kg' --centre-of-mass '0.3 m' --time t --channel force=F:N \\
      --channel position=x:mm --law kuwabara-kono
      one recording without a campaign; nothing is written"
)]
pub struct FitArguments {
    /// The campaign directory, one recording of a campaign, or any recording with --rig
    #[arg(default_value = ".", value_name = "DIR|FILE", value_hint = ValueHint::AnyPath)]
    pub directory: PathBuf,
    #[command(flatten)]
    pub request: FitRequest,
    /// How the result is shown
    #[arg(long, value_enum, default_value_t)]
    pub format: Format,
    /// Write the table of results into a file, too: .csv, .parquet or .arrow
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub out: Option<PathBuf>,
    /// Fit this part of the impacts alone, such as 3/64, and write its rows to --out as they come;
    /// results.sqlite is left alone
    #[arg(long, value_name = "PART/PARTS", requires = "out", conflicts_with_all = ["figures", "detail", "card", "rig", "watch", "joint", "refit"])]
    pub shard: Option<Shard>,
    /// Fit only the impacts that a file ("-": standard input) names, an id or a recording in each
    /// line, and write their rows to --out as they come; results.sqlite is left alone
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath, requires = "out", conflicts_with_all = ["shard", "figures", "detail", "card", "rig", "watch", "joint", "refit"])]
    pub only: Option<PathBuf>,
    /// Fit each recording that lands in DIR/raw, as soon as it stops growing, and show the mean
    /// so far, until Ctrl-C
    #[arg(long, conflicts_with_all = ["figures", "detail", "card", "rig", "out"])]
    pub watch: bool,
    /// Rig and channels of a recording without a campaign
    #[command(flatten)]
    pub recording: Option<RecordingRequest>,
}

impl FitArguments {
    /// The part of a campaign that alone is fitted.
    pub fn part(&self) -> Option<Part> {
        let listed = self.only.clone().map(Part::List);
        self.shard.map(Part::Shard).or(listed)
    }
}
