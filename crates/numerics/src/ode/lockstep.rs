//! Steps of several independent integrations side by side, one per lane of a
//! vector: each lane has its own position, width, limit and tolerance, and its
//! step is accepted or rejected for itself.
//!
//! A single integration waits for the result of each operation before it can
//! begin the next; here the other lanes and columns fill the time. Each lane goes
//! through the very operations of [`step`](crate::ode::step::step), in the same
//! order, so it ends at the same bits, whatever its neighbours do.

use crate::ode::dense::DenseStep;
use crate::ode::step::{DENSE_COEFFICIENTS, StepControl, Tolerance};
use crate::ode::tableau::{A, C, D as DENSE, DENSE_TERMS, E3, E5, Row, STAGES, STAGES_WITH_DENSE};
use crate::real::{Lanes, Real};

/// States of `B` integrations: of each component its value (column 0) and its
/// derivatives (the other columns), one lane per integration.
pub type LockstepState<const D: usize, const W: usize, const B: usize> = [[Lanes<B>; W]; D];

/// Right-hand sides y' = f(s, y) of `B` systems, with the derivatives of f in the
/// columns.
pub trait LockstepSystem<const D: usize, const W: usize, const B: usize> {
    /// y' of each lane at its `s` and state.
    fn derivative<R: Real<Plain = Lanes<B>>>(&self, s: R, state: &[[R; W]; D]) -> [[R; W]; D];
}

/// What became of a lane in one attempt.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// The lane has no integration.
    Idle,
    /// A step was made: see [`Lockstep::step`].
    Accepted,
    /// The step was too wide; the next attempt tries a narrower one.
    Rejected,
    /// The tolerance cannot be met; the lane is idle now.
    Failed,
}

/// One integration to begin.
#[derive(Clone, Copy, Debug)]
pub struct Beginning<const D: usize, const W: usize> {
    /// Independent variable.
    pub s: f64,
    /// State.
    pub state: [Lanes<W>; D],
    /// Width to try first; its sign is the direction.
    pub width: f64,
    /// Where the integration ends.
    pub limit: f64,
    /// Accuracy.
    pub tolerance: Tolerance<D>,
}

/// `B` integrations, and the steps that they made last.
#[derive(Clone, Debug)]
#[repr(align(64))]
pub struct Lockstep<const D: usize, const W: usize, const B: usize> {
    s: Lanes<B>,
    width: Lanes<B>,
    limit: Lanes<B>,
    relative: Lanes<B>,
    absolute: [Lanes<B>; D],
    state: LockstepState<D, W, B>,
    derivative: LockstepState<D, W, B>,
    control: [StepControl; B],
    outcome: [Outcome; B],
    /// 1 for lanes that begin with the next attempt.
    fresh: Lanes<B>,
    /// Start and width of the last step.
    start: Lanes<B>,
    done: Lanes<B>,
    from: LockstepState<D, W, B>,
    to: LockstepState<D, W, B>,
    k: [LockstepState<D, W, B>; STAGES_WITH_DENSE],
    terms: [LockstepState<D, W, B>; DENSE_TERMS],
}

impl<const D: usize, const W: usize, const B: usize> Lockstep<D, W, B> {
    /// No integration in any lane.
    pub const IDLE: Self = {
        let zero = [[Lanes::ZERO; W]; D];
        Self {
            s: Lanes::ZERO,
            // Results of idle lanes are ignored; these are numbers.
            width: Lanes([1.0; B]),
            limit: Lanes([1.0; B]),
            relative: Lanes([1.0; B]),
            absolute: [Lanes([1.0; B]); D],
            state: zero,
            derivative: zero,
            control: [StepControl::NEW; B],
            outcome: [Outcome::Idle; B],
            fresh: Lanes::ZERO,
            start: Lanes::ZERO,
            done: Lanes::ZERO,
            from: zero,
            to: zero,
            k: [zero; STAGES_WITH_DENSE],
            terms: [zero; DENSE_TERMS],
        }
    };

