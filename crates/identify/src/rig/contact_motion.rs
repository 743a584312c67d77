//! One impact of a rig under a force law, integrated with its sensitivities:
//! flight before, contact, flight after.
//!
//! The state is (x, v) with the derivatives by the free parameters in the
//! lanes. Time is counted from first touch, and during contact it runs as
//! t = s^q ([`ContactLaw::START_POWER`]): a law that starts like √x is then
//! smooth in s and the integrator keeps its order from the first step.

use crate::rig::motion::Motion;
use windfall_contact::law::{ContactForce, ContactLaw, EndRule, SMALLEST_DISPLACEMENT};
use windfall_numerics::ode::dense::DenseStep;
use windfall_numerics::ode::step::{Position, Step, StepError, System, Tolerance, step};
use windfall_numerics::real::{Lanes, Real};
use windfall_numerics::root::bracketed_root;

/// Steps before an integration is given up: an impact takes about ten.
pub(crate) const LARGEST_STEPS: usize = 20_000;
/// First step, as a fraction of the range to integrate, at a relative tolerance of
/// [`FIRST_TOLERANCE`]; the steps of a method of order 8 grow with the eighth root
/// of the tolerance.
const FIRST_STEP: f64 = 0.1;
const FIRST_TOLERANCE: f64 = 1e-8;
/// Event times are located to this fraction of a step.
const EVENT_TOLERANCE: f64 = 1e-14;
/// Where a contact that ends within its very first step is looked for from.
const EARLIEST_END: f64 = 1e-3;

/// Derivatives of the inputs by each free parameter, one lane each; lane 0 is
/// unused.
#[derive(Clone, Copy, Debug)]
pub struct Seeds<const N: usize, const W: usize> {
    /// Of each parameter of the law.
    pub parameters: [Lanes<W>; N],
    /// Of the velocity at first touch.
    pub velocity: Lanes<W>,
}

impl<const N: usize, const W: usize> Seeds<N, W> {
    /// Nothing is free.
    pub const NONE: Self = Self {
        parameters: [Lanes::ZERO; N],
        velocity: Lanes::ZERO,
    };
}

/// What happens: a body with `motion` touches at time zero with `velocity`.
#[derive(Clone, Copy, Debug)]
pub struct ImpactEvent<L, const N: usize, const W: usize> {
    /// Force law.
    pub law: L,
    /// Equation of motion.
    pub motion: Motion,
    /// Velocity at first touch; m/s.
    pub velocity: f64,
    /// When the contact is over.
    pub end: EndRule,
    /// Free parameters.
    pub seeds: Seeds<N, W>,
    /// Accuracy: relative, absolute for x (m) and v (m/s).
    pub tolerance: Tolerance<2>,
}

/// A piece of the motion: dense output valid for times in `[from, to]`.
#[derive(Clone, Copy, Debug)]
pub struct Segment<const W: usize> {
    /// Dense output in s.
    pub step: DenseStep<2, W>,
    /// q of t = s^q.
    pub power: u32,
    /// First time of validity; s.
    pub from: f64,
    /// Last time of validity; s.
    pub to: f64,
    /// Largest displacement so far, for laws with history; m.
    pub peak: f64,
    /// Its derivatives.
    pub peak_lanes: Lanes<W>,
}

/// Takes the pieces of a motion as they are integrated.
pub trait Sink<const W: usize> {
    /// A piece in which the bodies touch.
    fn contact(&mut self, segment: &Segment<W>);
    /// A piece before or after.
    fn flight(&mut self, segment: &Segment<W>);
}

/// State at the end of contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Separation {
    /// Time since first touch; s.
    pub time: f64,
    /// Displacement left; m.
    pub displacement: f64,
    /// Rate, negative; m/s.
    pub rate: f64,
}

/// s of t = s^q.
#[inline(always)]
pub fn scaled_time<R: Real>(time: R, power: u32) -> R {
    match power {
        1 => time,
        2 => time.sqrt(),
        _ => time.sqrt().sqrt(),
    }
}

/// t = s^q.
#[inline(always)]
pub fn time_of(s: f64, power: u32) -> f64 {
    match power {
        1 => s,
        2 => s * s,
        _ => (s * s) * (s * s),
    }
}

/// Right-hand side without contact.
struct Flight {
    motion: Motion,
}

