//! Minimum of a smooth function with known gradient.

use crate::basis::dot;
use nalgebra::{DMatrix, DVector, DVectorView, Dyn, SymmetricEigen};

/// Steps of the quasi-Newton search at most.
const MOST_STEPS: usize = 500;

/// The search ends when a step can lower the value by less than this share.
const DECREASE: f64 = 1e-13;

/// Steps in a row that do not lower the value before the search ends.
const MOST_IDLE: usize = 4;

/// Steps of Newton's method at the end, at most.
const MOST_POLISHES: usize = 8;

/// Newton's steps end when one can lower the value by less than this share.
const SETTLED: f64 = 1e-24;

/// Eigenvalues of the second derivative below this share of the largest are flat.
pub(crate) const FLAT: f64 = 1e-9;

/// Curvature of a deviance below which a coordinate is undetermined.
const LEVEL: f64 = 1e-5;

/// Coordinates are taken to be at least of this size.
pub(crate) const LEAST_SIZE: f64 = 0.05;

/// Value and gradient; `None` where there is none.
pub(crate) type Sloped = Option<(f64, Vec<f64>)>;

/// Where a search ended.
#[derive(Clone, Debug)]
pub(crate) struct Minimum {
    pub point: Vec<f64>,
    pub value: f64,
    pub evaluations: usize,
    /// Whether the gradient vanishes there to rounding.
    pub converged: bool,
    /// Directions without curvature, in coordinates scaled by their size.
    pub flat: usize,
}

/// A point with its value and gradient.
#[derive(Clone, Debug)]
pub(crate) struct Step {
    pub point: Vec<f64>,
    pub value: f64,
    pub gradient: Vec<f64>,
}

/// Minimum good to rounding: `descend`, then Newton; `None` without a value at the start.
pub(crate) fn minimise(objective: &dyn Fn(&[f64]) -> Sloped, start: Vec<f64>) -> Option<Minimum> {
    let (found, evaluations) = descend(objective, start)?;
    if found.point.is_empty() {
        return Some(Minimum {
            point: found.point,
            value: found.value,
            evaluations,
            converged: true,
            flat: 0,
        });
    }
    Some(polish(objective, found, evaluations))
}

/// BFGS with a weak Wolfe search by bisection (Lewis and Overton 2013) to rounding;
/// also the number of evaluations.
pub(crate) fn descend(
    objective: &dyn Fn(&[f64]) -> Sloped,
    start: Vec<f64>,
) -> Option<(Step, usize)> {
    let n = start.len();
    let (value, gradient) = objective(&start)?;
    let mut at = Step {
        point: start,
        value,
        gradient,
    };
    let first = 0.5 / dot(&at.gradient, &at.gradient).sqrt().max(1e-8);
    let mut inverse = DMatrix::identity(n, n) * first;
    let mut evaluations = 1;
    let (mut fresh, mut idle) = (true, 0);
    for _ in 0..MOST_STEPS {
        let slope = DVector::from_column_slice(&at.gradient);
        let mut direction = -(&inverse * &slope);
        let mut descent = direction.dot(&slope);
        if descent >= 0.0 {
            direction = -&slope;
            descent = -slope.norm_squared();
            inverse = DMatrix::identity(n, n);
        }
        if !fresh && -descent <= DECREASE * (1.0 + at.value.abs()) {
            break;
        }
        let Some(step) = search(
            objective,
            &at,
            direction.as_slice(),
            descent,
            &mut evaluations,
        ) else {
            break;
        };
        let change = difference(&step.point, &at.point);
        let turn = difference(&step.gradient, &at.gradient);
        if fresh && turn.dot(&change) > 0.0 {
            inverse = DMatrix::identity(n, n) * (turn.dot(&change) / turn.norm_squared());
        }
        fresh = false;
        update(&mut inverse, &change, &turn);
        // steps that change no digit of the value lead nowhere
        let lower = step.value < at.value - f64::EPSILON * at.value.abs();
        idle = if lower { 0 } else { idle + 1 };
        at = step;
        if idle == MOST_IDLE {
            break;
        }
    }
    Some((at, evaluations))
}

