//! A drop from first touch on: contacts, relaxation and flights in turn.

use crate::contact::{
    ContactPiece, ContactStop, LONGEST_CONTACT, Memory, follow_contact, force_dual,
};
use crate::dual::{fixed, instant, mapped, product};
use crate::event::{DropEvent, RigDuals, rig_duals};
use crate::flight::FlightPiece;
use crate::plate_ringing::Ringing;
use windfall_contact::law::ContactLaw;
use windfall_numerics::ode::step::StepError;
use windfall_numerics::real::{Lanes, Real};
use windfall_numerics::root::bracketed_root;

/// Parts of the estimated time to the opening of a gap in which it is watched.
const RELAXATION_PARTS: f64 = 16.0;
/// Steps before the watch of a relaxing contact is given up.
const LARGEST_STEPS: usize = 100_000;
/// Contacts that may resume within one impact.
const LARGEST_RESUMPTIONS: usize = 1_000;
/// Events are located to this fraction of the bracket.
const EVENT_TOLERANCE: f64 = 1e-14;

/// First touch of an impact: with total derivatives.
#[derive(Clone, Copy, Debug)]
pub struct Touch<const W: usize> {
    /// Since first touch of the drop; s.
    pub time: Lanes<W>,
    /// Height of the fruit and of the plate, 0 at its static position; m.
    pub height: Lanes<W>,
    /// Velocity of the fruit, up positive; m/s.
    pub velocity: Lanes<W>,
    /// Velocity of the plate, up positive; m/s.
    pub plate_velocity: Lanes<W>,
}

/// The fruit leaves the plate: with total derivatives.
#[derive(Clone, Copy, Debug)]
pub struct Departure<const W: usize> {
    /// When the force came to zero, since first touch of the drop; s.
    pub force_end: Lanes<W>,
    /// When the gap opened; s.
    pub time: Lanes<W>,
    /// Height of the fruit (its centre of mass) then; m.
    pub height: Lanes<W>,
    /// Velocity of the fruit's centre of mass, up positive; m/s.
    pub velocity: Lanes<W>,
    /// Velocity of the point of contact over the plate; m/s.
    pub relative_velocity: Lanes<W>,
}

/// Takes the pieces of a drop as they come.
pub trait DropSink<const W: usize> {
    /// An impact begins.
    fn touch(&mut self, touch: &Touch<W>);
    /// A piece of it in which the bodies press on each other.
    fn contact(&mut self, piece: &ContactPiece<W>);
    /// A piece without contact force.
    fn flight(&mut self, piece: &FlightPiece<W>);
    /// The fruit has left the plate.
    fn departure(&mut self, _departure: &Departure<W>) {}
    /// It touches the plate again after the last requested impact.
    fn beyond(&mut self, _touch: &Touch<W>) {}
}

/// How a drop that was followed ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DropEnding {
    /// All requested impacts, and the flight after them.
    Complete,
    /// The fruit stays on the plate.
    AtRest,
    /// Time ran out.
    Until,
}

/// Where an impact stands between its parts.
#[derive(Clone, Copy)]
struct Stage<const W: usize> {
    /// Since first touch of the drop; s.
    time: Lanes<W>,
    /// d, d', x, x'.
    state: [Lanes<W>; 4],
    memory: Memory<W>,
}

/// Follows a drop through `impacts` impacts and the flight after the last, or
/// until `until` (s since first touch).
///
/// # Errors
/// [`StepError`] when the tolerance cannot be met.
///
/// # Numerics
/// Contacts are integrated ([`crate::contact`]); flights and the plate's
/// ringing are closed forms, and touch and separation are located on them. A
/// contact whose force has come to zero is memoryless: while the bodies still
/// overlap it resumes as soon as the law pushes again. No time is lost to the
/// length of a flight, and nothing is allocated.
#[inline(always)]
pub fn follow_drop<L: ContactLaw<N>, const N: usize, const W: usize>(
    event: &DropEvent<L, N, W>,
    impacts: usize,
    until: f64,
    sink: &mut impl DropSink<W>,
) -> Result<DropEnding, StepError> {
    let rig = rig_duals(event);
    let velocity = mapped(event.seeds.velocity, -event.velocity, -1.0);
    let mut touch = Touch {
        time: fixed(0.0),
        height: fixed(0.0),
        velocity,
        plate_velocity: fixed(0.0),
    };
    for _ in 0..impacts {
        sink.touch(&touch);
        let state = [
            fixed(0.0),
            touch.plate_velocity - touch.velocity,
            touch.height,
            touch.plate_velocity,
        ];
        let stage = Stage {
            time: touch.time,
            state,
            memory: Memory::NONE,
        };
        let Some(last) = impact(event, &rig, &touch, stage, until, sink)? else {
            return Ok(DropEnding::Until);
        };
        let Some(stage) = last else {
            return Ok(DropEnding::AtRest);
        };
        let mut flight = flight_after(&rig, &touch, &stage);
        let next = flight.next_touch();
        flight.duration = next.unwrap_or(f64::INFINITY);
        sink.flight(&flight);
        let Some(time) = next else {
            return Ok(DropEnding::AtRest);
        };
        if flight.start.0[0] + time >= until {
            return Ok(DropEnding::Until);
        }
        let (after, [height, velocity, _, plate_velocity]) = flight.touch_at(time);
        touch = Touch {
            time: flight.start + after,
            height,
            velocity,
            plate_velocity,
        };
    }
    sink.beyond(&touch);
    Ok(DropEnding::Complete)
}

