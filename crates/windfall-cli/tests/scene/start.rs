//! Scenes that begin where another run ended.

use super::{change, scene, windfall};
use std::path::Path;

/// Runs a scene in s/ and returns what it says.
fn run(directory: &Path, name: &str) -> Result<serde_json::Value, String> {
    let file = format!("s/{name}.toml");
    let (done, json, problem) = windfall(&["scene", "run", &file, "--format", "json"], directory);
    assert!(!problem.contains("panicked"), "{problem}");
    match done {
        true => Ok(serde_json::from_str(&json).unwrap()),
        false => Err(problem),
    }
}

/// A scene of s/ with changes, under another name.
fn copy(directory: &Path, [from, name]: [&str; 2], changes: &[(&str, &str)]) {
    let path = |name: &str| directory.join(format!("s/{name}.toml"));
    std::fs::copy(path(from), path(name)).unwrap();
    change(&path(name), changes);
}

/// Rows of a table of a run, without the comments.
fn rows(directory: &Path, name: &str, table: &str) -> Vec<Vec<String>> {
    let path = directory.join(format!("s/{name}.run/{table}"));
    let text = std::fs::read_to_string(path).unwrap();
    let rows = text.lines().filter(|own| !own.starts_with('#')).skip(1);
    rows.map(|own| own.split(',').map(str::to_owned).collect())
        .collect()
}

/// A filled scene: 12 fruit that lie or roll after 0.8 s, of which some have left.
fn filled(directory: &Path) {
    scene(
        directory,
        &[
            ("count = 100", "count = 12"),
            ("end = \"4 s\"", "end = \"0.8 s\""),
            ("rate = \"50 Hz\"", "rate = \"14 Hz\""),
            ("time_step = \"auto\"", "time_step = \"100 us\""),
        ],
    );
    let sink = "\n[[sinks]]\nname = \"edge\"\nlow = [-0.2, 0, 0.2]\nhigh = [0, 0.5, 0.5]\n";
    let path = directory.join("s/scene.toml");
    let text = std::fs::read_to_string(&path).unwrap();
    std::fs::write(&path, text + sink).unwrap();
    run(directory, "scene").unwrap();
}

const GOES_ON: (&str, &str) = ("end = \"0.8 s\"", "end = \"1.3 s\"\nstart = \"scene.run\"");

#[test]
fn two_runs_in_a_row_are_one() {
    let folder = tempfile::tempdir().unwrap();
    let directory = folder.path();
    filled(directory);
    copy(directory, ["scene", "on"], &[GOES_ON]);
    let on = run(directory, "on").unwrap();
    copy(
        directory,
        ["scene", "whole"],
        &[("end = \"0.8 s\"", "end = \"1.3 s\"")],
    );
    let whole = run(directory, "whole").unwrap();
    // Places and times to the last bit; what left before the start, too.
    let places = |name: &str| -> Vec<Vec<String>> {
        let rows = rows(directory, name, "fruit.csv").into_iter();
        rows.map(|own| own[..10].to_vec()).collect()
    };
    assert_eq!(places("on"), places("whole"));
    assert_eq!(on["left"], whole["left"]);
    assert!(on["left"].as_u64().unwrap() > 0);
    assert!((on["start"].as_f64().unwrap() - 0.8).abs() < 2e-4);
    assert!(whole["start"].is_null());
    let steps = |of: &serde_json::Value| of["steps"].as_u64().unwrap();
    let first = run(directory, "scene").unwrap();
    assert!(steps(&first) + steps(&on) <= steps(&whole));
    assert!(steps(&first) + steps(&on) + 2 >= steps(&whole));
    assert!(on["energy_closure"].as_f64().unwrap().abs() < 1e-3);
    // Loads that began after the start are those of the whole run.
    let later = |name: &str| -> Vec<Vec<String>> {
        let rows = rows(directory, name, "events.csv").into_iter();
        rows.filter(|own| own[3].parse::<f64>().unwrap() > 0.81)
            .collect()
    };
    assert!(later("on").len() > 5);
    assert_eq!(later("on"), later("whole"));
    // A run that was started can be started from, and frames begin with it.
    copy(
        directory,
        ["on", "further"],
        &[("1.3 s", "1.4 s"), ("scene.run", "on.run")],
    );
    let further = run(directory, "further").unwrap();
    assert!(further["start"].as_f64().unwrap() > 1.29);
    let arguments = ["scene", "picture", "s/further.run", "--time", "1.35"];
    let (done, _, problem) = windfall(&arguments, directory);
    assert!(done, "{problem}");
}

#[test]
fn a_filled_bin_is_tipped_with_another_step() {
    let folder = tempfile::tempdir().unwrap();
    let directory = folder.path();
    filled(directory);
    let floor = "\n[[moves]]\nname = \"tip\"\nwalls = [\"conveyor\"]\nfrom = \"0.85 s\"\n\
                 until = \"1.2 s\"\nrotation = { point = [-0.6, 0, 0.3], axis = [0, 1, 0], angle = \
                 \"80 deg\" }\n";
    copy(directory, ["scene", "tip"], &[GOES_ON]);
    let path = directory.join("s/tip.toml");
    let text = std::fs::read_to_string(&path).unwrap();
    let text = text.replace("time_step = \"100 us\"", "time_step = \"70 us\"");
    std::fs::write(&path, text + floor).unwrap();
    let json = run(directory, "tip").unwrap();
    let step = json["step"]["time_step"].as_f64().unwrap();
    let start = json["start"].as_f64().unwrap();
    assert!(step <= 70e-6 && step > 69e-6, "{step}");
    assert!((start / step - (start / step).round()).abs() < 1e-6);
    assert!(json["energy_closure"].as_f64().unwrap().abs() < 5e-3);
    // Those that lay on the conveyor have slid off it.
    let height = |name: &str| -> Vec<f64> {
        let rows = rows(directory, name, "fruit.csv").into_iter();
        rows.filter_map(|own| own[9].parse().ok()).collect()
    };
    let high = |name: &str| height(name).iter().filter(|z| **z > 0.32).count();
    assert!(high("scene") > 3, "{:?}", height("scene"));
    assert!(high("tip") < high("scene"), "{:?}", height("tip"));
}

