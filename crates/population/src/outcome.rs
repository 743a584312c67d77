//! A population as it is saved and shown.

use serde::{Deserialize, Serialize};
use windfall_files::found::{FailureOutcome, FindingOutcome};
use windfall_identify::fit::interval::independent_draws;
use windfall_identify::population::model::{FixedEffect, PopulationFit, Spread, Variation};
use windfall_identify::population::posterior::{PopulationPosterior, PosteriorRange};
use windfall_identify::population::two_stage::TwoStage;

/// A number with its interval, where there is one.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, utoipa::ToSchema, Deserialize)]
pub struct RangeOutcome {
    /// Estimate.
    pub value: f64,
    /// Lower end; none where it cannot be computed.
    pub low: Option<f64>,
    /// Upper end; none where there is no bound.
    pub high: Option<f64>,
}

/// One parameter of the law over the fruit.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema, Deserialize)]
pub struct PopulationParameter {
    /// Name.
    pub name: String,
    /// Unit of its median.
    pub unit: String,
    /// "logarithm" where deviations are those of ln, "value" for exponents.
    pub scale: String,
    /// Median fruit at the centre of all covariates; SI.
    pub median: RangeOutcome,
    /// Standard deviation between fruit, on the scale; a profile interval.
    pub between: RangeOutcome,
    /// Standard deviation of the impacts of one fruit.
    pub within: RangeOutcome,
}

/// Correlation of two parameters.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema, Deserialize)]
pub struct PopulationCorrelation {
    /// One parameter.
    pub first: String,
    /// The other.
    pub second: String,
    /// Between fruit.
    pub between: RangeOutcome,
    /// Of the impacts of one fruit.
    pub within: RangeOutcome,
}

/// Effect of a covariate on a parameter.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema, Deserialize)]
pub struct PopulationEffect {
    /// The covariate.
    pub covariate: String,
    /// Its value at the median.
    pub centre: f64,
    /// The parameter.
    pub parameter: String,
    /// Change of the parameter on its scale per unit of the covariate.
    pub effect: f64,
    /// Standard error.
    pub se: f64,
    /// Degrees of freedom.
    pub df: f64,
    /// Lower end of the t interval.
    pub low: f64,
    /// Upper end.
    pub high: f64,
    /// Probability of such an effect if there were none.
    pub p: f64,
}

/// The usual way: fit each impact, average per fruit, regress all fits.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema, Deserialize)]
pub struct TwoStageOutcome {
    /// Exponential of the mean of the averages (mean of exponents).
    pub medians: Vec<RangeOutcome>,
    /// Standard deviations of the averages.
    pub between: Vec<RangeOutcome>,
    /// Correlations of the averages.
    pub correlations: Vec<f64>,
    /// Least squares over all impacts as if they were independent.
    pub effects: Vec<PopulationEffect>,
}

/// The posterior, next to the estimate.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema, Deserialize)]
pub struct PopulationPosteriorOutcome {
    /// Medians of the parameters over fruit: median of the draws, interval between
    /// their quantiles; SI.
    pub medians: Vec<RangeOutcome>,
    /// Standard deviations between fruit, in the order of the parameters.
    pub between: Vec<RangeOutcome>,
    /// Those of the impacts of one fruit; empty where each has one impact.
    pub within: Vec<RangeOutcome>,
    /// Correlations between fruit, in the order of the pairs.
    pub between_correlations: Vec<RangeOutcome>,
    /// Those of the impacts of one fruit.
    pub within_correlations: Vec<RangeOutcome>,
    /// Effects of covariates, in the order of the estimated ones.
    pub effects: Vec<RangeOutcome>,
    /// Chains.
    pub chains: usize,
    /// Draws of each.
    pub draws: usize,
    /// Their seed.
    pub seed: u64,
    /// Largest spread of all chains over that within chains.
    pub largest_r_hat: f64,
    /// Fewest independent draws.
    pub fewest_draws: f64,
    /// Draws at which the sampler diverged.
    pub divergences: usize,
}

/// The population in numbers alone, as a law card carries it.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema, Deserialize)]
pub struct Population {
    /// Names of the parameters that vary.
    pub parameters: Vec<String>,
    /// Whether deviations of each are those of ln.
    pub logarithmic: Vec<bool>,
    /// Median fruit at the centre of all covariates; SI.
    pub median: Vec<f64>,
    /// Covariance of the medians' estimates, on the scale of the deviations.
    pub median_covariance: Vec<Vec<f64>>,
    /// Covariance between fruit, on the scale of the deviations.
    pub between: Vec<Vec<f64>>,
    /// Covariance of the impacts of one fruit.
    pub within: Vec<Vec<f64>>,
    /// Effects of covariates.
    pub covariates: Vec<CovariateEffect>,
    /// Fruit.
    pub fruits: usize,
    /// Impacts.
    pub impacts: usize,
    /// How it was estimated.
    pub method: String,
}