fn difference(a: &[f64], b: &[f64]) -> DVector<f64> {
    DVector::from_iterator(a.len(), a.iter().zip(b).map(|(a, b)| a - b))
}

/// A step that lowers the value enough and flattens the slope enough.
fn search(
    objective: &dyn Fn(&[f64]) -> Sloped,
    at: &Step,
    direction: &[f64],
    descent: f64,
    evaluations: &mut usize,
) -> Option<Step> {
    let (mut low, mut high, mut length) = (0.0, f64::INFINITY, 1.0);
    let mut best: Option<Step> = None;
    for _ in 0..60 {
        let moved: Vec<f64> = at
            .point
            .iter()
            .zip(direction)
            .map(|(x, d)| x + length * d)
            .collect();
        *evaluations += 1;
        let lower = |(found, _): &(f64, Vec<f64>)| *found <= at.value + 1e-4 * length * descent;
        match objective(&moved).filter(lower) {
            None => high = length,
            Some((found, gradient)) => {
                let flat = dot(&gradient, direction) >= 0.9 * descent;
                best = Some(Step {
                    point: moved,
                    value: found,
                    gradient,
                });
                if flat {
                    return best;
                }
                low = length;
            }
        }
        length = if high.is_finite() {
            f64::midpoint(low, high)
        } else {
            2.0 * low
        };
        if high - low <= 1e-14 * high {
            break;
        }
    }
    best
}

/// The BFGS update of the inverse of the second derivative.
fn update(inverse: &mut DMatrix<f64>, change: &DVector<f64>, turn: &DVector<f64>) {
    let curvature = change.dot(turn);
    if curvature <= 1e-14 * change.norm() * turn.norm() {
        return;
    }
    let moved = &*inverse * turn;
    let scale = (1.0 + turn.dot(&moved) / curvature) / curvature;
    let cross = change * moved.transpose() / curvature;
    *inverse += scale * change * change.transpose() - &cross - cross.transpose();
}

/// Newton's method with the initial second derivative while the gradient shrinks.
fn polish(objective: &dyn Fn(&[f64]) -> Sloped, start: Step, evaluations: usize) -> Minimum {
    let Step {
        mut point,
        mut value,
        mut gradient,
    } = start;
    let mut evaluations = evaluations + 2 * point.len();
    let (mut converged, mut flat) = (false, 0);
    let only_gradient = |x: &[f64]| objective(x).map(|(_, gradient)| gradient);
    if let Some(second) = second_derivative(&only_gradient, &point) {
        flat = flat_directions(&second, &point);
        let eigen = second.symmetric_eigen();
        for _ in 0..MOST_POLISHES {
            let slope = DVector::from_column_slice(&gradient);
            let step = newton_step(&eigen, &slope);
            let promised = -step.dot(&slope);
            converged = promised.abs() <= 1e-9 * (1.0 + value.abs());
            if promised.abs() <= SETTLED * (1.0 + value.abs()) {
                break;
            }
            let moved: Vec<f64> = point.iter().zip(step.iter()).map(|(x, d)| x + d).collect();
            evaluations += 1;
            let Some((found, turned)) = objective(&moved) else {
                break;
            };
            let lower = found <= value + 1e-12 * (1.0 + value.abs());
            if !lower || dot(&turned, &turned) >= dot(&gradient, &gradient) {
                break;
            }
            (point, value, gradient) = (moved, found, turned);
        }
    }
    Minimum {
        point,
        value,
        evaluations,
        converged,
        flat,
    }
}

