//! `windfall fit` from raw recordings to results that are kept.

#![allow(clippy::unwrap_used, clippy::print_stdout)]

use assert_cmd::cargo::cargo_bin;
use std::path::Path;
use std::process::{Command, Output, Stdio};
use std::time::Instant;
use windfall_campaign::store::runs::{count_runs, find_results, latest_run};

fn windfall(arguments: &[&str]) -> Output {
    Command::new(cargo_bin("windfall"))
        .args(arguments)
        .output()
        .unwrap()
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).unwrap()
}

/// Simulated recordings of apples: 2003 pendulum study, 753599 ± 133165 N/m^1.5
/// and 1524 ± 263 N s/m^1.5.
fn simulate(directory: &Path, specimens: usize) {
    let output = windfall(&[
        "simulate",
        "pendulum",
        "--law",
        "kuwabara-kono(k=753599, c=1524)",
        "--spread",
        "k=133165",
        "--spread",
        "c=263",
        "--specimens",
        &specimens.to_string(),
        "--seed",
        "11",
        "--recordings",
        directory.to_str().unwrap(),
    ]);
    assert!(output.status.success(), "{}", text(&output.stderr));
}

fn fit(directory: &Path, more: &[&str]) -> Output {
    let mut arguments = vec!["fit", directory.to_str().unwrap()];
    arguments.extend(more);
    let output = windfall(&arguments);
    assert!(output.status.success(), "{}", text(&output.stderr));
    output
}

#[test]
fn recovers_what_was_put_into_each_simulated_fruit() {
    let scratch = tempfile::tempdir().unwrap();
    let directory = scratch.path().join("campaign");
    simulate(&directory, 12);
    let found: serde_json::Value =
        serde_json::from_slice(&fit(&directory, &["--format", "json"]).stdout).unwrap();
    let truth = std::fs::read_to_string(directory.join("truth.csv")).unwrap();
    let mut scores = Vec::new();
    for (impact, line) in found["impacts"]
        .as_array()
        .unwrap()
        .iter()
        .zip(truth.lines().skip(1))
    {
        assert!(line.starts_with(impact["id"].as_str().unwrap()));
        for name in ["k", "c"] {
            let (_, rest) = line.split_once(&format!("{name}=")).unwrap();
            let end = rest
                .find(|c: char| !(c.is_ascii_digit() || ".e-".contains(c)))
                .unwrap();
            let put_in: f64 = rest[..end].parse().unwrap();
            let parameter = &impact["parameters"][name];
            let (value, sd) = (
                parameter["value"].as_f64().unwrap(),
                parameter["sd"].as_f64().unwrap(),
            );
            assert!(sd > 0.0 && sd < 0.05 * put_in, "{name} {sd}");
            scores.push((value - put_in) / sd);
        }
    }
    // 24 standard scores: their mean square is 1 within four standard errors,
    // √(2/24) each, and none is absurd.
    let mean_square = scores.iter().map(|z| z * z).sum::<f64>() / scores.len() as f64;
    assert_eq!(scores.len(), 24);
    assert!(
        mean_square < 1.0 + 4.0 * (2f64 / 24.0).sqrt(),
        "{mean_square}: {scores:?}"
    );
    assert!(scores.iter().all(|z| z.abs() < 4.5), "{scores:?}");
    assert!(found["simulated"].as_str().unwrap().contains("seed 11"));
    assert_eq!(found["summary"]["k"]["n"], 12);
}

