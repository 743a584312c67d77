//! `windfall fit FILE --rig …`: one recording without a campaign.

#![allow(clippy::unwrap_used, clippy::print_stdout)]

use assert_cmd::cargo::cargo_bin;
use std::path::Path;
use std::process::{Command, Output};

fn windfall(arguments: &[&str]) -> Output {
    Command::new(cargo_bin("windfall"))
        .args(arguments)
        .output()
        .unwrap()
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).unwrap()
}

fn json(arguments: &[&str]) -> serde_json::Value {
    let output = windfall(arguments);
    assert!(output.status.success(), "{}", text(&output.stderr));
    serde_json::from_slice(&output.stdout).unwrap()
}

const PENDULUM: [&str; 10] = [
    "--rig",
    "pendulum",
    "--inertia",
    "0.01435 kg m^2",
    "--arm",
    "0.505 m",
    "--mass",
    "110 g",
    "--centre-of-mass",
    "300 mm",
];

/// A recording and the campaign around it give the same bits as the flags that
/// say what the campaign says.
#[test]
fn repeats_the_fit_of_the_campaign_from_flags() {
    let scratch = tempfile::tempdir().unwrap();
    let directory = scratch.path().join("campaign");
    let directory = directory.to_str().unwrap();
    let law = "kuwabara-kono(k=753599, c=1524)";
    let simulate = [
        "simulate",
        "pendulum",
        "--law",
        law,
        "--recordings",
        directory,
        "--specimens",
        "1",
        "--encoder",
        "counts",
        "--bits",
        "16",
    ];
    assert!(windfall(&simulate).status.success());
    let campaign = json(&["fit", directory, "--format", "json"]);

    let stray = scratch.path().join("stray.csv");
    std::fs::copy(Path::new(directory).join("raw/specimen-01.csv"), &stray).unwrap();
    let mut arguments = vec!["fit", stray.to_str().unwrap()];
    arguments.extend(PENDULUM);
    let channels = [
        "--sampling-rate",
        "200 kHz",
        "--channel",
        "force=force_V:11 mV/N",
        "--channel",
        "count=count",
        "--counts-per-revolution",
        "360000",
        "--threshold",
        "1 N",
        "--quantities",
        "displacement,force",
        "--law",
        "kuwabara-kono",
        "--format",
        "json",
    ];
    arguments.extend(channels);
    let one = json(&arguments);
    for key in ["parameters", "cost", "samples", "derived", "findings"] {
        assert_eq!(one["impacts"][0][key], campaign["impacts"][0][key], "{key}");
    }
    assert_eq!(one["impacts"][0]["id"], "stray");
    let left: Vec<_> = std::fs::read_dir(scratch.path()).unwrap().collect();
    assert_eq!(left.len(), 2, "nothing is written");
}

/// Columns t, x, xdot, F in SI, noise-free and beginning at first touch: what
/// was put in comes out to the accuracy of the integration.
#[test]
fn recovers_parameters_from_columns_in_si() {
    let scratch = tempfile::tempdir().unwrap();
    let motion = text(
        &windfall(&[
            "simulate",
            "pendulum",
            "--law",
            "kuwabara-kono(k=394931, c=681)",
            "--format",
            "csv",
        ])
        .stdout,
    );
    let mut table = String::from("t,x,xdot,F\n");
    for line in motion.lines().skip(1) {
        let cells: Vec<&str> = line.split(',').collect();
        if !cells[0].starts_with('-') {
            table += &(cells[..4].join(",") + "\n");
        }
    }
    let file = scratch.path().join("motion.csv");
    std::fs::write(&file, table).unwrap();
    let mut arguments = vec!["fit", file.to_str().unwrap()];
    arguments.extend(PENDULUM);
    let channels = [
        "--time",
        "t",
        "--channel",
        "position=x:m",
        "--channel",
        "velocity=xdot",
        "--channel",
        "force=F:N",
        "--law",
        "kuwabara-kono",
        "--threshold",
        "1 N",
        "--format",
        "json",
    ];
    arguments.extend(channels);
    let found = json(&arguments);
    let parameters = &found["impacts"][0]["parameters"];
    for (name, put_in) in [("k", 394_931.0), ("c", 681.0)] {
        let value = parameters[name]["value"].as_f64().unwrap();
        assert!((value / put_in - 1.0).abs() < 1e-7, "{name}: {value}");
    }
}

/// A cart that was not weighed: sensors of unlike rates, mass from impulse.
#[test]
fn recovers_mass_and_law_of_a_simulated_carriage() {
    let scratch = tempfile::tempdir().unwrap();
    let directory = scratch.path().join("campaign");
    let directory = directory.to_str().unwrap();
    let simulate = [
        "simulate",
        "carriage",
        "--law",
        "kelvin-voigt(k=2000, c=3)",
        "--mass",
        "0.5 kg",
        "--velocity",
        "0.4 m/s",
        "--driving-acceleration",
        "0.3 m/s^2",
        "--recordings",
        directory,
        "--specimens",
        "12",
        "--sensor",
        "force: rate=5 kHz, noise=0.1 N",
        "--sensor",
        "position: rate=500 Hz, noise=0.05 mm, bits=14",
        "--unweighed",
        "--seed",
        "5",
    ];
    let output = windfall(&simulate);
    assert!(output.status.success(), "{}", text(&output.stderr));
    let found = json(&["fit", directory, "--format", "json"]);
    let mass = &found["effective_mass"];
    let (value, sd) = (
        mass["value"].as_f64().unwrap(),
        mass["sd"].as_f64().unwrap(),
    );
    assert_eq!(mass["impacts"], 12);
    assert!(
        (value - 0.5).abs() < 4.0 * sd && sd < 0.005,
        "{value} ± {sd}"
    );
    for impact in found["impacts"].as_array().unwrap() {
        for (name, put_in) in [("k", 2000.0), ("c", 3.0)] {
            let parameter = &impact["parameters"][name];
            let (value, sd) = (
                parameter["value"].as_f64().unwrap(),
                parameter["sd"].as_f64().unwrap(),
            );
            assert!(
                (value - put_in).abs() < 4.5 * sd && sd < 0.1 * put_in,
                "{name} {value} ± {sd}"
            );
        }
    }
}

