//! A run that is stopped and taken up has the bits of one that never was.
#![allow(clippy::unwrap_used)]

use crate::common;

use common::{FRUIT, STEEL, ball, floor, law, plane};
use std::collections::BTreeMap;
use windfall_scene::binary::Binary;
use windfall_scene::energy::Energy;
use windfall_scene::event::Event;
use windfall_scene::interaction::{Interaction, Spread, mindlin_ratio};
use windfall_scene::motion::simulation::{FruitState, Leaving, Simulation};
use windfall_scene::scene::{Scene, Sink};
use windfall_scene::shape::motion::{Axis, How, Motion};
use windfall_scene::shape::surface::Shape;
use windfall_scene::shape::wall::Wall;
use windfall_scene::state::State;

/// Numbers as good as random, the same everywhere; -0.5 to 0.5.
fn random(seed: &mut u64) -> f64 {
    *seed = seed
        .wrapping_mul(6364136223846793005)
        .wrapping_add(1442695040888963407);
    (*seed >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
}

/// Two materials of fruit, one of them with a spread, poured on a shaking floor between
/// walls; a paddle turns among them, a tube stands there, and some roll into a sink.
///
/// * `moves`: whether the walls move
fn scene(moves: bool) -> Scene {
    let interaction = |text: &str, spread: bool, annuli: usize| Interaction {
        effective_radius: Some(0.01875),
        friction: 0.4,
        tangential_ratio: mindlin_ratio(0.3),
        tangential_damping: 1.0,
        annuli,
        rolling: 0.02,
        spread: spread.then(|| Spread {
            logarithm: vec![true, true],
            factor: vec![vec![0.1, 0.0], vec![0.05, 0.1]],
        }),
        ..Interaction::frictionless(law(text))
    };
    let apple = "kuwabara-kono(k=753599, c=1524)";
    let pear = FRUIT + 2;
    let interactions = BTreeMap::from([
        ((FRUIT, FRUIT), interaction(apple, true, 4)),
        ((FRUIT, STEEL), interaction(apple, true, 3)),
        (
            (FRUIT, pear),
            interaction("kelvin-voigt(k=30000, c=20)", false, 1),
        ),
        (
            (pear, pear),
            interaction("tsuji(k=600000, restitution=0.5, mass=0.1)", false, 8),
        ),
        (
            (STEEL, pear),
            interaction("walton-braun(k1=20000, k2=30000)", false, 2),
        ),
    ]);
    let mut scene = Scene {
        materials: vec!["apple".to_owned(), "steel".to_owned(), "pear".to_owned()],
        interactions,
        gravity: [0.0, 0.0, -9.81],
        time_step: 5e-5,
        ..Scene::default()
    };
    let mut shaken = floor();
    shaken.motion = Motion::always([How::Vibration {
        amplitude: [0.001, 0.0, 0.002],
        frequency: 15.0,
    }]);
    scene.walls = vec![
        shaken,
        plane("left", [0.0; 3], [1.0, 0.0, 0.0]),
        plane("right", [0.8, 0.0, 0.0], [-1.0, 0.0, 0.0]),
        plane("front", [0.0; 3], [0.0, 1.0, 0.0]),
        Wall {
            name: "tube".to_owned(),
            material: STEEL,
            shape: Shape::Cylinder {
                start: [0.2, 0.3, 0.0],
                end: [0.2, 0.3, 0.4],
                radius: 0.04,
            },
            motion: Motion::default(),
        },
        Wall {
            name: "paddle".to_owned(),
            material: STEEL,
            shape: Shape::Mesh {
                triangles: vec![
                    [[0.3, 0.4, 0.02], [0.5, 0.4, 0.02], [0.5, 0.4, 0.15]],
                    [[0.3, 0.4, 0.02], [0.5, 0.4, 0.15], [0.3, 0.4, 0.15]],
                ],
            },
            motion: Motion::always([How::Rotation {
                about: Axis {
                    point: [0.4, 0.4, 0.0],
                    direction: [0.0, 0.0, 1.0],
                },
                angular_velocity: 4.0,
            }]),
        },
    ];
    if !moves {
        for wall in &mut scene.walls {
            wall.motion = Motion::default();
        }
    }
    scene.sinks = vec![Sink {
        name: "outlet".to_owned(),
        low: [0.0, 0.75, 0.0],
        high: [0.8, 2.0, 1.0],
    }];
    let mut seed = 7;
    for number in 0..700 {
        let place = [0.4, 0.4, 0.4].map(|middle| middle + 0.7 * random(&mut seed));
        let mut own = ball(
            0.0375 + 0.01 * random(&mut seed),
            0.18,
            place,
            [0.0, 0.3, -1.0],
        );
        own.material = if number % 3 == 0 { pear } else { FRUIT };
        own.place[2] = 0.55 + 0.1 * random(&mut seed);
        own.draws[0] = 2.0 * random(&mut seed);
        own.draws[1] = 2.0 * random(&mut seed);
        own.time = 0.0015 * number as f64;
        own.elsewhere = Some([[0.05, 0.05, 0.5], [0.75, 0.7, 0.6]]);
        scene.fruit.push(own);
    }
    scene.fruit[0].time = 0.0;
    scene
}

const STEPS: u64 = 16_000;
const EVERY: u64 = 2_000;

/// Steps after which what happened is taken.
const TAKEN: u64 = 37;

/// What a run gives: its end, and what happened.
type Found = (Vec<FruitState>, Vec<Event>, Vec<Leaving>, Energy, u64);

/// Goes on to a step, with checkpoints; the last of them as bytes, and what happened since.
fn go_on(
    simulation: &mut Simulation,
    to: u64,
    events: &mut (Vec<Event>, Vec<Leaving>),
    mut at_checkpoint: impl FnMut(Vec<u8>, &(Vec<Event>, Vec<Leaving>)),
) {
    while simulation.steps() < to {
        let steps = simulation.steps();
        let left = (to - steps).min(EVERY - steps % EVERY);
        simulation.run(left.min(TAKEN)).unwrap();
        events.0.extend(simulation.take_events());
        events.1.extend(simulation.take_leavings());
        if simulation.steps().is_multiple_of(EVERY) {
            let mut bytes = Vec::new();
            simulation.checkpoint().write(&mut bytes).unwrap();
            at_checkpoint(bytes, events);
        }
    }
}

fn found(mut simulation: Simulation, (mut events, leavings): (Vec<Event>, Vec<Leaving>)) -> Found {
    let energy = simulation.step_with_energy().unwrap();
    events.extend(simulation.lasting());
    let rebuilds = simulation.rebuilds();
    (simulation.fruit(), events, leavings, energy, rebuilds)
}

fn on_threads<T: Send>(threads: usize, work: impl FnOnce() -> T + Send) -> T {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    pool.unwrap().install(work)
}

#[test]
fn a_run_that_is_taken_up_again_has_the_same_bits() {
    for moves in [true, false] {
        check_taken_up(|| scene(moves));
    }
}

fn check_taken_up(scene: impl Fn() -> Scene + Sync) {
    let whole = on_threads(1, || {
        let mut simulation = Simulation::new(scene()).unwrap();
        let mut happened = Default::default();
        go_on(&mut simulation, STEPS, &mut happened, |_, _| ());
        found(simulation, happened)
    });
    assert!(whole.1.len() > 3000, "{} events", whole.1.len());
    assert!(whole.2.len() > 10, "{} left", whole.2.len());
    assert!(whole.1.iter().any(|event| event.lasting));

    // Stopped off a checkpoint again and again, each time taken up on other threads.
    let mut kept = (Vec::new(), (Vec::new(), Vec::new()));
    for (number, stop) in [700, 2_001, 5_333, 9_999, 13_000, STEPS]
        .into_iter()
        .enumerate()
    {
        kept = on_threads(1 + number % 2, || {
            let mut simulation = match kept.0.is_empty() {
                true => Simulation::new(scene()).unwrap(),
                false => {
                    let state = State::read(&mut &kept.0[..]).unwrap();
                    Simulation::resume(scene(), &state).unwrap()
                }
            };
            let (mut last, mut happened) = kept.clone();
            let mut then = happened.clone();
            go_on(&mut simulation, stop, &mut happened, |bytes, events| {
                (last, then) = (bytes, events.clone());
            });
            if stop == STEPS {
                let same = found(simulation, happened) == whole;
                assert!(same, "other bits");
            }
            (last, then)
        });
    }
}

#[test]
fn rejects_a_state_of_another_scene() {
    let mut simulation = Simulation::new(scene(true)).unwrap();
    let mut happened = Default::default();
    go_on(&mut simulation, 9000, &mut happened, |_, _| ());
    let mut bytes = Vec::new();
    simulation.checkpoint().write(&mut bytes).unwrap();
    let state = State::read(&mut &bytes[..]).unwrap();
    // What was read is what was written.
    let mut again = Vec::new();
    state.write(&mut again).unwrap();
    assert_eq!(again, bytes);
    let mut fewer = scene(true);
    fewer.fruit.truncate(10);
    let mut bare = scene(true);
    bare.walls.truncate(0);
    for other in [fewer, bare] {
        let problem = Simulation::resume(other, &state).err().unwrap().to_string();
        assert!(problem.contains("state of this scene"), "{problem}");
    }
    // Bytes that end early.
    bytes.pop();
    assert!(State::read(&mut &bytes[..]).is_err());
}
