//! Loads of contacts that last: blows told apart from rests.
#![allow(clippy::unwrap_used)]

use crate::common;

use common::{STEEL, ball, law, plane, scene};
use windfall_scene::event::{Event, Partner};
use windfall_scene::interaction::{Interaction, mindlin_ratio};
use windfall_scene::motion::simulation::Simulation;
use windfall_scene::scene::Scene;
use windfall_scene::shape::motion::{How, Motion};
use windfall_scene::shape::surface::{Plate, Shape};
use windfall_scene::shape::wall::Wall;

const RADIUS: f64 = 0.0375;
const MASS: f64 = 0.1856;

/// Apples one on the other in a narrow shaft on a floor.
fn column(count: usize, floor: Motion, step: f64) -> Scene {
    let apple = Interaction {
        effective_radius: Some(0.5 * RADIUS),
        friction: 0.3,
        tangential_ratio: mindlin_ratio(0.3),
        tangential_damping: 1.0,
        annuli: 4,
        rolling: 0.01,
        ..Interaction::frictionless(law("kuwabara-kono(k=753599, c=1524)"))
    };
    let mut scene = scene(apple, step);
    scene.gravity = [0.0, 0.0, -9.81];
    scene.walls.push(Wall {
        name: "floor".to_owned(),
        material: STEEL,
        shape: Shape::Plates(vec![Plate {
            corner: [-1.0, -1.0, 0.0],
            edges: [[2.0, 0.0, 0.0], [0.0, 2.0, 0.0]],
        }]),
        motion: floor,
    });
    for (axis, sign) in [(0, 1.0), (0, -1.0), (1, 1.0), (1, -1.0)] {
        let (mut point, mut normal) = ([0.0; 3], [0.0; 3]);
        (point[axis], normal[axis]) = (-0.0385 * sign, sign);
        scene.walls.push(plane("side", point, normal));
    }
    for number in 0..count {
        let side = if number % 2 == 0 { 5e-4 } else { -5e-4 };
        let height = RADIUS * (2.0 * number as f64 + 1.0) + 1e-4;
        scene
            .fruit
            .push(ball(RADIUS, MASS, [side, 0.0, height], [0.0; 3]));
    }
    scene
}

/// All loads up to a time, those that last among them; with the energy account.
fn loads(scene: Scene, end: f64) -> (Vec<Event>, f64) {
    let mut simulation = Simulation::new(scene).unwrap();
    let first = simulation.step_with_energy().unwrap().closure();
    while simulation.time() < end {
        simulation.step().unwrap();
    }
    let last = simulation.step_with_energy().unwrap();
    let mut events = simulation.take_events();
    events.extend(simulation.lasting());
    (events, (last.closure() - first) / last.lost())
}

#[test]
fn a_column_that_is_shaken_for_long_is_not_hit_harder() {
    // 0.4 g at 15 Hz: nothing leaves the floor.
    let rate = std::f64::consts::TAU * 15.0;
    let shaken = Motion::always([How::Vibration {
        amplitude: [0.0, 0.0, 0.4 * 9.81 / (rate * rate)],
        frequency: 15.0,
    }]);
    let (events, closure) = loads(column(5, shaken, 5e-5), 12.0);
    assert!(closure.abs() < 1e-3, "{closure}");
    let most = |from: f64, to: f64| {
        let own = events
            .iter()
            .filter(|own| !own.resting && own.duration < 0.1);
        let own = own.filter(|own| (from..to).contains(&own.time));
        own.map(|own| own.absorbed_energy).fold(0.0, f64::max)
    };
    // Twice as long is not twice as hard.
    let (early, late) = (most(0.0, 4.0), most(4.0, 12.0));
    assert!(early > 1e-3 && late < 1.5 * early, "{early} {late}");
    // All that the floor and the fruit took is in one load or another.
    let lasting = events.iter().filter(|own| own.lasting).count();
    assert!(
        lasting >= 5 && events.len() > 300,
        "{lasting} {}",
        events.len()
    );
}

#[test]
fn a_blow_through_fruit_at_rest_is_a_pulse_of_each_contact() {
    let mut scene = column(4, Motion::default(), 2e-5);
    // A heavy fruit falls on the column when it has come to rest.
    let mut hammer = ball(RADIUS, 3.0 * MASS, [0.0, 0.0, 0.45], [0.0, 0.0, -1.0]);
    hammer.time = 1.5;
    scene.fruit.push(hammer);
    let (events, closure) = loads(scene, 2.5);
    assert!(closure.abs() < 1e-3, "{closure}");
    let of_floor = events.iter().filter(|own| own.partner == Partner::Wall(0));
    let mut of_floor: Vec<&Event> = of_floor.collect();
    of_floor.sort_by(|a, b| a.time.total_cmp(&b.time));
    // The weight of four, then the blow, then the weight of seven, with what rings.
    let rests: Vec<f64> = of_floor
        .iter()
        .filter(|own| own.duration > 0.3)
        .map(|own| own.peak_force / (MASS * 9.81))
        .collect();
    assert_eq!(rests.len(), 2, "{of_floor:#?}");
    assert!((4.0..12.0).contains(&rests[0]), "{rests:?}");
    assert!((7.0..14.0).contains(&rests[1]), "{rests:?}");
    let blow = of_floor.iter().filter(|own| (1.5..1.7).contains(&own.time));
    let blow = blow
        .max_by(|a, b| a.peak_force.total_cmp(&b.peak_force))
        .unwrap();
    assert!(
        blow.number > 1 && !blow.resting && blow.duration < 0.05,
        "{blow:?}"
    );
    // The column hands on the blow: as hard as on top within a factor of two.
    let top = events
        .iter()
        .filter(|own| own.partner == Partner::Fruit(4) && own.number == 1);
    let top = top.map(|own| own.peak_force).fold(0.0, f64::max);
    assert!(
        blow.peak_force > 0.5 * top && blow.peak_force < 2.0 * top,
        "{blow:?} {top}"
    );
    assert!(
        blow.normal_speed > 0.05 && blow.normal_speed < 1.5,
        "{blow:?}"
    );
}

#[test]
fn what_elastic_fruit_give_back_is_not_absorbed() {
    // One on the floor is struck by another before it is gone again.
    let mut scene = scene(Interaction::frictionless(law("hertz(k=1e6)")), 1e-5);
    scene.walls.push(plane("floor", [0.0; 3], [0.0, 0.0, 1.0]));
    scene.fruit = vec![
        ball(RADIUS, MASS, [0.0, 0.0, RADIUS + 1e-4], [0.0, 0.0, -1.0]),
        ball(
            RADIUS,
            MASS,
            [0.0, 0.0, 3.0 * RADIUS + 0.0125],
            [0.0, 0.0, -3.0],
        ),
    ];
    let (events, _) = loads(scene, 0.05);
    let later = events.iter().filter(|own| own.number > 1).count();
    assert!(later > 0, "{events:#?}");
    for own in &events {
        let stored = 0.4 * own.peak_force * own.largest_displacement;
        assert!(
            own.absorbed_energy.abs() < 0.01 * stored,
            "{stored}: {own:#?}"
        );
    }
}