    /// Begins an integration in `lane`, in place of the one that was there.
    #[inline(always)]
    pub fn begin(&mut self, lane: usize, beginning: &Beginning<D, W>) {
        self.s.0[lane] = beginning.s;
        self.width.0[lane] = beginning.width;
        self.limit.0[lane] = beginning.limit;
        self.relative.0[lane] = beginning.tolerance.relative;
        for d in 0..D {
            self.absolute[d].0[lane] = beginning.tolerance.absolute[d];
            for w in 0..W {
                self.state[d][w].0[lane] = beginning.state[d].0[w];
            }
        }
        self.fresh.0[lane] = 1.0;
        self.control[lane] = StepControl::NEW;
        self.outcome[lane] = Outcome::Rejected;
    }

    /// Leaves `lane` without an integration.
    pub fn end(&mut self, lane: usize) {
        self.outcome[lane] = Outcome::Idle;
        for d in 0..D {
            for w in 0..W {
                self.state[d][w].0[lane] = 0.0;
                self.derivative[d][w].0[lane] = 0.0;
            }
        }
        self.s.0[lane] = 0.0;
        (self.width.0[lane], self.limit.0[lane]) = (1.0, 1.0);
    }

    /// What became of `lane` in the last attempt.
    #[inline(always)]
    pub fn outcome(&self, lane: usize) -> Outcome {
        self.outcome[lane]
    }

    /// Where `lane` stands.
    #[inline(always)]
    pub fn position(&self, lane: usize) -> f64 {
        self.s.0[lane]
    }

    /// Width that `lane` tries next.
    #[inline(always)]
    pub fn width(&self, lane: usize) -> f64 {
        self.width.0[lane]
    }

    /// The step that `lane` made in the last attempt, if it was accepted.
    #[inline(always)]
    pub fn step(&self, lane: usize) -> DenseStep<D, W> {
        let mut coefficients = [[[0.0; DENSE_COEFFICIENTS]; W]; D];
        let mut to = [0.0; D];
        for d in 0..D {
            for w in 0..W {
                coefficients[d][w][0] = self.from[d][w].0[lane];
                for term in 0..DENSE_TERMS {
                    coefficients[d][w][1 + term] = self.terms[term][d][w].0[lane];
                }
            }
            to[d] = self.to[d][0].0[lane];
        }
        DenseStep {
            start: self.start.0[lane],
            width: self.done.0[lane],
            to,
            coefficients,
        }
    }
}

/// Tries one step in every lane, with numbers like `zero`.
///
/// # Numerics
/// As [`step`](crate::ode::step::step), whose control of the step each lane has for
/// itself. The stages of the dense output are left out when no lane's step is
/// accepted. Nothing is allocated.
#[inline(always)]
pub fn attempt<R: Real<Plain = Lanes<B>>, const D: usize, const W: usize, const B: usize>(
    zero: R,
    system: &impl LockstepSystem<D, W, B>,
    all: &mut Lockstep<D, W, B>,
) {
    if all.fresh.0.iter().any(|fresh| *fresh > 0.0) {
        let state = with_plain(zero, &all.state);
        let derivative = system.derivative(zero.with_plain(all.s), &state);
        choose(zero, all.fresh, &derivative, &mut all.derivative);
        all.fresh = Lanes::ZERO;
    }
    let mut last = [false; B];
    for lane in 0..B {
        if all.outcome[lane] == Outcome::Idle {
            continue;
        }
        let (s, limit) = (all.s.0[lane], all.limit.0[lane]);
        let control = &mut all.control[lane];
        match control.prepare(s, limit, &mut all.width.0[lane]) {
            Some(is_last) => last[lane] = is_last,
            None => {
                all.end(lane);
                all.outcome[lane] = Outcome::Failed;
            }
        }
    }
    all.start = all.s;
    all.done = all.width;
    all.from = all.state;
    all.k[0] = all.derivative;
    let to = stages(zero, system, all, 1..=STAGES);
    let error = error_norm(&to, all);
    // The error's eighth root.
    let factor = zero.constant(StepControl::SAFETY) / error.sqrt().sqrt().sqrt();
    let (error, factor) = (error.plain(), factor.plain());
    let mut accepted = Lanes::<B>::ZERO;
    for lane in 0..B {
        if matches!(all.outcome[lane], Outcome::Idle | Outcome::Failed) {
            continue;
        }
        let (error, factor) = (error.0[lane], factor.0[lane]);
        let control = &mut all.control[lane];
        if error <= 1.0 {
            accepted.0[lane] = 1.0;
            all.outcome[lane] = Outcome::Accepted;
            let end = all.start.0[lane] + all.done.0[lane];
            all.s.0[lane] = if last[lane] { all.limit.0[lane] } else { end };
            all.width.0[lane] = control.accept(all.done.0[lane], factor);
        } else {
            all.outcome[lane] = Outcome::Rejected;
            all.width.0[lane] = control.reject(all.done.0[lane], error, factor);
        }
    }
    if accepted.0.iter().any(|a| *a > 0.0) {
        dense_terms(system, &to, all);
        let derivative = with_plain(zero, &all.k[STAGES]);
        choose(zero, accepted, &to, &mut all.state);
        choose(zero, accepted, &derivative, &mut all.derivative);
    }
}

