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
    /// No step within the bounds lowers the cost noticeably: the full
    /// Gauss-Newton step gains less than `cost_tolerance`, or less than the
    /// rounding of the parameters. A parameter that the data do not tell, at
    /// this point, has no step to take: look at the normal matrix.
    Converged,
    /// The full step promises a gain, but shorter and shorter steps did not
    /// deliver it: the model is not smooth, or its derivatives are wrong.
    Stuck,
    /// The evaluations ran out.
    EvaluationLimit,
    /// The start is not a number, the bounds exclude each other, or the model
    /// cannot be evaluated at the start.
    BadStart,
}

/// Where the minimiser stopped.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Minimum<const P: usize> {
    /// Parameters.
    pub parameters: [f64; P],
    /// Normal equations of the last evaluation that lowered the cost (one
    /// negligible step before `parameters` when converged).
    pub equations: NormalEquations<P>,
    /// Evaluations used.
    pub evaluations: usize,
    /// Why it stopped.
    pub stop: Stop,
    /// Whether each parameter ended on a bound: −1 lower, 1 upper, 0 neither
    /// (or both, where they are equal).
    pub at_bound: [i8; P],
}

/// Damping to begin with, relative to the diagonal.
const FIRST_DAMPING: f64 = 1e-3;
/// Below this the damping no longer changes a step.
const SMALLEST_DAMPING: f64 = 1e-12;
/// Above this every step is negligible.
const LARGEST_DAMPING: f64 = 1e16;
/// Relative error of a parameter, or of the model, that is rounding: a few
/// units in the last place.
const ROUNDING: f64 = 4.0 * f64::EPSILON;
/// Changes of the cost below this fraction may be noise of the model, such as
/// steps of an integrator; there the gradients decide.
const NOISE: f64 = 1e-8;

/// Minimises a sum of squares from `start` within `bounds`.
///
/// # Numerics
/// Levenberg-Marquardt. The damping is scaled by the largest diagonal of the
/// normal matrix so far, so that a parameter that loses its effect does not run
/// away; it follows the gain ratio. Each step minimises the damped quadratic
/// model within the bounds exactly (primal active set). Where the change of the
/// cost drowns in rounding, a step is accepted when less is left to gain after
/// it than before, as the gradients tell.
///
/// # Source
/// Marquardt (1963), J. SIAM 11:431; Moré (1978), Lecture Notes in Mathematics
/// 630:105, for the scaling; Nielsen (1999), IMM-REP-1999-05, for the damping;
/// Bates and Watts (1981), Technometrics 23:179, for the stopping rule (the
/// residual's part in the tangent plane).
pub fn minimise<const P: usize>(
    problem: &mut impl LeastSquares<P>,
    start: &[f64; P],
    bounds: &Bounds<P>,
    options: &Options<P>,
) -> Minimum<P> {
    let mut minimum = Minimum {
        parameters: *start,
        equations: NormalEquations::ZERO,
        evaluations: 0,
        stop: Stop::BadStart,
        at_bound: [0; P],
    };
    let legal = (0..P).all(|i| !start[i].is_nan() && bounds.lower[i] <= bounds.upper[i]);
    if legal {
        minimum.parameters = clip(start, bounds);
        minimum.evaluations = 1;
        if let Some(equations) = problem.evaluate(&minimum.parameters).filter(finite) {
            minimum.equations = equations;
            descend(problem, &mut minimum, bounds, options);
        }
    }
    minimum
}

/// Parameters with their normal equations, and what is left to gain there.
#[derive(Clone, Copy)]
struct Point<const P: usize> {
    parameters: [f64; P],
    equations: NormalEquations<P>,
    /// The undamped Gauss-Newton step within the bounds.
    full: [f64; P],
    /// Predicted gain of `full`.
    left: f64,
}

/// Damping of the next step, and how it grows when a step fails.
struct Damping<const P: usize> {
    relative: f64,
    growth: f64,
    scaling: [f64; P],
}

/// Moves `minimum` from its evaluated parameters to where it stops.
fn descend<const P: usize>(
    problem: &mut impl LeastSquares<P>,
    minimum: &mut Minimum<P>,
    bounds: &Bounds<P>,
    options: &Options<P>,
) {
    let mut here = point(minimum.parameters, minimum.equations, bounds);
    let mut damping = Damping {
        relative: FIRST_DAMPING,
        growth: 2.0,
        scaling: [0.0; P],
    };
    minimum.stop = loop {
        for i in 0..P {
            damping.scaling[i] = damping.scaling[i].max(here.equations.normal[i][i]);
        }
        if here.left <= negligible(&here, options) || short(&here.full, options) {
            let last = shortened(&here.full, options);
            here.parameters = moved(&here.parameters, &last, bounds);
            break Stop::Converged;
        }
        let spent = &mut minimum.evaluations;
        match next_point(problem, &here, &mut damping, spent, bounds, options) {
            Ok(next) => here = next,
            Err(stop) => break stop,
        }
    };
    (minimum.parameters, minimum.equations) = (here.parameters, here.equations);
    minimum.at_bound = std::array::from_fn(|i| {
        let at = minimum.parameters[i];
        i8::from(at >= bounds.upper[i]) - i8::from(at <= bounds.lower[i])
    });
}

