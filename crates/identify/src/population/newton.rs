//! Minimum of a smooth function of a dozen parameters with exact gradient.

use nalgebra::{DMatrix, DVector, SymmetricEigen};

/// Function and gradient; `None` where it is not defined.
pub(crate) type Smooth<'a> = dyn Fn(&DVector<f64>) -> Option<(f64, DVector<f64>)> + 'a;

/// Step of the differences of gradients that make the Hessian.
const STEP: f64 = 1e-4;
/// Longest step of one parameter.
const LONGEST: f64 = 1.0;
/// Predicted decrease at which the minimum is reached.
const DECREASE: f64 = 1e-9;
/// Curvatures below this fraction of the largest are taken as this large.
const FLAT: f64 = 1e-9;
/// Iterations, and halvings of one step.
const MOST: (usize, usize) = (100, 40);

/// Where the minimum is.
#[derive(Clone, Debug)]
pub(crate) struct Minimum {
    pub at: DVector<f64>,
    pub value: f64,
    pub hessian: DMatrix<f64>,
    pub converged: bool,
}

/// Newton's method with the curvatures' absolute values, which makes saddles
/// repel, and halved steps.
pub(crate) fn minimise(function: &Smooth, start: &DVector<f64>) -> Option<Minimum> {
    let mut at = start.clone();
    let (mut value, mut gradient) = function(&at)?;
    let mut hessian = differences(function, &at)?;
    let mut converged = false;
    for _ in 0..MOST.0 {
        let (step, decrease) = newton_step(&hessian, &gradient);
        let Some((next, next_value, next_gradient)) = descend(function, &at, value, &step) else {
            // Nothing lower along a direction of descent: rounding is reached.
            converged = decrease < DECREASE.sqrt();
            break;
        };
        (at, value, gradient) = (next, next_value, next_gradient);
        if decrease < DECREASE {
            converged = true;
            break;
        }
        hessian = differences(function, &at)?;
    }
    Some(Minimum {
        at,
        value,
        hessian,
        converged,
    })
}

fn newton_step(hessian: &DMatrix<f64>, gradient: &DVector<f64>) -> (DVector<f64>, f64) {
    let mut step = DVector::zeros(gradient.len());
    if gradient.is_empty() {
        return (step, 0.0);
    }
    let eigen = SymmetricEigen::new(hessian.clone());
    let largest = eigen.eigenvalues.amax().max(f64::MIN_POSITIVE);
    let mut decrease = 0.0;
    for (value, direction) in eigen
        .eigenvalues
        .iter()
        .zip(eigen.eigenvectors.column_iter())
    {
        let slope = direction.dot(gradient);
        let curvature = value.abs().max(FLAT * largest);
        decrease += 0.5 * slope * slope / curvature;
        step.axpy(-slope / curvature, &direction, 1.0);
    }
    let longest = step.amax();
    if longest > LONGEST {
        step *= LONGEST / longest;
    }
    (step, decrease)
}

fn descend(
    function: &Smooth,
    at: &DVector<f64>,
    value: f64,
    step: &DVector<f64>,
) -> Option<(DVector<f64>, f64, DVector<f64>)> {
    let mut factor = 1.0;
    for _ in 0..MOST.1 {
        let next = at + factor * step;
        if let Some((lower, gradient)) = function(&next)
            && lower <= value
        {
            return Some((next, lower, gradient));
        }
        factor *= 0.5;
    }
    None
}

/// Hessian by central differences of the gradient.
pub(crate) fn differences(function: &Smooth, at: &DVector<f64>) -> Option<DMatrix<f64>> {
    let n = at.len();
    let mut out = DMatrix::zeros(n, n);
    for i in 0..n {
        let shifted = |side: f64| {
            let mut other = at.clone();
            other[i] += side * STEP;
            function(&other).map(|(_, gradient)| gradient)
        };
        let column = (shifted(1.0)? - shifted(-1.0)?) / (2.0 * STEP);
        out.set_column(i, &column);
    }
    Some(0.5 * (&out + out.transpose()))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rosenbrock (1960): minimum 0 at (1, 1); More, Garbow and Hillstrom
    /// (1981), problem 1.
    #[test]
    fn reference_rosenbrock() {
        let f = |x: &DVector<f64>| {
            let (a, b) = (x[1] - x[0] * x[0], 1.0 - x[0]);
            let gradient = DVector::from_vec(vec![-400.0 * x[0] * a - 2.0 * b, 200.0 * a]);
            Some((100.0 * a * a + b * b, gradient))
        };
        let found = minimise(&f, &DVector::from_vec(vec![-1.2, 1.0])).unwrap();
        assert!(found.converged);
        assert!((found.at - DVector::from_vec(vec![1.0, 1.0])).amax() < 1e-7);
    }

    /// x⁴/4 − x²/2 + y² from near its saddle.
    #[test]
    fn closed_form_leaves_a_saddle() {
        let f = |x: &DVector<f64>| {
            let value = x[0].powi(4) / 4.0 - x[0] * x[0] / 2.0 + x[1] * x[1];
            Some((
                value,
                DVector::from_vec(vec![x[0].powi(3) - x[0], 2.0 * x[1]]),
            ))
        };
        let found = minimise(&f, &DVector::from_vec(vec![1e-3, 0.5])).unwrap();
        assert!(found.converged && (found.at[0] - 1.0).abs() < 1e-6);
    }
}
