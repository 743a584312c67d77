//! How errors go with the time step: of single impacts, and of the energy of a bin.
#![allow(clippy::unwrap_used, clippy::print_stdout)]

use crate::common;

use common::{STEEL, ball, floor, law, scene};
use windfall_scene::energy::Energy;
use windfall_scene::interaction::{Interaction, mindlin_ratio};
use windfall_scene::motion::simulation::Simulation;
use windfall_scene::scene::Scene;
use windfall_scene::shape::motion::{Axis, How, Motion};
use windfall_scene::shape::surface::{Plate, Shape};
use windfall_scene::shape::wall::Wall;

/// Slope of the logarithms of errors over those of steps, by least squares.
fn order(points: &[(f64, f64)]) -> f64 {
    let logs: Vec<(f64, f64)> = points.iter().map(|own| (own.0.ln(), own.1.ln())).collect();
    let count = logs.len() as f64;
    let mean_x = logs.iter().map(|own| own.0).sum::<f64>() / count;
    let mean_y = logs.iter().map(|own| own.1).sum::<f64>() / count;
    let above: f64 = logs
        .iter()
        .map(|own| (own.0 - mean_x) * (own.1 - mean_y))
        .sum();
    above / logs.iter().map(|own| (own.0 - mean_x).powi(2)).sum::<f64>()
}

/// Peak force and restitution of an apple of 0.2 kg at 0.5 m/s that touches a floor after
/// so much of a step.
fn impact(expression: &str, step: f64, share: f64) -> (f64, f64) {
    let apple = Interaction::frictionless(law(expression));
    let mut scene = scene(apple, step);
    scene.walls.push(floor());
    let height = 0.04 + share * 0.5 * step;
    scene
        .fruit
        .push(ball(0.04, 0.2, [0.0, 0.0, height], [0.0, 0.0, -0.5]));
    let mut simulation = Simulation::new(scene).unwrap();
    loop {
        simulation.step().unwrap();
        if let Some(event) = simulation.take_events().first() {
            let lost = event.absorbed_energy / (0.5 * 0.2 * 0.25);
            return (event.peak_force, (1.0 - lost).sqrt());
        }
    }
}

/// Order of the errors of two results of an impact, whenever in a step they touch: of the root
/// of the mean square over that.
///
/// * `impact`: the results with a time step, s, that touches after so much of it
fn orders_of(
    name: &str,
    impact: impl Fn(f64, f64) -> (f64, f64),
    [first, second]: [f64; 2],
) -> [f64; 2] {
    let mut points = [Vec::new(), Vec::new()];
    for step in [2e-4, 1e-4, 5e-5, 2.5e-5, 1.25e-5] {
        let mut squares = [0.0; 2];
        for number in 0..16 {
            let found = impact(step, (f64::from(number) + 0.5) / 16.0);
            squares[0] += (found.0 / first - 1.0).powi(2) / 16.0;
            squares[1] += (found.1 / second - 1.0).powi(2) / 16.0;
        }
        println!(
            "{name}, {step} s: {:e}, {:e}",
            squares[0].sqrt(),
            squares[1].sqrt()
        );
        for (points, square) in points.iter_mut().zip(squares) {
            points.push((step, square.sqrt()));
        }
    }
    let found = points.map(|own| order(&own));
    println!("{name}: orders {found:?}");
    found
}

/// [`orders_of`] peak force and restitution of [`impact`].
fn orders(expression: &str, wanted: [f64; 2]) -> [f64; 2] {
    orders_of(
        expression,
        |step, share| impact(expression, step, share),
        wanted,
    )
}

/// Peak force and absorbed energy of the first contact of a scene.
fn first_contact(scene: Scene) -> (f64, f64) {
    let mut simulation = Simulation::new(scene).unwrap();
    loop {
        simulation.step().unwrap();
        if let Some(event) = simulation.take_events().first() {
            return (event.peak_force, event.absorbed_energy);
        }
    }
}

/// Two apples of 0.2 kg that touch after so much of a step, the one across the other.
fn oblique(expression: &str, [across, towards]: [f64; 2], step: f64, share: f64) -> (f64, f64) {
    let mut scene = scene(Interaction::frictionless(law(expression)), step);
    let before = share * step;
    let place = [-across * before, 0.0, 0.08 + towards * before];
    scene.fruit = vec![
        ball(0.04, 0.2, [0.0; 3], [0.0; 3]),
        ball(0.04, 0.2, place, [across, 0.0, -towards]),
    ];
    first_contact(scene)
}

