//! What a look back on a campaign is asked.

use std::path::PathBuf;
use windfall_tables::reading::ReadingOptions;

/// A finished table.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
pub struct AchievedRequest {
    /// Table of impacts (CSV)
    #[cfg_attr(feature = "clap", arg(value_hint = clap::ValueHint::FilePath))]
    pub table: PathBuf,
    /// Its mixed model: 'k ~ V + variety + (1 | fruit)'
    #[cfg_attr(feature = "clap", arg(long))]
    pub formula: String,
    /// Marginal means of a category, or of several, as in `windfall regress`; may be repeated
    #[cfg_attr(feature = "clap", arg(long = "means", value_name = "COLUMNS"))]
    pub means: Vec<String>,
    /// Power with which the detectable effects are found
    #[cfg_attr(
        feature = "clap",
        arg(
            long,
            default_value_t = 0.8,
            value_name = "PART",
            allow_negative_numbers = true
        )
    )]
    pub power: f64,
    /// Level of the intervals; tests are made at 1 minus it
    #[cfg_attr(
        feature = "clap",
        arg(
            long,
            default_value_t = 0.95,
            value_name = "LEVEL",
            allow_negative_numbers = true
        )
    )]
    pub confidence: f64,
    /// How the table is read
    #[cfg_attr(feature = "clap", command(flatten))]
    pub reading: ReadingOptions,
}
