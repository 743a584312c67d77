//! `windfall scene run --engine` and `windfall scene export`, with LAMMPS and LIGGGHTS
//! themselves: the test command installs them.

use super::{said, windfall, windfall_command};
use std::collections::BTreeMap;
use std::os::unix::fs::PermissionsExt;
use std::path::Path;
use windfall_files::written::LIST;

fn with_path(arguments: &[&str], directory: &Path, path: &str) -> (bool, String, String) {
    let mut command = windfall_command(arguments, directory);
    command.env("PATH", path);
    said(command)
}

/// Fruit that come one by one, each on its own place, and two pairs that collide in the air
/// where two ranks meet; a floor, a pad that vibrates, a tilted plate, a tube, a sink.
pub(super) const IMPACTS: &str = r#"format = 1
materials = ["apple", "steel", "foam"]
[scene]
title = "Impacts, one by one"
seed = 1
time_step = "20 us"
end = "0.4 s"
[[contacts]]
between = ["apple", "apple"]
law = "kuwabara-kono(k=753599, c=1524)"
effective_radius = "18.75 mm"
annuli = 1
friction = 0.3
rolling = 0.01
[[contacts]]
between = ["apple", "steel"]
law = "kuwabara-kono(k=1065750, c=2155)"
effective_radius = "37.5 mm"
annuli = 1
friction = 0.3
[[contacts]]
between = ["apple", "foam"]
law = "kelvin-voigt(k=6000, c=25)"
annuli = 1
friction = 0.5
[[fruit]]
material = "apple"
count = 1
diameter = "75 mm"
density = "840 kg/m^3"
drop = { place = [-0.5, 0, 0.2], velocity = [0.3, 0, -0.5] }
[[fruit]]
material = "apple"
count = 2
diameter = "75 mm"
diameter_sd = "2 mm"
density = "840 kg/m^3"
drop = { place = [0.2, 0, 0.3], interval = "0.2 s", velocity = [0, 0, -1] }
[[fruit]]
material = "apple"
count = 1
diameter = "70 mm"
density = "840 kg/m^3"
drop = { place = [0.6, 0, 0.4] }
[[fruit]]
material = "apple"
count = 1
diameter = "75 mm"
density = "840 kg/m^3"
drop = { place = [-0.05, 0.5, 0.6], velocity = [0.5, 0, 0] }
[[fruit]]
material = "apple"
count = 1
diameter = "75 mm"
density = "840 kg/m^3"
drop = { place = [0.05, 0.5, 0.61], velocity = [-0.5, 0, 0] }
[[fruit]]
material = "apple"
count = 1
diameter = "75 mm"
density = "840 kg/m^3"
drop = { place = [1.2, 0, 0.3], from = "0.05 s" }
[[walls]]
name = "floor"
material = "steel"
plate = { corner = [-1, -0.3, 0], edges = [[1, 0, 0], [0, 0.6, 0]] }
[[walls]]
name = "pad"
material = "foam"
plate = { corner = [0, -0.3, 0.05], edges = [[0.4, 0, 0], [0, 0.6, 0]] }
vibration = { amplitude = [0, 0, 0.002], frequency = "20 Hz" }
[[walls]]
name = "slope"
material = "steel"
plate = { corner = [0.45, -0.3, 0.2], edges = [[0.4, 0, -0.15], [0, 0.6, 0]] }
[[sinks]]
name = "end"
low = [1, -0.3, -1]
high = [1.4, 0.3, 0.1]
"#;

/// What a fruit went through: partner, time, impact speed, peak force, absorbed energy, depth.
pub(super) type Contact = (String, [f64; 5]);

