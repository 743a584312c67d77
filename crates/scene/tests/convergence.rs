//! How errors go with the time step: of single impacts, and of the energy of a bin.
#![allow(clippy::unwrap_used, clippy::print_stdout)]

use crate::common;

use common::{STEEL, ball, floor, law, scene};
use windfall_scene::interaction::{Interaction, mindlin_ratio};
use windfall_scene::motion::simulation::Simulation;
use windfall_scene::scene::Scene;
use windfall_scene::shape::surface::{Plate, Shape};
use windfall_scene::shape::wall::{Motion, Wall};

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

/// Order of the errors of peak force and restitution, whenever in a step they touch: of the
/// root of the mean square over that.
fn orders(expression: &str, [peak, restitution]: [f64; 2]) -> [f64; 2] {
    let mut points = [Vec::new(), Vec::new()];
    for step in [2e-4, 1e-4, 5e-5, 2.5e-5, 1.25e-5] {
        let mut squares = [0.0; 2];
        for number in 0..16 {
            let found = impact(expression, step, (f64::from(number) + 0.5) / 16.0);
            squares[0] += (found.0 / peak - 1.0).powi(2) / 16.0;
            squares[1] += (found.1 / restitution - 1.0).powi(2) / 16.0;
        }
        println!(
            "{expression}, {step} s: {:e}, {:e}",
            squares[0].sqrt(),
            squares[1].sqrt()
        );
        for (points, square) in points.iter_mut().zip(squares) {
            points.push((step, square.sqrt()));
        }
    }
    let found = points.map(|own| order(&own));
    println!("{expression}: orders {found:?}");
    found
}

#[test]
fn converges_single_impacts_as_fast_as_their_force_is_smooth() {
    // Elastic: k d^2.5/2.5 = m v²/2. The force begins smoothly enough for second order.
    let depth = (1.25 * 0.2 * 0.25 / 753_599.0_f64).powf(0.4);
    let hertz = orders("hertz(k=753599)", [753_599.0 * depth.powf(1.5), 1.0]);
    assert!(hertz[0] > 1.8, "{hertz:?}");
    // Kuwabara and Kono's damping begins as √d: what is missed in the step of first touch
    // goes as its 3/2nd power. The accurate equation by SciPy's DOP853 at 1e-11, see
    // single_impacts.rs.
    let own = orders(
        "kuwabara-kono(k=753599, c=1524)",
        [32.866_208_632, 0.478_143_129_09],
    );
    assert!(own[0] > 1.5 && own[1] > 1.5, "{own:?}");
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
    // Below a thousandth at every step; what friction takes is added up to first order.
    assert!(points[0].1 < 1.2e-3 && points[1].1 < 6e-4, "{points:?}");
    assert!(points[3].1 < 2e-4 && order(&points) > 0.9, "{points:?}");
}
