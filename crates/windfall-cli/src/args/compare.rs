//! `windfall summary` and `windfall compare`: arguments.

use crate::args::format::Format;
use clap::{Args, ValueEnum, ValueHint};
use std::path::PathBuf;

/// `windfall summary`
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  windfall summary impacts.csv --by variety --value k --value c
  windfall summary impacts.csv --by variety,V --value k --format csv")]
pub struct SummaryArguments {
    /// Table with a header line (CSV)
    #[arg(value_hint = ValueHint::FilePath)]
    pub table: PathBuf,
    /// Columns that group the rows, separated by commas; all rows are one group if left out
    #[arg(long, value_name = "COLUMNS", value_delimiter = ',')]
    pub by: Vec<String>,
    /// Column of values; may be repeated; all columns of numbers if left out
    #[arg(long = "value", value_name = "COLUMN")]
    pub values: Vec<String>,
    /// Level of the intervals of means
    #[arg(long, default_value_t = 0.95, value_name = "LEVEL")]
    pub confidence: f64,
    /// How the result is shown
    #[arg(long, value_enum, default_value_t)]
    pub format: Format,
}

/// `windfall compare`
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  windfall compare fruit.csv --value firmness_N --by variety
      analysis of variance, Welch, Levene, Tukey and letters
  windfall compare impacts.csv --value k --by V --paired specimen
      the same fruit at every velocity
  windfall compare impacts.csv --value k --by variety --specimen fruit
      several impacts on each fruit: their means are compared
  windfall compare fitted.csv --measured k --predicted k_model --parameters 5
      how far predictions lie from what was measured")]
pub struct CompareArguments {
    /// Table with a header line (CSV)
    #[arg(value_hint = ValueHint::FilePath)]
    pub table: PathBuf,
    /// Column of values
    #[arg(
        long,
        value_name = "COLUMN",
        required_unless_present = "measured",
        requires = "by"
    )]
    pub value: Option<String>,
    /// Columns that group the rows, separated by commas
    #[arg(long, value_name = "COLUMNS", value_delimiter = ',')]
    pub by: Vec<String>,
    /// Column of specimens that were measured in every group
    #[arg(long, value_name = "COLUMN", requires = "value", conflicts_with_all = ["specimen", "pairs"])]
    pub paired: Option<String>,
    /// Column of specimens measured several times within a group: their means are compared
    #[arg(long, value_name = "COLUMN", requires = "value")]
    pub specimen: Option<String>,
    /// How pairs of groups are compared
    #[arg(long, value_enum, default_value_t, requires = "value")]
    pub pairs: Pairs,
    /// Level of all intervals; letters say what differs at one less this
    #[arg(long, default_value_t = 0.95, value_name = "LEVEL")]
    pub confidence: f64,
    /// Column of measured values, to hold predictions against
    #[arg(long, value_name = "COLUMN", requires = "predicted", conflicts_with_all = ["value", "by"])]
    pub measured: Option<String>,
    /// Column of predicted values
    #[arg(long, value_name = "COLUMN", requires = "measured")]
    pub predicted: Option<String>,
    /// Parameters that were fitted to these values
    #[arg(long, default_value_t = 0, value_name = "N", requires = "measured")]
    pub parameters: usize,
    /// How the result is shown
    #[arg(long, value_enum, default_value_t)]
    pub format: Format,
}

/// How pairs of groups are compared.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum Pairs {
    /// Tukey's honest significant difference, common variance
    #[default]
    Tukey,
    /// Each pair with its own variances
    GamesHowell,
    /// Welch's t tests adjusted by Holm
    Holm,
}