/// One impact, from touch until the gap is open: the stage then; `Some(None)`
/// when the fruit stays on the plate, `None` when time ran out.
#[allow(clippy::type_complexity)]
#[inline(always)]
fn impact<L: ContactLaw<N>, const N: usize, const W: usize>(
    event: &DropEvent<L, N, W>,
    rig: &RigDuals<W>,
    touch: &Touch<W>,
    from: Stage<W>,
    until: f64,
    sink: &mut impl DropSink<W>,
) -> Result<Option<Option<Stage<W>>>, StepError> {
    let mut stage = from;
    let mut power = event.law.start_power();
    let mut longest = f64::INFINITY;
    for _ in 0..LARGEST_RESUMPTIONS {
        let left = until - stage.time.0[0];
        if left <= 0.0 {
            return Ok(None);
        }
        let end = follow_contact(
            event,
            rig,
            (stage.state, stage.memory),
            (stage.time, power),
            (left, longest),
            |piece| sink.contact(piece),
        )?;
        let since = stage.time.0[0] - touch.time.0[0];
        stage = Stage {
            time: stage.time + end.time,
            state: end.state,
            memory: end.memory,
        };
        let force_end = stage.time;
        match end.stop {
            ContactStop::Until => return Ok(None),
            ContactStop::Lasting => return Ok(Some(None)),
            ContactStop::Opened => {}
            ContactStop::ForceZero => match relax(event, rig, touch, &mut stage, sink) {
                Relaxed::Opened => {}
                Relaxed::Resumed => {
                    power = 1;
                    longest = LONGEST_CONTACT * (since + end.time.0[0]);
                    continue;
                }
                Relaxed::Never => return Ok(Some(None)),
            },
        }
        let flight = flight_after(rig, touch, &stage);
        sink.departure(&Departure {
            force_end,
            time: stage.time,
            height: flight.height,
            velocity: flight.velocity,
            relative_velocity: -stage.state[1],
        });
        return Ok(Some(Some(stage)));
    }
    Ok(Some(None))
}

/// What becomes of a contact without force while the bodies still overlap.
enum Relaxed {
    Opened,
    Resumed,
    Never,
}

/// The plate's free motion from a stage.
fn ringing_from<const W: usize>(rig: &RigDuals<W>, stage: &Stage<W>) -> Option<Ringing<W>> {
    rig.ringing.map(|ringing| Ringing {
        displacement: stage.state[2],
        velocity: stage.state[3],
        ..ringing
    })
}

/// The point of contact in free flight from a stage; its height is that of the
/// plate less the indentation.
fn contact_flight<const W: usize>(rig: &RigDuals<W>, stage: &Stage<W>) -> FlightPiece<W> {
    let [d, rate, x, u] = stage.state;
    FlightPiece {
        start: stage.time,
        duration: f64::INFINITY,
        height: x - d,
        velocity: u - rate,
        gravity: rig.gravity,
        plate: ringing_from(rig, stage),
    }
}

