//! Bounded, scaled Levenberg-Marquardt for a handful of parameters.
//!
//! The problem hands over its normal equations, summed in one pass over the
//! data; nothing here depends on how many residuals there are, and nothing is
//! allocated.

use crate::box_quadratic::minimum_in_box;
pub use crate::normal_equations::NormalEquations;

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
    /// Also stop when a step fails and less than this fraction of the cost was
    /// left to gain: for models that are not quite smooth (a sample that an
    /// event passes), where nothing more can be had. 0: never.
    pub roughness: f64,
    /// Also stop when the step to come is foreseen to leave less than this part of
    /// what `cost_tolerance` allows, each step leaving at most the same share as the
    /// one before; that step is still taken. Saves an evaluation that would only
    /// confirm. 0: never.
    pub foresight: f64,
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
            roughness: 0.0,
            foresight: 0.0,
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
    /// rounding of the parameters, or less than `roughness` and fails. A parameter that
    /// the data do not determine has no step to take: see the normal matrix.
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

impl<const P: usize> Minimum<P> {
    /// A place for a result.
    pub const NONE: Self = Self {
        parameters: [f64::NAN; P],
        equations: NormalEquations::ZERO,
        evaluations: 0,
        stop: Stop::BadStart,
        at_bound: [0; P],
    };
}

/// Damping to begin with, relative to the diagonal.
const FIRST_DAMPING: f64 = 1e-3;
/// Part of the scaling that each step keeps. With 0 parameters run away (NIST
/// MGH17, start 1); 1 is Moré's rule, which costs good starts an evaluation.
/// The NIST sets are fitted with all values from 0.5 to 1.
const SCALING_MEMORY: f64 = 0.8;
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

/// Minimises a sum of squares from `start` within `bounds`: a [`Descent`] that is
/// given what it asks for.
pub fn minimise<const P: usize>(
    problem: &mut impl LeastSquares<P>,
    start: &[f64; P],
    bounds: &Bounds<P>,
    options: &Options<P>,
) -> Minimum<P> {
    let mut descent = Descent::new(start, bounds, options);
    while let Some(parameters) = descent.propose() {
        descent.take(problem.evaluate(&parameters));
    }
    descent.minimum()
}

/// A minimisation that asks for evaluations one by one, so that those of several
/// problems can be made side by side.
///
/// # Numerics
/// Levenberg-Marquardt. The damping is scaled by the largest recent diagonal of
/// the normal matrix, so that a parameter that loses its effect does not run
/// away; it follows the gain ratio. Each step minimises the damped quadratic
/// model within the bounds exactly (primal active set). Where the change of the
/// cost drowns in rounding, a step is accepted when less is left to gain after
/// it than before, as the gradients tell.
///
/// # Source
/// Marquardt (1963), J. SIAM 11:431; Moré (1978), Lecture Notes in Mathematics
/// 630:105, for the scaling (kept there for ever, here for some steps); Nielsen
/// (1999), IMM-REP-1999-05, for the damping; Bates and Watts (1981),
/// Technometrics 23:179, for the stopping rule (the residual's part in the
/// tangent plane).
///
/// # Example
/// ```
/// use windfall_numerics::least_squares::{Bounds, Descent, NormalEquations, Options};
/// // (b − 3)² + 1
/// let mut descent = Descent::new(&[0.0], &Bounds::NONE, &Options::default());
/// while let Some([b]) = descent.propose() {
///     let mut equations = NormalEquations::ZERO;
///     equations.add(1.0, b - 3.0, &[1.0]);
///     equations.add(1.0, 1.0, &[0.0]);
///     descent.take(Some(equations));
/// }
/// assert!((descent.minimum().parameters[0] - 3.0).abs() < 1e-9);
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Descent<const P: usize> {
    bounds: Bounds<P>,
    options: Options<P>,
    here: Point<P>,
    damping: Damping<P>,
    asked: Option<Asked<P>>,
    evaluations: usize,
    stop: Stop,
}

/// A requested evaluation.
#[derive(Clone, Copy, Debug)]
enum Asked<const P: usize> {
    Start,
    Step { to: [f64; P], gain: f64 },
}