/// A state as numbers like `zero`.
#[inline(always)]
fn with_plain<R: Real, const D: usize, const W: usize>(
    zero: R,
    state: &[[R::Plain; W]; D],
) -> [[R; W]; D] {
    let mut out = [[zero; W]; D];
    for d in 0..D {
        out[d] = zero.with_each_plain(state[d]);
    }
    out
}

/// Puts `found` in the place of `state` in the lanes that are 1 in `chosen`.
#[inline(always)]
fn choose<R: Real, const D: usize, const W: usize>(
    zero: R,
    chosen: R::Plain,
    found: &[[R; W]; D],
    state: &mut [[R::Plain; W]; D],
) {
    let chosen = zero.with_plain(chosen);
    for d in 0..D {
        for w in 0..W {
            let other = zero.with_plain(state[d][w]);
            state[d][w] = chosen.select(found[d][w], other).plain();
        }
    }
}

/// Σ a_j k_j for one row of the tableau.
#[inline(always)]
fn combine<R: Real, const D: usize, const W: usize>(
    zero: R,
    row: Row,
    k: &[[[R::Plain; W]; D]; STAGES_WITH_DENSE],
) -> [[R; W]; D] {
    let mut out = [[zero.constant(0.0); W]; D];
    for &(j, a) in row {
        let (a, k) = (zero.constant(a), &k[j]);
        for d in 0..D {
            for w in 0..W {
                out[d][w] = zero.with_plain(k[d][w]).mul_add(a, out[d][w]);
            }
        }
    }
    out
}

/// The states of some stages and their derivatives; the state of the last one.
#[inline(always)]
fn stages<R: Real<Plain = Lanes<B>>, const D: usize, const W: usize, const B: usize>(
    zero: R,
    system: &impl LockstepSystem<D, W, B>,
    all: &mut Lockstep<D, W, B>,
    range: std::ops::RangeInclusive<usize>,
) -> [[R; W]; D] {
    let [start, width] = zero.with_each_plain([all.start, all.done]);
    let from = with_plain(zero, &all.from);
    let mut state = from;
    for i in range {
        let sum = combine(zero, A[i], &all.k);
        for d in 0..D {
            for w in 0..W {
                state[d][w] = sum[d][w].mul_add(width, from[d][w]);
            }
        }
        let derivative = system.derivative(start + width * C[i], &state);
        for d in 0..D {
            all.k[i][d] = zero.each_plain(derivative[d]);
        }
    }
    state
}

