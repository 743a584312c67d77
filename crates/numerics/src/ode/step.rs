//! One accepted step of an explicit Runge-Kutta pair of order 8 with dense
//! output, for a small system whose state carries its own sensitivities.
//!
//! The state is `[Lanes<W>; D]`: lane 0 of each of the `D` components is its
//! value, the other lanes its derivatives with respect to parameters. The
//! error of the derivatives takes part in the step control, with a tolerance
//! of its own ([`SENSITIVITY_LOOSENESS`]).

use crate::ode::tableau::{A, C, D as DENSE, DENSE_TERMS, E3, E5, Row, STAGES, STAGES_WITH_DENSE};
use crate::real::{Lanes, Real};

/// Derivatives may be this much less accurate than the value: they steer the
/// minimiser and enter the covariance, where six digits are plenty.
pub const SENSITIVITY_LOOSENESS: f64 = 30.0;

/// Step-size factor kept in hand against the next step's rejection.
const SAFETY: f64 = 0.9;
/// Smallest and largest change of the step size in one step.
const SHRINK: f64 = 0.2;
const GROWTH: f64 = 8.0;
/// A step this small against its position cannot be represented.
const SMALLEST_STEP: f64 = 1e-15;
/// Attempts before a step is given up: each shrinks it, so 60 span 10⁻⁴⁰.
const LARGEST_ATTEMPTS: usize = 60;

/// Numbers that describe one lane's dense output over a step.
pub const DENSE_COEFFICIENTS: usize = DENSE_TERMS + 1;

/// Right-hand side y' = f(s, y) with the derivatives of f in the lanes.
pub trait System<const D: usize, const W: usize> {
    /// y' at `(s, state)`.
    fn derivative(&self, s: f64, state: &[Lanes<W>; D]) -> [Lanes<W>; D];
}

/// Accuracy asked of a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tolerance<const D: usize> {
    /// Relative to the larger of the state at both ends.
    pub relative: f64,
    /// Absolute, for each component; its unit.
    pub absolute: [f64; D],
}

impl<const D: usize> Tolerance<D> {
    /// The same tolerance, `factor` times as large.
    pub fn loosened(&self, factor: f64) -> Self {
        Self {
            relative: self.relative * factor,
            absolute: self.absolute.map(|a| a * factor),
        }
    }
}

/// An accepted step: the solution over `[start, start + width]`.
///
/// ```text
/// y(s) = y₀ + σ (r₁ + (1−σ) (r₂ + σ (r₃ + … ))),   σ = (s − start)/width
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Step<const D: usize, const W: usize> {
    /// Independent variable at the start.
    pub start: f64,
    /// Width; negative when integrating backwards.
    pub width: f64,
    /// State at the start.
    pub from: [Lanes<W>; D],
    /// State at the end.
    pub to: [Lanes<W>; D],
    /// Terms r₁ … r₇ of the dense output.
    pub terms: [[Lanes<W>; D]; DENSE_TERMS],
}

impl<const D: usize, const W: usize> Step<D, W> {
    /// State at `sigma`, the fraction of the step from 0 to 1.
    #[inline(always)]
    pub fn at(&self, sigma: f64) -> [Lanes<W>; D] {
        let mut out = self.from;
        for (i, component) in out.iter_mut().enumerate() {
            let mut sum = Lanes::ZERO;
            for term in (0..DENSE_TERMS).rev() {
                let factor = if term % 2 == 0 { sigma } else { 1.0 - sigma };
                sum = (sum + self.terms[term][i]) * factor;
            }
            *component += sum;
        }
        out
    }

    /// Value and seven terms of one lane of one component, for evaluating
    /// many samples at once with [`dense_at`].
    #[inline(always)]
    pub fn lane(&self, component: usize, lane: usize) -> [f64; DENSE_COEFFICIENTS] {
        let mut out = [self.from[component].0[lane]; DENSE_COEFFICIENTS];
        for (term, value) in out[1..].iter_mut().enumerate() {
            *value = self.terms[term][component].0[lane];
        }
        out
    }
}