/// One covariate of a [`Population`].
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema, Deserialize)]
pub struct CovariateEffect {
    /// Its name.
    pub name: String,
    /// Its value at the median.
    pub centre: f64,
    /// Change of each parameter on its scale per unit.
    pub effects: Vec<f64>,
    /// Their standard errors.
    pub sds: Vec<f64>,
}

/// The result of `windfall population`.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema, Deserialize)]
pub struct PopulationOutcome {
    /// Version of windfall.
    pub windfall: String,
    /// Title of the campaign.
    pub campaign: String,
    /// Label where the recordings are simulated.
    pub simulated: Option<String>,
    /// The law.
    pub law: String,
    /// How it was estimated.
    pub method: String,
    /// Fruit with a usable impact.
    pub fruits: usize,
    /// Impacts that took part.
    pub impacts: usize,
    /// Parameters.
    pub parameters: Vec<PopulationParameter>,
    /// Correlations of all pairs.
    pub correlations: Vec<PopulationCorrelation>,
    /// Effects of covariates.
    pub effects: Vec<PopulationEffect>,
    /// The usual way beside it.
    pub two_stage: TwoStageOutcome,
    /// The posterior, if requested.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schema(nullable = false)]
    pub posterior: Option<PopulationPosteriorOutcome>,
    /// Log-likelihood.
    pub log_likelihood: f64,
    /// Largest difference to a single linearisation at the fits; standard errors.
    pub shift_from_fits: f64,
    /// Largest difference to the first-order linearisation; standard errors.
    pub shift_from_first_order: f64,
    /// Whether the estimates settled.
    pub converged: bool,
    /// Most probable parameters of each fruit at the centre; SI.
    pub fruit: Vec<FruitOutcome>,
    /// The population in numbers alone.
    pub population: Population,
    /// Impacts that could not take part.
    pub failed: Vec<FailureOutcome>,
    /// What a reader must know.
    pub findings: Vec<FindingOutcome>,
}

/// One fruit.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema, Deserialize)]
pub struct FruitOutcome {
    /// Its id.
    pub specimen: String,
    /// Its impacts.
    pub impacts: usize,
    /// Its parameters; SI.
    pub parameters: Vec<f64>,
}

/// A parameter that varies between fruit.
#[derive(Clone, Debug, PartialEq)]
pub struct Varying {
    /// Name.
    pub name: String,
    /// Unit.
    pub unit: String,
    /// Whether φ is its logarithm.
    pub logarithmic: bool,
}

impl Varying {
    /// Its value at φ.
    pub fn value(&self, phi: f64) -> f64 {
        match self.logarithmic {
            true => phi.exp(),
            false => phi,
        }
    }

    fn range(&self, value: f64, (low, high): (f64, f64)) -> RangeOutcome {
        RangeOutcome {
            value: self.value(value),
            low: finite(self.value(low)),
            high: finite(self.value(high)),
        }
    }
}

fn finite(value: f64) -> Option<f64> {
    value.is_finite().then_some(value)
}

fn range(spread: &Spread) -> RangeOutcome {
    RangeOutcome {
        value: spread.value,
        low: spread.interval.and_then(|(low, _)| finite(low)),
        high: spread.interval.and_then(|(_, high)| finite(high)),
    }
}

/// The parameters, their correlations and the effects on them.
pub fn parameters_of(fit: &PopulationFit, varying: &[Varying]) -> Vec<PopulationParameter> {
    let medians: Vec<&FixedEffect> = fit
        .effects
        .iter()
        .filter(|e| e.covariate.is_none())
        .collect();
    let own = varying.iter().enumerate();
    own.map(|(k, parameter)| PopulationParameter {
        name: parameter.name.clone(),
        unit: parameter.unit.clone(),
        scale: match parameter.logarithmic {
            true => "logarithm".to_owned(),
            false => "value".to_owned(),
        },
        median: parameter.range(medians[k].value, (medians[k].low, medians[k].high)),
        between: range(&fit.between.sds[k]),
        within: range(&fit.within.sds[k]),
    })
    .collect()
}

/// Correlations of all pairs.
pub fn correlations_of(fit: &PopulationFit) -> Vec<PopulationCorrelation> {
    let size = fit.parameters.len();
    let pairs = (0..size).flat_map(|k| (k + 1..size).map(move |l| (k, l)));
    let of = |variation: &Variation, i: usize| range(&variation.correlations[i]);
    pairs
        .enumerate()
        .map(|(i, (k, l))| PopulationCorrelation {
            first: fit.parameters[k].clone(),
            second: fit.parameters[l].clone(),
            between: of(&fit.between, i),
            within: of(&fit.within, i),
        })
        .collect()
}

