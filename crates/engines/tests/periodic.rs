//! Scenes that repeat, against `boundary p` of LAMMPS.

use std::collections::BTreeMap;
use std::f64::consts::PI;
use std::fmt::Write;
use std::process::Command;
use windfall_contact::expression::parse_law;
use windfall_scene::interaction::Interaction;
use windfall_scene::motion::simulation::Simulation;
use windfall_scene::scene::{Fruit, Scene};
use windfall_scene::shape::motion::Motion;
use windfall_scene::shape::surface::Shape;
use windfall_scene::shape::wall::Wall;
use windfall_scene::vector::{Vector, length, subtract};

const STEP: f64 = 2e-5;
const STEPS: u64 = 4_000;
const SIDES: [f64; 2] = [0.5, 0.4];
const GRAVITY: Vector = [3.0, -1.0, -9.0];
/// N/m^1.5, at this R*; m.
const STIFFNESS: f64 = 1e6;
const RADIUS: f64 = 0.02;

/// Elastic balls that fall on a floor and slide over the ends of a room.
fn scene() -> Scene {
    let law = parse_law(&format!("hertz(k={STIFFNESS})")).unwrap();
    let elastic = Interaction {
        effective_radius: Some(RADIUS),
        ..Interaction::frictionless(law.complete().unwrap())
    };
    let mut own = Scene {
        materials: vec!["ball".to_owned(), "floor".to_owned()],
        interactions: BTreeMap::from([((0, 0), elastic.clone()), ((0, 1), elastic)]),
        gravity: GRAVITY,
        periodic: [Some([-0.1, SIDES[0] - 0.1]), Some([0.0, SIDES[1]]), None],
        time_step: STEP,
        ..Scene::default()
    };
    own.walls.push(Wall {
        name: "floor".to_owned(),
        material: 1,
        shape: Shape::Plane {
            point: [0.0; 3],
            normal: [0.0, 0.0, 1.0],
        },
        motion: Motion::default(),
    });
    for number in 0..5 * 4 * 4 {
        let at = [number % 5, number / 5 % 4, number / 20].map(f64::from);
        // Different ones, side by side over both ends.
        let own_share = (f64::from(number) * 0.618_033_988_7).fract();
        let place = [
            0.1 * at[0] - 0.1,
            0.1 * at[1],
            0.1 * at[2] + 0.06 + 0.01 * own_share,
        ];
        let mut ball = Fruit::sphere(0, 0.035 + 0.012 * own_share, 900.0, place);
        ball.velocity = [1.0 - 2.0 * own_share, 3.0 * own_share - 1.0, -1.0];
        own.fruit.push(ball);
    }
    own
}

/// The same scene as a deck, and its balls.
fn deck(own: &Scene) -> [String; 2] {
    let [x, y] = [own.periodic[0].unwrap(), own.periodic[1].unwrap()];
    let mut data = format!(
        "balls\n\n{} atoms\n1 atom types\n\n{} {} xlo xhi\n{} {} ylo yhi\n0 2 zlo zhi\n\n\
         Atoms # sphere\n\n",
        own.fruit.len(),
        x[0],
        x[1],
        y[0],
        y[1]
    );
    for (number, ball) in own.fruit.iter().enumerate() {
        let ([x, y, z], radius) = (ball.place, ball.radius);
        let density = ball.mass / (4.0 / 3.0 * PI * radius.powi(3));
        let diameter = 2.0 * radius;
        writeln!(data, "{} 1 {diameter} {density} {x} {y} {z}", number + 1).unwrap();
    }
    data += "\nVelocities\n\n";
    for (number, ball) in own.fruit.iter().enumerate() {
        let [u, v, w] = ball.velocity;
        writeln!(data, "{} {u} {v} {w} 0 0 0", number + 1).unwrap();
    }
    let contact = format!(
        "hertz {} 0 tangential linear_nohistory 0 0 damping velocity",
        STIFFNESS / RADIUS.sqrt()
    );
    let [u, v, w] = GRAVITY;
    let deck = format!(
        "units si\natom_style sphere\nboundary p p f\nnewton off\ncomm_modify vel yes\n\
         read_data balls.data\npair_style granular\npair_coeff * * {contact}\n\
         fix floor all wall/gran granular {contact} zplane 0 NULL\n\
         fix down all gravity {} vector {u} {v} {w}\nfix move all nve/sphere\n\
         neighbor 0.005 bin\nneigh_modify delay 0 every 1 check yes\ntimestep {STEP}\n\
         run {STEPS}\nwrite_dump all custom end.txt id x y z modify sort id format float %.16g\n",
        length(GRAVITY)
    );
    [deck, data]
}

fn lammps(own: &Scene) -> Vec<Vector> {
    let folder = tempfile::tempdir().unwrap();
    let [deck, data] = deck(own);
    std::fs::write(folder.path().join("in.balls"), deck).unwrap();
    std::fs::write(folder.path().join("balls.data"), data).unwrap();
    let done = Command::new("lmp")
        .args(["-in", "in.balls", "-log", "none"])
        .current_dir(folder.path())
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&done.stdout);
    assert!(done.status.success(), "{said}");
    let text = std::fs::read_to_string(folder.path().join("end.txt")).unwrap();
    let rows = text
        .lines()
        .skip_while(|own| !own.starts_with("ITEM: ATOMS"));
    let place = |row: &str| {
        let n: Vec<f64> = row
            .split(' ')
            .skip(1)
            .map(|own| own.parse().unwrap())
            .collect();
        [n[0], n[1], n[2]]
    };
    rows.skip(1).map(|own| place(own.trim())).collect()
}

#[test]
fn reference_balls_are_where_lammps_has_them() {
    let own = scene();
    let wanted = lammps(&own);
    let periods = own.periods();
    let mut simulation = Simulation::new(own).unwrap();
    let mut events = Vec::new();
    let (mut wraps, mut before) = (0, simulation.fruit());
    for _ in 0..STEPS / 100 {
        simulation.run(100).unwrap();
        events.extend(simulation.take_events());
        let now = simulation.fruit();
        let far = |axis: usize| {
            let ways = now.iter().zip(&before);
            let ways = ways.map(move |(a, b)| (a.place[axis] - b.place[axis]).abs());
            ways.filter(|own| *own > 0.2).count()
        };
        wraps += far(0) + far(1);
        before = now;
    }
    // Over both ends, and with contacts enough.
    assert!(wraps > 30 && events.len() > 200, "{wraps} {}", events.len());
    assert_eq!(wanted.len(), before.len());
    let off = before.iter().zip(&wanted).map(|(own, place)| {
        let image = periods.image(*place, own.place);
        length(subtract(own.place, image))
    });
    let most = off.fold(0.0, f64::max);
    println!(
        "wraps {wraps}, contacts {}, off by {most:e} m",
        events.len()
    );
    assert!(most < 1e-11, "{most}");
}
