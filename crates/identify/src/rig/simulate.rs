//! Simulation of one impact under a force law: its summary, or its samples.

use crate::error::{Error, check_positive};
use crate::rig::contact_motion::{Piece, Segment, Separation, follow};
use crate::rig::contact_time::scaled_time;
use crate::rig::impact_event::{ImpactEvent, Seeds};
use crate::rig::kind::{Carriage, Rig};
use crate::rig::motion::Motion;
use windfall_contact::law::{ContactLaw, EndRule, SMALLEST_DISPLACEMENT};
use windfall_contact::laws::any_law::{AnyLaw, LARGEST_PARAMETERS};
use windfall_contact::laws::kind::Law;
use windfall_numerics::fast::fast;
use windfall_numerics::ode::step::{StepError, Tolerance};
use windfall_numerics::quadrature::EIGHT_NODES;
use windfall_numerics::root::bracketed_root;
pub use windfall_signal::instrument::Trajectory;

/// Relative accuracy of simulations; the reference tables require 1e-8.
pub const ACCURACY: f64 = 1e-12;
/// Points per piece of the motion among which a maximum is searched.
const SEARCH_POINTS: usize = 16;
/// A peak is located to this fraction of a piece.
const PEAK_TOLERANCE: f64 = 1e-13;
/// First guess of the longest contact, and how often it may be doubled; s.
const FIRST_DURATION: f64 = 0.02;
const LARGEST_DOUBLINGS: usize = 10;

/// Summary of one impact; SI.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ImpactSummary {
    /// Largest contact force; N.
    pub peak_force: f64,
    /// Time of the largest force, from first touch; s.
    pub time_of_peak_force: f64,
    /// Largest displacement; m.
    pub max_displacement: f64,
    /// Time of the largest displacement; s.
    pub time_of_max_displacement: f64,
    /// Force at the largest displacement; N.
    pub force_at_max_displacement: f64,
    /// From first touch to the end of contact; s.
    pub contact_duration: f64,
    /// Displacement left at the end of contact; m.
    pub final_displacement: f64,
    /// Speed at the end of contact, away from the fruit; m/s.
    pub separation_velocity: f64,
    /// Separation over impact velocity; 1.
    pub restitution: f64,
    /// Kinetic energy lost, m (v₀² − v²)/2; J.
    pub absorbed_energy: f64,
    /// Integral of the force over the contact; N s.
    pub impulse: f64,
}

/// A free body of `mass` strikes at `velocity`; gravity or another driving
/// acceleration towards the fruit may act.
///
/// # Errors
/// [`Error::BadInput`] when mass or velocity is not positive,
/// [`Error::EndlessContact`] when the bodies do not separate.
pub fn simulate_impact(
    law: &Law,
    mass: f64,
    velocity: f64,
    driving_acceleration: f64,
    end: EndRule,
) -> Result<ImpactSummary, Error> {
    let rig = Rig::Carriage(Carriage {
        mass,
        driving_acceleration,
    });
    simulate_rig(law, &rig, velocity, end)
}

/// The impactor of `rig` strikes at `velocity`.
///
/// # Errors
/// As [`simulate_impact`].
pub fn simulate_rig(
    law: &Law,
    rig: &Rig,
    velocity: f64,
    end: EndRule,
) -> Result<ImpactSummary, Error> {
    let event = event(law, rig, velocity, end)?;
    let mut duration = FIRST_DURATION;
    for _ in 0..LARGEST_DOUBLINGS {
        let mut summary = ImpactSummary::default();
        let separation = follow_fast(&event, 0.0, duration, &mut |segment, piece| {
            if piece == Piece::Contact {
                fast(
                    #[inline(always)]
                    || tally(&event, segment, &mut summary),
                );
            }
        })?;
        if let Some(separation) = separation {
            return Ok(complete(summary, &separation, rig, velocity));
        }
        duration *= 2.0;
    }
    Err(Error::EndlessContact {
        duration: duration * 0.5,
    })
}

