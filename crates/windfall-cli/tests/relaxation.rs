//! Campaigns of stress relaxation from the command line.

#![allow(clippy::unwrap_used)]

use assert_cmd::Command;
use std::path::{Path, PathBuf};

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

/// Position and force of a ramp of 0.4 s, a hold of 60 s and the way back, every 50 ms: by
/// superposition of the ramp, for a force that grows as time^1.5.
fn recording(fractions: [f64; 3], times: [f64; 2]) -> String {
    let part = |since: f64| {
        let left = |i: usize| fractions[1 + i] * (-since / times[i]).exp();
        fractions[0] + left(0) + left(1)
    };
    let force = |t: f64| {
        let steps = 2000;
        let until = t.min(0.4);
        let step = |k: i32| {
            let (from, to) = (until * f64::from(k) / 2e3, until * f64::from(k + 1) / 2e3);
            let rise = (to / 0.4).powf(1.5) - (from / 0.4).powf(1.5);
            rise * part(t - 0.5 * (from + to))
        };
        20.0 * (0..steps).map(step).sum::<f64>()
    };
    let mut text = "time_s,force_N,position_mm\n".to_owned();
    for i in 0..1240 {
        let t = 0.05 * f64::from(i) - 0.5;
        let noise = 0.004 * (2.3 * f64::from(i).powi(2)).sin();
        let (position, force) = match t {
            t if t < 0.0 => (5.0 * t, 0.0),
            t if t < 60.4 => (5.0 * t.min(0.4), force(t)),
            t => (
                2.0 - 5.0 * (t - 60.4),
                (force(60.4) - 30.0 * (t - 60.4)).max(0.0),
            ),
        };
        text += &format!("{:.3},{:.5},{position:.5}\n", t + 0.5, force + noise);
    }
    text
}

fn campaign(recordings: &[(&str, String)]) -> (tempfile::TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let directory = folder.path().join("holds");
    let run = windfall(&["new", "relaxation", directory.to_str().unwrap()]);
    assert_eq!(run.code, 0, "{}", run.error);
    let mut rows = "id,specimen,file\n".to_owned();
    for (name, text) in recordings {
        std::fs::write(directory.join(format!("raw/{name}.csv")), text).unwrap();
        rows += &format!("{name},fruit-1,{name}.csv\n");
    }
    std::fs::write(directory.join("impacts.csv"), rows).unwrap();
    (folder, directory)
}

fn json(directory: &Path) -> serde_json::Value {
    let run = windfall(&["fit", directory.to_str().unwrap(), "--format", "json"]);
    serde_json::from_str(&run.text).unwrap_or_else(|_| panic!("{}", run.error))
}

fn codes(item: &serde_json::Value) -> Vec<&str> {
    let findings = item["findings"].as_array().unwrap();
    findings
        .iter()
        .map(|own| own["code"].as_str().unwrap())
        .collect()
}

/// Half of the force stays, 0.3 relaxes in 0.9 s and 0.2 in 15 s.
#[test]
fn closed_form_ramp_and_hold() {
    let text = recording([0.5, 0.3, 0.2], [0.9, 15.0]);
    let (_folder, directory) = campaign(&[("fruit-1-a", text)]);
    let found = json(&directory);
    let items = found["impacts"].as_array().unwrap();
    assert_eq!(items.len(), 2, "{found}");
    assert_eq!(items[0]["law"], "maxwell-2");
    assert_eq!(items[1]["law"], "peleg");
    assert_eq!(items[0]["words"]["hold_ended_by"], "movement");
    let value = |name: &str| {
        let of = |table: &str| items[0][table][name]["value"].as_f64();
        of("parameters").or_else(|| of("derived")).unwrap()
    };
    for (name, expected, tolerance) in [
        ("residual_fraction", 0.5, 0.005),
        ("fraction_1", 0.3, 0.02),
        ("fraction_2", 0.2, 0.005),
        ("relaxation_time_1", 0.9, 0.03),
        ("relaxation_time_2", 15.0, 0.02),
        ("initial_force", 20.0, 0.01),
        ("ramp_duration", 0.4, 0.2),
        ("hold_duration", 60.0, 0.002),
    ] {
        let error = (value(name) / expected - 1.0).abs();
        assert!(
            error < tolerance,
            "{name}: {} against {expected}",
            value(name)
        );
    }
    assert!(codes(&items[0]).is_empty(), "{:?}", codes(&items[0]));
    let peleg = &items[1]["parameters"];
    assert!(peleg["peleg_k2"]["value"].as_f64().unwrap() > 1.0);
    assert!(peleg["peleg_k1"]["sd"].as_f64().unwrap() > 0.0);
    let figures = directory.join("figures");
    let directory = directory.to_str().unwrap();
    let run = windfall(&["fit", directory, "--figures", figures.to_str().unwrap()]);
    assert!(run.text.contains("Peleg k1 (s)"), "{}", run.text);
    assert!(figures.join("fruit-1-a.svg").exists());
    let run = windfall(&["report", directory]);
    assert_eq!(run.code, 0, "{}", run.error);
}

