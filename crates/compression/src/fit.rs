//! A law fitted to slow compressions, with the first touch as a nuisance.
//!
//! One law is fitted to one loading curve or to several together, such as
//! compressions of one fruit at several rates; every curve has a first touch of
//! its own.

use crate::correlated_scores::{
    add_product, add_scores, at_least, correlation_lag, inverse_of_free, quadratic, sandwich,
    student,
};
pub use crate::problem::LoadingCurve;
use crate::problem::{Problem, SIZE};
use windfall_contact::expression::LawExpression;
use windfall_contact::laws::any_law::{AnyLaw, LARGEST_PARAMETERS};
use windfall_contact::laws::kind::{Law, LawKind};
use windfall_numerics::least_squares::{Bounds, LeastSquares, Minimum, Options, Stop, minimise};

/// One estimate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CompressionEstimate {
    /// Value; SI.
    pub value: f64,
    /// Standard deviation, with residuals as correlated as they are; SI.
    /// Infinite where the curves do not determine the value.
    pub sd: f64,
    /// Lower end of the 95 % interval; SI.
    pub low: f64,
    /// Upper end of the 95 % interval; SI.
    pub high: f64,
}

/// A law fitted to loading curves.
#[derive(Clone, Debug, PartialEq)]
pub struct CompressionFit {
    /// The law.
    pub law: Law,
    /// One per parameter of the law; `None` where it was held.
    pub parameters: Vec<Option<CompressionEstimate>>,
    /// First touch of each curve, on its axis of deformation; m.
    pub touches: Vec<CompressionEstimate>,
    /// Root mean square residual; N.
    pub rms: f64,
    /// Samples over which the residuals stay correlated; 1 for white noise.
    pub correlation_length: f64,
    /// Samples, of all curves.
    pub samples: usize,
    /// Whether the minimum was found.
    pub converged: bool,
}

/// Why there is no fit.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum CompressionFitError {
    /// A law that a loading curve does not determine.
    #[error(
        "a loading curve does not determine the parameters of {law}; choose {}",
        suited_laws()
    )]
    LawUnsuited {
        /// The law.
        law: &'static str,
    },
    /// Fewer samples than are needed.
    #[error(
        "{samples} samples in the fitted range cannot determine {parameters} free parameters; \
         widen the range with `fit_to` in [compression]"
    )]
    TooFewSamples {
        /// Samples.
        samples: usize,
        /// Free parameters.
        parameters: usize,
    },
    /// The minimiser could not begin.
    #[error("{law} cannot be fitted to this curve: the force does not rise with deformation")]
    NoStart {
        /// The law.
        law: &'static str,
    },
}

/// The laws that a loading curve determines, as a choice.
fn suited_laws() -> String {
    let suited = LawKind::ALL.iter().map(|kind| kind.describe());
    let mut names: Vec<_> = suited
        .filter(|law| law.from_compression)
        .map(|law| law.name)
        .collect();
    let last = names.pop().unwrap_or_default();
    format!("{} or {last}", names.join(", "))
}

/// Parts of the force at the end of the fastest curve that damping is taken to
/// have at the start: with two terms of the force the cost has several minima.
const DAMPED_PARTS: [f64; 3] = [0.01, 0.3, 0.7];

/// Fits a law to loading curves.
///
/// * `expression`: parameters with a value are held there, and defaults unless
///   they are named in `free`
///
/// # Numerics
/// Least squares of the force. Each curve's first touch is eliminated: found
/// for every set of parameters, and its row and column taken out of the normal
/// equations. Standard deviations come from the sandwich of the normal matrix
/// with the covariance of the scores, summed over lags with Bartlett weights,
/// since the residuals of a smooth curve are not independent.
///
/// # Source
/// Golub and Pereyra (1973), SIAM J. Numer. Anal. 10:413, for elimination;
/// Newey and West (1987), Econometrica 55:703, for the covariance.
///
/// # Errors
/// See [`CompressionFitError`].
pub fn fit_compression(
    curves: &[LoadingCurve],
    expression: &LawExpression,
    free: &[String],
) -> Result<CompressionFit, CompressionFitError> {
    let kind = expression.kind;
    if !kind.describe().from_compression {
        return Err(CompressionFitError::LawUnsuited { law: kind.name() });
    }
    let held = held_values(expression, free);
    let parameters = held.iter().filter(|value| value.is_none()).count() + curves.len();
    let samples = curves.iter().map(|curve| curve.force.len()).sum();
    if samples <= 2 * parameters {
        return Err(CompressionFitError::TooFewSamples {
            samples,
            parameters,
        });
    }
    let mut problem = Problem::new(kind, curves, &held);
    let no_start = CompressionFitError::NoStart { law: kind.name() };
    let start = problem.start(&held).ok_or(no_start)?;
    let bounds = bounds(kind, &held);
    let touches = problem.touches.clone();
    let minima = DAMPED_PARTS.map(|part| {
        problem.touches.clone_from(&touches);
        let start = problem.refined(problem.damped(&start, part), &held);
        minimise(&mut problem, &start, &bounds, &Options::default())
    });
    let cost = |minimum: &Minimum<LARGEST_PARAMETERS>| match minimum.stop {
        Stop::BadStart => f64::INFINITY,
        _ => minimum.equations.cost,
    };
    let best = minima.iter().min_by(|a, b| cost(a).total_cmp(&cost(b)));
    let minimum = *best.unwrap_or(&minima[0]);
    problem.touches = touches;
    problem.evaluate(&minimum.parameters);
    problem.evaluate(&minimum.parameters);
    let law = kind
        .from_values(&minimum.parameters[..kind.describe().parameters.len()])
        .ok_or(CompressionFitError::NoStart { law: kind.name() })?;
    Ok(report(&problem, law, minimum.stop))
}

