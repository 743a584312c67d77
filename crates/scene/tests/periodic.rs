//! Scenes that repeat along an axis.
#![allow(clippy::unwrap_used)]

use crate::common;

use common::{STEEL, ball, floor, law, plane, scene};
use windfall_scene::binary::Binary;
use windfall_scene::error::Error;
use windfall_scene::event::Event;
use windfall_scene::interaction::{Interaction, mindlin_ratio};
use windfall_scene::motion::simulation::{FruitState, Simulation};
use windfall_scene::scene::{Fruit, Scene, Sink};
use windfall_scene::shape::clump::Clump;
use windfall_scene::shape::motion::{Axis, How, Motion};
use windfall_scene::shape::surface::{Plate, Shape};
use windfall_scene::shape::wall::Wall;
use windfall_scene::state::State;
use windfall_scene::vector::{Vector, add, length, plus_scaled, subtract};

const GRAVITY: f64 = 9.81;

fn rough() -> Interaction {
    Interaction {
        friction: 0.4,
        tangential_ratio: mindlin_ratio(0.3),
        tangential_damping: 1.0,
        annuli: 4,
        rolling: 0.01,
        ..Interaction::frictionless(law("kuwabara-kono(k=753599, c=1524)"))
    }
}

fn wall(name: &str, shape: Shape) -> Wall {
    Wall {
        name: name.to_owned(),
        material: STEEL,
        shape,
        motion: Motion::default(),
    }
}

/// Numbers as good as random, the same everywhere; 0 to 1.
fn random(seed: &mut u64) -> f64 {
    *seed = seed
        .wrapping_mul(6364136223846793005)
        .wrapping_add(1442695040888963407);
    (*seed >> 11) as f64 / (1_u64 << 53) as f64
}

/// A level floor of triangles from x to x + `long`, in parts.
fn mesh_floor(x: f64, long: f64, parts: usize) -> Shape {
    let at = |i: usize, y: f64| [x + long * i as f64 / parts as f64, y, 0.0];
    let mut triangles = Vec::new();
    for i in 0..parts {
        let (a, b, c, d) = (at(i, -1.0), at(i + 1, -1.0), at(i + 1, 1.0), at(i, 1.0));
        triangles.extend([[a, b, c], [a, c, d]]);
    }
    Shape::Mesh { triangles }
}

const PERIOD: f64 = 0.6;

/// Round and ovate fruit that fall on a floor of triangles that runs, on each other, and
/// against a plate that stands across the way; all of it shifted along x.
fn shifted(by: f64) -> Scene {
    let mut own = scene(rough(), 2e-5);
    own.gravity = [0.0, 0.0, -GRAVITY];
    own.periodic[0] = Some([0.0, PERIOD]);
    let mut belt = wall("belt", mesh_floor(by, PERIOD, 5));
    belt.motion = Motion::always([How::Belt([0.8, 0.0, 0.0])]);
    let plate = Plate {
        corner: [by + 0.25, -0.05, 0.0],
        edges: [[0.0, 0.1, 0.0], [0.0, 0.0, 0.05]],
    };
    own.walls = vec![
        belt,
        wall("plate", Shape::Plates(vec![plate])),
        plane("front", [0.0, -0.16, 0.0], [0.0, 1.0, 0.0]),
        plane("back", [0.0, 0.16, 0.0], [0.0, -1.0, 0.0]),
    ];
    let mut seed = 5;
    for number in 0..24 {
        let at = [number % 6, number / 6 % 2, number / 12].map(|own| own as f64 + 0.5);
        let place = [by + 0.1 * at[0], 0.12 * at[1] - 0.12, 0.1 * at[2] + 0.01];
        let place = place.map(|own| own + 0.01 * random(&mut seed));
        let velocity = [0.8 * random(&mut seed), random(&mut seed) - 0.5, -1.0];
        let mut fruit = ball(0.036 + 0.004 * random(&mut seed), 0.18, place, velocity);
        if number % 3 == 0 {
            fruit.clump = Clump::spheroid(0.09, 0.065, 0.18, 5);
            fruit.radius = 0.045;
        }
        own.fruit.push(fruit);
    }
    own
}

