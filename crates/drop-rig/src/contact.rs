//! One contact of a fruit with the plate, integrated with its sensitivities.
//!
//! The state is (d, d', x, x'): indentation, its rate, displacement and
//! velocity of the plate (up positive, about its static position), each with
//! its derivatives by the free parameters in the lanes. Time runs as t = s^q
//! from first touch, as in [`windfall_identify::rig::contact_motion`].

use crate::dual::{derivatives, instant, product};
use crate::event::{DropEvent, RigDuals};
use windfall_contact::law::{ContactForce, ContactLaw, EndRule, SMALLEST_DISPLACEMENT};
use windfall_identify::rig::contact_stop::earlier;
use windfall_identify::rig::contact_time::{scaled_time, stretch, time_of};
use windfall_numerics::ode::step::{Position, Step, StepError, System, dense_at, step};
use windfall_numerics::real::{Lanes, Real};
use windfall_numerics::root::bracketed_root;

/// Steps before an integration is given up: a contact takes about fifteen, and one that lasts
/// while the plate rings some thousands.
const LARGEST_STEPS: usize = 50_000;
/// First step, as a part of the time in which the plate moves or the fruit
/// would pass the law's kink.
const FIRST_STEP: f64 = 0.3;
/// First step where neither gives a measure; s.
const FIRST_TIME: f64 = 1e-4;
/// Event times are located to this fraction of a step.
const EVENT_TOLERANCE: f64 = 1e-14;
/// Earliest end of a contact within its first step, as a fraction of the step.
const EARLIEST_END: f64 = 1e-3;
/// Points within a step at which the force's sign is checked.
const SIGN_POINTS: usize = 4;
/// A contact this many times longer than the way to its first maximum lasts:
/// the fruit has come to rest on the plate. Only asked where time has no end.
pub(crate) const LONGEST_CONTACT: f64 = 100.0;

/// The state of a contact.
pub(crate) type ContactState<const W: usize> = [Lanes<W>; 4];

/// What a law with history remembers.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Memory<const W: usize> {
    /// Largest displacement before the present unloading; m.
    pub peak: f64,
    /// Its derivatives.
    pub peak_lanes: Lanes<W>,
    /// Whether the displacement grows for the first time.
    pub loading: bool,
}

impl<const W: usize> Memory<W> {
    /// Of a body that has not been touched.
    pub const NONE: Self = Self {
        peak: 0.0,
        peak_lanes: Lanes::ZERO,
        loading: true,
    };
}

/// Dense output of a part of a contact.
#[derive(Clone, Copy, Debug)]
pub struct ContactPiece<const W: usize> {
    /// Dense output of (d, d', x, x') in s.
    pub step: Step<4, W>,
    /// q of t = s^q.
    pub power: u32,
    /// When t was zero, since first touch of the drop; s.
    pub start: Lanes<W>,
    /// First t of validity; s.
    pub from: f64,
    /// Last t of validity; s.
    pub to: f64,
    /// Largest displacement so far, for laws with history; m.
    pub peak: f64,
    /// Its derivatives.
    pub peak_lanes: Lanes<W>,
}

impl<const W: usize> ContactPiece<W> {
    /// The piece without derivatives.
    #[inline(always)]
    pub(crate) fn values(&self) -> ContactPiece<1> {
        ContactPiece {
            step: Step {
                start: self.step.start,
                width: self.step.width,
                from: self.step.from.map(value),
                to: self.step.to.map(value),
                terms: self.step.terms.map(|term| term.map(value)),
            },
            power: self.power,
            start: value(self.start),
            from: self.from,
            to: self.to,
            peak: self.peak,
            peak_lanes: Lanes::ZERO,
        }
    }
}

/// Lane 0 alone.
#[inline(always)]
fn value<const W: usize>(lanes: Lanes<W>) -> Lanes<1> {
    Lanes([lanes.0[0]])
}

