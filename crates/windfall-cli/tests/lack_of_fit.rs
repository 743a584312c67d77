//! How often a finding that chance gives once in a hundred impacts is given under a true law and
//! under a wrong one.

use assert_cmd::Command;
use serde_json::Value;
use std::path::Path;

fn windfall(line: &[&str], folder: &Path) -> Vec<u8> {
    let mut command = Command::cargo_bin("windfall").unwrap();
    let output = command.args(line).current_dir(folder).output().unwrap();
    let told = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{line:?}: {told}");
    output.stdout
}

/// Impacts with a finding of some codes, of all.
fn having(found: &Value, codes: &[&str]) -> (usize, usize) {
    let impacts = found["impacts"].as_array().unwrap();
    let has = |impact: &&Value| {
        let mut findings = impact["findings"].as_array().unwrap().iter();
        findings.any(|own| codes.contains(&own["code"].as_str().unwrap()))
    };
    (impacts.iter().filter(has).count(), impacts.len())
}

/// 1000 impacts of a known law for each seed (`WINDFALL_SEEDS=1,2,3`, 11 if not given): no
/// more than one in a hundred has a lack of fit, which the list of the campaign calls a note; under a law
/// without damping all are misfits.
#[test]
fn recovers_the_rate_of_chance_under_a_true_law() {
    let seeds = std::env::var("WINDFALL_SEEDS").unwrap_or_else(|_| "11".to_owned());
    for seed in seeds.split(',') {
        let laboratory = tempfile::tempdir().unwrap();
        let folder = laboratory.path();
        let law = "kuwabara-kono(k=753599,c=1524)";
        let made = ["simulate", "pendulum", "--law", law, "--recordings", "made"];
        let many = ["--specimens", "100", "--repeats", "10", "--seed", seed];
        windfall(&[&made[..], &many[..]].concat(), folder);
        let fit = |law: &str| -> Value {
            let line = ["fit", "made", "--law", law, "--format", "json"];
            serde_json::from_slice(&windfall(&line, folder)).unwrap()
        };
        let (have, all) = having(&fit("kuwabara-kono"), &["lack-of-fit"]);
        println!("seed {seed}: {have} of {all}");
        assert_eq!(all, 1000);
        // P(X ≥ 21) of 1000 at 1 % is 0.0015. A counted displacement takes part in the test and
        // is never less random than chance, so that about half of 1 % is seen.
        assert!((1..=20).contains(&have), "seed {seed}: {have} of {all}");
        let text = windfall(&["fit", "made", "--law", "kuwabara-kono"], folder);
        let text = String::from_utf8(text).unwrap();
        assert!(text.contains("[note] lack-of-fit: "), "{text}");
        let graver = ["lack-of-fit", "structured-residuals", "misfit"];
        assert_eq!(having(&fit("hertz"), &graver), (1000, 1000), "seed {seed}");
    }
}
