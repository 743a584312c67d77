//! Runs inside of LAMMPS's ranks that were stopped, and go on from their checkpoint: against runs
//! that were not.

use super::engines::{run, scene_of};
use super::ranks::{EXACT, crossing, processes, rows, with};
use super::{change, windfall};
use std::collections::BTreeMap;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::Duration;

/// The scene of the test of 1, 2 and 4 ranks, long enough to be stopped.
fn long() -> String {
    let changed = "end = \"2.5 s\"\ncheckpoint = \"0.1 s\"";
    crossing().replace("end = \"0.5 s\"", changed)
}

/// Starts a run into `out`, and waits until it has a checkpoint and went on for a while.
fn started(folder: &Path, ranks: &str) -> Child {
    let mut command = Command::new(assert_cmd::cargo::cargo_bin("windfall"));
    let words = [
        "scene",
        "run",
        "scene.toml",
        "--out",
        "out",
        "--ranks",
        ranks,
    ];
    command.args(words).args(EXACT).current_dir(folder);
    command.stderr(Stdio::piped()).stdout(Stdio::null());
    let child = command.spawn().unwrap();
    let checkpoint = folder.join("out/engine/checkpoint.bin");
    for _ in 0..1200 {
        std::thread::sleep(Duration::from_millis(50));
        if checkpoint.exists() {
            break;
        }
    }
    assert!(checkpoint.exists());
    std::thread::sleep(Duration::from_millis(150));
    child
}

fn kill(signal: &str, process: &str) {
    let killed = Command::new("kill").args([signal, process]).status();
    assert!(killed.unwrap().success());
}

/// What a run says that did not end well.
fn complaint(child: Child) -> String {
    let output = child.wait_with_output().unwrap();
    let problem = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(
        !output.status.success() && !problem.contains("panicked"),
        "{problem}"
    );
    problem
}

/// Stops a run by killing one of its ranks; what it says.
fn stopped(folder: &Path, ranks: &str) -> String {
    let child = started(folder, ranks);
    let word = folder.to_string_lossy().into_owned();
    kill("-KILL", processes(&word).last().unwrap());
    let problem = complaint(child);
    assert_eq!(processes(&word), Vec::<String>::new());
    problem
}

fn copied(folder: &Path, out: &str) {
    let [from, to] = ["out", out].map(|own| folder.join(own));
    let done = Command::new("cp").arg("-r").arg(from).arg(to).status();
    assert!(done.unwrap().success());
}

/// What a run says that is refused.
fn refused(folder: &Path, out: &str, more: &[&str]) -> String {
    let all = ["scene", "run", "scene.toml", "--out", out];
    let all: Vec<&str> = all.iter().chain(&with(more)).copied().collect();
    let (done, _, problem) = windfall(&all, folder);
    assert!(!done && !problem.contains("panicked"), "{problem}");
    problem
}

fn same_files(folder: &Path, [a, b]: [&str; 2]) {
    for name in ["events.csv", "fruit.csv", "histograms.csv"] {
        let [a, b] = [a, b].map(|out| std::fs::read(folder.join(out).join(name)).unwrap());
        assert!(a == b, "{name}");
    }
}

/// Contents of files by their names.
fn contents(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let entries = std::fs::read_dir(folder).unwrap().flatten();
    let files = entries.filter(|own| own.path().is_file());
    let read = files.map(|own| {
        let name = own.file_name().into_string().unwrap();
        (name, std::fs::read(own.path()).unwrap())
    });
    read.collect()
}