pub(super) fn contacts(directory: &Path, out: &str) -> BTreeMap<String, Vec<Contact>> {
    let text = std::fs::read_to_string(directory.join(out).join("events.csv")).unwrap();
    let mut lines = text.lines();
    let names: Vec<&str> = lines.next().unwrap().split(',').collect();
    let mut all: BTreeMap<String, Vec<Contact>> = BTreeMap::new();
    for line in lines {
        let cells: Vec<&str> = line.split(',').collect();
        let cell = |name: &str| cells[names.iter().position(|own| *own == name).unwrap()];
        let numbers = [
            "time_s",
            "normal_speed_m_s",
            "peak_force_N",
            "absorbed_energy_J",
            "largest_displacement_m",
        ];
        let numbers = numbers.map(|name| cell(name).parse::<f64>().unwrap());
        let (name, fruit, load) = (cell("partner"), cell("partner_fruit"), cell("load"));
        let partner = format!("{name} {fruit} load {load}");
        if numbers[1] > 0.05 {
            all.entry(cell("fruit").to_owned())
                .or_default()
                .push((partner, numbers));
        }
    }
    for own in all.values_mut() {
        own.sort_by(|a, b| a.1[0].total_cmp(&b.1[0]));
    }
    all
}

/// Each fruit's contacts are the same within a part.
pub(super) fn same(
    found: &BTreeMap<String, Vec<Contact>>,
    wanted: &BTreeMap<String, Vec<Contact>>,
    part: f64,
) {
    assert_eq!(
        found.keys().collect::<Vec<_>>(),
        wanted.keys().collect::<Vec<_>>()
    );
    for (fruit, wanted) in wanted {
        let found = &found[fruit];
        assert_eq!(
            found.len(),
            wanted.len(),
            "fruit {fruit}: {found:?} {wanted:?}"
        );
        for (found, wanted) in found.iter().zip(wanted) {
            assert_eq!(found.0, wanted.0);
            for (column, (own, wanted)) in found.1.iter().zip(wanted.1).enumerate() {
                // The speed of a later load is one that is seen now and then.
                let seen = column == 1 && !found.0.ends_with("load 1");
                let part = if seen { 3.0 * part } else { part };
                let found = own;
                let near = (found - wanted).abs() <= part * wanted.abs();
                assert!(near, "fruit {fruit}: {found} {wanted}");
            }
        }
    }
}

pub(super) fn scene_of(text: &str) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("scene.toml"), text).unwrap();
    folder
}

pub(super) fn run(folder: &Path, out: &str, arguments: &[&str]) -> serde_json::Value {
    let mut all = vec![
        "scene",
        "run",
        "scene.toml",
        "--out",
        out,
        "--format",
        "json",
    ];
    all.extend(arguments);
    let (done, json, problem) = windfall(&all, folder);
    assert!(done, "{arguments:?}: {problem}");
    serde_json::from_str(&json).unwrap()
}

#[test]
fn reference_lammps_gives_the_histories_of_isolated_impacts() {
    let folder = scene_of(IMPACTS);
    run(folder.path(), "own", &[]);
    let own = contacts(folder.path(), "own");
    assert!(own.values().map(Vec::len).sum::<usize>() >= 8, "{own:?}");
    // Many classes, so that each fruit has its own coefficients, and every step a frame.
    let exact = ["--engine", "lammps", "--classes", "28"];
    let json = run(folder.path(), "lammps", &exact);
    assert!(json["engine"].as_str().unwrap().starts_with("LAMMPS"));
    assert_eq!(json["left"], 1);
    assert!(json["energy_closure"].as_f64().unwrap().abs() < 0.01);
    let lammps = contacts(folder.path(), "lammps");
    same(&lammps, &own, 0.01);
    // Nothing of the pipe is left, but the deck and what it printed.
    let engine = folder.path().join("lammps/engine");
    assert!(!engine.join("frames.bin").exists() && engine.join("in.scene").exists());
    // On two ranks the same, but for rounding.
    let two = ["--engine", "lammps", "--classes", "28", "--ranks", "2"];
    let json = run(folder.path(), "two", &two);
    assert!(json["engine"].as_str().unwrap().contains("2 ranks"));
    same(&contacts(folder.path(), "two"), &lammps, 1e-6);
    let screen = std::fs::read_to_string(folder.path().join("two/engine/screen.txt")).unwrap();
    assert!(screen.contains("on 2 procs"), "{screen}");
}

