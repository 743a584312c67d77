//! The linear mixed model at its best variances, and what follows from how
//! sharply they are known.

use crate::population::linear::{LinearProblem, LinearValue};
use crate::population::newton::{Minimum, minimise};
use crate::population::variance::Variances;
use nalgebra::{DMatrix, DVector, SMatrix, SymmetricEigen};

/// Step of differences by a variance parameter.
const STEP: f64 = 1e-3;
/// Curvature of the deviance below this (in units where a parameter is a
/// standard deviation over its scale) means that the parameter is unknown.
const UNKNOWN: f64 = 1e-4;

/// Best variances and effects.
#[derive(Clone, Debug)]
pub(crate) struct Optimum<const Q: usize> {
    pub variances: Variances<Q>,
    pub minimum: Minimum,
    pub between: SMatrix<f64, Q, Q>,
    pub within: SMatrix<f64, Q, Q>,
    /// R with Ω = R Rᵀ.
    pub root: SMatrix<f64, Q, Q>,
    pub value: LinearValue<Q>,
}

/// Deviance and gradient at variance parameters `theta`.
pub(crate) fn deviance<const Q: usize>(
    problem: &LinearProblem<Q>,
    variances: &Variances<Q>,
    theta: &DVector<f64>,
) -> Option<(f64, DVector<f64>)> {
    let roots = variances.roots(theta);
    let within = roots[1] * roots[1].transpose();
    let value = problem.evaluate(&roots[0], &within)?;
    let gradient = variances.gradient(&roots, [&value.by_between, &value.by_within]);
    Some((value.deviance, gradient))
}

/// Best variances from `start`; `None` when the likelihood is nowhere defined.
pub(crate) fn optimise<const Q: usize>(
    problem: &LinearProblem<Q>,
    variances: Variances<Q>,
    start: &DVector<f64>,
) -> Option<Optimum<Q>> {
    let minimum = minimise(&|theta| deviance(problem, &variances, theta), start)?;
    let roots = variances.roots(&minimum.at);
    let within = roots[1] * roots[1].transpose();
    Some(Optimum {
        between: roots[0] * roots[0].transpose(),
        within,
        root: roots[0],
        value: problem.evaluate(&roots[0], &within)?,
        variances,
        minimum,
    })
}

impl<const Q: usize> Optimum<Q> {
    /// Covariance of the variance parameters: twice the inverse Hessian of the
    /// deviance, without undetermined directions.
    fn uncertainty(&self) -> DMatrix<f64> {
        let n = self.minimum.at.len();
        let mut out = DMatrix::zeros(n, n);
        if n == 0 {
            return out;
        }
        let eigen = SymmetricEigen::new(self.minimum.hessian.clone());
        for (value, direction) in eigen
            .eigenvalues
            .iter()
            .zip(eigen.eigenvectors.column_iter())
        {
            if *value > UNKNOWN {
                out += direction * direction.transpose() * (2.0 / value);
            }
        }
        out
    }

    /// Degrees of freedom of each fixed effect.
    ///
    /// # Source
    /// Satterthwaite (1946), Biometrics Bulletin 2:110; Giesbrecht and Burns
    /// (1985), Biometrics 41:477: 2 v² / var(v) for the variance v of an effect,
    /// var(v) by the delta method.
    pub(crate) fn degrees_of_freedom(&self, problem: &LinearProblem<Q>) -> Option<Vec<f64>> {
        let effects = self.value.effects.len();
        let at = |i: usize, side: f64| {
            let mut theta = self.minimum.at.clone();
            theta[i] += side * STEP;
            let roots = self.variances.roots(&theta);
            let value = problem.evaluate(&roots[0], &(roots[1] * roots[1].transpose()))?;
            Some(value.covariance.diagonal())
        };
        let mut slopes = DMatrix::zeros(effects, self.minimum.at.len());
        for i in 0..self.minimum.at.len() {
            slopes.set_column(i, &((at(i, 1.0)? - at(i, -1.0)?) / (2.0 * STEP)));
        }
        let spread = &slopes * self.uncertainty() * slopes.transpose();
        let freedom = (0..effects).map(|k| {
            let variance = self.value.covariance[(k, k)];
            2.0 * variance * variance / spread[(k, k)].max(f64::MIN_POSITIVE)
        });
        Some(freedom.collect())
    }
}
