//! Scenes that repeat along an axis.

use super::{change, windfall};
use serde_json::Value;
use std::path::Path;

/// One fruit that lies on a belt and one far above it, in a piece of 0.6 m of the belt.
const BELT: &str = r#"format = 1
materials = ["apple", "rubber"]
[scene]
title = "A piece of a belt"
periodic = { x = [0, 0.6] }
time_step = "50 us"
end = "2 s"
[[contacts]]
between = ["apple", "apple"]
law = "kuwabara-kono(k=753599, c=1524)"
friction = 0.3
[[contacts]]
between = ["apple", "rubber"]
law = "kelvin-voigt(k=6000, c=25)"
friction = 0.5
[[fruit]]
material = "apple"
count = 1
diameter = "80 mm"
density = "840 kg/m^3"
drop = { place = [0.5, 0, 0.0397], velocity = [1.5, 0, 0] }
[[walls]]
name = "belt"
material = "rubber"
plate = { corner = [0, -0.2, 0], edges = [[0.6, 0, 0], [0, 0.4, 0]] }
belt = [1.5, 0, 0]
[[sensors]]
name = "end"
plane = { point = [0.6, 0, 0], normal = [1, 0, 0] }
[[sensors]]
name = "start"
plane = { point = [0, 0, 0], normal = [1, 0, 0] }
[[sensors]]
name = "gate"
plate = { corner = [-0.1, -0.1, 0], edges = [[0, 0.2, 0], [0, 0, 0.2]] }
[[sensors]]
name = "all of it"
box = { low = [0, -0.2, 0], high = [0.6, 0.2, 0.3] }
interval = "100 ms"
[[sensors]]
name = "over the end"
box = { low = [0.5, -0.2, 0], high = [0.7, 0.2, 0.3] }
interval = "100 ms"
[record]
frames = "50 ms"
"#;

fn written(directory: &Path, changes: &[(&str, &str)]) {
    let path = directory.join("belt.toml");
    std::fs::write(&path, BELT).unwrap();
    change(&path, changes);
}

fn run(directory: &Path) -> Value {
    let arguments = ["scene", "run", "belt.toml", "--format", "json"];
    let (done, json, problem) = windfall(&arguments, directory);
    assert!(done, "{problem}");
    serde_json::from_str(&json).unwrap()
}

fn sensor(own: &Value, name: &str) -> Value {
    let all = own["sensors"].as_array().unwrap();
    all.iter().find(|own| own["name"] == name).unwrap().clone()
}

/// 0.5 m + 1.5 m/s · 2 s = 3.5 m: five ends, at 0.6 to 3.0 m, and five gates, at 0.5 m and every
/// 0.6 m on but for the first, where it begins.
#[test]
fn a_fruit_that_goes_round_is_seen_once_at_each_turn() {
    let folder = tempfile::tempdir().unwrap();
    let directory = folder.path();
    written(directory, &[("place = [0.5,", "place = [0.49,")]);
    let own = run(directory);
    for (name, first, count) in [("end", 0.11, 5), ("start", 0.11, 5), ("gate", 0.01, 5)] {
        let flow = &sensor(&own, name)["flow"];
        assert_eq!(flow["forward"], count, "{name} {flow}");
        assert_eq!(flow["backward"], 0, "{name} {flow}");
        let time = flow["first"].as_f64().unwrap();
        assert!((time - first / 1.5).abs() < 1e-4, "{name} {time}");
        let rate = flow["mean_flow"].as_f64().unwrap();
        assert!((rate / (1.5 / 0.6) - 1.0).abs() < 1e-4, "{name} {rate}");
    }
    let space = &sensor(&own, "all of it")["space"];
    assert_eq!(
        (&space["inside"], &space["entered"]),
        (&1.into(), &1.into())
    );
    assert!(space["residence"].is_null(), "{space}");
    // It goes in and out: at 3.49 m, 0.49 m of its sixth turn, it is out.
    let space = &sensor(&own, "over the end")["space"];
    assert_eq!(
        (&space["inside"], &space["entered"]),
        (&0.into(), &1.into())
    );
    // From 0.5 m first to 3.1 m last.
    let stays = space["residence"]["largest"].as_f64().unwrap();
    assert!((stays - 2.6 / 1.5).abs() < 1e-3, "{space}");
    // No load ends at an end, and the account closes.
    let rows = std::fs::read_to_string(directory.join("belt.run/events.csv")).unwrap();
    assert!(rows.lines().count() < 5, "{rows}");
    let passes = std::fs::read_to_string(directory.join("belt.run/sensor_passes.csv")).unwrap();
    assert_eq!(
        passes.lines().filter(|own| !own.starts_with('#')).count(),
        16
    );
    assert!(own["energy_closure"].as_f64().unwrap().abs() < 0.01);
    let (done, _, problem) = windfall(&["scene", "picture", "belt.toml"], directory);
    assert!(done, "{problem}");
}