/// The hold alone, without the position: fractions are those at its start, and it is said.
#[test]
fn reference_hold_without_its_ramp() {
    let text = recording([0.5, 0.3, 0.2], [0.9, 15.0]);
    let lines: Vec<&str> = text.lines().collect();
    let held = lines[19..1200].join("\n");
    let (_folder, directory) = campaign(&[("a", format!("{}\n{held}\n", lines[0]))]);
    let file = directory.join("campaign.toml");
    let text = std::fs::read_to_string(&file).unwrap();
    let (before, _) = text.split_once("[channels.position]").unwrap();
    std::fs::write(&file, before).unwrap();
    let found = json(&directory);
    let item = &found["impacts"][0];
    assert_eq!(codes(item), ["ramp_not_recorded"]);
    let residual = &item["parameters"]["residual_fraction"]["value"];
    assert!(residual.as_f64().unwrap() > 0.52);
    // With the ramp in campaign.toml they are those of a sudden step.
    std::fs::write(&file, format!("{before}[relaxation]\nramp = \"0.4 s\"\n")).unwrap();
    let found = json(&directory);
    let residual = &found["impacts"][0]["parameters"]["residual_fraction"]["value"];
    assert!(
        (residual.as_f64().unwrap() - 0.5).abs() < 0.004,
        "{residual}"
    );
}

#[test]
fn rejects_what_is_no_hold() {
    let text = recording([0.5, 0.3, 0.2], [0.9, 15.0]);
    let (_folder, directory) = campaign(&[("a", text)]);
    let file = directory.join("campaign.toml");
    let whole = std::fs::read_to_string(&file).unwrap();
    for (line, expected) in [
        ("elements = 4", "expected 1, 2 or 3"),
        ("exponent = 0.5", "a number from 1 to 5"),
        ("ramp = \"0.5 mm\"", "ramp"),
        ("element = 2", "there is no key"),
    ] {
        let text = whole.replace("[relaxation]\n", &format!("[relaxation]\n{line}\n"));
        std::fs::write(&file, text).unwrap();
        let run = windfall(&["fit", directory.to_str().unwrap()]);
        assert_eq!(run.code, 2, "{line}: {}", run.text);
        assert!(run.error.contains("campaign.toml, line"), "{}", run.error);
        assert!(run.error.contains(expected), "{line}: {}", run.error);
    }
    // Loading alone.
    std::fs::write(&file, &whole).unwrap();
    let mut rising = "time_s,force_N,position_mm\n".to_owned();
    for i in 0..200 {
        let x = 0.02 * f64::from(i);
        rising += &format!("{},{},{}\n", 0.05 * f64::from(i), x.powf(1.5), x);
    }
    std::fs::write(directory.join("raw/a.csv"), rising).unwrap();
    let run = windfall(&["fit", directory.to_str().unwrap()]);
    assert_eq!(run.code, 1, "{}", run.text);
    let told = run.text.replace("\n    ", " ") + &run.error;
    assert!(told.contains("the position is not held"), "{told}");
    assert!(told.contains("kind = \"compression\""), "{told}");
}

/// A hold in a campaign of compressions is called what it is.
#[test]
fn rejects_a_hold_as_a_compression() {
    let text = recording([0.5, 0.3, 0.2], [0.9, 15.0]);
    let lines: Vec<&str> = text.lines().collect();
    let held = lines[19..1200].join("\n");
    let (_folder, directory) = campaign(&[("a", format!("{}\n{held}\n", lines[0]))]);
    let file = directory.join("campaign.toml");
    let whole = std::fs::read_to_string(&file).unwrap();
    let (head, _) = whole.split_once("[relaxation]").unwrap();
    let head = head.replace(
        "kind = \"relaxation\"",
        "kind = \"compression\"\nplates = 2",
    );
    std::fs::write(&file, head + "[fit]\nlaw = \"hertz\"\n").unwrap();
    let run = windfall(&["fit", directory.to_str().unwrap()]);
    assert_eq!(run.code, 1, "{}", run.text);
    let told = run.text.replace("\n    ", " ") + &run.error;
    assert!(told.contains("stress relaxation, not a loading"), "{told}");
    assert!(!told.contains("the force rises"), "{told}");
}
