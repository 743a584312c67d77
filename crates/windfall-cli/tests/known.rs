//! Priors, bounds and noise that the user gives.

use crate::counted::windfall;
use serde_json::Value;
use std::path::Path;
use std::process::Command;

/// Eight impacts on four fruit, all of k = 394,931 and c = 681.
fn campaign() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let line = "simulate pendulum --law kuwabara-kono(k=394931,c=681) --specimens 4 --repeats 2 \
                --recordings campaign";
    let line = line.replace("                ", "");
    let (status, _, told) = windfall(&line, folder.path());
    assert_eq!(status, Some(0), "{told}");
    folder
}

/// `windfall fit campaign` with options that hold spaces.
fn fit(folder: &Path, options: &[&str]) -> (Option<i32>, String, String) {
    let output = Command::new(assert_cmd::cargo::cargo_bin("windfall"))
        .args(["fit", "campaign"])
        .args(options)
        .current_dir(folder)
        .output()
        .unwrap();
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    (
        output.status.code(),
        text(&output.stdout),
        text(&output.stderr),
    )
}

fn outcome(folder: &Path, options: &[&str]) -> Value {
    let (status, out, told) = fit(folder, &[options, &["--format", "json"]].concat());
    assert_eq!(status, Some(0), "{told}");
    serde_json::from_str(&out).unwrap()
}

fn codes(findings: &Value) -> Vec<String> {
    let all = findings.as_array().unwrap().iter();
    all.map(|own| own["code"].as_str().unwrap().to_owned())
        .collect()
}

/// Adds lines below `[fit]`, or in the place of another part of campaign.toml.
fn tell(folder: &Path, old: &str, new: &str) {
    let path = folder.join("campaign/campaign.toml");
    let text = std::fs::read_to_string(&path).unwrap();
    assert!(text.contains(old), "{text}");
    std::fs::write(&path, text.replacen(old, new, 1)).unwrap();
}

/// A prior of the campaign and the same one as an option give the same bits; what it moves is
/// common to all impacts and is not divided by their number.
#[test]
fn repeats_a_prior_of_the_file_as_an_option() {
    let folder = campaign();
    // Deviations from edges of a count know more than the weights: then precisions add up on
    // average only.
    let noise = ["--noise-sd", "displacement=2.5 um"];
    let plain = outcome(folder.path(), &noise);
    let asked = outcome(
        folder.path(),
        &[&noise[..], &["--prior", "k=394900 ± 300 N/m^1.5"]].concat(),
    );
    tell(
        folder.path(),
        "[summary]",
        "[fit.prior]\nk = \"394900 ± 300 N/m^1.5\"\n\n[summary]",
    );
    let told = outcome(folder.path(), &noise);
    assert_eq!(asked["impacts"], told["impacts"]);
    assert_eq!(told["status"]["stored"], 8, "one key for both");
    let own = &told["summary"]["k"];
    let mut shares = Vec::new();
    for (with, without) in told["impacts"]
        .as_array()
        .unwrap()
        .iter()
        .zip(plain["impacts"].as_array().unwrap())
    {
        let sd = |own: &Value| own["parameters"]["k"]["sd"].as_f64().unwrap();
        // Precisions add up.
        let expected = (sd(without).powi(-2) + 300f64.powi(-2)).powf(-0.5);
        assert!((sd(with) / expected - 1.0).abs() < 0.05, "{expected}");
        let moved = with["common"]["prior.k"]["k"].as_f64().unwrap();
        assert!(
            (moved / (sd(with).powi(2) / 300.0) - 1.0).abs() < 0.1,
            "{moved}"
        );
        shares.push(moved);
    }
    let mean = shares.iter().sum::<f64>() / 8.0;
    assert!((own["common_sd"].as_f64().unwrap() / mean - 1.0).abs() < 1e-9);
    assert!(codes(&told["findings"]).contains(&"prior-in-means".to_owned()));
    let (_, text, _) = fit(folder.path(), &[]);
    assert!(
        text.contains("The uncertainty of the priors shifts all impacts together"),
        "{text}"
    );
    // Fruit that a prior holds together do not show how fruit differ.
    let (status, _, told) = fit(folder.path(), &["--card", "law.toml"]);
    assert_eq!(status, Some(0), "{told}");
    let card = std::fs::read_to_string(folder.path().join("law.toml")).unwrap();
    assert!(
        card.contains("a prior holds their estimates of k"),
        "{card}"
    );
    assert!(!card.contains("between_fruit"), "{card}");
    // A comparison of laws and a population take no priors.
    for command in [
        "laws campaign --format json",
        "population campaign --format json",
    ] {
        let (status, out, told) = windfall(command, folder.path());
        assert_eq!(status, Some(0), "{told}");
        let found: Value = serde_json::from_str(&out).unwrap();
        let all = codes(&found["findings"]);
        assert!(
            all.contains(&"priors-not-used".to_owned()),
            "{command} {all:?}"
        );
    }
}

