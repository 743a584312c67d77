//! A bin that is filled with apples: particle-steps per second of processor time.
//!
//!     cargo run --release -p windfall-scene --example bin_fill -- INITIAL STEPS THREADS ANNULI [STATE]
//!
//! INITIAL: `# width` and a number, then `id x y z vx vy vz radius` in each line (SI), see
//! `bench/scene_bin.py`. ANNULI: of a contact area, for friction. STATE: a file from which
//! the run goes on if it is there, and that holds the state afterwards.

#![allow(clippy::print_stdout)]

use std::collections::BTreeMap;
use std::io::Write as _;
use windfall_contact::expression::parse_law;
use windfall_scene::binary::Binary as _;
use windfall_scene::error::Error;
use windfall_scene::interaction::{Interaction, mindlin_ratio};
use windfall_scene::motion::simulation::Simulation;
use windfall_scene::scene::{Fruit, Scene};
use windfall_scene::shape::motion::Motion;
use windfall_scene::shape::surface::Shape;
use windfall_scene::shape::wall::Wall;
use windfall_scene::state::State;

/// Steps after which contacts that ended are taken.
const TAKEN: u64 = 200;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let arguments: Vec<String> = std::env::args().collect();
    let [_, initial, steps, threads, annuli, state @ ..] = &arguments[..] else {
        return Err("bin_fill INITIAL STEPS THREADS ANNULI [STATE]".into());
    };
    rayon::ThreadPoolBuilder::new()
        .num_threads(threads.parse()?)
        .build_global()?;
    let steps: u64 = steps.parse()?;
    let annuli: usize = annuli.parse()?;
    let law = parse_law("kuwabara-kono(k=753599, c=1524)")?.complete()?;
    let contact = |effective_radius| Interaction {
        effective_radius: Some(effective_radius),
        friction: 0.3,
        annuli,
        tangential_ratio: mindlin_ratio(0.3),
        tangential_damping: 1.0,
        ..Interaction::frictionless(law)
    };
    let mut scene = Scene {
        materials: vec!["apple".into(), "bin".into()],
        interactions: BTreeMap::from([((0, 0), contact(0.01875)), ((0, 1), contact(0.0375))]),
        gravity: [0.0, 0.0, -9.81],
        time_step: 2e-5,
        ..Scene::default()
    };
    let mut width = 0.0;
    for line in std::fs::read_to_string(initial)?.lines() {
        if let Some(own) = line.strip_prefix("# width ") {
            width = own.parse()?;
            continue;
        }
        let n: Result<Vec<f64>, _> = line.split_whitespace().map(str::parse).collect();
        let [_, x, y, z, u, v, w, radius] = n?[..] else {
            return Err(format!("not eight numbers: {line}").into());
        };
        let mut fruit = Fruit::sphere(0, radius, 840.0, [x, y, z]);
        fruit.velocity = [u, v, w];
        scene.fruit.push(fruit);
    }
    let count = scene.fruit.len();
    for (point, normal) in [
        ([0.0; 3], [0.0, 0.0, 1.0]),
        ([0.0; 3], [1.0, 0.0, 0.0]),
        ([0.0; 3], [0.0, 1.0, 0.0]),
        ([width, 0.0, 0.0], [-1.0, 0.0, 0.0]),
        ([0.0, width, 0.0], [0.0, -1.0, 0.0]),
    ] {
        scene.walls.push(Wall {
            name: "bin".into(),
            material: 1,
            shape: Shape::Plane { point, normal },
            motion: Motion::default(),
        });
    }
    let mut simulation = match state.first().map(std::fs::File::open) {
        Some(Ok(file)) => {
            let state = State::read(&mut std::io::BufReader::new(file))?;
            Simulation::resume(scene, &state)?
        }
        _ => Simulation::new(scene)?,
    };
    // As a run does: by one of those who work.
    rayon::scope(|_| fill(&mut simulation, steps))?;
    if let Some(path) = state.first() {
        let mut to = std::io::BufWriter::new(std::fs::File::create(path)?);
        simulation.checkpoint().write(&mut to)?;
        to.flush()?;
    }
    let height: f64 = simulation.fruit().iter().map(|own| own.place[2]).sum();
    println!("FINAL mean height {:.4} m", height / count as f64);
    Ok(())
}

fn fill(simulation: &mut Simulation, steps: u64) -> Result<(), Error> {
    let count = simulation.scene.fruit.len();
    let mut events = 0;
    for part in 0..10 {
        let (wall, used) = (std::time::Instant::now(), processor_time());
        let mut left = steps / 10;
        while left > 0 {
            let now = left.min(TAKEN);
            simulation.run(now)?;
            events += simulation.take_events().len();
            left -= now;
        }
        let work = count as f64 * (steps / 10) as f64;
        let spent = processor_time() - used;
        println!(
            "{part} contacts/fruit {:.3} events {events} rebuilds {} M particle-steps: {:.2} per cpu s, {:.2} per s",
            2.0 * simulation.pair_contacts() as f64 / count as f64,
            simulation.rebuilds(),
            1e-6 * work / spent,
            1e-6 * work / wall.elapsed().as_secs_f64(),
        );
    }
    Ok(())
}

/// Of this process; s.
fn processor_time() -> f64 {
    let now = rustix::time::clock_gettime(rustix::time::ClockId::ProcessCPUTime);
    now.tv_sec as f64 + 1e-9 * now.tv_nsec as f64
}
