//! Small scenes for tests.
#![allow(dead_code)]

use std::collections::BTreeMap;
use windfall_contact::expression::parse_law;
use windfall_contact::laws::kind::Law;
use windfall_scene::interaction::Interaction;
use windfall_scene::scene::{Fruit, Scene};
use windfall_scene::shape::motion::Motion;
use windfall_scene::shape::surface::Shape;
use windfall_scene::shape::wall::Wall;
use windfall_scene::vector::Vector;

/// Numbers of the materials.
pub const FRUIT: usize = 0;
pub const STEEL: usize = 1;

pub fn law(text: &str) -> Law {
    parse_law(text).unwrap().complete().unwrap()
}

/// Fruit of one material and walls of another; one interaction for all.
pub fn scene(interaction: Interaction, time_step: f64) -> Scene {
    Scene {
        materials: vec!["fruit".to_owned(), "steel".to_owned()],
        interactions: BTreeMap::from([
            ((FRUIT, FRUIT), interaction.clone()),
            ((FRUIT, STEEL), interaction),
        ]),
        time_step,
        ..Scene::default()
    }
}

pub fn floor() -> Wall {
    plane("floor", [0.0; 3], [0.0, 0.0, 1.0])
}

pub fn plane(name: &str, point: Vector, normal: Vector) -> Wall {
    Wall {
        name: name.to_owned(),
        material: STEEL,
        shape: Shape::Plane { point, normal },
        motion: Motion::default(),
    }
}

pub fn ball(radius: f64, mass: f64, place: Vector, velocity: Vector) -> Fruit {
    Fruit {
        mass,
        velocity,
        ..Fruit::sphere(FRUIT, radius, 1.0, place)
    }
}
