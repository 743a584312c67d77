//! What a plan by simulation of a mixed model is asked.

use crate::options::{PlanOptions, SimulationOptions};
use std::path::PathBuf;
use windfall_tables::reading::ReadingOptions;

/// A term of a mixed model.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
pub struct ModelRequest {
    /// Table of earlier impacts (CSV), whose rows are the layout of the study
    #[cfg_attr(feature = "clap", arg(value_hint = clap::ValueHint::FilePath))]
    pub table: PathBuf,
    /// Mixed model of that table: 'k ~ V + variety + (1 + V | fruit)'
    #[cfg_attr(feature = "clap", arg(long))]
    pub formula: String,
    /// Term that is to be found; the only one if left out
    #[cfg_attr(feature = "clap", arg(long, value_name = "TERM"))]
    pub term: Option<String>,
    /// Coefficient that is taken in place of the fitted one: V=-0.3; may be repeated
    #[cfg_attr(
        feature = "clap",
        arg(long = "effect", value_name = "COEFFICIENT=VALUE")
    )]
    pub effects: Vec<String>,
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