#[test]
fn rejects_a_prior_that_excludes_the_data() {
    let folder = campaign();
    let vague = outcome(folder.path(), &["--prior", "k=5e5 ± 1e4 N/m^1.5"]);
    assert_eq!(codes(&vague["findings"]), ["prior-excludes-data"]);
    assert!(vague["summary"]["k"]["n"] == 8, "the data outweigh it");
    let sharp = outcome(folder.path(), &["--prior", "k=3.9e5 ± 300 N/m^1.5"]);
    assert!(codes(&sharp["findings"]).contains(&"prior-excludes-data".to_owned()));
    for impact in sharp["impacts"].as_array().unwrap() {
        assert_eq!(codes(&impact["left_out"]), ["prior-contradicted"]);
    }
    let (status, _, told) = fit(
        folder.path(),
        &["--prior", "k=3.9e5 ± 300 N/m^1.5", "--card", "law.toml"],
    );
    assert_eq!(status, Some(2), "{told}");
    assert!(told.contains("no impact counts"), "{told}");
}

#[test]
fn rejects_estimates_at_bounds_that_were_given() {
    let folder = campaign();
    let found = outcome(folder.path(), &["--bounds", "c=700 … 900 N s/m^1.5"]);
    assert!(codes(&found["findings"]).contains(&"bounds-hold".to_owned()));
    for impact in found["impacts"].as_array().unwrap() {
        let c = &impact["parameters"]["c"];
        assert!(c["sd"].is_null() && c["low"] == 700.0, "{c}");
        assert!(c["high"].as_f64().unwrap() < 720.0, "{c}");
        assert_eq!(codes(&impact["left_out"]), ["at-bound"]);
    }
    // Bounds that are not reached change nothing.
    let plain = outcome(folder.path(), &[]);
    let wide = outcome(folder.path(), &["--bounds", "c=> 100 N s/m^1.5"]);
    for (a, b) in plain["impacts"]
        .as_array()
        .unwrap()
        .iter()
        .zip(wide["impacts"].as_array().unwrap())
    {
        assert_eq!(a["parameters"], b["parameters"]);
    }
}

#[test]
fn rejects_noise_that_residuals_contradict() {
    let folder = campaign();
    for (sd, finds) in [("0.1 N", true), ("1 N", false), ("8 N", true)] {
        let found = outcome(folder.path(), &["--noise-sd", &format!("force={sd}")]);
        let said = codes(&found["findings"]).contains(&"noise-contradicted".to_owned());
        assert_eq!(said, finds, "{sd} {}", found["findings"]);
    }
    tell(
        folder.path(),
        "[channels.force]\n",
        "[channels.force]\nnoise_sd = \"1 N\"\n",
    );
    let told = outcome(folder.path(), &[]);
    let asked = outcome(folder.path(), &["--noise-sd", "force=1 N"]);
    assert_eq!(told["impacts"], asked["impacts"]);
    assert_eq!(told["impacts"][0]["residuals"]["force"]["noise"], 1.0);
}

