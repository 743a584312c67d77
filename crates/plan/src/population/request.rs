//! What a plan for a population of laws is asked.

use crate::options::PlanOptions;
use std::path::PathBuf;

/// A parameter of a population of laws.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
pub struct PopulationPlanRequest {
    /// Law card with a population, as `windfall population DIR --card FILE` writes it
    #[cfg_attr(feature = "clap", arg(value_name = "CARD", value_hint = clap::ValueHint::FilePath))]
    pub card: PathBuf,
    /// Parameter of the law
    #[cfg_attr(feature = "clap", arg(long, value_name = "NAME"))]
    pub parameter: String,
    /// Standard deviation between the impacts of a fruit, in the unit of the card's covariance
    /// (0.05 of a logarithm is 5 %); that of the card if left out
    #[cfg_attr(
        feature = "clap",
        arg(long, value_name = "SD", allow_negative_numbers = true)
    )]
    pub within: Option<f64>,
    /// Sizes and what is wanted.
    #[cfg_attr(feature = "clap", command(flatten))]
    pub plan: PlanOptions,
}