/// Why the integration of a contact stopped.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum ContactStop {
    /// The force returned to zero.
    ForceZero,
    /// The gap opened.
    Opened,
    /// The contact does not end.
    Lasting,
    /// Time ran out.
    Until,
}

/// How a contact ended: total derivatives at the instant of the event.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ContactEnd<const W: usize> {
    /// Since the start of the integration; s.
    pub time: Lanes<W>,
    /// State there.
    pub state: ContactState<W>,
    /// What ended it.
    pub stop: ContactStop,
    /// What the law remembers.
    pub memory: Memory<W>,
}

struct Phase<'a, L, const N: usize, const W: usize> {
    event: &'a DropEvent<L, N, W>,
    rig: &'a RigDuals<W>,
    power: u32,
    memory: Memory<W>,
}

impl<L: ContactLaw<N>, const N: usize, const W: usize> Phase<'_, L, N, W> {
    #[inline(always)]
    fn force(&self, d: f64, rate: f64) -> ContactForce<f64, N> {
        let d = Real::max(d, SMALLEST_DISPLACEMENT);
        self.event.law.evaluate(d, rate, self.memory.peak)
    }

    /// d(state)/dt; the contact force with its derivatives is `force`.
    #[inline(always)]
    fn motion(&self, state: &ContactState<W>, force: Lanes<W>) -> ContactState<W> {
        let [_, rate, x, u] = *state;
        let rig = self.rig;
        let support = product(rig.stiffness, x) + product(rig.damping, u);
        let plate = -product(force + support, rig.inverse_plate_mass);
        let fruit = product(force, rig.inverse_contact_mass) - rig.gravity;
        [rate, plate - fruit, u, plate]
    }
}

/// Contact force with its derivatives at a state.
#[inline(always)]
pub(crate) fn force_dual<L: ContactLaw<N>, const N: usize, const W: usize>(
    event: &DropEvent<L, N, W>,
    d: Lanes<W>,
    rate: Lanes<W>,
    peak: f64,
    peak_lanes: Lanes<W>,
) -> (Lanes<W>, ContactForce<f64, N>) {
    let law = event
        .law
        .evaluate(Real::max(d.0[0], SMALLEST_DISPLACEMENT), rate.0[0], peak);
    // Outside, where the law is evaluated at its smallest displacement, its
    // slope there (infinite for √d) does not count.
    let by_displacement = if d.0[0] > 0.0 {
        law.by_displacement
    } else {
        0.0
    };
    let mut dual = d * by_displacement + rate * law.by_rate + peak_lanes * law.by_peak;
    for (by, seed) in law.by_parameter.iter().zip(&event.seeds.parameters) {
        dual += *seed * *by;
    }
    dual.0[0] = law.force;
    (dual, law)
}

impl<L: ContactLaw<N>, const N: usize, const W: usize> System<4, W> for Phase<'_, L, N, W> {
    #[inline(always)]
    fn derivative(&self, s: f64, state: &ContactState<W>) -> ContactState<W> {
        let stretch = stretch(s, self.power);
        let memory = &self.memory;
        let (force, _) = force_dual(
            self.event,
            state[0],
            state[1],
            memory.peak,
            memory.peak_lanes,
        );
        let [d, rate, x, u] = self.motion(state, force);
        [d * stretch, rate * stretch, x * stretch, u * stretch]
    }
}

/// What happens within a step.
#[derive(Clone, Copy, PartialEq)]
enum Stop {
    End(ContactStop),
    Turn,
    Kink,
}

