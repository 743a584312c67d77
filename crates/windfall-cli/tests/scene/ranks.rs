//! Pulses that are found inside of the ranks of LAMMPS, against windfall's own engine, against
//! what is found outside of the ranks, and on 1, 2 and 4 of them.

use super::engines::{Contact, IMPACTS, contacts, run, same, scene_of};
use super::{said, windfall};
use std::collections::BTreeMap;
use std::path::Path;

pub(super) const EXACT: [&str; 4] = ["--engine", "lammps", "--classes", "28"];

pub(super) fn with<'a>(more: &[&'a str]) -> Vec<&'a str> {
    EXACT.iter().chain(more).copied().collect()
}

/// Fruit that move slowly along a floor through the border of ranks while they rest on it and on
/// each other, and some that fall onto them there.
pub(super) fn crossing() -> String {
    let mut text = String::from(
        r#"format = 1
materials = ["apple", "steel"]
[scene]
title = "Across the borders"
time_step = "20 us"
end = "0.5 s"
[[contacts]]
between = ["apple", "apple"]
law = "kuwabara-kono(k=753599, c=1524)"
effective_radius = "18.75 mm"
annuli = 1
friction = 0.3
[[contacts]]
between = ["apple", "steel"]
law = "kuwabara-kono(k=1065750, c=2155)"
effective_radius = "37.5 mm"
annuli = 1
friction = 0.01
[[walls]]
name = "floor"
material = "steel"
plane = { point = [0, 0, 0], normal = [0, 0, 1] }
[[walls]]
name = "left"
material = "steel"
plane = { point = [-0.6, 0, 0], normal = [1, 0, 0] }
[[walls]]
name = "right"
material = "steel"
plane = { point = [0.6, 0, 0], normal = [-1, 0, 0] }
"#,
    );
    // Pairs that touch, each from one side to the other, and one above each pair.
    for (number, y) in [-0.45, -0.2, 0.05, 0.3].iter().enumerate() {
        let way = if number % 2 == 0 { 1.0 } else { -1.0 };
        for (x, z, v) in [(-0.1, 0.0374, 0.5), (-0.0251, 0.0374, 0.5), (0.0, 0.2, 0.2)] {
            text += &format!(
                "[[fruit]]\nmaterial = \"apple\"\ncount = 1\ndiameter = \"75 mm\"\ndensity = \"840 kg/m^3\"\n\
                 drop = {{ place = [{}, {y}, {z}], velocity = [{}, {}, 0] }}\n",
                way * x,
                way * v,
                way * 0.11
            );
        }
    }
    text
}

fn count(all: &BTreeMap<String, Vec<Contact>>) -> usize {
    all.values().map(Vec::len).sum()
}

/// Every row of events.csv but its times and places, which rounding moves.
pub(super) fn rows(folder: &Path, out: &str) -> Vec<Vec<f64>> {
    let text = std::fs::read_to_string(folder.join(out).join("events.csv")).unwrap();
    let number = |cell: &str| cell.parse().unwrap_or(f64::from(u8::from(cell == "true")));
    let row = |line: &str| line.split(',').map(number).collect();
    let mut all: Vec<Vec<f64>> = text.lines().skip(1).map(row).collect();
    // By fruit, partner, and load.
    all.sort_by(|a, b| a.partial_cmp(b).unwrap());
    all
}