/// Dense output of one lane (from [`Step::lane`]) at `sigma`, with
/// `rest` = 1 − `sigma`.
#[inline(always)]
pub fn dense_at<R: Real>(coefficients: &[f64; DENSE_COEFFICIENTS], sigma: R, rest: R) -> R {
    let [y, r1, r2, r3, r4, r5, r6, r7] = *coefficients;
    let sum = sigma.mul_add(sigma.constant(r7), sigma.constant(r6));
    let sum = rest.mul_add(sum, sigma.constant(r5));
    let sum = sigma.mul_add(sum, sigma.constant(r4));
    let sum = rest.mul_add(sum, sigma.constant(r3));
    let sum = sigma.mul_add(sum, sigma.constant(r2));
    let sum = rest.mul_add(sum, sigma.constant(r1));
    sigma.mul_add(sum, sigma.constant(y))
}

/// Where an integration stands between steps.
#[derive(Clone, Copy, Debug)]
pub struct Position<const D: usize, const W: usize> {
    /// Independent variable.
    pub s: f64,
    /// State.
    pub state: [Lanes<W>; D],
    /// Its derivative.
    pub derivative: [Lanes<W>; D],
    /// Width to try next; its sign is the direction.
    pub width: f64,
}

/// A step could not be made as small as the tolerance asks, or the state left
/// the numbers.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error(
    "the integration cannot go on from {s}: the step fell to {width:e}; a parameter is probably far outside its useful range"
)]
pub struct StepError {
    /// Independent variable where the step failed.
    pub s: f64,
    /// Last width tried.
    pub width: f64,
}

impl<const D: usize, const W: usize> Position<D, W> {
    /// Starts (or restarts) an integration at `s`.
    #[inline(always)]
    pub fn new(
        system: &impl System<D, W>,
        s: f64,
        state: [Lanes<W>; D],
        width: f64,
    ) -> Position<D, W> {
        let derivative = system.derivative(s, &state);
        Position {
            s,
            state,
            derivative,
            width,
        }
    }
}

/// Control of one step's width over its attempts.
#[derive(Clone, Copy, Debug)]
pub(crate) struct StepControl {
    attempts: usize,
    rejected: bool,
}

impl StepControl {
    pub(crate) const NEW: Self = Self {
        attempts: 0,
        rejected: false,
    };
    pub(crate) const SAFETY: f64 = SAFETY;
    pub(crate) const SENSITIVITY: f64 = SENSITIVITY_LOOSENESS;

    /// Before an attempt from `s`: cuts `width` at `limit` and says whether it was;
    /// `None` when the step must be given up.
    #[inline(always)]
    pub(crate) fn prepare(&mut self, s: f64, limit: f64, width: &mut f64) -> Option<bool> {
        // End exactly on the limit, without a last sliver of a step.
        let remaining = limit - s;
        let last = (*width * 1.01).abs() >= remaining.abs();
        if last {
            *width = remaining;
        }
        let too_small = width.abs() <= SMALLEST_STEP * s.abs() && !last;
        self.attempts += 1;
        (self.attempts <= LARGEST_ATTEMPTS && !too_small).then_some(last)
    }

    /// Width of the next step after one of `width` was accepted.
    #[inline(always)]
    pub(crate) fn accept(&mut self, width: f64, factor: f64) -> f64 {
        let growth = if self.rejected { 1.0 } else { GROWTH };
        *self = Self::NEW;
        width * factor.clamp(SHRINK, growth)
    }

    /// Width of the next attempt after one of `width` was rejected.
    #[inline(always)]
    pub(crate) fn reject(&mut self, width: f64, error: f64, factor: f64) -> f64 {
        self.rejected = true;
        // A state that left the numbers gives a NaN error: shrink hard.
        width
            * if error.is_finite() {
                factor.clamp(SHRINK, 1.0)
            } else {
                0.1
            }
    }
}

