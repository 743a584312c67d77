//! One contact of the planar body with the plate, integrated with its events
//! ([`crate::eccentric::motion`]).

use crate::eccentric::body::{Planar, State};
use crate::eccentric::motion::{Forces, Grip, Phase, SIZE, Touching};
use windfall_contact::law::{ContactLaw, EndRule};
use windfall_contact::laws::any_law::AnyLaw;
use windfall_identify::error::Error;
use windfall_identify::rig::simulate::ACCURACY;
use windfall_numerics::ode::step::{Position, Step, Tolerance, step};
use windfall_numerics::quadrature::FOUR_NODES;
use windfall_numerics::root::bracketed_root;

/// Steps before a contact is given up: an impact takes about ten.
const LARGEST_STEPS: usize = 50_000;
/// First step; s.
const FIRST_STEP: f64 = 1e-4;
/// Parts of a step searched for events.
const SEARCH_PIECES: usize = 8;
/// Event times are located to this fraction of a step.
const EVENT_TOLERANCE: f64 = 1e-14;
/// Earliest end of a contact within its first step, as a fraction of the step.
const EARLIEST_END: f64 = 1e-3;
/// Sliding slower than this part of the impact velocity is a sign lost in
/// rounding.
const SLIDING_TOLERANCE: f64 = 1e-12;
/// A contact this many times longer than the way to its first maximum lasts:
/// the body lies, rolls or rocks on the plate.
const LONGEST_CONTACT: f64 = 100.0;

/// A piece of the contact: dense output from the start of the step to `to`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Piece<'a> {
    pub phase: Phase<'a>,
    step: Step<SIZE, 1>,
    /// End of validity, as a fraction of the step.
    pub to: f64,
}

impl Piece<'_> {
    /// State at the fraction `sigma` of the step.
    pub fn at(&self, sigma: f64) -> Touching {
        Touching::unpack(&self.step.at(sigma))
    }

    /// Time since first touch at the fraction `sigma` of the step; s.
    pub fn time_at(&self, sigma: f64) -> f64 {
        let s = self.step.start + sigma * self.step.width;
        s.powi(self.phase.power as i32)
    }

    /// Fraction of the step at a time since first touch.
    pub fn sigma_of(&self, time: f64) -> f64 {
        let s = time.powf(1.0 / f64::from(self.phase.power));
        (s - self.step.start) / self.step.width
    }
}

/// How a contact ended.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Ending {
    /// Time since first touch; s.
    pub time: f64,
    /// Time since first touch at which the law's force was last back at zero; s.
    pub force_end: f64,
    /// What the contact has done.
    pub touching: Touching,
    /// Whether the body left the plate; it stays on it otherwise.
    pub left: bool,
}

/// What ends a step of the contact.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Stop {
    /// The law's force is back at zero.
    ForceEnd,
    /// The law's force is back before the gap has opened.
    ForceStart,
    /// The gap opens.
    Gap,
    /// The displacement turns (laws with history), or passes its old maximum.
    Peak,
    /// The law's kink is passed.
    Kink,
    /// Sticking begins or ends, or sliding turns.
    Grip,
}