/// Motion of the impactor of `rig` at `times` (ascending, from first touch;
/// negative before it).
///
/// # Errors
/// As [`simulate_impact`]; a contact may last beyond the last time.
pub fn trajectory(
    law: &Law,
    rig: &Rig,
    velocity: f64,
    times: &[f64],
    end: EndRule,
) -> Result<Trajectory, Error> {
    let event = event(law, rig, velocity, end)?;
    let (Some(&first), Some(&last)) = (times.first(), times.last()) else {
        return Ok(Trajectory::default());
    };
    check_ascending(times)?;
    let zeros = vec![0.0; times.len()];
    let mut out = Trajectory {
        times: times.to_vec(),
        displacement: zeros.clone(),
        rate: zeros.clone(),
        force: zeros.clone(),
        acceleration: zeros,
    };
    follow_fast(&event, first.min(0.0), last, &mut |segment, piece| {
        fast(
            #[inline(always)]
            || read(&event, segment, piece, last, &mut out),
        );
    })?;
    Ok(out)
}

/// # Errors
/// [`Error::UnorderedTimes`] where a time is before the one in front of it.
pub fn check_ascending(times: &[f64]) -> Result<(), Error> {
    match (1..times.len()).find(|&i| times[i] < times[i - 1]) {
        Some(i) => Err(Error::UnorderedTimes {
            index: i,
            time: times[i],
            before: times[i - 1],
        }),
        None => Ok(()),
    }
}

type Event = ImpactEvent<AnyLaw, LARGEST_PARAMETERS, 1>;

fn event(law: &Law, rig: &Rig, velocity: f64, end: EndRule) -> Result<Event, Error> {
    rig.check()?;
    check_positive("velocity", velocity)?;
    Ok(ImpactEvent {
        law: AnyLaw(*law),
        motion: Motion::from(rig),
        velocity,
        end,
        seeds: Seeds::NONE,
        tolerance: Tolerance {
            relative: ACCURACY,
            absolute: [ACCURACY * 1e-6, ACCURACY * velocity],
        },
    })
}

fn follow_fast(
    event: &Event,
    before: f64,
    after: f64,
    sink: &mut impl FnMut(&Segment<1>, Piece),
) -> Result<Option<Separation>, StepError> {
    fast(
        #[inline(always)]
        || follow(event, before, after, sink),
    )
}

fn complete(
    found: ImpactSummary,
    separation: &Separation,
    rig: &Rig,
    velocity: f64,
) -> ImpactSummary {
    let speed = -separation.rate;
    ImpactSummary {
        contact_duration: separation.time,
        final_displacement: separation.displacement,
        separation_velocity: speed,
        restitution: speed / velocity,
        absorbed_energy: 0.5 * rig.effective_mass() * (velocity - speed) * (velocity + speed),
        ..found
    }
}

/// State read from a piece of the motion.
#[derive(Clone, Copy)]
struct State {
    time: f64,
    x: f64,
    v: f64,
    force: f64,
    acceleration: f64,
    /// dF/dt; N/s.
    force_rate: f64,
}

#[inline(always)]
fn state_at(event: &Event, segment: &Segment<1>, sigma: f64) -> State {
    let [x, v] = segment.step.at(sigma).map(|lanes| lanes.0[0]);
    let law = event
        .law
        .evaluate(f64::max(x, SMALLEST_DISPLACEMENT), v, segment.peak);
    let force = if event.end == EndRule::ForceZero {
        law.force.max(0.0)
    } else {
        law.force
    };
    let acceleration = event.motion.acceleration(x, v, force).value;
    let s = segment.step.start + sigma * segment.step.width;
    State {
        time: s.powi(segment.power as i32),
        x,
        v,
        force,
        acceleration,
        force_rate: law.by_displacement * v + law.by_rate * acceleration,
    }
}

