//! Walls of many triangles against the shapes that they stand for.
#![allow(clippy::unwrap_used)]

use crate::common;

use common::{STEEL, ball, law, scene};
use windfall_scene::event::Event;
use windfall_scene::interaction::{Interaction, mindlin_ratio};
use windfall_scene::motion::simulation::{FruitState, Simulation};
use windfall_scene::scene::Scene;
use windfall_scene::shape::motion::{Axis, How, Motion};
use windfall_scene::shape::surface::{Plate, Shape};
use windfall_scene::shape::wall::Wall;
use windfall_scene::vector::Vector;

fn apple() -> Interaction {
    Interaction {
        friction: 0.4,
        tangential_ratio: mindlin_ratio(0.3),
        tangential_damping: 1.0,
        rolling: 0.01,
        ..Interaction::frictionless(law("kuwabara-kono(k=753599, c=1524)"))
    }
}

fn wall(shape: Shape, motion: Motion) -> Wall {
    Wall {
        name: "wall".to_owned(),
        material: STEEL,
        shape,
        motion,
    }
}

/// A surface over a unit square, in `across` × `along` parts of two triangles.
fn tessellated(across: usize, along: usize, at: impl Fn(f64, f64) -> Vector) -> Shape {
    let corner = |i: usize, j: usize| at(i as f64 / across as f64, j as f64 / along as f64);
    let mut triangles = Vec::new();
    for i in 0..across {
        for j in 0..along {
            let (a, b) = (corner(i, j), corner(i + 1, j));
            let (c, d) = (corner(i + 1, j + 1), corner(i, j + 1));
            // Diagonals in turns, so that corners have four or eight triangles.
            triangles.extend(match (i + j) % 2 {
                0 => [[a, b, c], [a, c, d]],
                _ => [[a, b, d], [b, c, d]],
            });
        }
    }
    Shape::Mesh { triangles }
}

fn finished(scene: Scene, time: f64) -> (Vec<FruitState>, Vec<Event>) {
    let mut simulation = Simulation::new(scene).unwrap();
    while simulation.time() < time {
        simulation.step().unwrap();
    }
    let mut events = simulation.take_events();
    events.extend(simulation.lasting());
    (simulation.fruit(), events)
}

fn apart(a: Vector, b: Vector) -> f64 {
    let off = [0, 1, 2].map(|axis| a[axis] - b[axis]);
    off.iter().map(|own| own * own).sum::<f64>().sqrt()
}

/// What a ball that falls on to a floor and rolls over it does, on a plate or on a mesh.
fn over_a_floor(shape: Shape, motion: Motion) -> (Vec<FruitState>, Vec<Event>) {
    let mut scene = scene(apple(), 5e-5);
    scene.gravity = [0.0, 0.0, -9.81];
    scene.walls.push(wall(shape, motion));
    let mut own = ball(0.04, 0.2, [0.1013, 0.2031, 0.06], [0.9, 0.31, -0.5]);
    own.spin = [1.0, 10.0, 3.0];
    scene.fruit.push(own);
    finished(scene, 0.8)
}

fn flat() -> Shape {
    Shape::Plates(vec![Plate {
        corner: [-0.2, -0.2, 0.0],
        edges: [[1.6, 0.0, 0.0], [0.0, 1.2, 0.0]],
    }])
}

fn flat_mesh() -> Shape {
    tessellated(160, 120, |s, t| [1.6 * s - 0.2, 1.2 * t - 0.2, 0.0])
}

#[test]
fn a_ball_on_a_flat_mesh_feels_no_edge() {
    // 38,400 triangles of 10 mm; the patch in which it presses on them has about that size.
    let motions = [
        Motion::default(),
        Motion::always([How::Belt([0.2, -0.1, 0.0])]),
        Motion::always([How::Velocity([0.0, 0.1, 0.02])]),
        Motion::always([How::Vibration {
            amplitude: [0.001, 0.0, 0.0005],
            frequency: 25.0,
        }]),
        Motion::always([How::Rotation {
            about: Axis {
                point: [0.5, 0.3, 0.0],
                direction: [0.0, 0.0, 1.0],
            },
            angular_velocity: 0.7,
        }]),
    ];
    for motion in motions {
        let (plate, on_plate) = over_a_floor(flat(), motion.clone());
        let (mesh, on_mesh) = over_a_floor(flat_mesh(), motion.clone());
        let way = apart(plate[0].place, mesh[0].place);
        let speed = apart(plate[0].velocity, mesh[0].velocity);
        println!(
            "{way:e} m, {speed:e} m/s apart after {} contacts",
            on_mesh.len()
        );
        assert!(
            way < 1e-12 && speed < 1e-12,
            "{motion:?}: {plate:?} {mesh:?}"
        );
        assert_eq!(on_plate.len(), on_mesh.len(), "{motion:?}");
        for (a, b) in on_plate.iter().zip(&on_mesh) {
            assert!(
                (a.peak_force / b.peak_force - 1.0).abs() < 1e-8,
                "{a:?} {b:?}"
            );
            assert!((a.duration - b.duration).abs() < 1e-9, "{a:?} {b:?}");
        }
    }
}

