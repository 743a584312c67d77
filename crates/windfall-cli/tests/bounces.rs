//! Restitution from intervals between impacts, from the command line.

#![allow(clippy::unwrap_used)]

use assert_cmd::Command;
use std::path::PathBuf;

struct Run {
    code: i32,
    text: String,
    error: String,
}

fn windfall(arguments: &[&str]) -> Run {
    let output = Command::cargo_bin("windfall")
        .unwrap()
        .args(arguments)
        .output()
        .unwrap();
    let text = |bytes: Vec<u8>| String::from_utf8(bytes).unwrap();
    Run {
        code: output.status.code().unwrap(),
        text: text(output.stdout),
        error: text(output.stderr),
    }
}

fn json(arguments: &[&str]) -> serde_json::Value {
    let run = windfall(&[&["bounces"], arguments, &["--format", "json"]].concat());
    serde_json::from_str(&run.text).unwrap_or_else(|_| panic!("{}", run.error))
}

fn table(text: &str) -> (tempfile::TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("drops.csv");
    std::fs::write(&path, text).unwrap();
    (folder, path)
}

fn codes(outcome: &serde_json::Value) -> Vec<&str> {
    let findings = outcome["findings"].as_array().unwrap();
    findings
        .iter()
        .map(|own| own["code"].as_str().unwrap())
        .collect()
}

#[track_caller]
fn check(found: &serde_json::Value, expected: f64) {
    let found = found.as_f64().unwrap();
    assert!(
        (found - expected).abs() <= 1e-12 * expected.abs(),
        "{found} against {expected}"
    );
}

/// By hand: 0.4/0.5 and 0.3/0.4, their geometric mean √0.6, a stopwatch of 1 ms.
#[test]
fn closed_form_typed_intervals() {
    for text in ["0.500, 0.4, 0.3 s", "500 400 300 ms", "0,500; 0,4; 0,3 s"] {
        let found = json(&["--intervals", text]);
        let impacts = found["drops"][0]["impacts"].as_array().unwrap();
        assert_eq!(impacts.len(), 2);
        check(&impacts[0]["restitution"], 0.8);
        check(&impacts[1]["restitution"], 0.75);
        check(&impacts[1]["speed"], 0.2 * 9.80665);
        check(&found["drops"][0]["restitution"], 0.6f64.sqrt());
        check(&found["resolution"], 0.001);
        check(&found["mean"]["restitution"], 0.775);
        assert_eq!(found["mean"]["over"], "impacts");
    }
}

/// Three drops by hand, one of them with a missed impact: 0.8, 0.75, and 1.25, which is none.
/// The mean of two, 0.775 ± t₁ 0.025 with t₁ = 12.706.
const DROPS: &str = "variety,drop,t1_ms,t2_ms,drop_height_cm,exclude
Gala,a,500.0,400.0,,
Gala,b,400.0,300.0,,
Fuji,c,400.0,500.0,,
Fuji,d,400.0,100.0,,yes
Fuji,e,0,100.0,,
";

#[test]
fn closed_form_table_of_drops() {
    let (_folder, path) = table(DROPS);
    let path = path.to_str().unwrap();
    let found = json(&[path]);
    check(&found["mean"]["restitution"], 0.775);
    check(&found["resolution"], 1e-4);
    assert_eq!(found["mean"]["n"], 2);
    let low = found["mean"]["low"].as_f64().unwrap();
    assert!((low - (0.775 - 12.706_204_7 * 0.025)).abs() < 1e-7);
    let left_out = found["drops"][2]["left_out"].as_str().unwrap();
    assert!(left_out.contains("impact 2") && left_out.contains("1.25"));
    assert_eq!(
        codes(&found),
        [
            "too-few-intervals",
            "drop-left-out",
            "drop-left-out",
            "zero-interval"
        ]
    );
    let csv = windfall(&["bounces", path, "--format", "csv"]);
    let lines: Vec<&str> = csv.text.lines().collect();
    assert!(lines[0].ends_with(",left_out,variety,drop_height_cm,exclude"));
    assert!(lines[1].starts_with("a,2,2.4516625,0.8,") && lines[1].contains(",Gala,"));
    let text = windfall(&["bounces", path]).text;
    assert!(text.contains("no drag of the air") && text.contains("does not count"));
}

