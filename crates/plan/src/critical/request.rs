//! What a plan for a critical energy is asked.

use crate::options::{PlanOptions, SimulationOptions};

/// A critical energy.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
pub struct CriticalRequest {
    /// Energy that half the fruit stand, expected
    #[cfg_attr(
        feature = "clap",
        arg(long, value_name = "ENERGY", allow_negative_numbers = true)
    )]
    pub median: f64,
    /// Standard deviation between fruit of the logarithm of the critical energy (0.3 is about
    /// 30 %); of a Weibull distribution 1/shape
    #[cfg_attr(
        feature = "clap",
        arg(long, value_name = "SD", allow_negative_numbers = true)
    )]
    pub spread: f64,
    /// Energies at which every fruit is struck, rising, until it changes: 0.05,0.1,0.2,0.4
    #[cfg_attr(
        feature = "clap",
        arg(long, value_name = "ENERGY,…", allow_hyphen_values = true)
    )]
    pub energies: String,
    /// The distribution is Weibull's, not log-normal
    #[cfg_attr(feature = "clap", arg(long))]
    pub weibull: bool,
    /// How the simulation is run.
    #[cfg_attr(feature = "clap", command(flatten))]
    pub simulation: SimulationOptions,
    /// Sizes and what is wanted.
    #[cfg_attr(feature = "clap", command(flatten))]
    pub plan: PlanOptions,
}