/// Effects of covariates, with their centres.
pub fn effects_of(effects: &[FixedEffect], covariates: &[(String, f64)]) -> Vec<PopulationEffect> {
    let of = |effect: &FixedEffect| {
        let name = effect.covariate.as_ref()?;
        let centre = covariates.iter().find(|(known, _)| known == name)?.1;
        Some(PopulationEffect {
            covariate: name.clone(),
            centre,
            parameter: effect.parameter.clone(),
            effect: effect.value,
            se: effect.se,
            df: effect.df,
            low: effect.low,
            high: effect.high,
            p: effect.p,
        })
    };
    effects.iter().filter_map(of).collect()
}

/// The usual way, on the scales of people.
pub fn two_stage_outcome(
    stages: &TwoStage,
    varying: &[Varying],
    covariates: &[(String, f64)],
) -> TwoStageOutcome {
    let medians = stages.means.iter().zip(varying);
    TwoStageOutcome {
        medians: medians
            .map(|(mean, parameter)| {
                let (low, high) = mean.interval.unwrap_or((f64::NAN, f64::NAN));
                parameter.range(mean.value, (low, high))
            })
            .collect(),
        between: stages.sds.iter().map(range).collect(),
        correlations: stages.correlations.clone(),
        effects: effects_of(&stages.effects, covariates),
    }
}

/// The posterior on the scales of people.
pub fn posterior_outcome(
    posterior: &PopulationPosterior,
    fit: &PopulationFit,
    varying: &[Varying],
) -> PopulationPosteriorOutcome {
    let plain = |range: &PosteriorRange| RangeOutcome {
        value: range.median,
        low: finite(range.low),
        high: finite(range.high),
    };
    let all = |ranges: &[PosteriorRange]| ranges.iter().map(plain).collect::<Vec<_>>();
    let effects = fit.effects.iter().zip(&posterior.effects);
    let medians = effects
        .clone()
        .filter(|(effect, _)| effect.covariate.is_none());
    let rest = effects.filter(|(effect, _)| effect.covariate.is_some());
    let mixing = || posterior.ranges().map(|range| range.mixing);
    PopulationPosteriorOutcome {
        medians: medians
            .zip(varying)
            .map(|((_, range), parameter)| parameter.range(range.median, (range.low, range.high)))
            .collect(),
        between: all(&posterior.between.sds),
        within: all(&posterior.within.sds),
        between_correlations: all(&posterior.between.correlations),
        within_correlations: all(&posterior.within.correlations),
        effects: rest.map(|(_, range)| plain(range)).collect(),
        chains: posterior.drawing.chains,
        draws: posterior.drawing.draws,
        seed: posterior.drawing.seed,
        largest_r_hat: mixing().map(|m| m.r_hat).fold(1.0, f64::max),
        fewest_draws: mixing()
            .map(|m| independent_draws(&m))
            .fold(f64::INFINITY, f64::min),
        divergences: posterior.divergences,
    }
}

/// The population in numbers alone.
pub fn population_of(fit: &PopulationFit, varying: &[Varying], method: &str) -> Population {
    let of = |name: Option<&String>| {
        let own = fit
            .effects
            .iter()
            .filter(move |e| e.covariate.as_ref() == name);
        own.collect::<Vec<_>>()
    };
    let medians = of(None);
    let covariates = fit.covariates.iter().map(|(name, centre)| CovariateEffect {
        name: name.clone(),
        centre: *centre,
        effects: of(Some(name)).iter().map(|e| e.value).collect(),
        sds: of(Some(name)).iter().map(|e| e.se).collect(),
    });
    Population {
        parameters: fit.parameters.clone(),
        logarithmic: varying.iter().map(|v| v.logarithmic).collect(),
        median: varying
            .iter()
            .zip(&medians)
            .map(|(v, e)| v.value(e.value))
            .collect(),
        median_covariance: medians_covariance(fit),
        between: fit.between.covariance.clone(),
        within: fit.within.covariance.clone(),
        covariates: covariates.collect(),
        fruits: fit.fruit.len(),
        impacts: fit.impacts.len(),
        method: method.to_owned(),
    }
}

/// Rows and columns of the effects' covariance that are those of the medians.
fn medians_covariance(fit: &PopulationFit) -> Vec<Vec<f64>> {
    let effects = fit.effects.iter().enumerate();
    let medians: Vec<usize> = effects
        .filter(|(_, effect)| effect.covariate.is_none())
        .map(|(at, _)| at)
        .collect();
    let row = |i: &usize| {
        medians
            .iter()
            .map(|&j| fit.effects_covariance[*i][j])
            .collect()
    };
    medians.iter().map(row).collect()
}
