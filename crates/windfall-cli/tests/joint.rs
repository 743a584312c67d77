//! One law for all impacts on a specimen.

use crate::counted::windfall;
use serde_json::Value;
use std::path::Path;

/// Three impacts on each of three fruit, which differ.
fn campaign() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let line = "simulate pendulum --law kuwabara-kono(k=394931,c=681) --spread k=60000 \
                --specimens 3 --repeats 3 --recordings campaign";
    let line = line.replace("                ", "");
    let (status, _, told) = windfall(&line, folder.path());
    assert_eq!(status, Some(0), "{told}");
    folder
}

fn outcome(folder: &Path) -> Value {
    let (status, out, told) = windfall("fit campaign --joint --format json", folder);
    assert_eq!(status, Some(0), "{told}");
    serde_json::from_str(&out).unwrap()
}

/// Replaces a part of a file of the campaign.
fn change(folder: &Path, file: &str, old: &str, new: &str) {
    let path = folder.join("campaign").join(file);
    let text = std::fs::read_to_string(&path).unwrap();
    assert!(text.contains(old), "{text}");
    std::fs::write(&path, text.replace(old, new)).unwrap();
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap()
}

/// k and c of an impact, and the inverse of their covariance: p, q, r of [[p, q], [q, r]].
fn own(impact: &Value) -> ([f64; 2], [f64; 3]) {
    let of = |name: &str, key: &str| number(&impact["parameters"][name][key]);
    let (a, b) = (of("k", "sd"), of("c", "sd"));
    let r = number(&impact["correlations"]["k, c"]);
    let of_both = 1.0 - r * r;
    let inverse = [
        1.0 / (a * a * of_both),
        -r / (a * b * of_both),
        1.0 / (b * b * of_both),
    ];
    ([of("k", "value"), of("c", "value")], inverse)
}

/// The mean weighted with inverse covariances, solved by Cramer's rule.
#[test]
fn closed_form_joint_estimate_of_two_parameters() {
    let folder = campaign();
    let outcome = outcome(folder.path());
    let joint = outcome["joint"].as_array().unwrap();
    assert_eq!(joint.len(), 3);
    for found in joint {
        let impacts = outcome["impacts"].as_array().unwrap().iter();
        let impacts: Vec<_> = impacts
            .filter(|impact| impact["specimen"] == found["specimen"])
            .map(own)
            .collect();
        assert_eq!(impacts.len(), 3);
        let (mut sums, mut right) = ([0.0; 3], [0.0; 2]);
        for ([k, c], [p, q, r]) in &impacts {
            sums = [sums[0] + p, sums[1] + q, sums[2] + r];
            right = [right[0] + p * k + q * c, right[1] + q * k + r * c];
        }
        let determinant = sums[0] * sums[2] - sums[1] * sums[1];
        let k = (sums[2] * right[0] - sums[1] * right[1]) / determinant;
        let c = (sums[0] * right[1] - sums[1] * right[0]) / determinant;
        let chi_square: f64 = impacts
            .iter()
            .map(|(own, [p, q, r])| {
                let (u, v) = (own[0] - k, own[1] - c);
                p * u * u + 2.0 * q * u * v + r * v * v
            })
            .sum();
        let of = |name: &str, key: &str| number(&found["parameters"][name][key]);
        assert!((of("k", "value") / k - 1.0).abs() < 1e-9);
        assert!((of("c", "value") / c - 1.0).abs() < 1e-9);
        assert!((number(&found["chi_square"]) / chi_square - 1.0).abs() < 1e-5);
        assert_eq!(found["freedom"], 4);
        // These agree, and their deviations are those of the weights.
        assert_eq!(found["scale"], 1.0);
        assert!((of("k", "sd") / (sums[2] / determinant).sqrt() - 1.0).abs() < 1e-9);
        assert!((of("c", "sd") / (sums[0] / determinant).sqrt() - 1.0).abs() < 1e-9);
    }
    assert!(!codes(&outcome).contains(&"joint-scatter".to_owned()));
    let (_, text, _) = windfall("fit campaign --joint", folder.path());
    assert!(
        text.contains("One law for all impacts on a specimen"),
        "{text}"
    );
}

