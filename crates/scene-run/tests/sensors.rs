//! Sensors of scenes against closed forms, and against what the scene's own tables say.
#![allow(clippy::unwrap_used)]

use std::collections::BTreeMap;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use windfall_scene_run::run::outcome::SceneOutcome;
use windfall_scene_run::run::stopped::SceneStart;
use windfall_scene_run::run::tables::text_of_scene;
use windfall_scene_run::run::workflow::{SceneRequest, run_scene};

/// A scene in a folder of its own.
struct Lab(tempfile::TempDir);

/// Apples on steel and on each other.
const CONTACTS: &str = r#"
[[contacts]]
between = ["apple", "steel"]
law = "kuwabara-kono(k=1065750, c=2155)"
effective_radius = "40 mm"
friction = 0.3
poisson = 0.3

[[contacts]]
between = ["apple", "apple"]
law = "kuwabara-kono(k=753599, c=1524)"
effective_radius = "20 mm"
friction = 0.3
poisson = 0.3
"#;

impl Lab {
    /// A scene: a section `[scene]`, and what else is there.
    fn new(scene: &str, rest: &str) -> Self {
        let lab = Self(tempfile::tempdir().unwrap());
        let text = format!(
            "format = 1\nmaterials = [\"apple\", \"steel\"]\n\n[scene]\n{scene}\n{CONTACTS}\n{rest}"
        );
        std::fs::write(lab.path(), text).unwrap();
        lab
    }

    fn path(&self) -> PathBuf {
        self.0.path().join("s.toml")
    }

    fn out(&self) -> PathBuf {
        self.0.path().join("s.run")
    }

    fn run(&self) -> SceneOutcome {
        self.try_run(SceneStart::Fresh, u64::MAX).unwrap()
    }

    /// Runs up to a step.
    fn try_run(&self, start: SceneStart, until: u64) -> Result<SceneOutcome, String> {
        let request = SceneRequest {
            out: Some(self.out()),
            threads: Some(1),
            set: Vec::new(),
            start,
        };
        let progress = |done: usize, _: usize| match done as u64 >= until {
            true => ControlFlow::Break(()),
            false => ControlFlow::Continue(()),
        };
        run_scene(&self.path(), &request, &progress).map_err(|error| error.to_string())
    }

    /// Rows of a table, by column.
    fn table(&self, name: &str) -> Vec<BTreeMap<String, String>> {
        rows(&self.out().join(name))
    }
}

fn rows(path: &Path) -> Vec<BTreeMap<String, String>> {
    let mut reader = csv::Reader::from_path(path).unwrap();
    let names = reader.headers().unwrap().clone();
    let row = |own: csv::StringRecord| -> BTreeMap<String, String> {
        let cells = names.iter().zip(own.iter());
        cells
            .map(|(name, cell)| (name.to_owned(), cell.to_owned()))
            .collect()
    };
    reader.records().map(|own| row(own.unwrap())).collect()
}

fn number(row: &BTreeMap<String, String>, column: &str) -> f64 {
    row[column].parse().unwrap()
}

fn drop(place: &str, velocity: &str) -> String {
    format!(
        "[[fruit]]\nname = \"ball\"\nmaterial = \"apple\"\ncount = 1\ndiameter = \"80 mm\"\n\
         density = \"746 kg/m^3\"\ndrop = {{ place = {place}, velocity = {velocity} }}\n"
    )
}

const FLOOR: &str = "[[walls]]\nname = \"floor\"\nmaterial = \"steel\"\n\
                     plane = { point = [0, 0, 0], normal = [0, 0, 1] }\n";

const GRAVITY: f64 = 9.80665;