/// DOMAIN.md, 1.5: the law of Flores with a nominal 0.7 delivers 0.6832.
#[test]
fn reference_nominal_restitution_stands_beside_the_delivered_one() {
    let law = "flores(k=753599, restitution=0.7, impact_velocity=0.5)";
    let event = ["--mass", "0.2 kg", "--velocity", "0.5 m/s"];
    let mut arguments = vec!["simulate", "impact", "--law", law, "--format", "json"];
    arguments.extend(event);
    let simulated = json(&arguments);
    assert_eq!(simulated["nominal_restitution"], 0.7);
    assert!((simulated["restitution"].as_f64().unwrap() - 0.6832).abs() < 5e-5);

    let scratch = tempfile::tempdir().unwrap();
    let directory = scratch.path().join("campaign");
    let directory = directory.to_str().unwrap();
    let mut arguments = vec!["simulate", "carriage", "--law", law, "--specimens", "1"];
    arguments.extend(event);
    arguments.extend(["--recordings", directory]);
    assert!(windfall(&arguments).status.success());
    let fitted = json(&["fit", directory, "--format", "json"]);
    let fitted = &fitted["impacts"][0]["fitted"];
    let of = |name: &str| fitted[name].as_f64().unwrap();
    assert!((of("nominal_restitution") - 0.7).abs() < 0.01, "{fitted}");
    assert!((of("restitution") - 0.6832).abs() < 0.01, "{fitted}");
    assert!(of("nominal_restitution") > of("restitution"));

    let table = text(&windfall(&["fit", directory]).stdout);
    assert!(table.contains("nominal beside delivered"), "{table}");
    let csv = text(&windfall(&["fit", directory, "--format", "csv"]).stdout);
    assert!(csv.starts_with("id,") && csv.contains(",restitution_delivered,restitution_nominal,"));
}

#[test]
fn rejects_wrong_flags_of_a_recording_with_a_way_out() {
    let scratch = tempfile::tempdir().unwrap();
    let file = scratch.path().join("impact.csv");
    std::fs::write(&file, "t,F\n0,0\n0.001,1\n").unwrap();
    let file = file.to_str().unwrap();
    let cases: [(&[&str], &str); 9] = [
        (&["--time", "t"], "--channel force=F:N"),
        (
            &[
                "--time",
                "t",
                "--sampling-rate",
                "1 kHz",
                "--channel",
                "force=F:N",
            ],
            "cannot be used with",
        ),
        (
            &["--time", "t", "--channel", "force=F:mm"],
            "\"1 mm\" is a length",
        ),
        (
            &["--time", "t", "--channel", "forse=F"],
            "did you mean \"force\"",
        ),
        (
            &["--time", "t", "--channel", "force"],
            "name the column of the recording",
        ),
        (&["--time", "t:N", "--channel", "force=F"], "is a force"),
        (
            &["--time", "t", "--channel", "force=F", "--threshold", "0 N"],
            "must be above zero",
        ),
        (
            &["--time", "t", "--channel", "force=G"],
            "no column \"G\" (asked for as [channels.force])",
        ),
        (
            &["--time", "t", "--channel", "force=F", "--law", "hertz"],
            "each law can be fitted once",
        ),
    ];
    for (more, expected) in cases {
        let mut arguments = vec!["fit", file, "--law", "hertz"];
        arguments.extend(PENDULUM);
        arguments.extend(more);
        let output = windfall(&arguments);
        let said = text(&output.stderr);
        assert!(!output.status.success(), "{more:?}");
        let said = said + &text(&output.stdout).replace("\n    ", " ");
        assert!(said.contains(expected), "{more:?}: {said}");
    }
    let no_arm = ["fit", file, "--rig", "pendulum", "--law", "hertz"];
    let output = windfall(&no_arm);
    assert_eq!(output.status.code(), Some(2));
    assert!(text(&output.stderr).contains("a pendulum needs it, for example"));
}

/// What a person reads stays within 100 columns.
#[test]
fn closed_form_tables_fit_a_page() {
    let scratch = tempfile::tempdir().unwrap();
    let directory = scratch.path().join("example");
    let directory = directory.to_str().unwrap();
    let example = ["simulate", "pendulum", "--example", directory];
    assert!(windfall(&example).status.success());
    let laws = [
        "--law",
        "kuwabara-kono",
        "--law",
        "flores",
        "--law",
        "power-law",
    ];
    let mut arguments = vec!["fit", directory, "--free", "n"];
    arguments.extend(laws);
    let shown = text(&windfall(&arguments).stdout);
    for line in shown.lines() {
        assert!(line.chars().count() <= 100, "{line}");
    }
    assert!(shown.contains("potato") && shown.contains("SIMULATED recordings"));
}
