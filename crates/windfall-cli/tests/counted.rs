//! Impacts that do not count reach no mean, card, population, comparison or table.

use assert_cmd::Command;
use serde_json::Value;
use std::path::Path;

pub(crate) fn windfall(line: &str, folder: &Path) -> (Option<i32>, String, String) {
    let mut command = Command::cargo_bin("windfall").unwrap();
    let output = command.args(line.split(' ')).current_dir(folder).output();
    let output = output.unwrap();
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    (
        output.status.code(),
        text(&output.stdout),
        text(&output.stderr),
    )
}

pub(crate) fn fitted(folder: &Path) -> Value {
    let (status, out, told) = windfall("fit campaign --format json", folder);
    assert_eq!(status, Some(0), "{told}");
    serde_json::from_str(&out).unwrap()
}

/// Twelve impacts on one fruit.
fn campaign() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let line = "simulate carriage --law kuwabara-kono(k=753599,c=1524) --mass 0.2kg --velocity \
                0.5m/s --specimens 1 --repeats 12 --recordings campaign"
        .replace("                ", "");
    let (status, _, told) = windfall(&line, folder.path());
    assert_eq!(status, Some(0), "{told}");
    folder
}

/// Changes the samples of a column of one recording.
fn change(folder: &Path, recording: usize, column: usize, value: impl Fn(usize, f64) -> f64) {
    let raw = folder.join("campaign/raw");
    let mut names: Vec<_> = std::fs::read_dir(raw)
        .unwrap()
        .map(|e| e.unwrap().path())
        .collect();
    names.sort();
    let text = std::fs::read_to_string(&names[recording]).unwrap();
    let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
    for (row, line) in lines.iter_mut().skip(1).enumerate() {
        let mut cells: Vec<f64> = line.split(',').map(|cell| cell.parse().unwrap()).collect();
        cells[column] = value(row, cells[column]);
        let cells: Vec<String> = cells.iter().map(f64::to_string).collect();
        *line = cells.join(",");
    }
    std::fs::write(&names[recording], lines.join("\n") + "\n").unwrap();
}

fn reasons(outcome: &Value, impact: usize) -> Vec<String> {
    let out = outcome["impacts"][impact]["left_out"].as_array().cloned();
    let code = |own: &Value| own["code"].as_str().unwrap().to_owned();
    out.unwrap_or_default().iter().map(code).collect()
}

#[test]
fn where_laws_differ_in_what_counts_each_is_named() {
    let folder = campaign();
    let line = "fit campaign --law kuwabara-kono --law lankarani-nikravesh";
    let (status, text, told) = windfall(line, folder.path());
    assert_eq!(status, Some(0), "{told}");
    let text = text.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(
        text.contains("kuwabara-kono: all 12 impacts count. lankarani-nikravesh: 0 of 12 impacts count; left out: 12 at-bound"),
        "{text}"
    );
}