#[test]
fn closed_form_a_falling_ball_passes_a_plane_when_it_should_and_feels_nothing() {
    let sensors = r#"
[[sensors]]
name = "gate"
plane = { point = [0, 0, 0.3], normal = [0, 0, 1] }

[[sensors]]
name = "window beside it"
plate = { corner = [0.1, -1, 0.3], edges = [[1, 0, 0], [0, 2, 0]] }

[[sensors]]
name = "ball"
probe = "ball"
interval = "1 ms"
"#;
    // It ends before the ball is on the floor: 0.76 m take 0.394 s.
    let lab = Lab::new(
        "end = \"0.39 s\"",
        &(drop("[0, 0, 0.8]", "[0, 0, 0]") + FLOOR + sensors),
    );
    let found = lab.run();
    let passes = lab.table("sensor_passes.csv");
    assert_eq!(passes.len(), 1);
    let wanted = (2.0 * 0.5 / GRAVITY).sqrt();
    // Between looks of 1 ms at most the way is taken for straight: g Δt²/(8 v).
    let error = GRAVITY * 1e-6 / (8.0 * GRAVITY * wanted);
    let time = number(&passes[0], "time_s");
    assert!((time - wanted).abs() < 1.1 * error, "{time} {wanted}");
    let speed = number(&passes[0], "normal_speed_m_s");
    assert!(
        (speed + GRAVITY * wanted).abs() < 0.005 * GRAVITY,
        "{speed}"
    );
    assert_eq!(passes[0]["forward"], "false");
    let flow = found.sensors[0].flow.as_ref().unwrap();
    assert_eq!((flow.forward, flow.backward), (0, 1));
    assert!(found.sensors[0].look <= 1e-3);
    // The window saw nothing, and that is said.
    let silent: Vec<&str> = found.findings.iter().map(|own| own.code.as_str()).collect();
    assert_eq!(silent, ["sensor-silent"]);
    assert!(found.findings[0].message.contains("window beside it"));
    let samples = lab.table("sensor_probes.csv");
    assert!(samples.len() > 380, "{}", samples.len());
    for row in &samples {
        assert!(number(row, "magnitude_m_s2") < 1e-9, "{row:?}");
    }
    let probe = found.sensors[2].probe.as_ref().unwrap();
    assert_eq!((probe.fruit, probe.impacts), (1, 0));
    for name in ["sensors.svg", "sensors.csv"] {
        assert!(lab.out().join(name).is_file(), "{name}");
    }
}

#[test]
fn closed_form_a_bounce_changes_the_velocity_by_what_comes_in_and_out() {
    let sensors = "[[sensors]]\nname = \"ball\"\nprobe = \"ball\"\ninterval = \"20 us\"\n\
                   least_acceleration = \"1 m/s^2\"\n";
    let rest = drop("[0, 0, 0.041]", "[0.2, 0, -2]") + FLOOR + sensors;
    let lab = Lab::new(
        "gravity = \"0 m/s^2\"\nend = \"20 ms\"\ntime_step = \"10 us\"",
        &rest,
    );
    let text = std::fs::read_to_string(lab.path()).unwrap();
    std::fs::write(lab.path(), text.replace("friction = 0.3", "friction = 0")).unwrap();
    let found = lab.run();
    assert_eq!(found.sensors[0].interval, 2.0 * found.step.time_step);
    let (events, impacts) = (lab.table("events.csv"), lab.table("sensor_impacts.csv"));
    assert_eq!((events.len(), impacts.len()), (1, 1));
    let (event, impact) = (&events[0], &impacts[0]);
    let mass = 746.0 * std::f64::consts::PI / 6.0 * 0.08_f64.powi(3);
    let inwards = number(event, "normal_speed_m_s");
    // From the energy that the contact kept, not from velocities.
    let kept = number(event, "absorbed_energy_J");
    let outwards = (inwards * inwards - 2.0 * kept / mass).sqrt();
    let restitution = outwards / inwards;
    assert!((0.2..0.9).contains(&restitution), "{restitution}");
    let change = number(impact, "velocity_change_m_s");
    let wanted = inwards * (1.0 + restitution);
    assert!((change / wanted - 1.0).abs() < 5e-3, "{change} {wanted}");
    // The mean over 20 µs of a pulse of about 4 ms is at most 0.1 % below its peak.
    let peak = number(impact, "peak_acceleration_m_s2");
    let force = number(event, "peak_force_N");
    let share = peak * mass / force;
    assert!((0.997..1.0005).contains(&share), "{share}");
    let in_g = number(impact, "peak_acceleration_g");
    assert!((in_g * GRAVITY / peak - 1.0).abs() < 1e-12);
    let duration = number(impact, "duration_s") / number(event, "duration_s");
    assert!((0.9..1.05).contains(&duration), "{duration}");
    assert_eq!(
        (impact["struck"].as_str(), impact["lasting"].as_str()),
        ("floor", "false")
    );
}

