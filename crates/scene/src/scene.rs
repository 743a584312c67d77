//! What a scene is, before it runs.

use crate::error::Error;
use crate::interaction::{Draws, Interaction};
use crate::vector::{UNTURNED, Vector};
use crate::wall::Wall;
use std::collections::BTreeMap;

/// A scene: what is there, and what happens where it touches.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Scene {
    /// Names of the materials, of fruit and of walls.
    pub materials: Vec<String>,
    /// What pairs of materials do to each other; the lower number first.
    pub interactions: BTreeMap<(usize, usize), Interaction>,
    /// Walls.
    pub walls: Vec<Wall>,
    /// Every fruit that comes, in the order in which it is released.
    pub fruit: Vec<Fruit>,
    /// Where fruit leave the scene.
    pub sinks: Vec<Sink>,
    /// Gravity; m/s².
    pub gravity: Vector,
    /// Drag of the air, if it counts.
    pub air: Option<Air>,
    /// Time step; s.
    pub time_step: f64,
}

/// One fruit: a sphere.
#[derive(Clone, Debug, PartialEq)]
pub struct Fruit {
    /// Material, by its number.
    pub material: usize,
    /// Radius; m.
    pub radius: f64,
    /// Mass; kg.
    pub mass: f64,
    /// How it differs from the median of its kind.
    pub draws: Draws,
    /// When it comes; s.
    pub time: f64,
    /// Where; m.
    pub place: Vector,
    /// Velocity; m/s.
    pub velocity: Vector,
    /// Angular velocity; rad/s.
    pub spin: Vector,
    /// Lowest and highest place at which it may come in as well, where its own is taken; m.
    pub elsewhere: Option<[Vector; 2]>,
}

/// A box in which fruit leave the scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Sink {
    /// Name.
    pub name: String,
    /// Its lowest corner; m.
    pub low: Vector,
    /// Its highest corner; m.
    pub high: Vector,
}

/// Air at rest: a drag ½ ρ C A v².
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Air {
    /// Density; kg/m³.
    pub density: f64,
    /// Drag coefficient of a sphere; 1.
    pub drag_coefficient: f64,
}

impl Fruit {
    /// A fruit of homogeneous density that is released at time zero, at rest.
    #[must_use]
    pub fn sphere(material: usize, radius: f64, density: f64, place: Vector) -> Self {
        Self {
            material,
            radius,
            mass: density * 4.0 / 3.0 * std::f64::consts::PI * radius.powi(3),
            draws: Draws::default(),
            time: 0.0,
            place,
            velocity: [0.0; 3],
            spin: [0.0; 3],
            elsewhere: None,
        }
    }

    /// Moment of inertia of a homogeneous sphere; kg m².
    #[must_use]
    pub fn inertia(&self) -> f64 {
        0.4 * self.mass * self.radius * self.radius
    }

    pub(crate) const ORIENTATION: [f64; 4] = UNTURNED;
}

impl Scene {
    /// What two materials do to each other.
    ///
    /// # Errors
    /// [`Error::InteractionMissing`].
    pub fn interaction(&self, first: usize, second: usize) -> Result<&Interaction, Error> {
        let key = (first.min(second), first.max(second));
        self.interactions.get(&key).ok_or_else(|| {
            let name = |material: usize| self.materials[material].clone();
            Error::InteractionMissing {
                first: name(key.0),
                second: name(key.1),
            }
        })
    }

    /// Whether its numbers can be.
    ///
    /// # Errors
    /// The first that cannot.
    pub fn check(&self) -> Result<(), Error> {
        let positive = |what, value: f64| match value > 0.0 && value.is_finite() {
            true => Ok(()),
            false => Err(Error::Value {
                what,
                value,
                problem: "it must be a number above zero",
            }),
        };
        positive("the time step", self.time_step)?;
        for fruit in &self.fruit {
            positive("the radius of a fruit", fruit.radius)?;
            positive("the mass of a fruit", fruit.mass)?;
        }
        let kinds: std::collections::BTreeSet<usize> =
            self.fruit.iter().map(|fruit| fruit.material).collect();
        for &kind in &kinds {
            for &other in &kinds {
                self.interaction(kind, other)?;
            }
            for wall in &self.walls {
                self.interaction(kind, wall.material)?;
            }
        }
        for interaction in self.interactions.values() {
            for (what, value) in [
                ("a coefficient of friction", interaction.friction),
                ("a coefficient of rolling friction", interaction.rolling),
                ("a tangential stiffness ratio", interaction.tangential_ratio),
                ("a tangential damping ratio", interaction.tangential_damping),
            ] {
                if !(value >= 0.0 && value.is_finite()) {
                    let problem = "it must be a number at or above zero";
                    return Err(Error::Value {
                        what,
                        value,
                        problem,
                    });
                }
            }
        }
        Ok(())
    }
}
