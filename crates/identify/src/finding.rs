//! What a reader of a fit should know besides its numbers.

/// A remark on one fit.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Finding {
    /// The minimiser did not reach a minimum.
    #[error(
        "the fit stopped after {evaluations} evaluations without reaching a minimum; its values are not estimates"
    )]
    NoConvergence {
        /// Evaluations used.
        evaluations: usize,
    },
    /// A parameter ended on its bound.
    #[error(
        "{parameter} ended on its {side} bound {bound} {unit}: the data ask for a value beyond it, or say nothing about it"
    )]
    AtBound {
        /// Name of the parameter.
        parameter: String,
        /// "lower" or "upper".
        side: &'static str,
        /// The bound; SI.
        bound: f64,
        /// Its unit.
        unit: String,
    },
    /// A nuisance was left out of the free parameters.
    #[error("{quantity} was held at {value} {unit}: {reason}")]
    Held {
        /// What was held.
        quantity: &'static str,
        /// Its value; SI.
        value: f64,
        /// Its unit.
        unit: &'static str,
        /// Why.
        reason: &'static str,
    },
    /// Nuisances that were estimated.
    #[error("estimated besides the law: {quantities}")]
    Freed {
        /// Their names.
        quantities: String,
    },
    /// Two parameters move together.
    #[error(
        "{first} and {second} can hardly be told apart in this impact (correlation {correlation:.4})"
    )]
    Correlated {
        /// One parameter.
        first: String,
        /// The other.
        second: String,
        /// Their correlation; 1.
        correlation: f64,
    },
    /// The normal matrix is singular.
    #[error(
        "the data cannot tell the free parameters apart: standard deviations are not available"
    )]
    Singular,
    /// The residuals of a channel are not random.
    #[error(
        "the residuals of {quantity} are not random (runs test z = {z:.1}): the law or the rig misses part of the signal, or the channel's noise is correlated"
    )]
    StructuredResiduals {
        /// The quantity.
        quantity: &'static str,
        /// Standardised number of runs; 1.
        z: f64,
    },
    /// The residuals are much larger than the channel's own noise.
    #[error(
        "the residuals of {quantity} are {ratio:.1} times its own noise ({noise:.3e}): the law does not describe the signal to its accuracy"
    )]
    Misfit {
        /// The quantity.
        quantity: &'static str,
        /// Root mean square residual over noise; 1.
        ratio: f64,
        /// Noise of a sample; SI.
        noise: f64,
    },
    /// The uncertainty of the mass widens the intervals.
    #[error("the intervals include the uncertainty of the mass, {mass:.4e} ± {sd:.1e} kg")]
    UncertainMass {
        /// Mass; kg.
        mass: f64,
        /// Its standard uncertainty; kg.
        sd: f64,
    },
    /// A wanted quantity is missing.
    #[error("{quantity} is not in the recording and took no part in the fit")]
    MissingQuantity {
        /// The quantity.
        quantity: &'static str,
    },
    /// The law's restitution is not what it delivers.
    #[error(
        "the law's restitution parameter is {nominal:.4}, but the impact it describes rebounds with {delivered:.4}"
    )]
    NominalRestitution {
        /// The law's parameter; 1.
        nominal: f64,
        /// What the law does; 1.
        delivered: f64,
    },
}

impl Finding {
    /// Stable name for scripts.
    #[must_use]
    pub fn code(&self) -> &'static str {
        match self {
            Self::NoConvergence { .. } => "no-convergence",
            Self::AtBound { .. } => "at-bound",
            Self::Held { .. } => "held",
            Self::Freed { .. } => "freed",
            Self::Correlated { .. } => "correlated",
            Self::Singular => "singular",
            Self::StructuredResiduals { .. } => "structured-residuals",
            Self::Misfit { .. } => "misfit",
            Self::UncertainMass { .. } => "uncertain-mass",
            Self::MissingQuantity { .. } => "missing-quantity",
            Self::NominalRestitution { .. } => "nominal-restitution",
        }
    }
}
