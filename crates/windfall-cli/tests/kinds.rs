//! Every kind of campaign from the command line: template, simulation, fit, figures.

#![allow(clippy::unwrap_used)]

use assert_cmd::Command;
use std::path::Path;

fn windfall(arguments: &[&str]) -> String {
    let output = Command::cargo_bin("windfall")
        .unwrap()
        .args(arguments)
        .output()
        .unwrap();
    let messages = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{arguments:?}: {messages}");
    String::from_utf8(output.stdout).unwrap()
}

fn json(arguments: &[&str]) -> serde_json::Value {
    serde_json::from_str(&windfall(arguments)).unwrap()
}

#[test]
fn template_of_every_kind() {
    let folder = tempfile::tempdir().unwrap();
    for kind in [
        "pendulum",
        "carriage",
        "compression",
        "acoustic",
        "repeats",
        "drop",
    ] {
        let campaign = folder.path().join(kind);
        windfall(&["new", kind, campaign.to_str().unwrap()]);
        let settings = std::fs::read_to_string(campaign.join("campaign.toml")).unwrap();
        settings.parse::<toml::Table>().unwrap();
        // Nothing is overwritten.
        let again = Command::cargo_bin("windfall")
            .unwrap()
            .args(["new", kind, campaign.to_str().unwrap()])
            .output()
            .unwrap();
        assert!(!again.status.success());
    }
}

/// Simulates, fits as JSON and with figures; the results.
fn simulated(folder: &Path, simulate: &[&str]) -> Vec<serde_json::Value> {
    let campaign = folder.join("campaign");
    let campaign = campaign.to_str().unwrap();
    let figures = folder.join("figures");
    let mut arguments = vec!["simulate", simulate[0], campaign];
    arguments.extend(&simulate[1..]);
    windfall(&arguments);
    let fitted = json(&["fit", campaign, "--format", "json"]);
    windfall(&["fit", campaign, "--figures", figures.to_str().unwrap()]);
    let drawn = std::fs::read_dir(&figures).unwrap();
    let drawn: Vec<_> = drawn.map(|entry| entry.unwrap().path()).collect();
    for kind in ["svg", "png", "csv"] {
        let found = drawn
            .iter()
            .any(|path| path.extension() == Some(kind.as_ref()));
        assert!(found, "no {kind} among {drawn:?}");
    }
    fitted["impacts"].as_array().unwrap().clone()
}

fn value(result: &serde_json::Value, path: &str) -> f64 {
    result.pointer(path).and_then(|v| v.as_f64()).unwrap()
}

/// What was put in comes out, within the standard deviations that are told.
#[test]
fn compression_from_simulation_to_figures() {
    let folder = tempfile::tempdir().unwrap();
    let law = "kuwabara-kono(k=300000, c=20000)";
    let rates = ["--rate", "1 mm/s", "--rate", "20 mm/s"];
    let mut arguments = vec!["compression", "--law", law, "--yield-force", "30 N"];
    arguments.extend(rates);
    let results = simulated(folder.path(), &arguments);
    assert_eq!(results.len(), 6);
    for result in &results {
        for (name, truth) in [("k", 300_000.0), ("c", 20_000.0)] {
            let found = value(result, &format!("/parameters/{name}/value"));
            let sd = value(result, &format!("/parameters/{name}/sd"));
            assert!((found - truth).abs() < 4.0 * sd, "{name}: {found} ± {sd}");
        }
    }
}

#[test]
fn taps_from_simulation_to_figures() {
    let folder = tempfile::tempdir().unwrap();
    let arguments = ["tap", "--frequency", "640 Hz", "--spread", "0"];
    let results = simulated(folder.path(), &[&arguments[..], &["--fruit", "2"]].concat());
    assert_eq!(results.len(), 2 * 2 * 2);
    for result in &results {
        let found = value(result, "/parameters/acoustic_frequency/value");
        assert!((found / 640.0 - 1.0).abs() < 1e-3, "{found} Hz");
    }
}

