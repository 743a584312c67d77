//! `windfall scene` as a user meets it.

use super::{change, scene, windfall};
use std::path::Path;

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

/// Other values than the file has: the result is that of a file with them, and says so.
#[test]
fn a_value_that_is_set_is_as_if_the_file_had_it() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let short = [("end = \"4 s\"", "end = \"0.5 s\"")];
    scene(folder, &short);
    let file = std::fs::read_to_string(folder.join("s/scene.toml")).unwrap();
    let run = |more: &[&str]| windfall(&[&["scene", "run", "s/scene.toml"], more].concat(), folder);
    let set = [
        "--set",
        "fruit.apples.count=7",
        "--set",
        "fruit.apples.diameter=60 mm",
    ];
    let (done, text, problem) = run(&[&set[..], &["--out", "set"]].concat());
    assert!(done, "{problem}");
    assert!(text.contains("changed-scene"), "{text}");
    let unchanged = std::fs::read_to_string(folder.join("s/scene.toml")).unwrap();
    assert_eq!(unchanged, file);
    let written = [
        ("count = 100", "count = 7"),
        ("diameter = \"75 mm\"", "diameter = \"60 mm\""),
    ];
    change(&folder.join("s/scene.toml"), &written);
    let (done, text, problem) = run(&["--out", "written"]);
    assert!(done && !text.contains("changed-scene"), "{text} {problem}");
    for name in ["events.csv", "fruit.csv"] {
        let [set, written] =
            ["set", "written"].map(|own| std::fs::read(folder.join(own).join(name)).unwrap());
        assert_eq!(set, written, "{name}");
    }
    for (wrong, told) in [
        ("scene.seed", "KEY=VALUE"),
        ("seed=2", "no path of a key"),
        ("fruit.aples.count=2", "apples"),
        ("fruit.apples.count=few", "count"),
        ("walls.floor.material=glass", "glass"),
        ("scene.seed=2\nend = 1", "seed"),
    ] {
        let (done, _, problem) = run(&["--set", wrong, "--out", "none"]);
        assert!(!done && problem.contains(told), "{wrong}: {problem}");
        assert!(problem.contains("--set"), "{wrong}: {problem}");
        assert!(!folder.join("none").exists(), "{wrong}");
    }
    let (done, _, problem) = run(&["--engine", "lammps", "--set", "scene.seed=2"]);
    assert!(!done && problem.contains("--set"), "{problem}");
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
    let arguments = [
        "scene",
        "run",
        "s/scene.toml",
        "--also-read",
        ".",
        "--format",
        "json",
    ];
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
            ("count = 100", "count = -3"),
            &["line", "expected a whole number, 0 or more in: count = -3"],
        ),
        (
            ("density = \"840 kg/m^3\"", "density = \"0.84 kg/m^3\""),
            &["line", "density = \"0.84 kg/m^3\"", "between 10 and 25,000"],
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

/// `[bruise]` of the template, in use.
fn with_bruises(directory: &Path) {
    let path = directory.join("s/scene.toml");
    let text = std::fs::read_to_string(&path).unwrap();
    let at = text.find("# [bruise]").unwrap();
    let bruise: Vec<&str> = text[at..]
        .lines()
        .map(|line| line.trim_start_matches("# "))
        .collect();
    std::fs::write(path, format!("{}{}\n", &text[..at], bruise.join("\n"))).unwrap();
}

#[test]
fn bruises_follow_from_the_contacts() {
    let folder = tempfile::tempdir().unwrap();
    // One fruit falls once on the conveyor, which stands still.
    scene(
        folder.path(),
        &[
            (
                "pour = { low = [-0.58, 0.02, 0.42], high = [-0.38, 0.48, 0.52], rate = \"50 Hz\" }",
                "drop = { place = [-0.3, 0.25, 0.6] }",
            ),
            ("count = 100", "count = 1"),
            ("belt = [0.5, 0, 0]", ""),
            ("end = \"4 s\"", "end = \"0.3 s\""),
        ],
    );
    with_bruises(folder.path());
    let run = || {
        let arguments = ["scene", "run", "s/scene.toml", "--format", "json"];
        let (done, json, problem) = windfall(&arguments, folder.path());
        assert!(done, "{problem}");
        let json: serde_json::Value = serde_json::from_str(&json).unwrap();
        let read = |name: &str| {
            std::fs::read_to_string(folder.path().join("s/scene.run").join(name)).unwrap()
        };
        (json, read("events.csv"), read("fruit.csv"))
    };
    let (json, events, fruit) = run();
    let cell = |text: &str, line: usize, name: &str| -> f64 {
        let place = text
            .lines()
            .next()
            .unwrap()
            .split(',')
            .position(|own| own == name)
            .unwrap();
        text.lines()
            .nth(line)
            .unwrap()
            .split(',')
            .nth(place)
            .unwrap()
            .parse()
            .unwrap()
    };
    let energy = cell(&events, 1, "absorbed_energy_J");
    let volume = 3000.0 * (energy - 0.05);
    assert!(volume > 500.0, "{volume}");
    assert!((cell(&fruit, 1, "largest_bruise_mm3") / volume - 1.0).abs() < 1e-12);
    // All of one fruit: by Jeffreys that is not certain.
    let limits = json["bruise"]["limits"].as_array().unwrap();
    for limit in limits {
        assert_eq!(limit["share"], 1.0);
        let low = limit["interval"][0].as_f64().unwrap();
        assert!((0.05..0.9).contains(&low), "{low}");
    }
    assert_eq!(json["bruise"]["places"][0]["name"], "conveyor");
    let (done, text, _) = windfall(&["scene", "run", "s/scene.toml"], folder.path());
    assert!(
        done && text.contains("bruised by") && text.contains("largest bruise above"),
        "{text}"
    );

    // Where the steel takes a part of the energy the bruise is smaller.
    let path = folder.path().join("s/scene.toml");
    let text = std::fs::read_to_string(&path).unwrap();
    let steel = "effective_radius = \"37.5 mm\"";
    std::fs::write(
        &path,
        text.replace(steel, &format!("{steel}\nfruit_share = 0.7")),
    )
    .unwrap();
    let volume = 3000.0 * (0.7 * energy - 0.05);
    assert!((cell(&run().2, 1, "largest_bruise_mm3") / volume - 1.0).abs() < 1e-12);

    for (old, new, words) in [
        ("fruit_share = 0.7", "fruit_share = 1.7", "between 0 and 1"),
        ("threshold = \"50 mJ\"", "threshold = \"50 N\"", "50 N"),
        ("susceptibility = \"3000 mm^3/J\"\n", "", "susceptibility"),
        (
            "predictor = \"absorbed energy\"",
            "predictor = \"energy\"",
            "peak force",
        ),
        (
            "limits = [\"100 mm^3\", \"500 mm^3\"]",
            "limits = []",
            "limits",
        ),
        (
            "threshold_sd = \"10 mJ\"",
            "threshold_sd = \"-10 mJ\"",
            "must not be below zero",
        ),
    ] {
        let path = folder.path().join("s/scene.toml");
        let text = std::fs::read_to_string(&path).unwrap();
        assert!(text.contains(old), "{old}");
        std::fs::write(&path, text.replace(old, new)).unwrap();
        let (done, _, problem) = windfall(&["scene", "run", "s/scene.toml"], folder.path());
        assert!(!done && problem.contains(words), "{new}: {problem}");
        std::fs::write(&path, text).unwrap();
    }
}

#[test]
fn ovate_fruit_run_and_short_ones_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let ovate = "diameter = \"75 mm\"\nlength = \"95 mm\"\nspheres = 7";
    let changes = [
        ("diameter = \"75 mm\"", ovate),
        ("count = 100", "count = 12"),
        ("end = \"4 s\"", "end = \"1 s\""),
    ];
    scene(folder.path(), &changes);
    let (done, json, problem) = windfall(
        &["scene", "run", "s/scene.toml", "--format", "json"],
        folder.path(),
    );
    assert!(done, "{problem}");
    let json: serde_json::Value = serde_json::from_str(&json).unwrap();
    assert!(json["contacts"].as_u64().unwrap() > 10);
    assert!(
        json["energy_closure"].as_f64().unwrap().abs() < 1e-3,
        "{json}"
    );
    for (length, says) in [
        ("length = \"70 mm\"", "an ovate fruit is longer than thick"),
        ("length = \"95 mm\"\nspheres = 1", "2 to 99 spheres"),
        ("spheres = 5", "give its length too"),
    ] {
        let with = format!("diameter = \"75 mm\"\n{length}");
        let problem = refused(&[("diameter = \"75 mm\"", &with)]);
        assert!(
            problem.contains(says) && problem.contains("line"),
            "{problem}"
        );
    }
}
