//! Profile likelihood intervals of standard deviations and correlations.

use crate::constraint::{Constrained, VarianceParameter};
use crate::error::MixedError;
use crate::finding::MixedFinding;
use crate::fit::{MixedFit, MixedMethod, MixedOptions, fit_mixed_model};
use rayon::prelude::*;
use std::cell::Cell;
use windfall_distribution::tail::normal_upper_quantile;
use windfall_numerics::root::bracketed_root;

/// Relative width of the bracket around the end of an interval.
const END_TOLERANCE: f64 = 1e-7;

/// A log-likelihood higher than that of the fit by more belongs to another maximum.
const HIGHER: f64 = 1e-3;

/// Doublings of the distance from the estimate before an upper end is given up.
const MOST_DOUBLINGS: usize = 40;

/// Profile interval of one standard deviation or correlation.
#[derive(Clone, Debug, PartialEq)]
pub struct ProfileInterval {
    /// Which.
    pub parameter: VarianceParameter,
    /// A name to print, as `sd of day, subject`.
    pub name: String,
    /// Estimate of the profiled likelihood, around which the interval is.
    pub estimate: f64,
    /// Lower end; 0 (or -1) where the likelihood does not fall far enough.
    pub low: f64,
    /// Upper end; 1 for a correlation whose likelihood does not fall far enough.
    pub high: f64,
}

/// Profile intervals, and what the reader should know.
#[derive(Clone, Debug, PartialEq)]
pub struct Profiles {
    /// Standard deviations and correlations of each term, then σ.
    pub intervals: Vec<ProfileInterval>,
    /// Ends that were not found.
    pub findings: Vec<MixedFinding>,
}

/// Profile intervals of all standard deviations and correlations.
///
/// The interval holds the values at which -2 log likelihood, minimised over all
/// other parameters, is at most χ²₁(confidence) above its minimum.
///
/// `likelihood` need not be that of the fit. lme4 profiles the plain likelihood, also
/// of fits by restricted likelihood. The restricted one puts the interval around
/// REML's estimates and holds the truth nearer to its stated rate where fixed effects
/// take up a good part of the groups.
///
/// # Errors
/// [`MixedError::NoCriterion`] if the model cannot be fitted by this likelihood;
/// [`MixedError::WrongConfidence`] unless 0 < confidence < 1.
///
/// # Source
/// Bates et al. (2015), J. Stat. Softw. 67(1), sec. 5.1; each end is found as a root
/// instead of by interpolation.
pub fn profile_variances(
    fit: &MixedFit,
    likelihood: MixedMethod,
    confidence: f64,
) -> Result<Profiles, MixedError> {
    if !(confidence > 0.0 && confidence < 1.0) {
        return Err(MixedError::WrongConfidence { confidence });
    }
    let refitted;
    let fit = if fit.method == likelihood {
        fit
    } else {
        let options = MixedOptions { method: likelihood };
        refitted = fit_mixed_model(fit.model.clone(), &options)?;
        &refitted
    };
    let z = normal_upper_quantile((1.0 - confidence) / 2.0);
    let parameters = parameters_of(fit);
    let found: Vec<(ProfileInterval, Vec<MixedFinding>)> = parameters
        .into_par_iter()
        .map(|parameter| interval(fit, parameter, z))
        .collect();
    let (intervals, findings): (Vec<_>, Vec<_>) = found.into_iter().unzip();
    Ok(Profiles {
        intervals,
        findings: findings.concat(),
    })
}

/// Signed roots of what -2 log (restricted) likelihood, minimised over all other parameters,
/// rises by where one parameter is held at `values`: below the estimate negative. NaN where the
/// model cannot be fitted with the value.
///
/// # Source
/// Bates et al. (2015), J. Stat. Softw. 67(1), sec. 5.1 (ζ of a profile).
pub fn profile_roots(fit: &MixedFit, own: &ProfileInterval, values: &[f64]) -> Vec<f64> {
    let constrained = Constrained::of(fit, own.parameter);
    let root = |value: &f64| {
        let rise = constrained.minimum(*value)? - fit.criterion;
        Some(rise.max(0.0).sqrt().copysign(value - own.estimate))
    };
    let roots = values
        .par_iter()
        .map(|value| root(value).unwrap_or(f64::NAN));
    roots.collect()
}

