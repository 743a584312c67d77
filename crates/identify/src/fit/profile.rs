//! Profile likelihood: how far each parameter can move while the others follow.

use crate::fit::estimator::{Estimator, FreeLaw};
use crate::fit::interval::{FreeIntervals, IntervalDetail, ProfileCurve};
use windfall_numerics::least_squares::{Minimum, Options, Stop, minimise};

/// Accuracy of an end, as a part of the way to it; 1.
const END_ACCURACY: f64 = 2e-3;
/// Trials of an end.
const MOST_TRIALS: usize = 30;
/// Longest and shortest next trial relative to the last; 1.
const STRETCH: (f64, f64) = (0.3, 3.0);
/// Trials that fail are pulled back by this factor; 1.
const PULL_BACK: f64 = 0.5;

/// A side of the estimate.
#[derive(Clone, Copy, PartialEq)]
enum Side {
    Below,
    Above,
}

/// Ends of the interval of each free parameter: where −2 ln of the likelihood,
/// maximal over the other parameters, has risen by `quantile`².
///
/// * `minimum`: the estimate
/// * `deviations`, `covariance`: of the coordinates, for first trials
/// * `quantile`: of Student's distribution
///
/// # Numerics
/// √(rise) is nearly a straight line in the coordinate; its root is found by
/// secants, each trial a minimisation over the other parameters from where the
/// covariance expects them. A parameter that meets its bound first has an open
/// end there.
///
/// # Source
/// Venzon and Moolgavkar (1988), Appl. Statist. 37:87; Bates and Watts (1988),
/// Nonlinear Regression Analysis, sec. 6.1, for the statistic.
pub(crate) fn profile_intervals<L: FreeLaw<N>, const N: usize, const W: usize, const P: usize>(
    estimator: &Estimator<L, N, W, P>,
    minimum: &Minimum<P>,
    covariance: &[[f64; P]; P],
    quantile: f64,
    options: &Options<P>,
) -> FreeIntervals {
    let count = estimator.free().len();
    let mut intervals = FreeIntervals {
        low: Vec::new(),
        high: Vec::new(),
        sd: None,
        detail: IntervalDetail::Asymptotic,
    };
    let mut curves = Vec::new();
    for index in 0..count {
        let search = Search {
            estimator,
            minimum,
            covariance,
            quantile,
            options,
            index,
        };
        let coordinate = estimator.free()[index].coordinate;
        let below = search.end(Side::Below);
        let above = search.end(Side::Above);
        let mut points: Vec<(f64, f64)> = below.points;
        points.push((minimum.parameters[index], 0.0));
        points.extend(&above.points);
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        intervals.low.push(coordinate.value(below.at));
        intervals.high.push(coordinate.value(above.at));
        curves.push(ProfileCurve {
            values: points.iter().map(|p| coordinate.value(p.0)).collect(),
            rises: points.iter().map(|p| p.1).collect(),
            open_below: below.open,
            open_above: above.open,
        });
    }
    intervals.detail = IntervalDetail::Profile(curves);
    intervals
}

struct Search<'a, 'b, L, const N: usize, const W: usize, const P: usize> {
    estimator: &'a Estimator<'b, L, N, W, P>,
    minimum: &'a Minimum<P>,
    covariance: &'a [[f64; P]; P],
    quantile: f64,
    options: &'a Options<P>,
    index: usize,
}

/// An end with the points that led to it, in coordinates.
struct End {
    at: f64,
    open: bool,
    points: Vec<(f64, f64)>,
}

impl<L: FreeLaw<N>, const N: usize, const W: usize, const P: usize> Search<'_, '_, L, N, W, P> {
    fn end(&self, side: Side) -> End {
        let sign = if side == Side::Below { -1.0 } else { 1.0 };
        let centre = self.minimum.parameters[self.index];
        let bounds = self.estimator.bounds();
        let bound = match side {
            Side::Below => bounds.lower[self.index],
            Side::Above => bounds.upper[self.index],
        };
        let farthest = (bound - centre).abs();
        let sd = self.covariance[self.index][self.index].max(0.0).sqrt();
        let mut length = (self.quantile * sd).min(farthest);
        let mut end = End {
            at: centre + sign * length,
            open: true,
            points: Vec::new(),
        };
        if !(length > 0.0 && length.is_finite()) {
            end.at = centre;
            return end;
        }
        // Root of √rise = quantile, between what is too short and too long.
        let (mut short, mut long) = ((0.0, 0.0), (f64::INFINITY, f64::INFINITY));
        for _ in 0..MOST_TRIALS {
            let Some(rise) = self.rise(centre + sign * length) else {
                if length < long.0 {
                    long = (length, f64::INFINITY);
                }
                length = short.0 + PULL_BACK * (length - short.0);
                continue;
            };
            end.points.push((centre + sign * length, rise));
            end.at = centre + sign * length;
            let root = rise.max(0.0).sqrt();
            if (root / self.quantile - 1.0).abs() < END_ACCURACY {
                end.open = false;
                return end;
            }
            if root < self.quantile {
                if length >= farthest {
                    return end;
                }
                short = (length, root);
            } else {
                long = (length, root);
            }
            length = next_length(short, long, self.quantile).min(farthest);
        }
        end
    }

    /// Rise of −2 ln likelihood with the parameter held at `value`.
    fn rise(&self, value: f64) -> Option<f64> {
        let shift = value - self.minimum.parameters[self.index];
        let variance = self.covariance[self.index][self.index];
        let mut bounds = self.estimator.bounds();
        let mut start = self.minimum.parameters;
        for i in 0..self.estimator.free().len() {
            start[i] += self.covariance[i][self.index] / variance * shift;
        }
        start[self.index] = value;
        (bounds.lower[self.index], bounds.upper[self.index]) = (value, value);
        let held = minimise(&mut self.estimator.clone(), &start, &bounds, self.options);
        let usable = matches!(held.stop, Stop::Converged | Stop::Stuck);
        usable.then_some(held.equations.cost - self.minimum.equations.cost)
    }
}

/// Where the straight line through the nearest points meets the quantile.
fn next_length(short: (f64, f64), long: (f64, f64), quantile: f64) -> f64 {
    if long.1.is_finite() {
        let slope = (long.1 - short.1) / (long.0 - short.0);
        let at = short.0 + (quantile - short.1) / slope;
        // A curved profile must not stall the secants at one end.
        let margin = 0.02 * (long.0 - short.0);
        return at.clamp(short.0 + margin, long.0 - margin);
    }
    let stretch = (quantile / short.1).clamp(STRETCH.0, STRETCH.1);
    let longest = if long.0.is_finite() {
        0.5 * (short.0 + long.0)
    } else {
        f64::INFINITY
    };
    (short.0 * stretch).min(longest)
}