#[test]
fn reference_lammps_gives_the_histories_on_walls_that_start_and_stop() {
    let moves = r#"
[[moves]]
walls = ["floor"]
shift = [0, 0, 0.05]
from = "0.05 s"
until = "0.3 s"
[[moves]]
walls = ["slope"]
vibration = { amplitude = [0, 0, 0.003], frequency = "25 Hz" }
from = "0.1 s"
until = "0.3 s"
ramp = "0.06 s"
[[moves]]
walls = ["slope"]
velocity = [0, 0, 0.1]
from = "0.15 s"
ramp = "0 s"
"#;
    let folder = scene_of(&format!("{IMPACTS}{moves}"));
    run(folder.path(), "own", &[]);
    let own = contacts(folder.path(), "own");
    let exact = ["--engine", "lammps", "--classes", "28"];
    run(folder.path(), "lammps", &exact);
    same(&contacts(folder.path(), "lammps"), &own, 0.01);
    // They are others than on walls that stay.
    let still = scene_of(IMPACTS);
    run(still.path(), "own", &[]);
    let peaks = |all: &BTreeMap<String, Vec<Contact>>| -> Vec<f64> {
        all.values().flatten().map(|own| own.1[2]).collect()
    };
    assert_ne!(peaks(&contacts(still.path(), "own")), peaks(&own));
    // LIGGGHTS has no moves that begin.
    let (done, _, problem) = windfall(
        &["scene", "export", "scene.toml", "--engine", "liggghts"],
        folder.path(),
    );
    assert!(
        !done && problem.contains("its moves begin or end"),
        "{problem}"
    );
}

#[test]
fn reference_liggghts_gives_the_histories_of_isolated_impacts() {
    // It has one form of law for all meshes.
    let text = IMPACTS.replace(
        "law = \"kelvin-voigt(k=6000, c=25)\"",
        "law = \"kuwabara-kono(k=100000, c=500)\"\neffective_radius = \"37.5 mm\"",
    );
    let folder = scene_of(&text);
    run(folder.path(), "own", &[]);
    run(
        folder.path(),
        "liggghts",
        &["--engine", "liggghts", "--classes", "28"],
    );
    let own = contacts(folder.path(), "own");
    same(&contacts(folder.path(), "liggghts"), &own, 0.01);
}

/// A fruit and a floor, and two fruit that meet in the air, without gravity and loss.
const ELASTIC: &str = r#"format = 1
materials = ["apple", "steel"]
[scene]
time_step = "20 us"
end = "0.25 s"
gravity = [0, 0, 0]
[[contacts]]
between = ["apple", "apple"]
law = "hertz(k=753599)"
effective_radius = "18.75 mm"
annuli = 1
[[contacts]]
between = ["apple", "steel"]
law = "hertz(k=1065750)"
effective_radius = "37.5 mm"
annuli = 1
[[fruit]]
material = "apple"
count = 1
diameter = "75 mm"
density = "840 kg/m^3"
drop = { place = [0, 0, 0.1], velocity = [0, 0, -1] }
[[fruit]]
material = "apple"
count = 1
diameter = "75 mm"
density = "840 kg/m^3"
drop = { place = [0.5, 0, 0.5], velocity = [0.5, 0, 0] }
[[fruit]]
material = "apple"
count = 1
diameter = "70 mm"
density = "840 kg/m^3"
drop = { place = [0.63, 0, 0.5], velocity = [-0.3, 0, 0] }
[[walls]]
name = "floor"
material = "steel"
plane = { point = [0, 0, 0], normal = [0, 0, 1] }
"#;