impl<const W: usize> System<2, W> for Flight {
    #[inline(always)]
    fn derivative(&self, _s: f64, state: &[Lanes<W>; 2]) -> [Lanes<W>; 2] {
        let [x, v] = *state;
        let a = self.motion.acceleration(x.0[0], v.0[0], 0.0);
        let mut rate = x * a.by_displacement + v * a.by_rate;
        rate.0[0] = a.value;
        [v, rate]
    }
}

/// Right-hand side during contact.
struct Phase<'a, L, const N: usize, const W: usize> {
    event: &'a ImpactEvent<L, N, W>,
    power: u32,
    peak: f64,
    peak_lanes: Lanes<W>,
}

impl<L: ContactLaw<N>, const N: usize, const W: usize> Phase<'_, L, N, W> {
    #[inline(always)]
    fn force(&self, x: f64, v: f64) -> ContactForce<f64, N> {
        let d = Real::max(x, SMALLEST_DISPLACEMENT);
        self.event.law.evaluate(d, v, self.peak)
    }
}

impl<L: ContactLaw<N>, const N: usize, const W: usize> System<2, W> for Phase<'_, L, N, W> {
    #[inline(always)]
    fn derivative(&self, s: f64, state: &[Lanes<W>; 2]) -> [Lanes<W>; 2] {
        let [x, v] = *state;
        let event = self.event;
        let stretch = match self.power {
            1 => 1.0,
            2 => 2.0 * s,
            _ => 4.0 * s * s * s,
        };
        let force = self.force(x.0[0], v.0[0]);
        let a = event.motion.acceleration(x.0[0], v.0[0], force.force);
        let mut direct = self.peak_lanes * force.by_peak;
        for (by, seed) in force.by_parameter.iter().zip(&event.seeds.parameters) {
            direct += *seed * *by;
        }
        let mut rate = x * (a.by_displacement + a.by_force * force.by_displacement)
            + v * (a.by_rate + a.by_force * force.by_rate)
            + direct * a.by_force;
        rate.0[0] = a.value;
        [v * stretch, rate * stretch]
    }
}

/// Follows the impact from `before` (≤ 0) to `after` (s since first touch) and
/// hands each piece to `sink` in order of time, the flight before first.
///
/// Returns the end of contact, or `None` when it lies after `after`.
///
/// # Errors
/// [`StepError`] when the tolerance cannot be met.
///
/// # Numerics
/// The end of contact, the first maximum of laws with history and the kink of
/// laws that have one are located on the dense output and end a step. The end
/// by gap, where the force jumps, carries its jump of the sensitivities.
/// Nothing is allocated.
#[inline(always)]
pub fn follow<L: ContactLaw<N>, const N: usize, const W: usize>(
    event: &ImpactEvent<L, N, W>,
    before: f64,
    after: f64,
    sink: &mut impl Sink<W>,
) -> Result<Option<Separation>, StepError> {
    let touch = touch_state(event);
    if before < 0.0 {
        fly(event, touch, 0.0, before, sink)?;
    }
    if after <= 0.0 {
        return Ok(None);
    }
    let mut phase = Phase {
        event,
        power: event.law.start_power(),
        peak: 0.0,
        peak_lanes: Lanes::ZERO,
    };
    match touching(&mut phase, touch, after, sink)? {
        None => Ok(None),
        Some((time, mut state)) => {
            let separation = Separation {
                time,
                displacement: state[0].0[0],
                rate: state[1].0[0],
            };
            carry_jump(&phase, &mut state);
            if after > time {
                fly(event, state, time, after, sink)?;
            }
            Ok(Some(separation))
        }
    }
}

/// Width of the first step of a contact that is followed to `limit`.
#[inline(always)]
pub(crate) fn first_width(limit: f64, tolerance: &Tolerance<2>) -> f64 {
    let looseness = (tolerance.relative / FIRST_TOLERANCE).sqrt().sqrt().sqrt();
    limit * (FIRST_STEP * looseness).min(1.0)
}

/// Displacement and rate at first touch.
#[inline(always)]
pub(crate) fn touch_state<L, const N: usize, const W: usize>(
    event: &ImpactEvent<L, N, W>,
) -> [Lanes<W>; 2] {
    let mut velocity = event.seeds.velocity;
    velocity.0[0] = event.velocity;
    [Lanes::ZERO, velocity]
}

