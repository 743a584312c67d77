//! Bounded, scaled Levenberg-Marquardt for a handful of parameters.
//!
//! The problem hands over its normal equations, summed in one pass over the
//! data; nothing here depends on how many residuals there are, and nothing is
//! allocated.

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
}

/// A sum of squares to make small.
///
/// A parameter whose column of the normal matrix is zero is not moved.
pub trait LeastSquares<const P: usize> {
    /// Normal equations at `parameters`, or `None` where the model cannot be
    /// evaluated; the minimiser then tries a shorter step.
    fn evaluate(&mut self, parameters: &[f64; P]) -> Option<NormalEquations<P>>;
}

/// Range of each parameter; infinite where there is none.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds<const P: usize> {
    /// Smallest values.
    pub lower: [f64; P],
    /// Largest values.
    pub upper: [f64; P],
}

impl<const P: usize> Bounds<P> {
    /// No bounds.
    pub const NONE: Self = Self {
        lower: [f64::NEG_INFINITY; P],
        upper: [f64::INFINITY; P],
    };
}

/// When to stop, and how far to go at once.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options<const P: usize> {
    /// Stop when the next step would lower the cost by less than this
    /// fraction; that step is still taken.
    pub cost_tolerance: f64,
    /// Stop when every step is shorter than this, in units of `largest_step`.
    pub step_tolerance: f64,
    /// Longest step of each parameter.
    pub largest_step: [f64; P],
    /// Evaluations before giving up.
    pub max_evaluations: usize,
}

impl<const P: usize> Default for Options<P> {
    fn default() -> Self {
        Self {
            cost_tolerance: 1e-10,
            step_tolerance: 1e-12,
            largest_step: [f64::INFINITY; P],
            max_evaluations: 200,
        }
    }
}

/// Why the minimiser stopped.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stop {
    /// No step lowers the cost noticeably: a minimum.
    Converged,
    /// Shorter and shorter steps did not lower the cost.
    Stuck,
    /// The evaluations ran out.
    EvaluationLimit,
    /// The model cannot be evaluated at the start.
    BadStart,
}

/// Where the minimiser stopped.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Minimum<const P: usize> {
    /// Parameters.
    pub parameters: [f64; P],
    /// Normal equations of the last evaluation (one negligible step before
    /// `parameters` when converged).
    pub equations: NormalEquations<P>,
    /// Evaluations used.
    pub evaluations: usize,
    /// Why it stopped.
    pub stop: Stop,
    /// Whether each parameter ended on a bound: −1 lower, 1 upper, 0 neither.
    pub at_bound: [i8; P],
}

/// Damping to begin with, relative to the diagonal.
const FIRST_DAMPING: f64 = 1e-3;
/// Below this the damping no longer changes a step.
const SMALLEST_DAMPING: f64 = 1e-12;
/// Above this every step is negligible.
const LARGEST_DAMPING: f64 = 1e16;

/// Minimises a sum of squares from `start` within `bounds`.
///
/// # Numerics
/// Levenberg-Marquardt with Marquardt's scaling by the diagonal, damping by
/// the gain ratio, steps clipped to the bounds; a parameter at a bound whose
/// gradient points outwards is held there for the step.
///
/// # Source
/// Marquardt (1963), J. SIAM 11:431; Nielsen (1999), IMM-REP-1999-05, for the
/// damping.
pub fn minimise<const P: usize>(
    problem: &mut impl LeastSquares<P>,
    start: &[f64; P],
    bounds: &Bounds<P>,
    options: &Options<P>,
) -> Minimum<P> {
    let mut parameters = clip(start, bounds);
    let mut evaluations = 1;
    let Some(mut equations) = problem.evaluate(&parameters).filter(finite) else {
        return Minimum {
            parameters,
            equations: NormalEquations::ZERO,
            evaluations,
            stop: Stop::BadStart,
            at_bound: [0; P],
        };
    };
    let (mut damping, mut growth) = (FIRST_DAMPING, 2.0);
    let mut settled = false;

    let stop = loop {
        // A full Gauss-Newton step tells how much there is left to gain.
        if settled && let Some(full) = bounded_step(&equations, &parameters, bounds, 0.0, options) {
            let gain = predicted_gain(&equations, &full);
            if gain <= options.cost_tolerance * equations.cost {
                parameters = moved(&parameters, &full, bounds);
                break Stop::Converged;
            }
        }
        if evaluations >= options.max_evaluations {
            break Stop::EvaluationLimit;
        }
        let step = bounded_step(&equations, &parameters, bounds, damping, options);
        let step = step.unwrap_or([0.0; P]);
        let gain = predicted_gain(&equations, &step);
        let short = (0..P).all(|i| step[i].abs() <= options.step_tolerance * scale(options, i));
        if short || gain <= 0.0 {
            // At a minimum the step vanishes without damping; a damped one says
            // that no direction helped.
            break if damping <= 1.0 {
                Stop::Converged
            } else {
                Stop::Stuck
            };
        }
        let candidate = moved(&parameters, &step, bounds);
        evaluations += 1;
        let tried = problem.evaluate(&candidate).filter(finite);
        match tried.filter(|found| found.cost <= equations.cost) {
            Some(found) => {
                let ratio = (equations.cost - found.cost) / gain;
                let shrink = (1.0 - (2.0 * ratio - 1.0).powi(3)).clamp(0.05, 2.0);
                damping = (damping * shrink).max(SMALLEST_DAMPING);
                growth = 2.0;
                (parameters, equations, settled) = (candidate, found, true);
            }
            None => {
                damping *= growth;
                growth *= 2.0;
                settled = false;
                if damping > LARGEST_DAMPING {
                    break Stop::Stuck;
                }
                // Noise of the model, not its shape, decides below this.
                if gain <= options.cost_tolerance * equations.cost {
                    break Stop::Converged;
                }
            }
        }
    };
    let mut at_bound = [0; P];
    for i in 0..P {
        at_bound[i] =
            i8::from(parameters[i] >= bounds.upper[i]) - i8::from(parameters[i] <= bounds.lower[i]);
    }
    Minimum {
        parameters,
        equations,
        evaluations,
        stop,
        at_bound,
    }
}