impl<const P: usize> Descent<P> {
    /// A minimisation from `start` within `bounds`.
    pub fn new(start: &[f64; P], bounds: &Bounds<P>, options: &Options<P>) -> Self {
        let legal = (0..P).all(|i| !start[i].is_nan() && bounds.lower[i] <= bounds.upper[i]);
        let parameters = if legal { clip(start, bounds) } else { *start };
        Self {
            bounds: *bounds,
            options: *options,
            here: Point {
                parameters,
                equations: NormalEquations::ZERO,
                full: [0.0; P],
                left: f64::INFINITY,
            },
            damping: Damping {
                relative: FIRST_DAMPING,
                growth: 2.0,
                scaling: [0.0; P],
            },
            asked: legal.then_some(Asked::Start),
            evaluations: usize::from(legal),
            stop: Stop::BadStart,
        }
    }

    /// A minimisation from where `other` stopped, of a cost of the same shape (more
    /// samples of the same model): the damping is what it was there.
    pub fn resumed(other: &Self, bounds: &Bounds<P>, options: &Options<P>) -> Self {
        let mut resumed = Self::new(&other.here.parameters, bounds, options);
        resumed.damping.relative = other.damping.relative;
        resumed
    }

    /// A minimisation from where `other` stopped, of its cost but for small errors:
    /// besides the damping, the convergence of the steps is judged on from there.
    pub fn continued(other: &Self, bounds: &Bounds<P>, options: &Options<P>) -> Self {
        let mut continued = Self::resumed(other, bounds, options);
        continued.here.left = other.here.left;
        continued
    }

    /// Where the problem is to be evaluated next; `None` when the end is reached.
    pub fn propose(&self) -> Option<[f64; P]> {
        self.asked.map(|asked| match asked {
            Asked::Start => self.here.parameters,
            Asked::Step { to, .. } => to,
        })
    }

    /// Takes the normal equations at the parameters last proposed, or `None` where
    /// the model cannot be evaluated; without a proposal, does nothing.
    pub fn take(&mut self, found: Option<NormalEquations<P>>) {
        let found = found.filter(NormalEquations::is_finite);
        match (self.asked.take(), found) {
            (Some(Asked::Start), Some(equations)) => {
                let start = point(self.here.parameters, equations, &self.bounds);
                self.arrive(start, self.here.left);
            }
            (Some(Asked::Step { to, gain }), found) => {
                let next = found.map(|found| point(to, found, &self.bounds));
                match next.filter(|next| accepted(&self.here, next)) {
                    Some(next) => {
                        self.damping.follow(&self.here, &next, gain);
                        self.arrive(next, self.here.left);
                    }
                    None => match self.failed(gain) {
                        Some(stop) => self.stop = stop,
                        None => self.search(),
                    },
                }
            }
            _ => {}
        }
    }

    /// Where the minimisation stopped, or stands.
    pub fn minimum(&self) -> Minimum<P> {
        let parameters = self.here.parameters;
        let at_bound = |i: usize| {
            i8::from(parameters[i] >= self.bounds.upper[i])
                - i8::from(parameters[i] <= self.bounds.lower[i])
        };
        Minimum {
            parameters,
            equations: self.here.equations,
            evaluations: self.evaluations,
            stop: self.stop,
            at_bound: match self.stop {
                Stop::BadStart => [0; P],
                _ => std::array::from_fn(at_bound),
            },
        }
    }

    /// Goes on from `here`; before its step `left_before` was left to gain.
    fn arrive(&mut self, here: Point<P>, left_before: f64) {
        self.here = here;
        let options = &self.options;
        for i in 0..P {
            let scaling = &mut self.damping.scaling[i];
            *scaling = (SCALING_MEMORY * *scaling).max(here.equations.normal[i][i]);
        }
        let done = here.left <= negligible(&here, options)
            || short(&here.full, options)
            || foreseen(&here, left_before, options);
        if done {
            let last = shortened(&here.full, options);
            self.here.parameters = moved(&here.parameters, &last, &self.bounds);
            self.stop = Stop::Converged;
        } else {
            self.search();
        }
    }

    /// Asks for the next step, damped more and more until there is one, or stops.
    fn search(&mut self) {
        while self.damping.relative <= LARGEST_DAMPING {
            if self.evaluations >= self.options.max_evaluations {
                self.stop = Stop::EvaluationLimit;
                return;
            }
            let here = &self.here;
            let added = self.damping.scaling.map(|s| s * self.damping.relative);
            match bounded_step(&here.equations, &here.parameters, &self.bounds, &added) {
                None => self.damping.grow(),
                Some(step) => {
                    let step = shortened(&step, &self.options);
                    let (gain, _) = here.equations.predicted_gain(&step);
                    let to = moved(&here.parameters, &step, &self.bounds);
                    if to == here.parameters {
                        self.stop = Stop::Stuck;
                        return;
                    }
                    // A step without gain is rounding of a nearly singular matrix.
                    if gain > 0.0 {
                        self.evaluations += 1;
                        self.asked = Some(Asked::Step { to, gain });
                        return;
                    }
                    if let Some(stop) = self.failed(gain) {
                        self.stop = stop;
                        return;
                    }
                }
            }
        }
        self.stop = Stop::Stuck;
    }

