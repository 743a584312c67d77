//! Forces and accelerations of the planar body while it touches the plate.
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

use crate::eccentric::body::{Planar, State};
use windfall_contact::law::{ContactForce, ContactLaw, EndRule, SMALLEST_DISPLACEMENT};
use windfall_contact::laws::any_law::{AnyLaw, LARGEST_PARAMETERS};
use windfall_identify::rig::contact_time::stretch;
use windfall_numerics::ode::step::System;
use windfall_numerics::real::Lanes;

/// Part of the body's weight that a force keeping the surfaces from sliding may
/// lack to its limit: rounding.
const WEAKEST_HOLD: f64 = 1e-12;

/// State and quadratures of the integration.
pub(crate) const SIZE: usize = 12;

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
    pub fn pack(&self) -> [Lanes<1>; SIZE] {
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

    pub fn unpack(packed: &[Lanes<1>; SIZE]) -> Self {
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
pub(crate) enum Grip {
    Frictionless,
    Sticking,
    /// The body slides to the right (1) or to the left (−1).
    Sliding(f64),
}

/// Right-hand side between two events.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Phase<'a> {
    pub planar: &'a Planar,
    pub law: AnyLaw,
    pub end: EndRule,
    pub power: u32,
    pub peak: f64,
    pub loading: bool,
    pub beyond_kink: bool,
    /// The law's force has ended, the gap has not opened yet.
    pub parted: bool,
    pub grip: Grip,
    pub slowest_slide: f64,
    /// Tolerance of the present grip beyond its limit; m/s or N.
    pub slack: f64,
}

/// Forces and accelerations at one state.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Forces {
    /// N, as it acts; N.
    pub normal: f64,
    /// T, on the body, positive to the right; N.
    pub tangential: f64,
    /// Law's force, before it is clamped; N.
    pub raw: f64,
    /// d′; m/s.
    pub rate: f64,
    /// u; m/s.
    pub sliding: f64,
    /// Force that keeps u constant; N.
    pub holding: f64,
    /// dN/dt while touching; N/s.
    pub normal_rate: f64,
    acceleration_x: f64,
    acceleration_y: f64,
    spin_rate: f64,
    /// w′; m/s².
    pub plate_acceleration: f64,
}

impl Phase<'_> {
    pub fn law_at(&self, displacement: f64, rate: f64) -> ContactForce<f64, LARGEST_PARAMETERS> {
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

    /// A holding force below this is lost in rounding; N.
    pub fn weakest_hold(&self) -> f64 {
        WEAKEST_HOLD * self.planar.mass * self.planar.gravity
    }

    /// Whether the surfaces stick where they do not slide, or how they begin
    /// to slide.
    pub fn grip_at(&self, state: &State, forces: &Forces) -> Grip {
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
        if holding.abs() <= largest + self.weakest_hold() {
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
        let stretch = stretch(s, self.power);
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
