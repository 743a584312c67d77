//! `windfall scene`, `windfall bruise` and their exports as a user meets them.
#![allow(clippy::unwrap_used)]

#[cfg(unix)]
mod engines;
mod moves;
mod periodic;
mod ranks;
mod ranks_resume;
mod run;
mod start;
mod study;
mod view;
mod walls;

use assert_cmd::Command;
use std::path::Path;

/// Whether a command succeeds, and what it says on both streams.
fn windfall(arguments: &[&str], directory: &Path) -> (bool, String, String) {
    said(windfall_command(arguments, directory))
}

fn windfall_command(arguments: &[&str], directory: &Path) -> Command {
    let mut command = Command::cargo_bin("windfall").unwrap();
    command.args(arguments).current_dir(directory);
    command
}

fn said(mut command: Command) -> (bool, String, String) {
    let output = command.output().unwrap();
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    (
        output.status.success(),
        text(&output.stdout),
        text(&output.stderr),
    )
}

/// Puts texts of a file in the place of others.
fn change(path: &Path, changes: &[(&str, &str)]) {
    let mut text = std::fs::read_to_string(path).unwrap();
    for (old, new) in changes {
        assert!(text.contains(old), "{old}");
        text = text.replace(old, new);
    }
    std::fs::write(path, text).unwrap();
}

/// The template's scene with changes, in s/scene.toml.
fn scene(directory: &Path, changes: &[(&str, &str)]) {
    let (done, _, problem) = windfall(&["new", "scene", "s"], directory);
    assert!(done, "{problem}");
    change(&directory.join("s/scene.toml"), changes);
}