#[test]
fn reference_lammps_pulses_inside_of_ranks_are_those_outside_and_of_the_own_engine() {
    let folder = scene_of(IMPACTS);
    run(folder.path(), "own", &[]);
    let json = run(folder.path(), "inside", &EXACT);
    assert!(
        !json["findings"].to_string().contains("engine-outside"),
        "{json}"
    );
    run(folder.path(), "outside", &with(&["--engine-frames"]));
    let own = contacts(folder.path(), "own");
    let inside = contacts(folder.path(), "inside");
    assert!(count(&own) >= 8, "{own:?}");
    same(&inside, &own, 0.01);
    same(&inside, &contacts(folder.path(), "outside"), 1e-6);
    assert_eq!(json["left"], 1);
    assert!(json["energy_closure"].as_f64().unwrap().abs() < 0.01);
    // Fruit stand where they do outside, and one of them left there.
    let cells = |out: &str| -> Vec<Vec<String>> {
        let text = std::fs::read_to_string(folder.path().join(out).join("fruit.csv")).unwrap();
        let row = |line: &str| line.split(',').take(10).map(str::to_owned).collect();
        text.lines().skip(1).map(row).collect()
    };
    for (a, b) in cells("inside").iter().zip(cells("outside")) {
        for (a, b) in a.iter().zip(&b) {
            match (a.parse::<f64>(), b.parse::<f64>()) {
                // Outside they are gone on for one frame.
                (Ok(a), Ok(b)) => assert!((a - b).abs() <= 1e-3, "{a} {b}"),
                _ => assert_eq!(a, b),
            }
        }
    }
    // Nothing is left of what ranks told.
    let left = std::fs::read_dir(folder.path().join("inside/engine")).unwrap();
    for entry in left {
        let name = entry.unwrap().file_name();
        assert!(!name.to_string_lossy().starts_with("pulses"), "{name:?}");
    }
}

#[test]
fn reference_lammps_pulses_are_the_same_on_1_2_and_4_ranks() {
    let folder = scene_of(&crossing());
    run(folder.path(), "own", &[]);
    let own = contacts(folder.path(), "own");
    run(folder.path(), "one", &EXACT);
    same(&contacts(folder.path(), "one"), &own, 0.02);
    let one = rows(folder.path(), "one");
    assert!(one.len() >= 24, "{}", one.len());
    for ranks in ["2", "4"] {
        let json = run(folder.path(), ranks, &with(&["--ranks", ranks]));
        assert!(
            json["engine"]
                .as_str()
                .unwrap()
                .ends_with(&format!("{ranks} ranks"))
        );
        let several = rows(folder.path(), ranks);
        assert_eq!(several.len(), one.len());
        for (a, b) in several.iter().zip(&one) {
            for (column, (a, b)) in a.iter().zip(b).enumerate() {
                // Of what rounding has moved.
                let near = (a - b).abs() <= 1e-6 * (1.0 + b.abs());
                assert!(near, "{ranks} ranks, column {column}: {a} {b}");
            }
        }
        let screen = folder.path().join(ranks).join("engine/screen.txt");
        let screen = std::fs::read_to_string(screen).unwrap();
        assert!(screen.contains(&format!("on {ranks} procs")), "{screen}");
    }
}

#[test]
fn reference_lammps_pulses_of_ranks_that_ran_by_themselves_are_put_together() {
    let folder = scene_of(&crossing());
    run(folder.path(), "run", &EXACT);
    let export = [
        "scene",
        "export",
        "scene.toml",
        "--engine",
        "lammps",
        "--classes",
        "28",
    ];
    let (done, _, problem) = windfall(&export, folder.path());
    assert!(done, "{problem}");
    let rank = ["scene", "rank", "scene.toml", "--deck", "scene.lammps"];
    let (done, _, problem) = windfall(&rank, folder.path());
    assert!(done, "{problem}");
    let read = with(&["--pulses", "scene.lammps"]);
    let json = run(folder.path(), "read", &read);
    assert!(json["engine"].as_str().unwrap().contains("scene.lammps"));
    assert_eq!(rows(folder.path(), "read"), rows(folder.path(), "run"));
    // Pulses of another scene, of another deck, not whole, or none.
    let part = folder.path().join("scene.lammps/pulses.0.bin");
    let whole = std::fs::read(&part).unwrap();
    let refused = |arguments: &[&str]| {
        let all = ["scene", "run", "scene.toml", "--out", "other"];
        let all: Vec<&str> = all.iter().chain(&read).chain(arguments).copied().collect();
        let (done, _, problem) = windfall(&all, folder.path());
        assert!(!done && !problem.contains("panicked"), "{problem}");
        problem
    };
    assert!(refused(&["--frame-steps", "7"]).contains("as then"));
    std::fs::write(&part, &whole[..whole.len() / 2]).unwrap();
    assert!(refused(&[]).contains("not whole"));
    std::fs::write(&part, b"fruit,partner\n1,2\n").unwrap();
    let problem = refused(&[]);
    assert!(problem.contains("pulses.0.bin"), "{problem}");
    std::fs::remove_file(&part).unwrap();
    assert!(refused(&[]).contains("windfall scene rank"));
    std::fs::write(&part, &whole).unwrap();
    let text = crossing().replace("c=1524", "c=1525");
    std::fs::write(folder.path().join("scene.toml"), text).unwrap();
    let problem = refused(&[]);
    assert!(
        problem.contains("contacts of apple and apple changed"),
        "{problem}"
    );
}

