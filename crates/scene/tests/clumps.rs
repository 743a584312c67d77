//! Fruit that are clumps of spheres: how they turn, and how they are struck.
#![allow(clippy::unwrap_used)]

use crate::common;

use common::{ball, floor, law, plane, scene};
use windfall_scene::event::Event;
use windfall_scene::interaction::{Interaction, mindlin_ratio};
use windfall_scene::motion::simulation::{FruitState, Simulation};
use windfall_scene::scene::{Fruit, Sink};
use windfall_scene::shape::clump::Clump;
use windfall_scene::vector::{Vector, length, subtract, turn_about, turned};

const LAW: &str = "kuwabara-kono(k=753599, c=1524)";
const LENGTH: f64 = 0.1;
const DIAMETER: f64 = 0.06;
const MASS: f64 = 0.2;

/// An ovate fruit at rest.
fn ovate(place: Vector, count: usize) -> Fruit {
    let mut fruit = ball(0.5 * LENGTH, MASS, place, [0.0; 3]);
    fruit.clump = Clump::spheroid(LENGTH, DIAMETER, MASS, count);
    fruit
}

fn rough() -> Interaction {
    Interaction {
        friction: 0.4,
        tangential_ratio: mindlin_ratio(0.3),
        tangential_damping: 1.0,
        annuli: 4,
        rolling: 0.02,
        ..Interaction::frictionless(law(LAW))
    }
}

/// A clump that spins freely for a second.
fn free(step: f64) -> FruitState {
    let mut scene = scene(Interaction::frictionless(law(LAW)), step);
    let mut fruit = ovate([0.0; 3], 5);
    fruit.spin = [20.0, 10.0, 0.0];
    scene.fruit.push(fruit);
    let mut simulation = Simulation::new(scene).unwrap();
    for _ in 0..(1.0 / step).round() as usize {
        simulation.step().unwrap();
    }
    simulation.fruit()[0]
}

#[test]
fn closed_form_a_free_symmetric_top() {
    // Its axis goes round the angular momentum with L/I (Landau and Lifshitz, Mechanics, § 33).
    let across = MASS * (LENGTH * LENGTH + DIAMETER * DIAMETER) / 20.0;
    let momentum = [0.1 * MASS * DIAMETER * DIAMETER * 20.0, across * 10.0, 0.0];
    let size = length(momentum);
    let axis = turned(
        turn_about(momentum.map(|own| own / size), size / across),
        [1.0, 0.0, 0.0],
    );
    let error = |step| {
        let own = free(step);
        length(subtract(turned(own.turn, [1.0, 0.0, 0.0]), axis))
    };
    let (coarse, fine) = (error(1e-3), error(5e-4));
    assert!(fine < 2e-4, "{fine}");
    assert!((coarse / fine - 4.0).abs() < 0.1, "{coarse} {fine}");
}

/// The first contact of a fruit that falls on a floor, touching at first with `speed`.
fn struck(fruit: Fruit, speed: f64, step: f64) -> Event {
    let mut scene = scene(Interaction::frictionless(law(LAW)), step);
    scene.walls.push(floor());
    let mut fruit = fruit;
    fruit.velocity = [0.0, 0.0, -speed];
    scene.fruit.push(fruit);
    let mut simulation = Simulation::new(scene).unwrap();
    while simulation.time() < 0.05 {
        simulation.step().unwrap();
        if let Some(&event) = simulation.take_events().first() {
            return event;
        }
    }
    panic!("no contact ended");
}

#[test]
fn independent_a_clump_of_one_sphere_is_a_sphere() {
    let mut fruit = ovate([0.0, 0.0, 0.031], 5);
    let moment = 0.4 * MASS * 0.03 * 0.03;
    fruit.clump = Some(Clump {
        spheres: vec![([0.0; 3], 0.03)],
        moments: [moment; 3],
        turn: turn_about([0.0, 1.0, 0.0], 0.7),
        spheroid: None,
    });
    let run = |mut fruit: Fruit| {
        let mut scene = scene(rough(), 1e-5);
        scene.gravity = [0.0, 0.0, -9.81];
        scene.walls.push(floor());
        fruit.velocity = [0.3, 0.1, -0.5];
        fruit.spin = [5.0, -20.0, 3.0];
        scene.fruit.push(fruit);
        let mut simulation = Simulation::new(scene).unwrap();
        for _ in 0..20_000 {
            simulation.step().unwrap();
        }
        (simulation.fruit()[0], simulation.take_events())
    };
    let (own, events) = run(fruit.clone());
    let (other, others) = run(Fruit {
        clump: None,
        radius: 0.03,
        ..fruit
    });
    assert!(length(subtract(own.place, other.place)) < 1e-9);
    assert!(
        length(subtract(own.spin, other.spin)) < 1e-6,
        "{own:?} {other:?}"
    );
    assert_eq!(events.len(), others.len());
    assert!((events[0].peak_force / others[0].peak_force - 1.0).abs() < 1e-9);
    assert!((events[0].friction_energy / others[0].friction_energy - 1.0).abs() < 1e-6);
}

