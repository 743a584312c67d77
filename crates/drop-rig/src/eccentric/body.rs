//! The falling body and the state of body and plate.

use crate::eccentric::shape::{LowestPoint, Shape, effective_mass_factor};
use crate::rig::Plate;
use windfall_identify::error::{Error, check_finite, check_not_negative, check_positive};

/// A planar rigid body that falls on the plate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EccentricBody {
    /// Outline and attitude at release.
    pub shape: Shape,
    /// Mass; kg.
    pub mass: f64,
    /// Moment of inertia about the centre of mass; kg m². `None`: that of a
    /// solid ([`Shape::solid_inertia`]).
    pub inertia: Option<f64>,
    /// Coulomb's coefficient μ between body and plate, sticking and sliding; 1.
    pub friction: f64,
    /// Angular velocity at release, anticlockwise; rad/s.
    pub angular_velocity: f64,
    /// Horizontal velocity of the centre of mass at release; m/s.
    pub tangential_velocity: f64,
}

impl EccentricBody {
    /// A body of a solid's moment of inertia, released at rest, without
    /// friction.
    pub fn at_rest(shape: Shape, mass: f64) -> Self {
        Self {
            shape,
            mass,
            inertia: None,
            friction: 0.0,
            angular_velocity: 0.0,
            tangential_velocity: 0.0,
        }
    }

    /// Moment of inertia about the centre of mass; kg m².
    pub fn moment_of_inertia(&self) -> f64 {
        self.inertia
            .unwrap_or_else(|| self.shape.solid_inertia(self.mass))
    }

    /// [`effective_mass_factor`] of the body in its attitude at release.
    pub fn effective_mass_factor(&self) -> f64 {
        effective_mass_factor(self.mass, self.shape.lever_arm(), self.moment_of_inertia())
    }

    /// # Errors
    /// An error that names the first quantity without a physical value.
    pub(crate) fn check(&self) -> Result<(), Error> {
        check_positive("mass", self.mass)?;
        check_not_negative("friction", self.friction)?;
        check_finite("angular velocity", self.angular_velocity)?;
        check_finite("tangential velocity", self.tangential_velocity)?;
        match self.shape {
            Shape::OffsetDisc {
                radius,
                offset,
                angle,
            } => {
                check_positive("radius", radius)?;
                check_not_negative("offset", offset)?;
                check_finite("angle", angle)?;
                if offset >= radius {
                    return Err(Error::OffsetOutsideDisc { offset, radius });
                }
                if self.inertia.is_none() && self.moment_of_inertia() <= 0.0 {
                    return Err(Error::NoMomentOfInertia { offset, radius });
                }
            }
            Shape::Ellipse {
                semi_axes: [a, b],
                tilt,
            } => {
                check_positive("first semi-axis", a)?;
                check_positive("second semi-axis", b)?;
                check_finite("tilt", tilt)?;
            }
        }
        check_positive("moment of inertia", self.moment_of_inertia())
    }
}

/// Body, plate and gravity.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Planar {
    pub shape: Shape,
    pub mass: f64,
    pub inertia: f64,
    pub friction: f64,
    pub gravity: f64,
    pub plate: Option<Plate>,
}

/// State of body and plate. The height of the centre of mass follows from it:
/// y = z + H − d.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct State {
    /// Horizontal place of the centre of mass; m.
    pub x: f64,
    /// d, indentation; minus the gap when the body is off the plate; m.
    pub displacement: f64,
    /// Rotation since release; rad.
    pub rotation: f64,
    /// z, plate above its static position; m.
    pub plate: f64,
    /// Velocity of the centre of mass to the right; m/s.
    pub velocity_x: f64,
    /// Velocity of the centre of mass upwards; m/s.
    pub velocity_y: f64,
    /// Angular velocity, anticlockwise; rad/s.
    pub spin: f64,
    /// Velocity of the plate upwards; m/s.
    pub plate_velocity: f64,
}

impl Planar {
    pub fn lowest_point(&self, state: &State) -> LowestPoint {
        self.shape.lowest_point(state.rotation)
    }

    /// dd/dt = w − y′ + H′ ω; m/s. It is the normal velocity of the material
    /// point at the lowest point too: the place of contact wanders along the
    /// outline, and the outline is horizontal there.
    pub fn rate(&self, state: &State, lowest: &LowestPoint) -> f64 {
        state.plate_velocity - state.velocity_y + lowest.slope * state.spin
    }

    /// Force of the plate on its support, −(k z + c w); N.
    pub fn support_force(&self, state: &State) -> Option<f64> {
        let plate = self.plate?;
        Some(-(plate.stiffness * state.plate + plate.damping * state.plate_velocity))
    }

    /// Kinetic and potential energy of body and plate, without what the
    /// contact stores; J. Zero for a body at rest with its centre of mass at
    /// the height of the static plate.
    pub fn energy(&self, state: &State) -> f64 {
        self.translation_energy(state)
            + self.rotation_energy(state)
            + self.mass * self.gravity * self.height(state)
            + self.plate_energy(state)
    }

    /// Height of the centre of mass over the static plate, y; m.
    pub fn height(&self, state: &State) -> f64 {
        state.plate + self.lowest_point(state).depth - state.displacement
    }

    /// Energy of the plate's vibration about its static position; J.
    pub fn plate_energy(&self, state: &State) -> f64 {
        self.plate.map_or(0.0, |plate| {
            0.5 * (plate.stiffness * state.plate * state.plate
                + plate.mass * state.plate_velocity * state.plate_velocity)
        })
    }

    pub fn translation_energy(&self, state: &State) -> f64 {
        0.5 * self.mass
            * (state.velocity_x * state.velocity_x + state.velocity_y * state.velocity_y)
    }

    pub fn rotation_energy(&self, state: &State) -> f64 {
        0.5 * self.inertia * state.spin * state.spin
    }
}
