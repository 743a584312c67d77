//! Work that is stopped: killed, interrupted, out of room.
#![cfg(unix)]
#![allow(clippy::unwrap_used)]

use std::path::Path;
use std::process::{Child, Command, Output, Stdio};
use std::time::{Duration, Instant};
use windfall_files::written::LIST;

const WINDFALL: &str = env!("CARGO_BIN_EXE_windfall");
const TABLES: [&str; 8] = [
    "end.bin",
    "events.csv",
    "frames.bin",
    "fruit.csv",
    "histograms.csv",
    "histograms.png",
    "histograms.svg",
    "scene.json",
];

/// The template, shorter and with many checkpoints and bruises.
fn scene(directory: &Path, changes: &[(&str, &str)]) {
    let made = Command::new(WINDFALL)
        .args(["new", "scene", "s"])
        .current_dir(directory)
        .output()
        .unwrap();
    assert!(made.status.success());
    change(
        directory,
        "end = \"4 s\"",
        "end = \"1.5 s\"\ncheckpoint = \"0.02 s\"",
    );
    let path = directory.join("s/scene.toml");
    let text = std::fs::read_to_string(&path).unwrap();
    let at = text.find("# [bruise]").unwrap();
    let bruise: Vec<&str> = text[at..]
        .lines()
        .map(|line| line.trim_start_matches("# "))
        .collect();
    std::fs::write(path, format!("{}{}\n", &text[..at], bruise.join("\n"))).unwrap();
    for (old, new) in changes {
        change(directory, old, new);
    }
}

fn change(directory: &Path, old: &str, new: &str) {
    let path = directory.join("s/scene.toml");
    let text = std::fs::read_to_string(&path).unwrap();
    assert!(text.contains(old), "{old}");
    std::fs::write(path, text.replace(old, new)).unwrap();
}

fn command(directory: &Path, more: &[&str]) -> Command {
    let mut command = Command::new(WINDFALL);
    command
        .args(["scene", "run", "s/scene.toml"])
        .args(more)
        .current_dir(directory)
        .stdout(Stdio::piped())
        .stderr(Stdio::piped());
    command
}

fn run(directory: &Path, more: &[&str]) -> (bool, String) {
    told(command(directory, more).output().unwrap())
}

fn told(output: Output) -> (bool, String) {
    let text = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(!text.contains("panicked"), "{text}");
    (output.status.success(), text)
}

fn read(directory: &Path) -> Vec<Vec<u8>> {
    let path = |name| directory.join("s/scene.run").join(name);
    TABLES
        .map(|name| std::fs::read(path(name)).unwrap())
        .to_vec()
}

fn names(directory: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(directory.join("s/scene.run")).unwrap();
    let name = |entry: std::io::Result<std::fs::DirEntry>| entry.unwrap().file_name();
    let mut names: Vec<String> = entries
        .map(|own| name(own).into_string().unwrap())
        .collect();
    names.retain(|name| name != LIST);
    names.sort();
    names
}

/// The checkpoint as it is, or none.
fn checkpoint(directory: &Path) -> Option<Vec<u8>> {
    std::fs::read(directory.join("s/scene.run/checkpoint.bin")).ok()
}

/// Waits for another checkpoint than the one of before.
fn next_checkpoint(directory: &Path, child: &mut Child, before: &Option<Vec<u8>>) {
    let begun = Instant::now();
    while checkpoint(directory) == *before {
        assert!(begun.elapsed() < Duration::from_secs(120), "no checkpoint");
        assert!(child.try_wait().unwrap().is_none(), "it ended before");
        std::thread::sleep(Duration::from_millis(5));
    }
}

fn kill(child: &Child, signal: &str) {
    let id = child.id().to_string();
    assert!(
        Command::new("kill")
            .args([signal, &id])
            .status()
            .unwrap()
            .success()
    );
}