#[test]
fn repeats_from_simulation_to_figures() {
    let folder = tempfile::tempdir().unwrap();
    let arguments = ["repeats", "--fruit", "6", "--critical-energy", "0.12 J"];
    let energies = ["--energy", "0.05 J", "--energy", "0.4 J"];
    let spread = ["--spread", "0.1"];
    let arguments = [&arguments[..], &energies, &spread].concat();
    let results = simulated(folder.path(), &arguments);
    // Six fruit and a ball that is struck three times at each energy.
    assert_eq!(results.len(), 6 * 2 * 2 + 2 * 3);
    let campaign = folder.path().join("campaign");
    let fitted = json(&["fit", campaign.to_str().unwrap(), "--format", "json"]);
    for fruit in fitted["specimens"].as_array().unwrap() {
        assert_eq!(value(fruit, "/derived/changed_at/value"), 0.4);
    }
    let over_fruit = ["/whole/0/words/verdict", "/whole/1/words/verdict"];
    let verdicts = over_fruit.map(|path| fitted.pointer(path).unwrap().clone());
    assert_eq!(verdicts, ["unchanged", "changed"]);
}

/// Drops: bounces, and stiffness and damping of the plate from its ringing.
#[test]
fn drops_from_simulation_to_figures() {
    let folder = tempfile::tempdir().unwrap();
    let law = "adams-impact(k=\"0.868 N/mm^1.91\", e=1.91, c=\"5.56e-4 N s/mm\", d=\"0.001 mm\")";
    let fruit = ["drop", "--law", law, "--mass", "4.8 g"];
    let heights = ["--height", "300 mm", "--height", "500 mm", "--drops", "2"];
    let plate = ["--plate-mass", "0.2 kg", "--plate-stiffness", "645.8 N/mm"];
    let damping = ["--plate-damping", "0.05247 N s/mm"];
    let arguments = [&fruit[..], &heights, &plate, &damping].concat();
    let results = simulated(folder.path(), &arguments);
    assert_eq!(results.len(), 4);
    for result in &results {
        assert_eq!(result["law"], "drop");
        let e = value(result, "/derived/restitution/value");
        let sd = value(result, "/derived/restitution/sd");
        assert!((0.7..0.8).contains(&e) && sd < 0.01, "{e} ± {sd}");
    }
    let campaign = folder.path().join("campaign");
    let fitted = json(&["fit", campaign.to_str().unwrap(), "--format", "json"]);
    let whole = fitted["whole"].as_array().unwrap();
    let plate = whole.iter().find(|item| item["law"] == "plate").unwrap();
    let stiffness = value(plate, "/derived/plate_stiffness/value");
    assert!((stiffness / 645_800.0 - 1.0).abs() < 2e-3, "{stiffness}");
    assert!(fitted["parts"].as_array().unwrap().len() >= 4 * 2);
}

/// Hertz: 1/R* of a sphere of 31.5 mm mean radius against one of 25 mm; a plane
/// against 25 mm takes k by √(R*'/R*) = 0.613, as for an apple of 41.5 mm.
#[test]
fn geometry_from_the_command_line() {
    let radii = ["radius", "--diameters", "72 mm, 70 mm, 65 mm"];
    let shown = windfall(&[&radii[..], &["--against", "25 mm"]].concat());
    assert!(shown.contains("13.94 mm"), "{shown}");
    let from_to = ["--from", "41.5 mm, plane", "--to", "41.5 mm, 25 mm"];
    let transfer = ["card", "transfer", "--law", "hertz(k=733196)"];
    let shown = windfall(&[&transfer[..], &from_to].concat());
    let exact = 733_196.0 * (25.0_f64 / (41.5 + 25.0)).sqrt();
    let law = shown.lines().next().unwrap();
    let told = law.trim_start_matches("hertz(k=").trim_end_matches(')');
    let told: f64 = told.parse().unwrap();
    assert!((told / exact - 1.0).abs() < 1e-12, "{shown}");
    assert!(shown.contains("0.6131"), "{shown}");
}
