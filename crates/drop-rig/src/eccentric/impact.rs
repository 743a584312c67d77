//! The impacts of a drop of a planar body.

use crate::simulate::DropImpact;

/// Summary of one impact of a planar body; SI.
///
/// Energies balance: kinetic before + `height_energy` = kinetic after +
/// `contact_energy` + `sliding_energy` + `support_energy` +
/// `plate_energy_change`.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, utoipa::ToSchema)]
pub struct EccentricImpact {
    /// As for a central impact; velocities, restitution and absorbed energy
    /// are those of the centre of mass along the normal, the impact velocity
    /// and `contact_restitution` those of the point of contact.
    #[serde(flatten)]
    pub impact: DropImpact,
    /// Rotation from release to onset, anticlockwise; rad.
    pub rotation: f64,
    /// Horizontal distance from the centre of mass to the point of contact at
    /// onset, positive to the right; m.
    pub lever_arm: f64,
    /// [`effective_mass_factor`](crate::eccentric::shape::effective_mass_factor)
    /// at onset; 1.
    pub effective_mass_factor: f64,
    /// Velocity of the centre of mass at onset, up positive; m/s.
    #[serde(skip)]
    pub velocity_before: f64,
    /// Angular velocity at onset, anticlockwise; rad/s.
    pub angular_velocity_before: f64,
    /// Angular velocity at separation; rad/s.
    #[schema(value_type = Option<f64>)]
    pub angular_velocity: f64,
    /// Horizontal velocity of the centre of mass at onset, positive to the
    /// right; m/s.
    pub tangential_velocity_before: f64,
    /// Horizontal velocity of the centre of mass at separation; m/s.
    #[schema(value_type = Option<f64>)]
    pub tangential_velocity: f64,
    /// Integral of the friction force on the body, positive to the right; N s.
    pub friction_impulse: f64,
    /// Kinetic energy of the centre of mass at onset; J.
    pub translation_energy_before: f64,
    /// Kinetic energy of the rotation at onset; J.
    pub rotation_energy_before: f64,
    /// Kinetic energy of the centre of mass at separation; J.
    #[schema(value_type = Option<f64>)]
    pub translation_energy: f64,
    /// Kinetic energy of the rotation at separation; J.
    #[schema(value_type = Option<f64>)]
    pub rotation_energy: f64,
    /// Energy that the contact took, ∫ N d′ dt; J.
    pub contact_energy: f64,
    /// Energy that sliding took; J.
    pub sliding_energy: f64,
    /// Energy that the damper of the plate took from onset to separation; J.
    pub support_energy: f64,
    /// Energy of the vibrating plate at separation, less that at onset; J.
    #[serde(skip)]
    pub plate_energy_change: f64,
    /// Energy from the height that the centre of mass lost from onset to
    /// separation; J.
    #[serde(skip)]
    pub height_energy: f64,
}

impl EccentricImpact {
    /// An impact that has not ended: what belongs to its end is not a number.
    pub(crate) const LASTING: Self = Self {
        impact: DropImpact::LASTING,
        rotation: 0.0,
        lever_arm: 0.0,
        effective_mass_factor: 1.0,
        velocity_before: 0.0,
        angular_velocity_before: 0.0,
        angular_velocity: f64::NAN,
        tangential_velocity_before: 0.0,
        tangential_velocity: f64::NAN,
        friction_impulse: 0.0,
        translation_energy_before: 0.0,
        rotation_energy_before: 0.0,
        translation_energy: f64::NAN,
        rotation_energy: f64::NAN,
        contact_energy: 0.0,
        sliding_energy: 0.0,
        support_energy: 0.0,
        plate_energy_change: f64::NAN,
        height_energy: f64::NAN,
    };
}

/// The impacts of one drop of a planar body.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct EccentricSummary {
    /// In order of time.
    pub impacts: Vec<EccentricImpact>,
    /// From onset to onset; s.
    pub intervals: Vec<f64>,
    /// The body stays on the plate in the last of `impacts` (lying, rolling or
    /// rocking): there may be fewer than requested. What belongs to the
    /// separation of such an impact is not a number.
    pub at_rest: bool,
    /// Moment of inertia about the centre of mass; kg m².
    pub inertia: f64,
}