/// A run that was stopped behind a checkpoint.
fn stopped(directory: &Path) {
    let mut child = command(directory, &[]).spawn().unwrap();
    next_checkpoint(directory, &mut child, &None);
    child.kill().unwrap();
    child.wait().unwrap();
}

#[test]
fn a_run_that_is_killed_again_and_again_writes_the_same_bytes() {
    let folder = tempfile::tempdir().unwrap();
    let directory = folder.path();
    scene(directory, &[]);
    let begun = Instant::now();
    let (done, problem) = run(directory, &["--threads", "2"]);
    assert!(done, "{problem}");
    let whole = begun.elapsed();
    let wanted = read(directory);
    assert_eq!(names(directory), TABLES);
    std::fs::remove_dir_all(directory.join("s/scene.run")).unwrap();

    let mut killed = 0;
    let (mut part, mut patience, mut before) = (0.37_f64, 1.0, None);
    let mut more = vec!["--threads", "1"];
    loop {
        let mut child = command(directory, &more).spawn().unwrap();
        // Somewhere in a third of the run; later where the machine has become slower.
        part = (part + 0.618_033_988_749_894_9).fract();
        std::thread::sleep(whole.mul_f64(0.33 * part * patience));
        let ended = child.try_wait().unwrap();
        child.kill().unwrap();
        let output = child.wait_with_output().unwrap();
        if ended.is_some() {
            let (done, problem) = told(output);
            assert!(
                done || problem.contains("no run that was stopped"),
                "{problem}"
            );
            break;
        }
        let got_on = checkpoint(directory);
        if got_on == before {
            patience *= 1.3;
        }
        before = got_on;
        killed += 1;
        assert!(killed < 100, "it does not get on");
        // Killed before anything was there it is still to begin.
        let begun = directory.join("s/scene.run/events.csv.partial").exists();
        let threads = if killed % 2 == 0 { "1" } else { "2" };
        more = if begun {
            vec!["--resume", "--threads", threads]
        } else {
            vec!["--threads", threads]
        };
    }
    assert!(killed > 2, "killed {killed} times");
    assert!(read(directory) == wanted, "other bytes");
    assert_eq!(names(directory), TABLES);
}

#[test]
fn an_interrupted_run_says_how_it_goes_on_and_is_not_lost_unasked() {
    let folder = tempfile::tempdir().unwrap();
    let directory = folder.path();
    // Long enough to be there when it is looked at.
    let (long, short) = ("end = \"1.5 s\"", "end = \"0.5 s\"");
    scene(directory, &[(long, "end = \"100 s\"")]);
    let mut child = command(directory, &[]).spawn().unwrap();
    next_checkpoint(directory, &mut child, &None);
    // One at a time.
    for more in [&[][..], &["--resume"], &["--restart"]] {
        let (done, problem) = run(directory, more);
        assert!(
            !done && problem.contains("another windfall"),
            "{more:?}: {problem}"
        );
    }
    kill(&child, "-INT");
    let (done, problem) = told(child.wait_with_output().unwrap());
    assert!(!done && problem.contains("--resume"), "{problem}");
    assert!(problem.contains("of 100 s"), "{problem}");
    let there = ["checkpoint.bin", "events.csv.partial", "frames.bin.partial"];
    assert_eq!(names(directory), there);

    let (done, problem) = run(directory, &[]);
    assert!(!done, "lost");
    for word in ["was stopped after", "--resume", "--restart"] {
        assert!(problem.contains(word), "{problem}");
    }
    assert_eq!(names(directory), there);

    // Asked to end by the system.
    let before = checkpoint(directory);
    let mut child = command(directory, &["--resume"]).spawn().unwrap();
    next_checkpoint(directory, &mut child, &before);
    kill(&child, "-TERM");
    let (done, problem) = told(child.wait_with_output().unwrap());
    assert!(!done && problem.contains("--resume"), "{problem}");
    // Anew also with another scene.
    change(directory, "end = \"100 s\"", short);
    let (done, problem) = run(directory, &["--restart"]);
    assert!(done, "{problem}");
    assert_eq!(names(directory), TABLES);
    let (done, problem) = run(directory, &["--resume"]);
    assert!(
        !done && problem.contains("no run that was stopped"),
        "{problem}"
    );
    assert_eq!(names(directory), TABLES);
}