/// Follows a contact from a state until it ends, or until `until` (s since the
/// start of the integration).
///
/// * `power`: q of t = s^q; 1 where the contact resumes from an indentation
/// * `longest`: time after which the fruit has come to rest, where one is known
/// * `piece`: takes the pieces in order
///
/// # Errors
/// [`StepError`] when the tolerance cannot be met.
#[inline(always)]
pub(crate) fn follow_contact<L: ContactLaw<N>, const N: usize, const W: usize>(
    event: &DropEvent<L, N, W>,
    rig: &RigDuals<W>,
    (state, memory): (ContactState<W>, Memory<W>),
    (start, power): (Lanes<W>, u32),
    (until, longest): (f64, f64),
    mut piece: impl FnMut(&ContactPiece<W>),
) -> Result<ContactEnd<W>, StepError> {
    let mut phase = Phase {
        event,
        rig,
        power,
        memory,
    };
    let limit = match until.is_finite() {
        true => scaled_time(until, power),
        false => f64::MAX,
    };
    let kink = event.law.kink();
    let mut beyond_kink = state[0].0[0] > kink;
    let mut longest = longest;
    let width = scaled_time(first_time(rig, kink, state[1].0[0]), power).min(limit);
    let mut position = Position::new(&phase, 0.0, state, width);
    for _ in 0..LARGEST_STEPS {
        let done = step(&phase, &mut position, limit, &event.tolerance)?;
        let stop = first_stop(&phase, &done, kink, beyond_kink);
        let (to, at) = match stop {
            None => (position.s, done.to),
            Some((_, sigma)) => (done.start + sigma * done.width, done.at(sigma)),
        };
        let time = time_of(to, power);
        piece(&ContactPiece {
            step: done,
            power,
            start,
            from: time_of(done.start, power),
            to: time,
            peak: phase.memory.peak,
            peak_lanes: phase.memory.peak_lanes,
        });
        match stop {
            Some((Stop::End(stop), _)) => return Ok(end_at(&phase, time, at, stop)),
            Some((Stop::Turn, _)) => {
                let loading = !phase.memory.loading;
                longest = longest.min(LONGEST_CONTACT * time);
                phase.memory = match loading {
                    true => Memory::NONE,
                    false => Memory {
                        peak: at[0].0[0],
                        peak_lanes: derivatives(at[0]),
                        loading,
                    },
                };
                position = Position::new(&phase, to, at, position.width);
            }
            Some((Stop::Kink, _)) => {
                beyond_kink = !beyond_kink;
                position = Position::new(&phase, to, at, position.width);
            }
            None if time >= longest && !until.is_finite() => {
                return Ok(end_at(&phase, time, at, ContactStop::Lasting));
            }
            None if position.s == limit => return Ok(end_at(&phase, time, at, ContactStop::Until)),
            None => {}
        }
    }
    Err(StepError {
        s: position.s,
        width: position.width,
    })
}

fn first_time<const W: usize>(rig: &RigDuals<W>, kink: f64, rate: f64) -> f64 {
    let plate = rig
        .ringing
        .map_or(FIRST_TIME, |ringing| ringing.short_time());
    let kink = kink / rate.abs().max(f64::MIN_POSITIVE);
    FIRST_STEP * plate.min(FIRST_TIME).min(kink)
}

/// State at the end, with total derivatives: those at fixed time and the shift
/// of the event.
#[inline(always)]
fn end_at<L: ContactLaw<N>, const N: usize, const W: usize>(
    phase: &Phase<L, N, W>,
    time: f64,
    at: ContactState<W>,
    stop: ContactStop,
) -> ContactEnd<W> {
    let memory = phase.memory;
    let (force, law) = force_dual(phase.event, at[0], at[1], memory.peak, memory.peak_lanes);
    // Where the end is that of the force, the force after it is zero: so is
    // this one, to the accuracy of the event.
    let motion = phase.motion(&at, force);
    let [rate, acceleration, ..] = motion.map(|lanes| lanes.0[0]);
    let shift = match stop {
        ContactStop::ForceZero => instant(
            force,
            law.by_displacement * rate + law.by_rate * acceleration,
        ),
        ContactStop::Opened => instant(at[0], rate),
        ContactStop::Lasting | ContactStop::Until => Lanes::ZERO,
    };
    let mut state = at;
    for (component, rate) in state.iter_mut().zip(&motion) {
        *component += shift * rate.0[0];
    }
    if stop == ContactStop::Opened {
        state[0] = Lanes::ZERO;
    }
    ContactEnd {
        time: shift + Lanes::unit(0, time),
        state,
        stop,
        memory,
    }
}

