//! The line of laws that give the same features: where features are fewer than
//! free parameters, the null direction of their derivatives is followed.

use nalgebra::{DMatrix, DVector};
use windfall_identify::error::Error;

/// How a line is followed.
#[derive(Clone, Debug, PartialEq)]
pub struct FamilyOptions {
    /// Lowest coordinates.
    pub low: Vec<f64>,
    /// Highest coordinates.
    pub high: Vec<f64>,
    /// Length of a step, in ranges of the coordinates.
    pub step: f64,
    /// Most points to either side.
    pub points: usize,
}

/// Residuals and their derivatives at coordinates.
pub type FamilyModel<'a> = dyn FnMut(&[f64]) -> Result<(DVector<f64>, DMatrix<f64>), Error> + 'a;

/// Steps of Gauss-Newton at most.
const CORRECTIONS: usize = 30;
/// A correction below this part of the ranges is none.
const SETTLED: f64 = 1e-11;
/// What a correction may settle at when rounding lets it go no further.
const NEARLY: f64 = 1e-7;
/// Shortest step, in parts of the first.
const SHORTEST: f64 = 1e-3;

/// Points of the line through `start`, in order along it; both ends are on a
/// limit, or where it ends.
///
/// Predictor and corrector: a step along the null direction, then Gauss-Newton
/// steps at right angles to it.
///
/// # Errors
/// The model cannot be evaluated at the start.
///
/// # Source
/// Allgower and Georg (2003), Introduction to Numerical Continuation Methods,
/// chapter 2.
pub fn trace_family(
    model: &mut FamilyModel,
    start: &[f64],
    options: &FamilyOptions,
) -> Result<Vec<Vec<f64>>, Error> {
    let (_, jacobian) = model(start)?;
    let tangent = null_direction(&jacobian, options);
    let mut line = follow(model, start, &-&tangent, options);
    line.reverse();
    line.push(start.to_vec());
    line.extend(follow(model, start, &tangent, options));
    Ok(line)
}

/// The point of the line at a value of one coordinate, from a point nearby.
///
/// # Errors
/// The model cannot be evaluated at the start. `None` where the line has no such
/// point.
pub fn family_point(
    model: &mut FamilyModel,
    near: &[f64],
    (place, value): (usize, f64),
    options: &FamilyOptions,
) -> Result<Option<Vec<f64>>, Error> {
    model(near)?;
    let mut normal = DVector::zeros(near.len());
    normal[place] = 1.0;
    // In several moves: far from the line a Gauss-Newton step may overshoot.
    let moves = 8;
    let mut point = near.to_vec();
    for step in 1..=moves {
        let from = near[place];
        let mut guess = point.clone();
        guess[place] = from + (value - from) * f64::from(step) / f64::from(moves);
        match corrected(model, &guess, &normal, options) {
            Some(found) => point = found,
            None => return Ok(None),
        }
    }
    Ok(Some(point))
}

fn ranges(options: &FamilyOptions) -> DVector<f64> {
    let pairs = options.low.iter().zip(&options.high);
    DVector::from_iterator(
        options.low.len(),
        pairs.map(|(low, high)| (high - low).max(f64::MIN_POSITIVE)),
    )
}

/// Unit null direction in ranges of the coordinates.
fn null_direction(jacobian: &DMatrix<f64>, options: &FamilyOptions) -> DVector<f64> {
    let count = jacobian.ncols();
    let range = ranges(options);
    // Rows of zeros: without them the decomposition leaves the null vector out.
    let mut scaled = DMatrix::zeros(jacobian.nrows().max(count), count);
    for row in 0..jacobian.nrows() {
        for column in 0..count {
            scaled[(row, column)] = jacobian[(row, column)] * range[column];
        }
    }
    let decomposed = scaled.svd(false, true);
    let least = decomposed.singular_values.imin();
    match decomposed.v_t {
        Some(vectors) => vectors.row(least).transpose(),
        None => DVector::from_element(count, 1.0 / (count as f64).sqrt()),
    }
}

