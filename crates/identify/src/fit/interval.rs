//! Methods of intervals, their options and what they report besides the ends.

use crate::sampler::Drawing;
use crate::sampler::chain_diagnostics::ChainDiagnostics;
use serde::Serialize;

/// How intervals are made.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum IntervalMethod {
    /// Estimate ± t × standard deviation, from the curvature of the likelihood.
    #[default]
    Asymptotic,
    /// Where the likelihood, maximal over the other parameters, has fallen by
    /// what chance explains.
    Profile,
    /// Spread of the estimates over recordings made of the fitted model and
    /// blocks of its residuals.
    Bootstrap,
    /// Quantiles of the posterior distribution: under the priors that are given, and flat
    /// ones in the minimiser's coordinates (logarithms of scales) for the others.
    Posterior,
}

impl IntervalMethod {
    /// All, in the order in which they are listed to people.
    pub const ALL: [Self; 4] = [
        Self::Asymptotic,
        Self::Profile,
        Self::Bootstrap,
        Self::Posterior,
    ];

    /// Name in options and results.
    pub fn name(self) -> &'static str {
        match self {
            Self::Asymptotic => "asymptotic",
            Self::Profile => "profile",
            Self::Bootstrap => "bootstrap",
            Self::Posterior => "posterior",
        }
    }
}

/// How intervals are made, and with how much work.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct IntervalOptions {
    /// How.
    pub method: IntervalMethod,
    /// Recordings of a bootstrap.
    pub replicates: usize,
    /// Draws of each chain of a posterior, after as many for tuning, at most
    /// five hundred.
    pub draws: usize,
    /// Chains of a posterior.
    pub chains: usize,
    /// Seed of bootstrap and posterior.
    pub seed: u64,
}

impl IntervalOptions {
    /// The draws of a posterior.
    pub fn drawing(&self) -> Drawing {
        Drawing {
            chains: self.chains,
            draws: self.draws,
            seed: self.seed,
        }
    }
}

impl Default for IntervalOptions {
    fn default() -> Self {
        Self {
            method: IntervalMethod::default(),
            replicates: 1000,
            draws: 1000,
            chains: 4,
            seed: 1,
        }
    }
}

/// Details of the intervals. Lists run over the free parameters: those of the law, then
/// the nuisances.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum IntervalDetail {
    /// Nothing more.
    #[default]
    Asymptotic,
    /// Profile of each parameter.
    Profile(Vec<ProfileCurve>),
    /// Estimates of all replicates.
    Bootstrap(Bootstrap),
    /// Draws and how far they can be trusted.
    Posterior(Posterior),
}

/// Likelihood of one parameter, maximal over the others.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ProfileCurve {
    /// Values tried, ascending; SI.
    pub values: Vec<f64>,
    /// −2 ln of the likelihood relative to its maximum.
    pub rises: Vec<f64>,
    /// Whether no lower end was found: the data do not exclude the smallest value tried.
    pub open_below: bool,
    /// Whether no upper end was found.
    pub open_above: bool,
}

/// Estimates over resampled recordings.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Bootstrap {
    /// Recordings made.
    pub replicates: usize,
    /// How many of them had no estimate.
    pub failed: usize,
    /// Estimates of each parameter; SI.
    pub estimates: Vec<Vec<f64>>,
}

/// Draws of a posterior.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Posterior {
    /// Chains.
    pub chains: usize,
    /// Draws of each parameter, chain after chain; SI.
    pub draws: Vec<Vec<f64>>,
    /// Draws at which the integration of the sampler broke down, after tuning.
    pub divergences: usize,
    /// How well the chains agree, for each parameter.
    pub mixing: Vec<ChainDiagnostics>,
}

/// Largest R-hat and fewest independent draws of chains that agree and are long enough
/// (Vehtari et al. 2021, Bayesian Anal. 16:667).
const MIXED: (f64, f64) = (1.01, 400.0);

/// The fewer of a parameter's independent draws, for the centre and for the tails.
pub fn independent_draws(mixing: &ChainDiagnostics) -> f64 {
    mixing.bulk_draws.min(mixing.tail_draws)
}

/// Whether the chains agree and are long enough.
pub fn mixes(mixing: &ChainDiagnostics) -> bool {
    mixing.r_hat <= MIXED.0 && independent_draws(mixing) >= MIXED.1
}

/// Method and inputs of the intervals of one fit.
#[derive(Clone, Debug)]
pub(crate) struct IntervalPlan {
    pub options: IntervalOptions,
    pub confidence: f64,
    /// Student's quantile of the confidence.
    pub quantile: f64,
}

/// Intervals of the free parameters in their order, in the minimiser's
/// coordinates turned to SI.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct FreeIntervals {
    pub low: Vec<f64>,
    pub high: Vec<f64>,
    /// Standard deviations, where the method has its own.
    pub sd: Option<Vec<f64>>,
    pub detail: IntervalDetail,
}

/// Quantile `p` of a sample, linear between its order statistics
/// (Hyndman and Fan 1996, Am. Stat. 50:361, definition 7). Sorts the sample.
pub(crate) fn quantile(values: &mut [f64], p: f64) -> f64 {
    values.sort_unstable_by(f64::total_cmp);
    let place = p.clamp(0.0, 1.0) * (values.len() - 1) as f64;
    let below = place.floor() as usize;
    let above = (below + 1).min(values.len() - 1);
    values[below] + (place - below as f64) * (values[above] - values[below])
}

/// Standard deviation of a sample.
pub(crate) fn deviation(values: &[f64]) -> f64 {
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    let square: f64 = values.iter().map(|v| (v - mean).powi(2)).sum();
    (square / (n - 1.0).max(1.0)).sqrt()
}
