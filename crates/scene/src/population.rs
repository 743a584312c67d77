//! Fruit as they are drawn from a population, and when and where they come.

use crate::error::Error;
use crate::interaction::Draws;
use crate::scene::Fruit;
use crate::shape::clump::Clump;
use crate::vector::Vector;
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// A kind of fruit.
#[derive(Clone, Debug, PartialEq)]
pub struct FruitKind {
    /// Material, by its number in the scene.
    pub material: usize,
    /// How many.
    pub count: usize,
    /// Mean radius; m.
    pub radius: f64,
    /// Standard deviation of the radius between fruit; m. Draws beyond three of them are
    /// rejected.
    pub radius_sd: f64,
    /// Of ovate fruit how they differ from spheres; the radius is that across the axis.
    pub ovate: Option<Ovate>,
    /// Density; kg/m³.
    pub density: f64,
    /// How they come.
    pub source: Source,
}

/// Fruit that are longer than thick: clumps of spheres along the axis of a spheroid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ovate {
    /// Length over diameter, above 1.
    pub ratio: f64,
    /// Number of spheres.
    pub spheres: usize,
}

/// How fruit come into a scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Source {
    /// All at the beginning, on a loose lattice in a box, from below.
    Lattice {
        /// Lowest corner; m.
        low: Vector,
        /// Highest corner; m.
        high: Vector,
        /// Velocity; m/s.
        velocity: Vector,
    },
    /// One after the other at random places of a box, at a rate.
    Pour {
        /// Lowest corner; m.
        low: Vector,
        /// Highest corner; m.
        high: Vector,
        /// Velocity; m/s.
        velocity: Vector,
        /// Fruit per second; 1/s.
        rate: f64,
        /// When the first comes; s.
        from: f64,
    },
    /// One after the other from one place.
    Drop {
        /// From where; m.
        place: Vector,
        /// Velocity; m/s.
        velocity: Vector,
        /// Time from one to the next; s.
        interval: f64,
        /// When the first comes; s.
        from: f64,
    },
    /// From a tree: at rest, at random places of a box, at random times.
    Tree {
        /// Lowest corner; m.
        low: Vector,
        /// Highest corner; m.
        high: Vector,
        /// Over which time they come off; s.
        over: f64,
    },
}

/// Draws beyond this many standard deviations are rejected.
const FARTHEST: f64 = 3.0;
/// Pitch of the lattice over the largest diameter; 1.
const PITCH: f64 = 1.03;
/// Largest displacement from the place of the lattice, over the mean radius; 1.
const JITTER: f64 = 0.02;

/// All fruit of all kinds; the same for the same seed, whatever else the scene holds.
///
/// # Errors
/// A lattice has no room for its fruit; a box is smaller than a fruit.
pub fn drawn(kinds: &[FruitKind], seed: u64) -> Result<Vec<Fruit>, Error> {
    let mut fruit = Vec::new();
    for (number, kind) in kinds.iter().enumerate() {
        let mut generator = ChaCha8Rng::seed_from_u64(seed);
        // Each kind has its own numbers.
        generator.set_stream(number as u64);
        fruit.extend(drawn_of(kind, &mut generator)?);
    }
    Ok(fruit)
}