#[test]
fn closed_form_a_long_interval_averages_the_peak_and_keeps_the_impulse() {
    let rest = |interval: &str| {
        let sensors = format!(
            "[[sensors]]\nname = \"ball\"\nprobe = \"ball\"\ninterval = \"{interval}\"\n\
             least_acceleration = \"1 m/s^2\"\n"
        );
        drop("[0, 0, 0.041]", "[0, 0, -2]") + FLOOR + &sensors
    };
    let scene = "gravity = \"0 m/s^2\"\nend = \"30 ms\"\ntime_step = \"10 us\"";
    let of = |interval: &str| {
        let lab = Lab::new(scene, &rest(interval));
        lab.run();
        let impacts = lab.table("sensor_impacts.csv");
        assert_eq!(impacts.len(), 1, "{interval}");
        ["peak_acceleration_m_s2", "velocity_change_m_s"].map(|own| number(&impacts[0], own))
    };
    let (short, long) = (of("10 us"), of("2 ms"));
    assert!(
        (long[1] / short[1] - 1.0).abs() < 2e-3,
        "{short:?} {long:?}"
    );
    assert!(long[0] < 0.97 * short[0], "{short:?} {long:?}");
}

#[test]
fn closed_form_a_resting_ball_feels_one_g() {
    let sensors = "[[sensors]]\nname = \"ball\"\nprobe = \"ball\"\ninterval = \"5 ms\"\n";
    let rest = drop("[0, 0, 0.04]", "[0, 0, 0]") + FLOOR + sensors;
    let lab = Lab::new("end = \"0.6 s\"", &rest);
    let found = lab.run();
    let samples = lab.table("sensor_probes.csv");
    let last = samples.last().unwrap();
    for (column, wanted) in [("x_m_s2", 0.0), ("y_m_s2", 0.0), ("z_m_s2", GRAVITY)] {
        assert!((number(last, column) - wanted).abs() < 0.01, "{last:?}");
    }
    let probe = found.sensors[0].probe.as_ref().unwrap();
    // 15 g are the threshold where none is given.
    assert!((probe.least_acceleration - 15.0 * GRAVITY).abs() < 1e-9 && probe.impacts == 0);
    assert!(lab.table("sensor_impacts.csv").is_empty());
}

#[test]
fn closed_form_a_ball_crosses_a_box_in_its_length_over_its_speed() {
    let sensors = "[[sensors]]\nname = \"space\"\ninterval = \"10 ms\"\n\
                   box = { low = [0.1003, -1, -1], high = [0.4, 1, 1] }\n";
    let rest = drop("[0, 0, 0]", "[1.5, 0, 0]") + sensors;
    let lab = Lab::new(
        "gravity = \"0 m/s^2\"\nend = \"0.5 s\"\ntime_step = \"61 us\"",
        &rest,
    );
    let found = lab.run();
    let space = found.sensors[0].space.as_ref().unwrap();
    let residence = space.residence.as_ref().unwrap();
    assert_eq!((space.entered, space.inside, residence.fruit), (1, 0, 1));
    assert!(
        (residence.mean - 0.2997 / 1.5).abs() < 1e-9,
        "{residence:?}"
    );
    assert_eq!(found.sensors[0].interval, 164.0 * 61e-6);
    let table = lab.table("sensor_boxes.csv");
    assert_eq!(table.len(), 50);
    for row in &table {
        let place = 1.5 * number(row, "time_s");
        let inside = (0.1003..=0.4).contains(&place);
        assert_eq!(row["fruit"] == "1", inside, "{row:?}");
        assert_eq!(row["level_m"].is_empty(), !inside);
        if inside {
            assert!((number(row, "level_m") - 0.04).abs() < 1e-12);
            let volume = std::f64::consts::PI / 6.0 * 0.08_f64.powi(3);
            let share = volume / (0.2997 * 4.0);
            assert!((number(row, "fruit_share") / share - 1.0).abs() < 1e-9);
        }
    }
}