#[test]
fn reference_elastic_impacts_are_those_of_the_engines_to_the_last_digits() {
    // Each engine moves the fruit by forces of its own and with the same integrator. Where no
    // damping is, at whose order the three differ, nothing but rounding parts their places.
    let folder = scene_of(ELASTIC);
    run(folder.path(), "own", &[]);
    let own = contacts(folder.path(), "own");
    assert_eq!(own.values().map(Vec::len).sum::<usize>(), 2, "{own:?}");
    for engine in ["lammps", "liggghts"] {
        let exact = ["--engine", engine, "--frame-steps", "1", "--classes", "3"];
        run(folder.path(), engine, &exact);
        let theirs = contacts(folder.path(), engine);
        for (own, theirs) in own.values().flatten().zip(theirs.values().flatten()) {
            assert_eq!(own.0, theirs.0);
            let ([_, speed, force, _, depth], wanted) = (own.1, theirs.1);
            let near = |own: f64, wanted: f64, part: f64| (own - wanted).abs() <= part * wanted;
            let same = near(force, wanted[2], 1e-13) && near(depth, wanted[4], 1e-13);
            assert!(
                same && near(speed, wanted[1], 1e-10),
                "{engine}: {own:?} {theirs:?}"
            );
        }
    }
}

#[test]
fn an_exported_deck_runs_by_itself_and_its_frames_are_read() {
    let folder = scene_of(IMPACTS);
    let export = ["scene", "export", "scene.toml", "--engine", "lammps"];
    let (done, text, problem) = windfall(&export, folder.path());
    assert!(done && text.contains("lmp -in in.scene"), "{text}{problem}");
    let deck = folder.path().join("scene.lammps");
    let lammps = std::process::Command::new("lmp")
        .args(["-in", "in.scene"])
        .current_dir(&deck)
        .output()
        .unwrap();
    assert!(lammps.status.success(), "{lammps:?}");
    let frames = deck.join("frames.bin");
    let read = ["--engine", "lammps", "--frames", frames.to_str().unwrap()];
    run(folder.path(), "read", &read);
    run(
        folder.path(),
        "run",
        &["--engine", "lammps", "--engine-frames"],
    );
    same(
        &contacts(folder.path(), "read"),
        &contacts(folder.path(), "run"),
        1e-9,
    );
    // Frames that are cut short, of another deck, or none.
    let events = std::fs::read(folder.path().join("read/events.csv")).unwrap();
    let whole = std::fs::read(&frames).unwrap();
    std::fs::write(folder.path().join("short.bin"), &whole[..whole.len() / 2]).unwrap();
    for (name, steps, word) in [
        ("short.bin", None, "cut short"),
        ("scene.lammps/frames.bin", Some("7"), "another deck"),
        ("scene.toml", None, "no dump"),
        ("none.bin", None, "no such file"),
    ] {
        let mut all = vec![
            "scene",
            "run",
            "scene.toml",
            "--out",
            "read",
            "--engine",
            "lammps",
        ];
        all.extend(["--frames", name]);
        all.extend(steps.iter().flat_map(|steps| ["--frame-steps", steps]));
        let (done, _, problem) = windfall(&all, folder.path());
        assert!(!done && problem.contains(word), "{name}: {problem}");
    }
    // What was there before is there still.
    assert_eq!(
        std::fs::read(folder.path().join("read/events.csv")).unwrap(),
        events
    );
}

#[test]
fn rejects_what_an_engine_cannot_represent_with_all_reasons() {
    let text = IMPACTS
        .replace(
            "kelvin-voigt(k=6000, c=25)",
            "power-law(k=6000, n=1.9, c=25, p=0)",
        )
        .replace(
            "edges = [[1, 0, 0], [0, 0.6, 0]] }",
            "edges = [[1, 0, 0], [0.2, 0.6, 0]] }",
        )
        .replace("vibration = {", "belt = [0.5, 0, 0]\nvibration = {");
    let folder = scene_of(&text);
    let refused = |engine: &str| {
        let all = ["scene", "export", "scene.toml", "--engine", engine];
        let (done, _, problem) = windfall(&all, folder.path());
        assert!(!done && !problem.contains("panicked"), "{problem}");
        problem
    };
    let problem = refused("lammps");
    for word in ["n = 1.9", "apple and foam", "\"floor\"", "right angles"] {
        assert!(problem.contains(word), "{word}: {problem}");
    }
    let text = IMPACTS.replace("vibration = {", "belt = [0.5, 0, 0]\nvibration = {");
    std::fs::write(folder.path().join("scene.toml"), text).unwrap();
    assert!(refused("lammps").contains("belt"));
    assert!(refused("liggghts").contains("one form of law"));
}