#[test]
fn rejects_starts_that_do_not_fit_with_the_line() {
    let folder = tempfile::tempdir().unwrap();
    let directory = folder.path();
    filled(directory);
    let vibration = (
        "belt = [0.5, 0, 0]\n\n",
        "belt = [0.5, 0, 0]\nvelocity = [0, 0, 0.01]\n\n",
    );
    for (changes, words) in [
        (
            vec![("count = 12", "count = 13")],
            "different there: [[fruit]] or the seed",
        ),
        (
            vec![("seed = 1 ", "seed = 2 ")],
            "different there: [[fruit]] or the seed",
        ),
        (
            vec![(
                "edges = [[0.6, 0, 0], [0, 0.5, 0]] }\nbelt",
                "edges = [[0.61, 0, 0], [0, 0.5, 0]] }\nbelt",
            )],
            "different there: wall \"conveyor\"",
        ),
        (
            vec![("rolling = 0.02", "rolling = 0.03")],
            "different there: contacts of apple and foam",
        ),
        (vec![vibration], "wall \"conveyor\" is elsewhere at 0.8"),
        (vec![("1.3 s", "0.7 s")], "give a later end"),
        (vec![("scene.run", "other.run")], "holds no end of a run"),
    ] {
        let mut all = vec![GOES_ON];
        all.extend(changes);
        copy(directory, ["scene", "on"], &all);
        let problem = run(directory, "on").unwrap_err();
        assert!(problem.contains(words), "{all:?}: {problem}");
        assert!(problem.contains("on.toml, line "), "{problem}");
        assert!(!directory.join("s/on.run/events.csv").exists());
    }
    // A run elsewhere.
    std::fs::create_dir(directory.join("other")).unwrap();
    let end = "scene.run/end.bin";
    std::fs::create_dir(directory.join("other/scene.run")).unwrap();
    std::fs::copy(
        directory.join("s").join(end),
        directory.join("other").join(end),
    )
    .unwrap();
    copy(
        directory,
        ["scene", "on"],
        &[GOES_ON, ("scene.run", "../other/scene.run")],
    );
    let problem = run(directory, "on").unwrap_err();
    assert!(
        problem.contains("start = \"../other/scene.run\""),
        "{problem}"
    );
    // Its own directory, another engine, a damaged file.
    copy(directory, ["scene", "on"], &[GOES_ON]);
    let arguments = ["scene", "run", "s/on.toml", "--out", "s/scene.run"];
    let (done, _, problem) = windfall(&arguments, directory);
    assert!(
        !done && problem.contains("write them elsewhere"),
        "{problem}"
    );
    let arguments = ["scene", "export", "s/on.toml", "--engine", "lammps"];
    let (done, _, problem) = windfall(&arguments, directory);
    assert!(!done && problem.contains("[scene] start"), "{problem}");
    let path = directory.join("s/scene.run/end.bin");
    let whole = std::fs::read(&path).unwrap();
    for (bytes, words) in [
        (whole[..whole.len() / 2].to_vec(), "damaged"),
        (b"mine".to_vec(), "ends early or is none"),
        (Vec::new(), "ends early or is none"),
    ] {
        std::fs::write(&path, &bytes).unwrap();
        let problem = run(directory, "on").unwrap_err();
        assert!(
            problem.contains(words) && problem.contains("Run that scene again"),
            "{problem}"
        );
        assert!(!problem.contains("--restart"), "{problem}");
    }
    // A file of that name that is the user's own stays.
    std::fs::write(&path, b"mine").unwrap();
    let problem = run(directory, "scene").unwrap_err();
    assert!(problem.contains("end.bin"), "{problem}");
    assert_eq!(std::fs::read(&path).unwrap(), b"mine");
    // Without states none is left of an earlier run.
    std::fs::write(&path, &whole).unwrap();
    change(
        &directory.join("s/scene.toml"),
        &[("# checkpoint = \"0.5 s\" ", "checkpoint = \"never\" ")],
    );
    run(directory, "scene").unwrap();
    assert!(!path.exists());
}

#[test]
fn files_of_others_stay_where_this_scene_has_none_even_by_force() {
    let folder = tempfile::tempdir().unwrap();
    let directory = folder.path();
    scene(
        directory,
        &[
            ("count = 100", "count = 1"),
            ("end = \"4 s\"", "end = \"0.02 s\""),
            ("frames = \"20 ms\"", "# none"),
        ],
    );
    run(directory, "scene").unwrap();
    for name in ["sensor_passes.csv", "sensors.svg", "frames.bin"] {
        let path = directory.join("s/scene.run").join(name);
        std::fs::write(&path, "mine").unwrap();
        let (done, _, problem) = windfall(&["scene", "run", "s/scene.toml", "--force"], directory);
        assert!(done, "{problem}");
        assert_eq!(std::fs::read_to_string(&path).unwrap(), "mine");
    }
}
