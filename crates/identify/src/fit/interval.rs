//! Intervals that follow the likelihood: what they are asked for with, and what
//! is told besides their ends.

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
    /// Quantiles of the posterior distribution under flat priors in the
    /// minimiser's coordinates (logarithms of scales).
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
    #[must_use]
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

/// What is told of intervals besides their ends. Lists run over the free
/// parameters: those of the law, then the nuisances.
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
    /// Values looked at, ascending; SI.
    pub values: Vec<f64>,
    /// −2 ln of the likelihood relative to its maximum.
    pub rises: Vec<f64>,
    /// Whether no lower end was found: the data do not exclude the smallest
    /// value that was looked at.
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
    pub mixing: Vec<Mixing>,
}

/// How well the chains of one parameter agree.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mixing {
    /// Spread of all chains over that within chains: 1 when they agree.
    pub r_hat: f64,
    /// Independent draws that would tell the centre as well.
    pub bulk_draws: f64,
    /// Independent draws that would tell the ends as well.
    pub tail_draws: f64,
}

/// Largest R-hat and fewest independent draws of chains that say something.
const MIXED: (f64, f64) = (1.01, 400.0);

impl Mixing {
    /// The fewer of both independent draws.
    #[must_use]
    pub fn independent_draws(&self) -> f64 {
        self.bulk_draws.min(self.tail_draws)
    }

    /// Whether the chains agree and are long enough.
    ///
    /// # Source
    /// Vehtari et al. (2021), Bayesian Anal. 16:667.
    #[must_use]
    pub fn suffices(&self) -> bool {
        self.r_hat <= MIXED.0 && self.independent_draws() >= MIXED.1
    }
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
