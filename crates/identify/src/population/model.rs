//! A population of fruit: inputs and results.

use crate::population::finding::PopulationFinding;
pub use crate::population::linear::Likelihood;
pub use crate::population::variance::Structure;

/// The impacts of a campaign as members of a population.
///
/// ```text
/// φ_ij = X_ij β + b_i + e_ij,   b_i ~ N(0, Ω),   e_ij ~ N(0, Δ)
/// ```
///
/// φ are the law's free parameters (the logarithm of a scale, an exponent as it
/// is), i counts fruit and j the impacts of one.
#[derive(Clone, Debug, PartialEq)]
pub struct PopulationData {
    /// Names of the parameters.
    pub parameters: Vec<String>,
    /// Fruit of each impact: indices from 0.
    pub fruit: Vec<usize>,
    /// Covariates of every parameter.
    pub covariates: Vec<Covariate>,
}

/// A number that the parameters may depend on.
#[derive(Clone, Debug, PartialEq)]
pub struct Covariate {
    /// Its name.
    pub name: String,
    /// Value that stands for the median fruit.
    pub centre: f64,
    /// Value at each impact.
    pub values: Vec<f64>,
}

/// An impact's log-likelihood of its own parameters at one point.
#[derive(Clone, Debug, PartialEq)]
pub struct Expansion {
    /// Log-likelihood, up to a constant of the impact.
    pub value: f64,
    /// Its gradient.
    pub gradient: Vec<f64>,
    /// Its negative second derivatives, positive definite.
    pub curvature: Vec<Vec<f64>>,
}

/// Expansions of all impacts at one point each; `None` where an impact's
/// likelihood cannot be computed.
pub type Expand<'a> = dyn Fn(&[Vec<f64>]) -> Vec<Option<Expansion>> + 'a;

/// Approximation of the integral over the impacts' own parameters.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Approximation {
    /// Laplace's.
    #[default]
    Laplace,
    /// First-order conditional estimation (Lindstrom and Bates): without the
    /// change of the expansions' determinants with the mode.
    FirstOrder,
}

/// How a population is estimated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PopulationOptions {
    /// Likelihood of the variances.
    pub likelihood: Likelihood,
    /// Approximation of the likelihood.
    pub approximation: Approximation,
    /// Covariance between fruit.
    pub between: Structure,
    /// Covariance of the impacts of one fruit.
    pub within: Structure,
    /// Coverage of the intervals; 1.
    pub confidence: f64,
    /// Iterations before giving up.
    pub max_iterations: usize,
}

impl Default for PopulationOptions {
    fn default() -> Self {
        Self {
            likelihood: Likelihood::default(),
            approximation: Approximation::default(),
            between: Structure::default(),
            within: Structure::default(),
            confidence: 0.95,
            max_iterations: 30,
        }
    }
}

/// An estimated standard deviation or correlation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spread {
    /// Estimate.
    pub value: f64,
    /// Ends of its profile-likelihood interval; `None` where there is none.
    pub interval: Option<(f64, f64)>,
}

/// An estimated fixed effect on one parameter.
#[derive(Clone, Debug, PartialEq)]
pub struct FixedEffect {
    /// The parameter.
    pub parameter: String,
    /// The covariate; `None`: the parameter itself at the centre of all
    /// covariates.
    pub covariate: Option<String>,
    /// Estimate, on the scale of φ.
    pub value: f64,
    /// Standard error.
    pub se: f64,
    /// Degrees of freedom (Satterthwaite).
    pub df: f64,
    /// Lower end of the t interval.
    pub low: f64,
    /// Upper end.
    pub high: f64,
    /// Two-sided p-value of being zero.
    pub p: f64,
}

/// Variation at one level: between fruit, or of the impacts of one fruit.
#[derive(Clone, Debug, PartialEq)]
pub struct Variation {
    /// Covariance of φ.
    pub covariance: Vec<Vec<f64>>,
    /// Standard deviations.
    pub sds: Vec<Spread>,
    /// Correlations of the pairs (0, 1), (0, 2), (1, 2), …
    pub correlations: Vec<Spread>,
}

/// An estimated population.
#[derive(Clone, Debug, PartialEq)]
pub struct PopulationFit {
    /// Names of the parameters.
    pub parameters: Vec<String>,
    /// Covariates that are in the model, with their centres.
    pub covariates: Vec<(String, f64)>,
    /// Fixed effects, parameter by parameter, the parameter itself first.
    pub effects: Vec<FixedEffect>,
    /// Their covariance, in their order.
    pub effects_covariance: Vec<Vec<f64>>,
    /// Variation between fruit.
    pub between: Variation,
    /// Variation of the impacts of one fruit.
    pub within: Variation,
    /// Most probable φ of each fruit at the centre of all covariates.
    pub fruit: Vec<Vec<f64>>,
    /// Most probable φ of each impact.
    pub impacts: Vec<Vec<f64>>,
    /// Log-likelihood (Laplace) of the chosen kind; a constant of
    /// the impacts is such that it is that of the fits as normal observations
    /// where the impacts' likelihoods are quadratic.
    pub log_likelihood: f64,
    /// Part of it by which the impacts' likelihoods differ from quadratic ones.
    pub not_quadratic: f64,
    /// Largest difference of an estimate to that of a single linearisation at
    /// the fits; standard errors.
    pub shift_from_fits: f64,
    /// Largest difference to the first-order linearisation at the modes;
    /// standard errors.
    pub shift_from_first_order: f64,
    /// Iterations.
    pub iterations: usize,
    /// Whether the estimates settled.
    pub converged: bool,
    /// Remarks.
    pub findings: Vec<PopulationFinding>,
}