/// Where in a step of contact the contact ends, if it does: fraction of the step
/// and the state with which the flight begins. For laws without history.
#[inline(always)]
pub(crate) fn separation<L: ContactLaw<N>, const N: usize, const W: usize>(
    event: &ImpactEvent<L, N, W>,
    done: &DenseStep<2, W>,
) -> Option<(f64, [Lanes<W>; 2])> {
    let phase = Phase {
        event,
        power: event.law.start_power(),
        peak: 0.0,
        peak_lanes: Lanes::ZERO,
    };
    let sigma = end_of_contact(&phase, done)?;
    let mut state = done.at(sigma);
    carry_jump(&phase, &mut state);
    Some((sigma, state))
}

/// Flight without contact from `from` to `to`, in either direction.
#[inline(always)]
fn fly<L, const N: usize, const W: usize>(
    event: &ImpactEvent<L, N, W>,
    state: [Lanes<W>; 2],
    from: f64,
    to: f64,
    sink: &mut impl Sink<W>,
) -> Result<(), StepError> {
    let flight = Flight {
        motion: event.motion,
    };
    let mut position = Position::new(&flight, from, state, to - from);
    for _ in 0..LARGEST_STEPS {
        let done = flight_step(&flight, &mut position, to, &event.tolerance)?;
        let done = DenseStep::from(&done);
        let end = done.start + done.width;
        sink.flight(&Segment {
            step: done,
            power: 1,
            from: done.start.min(end),
            to: done.start.max(end),
            peak: 0.0,
            peak_lanes: Lanes::ZERO,
        });
        if position.s == to {
            return Ok(());
        }
    }
    Err(too_long(&position))
}

/// One step of flight: the same for every law, so compiled once.
#[inline(never)]
fn flight_step<const W: usize>(
    flight: &Flight,
    position: &mut Position<2, W>,
    limit: f64,
    tolerance: &Tolerance<2>,
) -> Result<Step<2, W>, StepError> {
    pulp::Arch::new().dispatch(FlightStep {
        flight,
        position,
        limit,
        tolerance,
    })
}

/// [`flight_step`], compiled for the machine's vector instructions.
struct FlightStep<'a, const W: usize> {
    flight: &'a Flight,
    position: &'a mut Position<2, W>,
    limit: f64,
    tolerance: &'a Tolerance<2>,
}

impl<const W: usize> pulp::WithSimd for FlightStep<'_, W> {
    type Output = Result<Step<2, W>, StepError>;

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, _simd: S) -> Self::Output {
        step(self.flight, self.position, self.limit, self.tolerance)
    }
}

fn too_long<const W: usize>(position: &Position<2, W>) -> StepError {
    StepError {
        s: position.s,
        width: position.width,
    }
}

/// What ends a step of the contact before its end.
#[derive(Clone, Copy, PartialEq)]
enum Stop {
    End,
    Peak,
    Kink,
}

/// Contact from touch until it ends or `after`; the end's time and state.
#[inline(always)]
fn touching<L: ContactLaw<N>, const N: usize, const W: usize>(
    phase: &mut Phase<L, N, W>,
    state: [Lanes<W>; 2],
    after: f64,
    sink: &mut impl Sink<W>,
) -> Result<Option<(f64, [Lanes<W>; 2])>, StepError> {
    let power = phase.power;
    let limit = scaled_time(after, power);
    let kink = phase.event.law.kink();
    let mut beyond_kink = false;
    let mut loading = true;
    let mut position = Position::new(
        phase,
        0.0,
        state,
        first_width(limit, &phase.event.tolerance),
    );
    for _ in 0..LARGEST_STEPS {
        let done = step(phase, &mut position, limit, &phase.event.tolerance)?;
        let done = DenseStep::from(&done);
        let stop = first_stop(phase, &done, loading, kink, beyond_kink);
        let to = stop.map_or(position.s, |(_, sigma)| done.start + sigma * done.width);
        sink.contact(&Segment {
            step: done,
            power,
            from: time_of(done.start, power),
            // The limit was given as a time: do not lose its last bit to the root.
            to: if to == limit {
                after
            } else {
                time_of(to, power)
            },
            peak: phase.peak,
            peak_lanes: phase.peak_lanes,
        });
        match stop {
            Some((Stop::End, sigma)) => return Ok(Some((time_of(to, power), done.at(sigma)))),
            Some((kind, sigma)) => {
                let at = done.at(sigma);
                if kind == Stop::Peak {
                    // Unloading starts from here; or a reloading past the old
                    // maximum is virgin loading again.
                    loading = !loading;
                    phase.peak = if loading { 0.0 } else { at[0].0[0] };
                    phase.peak_lanes = if loading { Lanes::ZERO } else { at[0] };
                } else {
                    beyond_kink = !beyond_kink;
                }
                position = Position::new(phase, to, at, position.width);
            }
            None if position.s == limit => return Ok(None),
            None => {}
        }
    }
    Err(too_long(&position))
}