/// The first point that a step, damped more and more, leads down to.
fn next_point<const P: usize>(
    problem: &mut impl LeastSquares<P>,
    here: &Point<P>,
    damping: &mut Damping<P>,
    evaluations: &mut usize,
    bounds: &Bounds<P>,
    options: &Options<P>,
) -> Result<Point<P>, Stop> {
    while damping.relative <= LARGEST_DAMPING {
        if *evaluations >= options.max_evaluations {
            return Err(Stop::EvaluationLimit);
        }
        let added = damping.scaling.map(|scale| scale * damping.relative);
        if let Some(step) = bounded_step(&here.equations, &here.parameters, bounds, &added) {
            let step = shortened(&step, options);
            let gain = predicted_gain(&here.equations, &step);
            let candidate = moved(&here.parameters, &step, bounds);
            if gain <= 0.0 || candidate == here.parameters {
                return Err(Stop::Stuck);
            }
            *evaluations += 1;
            let found = problem.evaluate(&candidate).filter(finite);
            if let Some(next) = found.map(|found| point(candidate, found, bounds))
                && accepted(here, &next)
            {
                damping.follow(here, &next, gain);
                return Ok(next);
            }
            // Shorter steps would gain less than what counts.
            if gain <= negligible(here, options) {
                return Err(Stop::Stuck);
            }
        }
        damping.relative *= damping.growth;
        damping.growth *= 2.0;
    }
    Err(Stop::Stuck)
}

impl<const P: usize> Damping<P> {
    /// Less damping where the quadratic model foretold the gain, more where it
    /// promised too much.
    fn follow(&mut self, from: &Point<P>, to: &Point<P>, gain: f64) {
        let fall = from.equations.cost - to.equations.cost;
        let ratio = if gain > noise(from) { fall / gain } else { 1.0 };
        let shrink = (1.0 - (2.0 * ratio - 1.0).powi(3)).clamp(0.05, 2.0);
        self.relative = (self.relative * shrink).max(SMALLEST_DAMPING);
        self.growth = 2.0;
    }
}

/// Lower cost; or, where the change of the cost is noise, less left to gain.
fn accepted<const P: usize>(from: &Point<P>, to: &Point<P>) -> bool {
    let rise = to.equations.cost - from.equations.cost;
    rise <= 0.0 || (rise <= noise(from) && to.left < from.left)
}

/// Change of the cost that says nothing.
fn noise<const P: usize>(at: &Point<P>) -> f64 {
    let rounding = rounding_gain(at);
    NOISE * at.equations.cost + 2.0 * (at.equations.cost * rounding).sqrt() + rounding
}

/// Gain that is not worth an evaluation.
fn negligible<const P: usize>(at: &Point<P>, options: &Options<P>) -> f64 {
    (options.cost_tolerance * at.equations.cost).max(rounding_gain(at))
}

/// Change of the cost when each parameter is off by its rounding, at a minimum.
fn rounding_gain<const P: usize>(at: &Point<P>) -> f64 {
    (0..P)
        .map(|i| at.equations.normal[i][i] * (ROUNDING * at.parameters[i]).powi(2))
        .sum()
}

fn point<const P: usize>(
    parameters: [f64; P],
    equations: NormalEquations<P>,
    bounds: &Bounds<P>,
) -> Point<P> {
    // Parameters that cannot be told apart need the least damping that works.
    let least = std::array::from_fn(|i| SMALLEST_DAMPING * equations.normal[i][i]);
    let full = bounded_step(&equations, &parameters, bounds, &[0.0; P])
        .or_else(|| bounded_step(&equations, &parameters, bounds, &least))
        .unwrap_or([f64::NAN; P]);
    Point {
        parameters,
        equations,
        full,
        left: predicted_gain(&equations, &full),
    }
}

fn short<const P: usize>(step: &[f64; P], options: &Options<P>) -> bool {
    (0..P).all(|i| {
        let unit = options.largest_step[i];
        let unit = if unit.is_finite() { unit } else { 0.0 };
        step[i].abs() <= options.step_tolerance * unit
    })
}