#[test]
fn reference_lammps_without_a_library_is_followed_from_outside_and_a_named_one_is_refused() {
    let folder = scene_of(IMPACTS);
    // A system library that is none of LAMMPS, and a file that is no library.
    std::fs::write(folder.path().join("text.so"), "no library").unwrap();
    for library in ["nowhere.so", "text.so", "libc.so.6"] {
        let all = ["scene", "run", "scene.toml", "--engine-library", library];
        let all: Vec<&str> = all.iter().chain(&EXACT).copied().collect();
        let (done, _, problem) = windfall(&all, folder.path());
        assert!(!done && problem.contains(library), "{problem}");
        assert!(problem.contains("--engine-library"), "{problem}");
    }
    // The program says another version than the library of the system.
    let lmp = "#!/bin/sh\nif [ \"$1\" = -h ]; then lmp -h | sed 's/Simulator - .*/Simulator - 29 Aug 2024/'; \
               exit; fi\nexec lmp \"$@\"\n";
    let program = folder.path().join("other-lmp");
    std::fs::write(&program, lmp).unwrap();
    use std::os::unix::fs::PermissionsExt;
    std::fs::set_permissions(&program, std::fs::Permissions::from_mode(0o755)).unwrap();
    let json = run(
        folder.path(),
        "outside",
        &with(&["--engine-program", program.to_str().unwrap()]),
    );
    let findings = json["findings"].to_string();
    assert!(
        findings.contains("engine-outside") && findings.contains("29 Aug 2024"),
        "{findings}"
    );
    run(folder.path(), "inside", &EXACT);
    same(
        &contacts(folder.path(), "outside"),
        &contacts(folder.path(), "inside"),
        1e-6,
    );
}

#[test]
fn reference_lammps_a_rank_that_cannot_write_ends_the_run_and_says_which() {
    let folder = scene_of(&crossing());
    let export = ["scene", "export", "scene.toml", "--engine", "lammps"];
    assert!(windfall(&export, folder.path()).0);
    // Something else has the name of the second rank's part.
    let part = folder.path().join("scene.lammps/pulses.1.bin.partial");
    std::fs::create_dir(&part).unwrap();
    let mut command = assert_cmd::Command::new("mpirun");
    command.args(["--oversubscribe", "-n", "2"]);
    command.arg(assert_cmd::cargo::cargo_bin("windfall"));
    command.args(["scene", "rank", "scene.toml", "--deck", "scene.lammps"]);
    command.env("OMPI_ALLOW_RUN_AS_ROOT", "1");
    command.env("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1");
    command.current_dir(folder.path());
    command.timeout(std::time::Duration::from_secs(60));
    let (done, _, problem) = said(command);
    assert!(!done && !problem.contains("panicked"), "{problem}");
    for word in ["ERROR on rank 1", "pulses.1.bin"] {
        assert!(problem.contains(word), "{word}: {problem}");
    }
    assert!(!folder.path().join("scene.lammps/pulses.0.bin").exists());
}