/// Apples poured onto a belt that carries them to a sink, past a gate.
const BELT: &str = r#"
[[fruit]]
name = "apples"
material = "apple"
count = 60
diameter = "80 mm"
density = "746 kg/m^3"
pour = { low = [0, -0.6, 0.1], high = [0.1, 0.6, 0.2], rate = "10 Hz" }

[[fruit]]
name = "IS100"
material = "apple"
count = 1
diameter = "90 mm"
density = "746 kg/m^3"
drop = { place = [0.3, 0.05, 0.4], from = "0.25 s" }

[[walls]]
name = "belt"
material = "steel"
plane = { point = [0, 0, 0], normal = [0, 0, 1] }
belt = [2, 0, 0]

[[sinks]]
name = "away"
low = [0.7, -5, -1]
high = [3, 5, 5]

[[sensors]]
name = "end of the belt, with a comma"
plane = { point = [0.5, 0, 0], normal = [1, 0, 0] }
fruit = "apples"
interval = "0.5 s"

[[sensors]]
name = "at the sink"
plane = { point = [0.7, 0, 0], normal = [1, 0, 0] }

[[sensors]]
name = "belt"
box = { low = [0, -1, 0], high = [0.7, 1, 0.5] }
interval = "20 ms"

[[sensors]]
name = "sphere"
probe = "IS100"
interval = "0.2 ms"
"#;

#[test]
fn the_flow_over_a_belt_is_that_of_the_pour() {
    let lab = Lab::new("end = \"4 s\"", BELT);
    let found = lab.run();
    let [gate, sink, space, probe] = &found.sensors[..] else {
        panic!("{:?}", found.sensors);
    };
    // Apples come at 10 a second, and roll and slide to the speed of the belt each alike.
    let flow = gate.flow.as_ref().unwrap();
    assert_eq!(flow.backward, 0);
    let mean = flow.mean_flow.unwrap();
    assert!((mean / 10.0 - 1.0).abs() < 0.05, "{flow:?}");
    let mass = 746.0 * std::f64::consts::PI / 6.0 * 0.08_f64.powi(3);
    assert!((flow.mass_forward / flow.forward as f64 / mass - 1.0).abs() < 1e-9);
    assert!((flow.mean_mass_flow.unwrap() / mean / mass - 1.0).abs() < 1e-9);
    assert!((10.0..=14.0).contains(&flow.largest_flow), "{flow:?}");
    // What leaves through the sink passes its face, also where it is seen there only once.
    let passed = sink.flow.as_ref().unwrap();
    assert_eq!(passed.forward, found.left as u64);
    assert!(found.left > 20);
    let of_probe = lab.table("sensor_passes.csv");
    let fruit = |name: &str| {
        let rows = of_probe.iter().filter(|row| row["sensor"] == name);
        rows.map(|row| row["fruit"].clone()).collect::<Vec<_>>()
    };
    assert_eq!(fruit("at the sink").len(), found.left);
    let here = fruit("end of the belt, with a comma").len() as u64;
    assert_eq!(here, flow.forward);
    // All that came and is not in the box any more has left.
    let space = space.space.as_ref().unwrap();
    let residence = space.residence.as_ref().unwrap();
    assert_eq!(space.entered, residence.fruit + space.inside);
    assert!((0.8..2.0).contains(&residence.median), "{residence:?}");
    let probe = probe.probe.as_ref().unwrap();
    assert!(probe.impacts >= 1, "{probe:?}");
    let hardest = probe.hardest.as_ref().unwrap();
    assert_eq!(hardest.struck.as_deref(), Some("belt"));
    // The same impact stands in events.csv.
    let peak = |row: &BTreeMap<String, String>| number(row, "peak_force_N");
    let mass = 746.0 * std::f64::consts::PI / 6.0 * 0.09_f64.powi(3);
    let events = lab.table("events.csv");
    let own = |row: &&BTreeMap<String, String>| row["fruit"] == hardest.fruit.to_string();
    let hard = events.iter().filter(own).map(peak).fold(0.0, f64::max);
    let share = hardest.peak_acceleration * mass / hard;
    // The sphere also feels friction, up to 0.3 of the normal force; the table has that alone.
    assert!((0.97..1.09_f64.sqrt()).contains(&share), "{share}");
}

