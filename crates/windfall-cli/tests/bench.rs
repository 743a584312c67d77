//! What all impacts of a campaign say of their bench.

use crate::counted::{fitted, windfall};
use serde_json::Value;
use std::path::Path;

/// Sixteen impacts on a pendulum of 0.01435 kg m².
fn campaign() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let line = "simulate pendulum --law kuwabara-kono(k=753599,c=1524) --specimens 4 --repeats 4 \
                --recordings campaign";
    let line = line.replace("                ", "");
    let (status, _, told) = windfall(&line, folder.path());
    assert_eq!(status, Some(0), "{told}");
    folder
}

/// Replaces a part of campaign.toml.
fn tell(folder: &Path, old: &str, new: &str) {
    let path = folder.join("campaign/campaign.toml");
    let text = std::fs::read_to_string(&path).unwrap();
    assert!(text.contains(old), "{text}");
    std::fs::write(&path, text.replacen(old, new, 1)).unwrap();
}

fn said(outcome: &Value) -> Vec<(String, String)> {
    let found = outcome["findings"].as_array().unwrap();
    let text = |own: &Value, key: &str| own[key].as_str().unwrap().to_owned();
    let found = found
        .iter()
        .map(|own| (text(own, "code"), text(own, "message")));
    found.filter(|own| own.0.starts_with("bench-")).collect()
}

#[test]
fn closed_form_gain_and_delay_of_a_bench_that_is_as_told() {
    let folder = campaign();
    let outcome = fitted(folder.path());
    assert_eq!(said(&outcome), []);
    let gain = &outcome["bench"]["force_gain"];
    assert_eq!(gain["impacts"], 16);
    let (value, sd) = (
        gain["value"].as_f64().unwrap(),
        gain["sd"].as_f64().unwrap(),
    );
    assert!((value - 1.0).abs() < 4.0 * sd && sd < 0.005, "{gain}");
    let (_, out, _) = windfall("fit campaign", folder.path());
    assert!(
        out.contains("By Newton's law, over 16 impacts: the force is"),
        "{out}"
    );
}

#[test]
fn recovers_an_inertia_that_is_not_what_the_file_says() {
    let folder = campaign();
    tell(
        folder.path(),
        "inertia = \"0.01435",
        "inertia = \"0.0150675",
    );
    let found = said(&fitted(folder.path()));
    let [(code, message)] = &found[..] else {
        panic!("{found:?}")
    };
    assert_eq!(code, "bench-gain");
    assert!(
        message.contains("inertia") && message.contains("too large"),
        "{message}"
    );
}

#[test]
fn recovers_a_force_that_is_late() {
    let folder = campaign();
    tell(
        folder.path(),
        "[channels.force]\n",
        "[channels.force]\ndelay = \"-40 us\"\n",
    );
    let found = said(&fitted(folder.path()));
    let codes: Vec<&str> = found.iter().map(|own| own.0.as_str()).collect();
    assert_eq!(codes, ["bench-delay"], "{found:?}");
}
