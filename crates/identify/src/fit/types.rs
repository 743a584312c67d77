//! What a fit returns.

use crate::finding::{Finding, Shown};
use crate::fit::identifiability::Direction;
use crate::fit::interval::IntervalDetail;
use crate::fit::uncertainty::RunsTest;
use crate::rig::bench::BenchQuantity;
use crate::rig::simulate::ImpactSummary;
use crate::samples::Quantity;
use windfall_contact::laws::kind::Law;

/// One estimated parameter.
#[derive(Clone, Debug, PartialEq)]
pub struct Estimate {
    /// Name: the law's, or "initial_velocity", "onset", "displacement_offset".
    pub name: String,
    /// Estimate; SI.
    pub value: f64,
    /// Standard deviation; SI. Infinite, with [`Finding::Singular`], where it is unknown.
    pub sd: f64,
    /// Lower end of the interval; SI.
    pub low: f64,
    /// Upper end of the interval; SI.
    pub high: f64,
    /// Unit.
    pub unit: String,
}

/// How one quantity fits.
#[derive(Clone, Debug, PartialEq)]
pub struct QuantityFit {
    /// The quantity.
    pub quantity: Quantity,
    /// Samples.
    pub samples: usize,
    /// Weight in the cost.
    pub weight: f64,
    /// Noise of a sample, from the recording itself; SI.
    pub noise: f64,
    /// Correlation of the noise of successive samples that the fit reckoned
    /// with; 1.
    pub persistence: f64,
    /// Root mean square residual; SI.
    pub rms_residual: f64,
    /// Root mean square of the residuals made independent, over their standard
    /// deviation by the recording's noise alone; 1.
    pub standardised: f64,
    /// Runs test of the residuals, where there are enough.
    pub runs: Option<RunsTest>,
    /// Probability of as few runs by chance: of the residuals made independent or of those as
    /// they are, whichever is larger; 1.
    ///
    /// The persistence of the noise comes from few samples. Where it is found by chance, what
    /// is made independent with it no longer is, and the residuals as they are show it.
    pub chance: Option<f64>,
    /// Mean residual, over its root mean square, in equal parts of the contact: what impacts
    /// have in common stands out when they are averaged; 1.
    pub by_phase: [f64; PHASES],
}

/// Parts of a contact in which residuals are averaged.
pub const PHASES: usize = 8;

/// What all impacts take from the same source, with the same error.
#[derive(Clone, Debug, PartialEq)]
pub enum CommonCause {
    /// A quantity of the bench.
    Bench(BenchQuantity),
    /// The prior of a parameter.
    Prior {
        /// The parameter.
        parameter: String,
        /// Its unit.
        unit: String,
    },
}

impl CommonCause {
    /// Its name in results: "inertia", "prior.k".
    pub fn name(&self) -> String {
        match self {
            Self::Bench(quantity) => quantity.name().to_owned(),
            Self::Prior { parameter, .. } => format!("prior.{parameter}"),
        }
    }
}

/// What the uncertainty of a common cause moves: by the same in all impacts.
#[derive(Clone, Debug, PartialEq)]
pub struct CommonShift {
    /// The cause.
    pub cause: CommonCause,
    /// Its standard uncertainty; SI.
    pub sd: f64,
    /// Change of each parameter, then of each nuisance, for one standard uncertainty more; SI.
    pub shifts: Vec<f64>,
}

impl CommonShift {
    /// The quantity of the bench, if it is one, and "inertia ± 0.0002 kg m^2".
    pub(crate) fn of_bench(&self) -> Option<(BenchQuantity, String)> {
        match self.cause {
            CommonCause::Bench(quantity) => {
                let sd = Shown(self.sd, quantity.unit());
                Some((quantity, format!("{} ± {sd}", quantity.name())))
            }
            CommonCause::Prior { .. } => None,
        }
    }
}

/// A law fitted to an impact.
#[derive(Clone, Debug, PartialEq)]
pub struct Fit {
    /// The law with all its parameters.
    pub law: Law,
    /// The law's free parameters.
    pub parameters: Vec<Estimate>,
    /// What was estimated besides the law.
    pub nuisances: Vec<Estimate>,
    /// Correlations of all free parameters, in the order of `parameters` then
    /// `nuisances`; empty when they are not available.
    pub correlations: Vec<Vec<f64>>,
    /// Weighted sum of squared residuals.
    pub cost: f64,
    /// Its root.
    pub residual_norm: f64,
    /// Samples of all quantities.
    pub samples: usize,
    /// Evaluations of the model.
    pub evaluations: usize,
    /// Whether a minimum was reached.
    pub converged: bool,
    /// Each quantity of the cost.
    pub quantities: Vec<QuantityFit>,
    /// Linear regression of eq. (9) for comparison, by name.
    pub regression: Vec<Estimate>,
    /// The impact that the fitted law describes.
    pub simulated: ImpactSummary,
    /// Velocity at first touch of the fitted model; m/s.
    pub velocity: f64,
    /// Time of first touch on the recording's clock; s.
    pub onset: f64,
    /// Displacement offset; m.
    pub offset: f64,
    /// Combinations of parameters and nuisances, in their order, from the least to the
    /// best determined; empty where the covariance is singular.
    pub directions: Vec<Direction>,
    /// What the uncertainties of bench and priors move; they are part of the deviations.
    pub common: Vec<CommonShift>,
    /// How the intervals came about.
    pub intervals: IntervalDetail,
    /// Remarks.
    pub findings: Vec<Finding>,
}