/// The values that are held; `None` for those that are estimated.
fn held_values(expression: &LawExpression, free: &[String]) -> Vec<Option<f64>> {
    let parameters = expression.kind.describe().parameters.iter();
    parameters
        .enumerate()
        .map(|(i, parameter)| {
            let given = expression.values.get(i).copied().flatten();
            let default = given.or(parameter.default);
            default.filter(|_| !free.iter().any(|name| name == parameter.name))
        })
        .collect()
}

fn bounds(kind: LawKind, held: &[Option<f64>]) -> Bounds<LARGEST_PARAMETERS> {
    let mut bounds = Bounds::NONE;
    for (i, parameter) in kind.describe().parameters.iter().enumerate() {
        (bounds.lower[i], bounds.upper[i]) = match held[i] {
            Some(value) => (value, value),
            None => (parameter.lower, parameter.upper),
        };
    }
    bounds
}

/// Covariance of parameters and touches.
fn report(problem: &Problem, law: Law, stop: Stop) -> CompressionFit {
    let any = AnyLaw(law);
    let free: Vec<usize> = (0..problem.estimated.len())
        .filter(|&i| problem.estimated[i])
        .collect();
    let curves = problem.curves;
    let samples: usize = curves.iter().map(|curve| curve.force.len()).sum();
    let freedom = samples.saturating_sub(free.len() + curves.len()).max(1);
    let mut bread = [[0.0; LARGEST_PARAMETERS]; LARGEST_PARAMETERS];
    let mut meat = bread;
    let (mut cost, mut longest) = (0.0, 1.0_f64);
    let mut touch_parts = Vec::new();
    for (index, curve) in curves.iter().enumerate() {
        let rows: Vec<(f64, [f64; SIZE])> = (0..curve.force.len())
            .map(|i| problem.row(&any, curve, i, problem.touches[index]))
            .collect();
        let residuals: Vec<f64> = rows.iter().map(|(residual, _)| *residual).collect();
        let lag = correlation_lag(&residuals);
        longest = longest.max(lag as f64);
        cost += residuals.iter().map(|r| r * r).sum::<f64>();
        // Derivatives by the parameters with the touch following them.
        let touch: f64 = rows.iter().map(|(_, row)| row[SIZE - 1].powi(2)).sum();
        let mut following = [0.0; LARGEST_PARAMETERS];
        for (i, cell) in following.iter_mut().enumerate() {
            let cross: f64 = rows.iter().map(|(_, row)| row[i] * row[SIZE - 1]).sum();
            *cell = cross / touch;
        }
        let without_touch = |row: &[f64; SIZE]| -> [f64; LARGEST_PARAMETERS] {
            std::array::from_fn(|i| row[i] - following[i] * row[SIZE - 1])
        };
        let scores: Vec<[f64; LARGEST_PARAMETERS]> = rows
            .iter()
            .map(|(residual, row)| without_touch(row).map(|by| by * residual))
            .collect();
        for (_, row) in &rows {
            let own = without_touch(row);
            add_product(&mut bread, &own, &own, 1.0);
        }
        add_scores(&mut meat, &scores, lag);
        let own: Vec<[f64; 1]> = rows.iter().map(|(r, row)| [r * row[SIZE - 1]]).collect();
        let mut spread = [[0.0; 1]; 1];
        add_scores(&mut spread, &own, lag);
        touch_parts.push((following, spread[0][0] / (touch * touch)));
    }
    let scale = samples as f64 / freedom as f64;
    let variance = cost / freedom as f64;
    let independent = inverse_of_free(&bread, &free);
    let covariance = sandwich(&bread, &meat, &free, scale).zip(independent);
    let covariance = covariance
        .map(|(correlated, independent)| at_least(correlated, |i| variance * independent[i][i]));
    let quantile = student(freedom as f64 / longest);
    let estimate = |value: f64, variance: Option<f64>| {
        let sd = variance
            .filter(|v| *v >= 0.0)
            .map_or(f64::INFINITY, f64::sqrt);
        CompressionEstimate {
            value,
            sd,
            low: value - quantile * sd,
            high: value + quantile * sd,
        }
    };
    let values = law.parameters();
    let parameters = values.iter().enumerate().map(|(i, value)| {
        let free = problem.estimated[i];
        free.then(|| estimate(*value, covariance.map(|c| c[i][i])))
    });
    let touches = problem
        .touches
        .iter()
        .zip(&touch_parts)
        .map(|(touch, (following, own))| {
            let carried = covariance.map(|c| quadratic(&c, following));
            estimate(*touch, carried.map(|carried| carried + scale * own))
        });
    CompressionFit {
        law,
        parameters: parameters.collect(),
        touches: touches.collect(),
        rms: (cost / samples as f64).sqrt(),
        correlation_length: longest,
        samples,
        converged: stop == Stop::Converged,
    }
}