fn finished(scene: Scene, time: f64) -> (Simulation, Vec<Event>) {
    let mut simulation = Simulation::new(scene).unwrap();
    while simulation.time() < time {
        simulation.step().unwrap();
    }
    let mut events = simulation.take_events();
    events.extend(simulation.lasting());
    events.sort_by_key(|own| (own.fruit, own.partner, own.number));
    (simulation, events)
}

/// From one place to the nearest image of another; m.
fn off(scene: &Scene, a: Vector, b: Vector) -> f64 {
    length(subtract(scene.periods().image(a, b), b))
}

#[test]
fn conserves_what_happens_wherever_the_ends_are() {
    let (middle, wanted) = finished(shifted(0.0), 0.12);
    assert!(wanted.len() > 80, "{}", wanted.len());
    // The plate stands on an end in the second.
    for by in [0.171, PERIOD - 0.25, 0.5, -3.29] {
        let (other, found) = finished(shifted(by), 0.12);
        assert_eq!(found.len(), wanted.len(), "{by}");
        for (a, b) in found.iter().zip(&wanted) {
            assert_eq!(
                (a.fruit, a.partner, a.number),
                (b.fruit, b.partner, b.number)
            );
            assert!((a.time - b.time).abs() < 1e-9, "{by}: {a:?} {b:?}");
            for (a, b) in [
                (a.peak_force, b.peak_force),
                (a.absorbed_energy + 1e-3, b.absorbed_energy + 1e-3),
                (a.friction_energy + 1e-3, b.friction_energy + 1e-3),
            ] {
                assert!((a / b - 1.0).abs() < 1e-6, "{by}: {a} {b}");
            }
            let place = add(b.place, [by, 0.0, 0.0]);
            assert!(
                off(&other.scene, place, a.place) < 1e-8,
                "{by}: {a:?} {b:?}"
            );
            assert!((0.0..=PERIOD).contains(&a.place[0]), "{a:?}");
        }
        for (a, b) in other.fruit().iter().zip(middle.fruit()) {
            let place = add(b.place, [by, 0.0, 0.0]);
            assert!(
                off(&other.scene, place, a.place) < 1e-8,
                "{by}: {a:?} {b:?}"
            );
            assert!(length(subtract(a.velocity, b.velocity)) < 1e-6);
            assert!((0.0..=PERIOD).contains(&a.place[0]), "{a:?}");
        }
    }
}

/// Balls that fly about between no walls, in a room that repeats along all axes.
fn gas(lengths: Vector, count: usize, step: f64) -> Scene {
    let mut own = scene(Interaction::frictionless(law("hertz(k=1e6)")), step);
    own.periodic = lengths.map(|length| Some([-0.3 * length, 0.7 * length]));
    let mut seed = 11;
    while own.fruit.len() < count {
        let place = lengths.map(|length| length * (random(&mut seed) - 0.3));
        let velocity = [0; 3].map(|_| 4.0 * random(&mut seed) - 2.0);
        let radius = 0.02 + 0.01 * random(&mut seed);
        let periods = own.periods();
        let apart = |other: &Fruit| {
            let image = periods.image(other.place, place);
            length(subtract(image, place)) > other.radius + radius
        };
        if own.fruit.iter().all(apart) {
            own.fruit
                .push(ball(radius, 4e3 * radius.powi(3), place, velocity));
        }
    }
    own
}

fn momentum(simulation: &Simulation) -> Vector {
    let all = simulation.fruit().into_iter();
    all.fold([0.0; 3], |sum, own| {
        let mass = simulation.scene.fruit[own.fruit as usize].mass;
        plus_scaled(sum, own.velocity, mass)
    })
}