#[test]
fn rejects_an_excluded_impact_everywhere() {
    let laboratory = campaign();
    let folder = laboratory.path();
    let whole = fitted(folder);
    assert_eq!(whole["summary"]["k"]["n"], 12);
    let list = folder.join("campaign/impacts.csv");
    let text = std::fs::read_to_string(&list).unwrap();
    let mut lines: Vec<String> = text.lines().map(|line| format!("{line},,")).collect();
    lines[0] = lines[0].trim_end_matches(',').to_owned() + ",exclude,note";
    lines[3] = lines[3].trim_end_matches(',').to_owned() + ",yes,slipped";
    std::fs::write(&list, lines.join("\n") + "\n").unwrap();
    let outcome = fitted(folder);
    assert_eq!(outcome["status"]["fitted"], 0, "nothing is fitted again");
    assert_eq!(reasons(&outcome, 2), ["excluded"]);
    assert_eq!(outcome["groups"][0]["left_out"], 1);
    let values: Vec<f64> = (0..12)
        .filter(|impact| *impact != 2)
        .map(|impact| {
            outcome["impacts"][impact]["parameters"]["k"]["value"]
                .as_f64()
                .unwrap()
        })
        .collect();
    let mean = values.iter().sum::<f64>() / 11.0;
    let told = outcome["summary"]["k"]["mean"].as_f64().unwrap();
    assert!((told - mean).abs() < 1e-6 * mean, "{told} {mean}");
    let (_, text, _) = windfall("fit campaign", folder);
    assert!(
        text.contains("11 of 12 impacts count; left out: 1 excluded"),
        "{text}"
    );
    assert!(
        text.contains("slipped") && text.contains("LEFT OUT: excluded"),
        "{text}"
    );
    windfall("fit campaign --card card.toml", folder);
    let card = std::fs::read_to_string(folder.join("card.toml")).unwrap();
    assert!(
        card.contains("recordings = 11") && card.contains("1 excluded"),
        "{card}"
    );
    let (_, laws, _) = windfall("laws campaign --format json", folder);
    let laws: Value = serde_json::from_str(&laws).unwrap();
    assert_eq!(laws["impacts"], 11);
    assert!(
        laws["failed"][0]["message"]
            .as_str()
            .unwrap()
            .contains("slipped")
    );
    let (_, csv, _) = windfall("fit campaign --format csv", folder);
    std::fs::write(folder.join("fitted.csv"), csv).unwrap();
    let (_, told, _) = windfall("summary fitted.csv --value k --format json", folder);
    let told: Value = serde_json::from_str(&told).unwrap();
    let text = told.to_string();
    assert!(
        text.contains("rows-left-out") && text.contains("\"n\":11"),
        "{text}"
    );
}

#[test]
fn rejects_what_physics_and_the_others_contradict() {
    let laboratory = campaign();
    let folder = laboratory.path();
    let clean = fitted(folder);
    let mean = clean["summary"]["k"]["mean"].as_f64().unwrap();
    for impact in 0..12 {
        assert!(reasons(&clean, impact).is_empty(), "{clean}");
    }
    // A force in wrong units; an amplifier at its limit; a velocity that reverses its sign.
    change(folder, 1, 0, |_, force| 3.0 * force);
    change(folder, 4, 0, |_, force| force.min(0.2));
    let outcome = fitted(folder);
    let wrong = reasons(&outcome, 1);
    assert!(
        wrong.contains(&"impulse-contradicts-momentum".to_owned()),
        "{wrong:?}"
    );
    assert!(reasons(&outcome, 4).contains(&"clipped".to_owned()));
    let told = &outcome["summary"]["k"];
    assert_eq!(told["n"], 10);
    let off = told["mean"].as_f64().unwrap() / mean - 1.0;
    assert!(off.abs() < 0.01, "{off}");
}

#[test]
fn rejects_a_copy_of_another_fruits_recording_as_a_finding() {
    let laboratory = tempfile::tempdir().unwrap();
    let folder = laboratory.path();
    let line = "simulate carriage --law kuwabara-kono(k=753599,c=1524) --mass 0.2kg --velocity \
                0.5m/s --specimens 2 --recordings campaign"
        .replace("                ", "");
    windfall(&line, folder);
    let raw = folder.join("campaign/raw");
    std::fs::copy(raw.join("specimen-01.csv"), raw.join("specimen-02.csv")).unwrap();
    let outcome = fitted(folder);
    let codes = outcome["findings"].to_string();
    assert!(codes.contains("same-recording"), "{codes}");
}

/// A weight that rests on the fruit while it rebounds adds its impulse to that of the motion.
#[test]
fn reference_a_slow_impact_under_gravity_counts() {
    let laboratory = tempfile::tempdir().unwrap();
    let folder = laboratory.path();
    let line = "simulate carriage --law kuwabara-kono(k=100000,c=150) --mass 0.5kg --velocity \
                0.2m/s --driving-acceleration 9.81m/s^2 --specimens 1 --repeats 3 --recordings \
                campaign"
        .replace("                ", "");
    let (status, _, told) = windfall(&line, folder);
    assert_eq!(status, Some(0), "{told}");
    let outcome = fitted(folder);
    for impact in 0..3 {
        assert_eq!(reasons(&outcome, impact), [""; 0], "{outcome}");
    }
}
