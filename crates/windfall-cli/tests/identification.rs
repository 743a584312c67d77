//! Intervals, comparison of laws and populations from the command line.

#![allow(clippy::unwrap_used)]

use serde_json::Value;
use std::path::Path;

fn windfall(arguments: &[&str]) -> assert_cmd::assert::Assert {
    let mut command = assert_cmd::Command::new(env!("CARGO_BIN_EXE_windfall"));
    command.args(arguments).assert()
}

fn printed(arguments: &[&str]) -> String {
    let output = windfall(arguments).success().get_output().stdout.clone();
    String::from_utf8(output).unwrap()
}

fn json(arguments: &[&str]) -> Value {
    serde_json::from_str(&printed(arguments)).unwrap()
}

/// Six fruit struck twice each.
fn campaign(folder: &Path) -> String {
    let directory = folder.join("campaign").display().to_string();
    let law = "kuwabara-kono(k=753599, c=1524)";
    let arguments = [
        "simulate",
        "pendulum",
        "--law",
        law,
        "--recordings",
        &directory,
        "--specimens",
        "6",
        "--repeats",
        "2",
        "--spread",
        "k=80000",
        "--spread",
        "c=200",
    ];
    printed(&arguments);
    directory
}

/// Each way says how it came about; the interval holds its value; the bootstrap
/// has the same bits on one thread and on two.
#[test]
fn recovers_intervals_of_every_kind() {
    let folder = tempfile::tempdir().unwrap();
    let directory = campaign(folder.path());
    for method in ["asymptotic", "profile", "bootstrap", "posterior"] {
        let found = json(&[
            "fit",
            &directory,
            "--intervals",
            method,
            "--replicates",
            "200",
            "--draws",
            "200",
            "--format",
            "json",
        ]);
        for impact in found["impacts"].as_array().unwrap() {
            assert_eq!(impact["intervals"]["method"], method);
            let k = &impact["parameters"]["k"];
            let of = |key: &str| k[key].as_f64().unwrap();
            assert!(of("low") < of("value") && of("value") < of("high"), "{k}");
            assert_eq!(impact["directions"].as_array().unwrap().len(), 5);
        }
    }
    let on = |threads: &str| {
        let found = json(&[
            "fit",
            &directory,
            "--intervals",
            "bootstrap",
            "--replicates",
            "200",
            "--seed",
            "7",
            "--refit",
            "--threads",
            threads,
            "--format",
            "json",
        ]);
        found["impacts"].clone()
    };
    assert_eq!(on("1"), on("2"));
    let text = printed(&[
        "fit",
        &directory,
        "--intervals",
        "posterior",
        "--draws",
        "200",
    ]);
    assert!(text.contains("largest R-hat"), "{text}");
    let refused = windfall(&[
        "fit",
        &directory,
        "--intervals",
        "bootstrap",
        "--replicates",
        "5",
    ]);
    let output = refused.code(2).get_output().stderr.clone();
    let message = String::from_utf8(output).unwrap();
    assert!(
        message.contains("too few to read an interval from"),
        "{message}"
    );
}

/// The law that made the recordings is first, and a single law is refused.
#[test]
fn recovers_the_law_that_made_them() {
    let folder = tempfile::tempdir().unwrap();
    let directory = campaign(folder.path());
    let found = json(&["laws", &directory, "--format", "json"]);
    assert_eq!(found["laws"][0]["law"], "kuwabara-kono");
    assert_eq!(found["verdict"], "sure");
    assert_eq!(found["impacts"], 12);
    let text = printed(&["laws", &directory]);
    assert!(
        text.contains("to their noise") && text.contains("one-level"),
        "{text}"
    );
    let refused = windfall(&["laws", &directory, "--law", "hertz"]);
    let output = refused.code(2).get_output().stderr.clone();
    assert!(
        String::from_utf8(output)
            .unwrap()
            .contains("nothing to be compared with")
    );
}

/// Population → card → simulation with a finding outside the card's range.
#[test]
fn recovers_a_population_and_its_card() {
    let folder = tempfile::tempdir().unwrap();
    let directory = campaign(folder.path());
    let card = folder.path().join("law.toml").display().to_string();
    let found = json(&[
        "population",
        &directory,
        "--card",
        &card,
        "--format",
        "json",
    ]);
    assert_eq!(found["fruits"], 6);
    let shown = printed(&["card", "show", "--file", &card]);
    assert!(shown.contains("between fruit: sd of ln k"), "{shown}");
    let simulated = json(&[
        "simulate",
        "impact",
        "--law",
        &card,
        "--mass",
        "0.2 kg",
        "--velocity",
        "2 m/s",
        "--format",
        "json",
    ]);
    assert!(
        simulated.to_string().contains("outside-card-range"),
        "{simulated}"
    );
}