/// Follows a contact from first touch in `state` until the gap opens, or until
/// the body is known to stay, and hands each piece to `sink`.
///
/// # Errors
/// [`Error::Integration`] and [`Error::EndlessContact`].
pub(crate) fn follow_contact(
    planar: &Planar,
    law: AnyLaw,
    end: EndRule,
    state: State,
    sink: &mut impl FnMut(&Piece),
) -> Result<Ending, Error> {
    let mut phase = first_phase(planar, law, end, &state);
    let tolerance = tolerance(&phase, &state);
    let mut touching = Touching {
        state,
        ..Touching::default()
    };
    let mut force_end = 0.0;
    let mut longest = f64::INFINITY;
    let mut position = Position::new(
        &phase,
        0.0,
        touching.pack(),
        FIRST_STEP.powf(1.0 / f64::from(phase.power)),
    );
    for _ in 0..LARGEST_STEPS {
        let made = step(&phase, &mut position, f64::INFINITY, &tolerance)?;
        let whole = Piece {
            phase,
            step: made,
            to: 1.0,
        };
        let stop = first_stop(&whole);
        let piece = Piece {
            to: stop.map_or(1.0, |(_, sigma)| sigma),
            ..whole
        };
        sink(&piece);
        touching = piece.at(piece.to);
        let time = piece.time_at(piece.to);
        if let Some((kind, _)) = stop {
            if matches!(kind, Stop::ForceEnd | Stop::Gap) && !phase.parted {
                force_end = time;
            }
            if kind == Stop::Gap {
                return Ok(Ending {
                    time,
                    force_end,
                    touching,
                    left: true,
                });
            }
            enter(&mut phase, kind, &touching.state);
            let s = made.start + piece.to * made.width;
            position = Position::new(&phase, s, touching.pack(), position.width);
        }
        if longest.is_infinite() && phase.forces(&touching.state).rate <= 0.0 {
            longest = LONGEST_CONTACT * time;
        }
        if time > longest || cannot_leave(&phase, &touching.state) {
            return Ok(Ending {
                time,
                force_end: time,
                touching,
                left: false,
            });
        }
    }
    Err(Error::EndlessContact {
        duration: position.s.powi(phase.power as i32),
    })
}

fn first_phase<'a>(planar: &'a Planar, law: AnyLaw, end: EndRule, state: &State) -> Phase<'a> {
    let approach = planar.rate(state, &planar.lowest_point(state));
    let mut phase = Phase {
        planar,
        law,
        end,
        power: law.start_power(),
        peak: 0.0,
        loading: true,
        beyond_kink: false,
        parted: false,
        grip: Grip::Frictionless,
        slowest_slide: SLIDING_TOLERANCE * approach.abs(),
        slack: 0.0,
    };
    let forces = phase.forces(state);
    let grip = phase.grip_at(state, &forces);
    take_grip(&mut phase, grip, &forces);
    phase
}

/// Changes the grip. Its limit is moved out of the way where rounding has put
/// the state beyond it: an event that has just happened does not happen again.
fn take_grip(phase: &mut Phase, grip: Grip, forces: &Forces) {
    phase.grip = grip;
    phase.slack = 0.0;
    phase.slack = 2.0 * f64::max(0.0, -grip_level(phase, forces).unwrap_or(0.0));
}

/// How far sliding or sticking is from its limit: m/s or N; positive within.
fn grip_level(phase: &Phase, forces: &Forces) -> Option<f64> {
    let largest = phase.planar.friction * forces.normal.max(0.0);
    let level = match phase.grip {
        Grip::Frictionless => return None,
        Grip::Sticking => largest - forces.holding.abs() + phase.weakest_hold(),
        Grip::Sliding(direction) => direction * forces.sliding + phase.slowest_slide,
    };
    Some(level + phase.slack)
}

fn tolerance(phase: &Phase, state: &State) -> Tolerance<SIZE> {
    let approach = phase.forces(state).rate.abs();
    let planar = phase.planar;
    let length = (planar.inertia / planar.mass).sqrt();
    let (place, velocity) = (ACCURACY * 1e-6, ACCURACY * approach);
    let energy = ACCURACY * planar.mass * approach * approach;
    Tolerance {
        relative: ACCURACY,
        absolute: [
            place,
            place,
            place / length,
            place,
            velocity,
            velocity,
            velocity / length,
            velocity,
            ACCURACY * planar.mass * approach,
            energy,
            energy,
            energy,
        ],
    }
}