#[test]
fn rejects_another_scene_and_damaged_checkpoints() {
    let folder = tempfile::tempdir().unwrap();
    let directory = folder.path();
    scene(directory, &[]);
    stopped(directory);
    let out = directory.join("s/scene.run");
    let before = std::fs::read(out.join("checkpoint.bin")).unwrap();
    for (old, new, changed) in [
        (
            "friction = 0.3",
            "friction = 0.31",
            "contacts of apple and apple",
        ),
        (
            "belt = [0.5, 0, 0]",
            "belt = [0.6, 0, 0]",
            "wall \"conveyor\"",
        ),
        ("end = \"1.5 s\"", "end = \"1.4 s\"", "the end"),
        ("threshold = \"50 mJ\"", "threshold = \"51 mJ\"", "[bruise]"),
        ("count = 100", "count = 101", "fruit"),
        (
            "checkpoint = \"0.02 s\"",
            "checkpoint = \"0.03 s\"",
            "the times of checkpoints",
        ),
    ] {
        change(directory, old, new);
        let (done, problem) = run(directory, &["--resume"]);
        assert!(
            !done && problem.contains(&format!("changed: {changed}")),
            "{problem}"
        );
        change(directory, new, old);
    }
    for (bytes, words) in [
        (before[..before.len() / 2].to_vec(), "damaged"),
        (b"something else".to_vec(), "is none"),
        (Vec::new(), "ends early"),
    ] {
        std::fs::write(out.join("checkpoint.bin"), &bytes).unwrap();
        let (done, problem) = run(directory, &["--resume"]);
        assert!(
            !done && problem.contains(words) && problem.contains("--restart"),
            "{problem}"
        );
        let (done, problem) = run(directory, &[]);
        assert!(
            !done && problem.contains("holds a run that was stopped"),
            "{problem}"
        );
        assert_eq!(std::fs::read(out.join("checkpoint.bin")).unwrap(), bytes);
    }
    std::fs::write(out.join("checkpoint.bin"), before).unwrap();
    let table = std::fs::read(out.join("events.csv.partial")).unwrap();
    std::fs::write(out.join("events.csv.partial"), &table[..9]).unwrap();
    let (done, problem) = run(directory, &["--resume"]);
    assert!(!done && problem.contains("9 bytes"), "{problem}");
    std::fs::write(out.join("events.csv.partial"), table).unwrap();
    // A comment is no other scene.
    change(directory, "[scene]", "# A comment.\n[scene]");
    let (done, problem) = run(directory, &["--resume"]);
    assert!(done, "{problem}");

    for (new, words) in [
        ("checkpoint = \"0 s\"", "above zero"),
        ("checkpoint = \"5 kg\"", "5 kg"),
    ] {
        change(directory, "checkpoint = \"0.02 s\"", new);
        let (done, problem) = run(directory, &[]);
        assert!(!done && problem.contains(words), "{problem}");
        change(directory, new, "checkpoint = \"0.02 s\"");
    }
}

/// A command of which no file can grow beyond so many blocks of 512 bytes: writing ends with an
/// error there, as on a full disk, whoever runs it.
fn with_room(blocks: usize, directory: &Path, arguments: &[&str]) -> (bool, String) {
    let output = Command::new("sh")
        .args(["-c", "trap '' XFSZ; ulimit -f \"$0\"; exec \"$@\""])
        .arg(blocks.to_string())
        .arg(WINDFALL)
        .args(arguments)
        .current_dir(directory)
        .output()
        .unwrap();
    told(output)
}

fn run_in(blocks: usize, directory: &Path, more: &[&str]) -> (bool, String) {
    let arguments = [&["scene", "run", "s/scene.toml"], more].concat();
    with_room(blocks, directory, &arguments)
}