#[test]
fn reference_lammps_a_run_whose_rank_was_killed_goes_on_with_the_same_bytes() {
    let folder = scene_of(&long());
    let folder = folder.path();
    run(folder, "whole", &with(&["--ranks", "2"]));
    let problem = stopped(folder, "2");
    for words in ["it stopped", "is kept: the same command with --resume"] {
        assert!(problem.contains(words), "{problem}");
    }
    assert!(folder.join("out/events.csv.partial").exists());
    let problem = refused(folder, "out", &["--ranks", "2"]);
    assert!(
        problem.contains("out holds a run that was stopped after"),
        "{problem}"
    );
    assert!(problem.contains("s of 2.5 s: with --resume"), "{problem}");
    let own = ["scene", "run", "scene.toml", "--out", "out", "--resume"];
    let (done, _, problem) = windfall(&own, folder);
    assert!(!done && problem.contains("another engine"), "{problem}");
    // On as many ranks, on fewer, and on more; and anew.
    for (out, ranks) in [("same", "2"), ("fewer", "1"), ("more", "3")] {
        copied(folder, out);
        run(folder, out, &with(&["--resume", "--ranks", ranks]));
        let left = contents(&folder.join(out).join("engine"));
        let rest = |own: &&String| own.starts_with("pulses") || own.starts_with("checkpoint");
        assert_eq!(left.keys().find(rest), None);
    }
    same_files(folder, ["same", "whole"]);
    for out in ["fewer", "more"] {
        let (found, wanted) = (rows(folder, out), rows(folder, "whole"));
        assert_eq!(found.len(), wanted.len());
        for (a, b) in found.iter().flatten().zip(wanted.iter().flatten()) {
            // Of what rounding has moved.
            assert!((a - b).abs() <= 1e-6 * (1.0 + b.abs()), "{out}: {a} {b}");
        }
    }
    run(folder, "out", &with(&["--restart", "--ranks", "2"]));
    same_files(folder, ["out", "whole"]);
    let problem = refused(folder, "out", &["--resume"]);
    assert!(
        problem.contains("holds no run that was stopped"),
        "{problem}"
    );
}

#[test]
fn reference_lammps_a_checkpoint_that_cannot_be_used_is_refused_and_stays() {
    let folder = scene_of(&long());
    let folder = folder.path();
    stopped(folder, "2");
    let engine = folder.join("out/engine");
    let whole = contents(&engine);
    let state =
        |own: &&String| own.starts_with("checkpoint.0.") || own.starts_with("checkpoint.1.");
    // Both turns, of which one counts.
    let cases = [
        (vec!["checkpoint.bin"], "checkpoint"),
        (
            vec!["checkpoint.0.1.bin", "checkpoint.1.1.bin"],
            "the checkpoint",
        ),
        (
            vec!["checkpoint.0.lammps", "checkpoint.1.lammps"],
            "LAMMPS's part of the checkpoint",
        ),
        // A rank that is done before the other is killed has given them their name.
        (
            vec!["pulses.1.bin.partial", "pulses.1.bin"],
            "the pulses have",
        ),
    ];
    assert!(
        whole.keys().filter(state).count() >= 3,
        "{:?}",
        whole.keys()
    );
    for (names, words) in cases {
        for (name, bytes) in &whole {
            std::fs::write(engine.join(name), bytes).unwrap();
        }
        let there = names.iter().filter_map(|name| whole.get_key_value(*name));
        let cut = there.map(|(name, bytes)| {
            // A rank goes on behind its checkpoint: a third of its pulses may be all that counts.
            let left = match name.starts_with("pulses") {
                true => 0,
                false => bytes.len() / 3,
            };
            std::fs::write(engine.join(name), &bytes[..left]).unwrap();
        });
        assert!(cut.count() > 0, "{names:?} of {:?}", whole.keys());
        let before = contents(&engine);
        // Shown where the run goes on and has nothing to say.
        eprintln!("{names:?}");
        let problem = refused(folder, "out", &["--resume", "--ranks", "2"]);
        assert!(
            problem.contains(words) && problem.contains("--restart"),
            "{names:?}: {problem}"
        );
        assert!(contents(&engine) == before);
    }
    for (name, bytes) in &whole {
        std::fs::write(engine.join(name), bytes).unwrap();
    }
    // Of another deck, and of another scene.
    let problem = refused(folder, "out", &["--resume", "--frame-steps", "2"]);
    assert!(problem.contains("changed: the deck"), "{problem}");
    change(&folder.join("scene.toml"), &[("c=1524", "c=1525")]);
    let problem = refused(folder, "out", &["--resume"]);
    assert!(
        problem.contains("changed: contacts of apple and apple. Put"),
        "{problem}"
    );
    // A file of somebody else in its place is not replaced, neither anew.
    std::fs::write(engine.join("checkpoint.bin"), "my notes\n").unwrap();
    let before = contents(&engine);
    for more in ["--resume", "--restart"] {
        let problem = refused(folder, "out", &[more]);
        assert!(problem.contains("checkpoint.bin"), "{problem}");
        assert_eq!(
            contents(&engine)["checkpoint.bin"],
            before["checkpoint.bin"]
        );
    }
}