/// Makes one accepted step that does not pass `limit`, and moves `position` to
/// its end.
///
/// # Errors
/// [`StepError`] when the tolerance cannot be met.
///
/// # Numerics
/// DOP853: order 8, error from the embedded orders 5 and 3, dense output of
/// order 7 from three more stages. 15 evaluations a step; nothing is allocated.
///
/// # Source
/// Hairer, Nørsett and Wanner (1993), Solving Ordinary Differential Equations
/// I, section II.10. Differences: the error norm takes the largest lane, so
/// that sensitivities are controlled too.
#[inline(always)]
pub fn step<const D: usize, const W: usize>(
    system: &impl System<D, W>,
    position: &mut Position<D, W>,
    limit: f64,
    tolerance: &Tolerance<D>,
) -> Result<Step<D, W>, StepError> {
    let mut k = [[Lanes::<W>::ZERO; D]; STAGES_WITH_DENSE];
    k[0] = position.derivative;
    let (s, from) = (position.s, position.state);
    let mut width = position.width;
    let mut control = StepControl::NEW;
    while let Some(last) = control.prepare(s, limit, &mut width) {
        let to = stages(system, s, &from, width, &mut k, 1..=STAGES);
        let error = error_norm(&k, &from, &to, width, tolerance);
        // The error's eighth root.
        let factor = SAFETY / error.sqrt().sqrt().sqrt();
        if error <= 1.0 {
            let terms = dense_terms(system, s, &from, &to, width, &mut k);
            position.s = if last { limit } else { s + width };
            position.state = to;
            position.derivative = k[STAGES];
            position.width = control.accept(width, factor);
            return Ok(Step {
                start: s,
                width,
                from,
                to,
                terms,
            });
        }
        width = control.reject(width, error, factor);
    }
    Err(StepError { s, width })
}

/// Σ a_j k_j for one row of the tableau.
#[inline(always)]
fn combine<const D: usize, const W: usize>(
    row: Row,
    k: &[[Lanes<W>; D]; STAGES_WITH_DENSE],
) -> [Lanes<W>; D] {
    let mut out = [Lanes::ZERO; D];
    for &(j, a) in row {
        for (sum, k) in out.iter_mut().zip(&k[j]) {
            *sum = k.mul_add(Lanes::splat(a), *sum);
        }
    }
    out
}

/// The states `from + width Σ a_ij k_j` of stages `first` to `last` and their
/// derivatives; the state of the last one.
///
/// One loop and not fifteen copies: the right-hand side is inlined once.
#[inline(always)]
fn stages<const D: usize, const W: usize>(
    system: &impl System<D, W>,
    s: f64,
    from: &[Lanes<W>; D],
    width: f64,
    k: &mut [[Lanes<W>; D]; STAGES_WITH_DENSE],
    range: std::ops::RangeInclusive<usize>,
) -> [Lanes<W>; D] {
    let mut state = *from;
    for i in range {
        let sum = combine(A[i], k);
        for component in 0..D {
            state[component] = sum[component].mul_add(Lanes::splat(width), from[component]);
        }
        k[i] = system.derivative(s + C[i] * width, &state);
    }
    state
}

/// Error of the step against the tolerance: accepted at 1 or below.
#[inline(always)]
fn error_norm<const D: usize, const W: usize>(
    k: &[[Lanes<W>; D]; STAGES_WITH_DENSE],
    from: &[Lanes<W>; D],
    to: &[Lanes<W>; D],
    width: f64,
    tolerance: &Tolerance<D>,
) -> f64 {
    let fifth = combine(E5, k);
    let third = combine(E3, k);
    let mut looseness = Lanes::<W>::splat(SENSITIVITY_LOOSENESS);
    looseness.0[0] = 1.0;
    let (mut sum5, mut sum3) = (Lanes::<W>::ZERO, Lanes::<W>::ZERO);
    for i in 0..D {
        let size = from[i].max(-from[i]).max(to[i].max(-to[i]));
        let scale = (size * tolerance.relative + tolerance.absolute[i]) * looseness;
        let (e5, e3) = (fifth[i] / scale, third[i] / scale);
        sum5 += e5 * e5;
        sum3 += e3 * e3;
    }
    let denominator = ((sum5 + sum3 * 0.01 + f64::MIN_POSITIVE) * D as f64).sqrt();
    let error = sum5 * width.abs() / denominator;
    let mut largest = 0.0;
    for lane in error.0 {
        // Written so that a NaN lane makes the whole error NaN.
        largest = if lane <= largest { largest } else { lane };
        if lane.is_nan() {
            return f64::NAN;
        }
    }
    // Below this the growth limit rules anyway; keeps the power finite.
    f64::max(largest, 1e-12)
}

