//! `windfall scene` as a user meets it.
#![allow(clippy::unwrap_used)]

use assert_cmd::Command;
use std::path::Path;

fn windfall(arguments: &[&str], directory: &Path) -> (bool, String, String) {
    let output = Command::cargo_bin("windfall")
        .unwrap()
        .args(arguments)
        .current_dir(directory)
        .output()
        .unwrap();
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    (
        output.status.success(),
        text(&output.stdout),
        text(&output.stderr),
    )
}

/// The template, with some of its text replaced.
fn scene(directory: &Path, changes: &[(&str, &str)]) {
    let (done, _, problem) = windfall(&["new", "scene", "s"], directory);
    assert!(done, "{problem}");
    let path = directory.join("s/scene.toml");
    let mut text = std::fs::read_to_string(&path).unwrap();
    for (old, new) in changes {
        assert!(text.contains(old), "{old}");
        text = text.replace(old, new);
    }
    std::fs::write(path, text).unwrap();
}

/// What the program says of a scene that it refuses.
fn refused(changes: &[(&str, &str)]) -> String {
    let folder = tempfile::tempdir().unwrap();
    scene(folder.path(), changes);
    let (done, _, problem) = windfall(&["scene", "run", "s/scene.toml"], folder.path());
    assert!(!done, "{changes:?}");
    let left = folder.path().join("s/scene.run/events.csv");
    assert!(!left.exists(), "{changes:?} left a table");
    problem
}

#[test]
fn every_fruit_of_the_template_is_accounted_for() {
    let folder = tempfile::tempdir().unwrap();
    scene(folder.path(), &[("end = \"4 s\"", "end = \"1.5 s\"")]);
    let run = |threads: &str, out: &str| {
        let arguments = [
            "scene",
            "run",
            "s/scene.toml",
            "--threads",
            threads,
            "--out",
            out,
            "--format",
            "json",
        ];
        let (done, json, problem) = windfall(&arguments, folder.path());
        assert!(done, "{problem}");
        let json: serde_json::Value = serde_json::from_str(&json).unwrap();
        let read =
            |name: &str| std::fs::read_to_string(folder.path().join(out).join(name)).unwrap();
        (json, read("events.csv"), read("fruit.csv"))
    };
    let (json, events, fruit) = run("1", "one");
    assert_eq!(fruit.lines().count(), 101);
    let written = json["written"].as_u64().unwrap();
    assert_eq!(events.lines().count() as u64, written + 1);
    assert!(written > 100 && json["contacts"].as_u64().unwrap() >= written);
    assert!(json["energy_closure"].as_f64().unwrap().abs() < 1e-3);
    assert!(json["step"]["peak_force_error"].as_f64().unwrap() <= 2e-3);
    // Every contact of the largest peak force of a fruit stands in events.csv.
    let column = |line: &str, at: usize| line.split(',').nth(at).unwrap().to_owned();
    let hardest: Vec<String> = fruit.lines().skip(1).map(|line| column(line, 11)).collect();
    let peaks: std::collections::BTreeSet<String> = events
        .lines()
        .skip(1)
        .map(|line| column(line, 17))
        .collect();
    for peak in hardest
        .iter()
        .filter(|peak| peak.parse::<f64>().is_ok_and(|peak| peak >= 0.5))
    {
        assert!(peaks.contains(peak), "{peak}");
    }
    // The same on two threads, to the last digit.
    let (_, other_events, other_fruit) = run("2", "two");
    assert!(events == other_events && fruit == other_fruit);
}

