//! Least squares of a relaxing force, with the covariance of its parameters.

use crate::correlated_scores::{
    add_product, add_scores, at_least, correlation_lag, inverse_of_free, sandwich, student,
};
use crate::fit::CompressionEstimate;
use windfall_numerics::least_squares::{LeastSquares, NormalEquations, Options};
use windfall_signal::noise::colour::persistence;

/// Parameters of the largest model.
pub(crate) const SIZE: usize = 7;

/// Parameters of a model; those that it lacks are zero.
pub(crate) type Parameters = [f64; SIZE];

/// A force over the time since the hold began, with its derivatives by the parameters.
pub(crate) trait Curve {
    fn force(&self, time: f64, parameters: &Parameters) -> (f64, Parameters);
}

/// Minimisation until the cost is known to its last digits: a model that leaves large residuals
/// converges slowly, and its parameters are known to the root of what the cost is.
pub(crate) fn options() -> Options<SIZE> {
    Options {
        cost_tolerance: 1e-15,
        ..Options::default()
    }
}

/// A model against samples.
pub(crate) struct Problem<'a, C> {
    pub curve: &'a C,
    pub times: &'a [f64],
    pub force: &'a [f64],
}

impl<C: Curve> LeastSquares<SIZE> for Problem<'_, C> {
    fn evaluate(&mut self, parameters: &Parameters) -> Option<NormalEquations<SIZE>> {
        let mut equations = NormalEquations::ZERO;
        for (time, force) in self.times.iter().zip(self.force) {
            let (model, slopes) = self.curve.force(*time, parameters);
            equations.add(1.0, model - force, &slopes);
        }
        equations.cost.is_finite().then_some(equations)
    }
}

/// What the residuals say of an estimate.
pub(crate) struct Spread {
    /// Covariance of the parameters; `None` where the samples do not determine them.
    pub covariance: Option<[[f64; SIZE]; SIZE]>,
    /// Factor from standard deviation to half an interval.
    pub quantile: f64,
    /// Root mean square residual; N.
    pub rms: f64,
    /// Samples over which residuals stay correlated.
    pub correlation_length: f64,
}

impl<C: Curve> Problem<'_, C> {
    /// Covariance at a minimum: Newey and West's, with variances not below those for a
    /// first-order autoregression of the residuals' persistence. Where few samples tell a
    /// parameter, as the first ones a fast element, the sum over lags alone is too small.
    ///
    /// * `free`: parameters that were estimated and are at no bound
    pub(crate) fn spread(&self, parameters: &Parameters, free: &[usize]) -> Spread {
        let rows: Vec<(f64, Parameters)> = self
            .times
            .iter()
            .zip(self.force)
            .map(|(time, force)| {
                let (model, slopes) = self.curve.force(*time, parameters);
                (model - force, slopes)
            })
            .collect();
        let residuals: Vec<f64> = rows.iter().map(|row| row.0).collect();
        let samples = residuals.len();
        let freedom = samples.saturating_sub(free.len()).max(1) as f64;
        let lag = correlation_lag(&residuals);
        let cost: f64 = residuals.iter().map(|own| own * own).sum();
        let mut bread = [[0.0; SIZE]; SIZE];
        for (_, slopes) in &rows {
            add_product(&mut bread, slopes, slopes, 1.0);
        }
        let scores: Vec<Parameters> = rows
            .iter()
            .map(|(residual, slopes)| slopes.map(|by| by * residual))
            .collect();
        let mut meat = [[0.0; SIZE]; SIZE];
        add_scores(&mut meat, &scores, lag);
        let variance = cost / freedom;
        let independent = inverse_of_free(&bread, free);
        let correlated = sandwich(&bread, &meat, free, samples as f64 / freedom);
        let phi = persistence(&residuals).unwrap_or(0.0).max(0.0);
        let lasting = lasting_scores(rows.iter().map(|row| row.1), phi);
        let lasting = sandwich(&bread, &lasting, free, variance);
        let all = correlated.zip(independent).zip(lasting);
        let covariance = all.map(|((correlated, independent), lasting)| {
            let least = |i: usize| (variance * independent[i][i]).max(lasting[i][i]);
            at_least(correlated, least)
        });
        Spread {
            covariance,
            quantile: student(freedom / lag as f64),
            rms: (cost / samples as f64).sqrt(),
            correlation_length: lag as f64,
        }
    }
}

/// Σᵢⱼ φ^|i−j| JᵢJⱼᵀ: what residuals of unit variance that are a first-order autoregression
/// make of the scores.
fn lasting_scores(slopes: impl Iterator<Item = Parameters>, phi: f64) -> [[f64; SIZE]; SIZE] {
    let mut sum = [[0.0; SIZE]; SIZE];
    let mut before = [0.0; SIZE];
    for own in slopes {
        add_product(&mut sum, &own, &own, 1.0);
        before = before.map(|last| phi * last);
        add_product(&mut sum, &own, &before, 1.0);
        add_product(&mut sum, &before, &own, 1.0);
        for (last, slope) in before.iter_mut().zip(own) {
            *last += slope;
        }
    }
    sum
}

impl Spread {
    /// A function of the parameters with its uncertainty, which follows from its slopes.
    pub(crate) fn estimate(
        &self,
        parameters: &Parameters,
        free: &[usize],
        of: impl Fn(&Parameters) -> f64,
    ) -> CompressionEstimate {
        let value = of(parameters);
        let slope = |i: usize| {
            let step = 1e-5 * parameters[i].abs().max(1e-3);
            let (mut above, mut below) = (*parameters, *parameters);
            above[i] += step;
            below[i] -= step;
            (of(&above) - of(&below)) / (2.0 * step)
        };
        let slopes: Vec<(usize, f64)> = free.iter().map(|&i| (i, slope(i))).collect();
        let variance = self.covariance.map(|covariance| {
            let all = slopes
                .iter()
                .flat_map(|a| slopes.iter().map(move |b| (a, b)));
            all.map(|((i, a), (j, b))| a * covariance[*i][*j] * b)
                .sum::<f64>()
        });
        let sd = match variance {
            Some(variance) if variance >= 0.0 => variance.sqrt(),
            _ => f64::INFINITY,
        };
        CompressionEstimate {
            value,
            sd,
            low: value - self.quantile * sd,
            high: value + self.quantile * sd,
        }
    }
}
