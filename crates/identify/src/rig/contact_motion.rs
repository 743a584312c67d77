//! One impact of a rig under a force law, integrated with its sensitivities:
//! flight before, contact, flight after.
//!
//! The state is (x, v) with the derivatives by the free parameters in the
//! lanes. Time is counted from first touch, in contact as t = s^q
//! ([`ContactLaw::start_power`]).

use crate::rig::contact_stop::{Phase, Stop, carry_jump, first_stop};
use crate::rig::contact_time::{scaled_time, time_of};
use crate::rig::impact_event::ImpactEvent;
use crate::rig::motion::Motion;
use windfall_contact::law::ContactLaw;
use windfall_numerics::ode::dense::DenseStep;
use windfall_numerics::ode::step::{Position, Step, StepError, System, Tolerance, step};
use windfall_numerics::real::Lanes;
use windfall_numerics::real_vector::compiled_for_vectors;

/// Steps before an integration is given up: an impact takes about ten.
pub(crate) const LARGEST_STEPS: usize = 20_000;
/// First step, as a fraction of the range to integrate, at a relative tolerance of
/// [`FIRST_TOLERANCE`]; the steps of a method of order 8 grow with the eighth root
/// of the tolerance.
const FIRST_STEP: f64 = 0.1;
const FIRST_TOLERANCE: f64 = 1e-8;

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

impl<const W: usize> Segment<W> {
    /// A piece in flight, or under a law without history.
    #[inline(always)]
    pub(crate) fn without_peak(step: DenseStep<2, W>, power: u32, from: f64, to: f64) -> Self {
        Self {
            step,
            power,
            from,
            to,
            peak: 0.0,
            peak_lanes: Lanes::ZERO,
        }
    }
}

/// Whether the bodies touch during a piece of the motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Piece {
    /// They touch.
    Contact,
    /// Before or after.
    Flight,
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

/// Follows the impact from `before` (≤ 0) to `after` (s since first touch) and
/// hands each piece to `sink`, the flight before first.
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
    sink: &mut impl FnMut(&Segment<W>, Piece),
) -> Result<Option<Separation>, StepError> {
    let touch = event.touch_state();
    if before < 0.0 {
        fly(event, touch, 0.0, before, sink)?;
    }
    if after <= 0.0 {
        return Ok(None);
    }
    let mut phase = Phase::new(event);
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

/// Flight without contact from `from` to `to`, in either direction.
#[inline(always)]
fn fly<L, const N: usize, const W: usize>(
    event: &ImpactEvent<L, N, W>,
    state: [Lanes<W>; 2],
    from: f64,
    to: f64,
    sink: &mut impl FnMut(&Segment<W>, Piece),
) -> Result<(), StepError> {
    let flight = Flight {
        motion: event.motion,
    };
    let mut position = Position::new(&flight, from, state, to - from);
    for _ in 0..LARGEST_STEPS {
        let done = flight_step(&flight, &mut position, to, &event.tolerance)?;
        let done = DenseStep::from(&done);
        let end = done.start + done.width;
        let segment = Segment::without_peak(done, 1, done.start.min(end), done.start.max(end));
        sink(&segment, Piece::Flight);
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
    compiled_for_vectors(FlightStep {
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

impl<const W: usize> pulp::NullaryFnOnce for FlightStep<'_, W> {
    type Output = Result<Step<2, W>, StepError>;

    #[inline(always)]
    fn call(self) -> Self::Output {
        step(self.flight, self.position, self.limit, self.tolerance)
    }
}

fn too_long<const W: usize>(position: &Position<2, W>) -> StepError {
    StepError {
        s: position.s,
        width: position.width,
    }
}

/// Contact from touch until it ends or `after`; the end's time and state.
#[inline(always)]
fn touching<L: ContactLaw<N>, const N: usize, const W: usize>(
    phase: &mut Phase<L, N, W>,
    state: [Lanes<W>; 2],
    after: f64,
    sink: &mut impl FnMut(&Segment<W>, Piece),
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
        let segment = Segment {
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
        };
        sink(&segment, Piece::Contact);
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
