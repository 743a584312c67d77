//! Numbers of reference campaigns against the revision that stored results carry.
//!
//! When this fails because numbers were meant to change, raise `REVISION`, put the new
//! digests here, and tell in CHANGELOG.md which numbers moved, by how much, and why.

#![allow(clippy::unwrap_used)]

use assert_cmd::Command;
use serde_json::Value;
use windfall_files::provenance::{REVISION, digest_text};

/// Digits by which numbers are compared: fewer than those in which machines differ.
const DIGITS: usize = 9;

/// Parts of the results that hold numbers of the campaign, not of the run.
const PARTS: [&str; 6] = [
    "impacts",
    "parts",
    "specimens",
    "whole",
    "groups",
    "summary",
];

fn windfall(arguments: &[&str], folder: &std::path::Path) -> Vec<u8> {
    let mut command = Command::cargo_bin("windfall").unwrap();
    let output = command
        .args(arguments)
        .current_dir(folder)
        .output()
        .unwrap();
    let told = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{arguments:?}: {told}");
    output.stdout
}

/// All numbers below a value, with the keys that lead to them.
fn numbers(path: &str, value: &Value, found: &mut String) {
    match value {
        Value::Number(number) => {
            let number = number.as_f64().unwrap();
            found.push_str(&format!("{path} {number:.*e}\n", DIGITS - 1));
        }
        Value::Array(items) => {
            for (index, item) in items.iter().enumerate() {
                numbers(&format!("{path}/{index}"), item, found);
            }
        }
        Value::Object(fields) => {
            for (name, field) in fields {
                numbers(&format!("{path}/{name}"), field, found);
            }
        }
        _ => (),
    }
}

/// Digest of the numbers that `fit` gives for a simulated campaign.
fn digest(simulate: &[&str], fit: &[&str]) -> String {
    let folder = tempfile::tempdir().unwrap();
    windfall(simulate, folder.path());
    let fit = [&["fit", "campaign", "--format", "json"], fit].concat();
    let outcome: Value = serde_json::from_slice(&windfall(&fit, folder.path())).unwrap();
    let mut found = String::new();
    for part in PARTS {
        numbers(part, &outcome[part], &mut found);
    }
    assert!(found.lines().count() > 20, "{simulate:?}: {found}");
    digest_text(&found)[..16].to_owned()
}

#[test]
fn pinned_numbers_are_those_of_the_revision() {
    let carriage = [
        "simulate",
        "carriage",
        "--law",
        "kuwabara-kono(k=753599, c=1524)",
        "--mass",
        "0.2 kg",
        "--velocity",
        "0.5 m/s",
        "--specimens",
        "3",
        "--recordings",
        "campaign",
    ];
    let laws = [
        "--law",
        "kuwabara-kono",
        "--law",
        "hunt-crossley",
        "--law",
        "tsuji",
        "--law",
        "adams-impact",
    ];
    let compression = [
        "simulate",
        "compression",
        "campaign",
        "--law",
        "kuwabara-kono(k=300000, c=20000)",
        "--fruit",
        "2",
    ];
    let taps = ["simulate", "tap", "campaign", "--fruit", "2"];
    let repeats = ["simulate", "repeats", "campaign", "--fruit", "4"];
    let drops = [
        "simulate",
        "drop",
        "campaign",
        "--law",
        "kuwabara-kono(k=753599, c=1524)",
        "--mass",
        "0.2 kg",
        "--height",
        "200 mm",
    ];
    let found = [
        digest(&carriage, &laws),
        digest(&carriage, &["--intervals", "profile"]),
        digest(&compression, &[]),
        digest(&taps, &[]),
        digest(&repeats, &[]),
        digest(&drops, &[]),
    ];
    let expected = (
        13,
        [
            "a181b92d447f09bf",
            "404fe045a1a00105",
            "0d9a7fd3ea4b6a51",
            "362e0649b943bd49",
            "3e453baf43c8c589",
            "14c37f9ceb43806e",
        ]
        .map(str::to_owned),
    );
    assert_eq!((REVISION, found), expected);
}
