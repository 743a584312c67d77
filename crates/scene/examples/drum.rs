//! Fruit in a drum that turns, as a cylinder and as a mesh: time of a step.
//!
//!     cargo run --release -p windfall-scene --example drum -- FRUIT TRIANGLES STEPS
//!
//! Every fruit that lies on the side of the drum touches it; the drum is so long that the
//! fruit fill a third of it.

#![allow(clippy::print_stdout)]

use std::collections::BTreeMap;
use std::time::Instant;
use windfall_contact::expression::parse_law;
use windfall_scene::interaction::{Interaction, mindlin_ratio};
use windfall_scene::motion::simulation::Simulation;
use windfall_scene::scene::{Fruit, Scene};
use windfall_scene::shape::motion::{Axis, How, Motion};
use windfall_scene::shape::surface::Shape;
use windfall_scene::shape::wall::Wall;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let arguments: Vec<String> = std::env::args().collect();
    let [_, fruit, triangles, steps] = &arguments[..] else {
        return Err("drum FRUIT TRIANGLES STEPS".into());
    };
    let (fruit, triangles): (usize, usize) = (fruit.parse()?, triangles.parse()?);
    let steps: u64 = steps.parse()?;
    let law = parse_law("kuwabara-kono(k=753599, c=1524)")?.complete()?;
    let contact = Interaction {
        friction: 0.3,
        tangential_ratio: mindlin_ratio(0.3),
        tangential_damping: 1.0,
        ..Interaction::frictionless(law)
    };
    // Layers of 9 × 9 fruit, 84 mm apart, in a drum of 1.2 m.
    let layers = fruit.div_ceil(81);
    let long = 0.084 * layers as f64;
    let motion = Motion::always([How::Rotation {
        about: Axis {
            point: [0.0; 3],
            direction: [1.0, 0.0, 0.0],
        },
        angular_velocity: 1.0,
    }]);
    let wall = |name: &str, shape, motion| Wall {
        name: name.to_owned(),
        material: 1,
        shape,
        motion,
    };
    let around = ((triangles as f64 / 2.0 * 3.8 / long).sqrt() as usize).max(8);
    let along = (triangles / (2 * around)).max(1);
    let at = |i: usize, j: usize| {
        let (s, c) = (std::f64::consts::TAU * i as f64 / around as f64).sin_cos();
        [long * j as f64 / along as f64, 0.6 * s, 0.6 * c]
    };
    let quad = |(i, j): (usize, usize)| {
        let (a, b, c, d) = (at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
        [[a, b, c], [a, c, d]]
    };
    let places = (0..around).flat_map(|i| (0..along).map(move |j| (i, j)));
    let mesh = Shape::Mesh {
        triangles: places.flat_map(quad).collect(),
    };
    let tube = Shape::Cylinder {
        start: [0.0; 3],
        end: [long, 0.0, 0.0],
        radius: 0.6,
    };
    for (name, side) in [("cylinder", tube), ("mesh", mesh)] {
        let end = |x: f64, towards: f64| Shape::Plane {
            point: [x, 0.0, 0.0],
            normal: [towards, 0.0, 0.0],
        };
        let place = |number: usize| {
            let (i, j, k) = (number / 81, number % 9, number / 9 % 9);
            [
                0.084 * (i as f64 + 0.5),
                0.084 * (j as f64 - 4.0),
                0.084 * (k as f64 - 4.0),
            ]
        };
        let scene = Scene {
            materials: vec!["apple".into(), "steel".into()],
            interactions: BTreeMap::from([((0, 0), contact.clone()), ((0, 1), contact.clone())]),
            walls: vec![
                wall("drum", side, motion.clone()),
                wall("left", end(0.0, 1.0), Motion::default()),
                wall("right", end(long, -1.0), Motion::default()),
            ],
            fruit: (0..fruit)
                .map(|number| Fruit::sphere(0, 0.0375, 840.0, place(number)))
                .collect(),
            gravity: [0.0, 0.0, -9.81],
            time_step: 5e-5,
            ..Scene::default()
        };
        let mut simulation = Simulation::new(scene)?;
        simulation.run(steps)?;
        let (start, rebuilds) = (Instant::now(), simulation.rebuilds());
        simulation.run(steps / 5)?;
        println!(
            "{name}: {:.1} µs a step, {} lists in {} steps, {} contacts of fruit and {} in all",
            1e6 * start.elapsed().as_secs_f64() / (steps / 5) as f64,
            simulation.rebuilds() - rebuilds,
            steps / 5,
            simulation.pair_contacts(),
            simulation.lasting().len(),
        );
    }
    Ok(())
}