/// Error of each lane's step against its tolerance: accepted at 1 or below.
#[inline(always)]
fn error_norm<R: Real<Plain = Lanes<B>>, const D: usize, const W: usize, const B: usize>(
    to: &[[R; W]; D],
    all: &Lockstep<D, W, B>,
) -> R {
    let zero = to[0][0].constant(0.0);
    let fifth = combine(zero, E5, &all.k);
    let third = combine(zero, E3, &all.k);
    let [width, relative] = zero.with_each_plain([all.done, all.relative]);
    let width = width.max(-width);
    let mut largest = zero;
    let mut poison = zero;
    for w in 0..W {
        let looseness = if w == 0 {
            1.0
        } else {
            StepControl::SENSITIVITY
        };
        let (mut sum5, mut sum3) = (zero, zero);
        for d in 0..D {
            let (from, to) = (zero.with_plain(all.from[d][w]), to[d][w]);
            let size = from.max(-from).max(to.max(-to));
            let scale = (size * relative + zero.with_plain(all.absolute[d])) * looseness;
            let (e5, e3) = (fifth[d][w] / scale, third[d][w] / scale);
            sum5 = sum5 + e5 * e5;
            sum3 = sum3 + e3 * e3;
        }
        let denominator = ((sum5 + sum3 * 0.01 + f64::MIN_POSITIVE) * D as f64).sqrt();
        let error = sum5 * width / denominator;
        largest = largest.max(error);
        // Zero, but for a state that left the numbers.
        poison = poison + error * 0.0;
    }
    // Below this the growth limit rules anyway; keeps the power finite.
    largest.max(zero.constant(1e-12)) + poison
}