fn drawn_of(kind: &FruitKind, generator: &mut ChaCha8Rng) -> Result<Vec<Fruit>, Error> {
    let ratio = kind.ovate.map_or(1.0, |own| own.ratio);
    let largest = ratio * (kind.radius + FARTHEST * kind.radius_sd);
    let lattice = match kind.source {
        Source::Lattice { low, high, .. } => lattice(low, high, largest, kind.count)?,
        _ => Vec::new(),
    };
    let mut all = Vec::with_capacity(kind.count);
    for number in 0..kind.count {
        let mut deviation = normal(generator);
        while deviation.abs() > FARTHEST {
            deviation = normal(generator);
        }
        let mut draws = Draws::default();
        draws.iter_mut().for_each(|own| *own = normal(generator));
        let across = kind.radius + kind.radius_sd * deviation;
        let mut fruit = match kind.ovate {
            None => Fruit::sphere(kind.material, across, kind.density, [0.0; 3]),
            Some(own) => ovate(kind, own, across, generator)?,
        };
        let radius = fruit.radius;
        fruit.draws = draws;
        match kind.source {
            Source::Lattice { velocity, .. } => {
                let jitter = JITTER * kind.radius;
                fruit.place =
                    lattice[number].map(|own| own + jitter * (generator.random::<f64>() - 0.5));
                fruit.velocity = velocity;
            }
            Source::Pour {
                low,
                high,
                velocity,
                rate,
                from,
            } => {
                fruit.time = from + number as f64 / rate;
                fruit.place = somewhere(low, high, radius, generator)?;
                fruit.velocity = velocity;
                fruit.elsewhere = Some([low.map(|own| own + radius), high.map(|own| own - radius)]);
            }
            Source::Drop {
                place,
                velocity,
                interval,
                from,
            } => {
                fruit.time = from + number as f64 * interval;
                (fruit.place, fruit.velocity) = (place, velocity);
            }
            Source::Tree { low, high, over } => {
                fruit.time = over * generator.random::<f64>();
                fruit.place = somewhere(low, high, radius, generator)?;
            }
        }
        all.push(fruit);
    }
    Ok(all)
}

/// An ovate fruit that points anywhere.
fn ovate(
    kind: &FruitKind,
    own: Ovate,
    across: f64,
    generator: &mut ChaCha8Rng,
) -> Result<Fruit, Error> {
    let ball = Fruit::sphere(kind.material, across, kind.density, [0.0; 3]);
    let (mass, length) = (own.ratio * ball.mass, 2.0 * own.ratio * across);
    let clump = Clump::spheroid(length, 2.0 * across, mass, own.spheres);
    let mut clump = clump.ok_or(Error::Value {
        what: "the length of a fruit over its diameter",
        value: own.ratio,
        problem: "it must be above one, and the clump of two spheres or more",
    })?;
    // Four normal numbers point anywhere in their space (Muller, 1959).
    let turn = [0; 4].map(|_| normal(generator));
    let size = turn.iter().map(|own| own * own).sum::<f64>().sqrt();
    if size > 0.0 {
        clump.turn = turn.map(|own| own / size);
    }
    Ok(Fruit {
        radius: 0.5 * length,
        mass,
        clump: Some(clump),
        ..ball
    })
}

/// A standard normal number, by Box and Muller (1958).
pub(crate) fn normal(generator: &mut ChaCha8Rng) -> f64 {
    normal_of_two(generator.random(), generator.random())
}

/// A standard normal number of two that are even over 0 to 1.
pub(crate) fn normal_of_two(a: f64, b: f64) -> f64 {
    (-2.0 * (1.0 - a).ln()).sqrt() * (2.0 * std::f64::consts::PI * b).cos()
}

/// A random place at which a fruit lies wholly inside a box.
fn somewhere(
    low: Vector,
    high: Vector,
    radius: f64,
    generator: &mut ChaCha8Rng,
) -> Result<Vector, Error> {
    let mut place = [0.0; 3];
    for axis in 0..3 {
        let (from, to) = (low[axis] + radius, high[axis] - radius);
        if from > to {
            return Err(Error::Value {
                what: "an edge of the box of a source",
                value: high[axis] - low[axis],
                problem: "a fruit must fit into it",
            });
        }
        place[axis] = from + (to - from) * generator.random::<f64>();
    }
    Ok(place)
}