#[test]
fn conserves_momentum_and_energy_of_a_gas() {
    // Two, three and more cells along an axis; one block of bodies and several.
    for (lengths, count) in [
        ([0.19, 0.24, 0.4], 25),
        ([0.2, 0.7, 0.2], 40),
        ([1.2, 1.1, 0.9], 900),
    ] {
        let mut simulation = Simulation::new(gas(lengths, count, 1e-5)).unwrap();
        let before = momentum(&simulation);
        let first = simulation.step_with_energy().unwrap();
        simulation.run(20_000).unwrap();
        let last = simulation.step_with_energy().unwrap();
        let hits = simulation.take_events().len();
        assert!(hits > count, "{hits}");
        let gone = length(subtract(momentum(&simulation), before));
        assert!(gone < 1e-13 * length(before).max(1.0), "{gone}");
        let held = |own: &windfall_scene::energy::Energy| own.kinetic + own.in_contacts;
        let lost = held(&last) + last.lost_in_contacts - held(&first);
        assert!(lost.abs() < 2e-6 * first.kinetic, "{lost} {first:?}");
    }
}

/// Every pair that touches is found once: forces of a lattice that fills a room are zero by
/// symmetry, and each ball has its six neighbours.
#[test]
fn closed_form_a_lattice_that_fills_the_room() {
    for number in [4, 5, 9] {
        let mut own = scene(Interaction::frictionless(law("hertz(k=1e6)")), 1e-5);
        let pitch = 0.0999;
        own.periodic = [Some([0.0, pitch * number as f64]); 3];
        for n in 0..number * number * number {
            let at = [n % number, n / number % number, n / number / number];
            let place = at.map(|own| pitch * own as f64);
            own.fruit.push(ball(0.05, 0.2, place, [0.0; 3]));
        }
        let mut simulation = Simulation::new(own).unwrap();
        simulation.run(200).unwrap();
        assert_eq!(simulation.pair_contacts(), 3 * number * number * number);
        for own in simulation.fruit() {
            assert!(length(own.velocity) < 1e-9, "{own:?}");
        }
    }
}

/// A ball that slides, then rolls, on a running belt of triangles.
fn on_belt(shape: Shape, repeats: bool) -> (Simulation, Vec<Event>, f64) {
    let mut own = scene(rough(), 5e-5);
    own.gravity = [0.0, 0.0, -GRAVITY];
    if repeats {
        own.periodic[0] = Some([-0.1, 0.4]);
    }
    let mut belt = wall("belt", shape);
    belt.motion = Motion::always([How::Belt([1.5, 0.1, 0.0])]);
    own.walls = vec![belt];
    // As deep as it lies.
    own.fruit
        .push(ball(0.04, 0.2, [0.013, 0.021, 0.0399], [3.0, 0.0, 0.0]));
    let mut simulation = Simulation::new(own).unwrap();
    let (mut way, mut last) = (0.0, simulation.fruit()[0].place);
    while simulation.time() < 2.0 {
        simulation.step().unwrap();
        let now = simulation.fruit()[0].place;
        let from = simulation.scene.periods().image(last, now);
        way += now[0] - from[0];
        last = now;
    }
    let mut events = simulation.take_events();
    events.extend(simulation.lasting());
    (simulation, events, way)
}