fn codes(outcome: &Value) -> Vec<String> {
    let findings = outcome["findings"].as_array().unwrap().iter();
    let codes = findings.map(|own| own["code"].as_str().unwrap().to_owned());
    codes.collect()
}

/// An inertia known to 1 % makes k uncertain by as much, however many impacts there are.
#[test]
fn closed_form_bench_is_common_to_the_impacts_on_a_fruit() {
    let folder = campaign();
    let plain = outcome(folder.path());
    change(folder.path(), "campaign.toml", "kg m^2\"", "kg m^2 ± 1 %\"");
    let common = outcome(folder.path());
    for (plain, common) in std::iter::zip(
        plain["joint"].as_array().unwrap(),
        common["joint"].as_array().unwrap(),
    ) {
        let k = |own: &Value, key: &str| number(&own["parameters"]["k"][key]);
        assert!((k(common, "value") / k(plain, "value") - 1.0).abs() < 1e-6);
        let added = (k(common, "sd").powi(2) - k(plain, "sd").powi(2)).sqrt();
        let shift = number(&common["common"]["inertia"]["k"]);
        assert!((added / shift.abs() - 1.0).abs() < 1e-3, "{added} {shift}");
        assert!((added / k(plain, "value") - 0.01).abs() < 1e-3, "{added}");
    }
}

/// Impacts on different fruit under one name do not agree.
#[test]
fn names_impacts_that_differ_and_scales_their_deviations() {
    let folder = campaign();
    let plain = outcome(folder.path());
    let path = folder.path().join("campaign/impacts.csv");
    let text = std::fs::read_to_string(&path).unwrap();
    let specimens = std::fs::read_to_string(folder.path().join("campaign/specimens.csv")).unwrap();
    let names: Vec<&str> = specimens
        .lines()
        .skip(1)
        .map(|line| line.split(',').next().unwrap())
        .collect();
    // The third impact on the first fruit goes to the second one.
    let lines: Vec<String> = text
        .lines()
        .enumerate()
        .map(|(row, line)| match row {
            3 => line.replacen(&format!(",{}", names[0]), &format!(",{}", names[1]), 1),
            _ => line.to_owned(),
        })
        .collect();
    std::fs::write(&path, lines.join("\n") + "\n").unwrap();
    let mixed = outcome(folder.path());
    let of = |name: &str| {
        let joint = mixed["joint"].as_array().unwrap().iter();
        joint.clone().find(|own| own["specimen"] == name).unwrap()
    };
    let second = of(names[1]);
    assert_eq!(second["impacts"].as_array().unwrap().len(), 4);
    assert!(number(&second["scale"]) > 3.0, "{second}");
    assert!(codes(&mixed).contains(&"joint-scatter".to_owned()));
    assert_eq!(of(names[2]), &plain["joint"][2]);
    assert_eq!(of(names[0])["impacts"].as_array().unwrap().len(), 2);
}

#[test]
fn says_that_no_specimen_has_two_impacts() {
    let folder = tempfile::tempdir().unwrap();
    let line =
        "simulate pendulum --law kuwabara-kono(k=394931,c=681) --specimens 2 --recordings campaign";
    let (status, _, told) = windfall(line, folder.path());
    assert_eq!(status, Some(0), "{told}");
    let outcome = outcome(folder.path());
    assert_eq!(outcome["joint"].as_array().unwrap().len(), 0);
    assert!(codes(&outcome).contains(&"joint-without-repeats".to_owned()));
}

#[test]
fn rejects_a_joint_fit_of_other_campaigns() {
    let folder = tempfile::tempdir().unwrap();
    let (status, _, told) = windfall("new drop rig", folder.path());
    assert_eq!(status, Some(0), "{told}");
    let (status, _, told) = windfall("fit rig --joint", folder.path());
    assert_eq!(status, Some(2), "{told}");
    assert!(told.contains("--joint"), "{told}");
}
