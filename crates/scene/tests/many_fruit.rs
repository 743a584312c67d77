//! Many fruit in a bin: energy, threads, lists of neighbours.
#![allow(clippy::unwrap_used)]

use crate::common;

use common::{STEEL, law, scene};
use windfall_scene::event::{Event, Partner};
use windfall_scene::interaction::{Interaction, mindlin_ratio};
use windfall_scene::motion::simulation::{FruitState, Simulation};
use windfall_scene::scene::{Fruit, Scene};
use windfall_scene::shape::motion::Motion;
use windfall_scene::shape::surface::{Plate, Shape};
use windfall_scene::shape::wall::Wall;

fn apples() -> Interaction {
    Interaction {
        effective_radius: Some(0.01875),
        friction: 0.3,
        tangential_ratio: mindlin_ratio(0.3),
        tangential_damping: 1.0,
        annuli: 4,
        rolling: 0.01,
        ..Interaction::frictionless(law("kuwabara-kono(k=753599, c=1524)"))
    }
}

/// Fruit of 35 to 40 mm on a loose lattice above a bin.
fn bin(side: usize, layers: usize, step: f64) -> Scene {
    let mut scene = scene(apples(), step);
    scene.gravity = [0.0, 0.0, -9.81];
    let pitch = 0.084;
    let width = side as f64 * pitch;
    let height = 2.0 * layers as f64 * pitch;
    let plate = |corner, edges| Plate { corner, edges };
    let (x, y, z) = ([width, 0.0, 0.0], [0.0, width, 0.0], [0.0, 0.0, height]);
    let sides = [
        plate([0.0; 3], [x, y]),
        plate([0.0; 3], [y, z]),
        plate(x, [y, z]),
        plate([0.0; 3], [x, z]),
        plate(y, [x, z]),
    ];
    scene.walls.push(Wall {
        name: "bin".to_owned(),
        material: STEEL,
        shape: Shape::Plates(sides.to_vec()),
        motion: Motion::default(),
    });
    // Numbers as good as random, the same everywhere.
    let mut seed = 1_u64;
    let mut random = || {
        seed = seed
            .wrapping_mul(6364136223846793005)
            .wrapping_add(1442695040888963407);
        (seed >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
    };
    for number in 0..side * side * layers {
        let (row, layer) = (number / side % side, number / (side * side));
        let mut place = [number % side, row, layer].map(|own| (own as f64 + 0.5) * pitch);
        place.iter_mut().for_each(|own| *own += 0.002 * random());
        let mut own = Fruit::sphere(0, 0.0375 + 0.005 * random(), 840.0, place);
        own.velocity = [0.2 * random(), 0.2 * random(), -0.5];
        scene.fruit.push(own);
    }
    scene
}

/// Where fruit are in the end, and every contact.
type Found = (Vec<FruitState>, Vec<Event>);

fn run(scene: Scene, steps: u64, threads: usize) -> Found {
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .build()
        .unwrap();
    pool.install(|| {
        let mut simulation = Simulation::new(scene).unwrap();
        simulation.run(steps).unwrap();
        let mut events = simulation.take_events();
        events.extend(simulation.lasting());
        (simulation.fruit(), events)
    })
}

#[test]
fn the_bits_do_not_depend_on_the_number_of_threads() {
    let one = run(bin(12, 8, 5e-5), 6000, 1);
    assert!(one.1.len() > 2000, "{}", one.1.len());
    for threads in [2, 3] {
        assert!(one == run(bin(12, 8, 5e-5), 6000, threads));
    }
}

#[test]
fn stops_where_a_body_is_thrown_across_its_radius() {
    // Fruit at rest that overlap a little under a law so stiff that they fly apart in a step.
    let mut scene = scene(Interaction::frictionless(law("hertz(k=2.5e13)")), 2e-5);
    for x in [0.0, 0.0749] {
        scene
            .fruit
            .push(Fruit::sphere(0, 0.0375, 840.0, [x, 0.0, 0.0]));
    }
    let mut simulation = Simulation::new(scene).unwrap();
    let problem = simulation.run(100).unwrap_err().to_string();
    assert!(problem.starts_with("at 0.000000 s fruit"), "{problem}");
    assert!(problem.contains("of its radius in one step"), "{problem}");
}

#[test]
fn energy_is_accounted_for() {
    let mut simulation = Simulation::new(bin(5, 6, 2e-5)).unwrap();
    let first = simulation.step_with_energy().unwrap();
    let mut worst = 0.0_f64;
    let mut last = first;
    for step in 0..50_000 {
        if step % 100 == 0 {
            last = simulation.step_with_energy().unwrap();
            worst = worst.max((last.closure() - first.closure()).abs());
        } else {
            simulation.step().unwrap();
        }
    }
    println!("{last:?} lost {} closure {worst:e}", last.lost());
    assert!(last.lost() > 20.0);
    assert!(worst < 2e-4 * last.lost(), "{worst:e} of {}", last.lost());
    // All have come to rest on each other and on the floor.
    assert!(last.kinetic < 1e-3 * last.lost(), "{last:?}");
    let lasting = simulation.lasting();
    let floor = lasting
        .iter()
        .filter(|event| matches!(event.partner, Partner::Wall(_)));
    // What the floor bears is the weight of all.
    assert!(floor.count() > 20);
}
