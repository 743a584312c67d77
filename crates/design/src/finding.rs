//! What the user of a design should know: no faults, but reasons to think.

use std::fmt;

/// Something to know about a design.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum DesignFinding {
    /// Two-factor interactions cannot be told from main effects or each other.
    LowResolution {
        /// Length of the shortest word of the defining relation.
        resolution: usize,
    },
    /// Blocks shift the quadratic coefficients.
    BlocksNotOrthogonal {
        /// Axial distance of the design, in half-ranges.
        alpha: f64,
        /// Axial distance at which they would not.
        orthogonal: f64,
    },
    /// No run is repeated: no pure error, no test of lack of fit.
    NoReplicates,
    /// Sobol points are balanced in powers of two.
    NotPowerOfTwo {
        /// Runs asked for.
        runs: usize,
    },
    /// Distances between points were not improved.
    SpreadNotImproved {
        /// Runs asked for.
        runs: usize,
        /// Most that are improved.
        most: usize,
    },
    /// Printed settings differ from the exact levels.
    SettingsRounded {
        /// The factor.
        factor: String,
        /// Largest difference, in half-ranges.
        coded: f64,
    },
    /// Rounding makes two levels one.
    SettingsMerged {
        /// The factor.
        factor: String,
        /// The decimals.
        decimals: usize,
    },
}

impl DesignFinding {
    /// Short name for tables and JSON.
    #[must_use]
    pub fn code(&self) -> &'static str {
        match self {
            Self::LowResolution { .. } => "low-resolution",
            Self::BlocksNotOrthogonal { .. } => "blocks-not-orthogonal",
            Self::NoReplicates => "no-replicates",
            Self::NotPowerOfTwo { .. } => "not-power-of-two",
            Self::SpreadNotImproved { .. } => "spread-not-improved",
            Self::SettingsRounded { .. } => "settings-rounded",
            Self::SettingsMerged { .. } => "settings-merged",
        }
    }
}

impl fmt::Display for DesignFinding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::LowResolution { resolution: 3 } => f.write_str(
                "resolution III: main effects cannot be told from two-factor interactions",
            ),
            Self::LowResolution { resolution } => write!(
                f,
                "resolution {resolution}: two-factor interactions cannot all be told from each other"
            ),
            Self::BlocksNotOrthogonal { alpha, orthogonal } => write!(
                f,
                "alpha {alpha:.4} does not block orthogonally: differences between blocks enter \
                 the quadratic terms; alpha {orthogonal:.4} would keep them out"
            ),
            Self::NoReplicates => f.write_str(
                "no run is repeated: there will be no pure error and no test of lack of fit",
            ),
            Self::NotPowerOfTwo { runs } => write!(
                f,
                "{runs} runs are no power of two: Sobol points are evenly balanced only in {} or {}",
                runs.next_power_of_two() / 2,
                runs.next_power_of_two()
            ),
            Self::SpreadNotImproved { runs, most } => write!(
                f,
                "distances between points are not improved beyond {most} runs, and {runs} are asked for"
            ),
            Self::SettingsRounded { factor, coded } => write!(
                f,
                "the printed settings of {factor} differ from the exact levels by up to {coded:.2e} \
                 half-ranges; analyse with the coded columns if the exact levels were set, \
                 with the settings if the printed ones were"
            ),
            Self::SettingsMerged { factor, decimals } => write!(
                f,
                "with {decimals} decimals two levels of {factor} are printed as one number"
            ),
        }
    }
}