/// The keys that scripts rely on: DESIGN.md, section 5.
#[test]
fn reference_json_has_the_agreed_keys() {
    let scratch = tempfile::tempdir().unwrap();
    let directory = scratch.path().join("campaign");
    simulate(&directory, 2);
    let found: serde_json::Value =
        serde_json::from_slice(&fit(&directory, &["--format", "json"]).stdout).unwrap();
    let impact = &found["impacts"][0];
    for key in ["id", "specimen", "law"] {
        assert!(impact[key].is_string(), "{key}");
    }
    assert_eq!(
        impact["quantities"],
        serde_json::json!(["displacement", "force"])
    );
    for name in ["k", "c"] {
        for key in ["value", "sd", "low", "high"] {
            assert!(impact["parameters"][name][key].is_f64(), "{name} {key}");
        }
    }
    assert_eq!(impact["parameters"]["c"]["unit"], "N s/m^1.5");
    assert!(impact["cost"].is_f64() && impact["samples"].is_u64());
    assert!(impact["converged"].is_boolean());
    for key in [
        "impact_velocity",
        "rebound_velocity",
        "restitution",
        "contact_duration",
        "peak_force",
        "max_displacement",
        "impact_energy",
        "elastic_energy",
        "absorbed_energy",
    ] {
        assert!(impact["derived"][key].is_f64(), "{key}");
        assert!(found["summary"][key]["mean"].is_f64(), "{key}");
    }
    for finding in impact["findings"].as_array().unwrap() {
        assert!(finding["code"].is_string() && finding["message"].is_string());
    }
    for key in ["mean", "sd"] {
        assert!(found["summary"]["k"][key].is_f64(), "{key}");
    }
    assert_eq!(found["summary"]["k"]["n"], 2);
}

#[test]
fn repeats_the_same_bits_for_any_number_of_threads() {
    let scratch = tempfile::tempdir().unwrap();
    let directory = scratch.path().join("campaign");
    simulate(&directory, 5);
    let one = fit(
        &directory,
        &["--threads", "1", "--refit", "--format", "json"],
    )
    .stdout;
    for threads in ["2", "8"] {
        let many = fit(
            &directory,
            &["--threads", threads, "--refit", "--format", "json"],
        )
        .stdout;
        assert_eq!(text(&one), text(&many), "{threads} threads");
    }
}

#[test]
fn repeats_an_unchanged_campaign_from_the_store() {
    let scratch = tempfile::tempdir().unwrap();
    let directory = scratch.path().join("campaign");
    simulate(&directory, 4);
    let first = fit(&directory, &[]);
    assert!(
        text(&first.stderr).contains("4 fitted, 0 unchanged"),
        "{}",
        text(&first.stderr)
    );
    assert!(text(&first.stdout).contains("SIMULATED recordings"));
    let second = fit(&directory, &[]);
    assert!(
        text(&second.stderr).contains("up to date"),
        "{}",
        text(&second.stderr)
    );
    assert_eq!(text(&first.stdout), text(&second.stdout));
    assert_eq!(count_runs(&directory.join("results.sqlite")).unwrap(), 1);

    // One changed recording is fitted again, the others are not.
    let changed = directory.join("raw/specimen-02.csv");
    let recording = std::fs::read_to_string(&changed).unwrap();
    std::fs::write(&changed, recording.replacen("0.0", "0.00", 1)).unwrap();
    let third = fit(&directory, &[]);
    assert!(
        text(&third.stderr).contains("1 fitted, 3 unchanged"),
        "{}",
        text(&third.stderr)
    );

    // So is everything when the rig changes, and nothing when a title does.
    let file = directory.join("campaign.toml");
    let toml = std::fs::read_to_string(&file).unwrap();
    std::fs::write(&file, toml.replace("title = \"", "title = \"Other ")).unwrap();
    assert!(text(&fit(&directory, &[]).stderr).contains("up to date"));
    std::fs::write(
        &file,
        toml.replace("arm = \"0.505 m\"", "arm = \"0.506 m\""),
    )
    .unwrap();
    assert!(text(&fit(&directory, &[]).stderr).contains("4 fitted, 0 unchanged"));
}

/// Moments at which a fit is killed.
const STEPS: u32 = 32;