const TABLES: [&str; 9] = [
    "events.csv",
    "fruit.csv",
    "scene.json",
    "sensor_boxes.csv",
    "sensor_impacts.csv",
    "sensor_passes.csv",
    "sensor_probes.csv",
    "sensors.csv",
    "sensors.svg",
];

#[test]
fn a_run_that_is_resumed_writes_the_same_bytes() {
    let lab = Lab::new("end = \"2 s\"\ncheckpoint = \"0.07 s\"", BELT);
    lab.run();
    let read = || TABLES.map(|name| std::fs::read(lab.out().join(name)).unwrap());
    let wanted = read();
    let steps = lab.run().steps;
    assert!(wanted == read());
    std::fs::remove_dir_all(lab.out()).unwrap();
    let mut start = SceneStart::Fresh;
    // In flight, in the first impact, on the belt, in the last steps.
    for share in [0.12, 0.25, 0.3, 0.55, 0.99] {
        let until = (share * steps as f64) as u64;
        let problem = lab.try_run(start, until).unwrap_err();
        assert!(problem.contains("--resume"), "{problem}");
        start = SceneStart::Resume;
    }
    // Another sensor is another scene.
    let text = std::fs::read_to_string(lab.path()).unwrap();
    std::fs::write(lab.path(), text.replace("\"0.2 ms\"", "\"0.3 ms\"")).unwrap();
    let problem = lab.try_run(start, u64::MAX).unwrap_err();
    assert!(problem.contains("changed: [[sensors]]"), "{problem}");
    // Comments are not.
    std::fs::write(lab.path(), format!("# a comment\n{text}")).unwrap();
    lab.try_run(start, u64::MAX).unwrap();
    assert!(wanted == read());
    // A scene without sensors leaves none of their files.
    let text = &text[..text.find("[[sensors]]").unwrap()];
    std::fs::write(lab.path(), text).unwrap();
    lab.run();
    for name in TABLES {
        let there = lab.out().join(name).exists();
        assert_eq!(there, !name.starts_with("sensor"), "{name}");
    }
}

#[test]
fn rejects_to_replace_a_file_of_somebody_else() {
    for name in ["sensor_passes.csv", "sensors.svg"] {
        let belt = BELT.replace("from = \"0.25 s\"", "from = \"0 s\"");
        let lab = Lab::new("end = \"0.03 s\"", &belt);
        std::fs::create_dir(lab.out()).unwrap();
        std::fs::write(lab.out().join(name), "mine").unwrap();
        let problem = lab.try_run(SceneStart::Fresh, u64::MAX).unwrap_err();
        assert!(problem.contains(name), "{problem}");
        assert_eq!(
            std::fs::read_to_string(lab.out().join(name)).unwrap(),
            "mine"
        );
        // A scene without sensors lets it be.
        let text = std::fs::read_to_string(lab.path()).unwrap();
        std::fs::write(lab.path(), &text[..text.find("[[sensors]]").unwrap()]).unwrap();
        lab.run();
        assert_eq!(
            std::fs::read_to_string(lab.out().join(name)).unwrap(),
            "mine"
        );
    }
}

#[test]
fn a_sensor_that_saw_nothing_says_so() {
    let sensors = r#"
[[sensors]]
name = "far off"
box = { low = [5, 5, 5], high = [6, 6, 6] }
interval = "10 ms"

[[sensors]]
name = "near"
box = { low = [0.02, 0.02, 0], high = [1, 1, 1] }
interval = "10 ms"

[[sensors]]
name = "above"
plane = { point = [0, 0, 7], normal = [0, 0.1, 1] }

[[sensors]]
name = "window far off"
plate = { corner = [5, 5, 5], edges = [[-1, 0, 0], [0, -1, 1]] }
"#;
    let ball = drop("[0, 0, 0.1]", "[0, 0, 0]");
    let lab = Lab::new("end = \"0.1 s\"", &(ball + FLOOR + sensors));
    let found = lab.run();
    let told: BTreeMap<bool, Vec<&str>> = found.findings.iter().fold(
        BTreeMap::new(),
        |mut told: BTreeMap<bool, Vec<&str>>, own| {
            assert_eq!(own.code, "sensor-silent");
            let outside = own.message.contains("lies outside of the walls");
            told.entry(outside).or_default().push(&own.message);
            told
        },
    );
    assert_eq!((told[&true].len(), told[&false].len()), (3, 1), "{told:?}");
    assert!(told[&false][0].contains("\"near\""));
}