#[test]
fn rejects_what_is_given_wrongly() {
    let folder = campaign();
    for (option, text, said) in [
        (
            "--prior",
            "k=3 ± 1 N",
            "a stiffness in N/m^1.5 was expected",
        ),
        (
            "--prior",
            "q=3 ± 1",
            "nothing that is estimated has this name",
        ),
        (
            "--prior",
            "k=3e5 N/m^1.5",
            "a value with its standard deviation",
        ),
        (
            "--prior",
            "k=3e5 ± 0 N/m^1.5",
            "an uncertainty of zero holds k",
        ),
        ("--prior", "k=3e5 ± -1 N/m^1.5", "it is negative"),
        ("--prior", "k=3e5 N/m^1.5 ± 1", "it has no unit"),
        (
            "--prior",
            "k=-3 ± 1 N/m^1.5",
            "k of kuwabara-kono lies between",
        ),
        ("--prior", "k", "expected NAME=QUANTITY"),
        ("--bounds", "c", "expected NAME=RANGE"),
        ("--bounds", "c=9 … 2 N s/m^1.5", "lower end is not below"),
        (
            "--bounds",
            "c=2 N s/m^1.5",
            "one end alone has its sign before it",
        ),
        (
            "--bounds",
            "c=< -1 N s/m^1.5",
            "c of kuwabara-kono lies between",
        ),
        ("--noise-sd", "force=-1 N", "must be above zero"),
        ("--noise-sd", "force=1 m", "force"),
        (
            "--noise-sd",
            "strength=1 N",
            "expected NAME=QUANTITY with one of",
        ),
    ] {
        let (status, _, told) = fit(folder.path(), &[option, text]);
        assert_eq!(status, Some(2), "{option} {text}: {told}");
        assert!(told.contains(said), "{option} {text}: {told}");
    }
    let prior = ["--prior", "k=3e5 ± 1e4 N/m^1.5"];
    for (more, said) in [
        (["--prior", "k=3e5 ± 1e3 N/m^1.5"], "it is given twice"),
        (["--bounds", "k=> 4e5 N/m^1.5"], "outside of its bounds"),
        (["--weights", "inverse-mean"], "weights 1/mean"),
        (["--law", "kuwabara-kono(k=3e5)"], "holds k at a value"),
        (["--law", "power-law"], ""),
    ] {
        let (status, _, told) = fit(folder.path(), &[&prior[..], &more].concat());
        let wrong = !said.is_empty();
        assert_eq!(status == Some(2), wrong, "{more:?}: {told}");
        assert!(told.contains(said), "{more:?}: {told}");
    }
    for (options, said) in [
        (
            &[
                "--law",
                "power-law",
                "--free",
                "n",
                "--prior",
                "k=3e5 ± 1e4",
            ][..],
            "the unit of k depends on n",
        ),
        (
            &["--law", "power-law", "--bounds", "n=1 … 2"],
            "n is held at its usual value",
        ),
        (
            &["--onset", "fixed", "--prior", "onset=0 ± 1 ms"],
            "onset is held",
        ),
        (
            &["--weights", "inverse-mean", "--noise-sd", "force=1 N"],
            "these weights know no noise",
        ),
    ] {
        let (status, _, told) = fit(folder.path(), options);
        assert_eq!(status, Some(2), "{options:?}: {told}");
        assert!(told.contains(said), "{options:?}: {told}");
    }
    // In the file: with its line.
    for (old, new, said) in [
        (
            "[summary]",
            "[fit.prior]\nk = \"3e5 N/m^1.5\"\n[summary]",
            "[fit.prior] k",
        ),
        (
            "[summary]",
            "[fit.bounds]\nz = \"0 … 1\"\n[summary]",
            "[fit.bounds] z",
        ),
        (
            "[channels.phase_a]\n",
            "[channels.phase_a]\nnoise_sd = \"1 V\"\n",
            "counts have the noise of a count",
        ),
    ] {
        let folder = campaign();
        tell(folder.path(), old, new);
        let (status, _, told) = fit(folder.path(), &[]);
        assert_eq!(status, Some(2), "{told}");
        assert!(
            told.contains(said) && told.contains("campaign.toml, line"),
            "{told}"
        );
    }
}
