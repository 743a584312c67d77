//! One contact of the planar body with the plate, integrated with its events.
//!
//! ```text
//! m x″ = T                     d′ = w − y′ + H′ ω
//! m y″ = N − m g               u = x′ + (y − z) ω   sliding velocity
//! I ω′ = −H′ N + (y − z) T
//! M w′ = −N − k z − c w
//! ```
//!
//! N is the law's force at (d, d′). T is Coulomb's: while sliding −μ N sign(u),
//! while sticking the force that keeps u at zero, as long as that takes no more
//! than μ N. Time runs as t = s^q from first touch
//! ([`ContactLaw::START_POWER`]).

use crate::eccentric_body::{Planar, State};
use crate::error::Error;
use crate::simulate::ACCURACY;
use windfall_contact::any_law::AnyLaw;
use windfall_contact::law::{ContactForce, ContactLaw, EndRule, SMALLEST_DISPLACEMENT};
use windfall_numerics::ode_step::{Position, Step, System, Tolerance, step};
use windfall_numerics::real::Lanes;
use windfall_numerics::root::bracketed_root;

/// Steps before a contact is given up: an impact takes about ten.
const LARGEST_STEPS: usize = 50_000;
/// First step; s.
const FIRST_STEP: f64 = 1e-4;
/// Pieces of a step in each of which events are looked for.
const SEARCH_PIECES: usize = 8;
/// Event times are located to this fraction of a step.
const EVENT_TOLERANCE: f64 = 1e-14;
/// Where events within the very first step are looked for from.
const EARLIEST_EVENT: f64 = 1e-3;
/// Sliding slower than this part of the impact velocity is a sign lost in
/// rounding.
const SLIDING_TOLERANCE: f64 = 1e-12;
/// A contact this many times longer than the way to its first maximum lasts:
/// the body lies, rolls or rocks on the plate.
const LONGEST_CONTACT: f64 = 100.0;
/// Gauss-Legendre nodes and weights on [0, 1] (Abramowitz and Stegun 1964,
/// table 25.4, n = 4), for the energy that a contact stores at most.
const GAUSS: [(f64, f64); 4] = [
    (0.069_431_844_202_973_71, 0.173_927_422_568_726_93),
    (0.330_009_478_207_571_87, 0.326_072_577_431_273_07),
    (0.669_990_521_792_428_1, 0.326_072_577_431_273_07),
    (0.930_568_155_797_026_3, 0.173_927_422_568_726_93),
];

/// State and quadratures of the integration.
const SIZE: usize = 12;

/// Motion of body and plate with what the contact has taken so far.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Touching {
    pub state: State,
    /// ∫ N dt; N s.
    pub impulse: f64,
    /// ∫ N d′ dt, energy that went into the contact; J.
    pub absorbed: f64,
    /// −∫ T u dt, energy that sliding took; J.
    pub sliding: f64,
    /// ∫ c w² dt, energy that the plate's support took; J.
    pub support: f64,
}

impl Touching {
    fn pack(&self) -> [Lanes<1>; SIZE] {
        let s = &self.state;
        [
            s.x,
            s.displacement,
            s.rotation,
            s.plate,
            s.velocity_x,
            s.velocity_y,
            s.spin,
            s.plate_velocity,
            self.impulse,
            self.absorbed,
            self.sliding,
            self.support,
        ]
        .map(|value| Lanes([value]))
    }

    fn unpack(packed: &[Lanes<1>; SIZE]) -> Self {
        let v = packed.map(|lanes| lanes.0[0]);
        Self {
            state: State {
                x: v[0],
                displacement: v[1],
                rotation: v[2],
                plate: v[3],
                velocity_x: v[4],
                velocity_y: v[5],
                spin: v[6],
                plate_velocity: v[7],
            },
            impulse: v[8],
            absorbed: v[9],
            sliding: v[10],
            support: v[11],
        }
    }
}

/// How the surfaces move over each other.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Grip {
    Frictionless,
    Sticking,
    /// The body slides to the right (1) or to the left (−1).
    Sliding(f64),
}

/// Right-hand side between two events.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Phase<'a> {
    planar: &'a Planar,
    law: AnyLaw,
    end: EndRule,
    power: u32,
    peak: f64,
    loading: bool,
    beyond_kink: bool,
    /// The law's force has ended, the gap has not opened yet.
    parted: bool,
    grip: Grip,
    slowest_slide: f64,
}

/// Forces and accelerations at one state.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Forces {
    /// N, as it acts; N.
    pub normal: f64,
    /// T, on the body, positive to the right; N.
    pub tangential: f64,
    /// Law's force, before it is clamped; N.
    raw: f64,
    /// d′; m/s.
    pub rate: f64,
    /// u; m/s.
    pub sliding: f64,
    /// Force that keeps u constant; N.
    holding: f64,
    /// dN/dt while touching; N/s.
    pub normal_rate: f64,
    acceleration_x: f64,
    acceleration_y: f64,
    spin_rate: f64,
    /// w′; m/s².
    pub plate_acceleration: f64,
}