#[test]
fn conserves_rolling_over_the_seam_of_a_belt() {
    let endless = Shape::Plane {
        point: [0.0; 3],
        normal: [0.0, 0.0, 1.0],
    };
    let (plane, wanted, way) = on_belt(endless, false);
    // It passes the end ten times.
    assert!(way > 5.0, "{way}");
    let plate = Shape::Plates(vec![Plate {
        corner: [-0.1, -1.0, 0.0],
        edges: [[0.5, 0.0, 0.0], [0.0, 2.0, 0.0]],
    }]);
    let half = |from: f64| Plate {
        corner: [from, -1.0, 0.0],
        edges: [[0.25, 0.0, 0.0], [0.0, 2.0, 0.0]],
    };
    for (shape, repeats) in [
        (mesh_floor(-0.1, 0.5, 3), true),
        // Drawn elsewhere, and longer than the room.
        (mesh_floor(7.3, 0.5, 2), true),
        (mesh_floor(-1.0, 3.0, 7), true),
        (plate, true),
        (Shape::Plates(vec![half(-0.1), half(0.15)]), true),
    ] {
        let (seamed, found, its_way) = on_belt(shape, repeats);
        let [a, b] = [&seamed, &plane].map(|own| own.fruit()[0]);
        assert!((its_way - way).abs() < 1e-10, "{its_way} {way}");
        assert!(
            length(subtract(a.velocity, b.velocity)) < 1e-7,
            "{a:?} {b:?}"
        );
        assert!(length(subtract(a.spin, b.spin)) < 1e-5, "{a:?} {b:?}");
        // One contact, in the same loads.
        assert_eq!(found.len(), wanted.len());
        for (a, b) in found.iter().zip(&wanted) {
            assert_eq!(a.number, b.number);
            assert!((a.friction_energy - b.friction_energy).abs() < 1e-7 * b.friction_energy);
        }
    }
}

/// Fruit on a chute that is one piece of an endless one: gravity is tilted.
#[test]
fn conserves_energy_down_a_chute() {
    let mut own = shifted(0.2);
    let tilt = 24.0_f64.to_radians();
    own.gravity = [GRAVITY * tilt.sin(), 0.0, -GRAVITY * tilt.cos()];
    own.walls.remove(1);
    own.walls[0].motion = Motion::default();
    for contact in own.interactions.values_mut() {
        contact.friction = 0.3;
    }
    let mut simulation = Simulation::new(own).unwrap();
    let first = simulation.step_with_energy().unwrap();
    let mut last = first;
    let (mut wraps, mut before) = (0, simulation.fruit());
    while simulation.time() < 1.0 {
        simulation.run(9).unwrap();
        last = simulation.step_with_energy().unwrap();
        let now = simulation.fruit();
        let ends = now.iter().zip(&before);
        wraps += ends.filter(|(a, b)| a.place[0] < b.place[0] - 0.3).count();
        before = now;
    }
    assert!(wraps > 50, "{wraps}");
    let closure = last.relative_closure(first.closure());
    assert!(closure.abs() < 1e-4, "{closure} {last:?}");
    // What came in by gravity is of the size of what was lost, not nothing.
    assert!(last.brought - first.brought > 0.5 * last.lost(), "{last:?}");
}

fn bytes(simulation: &mut Simulation) -> Vec<u8> {
    let mut bytes = Vec::new();
    simulation.checkpoint().write(&mut bytes).unwrap();
    bytes
}

fn many() -> Scene {
    let mut own = gas([1.2, 1.1, 0.9], 700, 2e-5);
    own.gravity = [3.0, 0.0, -GRAVITY];
    own.periodic[2] = None;
    own.interactions.values_mut().for_each(|own| *own = rough());
    own.walls = vec![wall("floor", mesh_floor(-0.7, 1.2, 6))];
    own.walls
        .push(plane("ground", [0.0, 0.0, -0.4], [0.0, 0.0, 1.0]));
    for (number, fruit) in own.fruit.iter_mut().enumerate() {
        fruit.place[2] += 0.4;
        if number % 40 == 0 {
            fruit.clump = Clump::spheroid(2.0 * fruit.radius, 1.4 * fruit.radius, fruit.mass, 3);
        }
    }
    own
}