/// Changes the right-hand side at an event.
fn enter(phase: &mut Phase, stop: Stop, state: &State) {
    match stop {
        Stop::ForceEnd => phase.parted = true,
        Stop::ForceStart => {
            phase.parted = false;
            let forces = phase.forces(state);
            let grip = phase.grip_at(state, &forces);
            take_grip(phase, grip, &forces);
        }
        Stop::Peak => {
            // Unloading starts; or reloading past the old maximum is virgin
            // loading again.
            phase.loading = !phase.loading;
            phase.peak = if phase.loading {
                0.0
            } else {
                state.displacement
            };
        }
        Stop::Kink => phase.beyond_kink = !phase.beyond_kink,
        Stop::Grip => {
            // The old grip ended at its limit: what would hold now decides.
            let forces = phase.forces(state);
            let mut slow = forces;
            if matches!(phase.grip, Grip::Sliding(_)) {
                slow.sliding = 0.0;
            }
            let grip = match (phase.grip, phase.grip_at(state, &slow)) {
                (Grip::Sticking, Grip::Sticking) => Grip::Sliding(-forces.holding.signum()),
                (_, grip) => grip,
            };
            take_grip(phase, grip, &forces);
        }
        Stop::Gap => {}
    }
}

/// The first event within a step, with its fraction of the step.
fn first_stop(piece: &Piece) -> Option<(Stop, f64)> {
    let mut from = 0.0;
    for i in 1..=SEARCH_PIECES {
        let to = i as f64 / SEARCH_PIECES as f64;
        let mut first: Option<(Stop, f64)> = None;
        for (stop, level) in levels(&piece.phase, &piece.at(to).state) {
            if level > 0.0 {
                continue;
            }
            // In the very first step displacement and force start at zero.
            let ends = matches!(stop, Stop::ForceEnd | Stop::Gap);
            let low = if ends && piece.step.start == 0.0 {
                f64::max(from, EARLIEST_END)
            } else {
                from
            };
            let sigma = bracketed_root(low, to, EVENT_TOLERANCE, |sigma| {
                level_of(&piece.phase, &piece.at(sigma).state, stop)
            });
            if first.is_none_or(|(_, earliest)| sigma < earliest) {
                first = Some((stop, sigma));
            }
        }
        if first.is_some() {
            return first;
        }
        from = to;
    }
    None
}

fn level_of(phase: &Phase, state: &State, wanted: Stop) -> f64 {
    levels(phase, state)
        .find(|(stop, _)| *stop == wanted)
        .map_or(f64::INFINITY, |(_, level)| level)
}

/// Functions that are positive until their event.
fn levels(phase: &Phase, state: &State) -> impl Iterator<Item = (Stop, f64)> {
    let forces = phase.forces(state);
    let d = state.displacement;
    let clamped = phase.end == EndRule::ForceZero;
    let force = match (clamped, phase.parted) {
        (false, _) => None,
        (true, false) => Some((Stop::ForceEnd, forces.raw)),
        (true, true) => Some((Stop::ForceStart, -forces.raw)),
    };
    let gap = Some((Stop::Gap, d));
    let history = phase.law.history() && !phase.parted;
    let peak = history.then_some((
        Stop::Peak,
        if phase.loading {
            forces.rate
        } else {
            phase.peak - d
        },
    ));
    let kink = phase.law.kink();
    let side = if phase.beyond_kink { 1.0 } else { -1.0 };
    let kink = kink.is_finite().then_some((Stop::Kink, side * (d - kink)));
    let grip = match phase.parted {
        true => None,
        false => grip_level(phase, &forces).map(|level| (Stop::Grip, level)),
    };
    [force, gap, peak, kink, grip].into_iter().flatten()
}

/// Whether the energy left, with all that the contact may have stored, is less
/// than the body needs to stand on the plate without pressing on it.
fn cannot_leave(phase: &Phase, state: &State) -> bool {
    let planar = phase.planar;
    let weight = planar.mass * planar.gravity;
    // The plate may help: it stores least when it hangs where the weight would
    // hold it.
    let sag = planar
        .plate
        .map_or(0.0, |plate| 0.5 * weight * weight / plate.stiffness);
    let needed = weight * planar.shape.least_depth() - sag;
    if planar.energy(state) >= needed {
        return false;
    }
    let d = state.displacement.max(0.0);
    let stored: f64 = FOUR_NODES
        .iter()
        .map(|(node, weight)| weight * d * phase.law_at(node * d, 0.0).force.max(0.0))
        .sum();
    planar.energy(state) + stored < needed
}