fn scale<const P: usize>(options: &Options<P>, i: usize) -> f64 {
    if options.largest_step[i].is_finite() {
        options.largest_step[i]
    } else {
        f64::MIN_POSITIVE
    }
}

fn finite<const P: usize>(equations: &NormalEquations<P>) -> bool {
    equations.cost.is_finite()
        && equations.gradient.iter().all(|g| g.is_finite())
        && equations.normal.iter().flatten().all(|n| n.is_finite())
}

fn clip<const P: usize>(parameters: &[f64; P], bounds: &Bounds<P>) -> [f64; P] {
    std::array::from_fn(|i| parameters[i].max(bounds.lower[i]).min(bounds.upper[i]))
}

fn moved<const P: usize>(parameters: &[f64; P], step: &[f64; P], bounds: &Bounds<P>) -> [f64; P] {
    clip(&std::array::from_fn(|i| parameters[i] + step[i]), bounds)
}

/// The damped step, zero for parameters that a bound holds; `None` when the
/// normal matrix is singular.
fn bounded_step<const P: usize>(
    equations: &NormalEquations<P>,
    parameters: &[f64; P],
    bounds: &Bounds<P>,
    damping: f64,
    options: &Options<P>,
) -> Option<[f64; P]> {
    let mut held: [bool; P] = std::array::from_fn(|i| {
        let out = (parameters[i] <= bounds.lower[i] && equations.gradient[i] > 0.0)
            || (parameters[i] >= bounds.upper[i] && equations.gradient[i] < 0.0);
        out || equations.normal[i][i] <= 0.0
    });
    // A step that runs into a bound is solved again with that parameter put on
    // the bound, so that the others take the rest of the way.
    let mut fixed = [0.0; P];
    for _ in 0..=P {
        let mut step = solve(equations, &held, &fixed, damping)?;
        let mut blocked = false;
        for i in 0..P {
            let to = parameters[i] + step[i];
            if !held[i] && (to < bounds.lower[i] || to > bounds.upper[i]) {
                held[i] = true;
                fixed[i] = to.max(bounds.lower[i]).min(bounds.upper[i]) - parameters[i];
                blocked = true;
            }
        }
        if !blocked {
            let longest = (0..P)
                .map(|i| step[i].abs() / options.largest_step[i])
                .fold(1.0, f64::max);
            step.iter_mut().for_each(|s| *s /= longest);
            return Some(step);
        }
    }
    Some(fixed)
}

/// Solves (N + λ diag N) δ = −g for the parameters that are not held, given
/// the steps of those that are.
fn solve<const P: usize>(
    equations: &NormalEquations<P>,
    held: &[bool; P],
    fixed: &[f64; P],
    damping: f64,
) -> Option<[f64; P]> {
    let mut matrix = equations.normal;
    let mut right = equations.gradient.map(|g| -g);
    for i in 0..P {
        matrix[i][i] *= 1.0 + damping;
        for j in 0..P {
            if held[j] && !held[i] {
                right[i] -= equations.normal[i][j] * fixed[j];
            }
        }
    }
    for i in (0..P).filter(|&i| held[i]) {
        for j in 0..P {
            matrix[i][j] = 0.0;
            matrix[j][i] = 0.0;
        }
        matrix[i][i] = 1.0;
        right[i] = fixed[i];
    }
    cholesky::solve(&matrix, &right)
}

/// −(2 gᵀδ + δᵀNδ): by how much the quadratic model's cost falls.
fn predicted_gain<const P: usize>(equations: &NormalEquations<P>, step: &[f64; P]) -> f64 {
    let mut gain = 0.0;
    for i in 0..P {
        let curved: f64 = (0..P).map(|j| equations.normal[i][j] * step[j]).sum();
        gain -= step[i] * (2.0 * equations.gradient[i] + curved);
    }
    gain
}