#[test]
fn repeats_bits_after_a_checkpoint_and_on_any_number_of_threads() {
    let run = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
        pool.build().unwrap().install(|| {
            let mut simulation = Simulation::new(many()).unwrap();
            simulation.run(6_000).unwrap();
            let kept = bytes(&mut simulation);
            simulation.take_events();
            simulation.run(6_000).unwrap();
            let events = simulation.take_events();
            (kept, bytes(&mut simulation), simulation.fruit(), events)
        })
    };
    let (kept, end, fruit, events) = run(1);
    assert!(events.len() > 500, "{}", events.len());
    let other = run(3);
    assert!(other.0 == kept && other.1 == end && other.2 == fruit && other.3 == events);
    let state = State::read(&mut &kept[..]).unwrap();
    let mut resumed = Simulation::resume(many(), &state).unwrap();
    resumed.run(6_000).unwrap();
    assert_eq!(resumed.take_events(), events);
    assert!(bytes(&mut resumed) == end);
}

fn one(place: Vector, velocity: Vector) -> Scene {
    let mut own = scene(rough(), 1e-4);
    own.periodic[0] = Some([0.0, 1.0]);
    own.fruit.push(ball(0.05, 0.2, place, velocity));
    own
}

/// A sink that reaches over an end, fruit that come in beyond one, and a place that is taken
/// across it.
#[test]
fn fruit_come_and_leave_across_an_end() {
    let mut own = one([1.3, 0.0, 0.0], [1.0, 0.0, 0.0]);
    own.sinks.push(Sink {
        name: "out".to_owned(),
        low: [-0.1, -1.0, -1.0],
        high: [0.05, 1.0, 1.0],
    });
    let mut simulation = Simulation::new(own).unwrap();
    assert!((simulation.fruit()[0].place[0] - 0.3).abs() < 1e-15);
    simulation.run(12_000).unwrap();
    let left = simulation.take_leavings();
    assert!((left[0].time - 0.6).abs() < 4e-3, "{left:?}");
    let mut own = one([0.99, 0.0, 0.0], [0.0; 3]);
    own.fruit.push(Fruit {
        time: 0.01,
        ..ball(0.05, 0.2, [0.04, 0.0, 0.0], [0.0; 3])
    });
    let mut simulation = Simulation::new(own.clone()).unwrap();
    simulation.run(1_000).unwrap();
    assert_eq!((simulation.count(), simulation.waiting()), (1, 1));
    own.fruit[1].time = 0.0;
    let error = Simulation::new(own).err().unwrap();
    assert!(matches!(error, Error::Occupied { .. }), "{error}");
}

/// A drum that turns about the axis along which it repeats, and a plate that turns far from
/// the ends.
#[test]
fn walls_that_turn_along_the_axis_are_repeated() {
    let about = |point, direction| Axis { point, direction };
    let turning = |shape, about| Wall {
        motion: Motion::always([How::Rotation {
            about,
            angular_velocity: 3.0,
        }]),
        ..wall("drum", shape)
    };
    let drum = |start: f64, end: f64| Shape::Cylinder {
        start: [start, 0.0, 0.0],
        end: [end, 0.0, 0.0],
        radius: 0.3,
    };
    let run = |shape: Shape, x: f64| -> FruitState {
        let mut own = one([x, 0.05, -0.24], [0.0; 3]);
        own.gravity = [0.0, 0.0, -GRAVITY];
        own.walls = vec![turning(shape, about([0.0; 3], [1.0, 0.0, 0.0]))];
        finished(own, 0.5).0.fruit()[0]
    };
    let wanted = run(drum(-5.0, 5.0), 0.5);
    assert!(wanted.spin[0] > 1.0, "{wanted:?}");
    for (shape, x) in [
        (drum(0.0, 1.0), 0.0),
        (drum(0.2, 1.2), 0.2),
        (drum(0.0, 1.0), 0.999),
    ] {
        let found = run(shape, x);
        assert!(length(subtract(found.velocity, wanted.velocity)) < 1e-9);
        assert!(length(subtract(found.spin, wanted.spin)) < 1e-7);
    }
    // Half of it lacks: the fruit falls out.
    assert!(run(drum(0.0, 0.4), 0.7).place[2] < -0.5);
    let plate = |x: f64| {
        Shape::Plates(vec![Plate {
            corner: [x, -0.1, -0.1],
            edges: [[0.1, 0.0, 0.0], [0.0, 0.2, 0.0]],
        }])
    };
    let mut own = one([0.5; 3], [0.0; 3]);
    own.walls = vec![turning(
        plate(0.5),
        about([0.55, 0.0, 0.0], [0.0, 1.0, 0.0]),
    )];
    assert!(own.check().is_ok());
    own.walls = vec![turning(
        plate(0.9),
        about([0.95, 0.0, 0.0], [0.0, 1.0, 0.0]),
    )];
    let error = own.check().unwrap_err().to_string();
    assert!(
        error.contains("\"drum\"") && error.contains("along x"),
        "{error}"
    );
    assert!(error.contains("turns about an axis"), "{error}");
}

