//! The normal equations of weighted least squares.

use crate::cholesky;

/// Cost, gradient and normal matrix of weighted least squares:
///
/// ```text
/// cost = Σ w e²,   gradient = Σ w J e,   normal = Σ w J Jᵀ
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NormalEquations<const P: usize> {
    /// Weighted sum of squared residuals.
    pub cost: f64,
    /// Half the gradient of the cost.
    pub gradient: [f64; P],
    /// Gauss-Newton approximation of half the Hessian, symmetric.
    pub normal: [[f64; P]; P],
}

impl<const P: usize> NormalEquations<P> {
    /// Adds one residual with its derivatives.
    pub fn add(&mut self, weight: f64, residual: f64, jacobian: &[f64; P]) {
        self.cost += weight * residual * residual;
        for i in 0..P {
            let weighted = weight * jacobian[i];
            self.gradient[i] += weighted * residual;
            for j in 0..P {
                self.normal[i][j] += weighted * jacobian[j];
            }
        }
    }

    /// No residuals yet.
    pub const ZERO: Self = Self {
        cost: 0.0,
        gradient: [0.0; P],
        normal: [[0.0; P]; P],
    };

    /// Inverse of the normal matrix of the first `count` parameters, the only ones;
    /// `None` where it is singular.
    pub fn inverse(&self, count: usize) -> Option<[[f64; P]; P]> {
        let mut normal = self.normal;
        for i in count..P {
            normal[i][i] = 1.0;
        }
        cholesky::inverse(&normal)
    }

    pub(crate) fn is_finite(&self) -> bool {
        self.cost.is_finite()
            && self.gradient.iter().all(|g| g.is_finite())
            && self.normal.iter().flatten().all(|n| n.is_finite())
    }

    /// −(2 gᵀδ + δᵀNδ): by how much the quadratic model's cost falls; and the sum of
    /// its terms without their signs, whose rounding hides a smaller gain.
    pub(crate) fn predicted_gain(&self, step: &[f64; P]) -> (f64, f64) {
        let (mut gain, mut size) = (0.0, 0.0);
        for i in 0..P {
            let mut slope = 2.0 * self.gradient[i];
            let mut steepest = slope.abs();
            for j in 0..P {
                let curved = self.normal[i][j] * step[j];
                slope += curved;
                steepest += curved.abs();
            }
            gain -= step[i] * slope;
            size += step[i].abs() * steepest;
        }
        (gain, size)
    }
}