impl Phase<'_> {
    fn law_at(&self, displacement: f64, rate: f64) -> ContactForce<f64, 4> {
        let d = displacement.max(SMALLEST_DISPLACEMENT);
        self.law.evaluate(d, rate, self.peak)
    }

    pub fn forces(&self, state: &State) -> Forces {
        let planar = self.planar;
        let lowest = planar.lowest_point(state);
        let rate = planar.rate(state, &lowest);
        // y − z: friction acts in the plate's surface, where the flattened
        // body touches it.
        let height = lowest.depth - state.displacement;
        let law = self.law_at(state.displacement, rate);
        let normal = if self.parted { 0.0 } else { law.force };
        let sliding = state.velocity_x + height * state.spin;

        let (by_mass, by_inertia) = (1.0 / planar.mass, 1.0 / planar.inertia);
        let closing = state.velocity_y - state.plate_velocity;
        let holding = (height * lowest.slope * by_inertia * normal - state.spin * closing)
            / (by_mass + height * height * by_inertia);
        let tangential = match self.grip {
            _ if self.parted => 0.0,
            Grip::Frictionless => 0.0,
            Grip::Sticking => holding,
            Grip::Sliding(direction) => -direction * planar.friction * normal.max(0.0),
        };
        let acceleration_y = normal * by_mass - planar.gravity;
        let spin_rate = (height * tangential - lowest.slope * normal) * by_inertia;
        let support = planar.support_force(state).unwrap_or(0.0);
        let plate_acceleration = planar
            .plate
            .map_or(0.0, |plate| (support - normal) / plate.mass);
        let acceleration = plate_acceleration - acceleration_y
            + lowest.curvature * state.spin * state.spin
            + lowest.slope * spin_rate;
        Forces {
            normal,
            tangential,
            raw: law.force,
            rate,
            sliding,
            holding,
            normal_rate: law.by_displacement * rate + law.by_rate * acceleration,
            acceleration_x: tangential * by_mass,
            acceleration_y,
            spin_rate,
            plate_acceleration,
        }
    }

    /// dF/dt of the force on the plate's support; N/s.
    pub fn support_rate(&self, state: &State, forces: &Forces) -> f64 {
        self.planar.plate.map_or(forces.normal_rate, |plate| {
            -(plate.stiffness * state.plate_velocity + plate.damping * forces.plate_acceleration)
        })
    }

    /// Whether the surfaces stick where they do not slide, or how they begin
    /// to slide.
    fn grip_at(&self, state: &State, forces: &Forces) -> Grip {
        let friction = self.planar.friction;
        if friction == 0.0 {
            return Grip::Frictionless;
        }
        if forces.sliding.abs() > self.slowest_slide {
            return Grip::Sliding(forces.sliding.signum());
        }
        let (holding, largest) = if forces.normal > 0.0 || forces.holding != 0.0 {
            (forces.holding, friction * forces.normal.max(0.0))
        } else {
            // First touch without rotation: both forces start at zero, in
            // this ratio.
            let lowest = self.planar.lowest_point(state);
            let lever = lowest.depth / self.planar.inertia;
            let share = 1.0 / self.planar.mass + lowest.depth * lever;
            (lowest.slope * lever / share, friction)
        };
        if holding.abs() <= largest {
            Grip::Sticking
        } else {
            Grip::Sliding(-holding.signum())
        }
    }
}

impl System<SIZE, 1> for Phase<'_> {
    fn derivative(&self, s: f64, packed: &[Lanes<1>; SIZE]) -> [Lanes<1>; SIZE] {
        let state = Touching::unpack(packed).state;
        let forces = self.forces(&state);
        let stretch = match self.power {
            1 => 1.0,
            2 => 2.0 * s,
            _ => 4.0 * s * s * s,
        };
        let support = self.planar.plate.map_or(0.0, |plate| {
            plate.damping * state.plate_velocity * state.plate_velocity
        });
        [
            state.velocity_x,
            forces.rate,
            state.spin,
            state.plate_velocity,
            forces.acceleration_x,
            forces.acceleration_y,
            forces.spin_rate,
            forces.plate_acceleration,
            forces.normal,
            forces.normal * forces.rate,
            -forces.tangential * forces.sliding,
            support,
        ]
        .map(|rate| Lanes([rate * stretch]))
    }
}

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
    };
    phase.grip = phase.grip_at(state, &phase.forces(state));
    phase
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
            phase.grip = phase.grip_at(state, &phase.forces(state));
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
            let mut forces = phase.forces(state);
            if matches!(phase.grip, Grip::Sliding(_)) {
                forces.sliding = 0.0;
            }
            phase.grip = match (phase.grip, phase.grip_at(state, &forces)) {
                (Grip::Sticking, Grip::Sticking) => Grip::Sliding(-forces.holding.signum()),
                (_, grip) => grip,
            };
        }
        Stop::Gap => {}
    }
}

/// The first event within a step, with its fraction of the step.
fn first_stop(piece: &Piece) -> Option<(Stop, f64)> {
    // In the very first step the state starts at zero displacement and force.
    let mut from = if piece.step.start == 0.0 {
        EARLIEST_EVENT
    } else {
        0.0
    };
    for i in 1..=SEARCH_PIECES {
        let to = i as f64 / SEARCH_PIECES as f64;
        let mut first: Option<(Stop, f64)> = None;
        for (stop, level) in levels(&piece.phase, &piece.at(to).state) {
            if level > 0.0 {
                continue;
            }
            let sigma = bracketed_root(from, to, EVENT_TOLERANCE, |sigma| {
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
    let largest = phase.planar.friction * forces.normal.max(0.0);
    let grip = match phase.grip {
        Grip::Frictionless => None,
        _ if phase.parted => None,
        Grip::Sticking => Some((Stop::Grip, largest - forces.holding.abs())),
        Grip::Sliding(direction) => {
            Some((Stop::Grip, direction * forces.sliding + phase.slowest_slide))
        }
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
    let stored: f64 = GAUSS
        .iter()
        .map(|(node, weight)| weight * d * phase.law_at(node * d, 0.0).force.max(0.0))
        .sum();
    planar.energy(state) + stored < needed
}