/// The first event within a step, with its fraction of the step.
#[inline(always)]
fn first_stop<L: ContactLaw<N>, const N: usize, const W: usize>(
    phase: &Phase<L, N, W>,
    done: &Step<4, W>,
    kink: f64,
    beyond_kink: bool,
) -> Option<(Stop, f64)> {
    let (d, rate) = (done.to[0].0[0], done.to[1].0[0]);
    let mut stop = None;
    let memory = &phase.memory;
    let history = phase.event.law.history();
    if memory.loading && rate <= 0.0 {
        stop = Some((Stop::Turn, locate(done, 0.0, 1.0, |y| y[1])));
    } else if history && !memory.loading && d > memory.peak && rate > 0.0 {
        let peak = memory.peak;
        stop = Some((Stop::Turn, locate(done, 0.0, 1.0, |y| peak - y[0])));
    }
    if kink.is_finite() && (d > kink) != beyond_kink {
        let side = if beyond_kink { 1.0 } else { -1.0 };
        let sigma = locate(done, 0.0, 1.0, |y| side * (y[0] - kink));
        stop = earlier(stop, (Stop::Kink, sigma));
    }
    match end_of_contact(phase, done) {
        Some((sigma, end)) => earlier(stop, (Stop::End(end), sigma)),
        None => stop,
    }
}

/// Fraction of the step at which the contact ends, if it does.
#[inline(always)]
fn end_of_contact<L: ContactLaw<N>, const N: usize, const W: usize>(
    phase: &Phase<L, N, W>,
    done: &Step<4, W>,
) -> Option<(f64, ContactStop)> {
    // In the very first step the state starts at zero displacement and force.
    let lowest = if done.start == 0.0 { EARLIEST_END } else { 0.0 };
    let values = values_of(done);
    let mut low = lowest;
    for point in 1..=SIGN_POINTS {
        let sigma = point as f64 / SIGN_POINTS as f64;
        let [d, rate] = values(sigma);
        let opened = d <= 0.0;
        if phase.event.end == EndRule::GapZero {
            if opened {
                return Some((locate(done, low, sigma, |y| y[0]), ContactStop::Opened));
            }
        } else if opened || phase.force(d, rate).force <= 0.0 {
            // The force of an elastic law falls to zero with the gap; that of
            // a damped one before it.
            let highest = match opened {
                true => locate(done, low, sigma, |y| y[0]),
                false => sigma,
            };
            let at = values(highest);
            if opened && phase.force(SMALLEST_DISPLACEMENT, at[1]).force >= 0.0 {
                return Some((highest, ContactStop::Opened));
            }
            let end = locate(done, low, highest, |y| phase.force(y[0], y[1]).force);
            return Some((end, ContactStop::ForceZero));
        }
        low = sigma;
    }
    None
}

/// (d, d') at a fraction of the step.
#[inline(always)]
fn values_of<const W: usize>(done: &Step<4, W>) -> impl Fn(f64) -> [f64; 2] {
    let (d, rate) = (done.lane(0, 0), done.lane(1, 0));
    move |sigma| {
        let dense = dense_at::<f64>;
        [
            dense(&d, sigma, 1.0 - sigma),
            dense(&rate, sigma, 1.0 - sigma),
        ]
    }
}

/// Root in `[low, high]` of a function of (d, d') that is positive before.
#[inline(always)]
fn locate<const W: usize>(
    done: &Step<4, W>,
    low: f64,
    high: f64,
    function: impl Fn([f64; 2]) -> f64,
) -> f64 {
    let values = values_of(done);
    bracketed_root(low, high, EVENT_TOLERANCE, |sigma| function(values(sigma)))
}