/// The first event within a step, with its fraction of the step.
#[inline(always)]
fn first_stop<L: ContactLaw<N>, const N: usize, const W: usize>(
    phase: &Phase<L, N, W>,
    done: &DenseStep<2, W>,
    loading: bool,
    kink: f64,
    beyond_kink: bool,
) -> Option<(Stop, f64)> {
    let [x, v] = done.to;
    let mut stop = None;
    if phase.event.law.history() {
        let turned = if loading {
            v <= 0.0
        } else {
            x > phase.peak && v > 0.0
        };
        if turned {
            let sigma = if loading {
                locate(done, 0.0, 1.0, |y| y[1])
            } else {
                let peak = phase.peak;
                locate(done, 0.0, 1.0, |y| peak - y[0])
            };
            stop = Some((Stop::Peak, sigma));
        }
    }
    if kink.is_finite() && (x > kink) != beyond_kink {
        let side = if beyond_kink { 1.0 } else { -1.0 };
        let sigma = locate(done, 0.0, 1.0, |y| side * (y[0] - kink));
        stop = earlier(stop, (Stop::Kink, sigma));
    }
    match end_of_contact(phase, done) {
        Some(sigma) => earlier(stop, (Stop::End, sigma)),
        None => stop,
    }
}

/// The event that comes first within a step.
pub fn earlier<E: Copy>(first: Option<(E, f64)>, second: (E, f64)) -> Option<(E, f64)> {
    match first {
        Some(found) if found.1 <= second.1 => Some(found),
        _ => Some(second),
    }
}

/// Fraction of the step at which the contact ends, if it does.
#[inline(always)]
fn end_of_contact<L: ContactLaw<N>, const N: usize, const W: usize>(
    phase: &Phase<L, N, W>,
    done: &DenseStep<2, W>,
) -> Option<f64> {
    let [x, v] = done.to;
    // In the very first step the state starts at zero displacement and force.
    let lowest = if done.start == 0.0 { EARLIEST_END } else { 0.0 };
    let opened = x <= 0.0;
    if phase.event.end == EndRule::GapZero {
        return opened.then(|| locate(done, lowest, 1.0, |y| y[0]));
    }
    if !opened && phase.force(x, v).force > 0.0 {
        return None;
    }
    // The force of an elastic law falls to zero with the gap; that of a damped
    // one before it.
    let highest = if opened {
        locate(done, lowest, 1.0, |y| y[0])
    } else {
        1.0
    };
    let at = done.at(highest);
    if opened && phase.force(SMALLEST_DISPLACEMENT, at[1].0[0]).force >= 0.0 {
        return Some(highest);
    }
    Some(locate(done, lowest, highest, |y| {
        phase.force(y[0], y[1]).force
    }))
}

/// Root in `[low, high]` of a function of (x, v) that is positive before.
#[inline(always)]
fn locate<const W: usize>(
    done: &DenseStep<2, W>,
    low: f64,
    high: f64,
    function: impl Fn([f64; 2]) -> f64,
) -> f64 {
    let [x, v] = [0, 1].map(|component| &done.coefficients[component][0]);
    bracketed_root(low, high, EVENT_TOLERANCE, |sigma| {
        let dense = windfall_numerics::ode::step::dense_at::<f64>;
        function([dense(x, sigma, 1.0 - sigma), dense(v, sigma, 1.0 - sigma)])
    })
}

/// Jump of the sensitivities where the force jumps to zero at the end:
/// ∂v/∂p grows by (a₋ − a₊) ∂t/∂p, with ∂t/∂p = −(∂x/∂p)/v at the gap.
#[inline(always)]
fn carry_jump<L: ContactLaw<N>, const N: usize, const W: usize>(
    phase: &Phase<L, N, W>,
    state: &mut [Lanes<W>; 2],
) {
    if phase.event.end == EndRule::ForceZero {
        return;
    }
    let (x, v) = (state[0].0[0], state[1].0[0]);
    let touching = phase.force(x, v).force;
    let jump = phase.event.motion.acceleration(x, v, touching).value
        - phase.event.motion.acceleration(x, v, 0.0).value;
    let mut change = state[0] * (-jump / v);
    change.0[0] = 0.0;
    state[1] += change;
}