#[test]
fn reference_lammps_an_interrupted_run_and_one_whose_rank_cannot_write_go_on() {
    let folder = scene_of(&long());
    let folder = folder.path();
    run(folder, "whole", &with(&["--ranks", "2"]));
    let child = started(folder, "2");
    kill("-INT", &child.id().to_string());
    let problem = complaint(child);
    assert!(
        problem.contains("stopped at") && problem.contains("--resume"),
        "{problem}"
    );
    run(folder, "out", &with(&["--resume", "--ranks", "2"]));
    same_files(folder, ["out", "whole"]);
    // A rank cannot write what it remembers: as on a full disk the checkpoint before counts.
    let child = started(folder, "2");
    let taken = folder.join("out/engine/checkpoint.0.1.bin");
    for _ in 0..1000 {
        let _ = std::fs::remove_file(&taken);
        if std::fs::create_dir(&taken).is_ok() {
            break;
        }
    }
    let problem = complaint(child);
    for words in ["ERROR on rank 1", "checkpoint.0.1.bin", "is kept"] {
        assert!(problem.contains(words), "{problem}");
    }
    std::fs::remove_dir(&taken).unwrap();
    run(folder, "out", &with(&["--resume", "--ranks", "2"]));
    same_files(folder, ["out", "whole"]);
}

#[test]
fn reference_lammps_ranks_that_run_by_themselves_go_on_from_their_checkpoint() {
    let folder = scene_of(&long());
    let folder = folder.path();
    run(folder, "whole", &EXACT);
    let export = ["scene", "export", "scene.toml", "--engine", "lammps"];
    let export: Vec<&str> = export
        .into_iter()
        .chain(["--classes", "28", "--out", "deck"])
        .collect();
    assert!(windfall(&export, folder).0);
    let rank = ["scene", "rank", "scene.toml", "--deck", "deck"];
    let with = |more: &'static str| -> Vec<&str> { rank.into_iter().chain([more]).collect() };
    let (done, _, problem) = windfall(&with("--resume"), folder);
    assert!(
        !done && problem.contains("holds no run that was stopped"),
        "{problem}"
    );
    let mut command = Command::new(assert_cmd::cargo::cargo_bin("windfall"));
    command.args(rank).current_dir(folder).stdout(Stdio::null());
    let mut child = command.spawn().unwrap();
    let checkpoint = folder.join("deck/checkpoint.bin");
    for _ in 0..3000 {
        std::thread::sleep(Duration::from_millis(20));
        if checkpoint.exists() {
            break;
        }
    }
    assert!(checkpoint.exists());
    child.kill().unwrap();
    child.wait().unwrap();
    let (done, _, problem) = windfall(&rank, folder);
    assert!(
        !done && problem.contains("deck holds a run that was stopped after"),
        "{problem}"
    );
    let (done, _, problem) = windfall(&with("--resume"), folder);
    assert!(done, "{problem}");
    let left = contents(&folder.join("deck"));
    assert!(!left.keys().any(|own| own.starts_with("checkpoint")));
    let read: Vec<&str> = EXACT.into_iter().chain(["--pulses", "deck"]).collect();
    let json = run(folder, "read", &read);
    assert!(
        json["engine"]
            .as_str()
            .unwrap()
            .contains(", 1 ranks (deck)")
    );
    same_files(folder, ["read", "whole"]);
    // Once more, and the pulses of before do not count.
    assert!(windfall(&rank, folder).0);
    assert!(!folder.join("deck/pulses.1.bin").exists());
}
