//! What a plan for a response surface is asked.

use crate::options::{PlanOptions, ScatterOptions, SimulationOptions};
use std::path::PathBuf;
use windfall_tables::reading::ReadingOptions;

/// A response surface.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
pub struct SurfacePlanRequest {
    /// Table of runs (CSV), as `windfall design` writes it
    #[cfg_attr(feature = "clap", arg(value_hint = clap::ValueHint::FilePath))]
    pub table: PathBuf,
    /// A column of earlier responses, whose surface is taken for the truth
    #[cfg_attr(
        feature = "clap",
        arg(long, value_name = "COLUMN", conflicts_with = "coefficients")
    )]
    pub response: Option<String>,
    /// The surface itself, coefficients of coded terms: 'A=1, A^2=-2, B^2=-1'; those left out
    /// are zero
    #[cfg_attr(
        feature = "clap",
        arg(long, value_name = "TERM=VALUE,…", allow_hyphen_values = true)
    )]
    pub coefficients: Option<String>,
    /// The model that is to be fitted
    #[cfg_attr(
        feature = "clap",
        arg(long, value_name = "MODEL", default_value = "quadratic")
    )]
    pub model: String,
    /// A factor; repeated in the order of the letters A, B, C …; as the header of a design says
    /// if left out
    #[cfg_attr(feature = "clap", arg(long = "factor", value_name = "COLUMN"))]
    pub factors: Vec<String>,
    /// Actual values of coded -1 and 1 of a factor: k=0.44..0.86; may be repeated
    #[cfg_attr(feature = "clap", arg(long = "range", value_name = "FACTOR=LOW..HIGH"))]
    pub ranges: Vec<String>,
    /// How much measurements scatter.
    #[cfg_attr(feature = "clap", command(flatten))]
    pub scatter: ScatterOptions,
    /// How the simulation is run.
    #[cfg_attr(feature = "clap", command(flatten))]
    pub simulation: SimulationOptions,
    /// Sizes and what is wanted.
    #[cfg_attr(feature = "clap", command(flatten))]
    pub plan: PlanOptions,
    /// How the table is read
    #[cfg_attr(feature = "clap", command(flatten))]
    pub reading: ReadingOptions,
}
