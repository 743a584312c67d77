//! Profile-likelihood intervals of standard deviations and correlations.

use crate::population::linear::LinearProblem;
use crate::population::newton::minimise;
use crate::population::optimum::{Optimum, deviance};
use crate::population::variance::{Level, Variances, order_with};
use nalgebra::{DMatrix, DVector};

/// Smallest standard deviation in a start, in units of its scale.
const LEAST: f64 = 1e-6;
/// Correlations are followed up to this distance from ±1.
const EDGE: f64 = 1e-3;
/// Widest search for a standard deviation, as a factor of the estimate or of
/// its unit.
const WIDEST: f64 = 64.0;
/// Accuracy of an end, in standard errors.
const TOLERANCE: f64 = 1e-3;
/// Steps in the search of one end.
const MOST: usize = 40;

/// What an interval is made for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Quantity {
    /// Standard deviation of a parameter.
    Sd(usize),
    /// Correlation of two parameters.
    Correlation(usize, usize),
}

/// The likelihood with one quantity held, everything else at its best.
struct Profile<'a, const Q: usize> {
    problem: &'a LinearProblem<Q>,
    variances: Variances<Q>,
    best: DVector<f64>,
    lowest: f64,
    /// Position of the block's first parameter.
    block: usize,
    correlation: bool,
}

impl<const Q: usize> Profile<'_, Q> {
    /// θ = offset + map y with the quantity at `value`.
    fn subspace(&self, value: f64) -> (DVector<f64>, DMatrix<f64>) {
        let n = self.best.len();
        let mut offset = DVector::zeros(n);
        let mut map = DMatrix::zeros(n, n - 1);
        // The position that is given up: the standard deviation itself, or the
        // second row's first entry, which follows its length.
        let given = self.block + usize::from(self.correlation);
        for i in 0..n {
            if i != given {
                map[(i, i - usize::from(i > given))] = 1.0;
            }
        }
        if self.correlation {
            map[(given, given)] = value;
            map[(given + 1, given)] = (1.0 - value * value).sqrt();
        } else {
            offset[given] = value;
        }
        (offset, map)
    }

    /// Deviance above its minimum, and the best of the other parameters.
    fn rise(&self, value: f64, near: &DVector<f64>) -> Option<(f64, DVector<f64>)> {
        let (offset, map) = self.subspace(value);
        let pseudo = map.transpose() * &map;
        let start = pseudo
            .cholesky()?
            .solve(&(map.transpose() * (near - &offset)));
        let function = |y: &DVector<f64>| {
            let (value, gradient) = deviance(self.problem, &self.variances, &(&offset + &map * y))?;
            Some((value, map.transpose() * gradient))
        };
        let found = minimise(&function, &start)?;
        Some((found.value - self.lowest, offset + map * found.at))
    }

    /// Where the deviance has risen by `threshold` between the estimate and
    /// `edge`; `edge` itself where it has not risen so far.
    fn end(&self, from: f64, edge: f64, threshold: f64) -> Option<f64> {
        let height = |rise: f64| rise.max(0.0).sqrt() - threshold.sqrt();
        let (rise, _) = self.rise(edge, &self.best)?;
        if rise <= threshold {
            return Some(edge);
        }
        let (mut low, mut at_low) = (from, height(0.0));
        let (mut high, mut at_high) = (edge, height(rise));
        let mut near = self.best.clone();
        for _ in 0..MOST {
            let part = (-at_low / (at_high - at_low)).clamp(0.02, 0.98);
            let middle = low + part * (high - low);
            let (rise, best) = self.rise(middle, &near)?;
            near = best;
            let at = height(rise);
            if at.abs() < TOLERANCE {
                return Some(middle);
            }
            if at > 0.0 {
                (high, at_high) = (middle, at);
                at_low *= 0.7;
            } else {
                (low, at_low) = (middle, at);
                at_high *= 0.7;
            }
        }
        Some(0.5 * (low + high))
    }
}

/// Interval of `quantity` where the deviance has risen by `threshold`; `None`
/// where it cannot be computed, as for a correlation with something that does
/// not vary.
pub(crate) fn interval<const Q: usize>(
    problem: &LinearProblem<Q>,
    optimum: &Optimum<Q>,
    (level, quantity): (Level, Quantity),
    threshold: f64,
) -> Option<(f64, f64)> {
    let mut variances = optimum.variances;
    let factor = match level {
        Level::Between => &mut variances.between,
        Level::Within => &mut variances.within,
    };
    factor.order = match quantity {
        Quantity::Sd(k) => order_with(&[k]),
        Quantity::Correlation(k, l) => order_with(&[k, l]),
    };
    let scale = factor.scale;
    let best = variances.parameters(&optimum.between, &optimum.within, LEAST);
    let block = match level {
        Level::Between => 0,
        Level::Within => variances.between.count(),
    };
    let mut profile = Profile {
        problem,
        variances,
        best,
        lowest: optimum.minimum.value,
        block,
        correlation: false,
    };
    match quantity {
        Quantity::Sd(k) => {
            let estimate = profile.best[block].abs();
            profile.best[block] = estimate;
            let low = profile.end(estimate, 0.0, threshold)?;
            let mut edge = (2.0 * estimate).max(1e-2);
            let mut high = profile.end(estimate, edge, threshold)?;
            while high >= edge && edge < WIDEST * estimate.max(1.0) {
                edge *= 2.0;
                high = profile.end(estimate, edge, threshold)?;
            }
            let high = if high >= edge { f64::INFINITY } else { high };
            Some((scale[k] * low, scale[k] * high))
        }
        Quantity::Correlation(..) => {
            profile.correlation = true;
            let second = (profile.best[block + 1], profile.best[block + 2]);
            let length = second.0.hypot(second.1);
            let estimate = second.0 / length;
            if length < 10.0 * LEAST || profile.best[block].abs() < 10.0 * LEAST {
                return None;
            }
            let low = profile.end(estimate, -1.0 + EDGE, threshold)?;
            let high = profile.end(estimate, 1.0 - EDGE, threshold)?;
            let clip = |end: f64| {
                if end.abs() >= 1.0 - EDGE {
                    end.signum()
                } else {
                    end
                }
            };
            Some((clip(low), clip(high)))
        }
    }
}