#[test]
fn closed_form_a_tip_is_struck_with_the_mass_that_it_feels() {
    // Lying at 30 degrees, it falls on its lower tip: 1/m* = 1/m + x²/I.
    let angle = std::f64::consts::FRAC_PI_6;
    let turn = turn_about([0.0, 1.0, 0.0], angle);
    let mut fruit = ovate([0.0; 3], 9);
    fruit.clump.as_mut().unwrap().turn = turn;
    // The lowest point of the spheroid is (a² − b²) sin cos/h to the side, h below the centre.
    let (sine, cosine) = angle.sin_cos();
    let (a, b) = (0.5 * LENGTH, 0.5 * DIAMETER);
    let low = (a * sine).hypot(b * cosine);
    let arm = (a * a - b * b) * sine * cosine / low;
    let radius = b * b / low;
    fruit.place = [0.0, 0.0, low + 1e-6];
    let moment = MASS * (LENGTH * LENGTH + DIAMETER * DIAMETER) / 20.0;
    let felt = 1.0 / (1.0 / MASS + arm * arm / moment);
    // Over all angles the arm is largest where it is a − b.
    let arms = (0..1800).map(|own| (f64::from(own) * 5e-4 * std::f64::consts::PI).sin_cos());
    let arms = arms.map(|(s, c)| (a * a - b * b) * s * c / (a * s).hypot(b * c));
    let arm = arms.fold(0.0, f64::max);
    let least = 1.0 / (1.0 / MASS + arm * arm / moment);
    assert!((fruit.least_felt_mass() / least - 1.0).abs() < 1e-6);
    assert!(least < felt);
    let own = struck(fruit, 0.5, 1e-6);
    let other = struck(
        ball(radius, felt, [0.0, 0.0, radius + 1e-6], [0.0; 3]),
        0.5,
        1e-6,
    );
    // The arm changes while it is struck: by less than a degree.
    for (found, wanted) in [
        (own.peak_force, other.peak_force),
        (own.largest_displacement, other.largest_displacement),
        (own.duration, other.duration),
        (own.absorbed_energy, other.absorbed_energy),
    ] {
        assert!((found / wanted - 1.0).abs() < 0.02, "{found} {wanted}");
    }
    assert_eq!(own.fruit, 0);
    // The spot is the direction from the fruit's centre to where the spheroid has this tangent,
    // (a² n_x, b² n_z).
    let (n_x, n_z) = (angle.sin(), angle.cos());
    let wanted = [LENGTH.powi(2) * n_x, 0.0, -DIAMETER.powi(2) * n_z];
    let wanted = wanted.map(|own| own / length(wanted));
    assert!(length(subtract(own.spot, wanted)) < 1e-4, "{:?}", own.spot);
}

#[test]
fn closed_form_an_ovate_fruit_rebounds_as_its_spheroid_does() {
    // Hard and elastic, without friction: an impulse along the normal, whose effect is
    // 1/m* = 1/m + x²/I about the axis across.
    let moment = MASS * (LENGTH * LENGTH + DIAMETER * DIAMETER) / 20.0;
    let (a, b) = (0.5 * LENGTH, 0.5 * DIAMETER);
    for spheres in [3, 9] {
        for degrees in [3.0, 20.0, 40.0, 60.0, 80.0_f64] {
            let (sine, cosine) = degrees.to_radians().sin_cos();
            let low = (a * sine).hypot(b * cosine);
            let arm = (a * a - b * b) * sine * cosine / low;
            let felt = 1.0 / (1.0 / MASS + arm * arm / moment);
            let wanted = -1.5 + 3.0 * felt / MASS;
            let mut scene = scene(Interaction::frictionless(law("hertz(k=1e11)")), 1e-7);
            scene.walls.push(floor());
            let mut fruit = ovate([0.0, 0.0, low + 1e-5], spheres);
            fruit.velocity = [0.0, 0.0, -1.5];
            fruit.clump.as_mut().unwrap().turn = turn_about([0.0, 1.0, 0.0], degrees.to_radians());
            scene.fruit.push(fruit);
            let mut simulation = Simulation::new(scene).unwrap();
            while simulation.take_events().is_empty() {
                simulation.step().unwrap();
            }
            let found = simulation.fruit()[0].velocity[2];
            assert!(
                (found - wanted).abs() < 0.001 * 1.5,
                "{spheres} {degrees}: {found} {wanted}"
            );
        }
    }
}