#[test]
fn rejects_sensors_that_cannot_be_with_their_line() {
    let ball = drop("[0, 0, 0.5]", "[0, 0, 0]") + FLOOR;
    let plane = "plane = { point = [0, 0, 0.2], normal = [0, 0, 1] }";
    let space = "box = { low = [0, 0, 0], high = [1, 1, 1] }";
    let probe = "probe = \"ball\"\ninterval = \"1 ms\"";
    for (sensor, words) in [
        ("name = \"none\"", &["plane, plate, box or probe"][..]),
        (
            &format!("name = \"two\"\n{plane}\n{space}"),
            &["box", "it has plane already"],
        ),
        (plane, &["name"]),
        (
            "name = \"p\"\nprobe = \"bal\"\ninterval = \"1 ms\"",
            &["bal", "did you mean \"ball\"", "line"],
        ),
        (
            &format!("name = \"p\"\n{plane}\nfruit = \"balls\""),
            &["balls", "did you mean \"ball\""],
        ),
        (
            "name = \"flat\"\nplate = { corner = [0, 0, 0], edges = [[1, 0, 0], [2, 0, 0]] }",
            &["parallel", "plate edges", "[[1, 0, 0], [2, 0, 0]]"],
        ),
        (
            "name = \"flat\"\nplane = { point = [0, 0, 0], normal = [0, 0, 0] }",
            &["length"],
        ),
        (
            "name = \"b\"\ninterval = \"1 ms\"\nbox = { low = [0, 0, 1], high = [1, 1, 1] }",
            &["`low` must be below `high`"],
        ),
        (&format!("name = \"b\"\n{space}"), &["interval"]),
        (
            &format!("name = \"b\"\n{space}\ninterval = \"0 s\""),
            &["above zero", "interval"],
        ),
        (
            &format!("name = \"b\"\n{space}\ninterval = \"-1 ms\""),
            &["above zero"],
        ),
        (
            &format!("name = \"b\"\n{space}\ninterval = \"3 s\""),
            &["ends at 1 s"],
        ),
        (
            &format!("name = \"b\"\n{space}\ninterval = \"1 us\""),
            &["1 us", "shorter than the time step", "line"],
        ),
        (
            "name = \"p\"\nprobe = \"ball\"\ninterval = \"1 us\"",
            &["shorter than the time step"],
        ),
        (
            &format!("name = \"p\"\n{probe}\nfruit = \"ball\""),
            &["fruit", "leave it out"],
        ),
        (
            &format!("name = \"p\"\n{plane}\nleast_acceleration = \"9 m/s^2\""),
            &["least_acceleration", "only a probe"],
        ),
        (
            &format!("name = \"p\"\n{probe}\nleast_acceleration = \"9 kg\""),
            &["9 kg"],
        ),
        (
            &format!(
                "name = \"p\"\n{plane}\n\n[[sensors]]\nname = \"p\"\n{space}\ninterval = \"1 ms\""
            ),
            &["another sensor has this name"],
        ),
        (
            &format!("name = \"p\"\n{plane}\n{probe}"),
            &[
                "probe",
                "it has plane already",
                "write a [[sensors]] for each",
            ],
        ),
        (
            &format!("name = \"p\"\n{plane}\nintervall = \"1 ms\""),
            &["intervall", "did you mean \"interval\""],
        ),
    ] {
        let lab = Lab::new("end = \"1 s\"", &format!("{ball}\n[[sensors]]\n{sensor}\n"));
        let problem = lab.try_run(SceneStart::Fresh, u64::MAX).unwrap_err();
        for word in words.iter().chain(&["s.toml"]) {
            assert!(problem.contains(word), "{sensor} without {word}: {problem}");
        }
        assert!(!lab.out().join("events.csv").exists(), "{sensor}");
    }
    // A probe that comes too late.
    let late = ball.replace("drop = {", "drop = { from = \"2 s\",");
    let lab = Lab::new(
        "end = \"1 s\"",
        &format!("{late}\n[[sensors]]\nname = \"p\"\n{probe}\n"),
    );
    let problem = lab.try_run(SceneStart::Fresh, u64::MAX).unwrap_err();
    assert!(
        problem.contains("comes at 2 s") && problem.contains("ends at 1 s"),
        "{problem}"
    );
}

