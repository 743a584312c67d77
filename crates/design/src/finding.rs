//! What the user of a design should know: no faults, but reasons to think.

/// Something to know about a design.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
#[allow(missing_docs, reason = "each message names its fields")]
pub enum DesignFinding {
    #[error("{}", confounded(*resolution))]
    LowResolution { resolution: usize },
    #[error(
        "alpha {alpha:.4} does not block orthogonally: differences between blocks enter \
         the quadratic terms; alpha {orthogonal:.4} would keep them out"
    )]
    BlocksNotOrthogonal { alpha: f64, orthogonal: f64 },
    #[error("no run is repeated: there will be no pure error and no test of lack of fit")]
    NoReplicates,
    #[error(
        "{runs} runs are no power of two: Sobol points are evenly balanced only in {} or {}",
        runs.next_power_of_two() / 2,
        runs.next_power_of_two()
    )]
    NotPowerOfTwo { runs: usize },
    #[error(
        "distances between points are not improved beyond {most} runs, and {runs} are asked for"
    )]
    SpreadNotImproved { runs: usize, most: usize },
    #[error(
        "the printed settings of {factor} differ from the exact levels by up to {coded:.2e} \
         half-ranges; analyse with the coded columns if the exact levels were set, \
         with the settings if the printed ones were"
    )]
    SettingsRounded { factor: String, coded: f64 },
    #[error(
        "{plots} whole plots determine the terms of the hard-to-change factors and leave no degrees \
         of freedom for the scatter between whole plots: there will be no valid test of these terms; \
         add whole plots"
    )]
    NoWholePlotError { plots: usize },
    #[error(
        "{runs} runs leave no degrees of freedom for the scatter within whole plots: add runs, or \
         leave out terms"
    )]
    NoErrorWithinPlots { runs: usize },
    #[error("with {decimals} decimals two levels of {factor} are printed as one number")]
    SettingsMerged { factor: String, decimals: usize },
}

impl DesignFinding {
    /// Short name for tables and JSON.
    pub fn code(&self) -> &'static str {
        match self {
            Self::LowResolution { .. } => "low-resolution",
            Self::BlocksNotOrthogonal { .. } => "blocks-not-orthogonal",
            Self::NoReplicates => "no-replicates",
            Self::NotPowerOfTwo { .. } => "not-power-of-two",
            Self::SpreadNotImproved { .. } => "spread-not-improved",
            Self::SettingsRounded { .. } => "settings-rounded",
            Self::NoWholePlotError { .. } => "no-whole-plot-error",
            Self::NoErrorWithinPlots { .. } => "no-error-within-plots",
            Self::SettingsMerged { .. } => "settings-merged",
        }
    }
}

fn confounded(resolution: usize) -> String {
    match resolution {
        3 => "resolution III: main effects cannot be told from two-factor interactions".to_owned(),
        _ => format!(
            "resolution {resolution}: two-factor interactions cannot all be told from each other"
        ),
    }
}