#[inline(always)]
fn dense_terms<const D: usize, const W: usize>(
    system: &impl System<D, W>,
    s: f64,
    from: &[Lanes<W>; D],
    to: &[Lanes<W>; D],
    width: f64,
    k: &mut [[Lanes<W>; D]; STAGES_WITH_DENSE],
) -> [[Lanes<W>; D]; DENSE_TERMS] {
    stages(
        system,
        s,
        from,
        width,
        k,
        STAGES + 1..=STAGES_WITH_DENSE - 1,
    );
    let mut terms = [[Lanes::ZERO; D]; DENSE_TERMS];
    for i in 0..D {
        let change = to[i] - from[i];
        terms[0][i] = change;
        terms[1][i] = k[0][i] * width - change;
        terms[2][i] = change * 2.0 - (k[STAGES][i] + k[0][i]) * width;
    }
    for (row, term) in DENSE.iter().zip(terms[3..].iter_mut()) {
        let sum = combine(row, k);
        for i in 0..D {
            term[i] = sum[i] * width;
        }
    }
    terms
}

#[cfg(test)]
mod tests {
    use super::*;

    /// y'' = −ω² y with the derivative by ω in lane 1.
    struct Oscillator {
        frequency: f64,
    }

    impl System<2, 2> for Oscillator {
        fn derivative(&self, _s: f64, y: &[Lanes<2>; 2]) -> [Lanes<2>; 2] {
            let w2 = self.frequency * self.frequency;
            let direct = Lanes([0.0, -2.0 * self.frequency * y[0].0[0]]);
            [y[1], y[0] * -w2 + direct]
        }
    }

    fn errors(relative: f64) -> (f64, f64, usize) {
        let system = Oscillator { frequency: 3.0 };
        let start = [Lanes([0.0, 0.0]), Lanes([3.0, 1.0])];
        let tolerance = Tolerance {
            relative,
            absolute: [relative * 1e-3; 2],
        };
        let mut position = Position::new(&system, 0.0, start, 0.1);
        let (mut value, mut sensitivity, mut steps) = (0.0_f64, 0.0_f64, 0);
        while position.s < 2.0 {
            let done = step(&system, &mut position, 2.0, &tolerance).unwrap();
            steps += 1;
            for i in 0..=10 {
                let sigma = f64::from(i) / 10.0;
                let s = done.start + sigma * done.width;
                let y = done.at(sigma)[0];
                value = value.max((y.0[0] - (3.0 * s).sin()).abs());
                sensitivity = sensitivity.max((y.0[1] - s * (3.0 * s).cos()).abs());
                let lane = dense_at(&done.lane(0, 1), sigma, 1.0 - sigma);
                assert!((lane - y.0[1]).abs() < 1e-14);
            }
        }
        (value, sensitivity, steps)
    }

    /// sin(ωt) and its derivative by ω, t cos(ωt), between the nodes too.
    #[test]
    fn closed_form_oscillator_with_sensitivity() {
        let (value, sensitivity, _) = errors(1e-11);
        assert!(value < 3e-10, "{value:e}");
        assert!(sensitivity < 3e-9, "{sensitivity:e}");
    }

    /// Dense output of order 7: halving the step divides its error by 2^8 (and
    /// at least by 2^7).
    #[test]
    fn converges_with_order_eight() {
        let system = Oscillator { frequency: 3.0 };
        let loose = Tolerance {
            relative: 1e9,
            absolute: [1e9; 2],
        };
        let error = |width: f64| {
            let start = [Lanes([0.0, 0.0]), Lanes([3.0, 1.0])];
            let mut position = Position::new(&system, 0.0, start, width);
            let done = step(&system, &mut position, width, &loose).unwrap();
            let end = (done.to[0].0[0] - (3.0 * width).sin()).abs();
            let middle = (done.at(0.3)[0].0[0] - (0.9 * width).sin()).abs();
            (end, middle)
        };
        let (coarse, fine) = (error(0.4), error(0.2));
        assert!((coarse.0 / fine.0).log2() > 8.5, "{coarse:?} {fine:?}");
        assert!((coarse.1 / fine.1).log2() > 7.5, "{coarse:?} {fine:?}");
    }

    #[test]
    fn rejects_a_system_without_numbers() {
        struct Broken;
        impl System<1, 1> for Broken {
            fn derivative(&self, _s: f64, _y: &[Lanes<1>; 1]) -> [Lanes<1>; 1] {
                [Lanes([f64::NAN])]
            }
        }
        let tolerance = Tolerance {
            relative: 1e-8,
            absolute: [1e-8],
        };
        let mut position = Position::new(&Broken, 1.0, [Lanes([1.0])], 0.1);
        let error = step(&Broken, &mut position, 2.0, &tolerance).unwrap_err();
        assert!(error.to_string().contains("cannot go on from 1"), "{error}");
    }
}