/// An apple of 0.2 kg that falls at 1 m/s onto a paddle, 0.3 m from its axis, that comes up at
/// 60 rad/s and lies level as they touch.
fn paddle(expression: &str, step: f64, share: f64) -> (f64, f64) {
    let mut scene = scene(Interaction::frictionless(law(expression)), step);
    let (before, speed) = (share * step, 60.0);
    let (s, c) = (-speed * before).sin_cos();
    scene.walls.push(Wall {
        shape: Shape::Plates(vec![Plate {
            corner: [0.0, -0.5, 0.0],
            edges: [[c, 0.0, s], [0.0, 1.0, 0.0]],
        }]),
        motion: Motion::always([How::Rotation {
            about: Axis {
                point: [0.0; 3],
                direction: [0.0, -1.0, 0.0],
            },
            angular_velocity: speed,
        }]),
        ..floor()
    });
    let place = [0.3, 0.0, 0.04 + before];
    scene.fruit = vec![ball(0.04, 0.2, place, [0.0, 0.0, -1.0])];
    first_contact(scene)
}

#[test]
fn converges_oblique_impacts_and_those_of_a_paddle() {
    // SciPy's DOP853 at 1e-11 of the plane motion of two centres, and of one centre beside a
    // line that turns.
    let law = "kuwabara-kono(k=753599, c=1524)";
    let way = |own: [f64; 2]| move |step, share| oblique(law, own, step, share);
    let grazing = orders_of(
        "grazing",
        way([3.0, 0.3]),
        [5.768_654_065, 1.224_445_911e-3],
    );
    assert!(grazing.iter().all(|own| *own > 1.6), "{grazing:?}");
    let slanting = orders_of(
        "slanting",
        way([1.0, 1.0]),
        [49.304_094_903, 0.042_469_007_25],
    );
    assert!(slanting.iter().all(|own| *own > 1.75), "{slanting:?}");
    // A force that sets in at once.
    let law = "kelvin-voigt(k=40000, c=40)";
    let sudden = |step, share| oblique(law, [3.0, 0.3], step, share);
    let sudden = orders_of("sudden", sudden, [12.359_541_204, 2.124_103_294e-3]);
    assert!(sudden.iter().all(|own| *own > 1.75), "{sudden:?}");
    let law = "kuwabara-kono(k=753599, c=1524)";
    let struck = |step, share| paddle(law, step, share);
    let struck = orders_of("paddle", struck, [2_779.210_280_032, 33.652_032_942_216]);
    assert!(struck.iter().all(|own| *own > 1.75), "{struck:?}");
}

#[test]
fn converges_single_impacts_as_fast_as_their_force_is_smooth() {
    // Elastic: k d^2.5/2.5 = m v²/2. The force begins smoothly enough for second order.
    let depth = (1.25 * 0.2 * 0.25 / 753_599.0_f64).powf(0.4);
    let hertz = orders("hertz(k=753599)", [753_599.0 * depth.powf(1.5), 1.0]);
    assert!(hertz[0] > 1.8, "{hertz:?}");
    // Kuwabara and Kono's damping begins as √d. The accurate equation by SciPy's DOP853 at
    // 1e-11, see single_impacts.rs.
    let own = orders(
        "kuwabara-kono(k=753599, c=1524)",
        [32.866_208_632, 0.478_143_129_09],
    );
    assert!(own[0] > 1.75 && own[1] > 1.75, "{own:?}");
}