/// Places of a lattice in a box, from below.
fn lattice(low: Vector, high: Vector, radius: f64, count: usize) -> Result<Vec<Vector>, Error> {
    let pitch = 2.0 * PITCH * radius;
    let number = [0, 1, 2].map(|axis| ((high[axis] - low[axis]) / pitch).floor().max(0.0));
    let room = number[0] * number[1] * number[2];
    if room < count as f64 {
        return Err(Error::Value {
            what: "the number of fruit on a lattice",
            value: count as f64,
            problem: "they do not fit into its box: make the box larger, or pour them",
        });
    }
    let [nx, ny, _] = number.map(|own| own as usize);
    let place = |n: usize| {
        let at = [n % nx, n / nx % ny, n / (nx * ny)];
        [0, 1, 2].map(|axis| low[axis] + pitch * (at[axis] as f64 + 0.5))
    };
    Ok((0..count).map(place).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn kind(count: usize, source: Source) -> FruitKind {
        FruitKind {
            material: 0,
            count,
            radius: 0.04,
            radius_sd: 0.002,
            ovate: None,
            density: 840.0,
            source,
        }
    }

    #[test]
    fn fruit_are_as_the_population_says() {
        let pour = Source::Pour {
            low: [0.0; 3],
            high: [1.0, 1.0, 0.1],
            velocity: [0.0, 0.0, -1.0],
            rate: 50.0,
            from: 1.0,
        };
        let fruit = drawn(&[kind(20_000, pour)], 3).unwrap();
        let n = fruit.len() as f64;
        let mean = fruit.iter().map(|own| own.radius).sum::<f64>() / n;
        let square = fruit
            .iter()
            .map(|own| (own.radius - mean).powi(2))
            .sum::<f64>()
            / n;
        // Five standard errors; cutting at three deviations takes 1.3 % off the spread.
        assert!((mean - 0.04).abs() < 5.0 * 0.002 / n.sqrt(), "{mean}");
        assert!(
            (square.sqrt() / 0.002 / 0.9866 - 1.0).abs() < 0.025,
            "{square}"
        );
        assert_eq!(fruit[50].time, 2.0);
        assert!(
            fruit
                .iter()
                .all(|own| own.place[2] >= own.radius && own.place[2] <= 0.1 - own.radius)
        );
        // Kinds do not disturb each other.
        let both = drawn(&[kind(20_000, pour), kind(10, pour)], 3).unwrap();
        assert_eq!(both[..20_000], fruit[..]);
        assert_ne!(both[20_000].draws, fruit[0].draws);
    }

    #[test]
    fn ovate_fruit_point_anywhere() {
        let drop = Source::Drop {
            place: [0.0; 3],
            velocity: [0.0; 3],
            interval: 1.0,
            from: 0.0,
        };
        let ovate = Ovate {
            ratio: 1.5,
            spheres: 7,
        };
        let kind = FruitKind {
            ovate: Some(ovate),
            ..kind(20_000, drop)
        };
        let fruit = drawn(&[kind], 3).unwrap();
        let axes = fruit.iter().map(|own| {
            let clump = own.clump.as_ref().unwrap();
            crate::vector::turned(clump.turn, [1.0, 0.0, 0.0])
        });
        let axes: Vec<Vector> = axes.collect();
        // Cosines of a direction anywhere are even over -1 to 1: mean 0, square 1/3; five
        // standard errors.
        for axis in 0..3 {
            let mean = axes.iter().map(|own| own[axis]).sum::<f64>() / 20_000.0;
            let square = axes.iter().map(|own| own[axis].powi(2)).sum::<f64>() / 20_000.0;
            assert!(mean.abs() < 5.0 * (1.0 / 60_000.0_f64).sqrt(), "{mean}");
            let error = (4.0 / 45.0 / 20_000.0_f64).sqrt();
            assert!((square - 1.0 / 3.0).abs() < 5.0 * error, "{square}");
        }
        let first = &fruit[0];
        let [a, b, c] = first.clump.as_ref().unwrap().semi_axes(first.mass);
        assert!((a - first.radius).abs() < 1e-12 && (a / b - 1.5).abs() < 1e-12);
        assert!((b - c).abs() < 1e-12);
        let mass = 840.0 * 4.0 / 3.0 * std::f64::consts::PI * a * b * c;
        assert!((first.mass / mass - 1.0).abs() < 1e-12);
    }

    #[test]
    fn rejects_boxes_without_room() {
        let lattice = Source::Lattice {
            low: [0.0; 3],
            high: [0.5; 3],
            velocity: [0.0; 3],
        };
        assert_eq!(drawn(&[kind(125, lattice)], 1).unwrap().len(), 125);
        assert!(drawn(&[kind(217, lattice)], 1).is_err());
        let tree = Source::Tree {
            low: [0.0; 3],
            high: [0.5, 0.5, 0.05],
            over: 1.0,
        };
        assert!(drawn(&[kind(1, tree)], 1).is_err());
    }
}