/// All standard deviations and correlations, in the order of lme4.
fn parameters_of(fit: &MixedFit) -> Vec<VarianceParameter> {
    let mut parameters = Vec::new();
    for (term, given) in fit.model.terms.iter().enumerate() {
        for first in 0..given.columns.len() {
            parameters.push(VarianceParameter::Sd {
                term,
                column: first,
            });
            if given.correlated {
                parameters.extend((first + 1..given.columns.len()).map(|second| {
                    VarianceParameter::Correlation {
                        term,
                        columns: [first, second],
                    }
                }));
            }
        }
    }
    let levels = 0..=fit.model.free_levels();
    parameters.extend(levels.map(|level| VarianceParameter::ResidualSd { level }));
    parameters
}

fn interval(
    fit: &MixedFit,
    parameter: VarianceParameter,
    z: f64,
) -> (ProfileInterval, Vec<MixedFinding>) {
    let constrained = Constrained::of(fit, parameter);
    let estimate = constrained.estimate;
    let name = constrained.name();
    let mut findings = Vec::new();
    let mut open = |side| {
        findings.push(MixedFinding::ProfileOpen {
            parameter: name.clone(),
            side,
        });
    };
    // signed root of what the deviance rises by
    let lowest_seen = Cell::new(fit.criterion);
    let rise = |value: f64| {
        let minimum = constrained.minimum(value).unwrap_or(f64::INFINITY);
        lowest_seen.set(lowest_seen.get().min(minimum));
        (minimum - fit.criterion).max(0.0).sqrt().min(1e8)
    };
    let (lowest, step, highest) = match parameter {
        VarianceParameter::Correlation { .. } => (-1.0, 0.25, 1.0),
        _ => (0.0, estimate.max(constrained.size()) * 0.5, f64::INFINITY),
    };
    let least = constrained.least();
    let low = if !estimate.is_finite() {
        lowest
    } else {
        let low = lower_end(&rise, estimate, least, z);
        if low > least { low } else { lowest }
    };
    let high = if estimate.is_finite() {
        upper_end(&rise, estimate, step, highest, z)
    } else {
        highest
    };
    if !estimate.is_finite() {
        open("lower");
    }
    if !high.is_finite() || !estimate.is_finite() {
        open("upper");
    }
    let rise = 0.5 * (fit.criterion - lowest_seen.get());
    if rise > HIGHER {
        findings.push(MixedFinding::HigherElsewhere {
            parameter: name.clone(),
            rise,
        });
    }
    let interval = ProfileInterval {
        parameter,
        estimate,
        low,
        high,
        name,
    };
    (interval, findings)
}

fn lower_end(rise: &dyn Fn(f64) -> f64, estimate: f64, lowest: f64, z: f64) -> f64 {
    if estimate <= lowest || rise(lowest) <= z {
        return lowest;
    }
    let tolerance = END_TOLERANCE * (estimate - lowest);
    bracketed_root(lowest, estimate, tolerance, |value| rise(value) - z)
}

fn upper_end(rise: &dyn Fn(f64) -> f64, estimate: f64, step: f64, highest: f64, z: f64) -> f64 {
    let mut low = estimate;
    let mut step = step;
    for _ in 0..MOST_DOUBLINGS {
        let high = (low + step).min(highest);
        if rise(high) >= z {
            let tolerance = END_TOLERANCE * (high - estimate);
            return bracketed_root(low, high, tolerance, |value| z - rise(value));
        }
        if high >= highest {
            return highest;
        }
        low = high;
        step *= 2.0;
    }
    f64::INFINITY
}