/// Where a ball is that falls into a trough and rolls to and fro in it, with its events.
fn in_a_trough(shape: Shape) -> (Vec<FruitState>, Vec<Event>) {
    // Rolling friction follows R*, and triangles count as flat.
    let mut own = apple();
    own.rolling = 0.0;
    let mut scene = scene(own, 5e-5);
    scene.gravity = [0.0, 0.0, -9.81];
    scene.walls.push(wall(shape, Motion::default()));
    scene
        .fruit
        .push(ball(0.04, 0.2, [0.1013, 0.013, -0.19], [0.02, 0.0, 0.0]));
    finished(scene, 0.6)
}

#[test]
fn converges_a_mesh_of_a_tube_to_the_tube() {
    // The inside of a lying tube of 0.6 m: a ball of 80 mm touches one or two of its facets.
    let tube = Shape::Cylinder {
        start: [-0.5, 0.0, 0.0],
        end: [1.0, 0.0, 0.0],
        radius: 0.3,
    };
    let (exact, on_tube) = in_a_trough(tube);
    let mesh = |parts: usize| {
        in_a_trough(tessellated(parts, 30, |s, t| {
            // Corners as far out as the facets' middles are in.
            let angle = std::f64::consts::TAU * s;
            let outer = 0.6 / (1.0 + (std::f64::consts::PI / parts as f64).cos());
            [1.5 * t - 0.5, outer * angle.sin(), -outer * angle.cos()]
        }))
    };
    let mut errors = Vec::new();
    for parts in [60, 240, 960] {
        let (own, on_mesh) = mesh(parts);
        let error = apart(own[0].place, exact[0].place);
        let [a, b] = [&on_tube, &on_mesh].map(|events| {
            events
                .iter()
                .map(|event| event.peak_force)
                .fold(0.0, f64::max)
        });
        println!("{parts} parts: {error:e} m off, peak force {b} for {a} N");
        assert!((b / a - 1.0).abs() < 0.05, "{parts}: {a} {b}");
        errors.push(error);
    }
    assert!(
        errors[2] < 2e-4 && errors[2] < 0.2 * errors[0],
        "{errors:?}"
    );
}

/// Peak force and direction of the velocity after a ball struck a globe of 0.3 m off centre.
fn on_a_globe(parts: usize, off: f64) -> (f64, Vector, usize) {
    let globe = |radius: f64| {
        tessellated(2 * parts, parts, move |s, t| {
            let (turn, tilt) = (std::f64::consts::TAU * s, std::f64::consts::PI * t);
            [
                radius * tilt.sin() * turn.cos(),
                radius * tilt.sin() * turn.sin(),
                radius * tilt.cos(),
            ]
        })
    };
    let mut scene = scene(Interaction::frictionless(law("hertz(k=753599)")), 1e-5);
    let Shape::Mesh { triangles } = globe(0.15) else {
        panic!("a mesh");
    };
    let surface = windfall_scene::shape::mesh::welded(&triangles);
    assert!(surface.flaws.rims.is_empty() && surface.flaws.contrary.is_empty());
    scene.walls.push(wall(
        Shape::Mesh {
            triangles: surface.triangles,
        },
        Motion::default(),
    ));
    scene
        .fruit
        .push(ball(0.04, 0.2, [0.3, off, 0.3 * off], [-1.0, 0.0, 0.0]));
    let (fruit, events) = finished(scene, 0.2);
    (events[0].peak_force, fruit[0].velocity, events.len())
}

#[test]
fn converges_a_mesh_of_a_globe_to_the_globe() {
    for off in [0.0, 0.03, 0.09] {
        // A mirror at the point of the sphere of 0.19 m where they first touch.
        let square = 0.19_f64.powi(2) - off * off * 1.09;
        let normal = [square.sqrt(), off, 0.3 * off].map(|own| own / 0.19);
        let reflected = [
            -1.0 + 2.0 * normal[0] * normal[0],
            2.0 * normal[0] * normal[1],
            2.0 * normal[0] * normal[2],
        ];
        // Hertz: k d^2.5/2.5 = m v²/2 of what goes along the normal; the path bends a little.
        let peak = |v: f64| 753_599.0 * (1.25 * 0.2 * v * v / 753_599.0_f64).powf(0.6);
        let (force, velocity, contacts) = on_a_globe(90, off);
        assert_eq!(contacts, 1, "{off}");
        let turned = apart(velocity, reflected);
        println!("{off} m off centre: peak {force} N, velocity {turned:e} m/s off");
        assert!(
            (force / peak(normal[0]) - 1.0).abs() < 0.02,
            "{off}: {force}"
        );
        assert!(turned < 0.05, "{off}: {velocity:?} {reflected:?}");
        let speed = velocity.iter().map(|own| own * own).sum::<f64>();
        assert!((speed - 1.0).abs() < 2e-3, "{off}: {speed}");
    }
}