#[test]
fn rejects_what_cannot_be_repeated() {
    let told = |change: fn(&mut Scene)| {
        let mut own = one([0.5; 3], [0.0; 3]);
        own.walls.push(floor());
        assert!(own.check().is_ok());
        change(&mut own);
        own.check()
            .err()
            .map_or(String::new(), |own| own.to_string())
    };
    for (change, wanted) in [
        (
            (|own| own.periodic[0] = Some([0.0, 0.29])) as fn(&mut Scene),
            "the period along x is 0.29: it must be at least three times",
        ),
        (
            |own| own.periodic[1] = Some([1.0, 0.0]),
            "the period along y is -1",
        ),
        (
            |own| own.periodic[2] = Some([0.0, f64::INFINITY]),
            "the period along z is inf",
        ),
        (|own| own.periodic[2] = Some([0.0, 1.0]), "must be parallel"),
        (
            |own| {
                own.walls[0].motion = Motion::always([How::Rotation {
                    about: Axis {
                        point: [0.0; 3],
                        direction: [0.0, 1.0, 0.0],
                    },
                    angular_velocity: 1.0,
                }])
            },
            "turns about an axis",
        ),
        (
            |own| {
                own.walls[0].shape = mesh_floor(0.4, 0.1, 1);
                own.walls[0].motion = Motion::always([How::Velocity([0.1, 0.0, 0.0])]);
            },
            "moves along this axis without end",
        ),
    ] {
        let found = told(change);
        assert!(found.contains(wanted), "{found}");
    }
    // Across the axis, or for a while, it may move.
    for change in [
        (|own| {
            own.walls[0].shape = mesh_floor(0.0, 1.0, 2);
            own.walls[0].motion = Motion::always([
                How::Velocity([0.0, 0.1, 0.1]),
                How::Vibration {
                    amplitude: [0.01, 0.0, 0.0],
                    frequency: 20.0,
                },
            ]);
        }) as fn(&mut Scene),
        |own| own.walls[0].motion = Motion::always([How::Velocity([0.0, 0.0, 0.1])]),
    ] {
        assert_eq!(told(change), "");
    }
}

/// A mesh that shakes along the axis is felt as an endless one that does.
#[test]
fn a_belt_that_shakes_along_the_axis_has_no_gap() {
    let run = |x: f64| {
        let mut own = one([x, 0.1, 0.0499], [0.2, 0.0, 0.0]);
        own.gravity = [0.0, 0.0, -GRAVITY];
        own.walls = vec![wall("belt", mesh_floor(0.0, 1.0, 2))];
        own.walls[0].motion = Motion::always([How::Vibration {
            amplitude: [0.08, 0.0, 0.0],
            frequency: 2.0,
        }]);
        let (simulation, events) = finished(own, 1.0);
        (simulation.fruit()[0], events.len())
    };
    let (wanted, loads) = run(0.5);
    for x in [0.0, 0.95] {
        let (found, own) = run(x);
        assert_eq!(own, loads);
        let off = length(subtract(found.velocity, wanted.velocity));
        assert!(off < 1e-7, "{found:?} {wanted:?}");
    }
}