#[test]
fn rejects_what_cannot_repeat() {
    let folder = tempfile::tempdir().unwrap();
    let directory = folder.path();
    let lattice = "lattice = { low = [-0.1, -0.2, 0.1], high = [0.6, 0.2, 0.3] }";
    let drop = "drop = { place = [0.5, 0, 0.0397], velocity = [1.5, 0, 0] }";
    for (old, new, line, told) in [
        (
            "{ x = [0, 0.6] }",
            "{ x = [0.6, 0] }",
            5,
            "the lower one first",
        ),
        (
            "{ x = [0, 0.6] }",
            "{ x = [0, inf] }",
            5,
            "expected a number below 1e100",
        ),
        (
            "{ x = [0, 0.6] }",
            "{ x = [0, 0.2] }",
            5,
            "three times the diameter",
        ),
        ("{ x = [0, 0.6] }", "{}", 5, "it names no axis"),
        (
            "{ x = [0, 0.6] }",
            "{ u = [0, 0.6] }",
            5,
            "there is no key \"u\" here; known keys: x, y, z",
        ),
        ("{ x = [0, 0.6] }", "{ x = [0, 0.6], z = [0, 1] }", 0, ""),
        (
            "belt = [1.5, 0, 0]",
            "velocity = [0.1, 0, 0]",
            22,
            "\"belt\" cannot be repeated along x: it moves along this axis without end",
        ),
        (
            "belt = [1.5, 0, 0]",
            "rotation = { point = [0, 0, 0], axis = [0, 1, 0], angular_velocity = \"1 rad/s\" }",
            22,
            "it turns about an axis that is not parallel",
        ),
        (
            "plate = { corner = [0, -0.2, 0], edges = [[0.6, 0, 0], [0, 0.4, 0]] }",
            "plane = { point = [0, 0, 0], normal = [-0.1, 0, 1] }",
            22,
            "tilt `gravity` instead",
        ),
        (
            "edges = [[0.6, 0, 0]",
            "edges = [[1e6, 1, 0]",
            22,
            "longer than a hundred periods",
        ),
        (drop, lattice, 21, "it would overlap itself"),
        (
            "high = [0.7,",
            "high = [1.7,",
            42,
            "which repeats after 0.6 m",
        ),
    ] {
        written(directory, &[(old, new)]);
        let (done, _, problem) = windfall(&["scene", "run", "belt.toml"], directory);
        assert_eq!(done, told.is_empty(), "{new}: {problem}");
        let place = format!("line {line}");
        assert!(done || problem.contains(&place), "{new}: {problem}");
        assert!(problem.contains(told), "{new}: {problem}");
    }
}

/// Other engines, and scenes that begin at the end of one with other ends.
#[test]
fn rejects_engines_and_other_ends() {
    let folder = tempfile::tempdir().unwrap();
    let directory = folder.path();
    written(directory, &[]);
    for engine in ["lammps", "liggghts"] {
        for command in [
            vec!["scene", "run", "belt.toml", "--engine", engine],
            vec!["scene", "export", "belt.toml", "--engine", engine],
        ] {
            let (done, _, problem) = windfall(&command, directory);
            assert!(!done && problem.contains("[scene] periodic"), "{problem}");
            assert!(problem.contains("--engine windfall"), "{problem}");
        }
    }
    run(directory);
    let path = directory.join("on.toml");
    for (ends, wanted) in [
        ("[0, 0.6]", true),
        ("[0, 0.7]", false),
        ("[-0.1, 0.5]", false),
    ] {
        std::fs::copy(directory.join("belt.toml"), &path).unwrap();
        let periodic = format!("start = \"belt.run\"\nperiodic = {{ x = {ends} }}");
        let changes = [
            ("end = \"2 s\"", "end = \"2.1 s\""),
            ("periodic = { x = [0, 0.6] }", &periodic),
        ];
        change(&path, &changes);
        let (done, _, problem) = windfall(&["scene", "run", "on.toml"], directory);
        assert_eq!(done, wanted, "{problem}");
        assert!(done || problem.contains("periodic of [scene]"), "{problem}");
    }
}

/// Frames tell after which length the scene repeats, and show its walls once.
#[test]
fn frames_tell_the_period_and_show_walls_once() {
    let folder = tempfile::tempdir().unwrap();
    let directory = folder.path();
    written(directory, &[]);
    run(directory);
    let frames = std::fs::read(directory.join("belt.run/frames.bin")).unwrap();
    let head = String::from_utf8_lossy(&frames[16..2000]);
    assert!(head.contains("\"periods\":[0.6,0.0,0.0]"), "{head}");
    let (done, _, problem) = windfall(&["scene", "vtk", "belt.toml", "--out", "vtk"], directory);
    assert!(done, "{problem}");
    let walls = std::fs::read_to_string(directory.join("vtk/walls.vtp")).unwrap();
    assert!(walls.contains("NumberOfPoints=\"4\""), "{walls}");
}

#[test]
fn a_belt_that_is_too_short_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let told = |changes: &[(&str, &str)]| {
        let _ = std::fs::remove_dir_all(folder.path().join("belt.run"));
        written(folder.path(), changes);
        let findings = run(folder.path())["findings"].clone();
        let mut all = findings.as_array().unwrap().iter();
        all.find(|own| own["code"] == "fell-out").cloned()
    };
    assert_eq!(told(&[]), None);
    // It drives off the end at once, and falls from there.
    let found = told(&[("x = [0, 0.6]", "x = [0, 3]")]).unwrap();
    let message = found["message"].as_str().unwrap();
    assert!(
        message.starts_with("1 fruit fell past every wall and sink"),
        "{message}"
    );
    // What has been let fall for too short a time is still above.
    assert_eq!(
        told(&[("x = [0, 0.6]", "x = [0, 3]"), ("2 s", "0.1 s")]),
        None
    );
}