#[test]
fn ovate_fruit_that_fly_about_keep_their_energy() {
    let mut scene = scene(Interaction::frictionless(law("hertz(k=753599)")), 4e-5);
    for (point, normal) in [
        ([0.0; 3], [1.0, 0.0, 0.0]),
        ([0.0; 3], [0.0, 1.0, 0.0]),
        ([0.0; 3], [0.0, 0.0, 1.0]),
        ([0.4; 3], [-1.0, 0.0, 0.0]),
        ([0.4; 3], [0.0, -1.0, 0.0]),
        ([0.4; 3], [0.0, 0.0, -1.0]),
    ] {
        scene.walls.push(plane("side", point, normal));
    }
    for number in 0..18 {
        let [i, j, k] = [number % 3, number / 3 % 3, number / 9].map(f64::from);
        let place = [0.075 + 0.125 * i, 0.075 + 0.125 * j, 0.1 + 0.2 * k];
        let mut fruit = ovate(place, 5);
        if number % 4 == 3 {
            fruit = ball(0.035, MASS, place, [0.0; 3]);
        } else {
            let axis = [0.6, 0.0, 0.8];
            fruit.clump.as_mut().unwrap().turn = turn_about(axis, i + 2.0 * j - k);
        }
        fruit.velocity = [1.5 - j, i - 1.0, 1.0 - 2.0 * k];
        fruit.spin = [4.0 * k, 5.0 - i, 3.0 * j];
        scene.fruit.push(fruit);
    }
    let mut simulation = Simulation::new(scene).unwrap();
    let first = simulation.step_with_energy().unwrap();
    let mut contacts = 0;
    while simulation.time() < 2.0 {
        simulation.step().unwrap();
        contacts += simulation.take_events().len();
    }
    let last = simulation.step_with_energy().unwrap();
    let moving =
        |own: &windfall_scene::energy::Energy| own.kinetic + own.rotational + own.in_contacts;
    let drift = moving(&last) / moving(&first) - 1.0;
    assert!(contacts > 300, "{contacts}");
    assert!(drift.abs() < 2e-4, "{drift}");
    let closure = (last.closure() - first.closure()) / moving(&first);
    assert!(closure.abs() < 2e-4, "{closure}");
}

#[test]
fn ovate_fruit_come_to_rest_on_their_sides_and_keep_their_energy() {
    let mut scene = scene(rough(), 2e-5);
    scene.gravity = [0.0, 0.0, -9.81];
    scene.walls.push(floor());
    for number in 0..12 {
        let (i, j) = (f64::from(number % 3), f64::from(number / 3));
        let mut fruit = ovate([0.06 * i, 0.06 * j, 0.08 + 0.11 * (i + j)], 7);
        let axis = [0.6, 0.8, 0.0];
        fruit.clump.as_mut().unwrap().turn = turn_about(axis, 0.5 + i + 2.0 * j);
        fruit.spin = [i, -j, 1.0];
        scene.fruit.push(fruit);
    }
    // The middle sphere lies in balance until the next one touches, at sin α = Δr/Δx.
    let spheres = scene.fruit[0].clump.as_ref().unwrap().spheres.clone();
    let middle = spheres.iter().map(|own| own.1).fold(0.0, f64::max);
    let others = spheres.iter().filter(|own| own.1 < middle);
    let neutral = others.map(|(offset, radius)| (middle - radius) / length(*offset));
    let neutral = neutral.fold(1.0, f64::min);
    let mut simulation = Simulation::new(scene).unwrap();
    let first = simulation.step_with_energy().unwrap();
    while simulation.time() < 12.0 {
        simulation.step().unwrap();
    }
    let last = simulation.step_with_energy().unwrap();
    let closure = (last.closure() - first.closure()) / last.lost();
    assert!(closure.abs() < 1e-3, "{closure}");
    assert_eq!(simulation.count(), 12);
    for own in simulation.fruit() {
        // On a floor without walls all of them lie, on their sides.
        assert!((own.place[2] - 0.5 * DIAMETER).abs() < 2e-3, "{own:?}");
        let tilt = turned(own.turn, [1.0, 0.0, 0.0])[2].abs();
        assert!(tilt < neutral + 0.01, "{neutral} {own:?}");
        // Nothing resists turning about the vertical.
        assert!(length([own.spin[0], own.spin[1], 0.0]) < 0.01, "{own:?}");
    }
}

#[test]
fn a_clump_leaves_whole() {
    let mut scene = scene(rough(), 2e-5);
    scene.gravity = [0.0, 0.0, -9.81];
    scene.fruit = (0..4)
        .map(|number| ovate([0.2 * f64::from(number), 0.0, 0.0], 5))
        .collect();
    scene.fruit[2] = ball(0.03, MASS, [0.4, 0.0, 0.0], [0.0; 3]);
    scene.sinks.push(Sink {
        name: "left".to_owned(),
        low: [-0.1, -1.0, -1.0],
        high: [0.3, 1.0, -0.1],
    });
    let mut simulation = Simulation::new(scene).unwrap();
    while simulation.time() < 0.25 {
        simulation.step().unwrap();
    }
    let gone: Vec<u32> = simulation
        .take_leavings()
        .iter()
        .map(|own| own.fruit)
        .collect();
    assert_eq!(gone, [0, 1]);
    let left: Vec<u32> = simulation.fruit().iter().map(|own| own.fruit).collect();
    assert_eq!(left, [2, 3]);
    assert_eq!(simulation.count(), 2);
}