/// The terms of the dense output of the steps made, which end at `to`.
#[inline(always)]
fn dense_terms<R: Real<Plain = Lanes<B>>, const D: usize, const W: usize, const B: usize>(
    system: &impl LockstepSystem<D, W, B>,
    to: &[[R; W]; D],
    all: &mut Lockstep<D, W, B>,
) {
    let zero = to[0][0];
    stages(zero, system, all, STAGES + 1..=STAGES_WITH_DENSE - 1);
    let width = zero.with_plain(all.done);
    for d in 0..D {
        all.to[d] = zero.each_plain(to[d]);
        for w in 0..W {
            let plain = [all.from[d][w], all.k[0][d][w], all.k[STAGES][d][w]];
            let [from, first, end] = zero.with_each_plain(plain);
            let change = to[d][w] - from;
            all.terms[0][d][w] = change.plain();
            all.terms[1][d][w] = (first * width - change).plain();
            all.terms[2][d][w] = (change * 2.0 - (end + first) * width).plain();
        }
    }
    for (row, term) in DENSE.iter().zip(3..) {
        let sum = combine(zero, row, &all.k);
        for d in 0..D {
            for w in 0..W {
                all.terms[term][d][w] = (sum[d][w] * width).plain();
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ode::step::{Position, StepError, System, step};

    /// y'' = −ω² y + s with the derivative by ω in column 1.
    struct One(f64);

    impl System<2, 2> for One {
        fn derivative(&self, s: f64, y: &[Lanes<2>; 2]) -> [Lanes<2>; 2] {
            let direct = Lanes([s, -2.0 * self.0 * y[0].0[0]]);
            [y[1], y[0] * -(self.0 * self.0) + direct]
        }
    }

    struct Several(Lanes<4>);

    impl LockstepSystem<2, 2, 4> for Several {
        fn derivative<R: Real<Plain = Lanes<4>>>(&self, s: R, y: &[[R; 2]; 2]) -> [[R; 2]; 2] {
            let frequency = s.with_plain(self.0);
            let w2 = -(frequency * frequency);
            let direct = [s, frequency * -2.0 * y[0][0]];
            [y[1], [y[0][0] * w2 + direct[0], y[0][1] * w2 + direct[1]]]
        }
    }

    fn beginning(width: f64, limit: f64, relative: f64) -> Beginning<2, 2> {
        Beginning {
            s: 0.0,
            state: [Lanes([0.0, 0.0]), Lanes([3.0, 1.0])],
            width,
            limit,
            tolerance: Tolerance {
                relative,
                absolute: [relative * 1e-3; 2],
            },
        }
    }

    /// Steps of one integration: start, width and middle of each.
    type Way = Vec<(f64, f64, [Lanes<2>; 2])>;

    fn alone(frequency: f64, beginning: &Beginning<2, 2>) -> Result<Way, StepError> {
        let system = One(frequency);
        let mut at = Position::new(&system, beginning.s, beginning.state, beginning.width);
        let mut way = Way::new();
        while at.s != beginning.limit {
            let done = step(&system, &mut at, beginning.limit, &beginning.tolerance)?;
            let done = DenseStep::from(&done);
            way.push((done.start, done.width, done.at(0.3)));
        }
        Ok(way)
    }

    /// Seven integrations through four lanes, in the given order.
    fn together(order: &[usize], all: &[(f64, Beginning<2, 2>)]) -> Vec<Way> {
        let mut ways = vec![Way::new(); all.len()];
        let mut waiting = order.iter().copied();
        let mut system = Several(Lanes::splat(1.0));
        let mut lockstep = Lockstep::<2, 2, 4>::IDLE;
        let mut busy: [Option<usize>; 4] = [None; 4];
        loop {
            for lane in 0..4 {
                if busy[lane].is_none() {
                    busy[lane] = waiting.next();
                    match busy[lane] {
                        Some(i) => {
                            system.0.0[lane] = all[i].0;
                            lockstep.begin(lane, &all[i].1);
                        }
                        None => lockstep.end(lane),
                    }
                }
            }
            if busy.iter().all(Option::is_none) {
                return ways;
            }
            attempt(Lanes::ZERO, &system, &mut lockstep);
            for (lane, slot) in busy.iter_mut().enumerate() {
                let Some(i) = *slot else { continue };
                assert_ne!(lockstep.outcome(lane), Outcome::Idle);
                if lockstep.outcome(lane) == Outcome::Accepted {
                    let done = lockstep.step(lane);
                    ways[i].push((done.start, done.width, done.at(0.3)));
                }
                let over = lockstep.position(lane) == all[i].1.limit;
                if over || lockstep.outcome(lane) == Outcome::Failed {
                    *slot = None;
                }
            }
        }
    }

    fn cases() -> Vec<(f64, Beginning<2, 2>)> {
        // The second's first step is rejected, the fourth goes backwards.
        vec![
            (3.0, beginning(0.1, 2.0, 1e-11)),
            (5.0, beginning(9.0, 9.0, 1e-9)),
            (0.5, beginning(0.3, 4.0, 1e-6)),
            (2.0, beginning(-0.2, -1.5, 1e-8)),
            (7.0, beginning(0.01, 3.0, 1e-10)),
            (1.0, beginning(1.0, 1.0, 1e-4)),
            (4.0, beginning(0.1, 0.7, 1e-12)),
        ]
    }

    /// The same steps and the same bits as one integration after the other.
    #[test]
    fn repeats_single_integrations_to_the_bit() {
        let all = cases();
        let found = together(&[0, 1, 2, 3, 4, 5, 6], &all);
        for ((frequency, beginning), found) in all.iter().zip(&found) {
            let expected = alone(*frequency, beginning).unwrap();
            assert!(!expected.is_empty());
            assert_eq!(*found, expected, "frequency {frequency}");
        }
    }

    #[test]
    fn repeats_in_any_order() {
        let all = cases();
        let forward = together(&[0, 1, 2, 3, 4, 5, 6], &all);
        assert_eq!(forward, together(&[6, 2, 0, 5, 3, 1, 4], &all));
        assert_eq!(forward[3], together(&[3], &all)[3]);
    }

    /// A lane without numbers fails for itself alone.
    #[test]
    fn rejects_a_lane_without_numbers() {
        let mut all = cases();
        all[1].0 = f64::NAN;
        let found = together(&[0, 1, 2, 3, 4, 5, 6], &all);
        assert!(found[1].is_empty());
        assert!(alone(f64::NAN, &all[1].1).is_err());
        assert_eq!(found[0], alone(all[0].0, &all[0].1).unwrap());
    }
}