/// The sounds of the last impacts fade, and one is missed: 0.6 after 0.32 cannot be, and neither
/// of these two intervals is used. What stands before them is: 0.8.
#[test]
fn closed_form_end_of_a_drop_is_not_used() {
    let found = json(&["--intervals", "0.50, 0.40, 0.32, 0.60, 0.25 s"]);
    let drop = &found["drops"][0];
    assert_eq!(drop["impacts"].as_array().unwrap().len(), 1);
    check(&drop["restitution"], 0.8);
    assert_eq!(drop["unused_from"], 3);
    assert_eq!(codes(&found), ["drop-cut-short"]);
}

/// A drop in each column, as below each other in the export of a phone's acoustic stopwatch.
#[test]
fn closed_form_drops_in_columns() {
    let (_folder, path) = table("Event time (s),Interval (s)\n2.5,0.5\n3.0,0.4\n3.4,0.3\n3.7,0\n");
    let path = path.to_str().unwrap();
    let found = json(&[path, "--each-column", "--height", "40 cm"]);
    let impacts = found["drops"][0]["impacts"].as_array().unwrap();
    assert_eq!(found["drops"][0]["drop"], "drops");
    assert_eq!(impacts.len(), 3);
    check(&impacts[0]["speed"], (0.8 * 9.80665f64).sqrt());
    check(
        &impacts[0]["restitution"],
        0.25 * 9.80665 / (0.8 * 9.80665f64).sqrt(),
    );
    // Read as rows there is one interval a drop: the message names the way out.
    let run = windfall(&["bounces", path]);
    assert_eq!(run.code, 2);
    assert!(run.error.contains("--each-column"), "{}", run.error);
}

#[test]
fn rejects_what_is_no_interval() {
    let cases = [
        (
            "t1_s,t2_s\n0.5,fast\n",
            "line 2: column \"t2_s\": \"fast\": this is no time",
        ),
        ("t1_s,t2_s\n0.5,-0.4\n", "an interval cannot be negative"),
        ("t1_s,t2_s\n0.5,1e400\n", "this is no time"),
        (
            "t1_s,t2_s\n0.5,nan\n",
            "no drop has two successive intervals",
        ),
        ("first,second\n0.5,0.4\n", "must end with its unit of time"),
        ("t1_s,t2_s,height_m\n0.5,0.4,-1\n", "height_m"),
    ];
    for (text, expected) in cases {
        let (_folder, path) = table(text);
        let run = windfall(&["bounces", path.to_str().unwrap()]);
        assert_eq!(run.code, 2, "{text}: {}", run.text);
        assert!(run.error.contains(expected), "{text}: {}", run.error);
    }
    let options: [(&[&str], &str); 6] = [
        (&["--intervals", "0.5, 0.4"], "the unit is missing"),
        (&["--intervals", "0.5, 0.4 kg"], "no unit of time"),
        (
            &["--intervals", "0.5 s"],
            "no drop has two successive intervals",
        ),
        (
            &["--intervals", "0.5, 0.4 s", "--contact", "0.4 s"],
            "is not longer than the contact",
        ),
        (
            &["--intervals", "0.5, 0.4 s", "--resolution", "0 s"],
            "must be above zero",
        ),
        (
            &["--intervals", "0.5, 0.4 s", "--height", "3 s"],
            "--height",
        ),
    ];
    for (arguments, expected) in options {
        let run = windfall(&[&["bounces"], arguments].concat());
        assert_eq!(run.code, 2, "{arguments:?}: {}", run.text);
        assert!(run.error.contains(expected), "{arguments:?}: {}", run.error);
    }
}