#[test]
fn conserves_earlier_results_when_fit_is_killed_at_any_moment() {
    let scratch = tempfile::tempdir().unwrap();
    let directory = scratch.path().join("campaign");
    simulate(&directory, 24);
    let list = directory.join("impacts.csv");
    let all = std::fs::read_to_string(&list).unwrap();
    let few: Vec<&str> = all.lines().take(5).collect();
    std::fs::write(&list, few.join("\n") + "\n").unwrap();
    fit(&directory, &[]);
    let store = directory.join("results.sqlite");
    let keys = latest_run(&store).unwrap().unwrap().keys;
    let results = find_results(&store, &keys).unwrap();
    assert!(results.len() == 4 && results.iter().all(Option::is_some));

    // How long a whole fit takes.
    std::fs::write(&list, &all).unwrap();
    let timed = |_| {
        let start = Instant::now();
        fit(&directory, &["--refit"]);
        start.elapsed()
    };
    let whole = (0..3).map(timed).min().unwrap();
    let runs = count_runs(&store).unwrap();

    let mut killed = 0;
    for step in 0..STEPS {
        let mut child = Command::new(cargo_bin("windfall"))
            .args(["fit", directory.to_str().unwrap(), "--refit"])
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        // From the very start to beyond the usual end, where it writes.
        std::thread::sleep(whole.mul_f64(1.1) * step / STEPS);
        let _ = child.kill();
        killed += u32::from(!child.wait().unwrap().success());
        assert!(count_runs(&store).unwrap() >= runs, "step {step}");
        assert_eq!(find_results(&store, &keys).unwrap(), results, "step {step}");
    }
    assert!(killed >= 5, "only {killed} of {STEPS} were killed in time");
    let after = fit(&directory, &[]);
    assert!(
        text(&after.stdout).contains("24"),
        "{}",
        text(&after.stdout)
    );
}

#[test]
fn rejects_a_campaign_in_which_nothing_can_be_fitted_with_status_1() {
    let scratch = tempfile::tempdir().unwrap();
    let directory = scratch.path().join("campaign");
    simulate(&directory, 2);
    std::fs::remove_dir_all(directory.join("raw")).unwrap();
    let output = windfall(&["fit", directory.to_str().unwrap()]);
    assert_eq!(output.status.code(), Some(1));
    let said = text(&output.stdout) + &text(&output.stderr);
    assert!(said.contains("impacts.csv, line 2 names it"), "{said}");
    assert!(said.contains("nothing could be fitted"), "{said}");
    assert!(!directory.join("results.sqlite").exists());
}

#[test]
fn repeats_one_recording_as_its_campaign_fits_it() {
    let scratch = tempfile::tempdir().unwrap();
    let directory = scratch.path().join("campaign");
    simulate(&directory, 3);
    let json = |path: &Path| -> serde_json::Value {
        serde_json::from_slice(&fit(path, &["--format", "json", "--refit"]).stdout).unwrap()
    };
    let one = json(&directory.join("raw/specimen-02.csv"));
    let all = json(&directory);
    assert_eq!(one["impacts"].as_array().unwrap().len(), 1);
    assert_eq!(one["impacts"][0], all["impacts"][1]);

    let stray = scratch.path().join("stray.csv");
    std::fs::write(&stray, "t,F\n0,1\n").unwrap();
    let output = windfall(&["fit", stray.to_str().unwrap()]);
    assert_eq!(output.status.code(), Some(2));
    let said = text(&output.stderr);
    assert!(
        said.contains("no campaign.toml above this recording"),
        "{said}"
    );
}

#[test]
fn rejects_a_foreign_store_and_leaves_it_alone() {
    let scratch = tempfile::tempdir().unwrap();
    let directory = scratch.path().join("campaign");
    simulate(&directory, 1);
    let store = directory.join("results.sqlite");
    let bytes = b"these are somebody's notes, not a database".repeat(50);
    std::fs::write(&store, &bytes).unwrap();
    let output = windfall(&["fit", directory.to_str().unwrap()]);
    assert_eq!(output.status.code(), Some(1));
    assert!(
        text(&output.stderr).contains("damaged or not a database"),
        "{}",
        text(&output.stderr)
    );
    assert_eq!(std::fs::read(&store).unwrap(), bytes);
}
