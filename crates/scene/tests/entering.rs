//! Fruit that come in while the scene runs, and wait where there is no room.
#![allow(clippy::unwrap_used)]

use crate::common;

use common::{ball, floor, law, plane, scene};
use windfall_scene::binary::Binary as _;
use windfall_scene::interaction::Interaction;
use windfall_scene::motion::simulation::Simulation;
use windfall_scene::scene::{Fruit, Scene};
use windfall_scene::shape::motion::{Axis, How, Motion, Move, When};
use windfall_scene::shape::surface::Shape;
use windfall_scene::shape::wall::Wall;
use windfall_scene::state::State;

/// A floor, and balls that come to places on it at times.
fn balls(all: &[([f64; 3], f64)]) -> Scene {
    let apple = Interaction::frictionless(law("kuwabara-kono(k=753599, c=1524)"));
    let mut scene = scene(apple, 1e-4);
    scene.gravity = [0.0, 0.0, -9.81];
    scene.walls.push(floor());
    scene.fruit = all
        .iter()
        .map(|&(place, time)| Fruit {
            time,
            ..ball(0.04, 0.2, place, [0.0; 3])
        })
        .collect();
    scene
}

fn numbers(simulation: &Simulation) -> Vec<u32> {
    simulation.fruit().iter().map(|own| own.fruit).collect()
}

#[test]
fn a_fruit_without_room_holds_up_only_its_own_place() {
    // The second and third are to come where the first lies; the fourth beside it.
    let here = [0.0, 0.0, 0.04];
    let scene = balls(&[
        (here, 0.0),
        (here, 0.01),
        (here, 0.02),
        ([0.3, 0.0, 0.1], 0.03),
    ]);
    let mut simulation = Simulation::new(scene).unwrap();
    simulation.run(250).unwrap();
    assert_eq!(numbers(&simulation), [0]);
    // One that is not yet due does not wait.
    assert_eq!(simulation.waiting(), 2);
    simulation.run(100).unwrap();
    assert_eq!(numbers(&simulation), [0, 3]);
    assert_eq!(simulation.waiting(), 2);
}

#[test]
fn fruit_that_wait_are_taken_up_again() {
    let here = [0.0, 0.0, 0.04];
    // The first rolls away, and makes room for one after the other.
    let scene = || {
        let mut scene = balls(&[
            (here, 0.0),
            (here, 0.01),
            (here, 0.01),
            ([0.0, 0.5, 0.1], 0.02),
        ]);
        for fruit in &mut scene.fruit {
            fruit.velocity = [1.0, 0.0, 0.0];
        }
        scene
    };
    let mut whole = Simulation::new(scene()).unwrap();
    let mut first = Simulation::new(scene()).unwrap();
    whole.run(300).unwrap();
    first.run(300).unwrap();
    assert_eq!(first.waiting(), 2);
    let mut bytes = Vec::new();
    first.checkpoint().write(&mut bytes).unwrap();
    let state = State::read(&mut &bytes[..]).unwrap();
    let mut second = Simulation::resume(scene(), &state).unwrap();
    whole.run(2000).unwrap();
    second.run(2000).unwrap();
    assert_eq!(numbers(&second), [0, 1, 2, 3]);
    assert_eq!(whole.fruit(), second.fruit());
}

#[test]
fn a_fruit_waits_for_a_wall_that_has_moved_to_its_place() {
    let mut scene = balls(&[([0.0, 0.0, 0.1], 0.2)]);
    // A gate that is at x = 0 from 0.1 s to 0.3 s.
    let shift = |from: f64, velocity: f64| Move {
        when: When {
            from,
            until: from + 0.1,
            ramp: 0.0,
        },
        how: How::Velocity([velocity, 0.0, 0.0]),
    };
    scene.walls.push(Wall {
        motion: Motion {
            moves: vec![shift(0.0, 1.0), shift(0.3, -1.0)],
        },
        ..plane("gate", [-0.1, 0.0, 0.0], [1.0, 0.0, 0.0])
    });
    let mut simulation = Simulation::new(scene).unwrap();
    simulation.run(2900).unwrap();
    assert_eq!((numbers(&simulation), simulation.waiting()), (vec![], 1));
    simulation.run(1000).unwrap();
    assert_eq!((numbers(&simulation), simulation.waiting()), (vec![0], 0));
}

#[test]
fn closed_form_a_roller_is_as_fast_as_its_surface() {
    // Whatever point of its axis is named.
    for along in [0.0, 3.0, -40.0] {
        let roller = Wall {
            shape: Shape::Cylinder {
                start: [0.0, -0.5, 0.2],
                end: [0.0, 0.5, 0.2],
                radius: 0.05,
            },
            motion: Motion::always([How::Rotation {
                about: Axis {
                    point: [0.0, along, 0.2],
                    direction: [0.0, 1.0, 0.0],
                },
                angular_velocity: 10.0,
            }]),
            ..floor()
        };
        let speed = roller.largest_speed([0.0, 1.0]);
        assert!((speed - 0.5).abs() < 1e-12, "{speed}");
    }
}