/// 252 fruit of 70 to 80 mm with friction, on a loose lattice in a bin.
fn bin(step: f64) -> Scene {
    let apple = Interaction {
        effective_radius: Some(0.01875),
        friction: 0.3,
        tangential_ratio: mindlin_ratio(0.3),
        tangential_damping: 1.0,
        annuli: 4,
        rolling: 0.01,
        ..Interaction::frictionless(law("kuwabara-kono(k=753599, c=1524)"))
    };
    let mut scene = scene(apple, step);
    scene.gravity = [0.0, 0.0, -9.81];
    let (wide, high) = (6.0 * 0.084, 1.2);
    let (x, y, z) = ([wide, 0.0, 0.0], [0.0, wide, 0.0], [0.0, 0.0, high]);
    let sides = [
        ([0.0; 3], x, y),
        ([0.0; 3], y, z),
        (x, y, z),
        ([0.0; 3], x, z),
        (y, x, z),
    ];
    let plates = sides.map(|(corner, a, b)| Plate {
        corner,
        edges: [a, b],
    });
    scene.walls.push(Wall {
        name: "bin".to_owned(),
        material: STEEL,
        shape: Shape::Plates(plates.to_vec()),
        motion: Motion::default(),
    });
    let mut seed = 7_u64;
    let mut random = || {
        seed = seed
            .wrapping_mul(6364136223846793005)
            .wrapping_add(1442695040888963407);
        (seed >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
    };
    for number in 0..252 {
        let at = [number % 6, number / 6 % 6, number / 36];
        let place = at.map(|own| (f64::from(own) + 0.5) * 0.084 + 0.002 * random());
        let radius = 0.0375 + 0.005 * random();
        let mut own = ball(radius, 0.0, place, [0.2 * random(), 0.2 * random(), -0.5]);
        own.mass = 840.0 * 4.0 / 3.0 * std::f64::consts::PI * radius.powi(3);
        scene.fruit.push(own);
    }
    scene
}

#[test]
fn conserves_the_energy_of_elastic_fruit_that_fly_about() {
    // In a closed box without gravity and friction, so that they collide at any angle.
    let drift = |step: f64| {
        let mut scene = bin(step);
        scene.gravity = [0.0; 3];
        let hertz = Interaction::frictionless(law("hertz(k=753599)"));
        scene
            .interactions
            .values_mut()
            .for_each(|own| *own = hertz.clone());
        let (wide, high) = (6.0 * 0.084, 1.2);
        if let Shape::Plates(plates) = &mut scene.walls[0].shape {
            plates.push(Plate {
                corner: [0.0, 0.0, high],
                edges: [[wide, 0.0, 0.0], [0.0, wide, 0.0]],
            });
        }
        for (number, own) in scene.fruit.iter_mut().enumerate() {
            let sign = if number % 2 == 0 { 1.0 } else { -1.0 };
            own.velocity = [1.1 * sign, 0.7, -0.4 * sign];
        }
        let mut simulation = Simulation::new(scene).unwrap();
        let first = simulation.step_with_energy().unwrap();
        while simulation.time() < 1.5 {
            simulation.step().unwrap();
        }
        let last = simulation.step_with_energy().unwrap();
        let events = simulation.take_events().len();
        assert!(events > 4000, "{events}");
        let moving = |own: &Energy| own.kinetic + own.rotational + own.in_contacts;
        let begun = moving(&first);
        (
            moving(&last) / begun - 1.0,
            last.lost_in_contacts / begun,
            begun,
        )
    };
    let coarse = drift(8e-5);
    let fine = drift(2e-5);
    println!("{coarse:?} {fine:?}");
    assert!(coarse.0.abs() < 2e-4 && coarse.1.abs() < 2e-4, "{coarse:?}");
    assert!(fine.0.abs() < 1e-4 && fine.1.abs() < 1e-4, "{fine:?}");
}

/// What the account of a second of the bin lacks at worst, over what was lost.
fn closure(step: f64) -> f64 {
    let mut simulation = Simulation::new(bin(step)).unwrap();
    let first = simulation.step_with_energy().unwrap();
    let (mut worst, mut lost) = (0.0_f64, 0.0);
    while simulation.time() < 1.0 {
        for _ in 0..50 {
            simulation.step().unwrap();
        }
        let own = simulation.step_with_energy().unwrap();
        worst = worst.max((own.closure() - first.closure()).abs());
        lost = own.lost();
    }
    assert!(lost > 20.0, "{lost}");
    worst / lost
}

#[test]
fn converges_the_energy_account_of_a_bin_with_friction() {
    let steps = [2e-4, 1e-4, 5e-5, 2.5e-5];
    let points = steps.map(|step| (step, closure(step)));
    println!("{points:?}: order {}", order(&points));
    // Below a ten thousandth at every step.
    assert!(points[0].1 < 1e-4 && points[1].1 < 3e-5, "{points:?}");
    assert!(points[3].1 < 4e-6 && order(&points) > 1.6, "{points:?}");
}