#[test]
fn a_mesh_of_a_box_has_corners_like_the_box() {
    // Three faces at once, each with its own contact.
    let interaction = apple();
    let side = |corner: Vector, a: Vector, b: Vector| Plate {
        corner,
        edges: [a, b],
    };
    let (x, y, z) = ([0.4, 0.0, 0.0], [0.0, 0.4, 0.0], [0.0, 0.0, 0.4]);
    let plates = vec![
        side([0.0; 3], x, y),
        side([0.0; 3], y, z),
        side([0.0; 3], x, z),
    ];
    let mut triangles = Vec::new();
    for plate in &plates {
        let own = tessellated(16, 16, |s, t| {
            [0, 1, 2].map(|axis| {
                plate.corner[axis] + s * plate.edges[0][axis] + t * plate.edges[1][axis]
            })
        });
        if let Shape::Mesh { triangles: own } = own {
            triangles.extend(own);
        }
    }
    let run = |shape: Shape| {
        let mut scene = scene(interaction.clone(), 5e-5);
        scene.gravity = [-3.0, -2.0, -9.0];
        scene.walls.push(wall(shape, Motion::default()));
        scene
            .fruit
            .push(ball(0.04, 0.2, [0.1, 0.12, 0.11], [0.1, -0.2, 0.0]));
        finished(scene, 1.0)
    };
    let (plates, mesh) = (run(Shape::Plates(plates)), run(Shape::Mesh { triangles }));
    assert!(apart(plates.0[0].place, mesh.0[0].place) < 1e-10);
    assert_eq!(plates.1.len(), mesh.1.len());
    assert!(mesh.1.iter().filter(|event| event.lasting).count() == 3);
}

#[test]
fn conserves_energy_of_a_ball_that_bounces_in_a_polygon() {
    // No friction, no damping: on facets, edges and corners nothing may be won or lost but
    // by the time step. The tube has 14, 24 and 100 sides.
    for sides in [14, 24, 100] {
        let mut scene = scene(Interaction::frictionless(law("hertz(k=753599)")), 1e-5);
        scene.gravity = [0.0, 0.0, -9.81];
        let shape = tessellated(sides, 4, |s, t| {
            let angle = std::f64::consts::TAU * s;
            [2.0 * t - 1.0, 0.3 * angle.sin(), -0.3 * angle.cos()]
        });
        scene.walls.push(wall(shape, Motion::default()));
        scene
            .fruit
            .push(ball(0.04, 0.2, [0.0, 0.1, 0.0], [0.01, 0.3, 0.0]));
        let mut simulation = Simulation::new(scene).unwrap();
        let mut energies = Vec::new();
        for _ in 0..200_000 {
            if simulation.steps().is_multiple_of(1000) {
                let own = simulation.step_with_energy().unwrap();
                energies.push(own.kinetic + own.potential + own.in_contacts);
            } else {
                simulation.step().unwrap();
            }
        }
        let moves = 0.2 * 9.81 * 0.3;
        let worst = energies
            .iter()
            .map(|own| (own - energies[0]).abs())
            .fold(0.0, f64::max);
        println!("{sides} sides: {worst:e} J of {moves} J");
        assert!(worst < 5e-3 * moves, "{sides}: {worst:e}");
    }
}

#[test]
fn fruit_in_a_drum_of_triangles_that_turns() {
    // A drum of 20,000 triangles, turning, with ends; fruit are carried up and fall back.
    let mut scene = scene(apple(), 1e-4);
    scene.gravity = [0.0, 0.0, -9.81];
    let motion = Motion::always([How::Rotation {
        about: Axis {
            point: [0.0; 3],
            direction: [1.0, 0.0, 0.0],
        },
        angular_velocity: 2.0,
    }]);
    let side = tessellated(200, 50, |s, t| {
        let angle = std::f64::consts::TAU * s;
        [0.6 * t - 0.3, 0.4 * angle.sin(), 0.4 * angle.cos()]
    });
    scene.walls.push(wall(side, motion));
    for end in [-0.3, 0.3] {
        let sign = -f64::signum(end);
        let normal = [sign, 0.0, 0.0];
        scene
            .walls
            .push(common::plane("end", [end, 0.0, 0.0], normal));
    }
    for number in 0..60 {
        let (i, j, k) = (number % 5, number / 5 % 4, number / 20);
        let place = [
            0.09 * (i as f64 - 2.0),
            0.09 * (j as f64 - 1.5),
            0.09 * (k as f64 - 2.0),
        ];
        scene.fruit.push(ball(0.04, 0.2, place, [0.0; 3]));
    }
    let mut simulation = Simulation::new(scene).unwrap();
    let first = simulation.step_with_energy().unwrap();
    for _ in 0..20_000 {
        simulation.step().unwrap();
    }
    let last = simulation.step_with_energy().unwrap();
    let closure = (last.closure() - first.closure()).abs();
    println!("closure {closure:e} J of {} J lost", last.lost());
    assert!(last.lost() > 5.0 && last.done_by_walls > 5.0, "{last:?}");
    assert!(
        closure < 2e-3 * last.lost(),
        "{closure:e} of {}",
        last.lost()
    );
    for own in simulation.fruit() {
        let [_, y, z] = own.place;
        assert!(y.hypot(z) < 0.37, "{own:?}");
    }
}