/// The step in the same direction within the longest step allowed.
fn shortened<const P: usize>(step: &[f64; P], options: &Options<P>) -> [f64; P] {
    let longest = (0..P)
        .map(|i| step[i].abs() / options.largest_step[i])
        .fold(1.0, f64::max);
    step.map(|s| s / longest)
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

/// What a parameter may do in a step.
#[derive(Clone, Copy, PartialEq)]
enum Hold {
    Free,
    /// On its lower bound.
    Lower,
    /// On its upper bound.
    Upper,
    /// Without effect, or without room.
    Fixed,
}

/// Step to the minimum of the damped quadratic model within the bounds; `None`
/// when its matrix is singular.
fn bounded_step<const P: usize>(
    equations: &NormalEquations<P>,
    parameters: &[f64; P],
    bounds: &Bounds<P>,
    added: &[f64; P],
) -> Option<[f64; P]> {
    let mut matrix = equations.normal;
    for i in 0..P {
        matrix[i][i] += added[i];
    }
    let mut hold = std::array::from_fn(|i| first_hold(equations, parameters, bounds, i));
    let mut step = [0.0; P];
    // Each round puts a parameter on its bound or, lower down, releases one.
    for _ in 0..4 * (P + 1) {
        let target = solve(&matrix, &equations.gradient, &hold, &step)?;
        if let Some((i, bound, fraction)) = first_bound(parameters, bounds, &hold, &step, &target) {
            for j in 0..P {
                step[j] += fraction * (target[j] - step[j]);
            }
            step[i] = match bound {
                Hold::Lower => bounds.lower[i] - parameters[i],
                _ => bounds.upper[i] - parameters[i],
            };
            hold[i] = bound;
            continue;
        }
        step = target;
        match held_in_vain(&matrix, &equations.gradient, &hold, &step) {
            Some(i) => hold[i] = Hold::Free,
            None => break,
        }
    }
    Some(step)
}

/// A parameter on a bound whose gradient points outwards is held there.
fn first_hold<const P: usize>(
    equations: &NormalEquations<P>,
    parameters: &[f64; P],
    bounds: &Bounds<P>,
    i: usize,
) -> Hold {
    if equations.normal[i][i] <= 0.0 || bounds.lower[i] >= bounds.upper[i] {
        Hold::Fixed
    } else if parameters[i] <= bounds.lower[i] && equations.gradient[i] > 0.0 {
        Hold::Lower
    } else if parameters[i] >= bounds.upper[i] && equations.gradient[i] < 0.0 {
        Hold::Upper
    } else {
        Hold::Free
    }
}

/// The bound met first on the way from `step` to `target`, and at which
/// fraction of the way.
fn first_bound<const P: usize>(
    parameters: &[f64; P],
    bounds: &Bounds<P>,
    hold: &[Hold; P],
    step: &[f64; P],
    target: &[f64; P],
) -> Option<(usize, Hold, f64)> {
    let mut first: Option<(usize, Hold, f64)> = None;
    for i in (0..P).filter(|&i| hold[i] == Hold::Free) {
        let to = parameters[i] + target[i];
        let (bound, limit) = if to < bounds.lower[i] {
            (Hold::Lower, bounds.lower[i])
        } else if to > bounds.upper[i] {
            (Hold::Upper, bounds.upper[i])
        } else {
            continue;
        };
        let way = (limit - parameters[i] - step[i]) / (target[i] - step[i]);
        let fraction = if way.is_finite() {
            way.clamp(0.0, 1.0)
        } else {
            0.0
        };
        if first.is_none_or(|(_, _, least)| fraction < least) {
            first = Some((i, bound, fraction));
        }
    }
    first
}

/// The parameter on a bound that the model wants away from it most, relative to
/// what rounding could feign.
fn held_in_vain<const P: usize>(
    matrix: &[[f64; P]; P],
    gradient: &[f64; P],
    hold: &[Hold; P],
    step: &[f64; P],
) -> Option<usize> {
    let mut worst: Option<(usize, f64)> = None;
    for i in 0..P {
        let (mut slope, mut size) = (gradient[i], gradient[i].abs());
        for j in 0..P {
            slope += matrix[i][j] * step[j];
            size += (matrix[i][j] * step[j]).abs();
        }
        let inward = match hold[i] {
            Hold::Lower => -slope,
            Hold::Upper => slope,
            Hold::Free | Hold::Fixed => continue,
        };
        let gain = inward * inward / matrix[i][i];
        if inward > 8.0 * ROUNDING * size && worst.is_none_or(|(_, most)| gain > most) {
            worst = Some((i, gain));
        }
    }
    worst.map(|(i, _)| i)
}

/// Solves `matrix` δ = −g for the free parameters, given the steps of those
/// that are held.
fn solve<const P: usize>(
    matrix: &[[f64; P]; P],
    gradient: &[f64; P],
    hold: &[Hold; P],
    step: &[f64; P],
) -> Option<[f64; P]> {
    let held = |i: usize| hold[i] != Hold::Free;
    let mut reduced = *matrix;
    let mut right = gradient.map(|g| -g);
    for i in 0..P {
        for j in 0..P {
            if held(j) && !held(i) {
                right[i] -= matrix[i][j] * step[j];
            }
            if held(i) || held(j) {
                reduced[i][j] = if i == j { 1.0 } else { 0.0 };
            }
        }
        if held(i) {
            right[i] = step[i];
        }
    }
    cholesky::solve(&reduced, &right)
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
