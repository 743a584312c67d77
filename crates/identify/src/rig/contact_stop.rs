//! A contact's right-hand side and the events that end its steps.

use crate::rig::contact_time::stretch;
use crate::rig::impact_event::ImpactEvent;
use windfall_contact::law::{ContactForce, ContactLaw, EndRule, SMALLEST_DISPLACEMENT};
use windfall_numerics::ode::dense::DenseStep;
use windfall_numerics::ode::step::{System, dense_at};
use windfall_numerics::real::{Lanes, Real};
use windfall_numerics::root::bracketed_root;

/// Event times are located to this fraction of a step.
const EVENT_TOLERANCE: f64 = 1e-14;
/// Earliest end of a contact within its first step, as a fraction of the step.
const EARLIEST_END: f64 = 1e-3;

/// Right-hand side during contact.
pub(crate) struct Phase<'a, L, const N: usize, const W: usize> {
    pub event: &'a ImpactEvent<L, N, W>,
    pub power: u32,
    pub peak: f64,
    pub peak_lanes: Lanes<W>,
}

impl<'a, L: ContactLaw<N>, const N: usize, const W: usize> Phase<'a, L, N, W> {
    /// The contact from first touch on.
    #[inline(always)]
    pub fn new(event: &'a ImpactEvent<L, N, W>) -> Self {
        Self {
            event,
            power: event.law.start_power(),
            peak: 0.0,
            peak_lanes: Lanes::ZERO,
        }
    }

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
        let stretch = stretch(s, self.power);
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

/// What ends a step of the contact before its end.
#[derive(Clone, Copy, PartialEq)]
pub(crate) enum Stop {
    End,
    Peak,
    Kink,
}

/// Where in a step of contact the contact ends, if it does: fraction of the step
/// and the state with which the flight begins. For laws without history.
#[inline(always)]
pub(crate) fn separation<L: ContactLaw<N>, const N: usize, const W: usize>(
    event: &ImpactEvent<L, N, W>,
    done: &DenseStep<2, W>,
) -> Option<(f64, [Lanes<W>; 2])> {
    let phase = Phase::new(event);
    let sigma = end_of_contact(&phase, done)?;
    let mut state = done.at(sigma);
    carry_jump(&phase, &mut state);
    Some((sigma, state))
}

/// The first event within a step, with its fraction of the step.
#[inline(always)]
pub(crate) fn first_stop<L: ContactLaw<N>, const N: usize, const W: usize>(
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
        let dense = dense_at::<f64>;
        function([dense(x, sigma, 1.0 - sigma), dense(v, sigma, 1.0 - sigma)])
    })
}

/// Jump of the sensitivities where the force jumps to zero at the end:
/// ∂v/∂p grows by (a₋ − a₊) ∂t/∂p, with ∂t/∂p = −(∂x/∂p)/v at the gap.
#[inline(always)]
pub(crate) fn carry_jump<L: ContactLaw<N>, const N: usize, const W: usize>(
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
