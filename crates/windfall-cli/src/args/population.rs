//! `windfall population`: arguments.

use crate::args::format::Shown;
use clap::{Args, ValueHint};
use std::path::PathBuf;

/// `windfall population`
#[derive(Debug, Args)]
#[command(
    after_help = "Estimates how the law's parameters vary between fruit, within fruit and with covariates, from \
all impacts of a campaign at once (nonlinear mixed effects); the two-stage way of fitting each \
impact and averaging stands beside it.

A covariate is a numeric column of impacts.csv or specimens.csv, the logarithm of one, \
impact_velocity (as measured), or a column of words (compared with its first word). \
campaign.toml may name them: [population] covariates = [\"log(impact_velocity)\"]

Exit status: 0 when the population was estimated, 1 when the impacts do not allow it, \
2 when the request or the campaign is wrong.

Examples:
  windfall population my-campaign
  windfall population my-campaign --covariate 'log(impact_velocity)' --covariate variety
  windfall population my-campaign --posterior --detail draws.json
  windfall population my-campaign --law hunt-crossley --format json"
)]
pub struct PopulationArguments {
    /// The campaign directory
    #[arg(default_value = ".", value_name = "DIR", value_hint = ValueHint::DirPath)]
    pub directory: PathBuf,
    /// Column, log(column) or impact_velocity that the parameters may depend on; may be repeated
    #[arg(long = "covariate", value_name = "COVARIATE")]
    pub covariates: Vec<String>,
    /// Law in place of the campaign's
    #[arg(long, value_name = "LAW")]
    pub law: Option<String>,
    /// Parameter to estimate although it has a value, such as an exponent; may be repeated
    #[arg(long, value_name = "NAME")]
    pub free: Vec<String>,
    /// Draw the posterior beside the estimate, as a check; minutes for large campaigns
    #[arg(long)]
    pub posterior: bool,
    /// Draws of each of four chains for --posterior (1000)
    #[arg(long, value_name = "N", requires = "posterior")]
    pub draws: Option<usize>,
    /// Seed of the posterior's draws (1)
    #[arg(long, value_name = "N", requires = "posterior")]
    pub seed: Option<u64>,
    /// Write the posterior's draws, as JSON for arviz.from_json or as a table (.parquet, .arrow or
    /// .csv); draws them anew
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath, requires = "posterior")]
    pub detail: Option<PathBuf>,
    /// Write the population as a law card (TOML, or JSON where the name ends with .json)
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub card: Option<PathBuf>,
    /// Find the answer anew, even where nothing has changed since it was found
    #[arg(long)]
    pub refit: bool,
    /// Number of threads; all cores if left out. It never changes a result
    #[arg(long, value_name = "N")]
    pub threads: Option<usize>,
    #[command(flatten)]
    pub shown: Shown,
}
