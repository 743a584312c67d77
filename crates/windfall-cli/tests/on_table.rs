//! A command on one table, for the tests of several commands.

use assert_cmd::Command;
use serde_json::Value;

/// Exit status, output and messages of a command on a table, which is called `t.csv`.
pub fn run(table: &str, arguments: &[&str]) -> (Option<i32>, String, String) {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("t.csv"), table).unwrap();
    let mut command = Command::cargo_bin("windfall").unwrap();
    let output = command.args(arguments).current_dir(folder.path()).output();
    let output = output.unwrap();
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    (
        output.status.code(),
        text(&output.stdout),
        text(&output.stderr),
    )
}

/// The JSON of a command that succeeds.
pub fn json(table: &str, arguments: &[&str]) -> Value {
    let (status, output, told) = run(table, &[arguments, &["--format", "json"]].concat());
    assert_eq!(status, Some(0), "{arguments:?}: {told}");
    serde_json::from_str(&output).unwrap()
}

/// A number within a relative error.
pub fn close(found: &Value, expected: f64, limit: f64) {
    let found = found.as_f64().unwrap();
    assert!((found / expected - 1.0).abs() < limit, "{found} {expected}");
}
