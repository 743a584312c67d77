//! Fruit of an engine in classes of size, each with coefficients of its own.

use crate::law::PairNumbers;
use std::collections::BTreeMap;
use windfall_scene::scene::Scene;

/// A class of fruit of one material and nearly one size.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Class {
    /// Material, by its number.
    pub material: usize,
    /// Radius that its coefficients are for; m.
    pub radius: f64,
    /// Mass that its coefficients are for; kg.
    pub mass: f64,
}

impl Class {
    /// R* and effective mass of a contact with another; m, kg.
    pub(crate) fn effective(&self, other: &Self) -> (f64, f64) {
        (
            self.radius * other.radius / (self.radius + other.radius),
            self.mass * other.mass / (self.mass + other.mass),
        )
    }
}

/// All classes of a scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Classes {
    pub classes: Vec<Class>,
    /// The class of each fruit, by number.
    pub of_fruit: Vec<usize>,
    /// Largest relative error of a damping coefficient that the classes make; 1.
    pub damping_error: f64,
    /// The same of a stiffness; 1. Only laws that do not follow the radii have any.
    pub stiffness_error: f64,
}

/// Error of damping coefficients that classes are chosen for; 1.
const WANTED: f64 = 0.02;
/// Default limit of the classes of one material.
#[cfg(any(test, feature = "clap"))]
pub const MOST: usize = 12;

/// Sorts the fruit of a scene into classes: equal steps of the logarithm of the mass, as
/// many as keep damping coefficients within 2 %. A class stands for the geometric means of
/// its lightest and heaviest fruit.
///
/// * `most`: classes of one material at most
pub fn classes_of(scene: &Scene, most: usize) -> Classes {
    let mut found = Classes {
        classes: Vec::new(),
        of_fruit: vec![0; scene.fruit.len()],
        damping_error: 0.0,
        stiffness_error: 0.0,
    };
    let mut materials: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for (number, fruit) in scene.fruit.iter().enumerate() {
        materials.entry(fruit.material).or_default().push(number);
    }
    for (material, own) in materials {
        let touching = scene.interactions.iter();
        let touching = touching.filter(|((a, b), _)| *a == material || *b == material);
        let (mut by_size, mut by_radius) = (false, false);
        for (_, interaction) in touching {
            by_size |= PairNumbers::by_size(interaction);
            by_radius |= !interaction.follows_radii();
        }
        let masses = own.iter().map(|&fruit| scene.fruit[fruit].mass);
        let (low, high) = masses.fold((f64::INFINITY, 0.0_f64), |(low, high), mass| {
            (low.min(mass), high.max(mass))
        });
        let range = (high / low).ln();
        let needed = (range / (2.0 * WANTED.ln_1p())).ceil();
        let count = match by_size {
            true => (needed as usize).clamp(1, most.max(1)),
            false => 1,
        };
        let mut members: Vec<Vec<usize>> = vec![Vec::new(); count];
        for fruit in own {
            let share = (scene.fruit[fruit].mass / low).ln() / range.max(f64::MIN_POSITIVE);
            let place = (share * count as f64) as usize;
            members[place.min(count - 1)].push(fruit);
        }
        for members in members.iter().filter(|members| !members.is_empty()) {
            found.add(scene, material, members, (by_size, by_radius));
        }
    }
    found
}

impl Classes {
    fn add(
        &mut self,
        scene: &Scene,
        material: usize,
        members: &[usize],
        (by_size, by_radius): (bool, bool),
    ) {
        // The geometric mean of the smallest and the largest; and how far they are from it.
        let middle = |of: &dyn Fn(usize) -> f64| {
            let values = members.iter().map(|&fruit| of(fruit));
            let (low, high) = values.fold((f64::INFINITY, 0.0_f64), |(low, high), own| {
                (low.min(own), high.max(own))
            });
            match low == high {
                true => (low, 0.0),
                false => ((low * high).sqrt(), (high / low).sqrt() - 1.0),
            }
        };
        let (mass, off) = middle(&|fruit| scene.fruit[fruit].mass);
        let (radius, wide) = middle(&|fruit| scene.fruit[fruit].radius);
        if by_size {
            self.damping_error = self.damping_error.max(off);
        }
        if by_size && by_radius {
            self.stiffness_error = self.stiffness_error.max((1.0 + wide).sqrt() - 1.0);
        }
        for &fruit in members {
            self.of_fruit[fruit] = self.classes.len();
        }
        self.classes.push(Class {
            material,
            radius,
            mass,
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use windfall_contact::expression::parse_law;
    use windfall_scene::interaction::Interaction;
    use windfall_scene::scene::Fruit;

    fn scene(law: &str) -> Scene {
        let law = parse_law(law).unwrap().complete().unwrap();
        let mut interaction = Interaction::frictionless(law);
        interaction.effective_radius = Some(0.02);
        let fruit = |n: usize| Fruit::sphere(0, 0.035 + 1e-4 * n as f64, 840.0, [0.0; 3]);
        Scene {
            materials: vec!["apple".into()],
            interactions: BTreeMap::from([((0, 0), interaction)]),
            fruit: (0..=50).map(fruit).collect(),
            ..Scene::default()
        }
    }

    #[test]
    fn classes_are_as_near_as_they_say() {
        let scene = scene("kuwabara-kono(k=753599, c=1524)");
        for most in [1, 4, 64] {
            let found = classes_of(&scene, most);
            assert!(found.classes.len() <= most);
            let worst = scene
                .fruit
                .iter()
                .zip(&found.of_fruit)
                .map(|(own, &class)| {
                    let ratio = own.mass / found.classes[class].mass;
                    ratio.max(1.0 / ratio) - 1.0
                });
            let worst = worst.fold(0.0, f64::max);
            assert!((worst - found.damping_error).abs() < 1e-12, "{worst}");
            assert_eq!(found.stiffness_error, 0.0);
        }
        // Masses differ by a half; eleven classes keep within the 2 %.
        assert!(classes_of(&scene, MOST).damping_error <= WANTED);
        assert_eq!(classes_of(&scene, 64).classes.len(), 11);
    }

    #[test]
    fn laws_without_sizes_need_one_class() {
        for law in ["kelvin-voigt(k=6000, c=25)", "hertz(k=753599)"] {
            let found = classes_of(&scene(law), MOST);
            assert_eq!((found.classes.len(), found.damping_error), (1, 0.0));
        }
    }
}
