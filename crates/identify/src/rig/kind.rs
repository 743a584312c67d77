//! Rigs: how the impactor moves between contacts and under the contact force.

use crate::error::{Error, check_positive};

/// Pendulum arm that strikes a fruit fixed to an anvil at the arm's lowest
/// point: I θ'' = −m g l sin θ − F r cos θ, x = r sin θ.
///
/// # Source
/// Eq. (7) of the 2003 pendulum study, with F positive when repulsive and the
/// distance l of the centre of mass in the gravity term.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pendulum {
    /// Moment of inertia about the pivot, I; kg m².
    pub inertia: f64,
    /// Distance from pivot to point of contact, r; m.
    pub arm: f64,
    /// Mass of arm and impactor, m; kg.
    pub mass: f64,
    /// Distance from pivot to the centre of mass, l; m.
    pub centre_of_mass: f64,
    /// Acceleration of gravity, g; m/s².
    pub gravity: f64,
}

/// Body on a line under a constant driving acceleration (an incline, a drop
/// hammer, a cart): m x'' = m a − F.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Carriage {
    /// Mass, m; kg.
    pub mass: f64,
    /// Acceleration towards the fruit when there is no contact, a; m/s².
    pub driving_acceleration: f64,
}

/// A rig that windfall can simulate and fit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Rig {
    /// Pendulum.
    Pendulum(Pendulum),
    /// Carriage.
    Carriage(Carriage),
}

impl Rig {
    /// Whether every quantity has a physical value.
    ///
    /// # Errors
    /// [`Error::BadInput`] names the first that has none.
    pub fn check(&self) -> Result<(), Error> {
        let quantities = match self {
            Self::Pendulum(p) => vec![
                ("inertia", p.inertia),
                ("arm", p.arm),
                ("mass", p.mass),
                ("centre_of_mass", p.centre_of_mass),
                ("gravity", p.gravity),
            ],
            Self::Carriage(c) => vec![("mass", c.mass)],
        };
        quantities
            .into_iter()
            .try_for_each(|(name, value)| check_positive(name, value))
    }

    /// Mass that the contact feels: I/r² of a pendulum, m of a carriage; kg.
    pub fn effective_mass(&self) -> f64 {
        match self {
            Self::Pendulum(rig) => rig.inertia / (rig.arm * rig.arm),
            Self::Carriage(rig) => rig.mass,
        }
    }

    /// Acceleration towards the fruit during contact, beside that of the contact: none for a
    /// pendulum, whose arm hangs upright there; m/s².
    pub fn driving_acceleration(&self) -> f64 {
        match self {
            Self::Pendulum(_) => 0.0,
            Self::Carriage(rig) => rig.driving_acceleration,
        }
    }

    /// Work of gravity or the driving acceleration on the way from first touch to a
    /// displacement: m a x of a carriage, m g l (cos θ − 1) of a pendulum; J.
    pub fn driving_work(&self, displacement: f64) -> f64 {
        match self {
            Self::Pendulum(rig) => {
                let sine = displacement / rig.arm;
                let weight = rig.mass * rig.gravity * rig.centre_of_mass;
                // 1 − cos θ without cancellation.
                -weight * sine * sine / (1.0 + (1.0 - sine * sine).max(0.0).sqrt())
            }
            Self::Carriage(rig) => rig.mass * rig.driving_acceleration * displacement,
        }
    }

    /// Velocity at the contact after a fall from the highest point of a pendulum,
    /// r (4 m g l / I)^½; m/s. `None` where it has no limit.
    pub fn largest_velocity(&self) -> Option<f64> {
        match self {
            Self::Pendulum(rig) => {
                let energy = 4.0 * rig.mass * rig.gravity * rig.centre_of_mass;
                (energy > 0.0).then(|| rig.arm * (energy / rig.inertia).sqrt())
            }
            Self::Carriage(_) => None,
        }
    }
}
