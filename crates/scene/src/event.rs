//! Contacts as they end.

use crate::vector::Vector;

/// What a fruit touched.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Partner {
    /// Another fruit, by its number.
    Fruit(u32),
    /// A wall, by its number in the scene.
    Wall(u32),
}

/// One contact from first touch to its end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Event {
    /// Number of the fruit; of two fruit the lower one.
    pub fruit: u32,
    /// What it touched.
    pub partner: Partner,
    /// First touch; s.
    pub time: f64,
    /// From first touch to the last moment of a force; s.
    pub duration: f64,
    /// Whether the contact was still there when the scene ended.
    pub lasting: bool,
    /// Where it touched in space; m.
    pub place: Vector,
    /// Where on the fruit's surface: direction from its centre, fixed to the fruit.
    pub spot: Vector,
    /// The same of the other fruit; zero of a wall.
    pub other_spot: Vector,
    /// Normal speed at first touch; m/s.
    pub normal_speed: f64,
    /// Tangential speed of the surfaces at first touch; m/s.
    pub tangential_speed: f64,
    /// Largest normal force; N.
    pub peak_force: f64,
    /// Largest displacement; m.
    pub largest_displacement: f64,
    /// Energy that the normal contact kept; J.
    pub absorbed_energy: f64,
    /// Energy that friction and rolling took; J.
    pub friction_energy: f64,
}

/// How a contact began.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Encounter {
    pub time: f64,
    pub place: Vector,
    pub spot: Vector,
    pub other_spot: Vector,
    pub normal_speed: f64,
    pub tangential_speed: f64,
}

impl Encounter {
    pub(crate) fn swapped(self) -> Self {
        Self {
            spot: self.other_spot,
            other_spot: self.spot,
            ..self
        }
    }
}