fn follow(
    model: &mut FamilyModel,
    start: &[f64],
    tangent: &DVector<f64>,
    options: &FamilyOptions,
) -> Vec<Vec<f64>> {
    let range = ranges(options);
    let mut line = Vec::new();
    let (mut point, mut tangent) = (start.to_vec(), tangent.clone());
    let mut step = options.step;
    while line.len() < options.points {
        let mut guess = point.clone();
        for place in 0..guess.len() {
            guess[place] += step * tangent[place] * range[place];
        }
        let normal = tangent.component_div(&range);
        let found = corrected(model, &guess, &normal, options)
            .and_then(|found| model(&found).ok().map(|(_, jacobian)| (found, jacobian)));
        let Some((found, jacobian)) = found else {
            step *= 0.5;
            if step < SHORTEST * options.step {
                break;
            }
            continue;
        };
        if outside(&found, options).is_some() {
            line.extend(end_on_limit(model, &point, &found, options));
            break;
        }
        let next = null_direction(&jacobian, options);
        tangent = if next.dot(&tangent) < 0.0 {
            -next
        } else {
            next
        };
        line.push(found.clone());
        point = found;
        step = (1.5 * step).min(options.step);
    }
    line
}

/// Where the line leaves the limits between a point within and one beyond.
fn end_on_limit(
    model: &mut FamilyModel,
    inside: &[f64],
    beyond: &[f64],
    options: &FamilyOptions,
) -> Option<Vec<f64>> {
    let mut limit = outside(beyond, options)?;
    // The line may leave by another coordinate before this one.
    for _ in 0..inside.len() {
        let end = family_point(model, inside, limit, options).ok()??;
        match outside(&end, options).filter(|_| outside_by(&end, options) > 1e-9) {
            Some(other) => limit = other,
            None => return Some(end),
        }
    }
    None
}

/// The coordinate that is farthest outside, with its limit.
fn outside(point: &[f64], options: &FamilyOptions) -> Option<(usize, f64)> {
    let range = ranges(options);
    let beyond = |place: usize| {
        let low = (options.low[place] - point[place]) / range[place];
        let high = (point[place] - options.high[place]) / range[place];
        match low > high {
            true => (low, options.low[place]),
            false => (high, options.high[place]),
        }
    };
    let worst = (0..point.len()).max_by(|a, b| beyond(*a).0.total_cmp(&beyond(*b).0))?;
    let (by, limit) = beyond(worst);
    (by > 0.0).then_some((worst, limit))
}

fn outside_by(point: &[f64], options: &FamilyOptions) -> f64 {
    let range = ranges(options);
    let by = (0..point.len()).map(|place| {
        let low = options.low[place] - point[place];
        let high = point[place] - options.high[place];
        low.max(high) / range[place]
    });
    by.fold(f64::NEG_INFINITY, f64::max)
}

/// Gauss-Newton steps of which none has a part along `normal`.
fn corrected(
    model: &mut FamilyModel,
    guess: &[f64],
    normal: &DVector<f64>,
    options: &FamilyOptions,
) -> Option<Vec<f64>> {
    let range = ranges(options);
    let count = guess.len();
    let mut point = guess.to_vec();
    let mut last = f64::INFINITY;
    for _ in 0..CORRECTIONS {
        let (residuals, jacobian) = model(&point).ok()?;
        let rows = residuals.len();
        // The row of the normal weighs as much as the largest: it is met exactly
        // where the features can be met at all.
        let mut bordered = DMatrix::zeros(rows + 1, count);
        let mut right = DVector::zeros(rows + 1);
        for row in 0..rows {
            right[row] = -residuals[row];
            for column in 0..count {
                bordered[(row, column)] = jacobian[(row, column)] * range[column];
            }
        }
        let weight = 1e6 * bordered.amax().max(1.0);
        let unit = normal.component_mul(&range);
        let unit = &unit / unit.norm();
        for column in 0..count {
            bordered[(rows, column)] = weight * unit[column];
        }
        let step = bordered.svd(true, true).solve(&right, 1e-15).ok()?;
        let size = step.amax();
        if !size.is_finite() || size > 1.0 {
            return None;
        }
        for place in 0..count {
            point[place] += step[place] * range[place];
        }
        let stalled = size < NEARLY && size > 0.5 * last;
        if size < SETTLED || stalled {
            return Some(point);
        }
        last = size;
    }
    None
}
