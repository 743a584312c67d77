//! What a scene is, before it runs.

use crate::annuli::MOST_ANNULI;
use crate::error::Error;
use crate::event::{Event, Partner};
use crate::interaction::{Draws, Interaction};
use crate::periods::Periods;
use crate::shape::beyond::{Unrepeatable, continued};
use crate::shape::clump::Clump;
use crate::shape::surface::Facet;
use crate::shape::wall::Wall;
use crate::vector::{UNTURNED, Vector, add, scaled};
use std::collections::BTreeMap;

/// A scene: what is there, and what happens where it touches.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Scene {
    /// Names of the materials, of fruit and of walls.
    pub materials: Vec<String>,
    /// Interactions of pairs of materials; the lower number first.
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
    /// Low and high of each axis along which the scene repeats: what leaves through one end comes
    /// in through the other; m.
    pub periodic: [Option<[f64; 2]>; 3],
    /// Time step; s.
    pub time_step: f64,
}

/// One fruit: a sphere, or a clump of spheres.
#[derive(Clone, Debug, PartialEq)]
pub struct Fruit {
    /// Material, by its number.
    pub material: usize,
    /// Radius, of a clump that of a sphere around it; m.
    pub radius: f64,
    /// Of which spheres it is, unless it is one.
    pub clump: Option<Clump>,
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
    pub fn sphere(material: usize, radius: f64, density: f64, place: Vector) -> Self {
        Self {
            material,
            radius,
            clump: None,
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
    pub fn inertia(&self) -> f64 {
        0.4 * self.mass * self.radius * self.radius
    }

    /// Largest diameter across its axis; m.
    pub fn diameter(&self) -> f64 {
        let across = self.clump.as_ref().map(|own| own.semi_axes(self.mass)[1]);
        2.0 * across.unwrap_or(self.radius)
    }

    /// Radius of the sphere with the same volume; m.
    pub fn mean_radius(&self) -> f64 {
        let axes = self.clump.as_ref().map(|own| own.semi_axes(self.mass));
        axes.map_or(self.radius, |[a, b, c]| (a * b * c).cbrt())
    }

    /// The least mass that a contact of the fruit feels along its normal: from a spheroid that is
    /// struck beside its centre it turns away; kg.
    pub fn least_felt_mass(&self) -> f64 {
        self.clump.as_ref().map_or(self.mass, |own| {
            // No normal of an ellipse passes its centre farther off than a − b.
            let axes = own.semi_axes(self.mass);
            let least = axes.into_iter().fold(f64::INFINITY, f64::min);
            let arm = axes.into_iter().fold(0.0, f64::max) - least;
            let moment = own.moments.iter().copied().fold(0.0, f64::max);
            1.0 / (1.0 / self.mass + arm * arm / moment)
        })
    }

    pub(crate) const ORIENTATION: [f64; 4] = UNTURNED;
}

impl Sink {
    /// Whether a place, or an image of it, is in the box.
    pub fn holds(&self, place: Vector, periods: &Periods) -> bool {
        let middle = scaled(add(self.low, self.high), 0.5);
        let place = periods.image(place, middle);
        (0..3).all(|axis| (self.low[axis]..=self.high[axis]).contains(&place[axis]))
    }
}

/// Names of the axes.
pub const AXES: [char; 3] = ['x', 'y', 'z'];
const PERIODS: [&str; 3] = [
    "the period along x",
    "the period along y",
    "the period along z",
];

/// Skin of the list of neighbours over the mean radius; 1.
const SKIN: f64 = 0.16;

/// Periods over the largest diameter at least; 1.
const SHORTEST_PERIOD: f64 = 3.0;

impl Scene {
    /// Along which axes it repeats.
    pub fn periods(&self) -> Periods {
        Periods::new(&self.periodic)
    }

    /// How far apart bodies are listed as neighbours, and what of that is needed without any
    /// motion; m.
    pub(crate) fn skin(&self) -> [f64; 2] {
        let mean = self.fruit.iter().map(|fruit| fruit.radius).sum::<f64>();
        // Surfaces of ovate fruit lie a little outside of the spheres by which they are listed.
        let clumps = self.fruit.iter().filter_map(|fruit| fruit.clump.as_ref());
        let lacks = 2.0 * clumps.map(Clump::lacks).fold(0.0, f64::max);
        [SKIN * mean / self.fruit.len().max(1) as f64 + lacks, lacks]
    }

    /// How far two fruit are apart at most that are listed as neighbours; m.
    fn farthest_neighbours(&self) -> f64 {
        let radii = self.fruit.iter().map(|fruit| fruit.radius);
        2.0 * radii.fold(0.0, f64::max) + self.skin()[0]
    }

    /// Parts of a wall, with those that continue it beyond the ends.
    pub(crate) fn parts_of(&self, wall: &Wall) -> Result<Vec<Facet>, Unrepeatable> {
        // A body may have left the room by half a fruit and the skin.
        continued(wall, &self.periods(), 2.0 * self.farthest_neighbours())
    }

    /// The first wall that is not the same one period on, by its number.
    pub fn first_unrepeatable(&self) -> Option<(usize, Unrepeatable)> {
        let mut walls = self.walls.iter().enumerate();
        walls.find_map(|(number, wall)| Some((number, self.parts_of(wall).err()?)))
    }

    /// Checks that each fruit has one nearest image.
    ///
    /// # Errors
    /// A period is too short for the largest fruit, or is no length.
    pub fn check_periods(&self) -> Result<(), Error> {
        let radii = self.fruit.iter().map(|fruit| fruit.radius);
        let shortest = 2.0 * SHORTEST_PERIOD * radii.fold(0.0, f64::max);
        let shortest = shortest.max(2.0 * self.farthest_neighbours());
        for (what, ends) in PERIODS.into_iter().zip(self.periodic) {
            let Some([low, high]) = ends else {
                continue;
            };
            let value = high - low;
            let wrong = |problem| {
                Err(Error::Value {
                    what,
                    value,
                    problem,
                })
            };
            if !(low < high && value.is_finite()) {
                return wrong("its ends must be numbers, the lower one first");
            }
            if value < shortest {
                return wrong("it must be at least three times the diameter of the largest fruit");
            }
        }
        Ok(())
    }

    /// The interaction of two materials.
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

    /// The materials that met in a contact, the lower number first.
    pub fn materials_of(&self, event: &Event) -> (usize, usize) {
        let own = self.fruit[event.fruit as usize].material;
        let other = match event.partner {
            Partner::Fruit(other) => self.fruit[other as usize].material,
            Partner::Wall(wall) => self.walls[wall as usize].material,
        };
        (own.min(other), own.max(other))
    }

    /// R* (m) and effective mass (kg) of the mean fruit of two materials, or of a material
    /// and a wall.
    pub fn mean_contact(&self, (first, second): (usize, usize)) -> Option<(f64, f64)> {
        let mean = |material: usize| {
            let fruit = self.fruit.iter().filter(|own| own.material == material);
            let (n, radius, mass) = fruit.fold((0.0, 0.0, 0.0), |(n, radius, mass), own| {
                (n + 1.0, radius + own.radius, mass + own.mass)
            });
            (n > 0.0).then(|| (radius / n, mass / n))
        };
        match (mean(first), mean(second)) {
            (Some(a), Some(b)) => Some((a.0 * b.0 / (a.0 + b.0), a.1 * b.1 / (a.1 + b.1))),
            (own, None) | (None, own) => own,
        }
    }

    /// Checks its numbers.
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
            for own in fruit.clump.iter() {
                for &(_, radius) in &own.spheres {
                    positive("the radius of a sphere of a clump", radius)?;
                }
                for moment in own.moments {
                    positive("a moment of inertia of a clump", moment)?;
                }
                positive("the number of spheres of a clump", own.spheres.len() as f64)?;
            }
        }
        self.check_periods()?;
        if let Some((wall, Unrepeatable { axis, problem })) = self.first_unrepeatable() {
            let wall = self.walls[wall].name.clone();
            return Err(Error::Unrepeatable {
                wall,
                axis: AXES[axis],
                problem,
            });
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
            if !(1..=MOST_ANNULI).contains(&interaction.annuli) {
                return Err(Error::Value {
                    what: "a number of annuli",
                    value: interaction.annuli as f64,
                    problem: "it must be 1 to 8",
                });
            }
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