#[test]
fn closed_form_two_equal_balls_share_the_velocity_change() {
    let other = drop("[-0.1, 0, 0]", "[2, 0, 0]").replace("\"ball\"", "\"other\"");
    let sensors = "[[sensors]]\nname = \"ball\"\nprobe = \"ball\"\ninterval = \"20 us\"\n\
                   least_acceleration = \"1 m/s^2\"\n";
    let lab = Lab::new(
        "gravity = \"0 m/s^2\"\nend = \"40 ms\"\ntime_step = \"10 us\"",
        &(drop("[0, 0, 0]", "[0, 0, 0]") + &other + sensors),
    );
    lab.run();
    let (events, impacts) = (lab.table("events.csv"), lab.table("sensor_impacts.csv"));
    assert_eq!((events.len(), impacts.len()), (1, 1));
    let mass = 746.0 * std::f64::consts::PI / 6.0 * 0.08_f64.powi(3);
    // Half the mass moves: the energy kept is ¼ m v² (1 − e²).
    let kept = number(&events[0], "absorbed_energy_J");
    let restitution = (1.0 - kept / (0.25 * mass * 4.0)).sqrt();
    let change = number(&impacts[0], "velocity_change_m_s");
    let share = change / (1.0 + restitution);
    assert!((share - 1.0).abs() < 5e-3, "{change} {restitution}");
    let struck = (
        impacts[0]["struck"].as_str(),
        impacts[0]["struck_fruit"].as_str(),
    );
    assert_eq!(
        (impacts[0]["fruit"].as_str(), struck),
        ("1", ("fruit", "2"))
    );
}

#[test]
fn a_probe_has_no_part_in_the_share_of_bruised_fruit() {
    let other = drop("[-0.1, 0, 0]", "[2, 0, 0]").replace("\"ball\"", "\"other\"");
    let probe = "[[sensors]]\nname = \"ball\"\nprobe = \"ball\"\ninterval = \"1 ms\"\n";
    let bruise = "[bruise]\npredictor = \"absorbed energy\"\nthreshold = \"1 mJ\"\nsusceptibility = \"3000 mm^3/J\"\n\
                  limits = [\"1 mm^3\"]\n";
    let balls = drop("[0, 0, 0]", "[0, 0, 0]") + &other + bruise;
    for (sensor, fruit) in [("", 2), (probe, 1)] {
        let lab = Lab::new(
            "gravity = \"0 m/s^2\"\nend = \"40 ms\"\ntime_step = \"20 us\"",
            &(balls.clone() + sensor),
        );
        let bruise = lab.run().bruise.unwrap();
        // Both were struck as hard.
        assert_eq!((bruise.fruit, bruise.places[0].bruises), (fruit, fruit));
        assert!((bruise.limits[0].share - 1.0).abs() < 1e-12);
        let column = "largest_bruise_mm3";
        let rows = lab.table("fruit.csv");
        let bruised = rows.iter().filter(|own| number(own, column) > 0.0);
        assert_eq!(bruised.count(), fruit);
    }
}

#[test]
fn an_account_of_nothing_is_none() {
    let bounce = |scene: &str| {
        let lab = Lab::new(scene, &(drop("[0, 0, 0.05]", "[0.5, 0, -2]") + FLOOR));
        lab.run()
    };
    let fine = bounce("end = \"50 ms\"");
    assert!(fine.energy_closure.abs() < 1e-3, "{}", fine.energy_closure);
    assert!(fine.findings.is_empty());
    // It has not come down yet.
    let flight = bounce("end = \"1 ms\"");
    assert_eq!((flight.contacts, flight.energy.lost()), (0, 0.0));
    assert!(
        flight.energy_closure.abs() < 1e-3,
        "{}",
        flight.energy_closure
    );
    assert!(text_of_scene(&flight).contains("No energy was lost."));
    assert!(text_of_scene(&fine).contains("The energy account closes to"));
}