#[test]
fn a_law_card_brings_its_spread_and_its_range() {
    let folder = tempfile::tempdir().unwrap();
    let made = [
        "simulate",
        "pendulum",
        "--law",
        "kuwabara-kono(k=753599, c=1524)",
        "--recordings",
        "apples",
        "--specimens",
        "8",
        "--spread",
        "k=133165",
        "--spread",
        "c=263",
    ];
    assert!(windfall(&made, folder.path()).0);
    let (done, _, problem) = windfall(&["fit", "apples", "--card", "apple.toml"], folder.path());
    assert!(done, "{problem}");
    let law = "law = \"kuwabara-kono(k=1065750, c=2155)\"";
    scene(
        folder.path(),
        &[
            (law, "card = \"../apple.toml\""),
            ("end = \"4 s\"", "end = \"1 s\""),
        ],
    );
    let arguments = ["scene", "run", "s/scene.toml", "--format", "json"];
    let (done, json, problem) = windfall(&arguments, folder.path());
    assert!(done, "{problem}");
    let json: serde_json::Value = serde_json::from_str(&json).unwrap();
    // The pendulum strikes at 0.39 m/s, fruit fall on the conveyor faster.
    let codes: Vec<&str> = json["findings"]
        .as_array()
        .unwrap()
        .iter()
        .map(|own| own["code"].as_str().unwrap())
        .collect();
    assert!(codes.contains(&"law-range"), "{codes:?}");
}

#[test]
fn rejects_scenes_that_cannot_be_with_their_line() {
    for (changes, words) in [
        (
            ("material = \"foam\"", "material = \"foan\""),
            &["foan", "did you mean \"foam\"", "line"][..],
        ),
        (
            (
                "between = [\"apple\", \"foam\"]",
                "between = [\"steel\", \"foam\"]",
            ),
            &["apple and foam"],
        ),
        (
            (
                "open = [\"top\", \"bottom\"]",
                "open = [\"top\", \"botom\"]",
            ),
            &["botom", "did you mean \"bottom\""],
        ),
        (
            (
                "edges = [[0.6, 0, 0], [0, 0.5, 0]] }\nbelt",
                "edges = [[0.6, 0, 0], [0.3, 0, 0]] }\nbelt",
            ),
            &["parallel"],
        ),
        (
            ("diameter = \"75 mm\"", "diameter = \"75 kg\""),
            &["75 kg", "line"],
        ),
        (
            ("rolling = 0.02", "roling = 0.02"),
            &["roling", "did you mean \"rolling\""],
        ),
        (("friction = 0.5", "friction = -0.5"), &["friction", "-0.5"]),
        (
            (
                "law = \"kelvin-voigt(k=6000, c=25)\"",
                "law = \"kelvin-voight(k=6000)\"",
            ),
            &["kelvin-voigt"],
        ),
        (
            (
                "pour = {",
                "lattice = { low = [0, 0, 0], high = [1, 1, 1] }\npour = {",
            ),
            &["lattice, pour, drop or tree"],
        ),
        (("end = \"4 s\"\n", ""), &["end"]),
        (("format = 1\nmaterials", "format = 7\nmaterials"), &["7"]),
        (
            (
                "low = [-0.58, 0.02, 0.42], high = [-0.38, 0.48, 0.52]",
                "low = [-0.5, 0.2, 0.4], high = [-0.45, 0.3, 0.5]",
            ),
            &["must fit"],
        ),
        (
            ("time_step = \"auto\"", "time_step = \"20 ms\""),
            &["shorter time step"],
        ),
    ] {
        let problem = refused(&[changes]);
        for word in words {
            assert!(
                problem.contains(word),
                "{changes:?} without {word}: {problem}"
            );
        }
        assert!(!problem.contains("panicked"), "{problem}");
    }
}

#[test]
fn rejects_files_that_are_not_there() {
    let folder = tempfile::tempdir().unwrap();
    let (done, _, problem) = windfall(&["scene", "run", "none.toml"], folder.path());
    assert!(
        !done && problem.contains("none.toml") && problem.contains("windfall new scene"),
        "{problem}"
    );
    let changes = [(
        "law = \"kelvin-voigt(k=6000, c=25)\"",
        "card = \"foam.toml\"",
    )];
    assert!(refused(&changes).contains("foam.toml"));
}