/// A program of the name in a directory.
fn fake(directory: &Path, name: &str, text: &str) {
    let path = directory.join(name);
    std::fs::write(&path, format!("#!/bin/sh\n{text}\n")).unwrap();
    std::fs::set_permissions(&path, std::fs::Permissions::from_mode(0o755)).unwrap();
}

#[test]
fn rejects_engines_that_are_absent_old_or_fail() {
    let folder = scene_of(IMPACTS);
    let programs = folder.path().join("bin");
    std::fs::create_dir(&programs).unwrap();
    let only = programs.to_str().unwrap().to_owned();
    let with_system = format!("{only}:/usr/bin:/bin");
    let refused = |path: &str, arguments: &[&str]| {
        let mut all = vec!["scene", "run", "scene.toml", "--engine", "lammps"];
        all.extend(arguments);
        let (done, _, problem) = with_path(&all, folder.path(), path);
        assert!(!done && !problem.contains("panicked"), "{problem}");
        problem
    };
    let problem = refused(&only, &[]);
    assert!(
        problem.contains("not installed") && problem.contains("apt install"),
        "{problem}"
    );
    let problem = refused(&only, &["--engine-program", "nowhere/lmp"]);
    assert!(problem.contains("nowhere/lmp"), "{problem}");
    fake(&programs, "lmp", "echo I am something else");
    assert!(refused(&only, &[]).contains("I am something else"));
    let help = |date: &str, styles: &str| {
        format!(
            "if [ \"$1\" = -h ]; then echo 'Large-scale Atomic/Molecular Massively Parallel \
             Simulator - {date}'; echo 'MPI v3.1: MPICH 4.0, package'; echo '{styles}'; exit; fi"
        )
    };
    let styles = "granular wall/gran/region property/atom nve/sphere evaporate";
    fake(&programs, "lmp", &help("3 Mar 2020", styles));
    let problem = refused(&only, &[]);
    assert!(
        problem.contains("3 Mar 2020") && problem.contains("29 Sep 2021"),
        "{problem}"
    );
    fake(
        &programs,
        "lmp",
        &help("29 Aug 2024", "granular property/atom nve/sphere"),
    );
    assert!(refused(&only, &[]).contains("without wall/gran/region"));

    // One that fails before its first frame; an earlier result stays.
    let out = folder.path().join("scene.run");
    std::fs::create_dir(&out).unwrap();
    std::fs::write(out.join("events.csv"), "earlier").unwrap();
    std::fs::write(out.join(LIST), "any  events.csv\n").unwrap();
    let good = help("29 Aug 2024", styles);
    fake(
        &programs,
        "lmp",
        &format!("{good}\necho 'ERROR: Lost atoms: original 7'; exit 1"),
    );
    let problem = refused(&with_system, &[]);
    assert!(
        problem.contains("Lost atoms") && problem.contains("step 0"),
        "{problem}"
    );
    assert_eq!(
        std::fs::read_to_string(out.join("events.csv")).unwrap(),
        "earlier"
    );

    // A launcher of another MPI starts as many as are asked for, each for itself.
    fake(
        &programs,
        "lmp",
        &format!("{good}\necho '  1 by 1 by 1 MPI processor grid'"),
    );
    let launcher = "if [ \"$1\" = --version ]; then echo HYDRA; exit; fi\n\
                    shift; n=$1; shift; while [ $n -gt 0 ]; do \"$@\"; n=$((n - 1)); done";
    fake(&programs, "mpirun", launcher);
    let problem = refused(&only, &["--ranks", "2"]);
    for word in ["on 1 procs", "MPICH 4.0", "same MPI"] {
        assert!(problem.contains(word), "{word}: {problem}");
    }
}

