//! From raw volts to a law card, on the command line.

#![allow(clippy::unwrap_used)]

use assert_cmd::Command;
use serde_json::Value;
use std::path::Path;

fn windfall(directory: &Path, arguments: &[&str]) -> (i32, String, String) {
    let output = Command::cargo_bin("windfall")
        .unwrap()
        .current_dir(directory)
        .args(arguments)
        .output()
        .unwrap();
    let text = |bytes: Vec<u8>| String::from_utf8(bytes).unwrap();
    let code = output.status.code().unwrap();
    (code, text(output.stdout), text(output.stderr))
}

fn succeeded(directory: &Path, arguments: &[&str]) -> String {
    let (code, text, messages) = windfall(directory, arguments);
    assert_eq!(code, 0, "{arguments:?}: {messages}");
    text
}

/// Law of the study's optimum.
const LAW: &str = r#"adams-impact(k="0.868 N/mm^1.91", e=1.91, c="5.56e-4 N s/mm", d="0.001 mm")"#;

/// Simulated recordings in volts; the plate's stiffness and damping are not
/// given to the campaign.
fn simulated(directory: &Path) {
    let begin = ["simulate", "drop", "drops", "--law", LAW, "--mass", "4.8 g"];
    let plate = [
        "--plate-mass",
        "0.2 kg",
        "--plate-stiffness",
        "648 N/mm",
        "--plate-damping",
        "0.05247 N s/mm",
    ];
    let heights = ["--height", "200 mm", "--height", "500 mm"];
    let rest = ["--drops", "2", "--seed", "5"];
    succeeded(directory, &[&begin[..], &plate, &heights, &rest].concat());
}

/// Volts → waveform → law card → simulation: the law that was put in comes back
/// within 2 %, inside its intervals' reach, and the card carries it on.
#[test]
fn recovers_a_law_from_volts_to_its_card() {
    let folder = tempfile::tempdir().unwrap();
    let directory = folder.path();
    simulated(directory);
    let calibrate = ["calibrate", "drops", "--way", "waveform"];
    let more = ["--card", "law.toml", "--format", "json"];
    let text = succeeded(directory, &[&calibrate[..], &more].concat());
    let found: Value = serde_json::from_str(&text).unwrap();
    let waveform = &found["waveform"];
    assert_eq!(waveform["converged"], true);
    assert_eq!(waveform["impacts"], 8);
    assert!((waveform["misfit"].as_f64().unwrap() - 1.0).abs() < 0.1);
    let truth = [
        ("k", 0.868),
        ("e", 1.91),
        ("c", 0.556),
        ("plate_stiffness", 648_000.0),
        ("plate_damping", 52.47),
    ];
    let parameters = waveform["parameters"].as_array().unwrap();
    for (parameter, (name, truth)) in parameters.iter().zip(truth) {
        assert_eq!(parameter["name"], name);
        let shown = match &parameter["per_millimetre"] {
            Value::Null => &parameter["value"],
            shown => shown,
        };
        let (value, sd) = (
            shown["value"].as_f64().unwrap(),
            shown["sd"].as_f64().unwrap(),
        );
        assert!((value / truth - 1.0).abs() < 0.02, "{name}: {value}");
        assert!((value - truth).abs() < 4.0 * sd, "{name}: {value} ± {sd}");
        assert!(sd < 0.02 * truth, "{name}: {sd}");
    }
    let card = succeeded(directory, &["card", "show", "--file", "law.toml"]);
    for part in ["95 % interval", "waveforms of drops", "simulated", "m/s"] {
        assert!(card.contains(part), "{part} is not in\n{card}");
    }
    let drop = [
        "simulate", "drop", "--law", "law.toml", "--mass", "4.8 g", "--height", "500 mm",
        "--format", "json",
    ];
    let again: Value = serde_json::from_str(&succeeded(directory, &drop)).unwrap();
    // The rigid plate of the reference table: 12.9104 N for the true law.
    let peak = again.pointer("/impacts/0/peak_contact_force").unwrap();
    assert!(
        (peak.as_f64().unwrap() / 12.910_415_6 - 1.0).abs() < 5e-3,
        "{peak}"
    );
}

/// Features of recordings: three parameters from two heights.
#[test]
fn recovers_a_law_from_the_features_of_recordings() {
    let folder = tempfile::tempdir().unwrap();
    let directory = folder.path();
    simulated(directory);
    let arguments = [
        "calibrate",
        "drops",
        "--way",
        "features",
        "--format",
        "json",
    ];
    let found: Value = serde_json::from_str(&succeeded(directory, &arguments)).unwrap();
    let features = &found["features"];
    assert_eq!(features["rank"], 3);
    for (parameter, truth) in features["parameters"]
        .as_array()
        .unwrap()
        .iter()
        .zip([0.868, 1.91, 0.556])
    {
        let written = &parameter["written"];
        let value = written["value"].as_f64().unwrap();
        let sd = written["sd"].as_f64().unwrap();
        assert!((value - truth).abs() < 4.0 * sd, "{value} ± {sd}, {truth}");
        assert!((value / truth - 1.0).abs() < 0.15, "{value}, {truth}");
    }
}

#[test]
fn rejects_cards_that_are_none() {
    let folder = tempfile::tempdir().unwrap();
    let directory = folder.path();
    std::fs::write(directory.join("law.toml"), "format = 7\n").unwrap();
    let (code, _, message) = windfall(directory, &["card", "show", "--file", "law.toml"]);
    assert_ne!(code, 0);
    assert!(message.contains("law.toml"), "{message}");
    let (code, _, message) = windfall(directory, &["card", "show", "--file", "missing.toml"]);
    assert_ne!(code, 0);
    assert!(message.contains("missing.toml"), "{message}");
}

/// One height and two features leave a family: no card is written.
#[test]
fn rejects_a_card_of_a_family() {
    let folder = tempfile::tempdir().unwrap();
    let directory = folder.path();
    succeeded(directory, &["new", "drop", "drops"]);
    let impacts = "id,specimen,file,drop_height_mm,mass_g,peak_force_1_N,interval_1_ms\n\
                   d1,s1,none,500,4.8,19.04,498.2\n";
    std::fs::write(directory.join("drops/impacts.csv"), impacts).unwrap();
    std::fs::write(directory.join("drops/specimens.csv"), "id\ns1\n").unwrap();
    let toml = std::fs::read_to_string(directory.join("drops/campaign.toml")).unwrap();
    let toml = toml
        .replace("# plate_stiffness", "plate_stiffness")
        .replace("# plate_damping", "plate_damping");
    std::fs::write(directory.join("drops/campaign.toml"), toml).unwrap();
    let arguments = [
        "calibrate",
        "drops",
        "--way",
        "features",
        "--card",
        "law.toml",
    ];
    let (code, _, message) = windfall(directory, &arguments);
    assert_ne!(code, 0);
    assert!(message.contains("family"), "{message}");
    assert!(!directory.join("law.toml").exists());
}
