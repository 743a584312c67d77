//! An impact's likelihood of the law's parameters, everything else about the
//! impact at its best.

use crate::error::Error;
use crate::estimator::{Coordinate, Estimator, FreeLaw, FreeParameter, Setting, Values};
use crate::fit_plan::{Plan, plan};
use crate::model::Sampling;
use crate::motion::Motion;
use crate::population::Expansion;
use crate::problem::{FitOptions, LawProblem};
use crate::rig::Rig;
use crate::samples::SampleGroup;
use crate::solve::{LARGEST_FREE, Solution};
use nalgebra::{DMatrix, DVector};
use windfall_contact::any_law::{AnyLaw, LARGEST_PARAMETERS};
use windfall_contact::law::EndRule;
use windfall_contact::law_kind::Law;
use windfall_numerics::least_squares::{LeastSquares, NormalEquations, Stop};
use windfall_numerics::ode_step::Tolerance;
use windfall_signal::impact::Impact;

/// Evaluations in which the nuisances follow the law's parameters.
const MOST: usize = 30;
/// Gain of the cost, in the units of a log-likelihood, below which the nuisances
/// are at their best.
const SETTLED: f64 = 1e-6;

/// One impact's log-likelihood of φ, the free parameters of the law on the axes
/// of the fit (the logarithm of a scale, an exponent as it is):
///
/// ```text
/// ℓ(φ) = −½ [C(φ̃) − C(φ̃₀)],   C(φ) = min over the nuisances of the cost,
/// φ̃ = φ̃₀ + A (φ − φ̂),        Aᵀ (½ C'')(φ̃₀) A = Σ⁻¹
/// ```
///
/// φ̂ and Σ are estimate and covariance of the fit, φ̃₀ the minimum of the smooth
/// cost of averaged samples. The shape of the likelihood is that of the cost;
/// its place and its curvature there are those of the fit, whose covariance
/// knows of correlated noise and of uncertain zeros, which the sum of squares
/// does not.
///
/// # Source
/// Chandler and Bate (2007), Biometrika 94:167, for the adjustment of a
/// likelihood that takes correlated data as independent.
#[derive(Clone, Debug)]
pub struct ImpactLikelihood {
    law: Law,
    motion: Motion,
    groups: Vec<SampleGroup>,
    end: EndRule,
    tolerance: Tolerance<2>,
    tied_velocity: Option<usize>,
    free: Vec<FreeParameter>,
    base: (Vec<f64>, [f64; 4]),
    law_count: usize,
    /// φ̂.
    estimate: DVector<f64>,
    /// φ̃₀ and the nuisances there.
    smooth: DVector<f64>,
    lowest: f64,
    /// A.
    adjustment: DMatrix<f64>,
    /// Σ.
    covariance: DMatrix<f64>,
    velocity: f64,
}

/// Why an impact cannot be a member of a population.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Unusable {
    /// The fit did not converge.
    #[error("its fit did not converge")]
    NoConvergence,
    /// A parameter ended on its bound.
    #[error("a parameter of its fit ended on a bound")]
    AtBound,
    /// The covariance is singular.
    #[error("its fit cannot tell the free parameters apart")]
    Singular,
}