    /// After a step that did not lower the cost: the end, or more damping.
    fn failed(&mut self, gain: f64) -> Option<Stop> {
        if self.here.left <= self.options.roughness * self.here.equations.cost {
            return Some(Stop::Converged);
        }
        // Shorter steps would gain less than what counts.
        if gain > 0.0 && gain <= negligible(&self.here, &self.options) {
            return Some(Stop::Stuck);
        }
        self.damping.grow();
        None
    }
}

/// Parameters with their normal equations, and what is left to gain there.
#[derive(Clone, Copy, Debug)]
struct Point<const P: usize> {
    parameters: [f64; P],
    equations: NormalEquations<P>,
    /// The undamped Gauss-Newton step within the bounds.
    full: [f64; P],
    /// Predicted gain of `full`, at most; not a number when there is no step.
    left: f64,
}

/// Damping of the next step, and how it grows when a step fails.
#[derive(Clone, Copy, Debug)]
struct Damping<const P: usize> {
    relative: f64,
    growth: f64,
    scaling: [f64; P],
}

impl<const P: usize> Damping<P> {
    /// Less damping where the quadratic model predicted the gain, more where it
    /// promised too much.
    fn follow(&mut self, from: &Point<P>, to: &Point<P>, gain: f64) {
        let fall = from.equations.cost - to.equations.cost;
        let ratio = if gain > noise(from) { fall / gain } else { 1.0 };
        let shrink = (1.0 - (2.0 * ratio - 1.0).powi(3)).clamp(0.05, 2.0);
        self.relative = (self.relative * shrink).max(SMALLEST_DAMPING);
        self.growth = 2.0;
    }

    /// More damping, and still more after that.
    fn grow(&mut self) {
        self.relative *= self.growth;
        self.growth *= 2.0;
    }
}

/// Lower cost; or, where the change of the cost is noise, less left to gain.
fn accepted<const P: usize>(from: &Point<P>, to: &Point<P>) -> bool {
    let rise = to.equations.cost - from.equations.cost;
    rise <= 0.0 || (rise <= noise(from) && to.left < from.left)
}

/// Change of the cost that is rounding.
fn noise<const P: usize>(at: &Point<P>) -> f64 {
    let rounding = rounding_gain(at);
    NOISE * at.equations.cost + 2.0 * (at.equations.cost * rounding).sqrt() + rounding
}

/// Whether the full step is sure to end at the minimum: the errors of successive
/// Gauss-Newton steps shrink at least by the same factor near it.
fn foreseen<const P: usize>(at: &Point<P>, left_before: f64, options: &Options<P>) -> bool {
    let after = at.left * (at.left / left_before);
    left_before.is_finite() && after <= options.foresight * negligible(at, options)
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
    // Inseparable parameters need the least damping that works.
    let least = std::array::from_fn(|i| SMALLEST_DAMPING * equations.normal[i][i]);
    let full = bounded_step(&equations, &parameters, bounds, &[0.0; P])
        .or_else(|| bounded_step(&equations, &parameters, bounds, &least))
        .unwrap_or([f64::NAN; P]);
    let (gain, size) = equations.predicted_gain(&full);
    Point {
        parameters,
        equations,
        full,
        left: gain + ROUNDING * size,
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

fn clip<const P: usize>(parameters: &[f64; P], bounds: &Bounds<P>) -> [f64; P] {
    std::array::from_fn(|i| parameters[i].max(bounds.lower[i]).min(bounds.upper[i]))
}

/// Parameters after a step; a step to a bound ends on it exactly.
fn moved<const P: usize>(parameters: &[f64; P], step: &[f64; P], bounds: &Bounds<P>) -> [f64; P] {
    std::array::from_fn(|i| {
        if step[i] <= bounds.lower[i] - parameters[i] {
            bounds.lower[i]
        } else if step[i] >= bounds.upper[i] - parameters[i] {
            bounds.upper[i]
        } else {
            parameters[i] + step[i]
        }
    })
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
    let lower = std::array::from_fn(|i| bounds.lower[i] - parameters[i]);
    let upper = std::array::from_fn(|i| bounds.upper[i] - parameters[i]);
    minimum_in_box(&matrix, &equations.gradient, &lower, &upper)
}