#[test]
fn reference_lammps_a_rank_leaves_the_files_of_others() {
    let folder = scene_of(&crossing());
    let export = ["scene", "export", "scene.toml", "--engine", "lammps"];
    assert!(windfall(&export, folder.path()).0);
    let log = folder.path().join("scene.lammps/log.txt");
    std::fs::write(&log, "my own notes\n").unwrap();
    let rank = ["scene", "rank", "scene.toml", "--deck", "scene.lammps"];
    let (done, _, problem) = windfall(&rank, folder.path());
    assert!(!done && problem.contains("log.txt"), "{problem}");
    assert_eq!(std::fs::read_to_string(&log).unwrap(), "my own notes\n");
}

#[test]
fn options_of_another_engine_are_refused() {
    let folder = scene_of(IMPACTS);
    for (engine, option, words) in [
        (
            "windfall",
            "--pulses=deck",
            "not for windfall: use --engine lammps",
        ),
        ("windfall", "--frames=frames.bin", "--engine liggghts"),
        ("windfall", "--frame-steps=3", "--engine liggghts"),
        ("windfall", "--ranks=2", "--engine liggghts"),
        ("windfall", "--engine-frames", "use --engine lammps"),
        (
            "liggghts",
            "--pulses=deck",
            "not for LIGGGHTS: use --engine lammps",
        ),
        ("liggghts", "--engine-library=x.so", "use --engine lammps"),
    ] {
        let all = ["scene", "run", "scene.toml", "--engine", engine, option];
        let (done, _, problem) = windfall(&all, folder.path());
        assert!(!done && problem.contains(words), "{option}: {problem}");
        assert!(!folder.path().join("scene.run").exists(), "{option}");
    }
}

/// Processes whose arguments hold a word.
pub(super) fn processes(word: &str) -> Vec<String> {
    let mut found = Vec::new();
    for entry in std::fs::read_dir("/proc").unwrap().flatten() {
        let arguments = std::fs::read(entry.path().join("cmdline")).unwrap_or_default();
        let arguments = String::from_utf8_lossy(&arguments).replace('\0', " ");
        if arguments.contains(" scene rank ") && arguments.contains(word) {
            found.push((arguments, entry.file_name().into_string().unwrap()));
        }
    }
    // Not the launcher, which has the same words among its own.
    found.retain(|(arguments, _)| !arguments.contains("mpirun"));
    found.into_iter().map(|(_, own)| own).collect()
}

#[test]
fn reference_lammps_a_rank_that_dies_ends_the_run_and_an_earlier_result_stays() {
    let text = crossing().replace("end = \"0.5 s\"", "end = \"60 s\"");
    let folder = scene_of(&text);
    let out = folder.path().join("scene.run");
    let mut command = std::process::Command::new(assert_cmd::cargo::cargo_bin("windfall"));
    command.args(["scene", "run", "scene.toml", "--ranks", "2"]);
    command.args(EXACT).current_dir(folder.path());
    command.stderr(std::process::Stdio::piped());
    command.stdout(std::process::Stdio::null());
    let child = command.spawn().unwrap();
    let word = folder.path().to_string_lossy().into_owned();
    let mut ranks = Vec::new();
    for _ in 0..300 {
        std::thread::sleep(std::time::Duration::from_millis(100));
        ranks = processes(&word);
        if ranks.len() == 2 && out.join("engine/pulses.1.bin.partial").exists() {
            break;
        }
    }
    assert_eq!(ranks.len(), 2, "{ranks:?}");
    std::thread::sleep(std::time::Duration::from_secs(1));
    let killed = std::process::Command::new("kill")
        .args(["-KILL", &ranks[1]])
        .status();
    assert!(killed.unwrap().success());
    let output = child.wait_with_output().unwrap();
    let problem = String::from_utf8_lossy(&output.stderr);
    assert!(
        !output.status.success() && problem.contains("it stopped"),
        "{problem}"
    );
    assert!(!out.join("events.csv").exists());
    assert_eq!(processes(&word), Vec::<String>::new());
}