/// Number of directions without curvature, coordinates taken in shares of their size.
fn flat_directions(second: &DMatrix<f64>, point: &[f64]) -> usize {
    let size = |i: usize| point[i].abs().max(LEAST_SIZE);
    let n = point.len();
    let scaled = DMatrix::from_fn(n, n, |i, j| second[(i, j)] * size(i) * size(j));
    let eigenvalues = scaled.symmetric_eigenvalues();
    eigenvalues.iter().filter(|value| **value < LEVEL).count()
}

/// Each eigenvalue with its vector.
pub(crate) fn directions(
    eigen: &SymmetricEigen<f64, Dyn>,
) -> impl Iterator<Item = (&f64, DVectorView<'_, f64>)> {
    eigen
        .eigenvalues
        .iter()
        .zip(eigen.eigenvectors.column_iter())
}

/// Newton's step in the directions that are not flat, always downhill.
fn newton_step(eigen: &SymmetricEigen<f64, Dyn>, slope: &DVector<f64>) -> DVector<f64> {
    let largest = eigen.eigenvalues.amax();
    let mut step = DVector::zeros(slope.len());
    for (value, vector) in directions(eigen) {
        if value.abs() > FLAT * largest {
            step -= vector * (vector.dot(slope) / value.abs());
        }
    }
    step
}

/// Second derivative by central differences of the gradient, symmetrised.
fn second_derivative(
    gradient: &dyn Fn(&[f64]) -> Option<Vec<f64>>,
    point: &[f64],
) -> Option<DMatrix<f64>> {
    let n = point.len();
    let mut rows = DMatrix::zeros(n, n);
    for i in 0..n {
        let step = 1e-4 * point[i].abs().max(LEAST_SIZE);
        let at = |by: f64| {
            let mut moved = point.to_vec();
            moved[i] += by;
            gradient(&moved)
        };
        let (above, below) = (at(step)?, at(-step)?);
        for j in 0..n {
            rows[(i, j)] = (above[j] - below[j]) / (2.0 * step);
        }
    }
    rows.iter()
        .all(|value| value.is_finite())
        .then(|| (&rows + rows.transpose()) * 0.5)
}

/// Derivatives of outputs (columns) by coordinates (rows), by central differences of
/// fourth order with steps of a thousandth.
pub(crate) fn differences(
    outputs: &dyn Fn(&[f64]) -> Option<Vec<f64>>,
    point: &[f64],
) -> Option<Vec<Vec<f64>>> {
    let coordinates = 0..point.len();
    coordinates
        .map(|i| {
            let step = 1e-3 * point[i].abs().max(LEAST_SIZE);
            let at = |by: f64| {
                let mut moved = point.to_vec();
                moved[i] += by * step;
                outputs(&moved)
            };
            let (a, b, c, d) = (at(1.0)?, at(-1.0)?, at(2.0)?, at(-2.0)?);
            let outputs =
                (0..a.len()).map(|k| (8.0 * (a[k] - b[k]) - (c[k] - d[k])) / (12.0 * step));
            Some(outputs.collect())
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn closed_form_minimum_of_rosenbrock() {
        let objective = |x: &[f64]| -> Sloped {
            let (a, b) = (1.0 - x[0], x[1] - x[0] * x[0]);
            Some((
                a * a + 100.0 * b * b,
                vec![-2.0 * a - 400.0 * x[0] * b, 200.0 * b],
            ))
        };
        let found = minimise(&objective, vec![-1.2, 1.0]).unwrap();
        assert!(found.converged);
        assert!((found.point[0] - 1.0).abs() < 1e-13 && (found.point[1] - 1.0).abs() < 1e-13);
    }

    #[test]
    fn converges_to_a_minimum_far_away_beside_a_wall() {
        let objective = |x: &[f64]| -> Sloped {
            let value = x[0] - 1000.0 * x[0].ln();
            value
                .is_finite()
                .then(|| (value, vec![1.0 - 1000.0 / x[0]]))
        };
        let found = minimise(&objective, vec![1.0]).unwrap();
        assert!((found.point[0] / 1000.0 - 1.0).abs() < 1e-12, "{found:?}");
    }
}