#[test]
fn a_full_disk_leaves_the_results_of_fits_as_they_were() {
    let folder = tempfile::tempdir().unwrap();
    let directory = folder.path();
    let law = "kuwabara-kono(k=753599, c=1524)";
    let made = [
        "simulate",
        "pendulum",
        "--law",
        law,
        "--recordings",
        "p",
        "--specimens",
        "2",
    ];
    for arguments in [&made[..], &["fit", "p"]] {
        let (done, problem) = with_room(100_000, directory, arguments);
        assert!(done, "{problem}");
    }
    let store = directory.join("p/results.sqlite");
    let before = std::fs::read(&store).unwrap();
    let (done, problem) = with_room(
        before.len() / 512,
        directory,
        &["fit", "p", "--law", "hertz"],
    );
    assert!(!done, "there was room");
    for words in [
        "results.sqlite: cannot write",
        "earlier results are as they were",
        "make room",
    ] {
        assert!(problem.contains(words), "{problem}");
    }
    assert!(std::fs::read(&store).unwrap() == before);
    let (done, problem) = with_room(100_000, directory, &["fit", "p", "--law", "hertz"]);
    assert!(done, "{problem}");
}

#[test]
fn a_full_disk_loses_nothing_of_a_scene() {
    let folder = tempfile::tempdir().unwrap();
    let directory = folder.path();
    scene(directory, &[]);
    let (done, problem) = run(directory, &[]);
    assert!(done, "{problem}");
    let before = read(directory);
    let sizes: Vec<usize> = before.iter().map(|own| own.len() / 512).collect();
    let table = TABLES.iter().position(|own| *own == "events.csv").unwrap();
    // Other results, so that those of before can be told from them.
    change(directory, "seed = 1", "seed = 2");

    // No room at all: nothing was done, and what was there is there.
    let (done, problem) = run_in(0, directory, &[]);
    assert!(
        !done && problem.contains("Make room and run the scene again"),
        "{problem}"
    );
    assert!(read(directory) == before);
    assert_eq!(names(directory), TABLES);

    // Room for some of the table: what was done up to a checkpoint is kept.
    let (done, problem) = run_in(sizes[table] / 2, directory, &[]);
    assert!(!done && problem.contains("cannot write"), "{problem}");
    assert!(
        problem.contains("is kept: make room") && problem.contains("--resume"),
        "{problem}"
    );
    assert!(read(directory) == before);
    // Still none.
    let (done, problem) = run_in(sizes[table] / 2, directory, &["--resume"]);
    assert!(!done && problem.contains("--resume"), "{problem}");
    assert!(read(directory) == before);
    // Room was made.
    let (done, problem) = run(directory, &["--resume"]);
    assert!(done, "{problem}");
    let resumed = read(directory);
    assert!(resumed != before);
    let (done, problem) = run(directory, &[]);
    assert!(done, "{problem}");
    assert!(read(directory) == resumed, "other bytes");
    assert_eq!(names(directory), TABLES);
}

#[test]
fn a_run_that_is_killed_while_it_names_its_files_goes_on() {
    let folder = tempfile::tempdir().unwrap();
    let directory = folder.path();
    scene(directory, &[]);
    let (done, problem) = run(directory, &[]);
    assert!(done, "{problem}");
    let wanted = read(directory);
    let results = directory.join("s/scene.run");
    std::fs::remove_dir_all(&results).unwrap();
    stopped(directory);
    // The frames have their name before the table of contacts has.
    let partial = results.join("frames.bin.partial");
    windfall_files::written::list_written_as(&results.join("frames.bin"), &partial).unwrap();
    std::fs::rename(partial, results.join("frames.bin")).unwrap();
    let (done, problem) = run(directory, &["--resume"]);
    assert!(done, "{problem}");
    assert!(read(directory) == wanted, "other bytes");
    assert_eq!(names(directory), TABLES);
}