/// Adds the peaks and the impulse of a piece of the contact.
#[inline(always)]
fn tally(event: &Event, segment: &Segment<1>, summary: &mut ImpactSummary) {
    let end = sigma_of(segment, segment.to);
    let state = |sigma: f64| state_at(event, segment, sigma);

    let (mut forces, mut depths) = ([0.0; SEARCH_POINTS + 1], [0.0; SEARCH_POINTS + 1]);
    for i in 0..=SEARCH_POINTS {
        let state = state(point(end, i));
        (forces[i], depths[i]) = (state.force, state.x);
    }

    // The force's maximum may be at first touch, where some laws jump.
    let force = highest_on(
        (end, forces),
        |sigma| state(sigma).force,
        |sigma| state(sigma).force_rate,
    );
    let peak = state(force);
    if peak.force > summary.peak_force {
        summary.peak_force = peak.force;
        summary.time_of_peak_force = peak.time;
    }
    let deepest = highest_on(
        (end, depths),
        |sigma| state(sigma).x,
        |sigma| state(sigma).v,
    );
    let deepest = state(deepest);
    if deepest.x > summary.max_displacement {
        summary.max_displacement = deepest.x;
        summary.time_of_max_displacement = deepest.time;
        summary.force_at_max_displacement = deepest.force;
    }

    // ∫ F dt = ∫ F q s^(q−1) ds
    let (power, width) = (f64::from(segment.power), segment.step.width);
    for (node, weight) in EIGHT_NODES {
        let sigma = 0.5 * end * (1.0 + node);
        let s = segment.step.start + sigma * width;
        let stretch = power * s.powi(segment.power as i32 - 1);
        summary.impulse += 0.5 * end * width * weight * stretch * state(sigma).force;
    }
}

#[inline(always)]
fn sigma_of(segment: &Segment<1>, time: f64) -> f64 {
    (scaled_time(time, segment.power) - segment.step.start) / segment.step.width
}

/// A point of the grid over `[0, end]` on which a maximum is searched.
#[inline(always)]
fn point(end: f64, i: usize) -> f64 {
    end * i as f64 / SEARCH_POINTS as f64
}

/// Where in `[0, end]` a function with the derivative `slope` is highest.
#[inline(always)]
pub fn highest(end: f64, value: impl Fn(f64) -> f64, slope: impl Fn(f64) -> f64) -> f64 {
    let grid = std::array::from_fn(|i| value(point(end, i)));
    highest_on((end, grid), value, slope)
}

/// [`highest`] with the values on the grid of points.
#[inline(always)]
fn highest_on(
    (end, grid): (f64, [f64; SEARCH_POINTS + 1]),
    value: impl Fn(f64) -> f64,
    slope: impl Fn(f64) -> f64,
) -> f64 {
    let (best, most) = (0_usize..)
        .zip(grid)
        .fold((0, f64::NEG_INFINITY), |best, next| {
            if next.1 > best.1 { next } else { best }
        });
    let low = point(end, best.saturating_sub(1));
    let high = point(end, (best + 1).min(SEARCH_POINTS));
    let root = bracketed_root(low, high, PEAK_TOLERANCE, slope);
    if value(root) >= most {
        root
    } else {
        point(end, best)
    }
}

/// Reads those of the times that lie in a piece of the motion; `last` is the last time.
#[inline(always)]
fn read(event: &Event, segment: &Segment<1>, piece: Piece, last: f64, out: &mut Trajectory) {
    let first = out.times.partition_point(|time| *time < segment.from);
    let behind = out.times.partition_point(|time| *time <= segment.to);
    for i in first..behind.max(first) {
        let time = out.times[i];
        let ends = segment.to >= last && time <= segment.to;
        if !(time < segment.to || ends) {
            continue;
        }
        let sigma = sigma_of(segment, time);
        let (x, v, force, acceleration) = if piece == Piece::Contact {
            let s = state_at(event, segment, sigma);
            (s.x, s.v, s.force, s.acceleration)
        } else {
            let [x, v] = segment.step.at(sigma).map(|lanes| lanes.0[0]);
            let a = event.motion.acceleration(x, v, 0.0).value;
            (x, v, 0.0, a)
        };
        out.displacement[i] = x;
        out.rate[i] = v;
        out.force[i] = force;
        out.acceleration[i] = acceleration;
    }
}