#[test]
fn every_poured_fruit_comes_on_lammps_too() {
    let folder = tempfile::tempdir().unwrap();
    assert!(windfall(&["new", "scene", "s"], folder.path()).0);
    let text = std::fs::read_to_string(folder.path().join("s/scene.toml")).unwrap();
    let (belt, end) = ("belt = [0.5, 0, 0]\n", "end = \"4 s\"");
    assert!(text.contains(belt) && text.contains(end));
    let text = text.replace(belt, "").replace(end, "end = \"0.65 s\"");
    std::fs::write(folder.path().join("scene.toml"), text).unwrap();
    let json = run(folder.path(), "lammps", &["--engine", "lammps"]);
    assert_eq!(json["fruit"], 100);
    // Of one each 20 ms those of the first 0.65 s, as here.
    let own = run(folder.path(), "own", &[]);
    let waiting = |json: &serde_json::Value| json["waiting"].as_i64().unwrap();
    // One that comes within the last frame is seen by one of them.
    assert!((waiting(&json) - waiting(&own)).abs() <= 1);
    let closure = json["energy_closure"].as_f64().unwrap();
    assert!(closure.abs() < 0.02, "{closure}");
    let codes = json["findings"].to_string();
    assert!(
        codes.contains("engine-classes") && codes.contains("engine-rolling"),
        "{codes}"
    );
    let count = |json: &serde_json::Value| json["contacts"].as_f64().unwrap();
    assert!(
        (count(&json) / count(&own)).ln().abs() < 0.3,
        "{} {}",
        count(&json),
        count(&own)
    );
}

/// A plane and a box see the same fruit at the same times in frames of LAMMPS; a probe is refused.
#[test]
fn sensors_see_the_same_in_the_frames_of_another_engine() {
    let folder = tempfile::tempdir().unwrap();
    let sensors = "[[sensors]]\nname = \"level\"\nplane = { point = [0, 0, 0.12], normal = [0, 0, 1] }\n\
                   [[sensors]]\nname = \"room\"\ninterval = \"10 ms\"\n\
                   box = { low = [-1, -0.3, -0.5], high = [1.4, 0.3, 0.25] }\n";
    std::fs::write(folder.path().join("s.toml"), format!("{IMPACTS}{sensors}")).unwrap();
    let run = |engine: &str| {
        let arguments = [
            "scene", "run", "s.toml", "--engine", engine, "--out", engine, "--format", "json",
        ];
        let (done, json, problem) = windfall(&arguments, folder.path());
        assert!(done, "{problem}");
        let json: serde_json::Value = serde_json::from_str(&json).unwrap();
        let path = folder.path().join(engine).join("sensor_passes.csv");
        let text = std::fs::read_to_string(path).unwrap();
        let mut passes: Vec<(String, String, f64)> = Vec::new();
        for line in text.lines().skip(1) {
            let cells: Vec<&str> = line.split(',').collect();
            passes.push((
                cells[2].to_owned(),
                cells[3].to_owned(),
                cells[1].parse().unwrap(),
            ));
        }
        passes.sort_by(|a, b| a.0.cmp(&b.0).then(a.2.total_cmp(&b.2)));
        (passes, json["sensors"].clone())
    };
    let ((own, here), (theirs, there)) = (run("windfall"), run("lammps"));
    assert!(own.len() >= 4, "{own:?}");
    assert_eq!(own.len(), theirs.len(), "{own:?} {theirs:?}");
    for (a, b) in own.iter().zip(&theirs) {
        assert_eq!((&a.0, &a.1), (&b.0, &b.1));
        assert!((a.2 - b.2).abs() < 5e-4, "{a:?} {b:?}");
    }
    for key in ["entered", "inside"] {
        assert_eq!(here[1]["space"][key], there[1]["space"][key], "{key}");
    }
    let probe = "[[sensors]]\nname = \"feeler\"\nprobe = \"apple\"\ninterval = \"1 ms\"\n";
    std::fs::write(folder.path().join("p.toml"), format!("{IMPACTS}{probe}")).unwrap();
    let (done, _, problem) = windfall(
        &["scene", "run", "p.toml", "--engine", "lammps"],
        folder.path(),
    );
    assert!(
        !done && problem.contains("\"feeler\"") && problem.contains("--engine windfall"),
        "{problem}"
    );
}