/// The fruit's centre of mass in free flight from a stage of the impact that
/// began at `touch`.
///
/// The force F = f m (w' + g) on the point of contact, with its velocity w,
/// gives the centre of mass the acceleration f (w' + g) − g.
fn flight_after<const W: usize>(
    rig: &RigDuals<W>,
    touch: &Touch<W>,
    stage: &Stage<W>,
) -> FlightPiece<W> {
    let point = contact_flight(rig, stage);
    let time = stage.time - touch.time;
    let fallen = product(rig.gravity, time);
    let gained = point.velocity - touch.velocity + fallen;
    let risen = product(touch.velocity, time);
    let drop = product(fallen, time) * 0.5;
    let moved = point.height - touch.height - risen + drop;
    FlightPiece {
        height: touch.height + risen - drop + product(rig.factor, moved),
        velocity: touch.velocity - fallen + product(rig.factor, gained),
        ..point
    }
}

/// Watches the gap after the force came to zero; moves `stage` to where it
/// opens, or to where the law pushes again.
#[inline(always)]
fn relax<L: ContactLaw<N>, const N: usize, const W: usize>(
    event: &DropEvent<L, N, W>,
    rig: &RigDuals<W>,
    touch: &Touch<W>,
    stage: &mut Stage<W>,
    sink: &mut impl DropSink<W>,
) -> Relaxed {
    let flight = contact_flight(rig, stage);
    let memory = stage.memory;
    let overlap = |t: f64| {
        let (x, u) = flight.plate.map_or((0.0, 0.0), |plate| plate.values_at(t));
        let (y, w) = {
            let (y, w) = flight.fruit(t);
            (y.0[0], w.0[0])
        };
        (x - y, u - w)
    };
    let push = |t: f64| {
        let (d, rate) = overlap(t);
        let d = Real::max(d, windfall_contact::law::SMALLEST_DISPLACEMENT);
        event.law.evaluate(d, rate, memory.peak).force
    };
    let (depth, rate) = overlap(0.0);
    let short = flight.plate.map_or(f64::INFINITY, |p| p.short_time());
    let scale = (depth / rate.abs()).min((2.0 * depth / rig.gravity.0[0]).sqrt());
    let step = (scale / RELAXATION_PARTS).min(short).max(f64::MIN_POSITIVE);
    let mut before = 0.0;
    for _ in 0..LARGEST_STEPS {
        let after = before + step;
        let tolerance = EVENT_TOLERANCE * after;
        let (depth, _) = overlap(after);
        if depth <= 0.0 {
            let time = bracketed_root(before, after, tolerance, |t| overlap(t).0);
            advance(rig, touch, &flight, stage, time, true, sink);
            return Relaxed::Opened;
        }
        if before > 0.0 && push(after) > 0.0 {
            let time = bracketed_root(before, after, tolerance, |t| -push(t));
            advance(rig, touch, &flight, stage, time, false, sink);
            let (force, law) = force_dual(
                event,
                stage.state[0],
                stage.state[1],
                memory.peak,
                memory.peak_lanes,
            );
            resume(stage, rig, force, (law.by_displacement, law.by_rate));
            return Relaxed::Resumed;
        }
        before = after;
    }
    Relaxed::Never
}

/// Hands on the flight up to `time` and moves the stage there; derivatives are
/// total where the gap `opens`, and at fixed time otherwise.
fn advance<const W: usize>(
    rig: &RigDuals<W>,
    touch: &Touch<W>,
    flight: &FlightPiece<W>,
    stage: &mut Stage<W>,
    time: f64,
    opens: bool,
    sink: &mut impl DropSink<W>,
) {
    let mut seen = flight_after(rig, touch, stage);
    seen.duration = time;
    sink.flight(&seen);
    if opens {
        let (after, [_, w, x, u]) = flight.touch_at(time);
        stage.time += after;
        stage.state = [Lanes::ZERO, u - w, x, u];
        return;
    }
    let (y, w) = flight.fruit(time);
    let (x, u) = flight.plate(time);
    stage.time += fixed(time);
    stage.state = [x - y, u - w, x, u];
}

/// Shifts a stage to the instant at which the law pushes again.
fn resume<const W: usize>(
    stage: &mut Stage<W>,
    rig: &RigDuals<W>,
    force: Lanes<W>,
    (by_displacement, by_rate): (f64, f64),
) {
    let [_, rate, x, u] = stage.state.map(|lanes| lanes.0[0]);
    let plate = -(rig.stiffness.0[0] * x + rig.damping.0[0] * u) * rig.inverse_plate_mass.0[0];
    let acceleration = plate + rig.gravity.0[0];
    let shift = instant(force, by_displacement * rate + by_rate * acceleration);
    stage.time += shift;
    for (component, rate) in stage.state.iter_mut().zip([rate, acceleration, u, plate]) {
        *component += shift * rate;
    }
}
