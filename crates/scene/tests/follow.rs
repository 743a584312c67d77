//! A scene that follows another's frames.
#![allow(clippy::unwrap_used)]

use std::collections::BTreeMap;
use windfall_contact::expression::parse_law;
use windfall_scene::event::Event;
use windfall_scene::follow::Followed;
use windfall_scene::interaction::{Interaction, mindlin_ratio};
use windfall_scene::motion::simulation::{FruitState, Simulation};
use windfall_scene::scene::{Fruit, Scene, Sink};
use windfall_scene::shape::motion::Motion;
use windfall_scene::shape::surface::Shape;
use windfall_scene::shape::wall::Wall;
use windfall_scene::vector::plus_scaled;

/// Two apples that collide above a floor and fall on it, and one that comes later.
pub(crate) fn scene(time_step: f64) -> Scene {
    let law = parse_law("kuwabara-kono(k=753599, c=1524)").unwrap();
    let contact = Interaction {
        friction: 0.3,
        tangential_ratio: mindlin_ratio(0.3),
        tangential_damping: 1.0,
        rolling: 0.01,
        ..Interaction::frictionless(law.complete().unwrap())
    };
    let mut fruit = vec![
        Fruit::sphere(0, 0.037, 840.0, [0.0, 0.0, 0.1]),
        Fruit::sphere(0, 0.040, 840.0, [0.08, 0.01, 0.11]),
        Fruit::sphere(0, 0.035, 840.0, [0.3, 0.0, 0.2]),
    ];
    fruit[0].velocity = [0.5, 0.0, 0.0];
    fruit[2].time = 0.1;
    Scene {
        materials: vec!["apple".into(), "steel".into()],
        interactions: BTreeMap::from([((0, 0), contact.clone()), ((0, 1), contact)]),
        walls: vec![Wall {
            name: "floor".into(),
            material: 1,
            shape: Shape::Plane {
                point: [0.0; 3],
                normal: [0.0, 0.0, 1.0],
            },
            motion: Motion::default(),
        }],
        fruit,
        sinks: vec![Sink {
            name: "end".into(),
            low: [0.4, -1.0, 0.0],
            high: [0.6, 1.0, 0.2],
        }],
        gravity: [0.0, 0.0, -9.81],
        time_step,
        ..Scene::default()
    }
}

/// Where fruit are, with velocities at the same time: the mean of half a step before and
/// after.
fn frames(every: u64, steps: u64) -> (Vec<Vec<FruitState>>, Vec<Event>) {
    let mut own = Simulation::new(scene(1e-5)).unwrap();
    let mut frames = Vec::new();
    let mut events = Vec::new();
    for step in 0..steps {
        let before = own.fruit();
        own.step().unwrap();
        events.extend(own.take_events());
        if step % every == 0 {
            let after = own.fruit();
            let at = before.iter().filter_map(|own| {
                let next = after.iter().find(|next| next.fruit == own.fruit)?;
                let mean = |a: [f64; 3], b: [f64; 3]| plus_scaled(a.map(|own| 0.5 * own), b, 0.5);
                Some(FruitState {
                    velocity: mean(own.velocity, next.velocity),
                    spin: mean(own.spin, next.spin),
                    ..*own
                })
            });
            frames.push(at.collect());
        }
    }
    events.extend(own.lasting());
    (frames, events)
}

#[test]
fn conserves_what_the_frames_show() {
    const EVERY: u64 = 5;
    let (frames, expected) = frames(EVERY, 60_000);
    let mut follower = Simulation::new(scene(1e-5 * EVERY as f64)).unwrap();
    let mut followed = Followed::default();
    let mut events = Vec::new();
    let mut leavings = Vec::new();
    let mut energies = Vec::new();
    for frame in &frames {
        energies.push(follower.follow(frame, &mut followed).unwrap());
        events.extend(follower.take_events());
        leavings.extend(follower.take_leavings());
    }
    events.extend(follower.lasting());
    let hard = |events: &[Event]| {
        let mut hard: Vec<Event> = events.to_vec();
        hard.retain(|own| own.peak_force > 1.0);
        hard.sort_by(|a, b| a.time.total_cmp(&b.time));
        hard
    };
    let (found, expected) = (hard(&events), hard(&expected));
    assert_eq!(found.len(), expected.len());
    assert!(found.len() > 5, "{}", found.len());
    for (found, expected) in found.iter().zip(&expected) {
        assert_eq!(
            (found.fruit, found.partner),
            (expected.fruit, expected.partner)
        );
        let near = |name: &str, found: f64, expected: f64, part: f64, least: f64| {
            let apart = (found - expected).abs();
            assert!(
                apart <= part * expected.abs() + least,
                "{name} {found} {expected}"
            );
        };
        assert_eq!(
            (found.number, found.resting),
            (expected.number, expected.resting)
        );
        // Later loads begin where a force is seen to rise, or to have come to rest: within
        // the 64 steps between looks.
        if found.number > 1 {
            near("time", found.time, expected.time, 0.0, 64.0 * 5e-5);
            near("peak", found.peak_force, expected.peak_force, 0.003, 0.0);
            continue;
        }
        near("time", found.time, expected.time, 0.0, 2e-5);
        near("peak", found.peak_force, expected.peak_force, 0.003, 0.0);
        near(
            "speed",
            found.normal_speed,
            expected.normal_speed,
            0.01,
            0.0,
        );
        near(
            "depth",
            found.largest_displacement,
            expected.largest_displacement,
            0.002,
            0.0,
        );
        near(
            "absorbed",
            found.absorbed_energy,
            expected.absorbed_energy,
            0.01,
            1e-6,
        );
        near(
            "friction",
            found.friction_energy,
            expected.friction_energy,
            0.03,
            2e-5,
        );
        for axis in 0..3 {
            near("spot", found.spot[axis], expected.spot[axis], 0.0, 0.01);
        }
    }
    let (first, last) = (&energies[0], energies.last().unwrap());
    let closure = (last.closure() - first.closure()) / last.lost();
    assert!(closure.abs() < 5e-3, "{closure}");
}

#[test]
fn rejects_frames_of_another_scene() {
    let mut follower = Simulation::new(scene(1e-4)).unwrap();
    let state = follower.fruit()[0];
    let other = FruitState { fruit: 7, ..state };
    let problem = follower
        .follow(&[other], &mut Followed::default())
        .unwrap_err();
    assert!(problem.to_string().contains('8'), "{problem}");
    // A fruit that is gone without a sink was lost.
    let mut scene = scene(1e-4);
    scene.sinks.clear();
    let mut follower = Simulation::new(scene).unwrap();
    let mut followed = Followed::default();
    let all = follower.fruit();
    follower.follow(&all, &mut followed).unwrap();
    let problem = follower.follow(&all[..1], &mut followed).unwrap_err();
    assert!(problem.to_string().contains("lost"), "{problem}");
}
