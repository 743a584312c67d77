//! Loads of contacts as they end.

use crate::binary;
use crate::binary::Binary;
use crate::vector::Vector;
use std::io::{Read, Result as IoResult, Write};

/// What a fruit touched.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Partner {
    /// Another fruit, by its number.
    Fruit(u32),
    /// A wall, by its number in the scene.
    Wall(u32),
}

/// One load of a contact: a pulse, or a rest between pulses. A contact that does not last is one
/// pulse, from first touch to its end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Event {
    /// Number of the fruit; of two fruit the lower one.
    pub fruit: u32,
    /// What it touched.
    pub partner: Partner,
    /// First touch, or when the force began to rise; s.
    pub time: f64,
    /// From there to the last moment of a force, or until it rises again; s.
    pub duration: f64,
    /// Whether the load was still there when the scene ended.
    pub lasting: bool,
    /// Which load of the contact, from 1.
    pub number: u32,
    /// Whether it is a rest: a load that does not come and go.
    pub resting: bool,
    /// From its beginning until the force had fallen below half of its peak; s.
    pub width: f64,
    /// Where it touched in space; m.
    pub place: Vector,
    /// Where on the fruit's surface: direction from its centre, fixed to the fruit.
    pub spot: Vector,
    /// The same of the other fruit; zero of a wall.
    pub other_spot: Vector,
    /// Normal speed at first touch, or the largest seen as the force of a later pulse grows; zero of a
    /// rest; m/s.
    pub normal_speed: f64,
    /// Tangential speed of the surfaces then; m/s.
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

/// How a contact, or a later pulse of it, began.
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
    /// That of a later pulse, which began before it was seen.
    pub(crate) fn from(self, time: f64) -> Self {
        Self {
            time,
            normal_speed: self.normal_speed.max(0.0),
            ..self
        }
    }

    pub(crate) fn swapped(self) -> Self {
        Self {
            spot: self.other_spot,
            other_spot: self.spot,
            ..self
        }
    }
}

binary!(Encounter {
    time,
    place,
    spot,
    other_spot,
    normal_speed,
    tangential_speed
});
binary!(Event {
    fruit,
    partner,
    time,
    duration,
    lasting,
    number,
    resting,
    width,
    place,
    spot,
    other_spot,
    normal_speed,
    tangential_speed,
    peak_force,
    largest_displacement,
    absorbed_energy,
    friction_energy
});

impl Binary for Partner {
    fn write(&self, to: &mut dyn Write) -> IoResult<()> {
        let (wall, number) = match self {
            Self::Fruit(number) => (false, number),
            Self::Wall(number) => (true, number),
        };
        wall.write(to)?;
        number.write(to)
    }

    fn read(from: &mut dyn Read) -> IoResult<Self> {
        let wall = bool::read(from)?;
        let number = u32::read(from)?;
        Ok(if wall {
            Self::Wall(number)
        } else {
            Self::Fruit(number)
        })
    }
}
