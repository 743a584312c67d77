//! Every kind of bad input of a campaign, each with the message it must give.
//!
//! The directories under `fixtures` hold their own expected message; the script
//! beside them says how they were made.

#![allow(clippy::unwrap_used, clippy::print_stdout)]

use std::path::{Path, PathBuf};
use windfall_campaign::impacts::run::fit_campaign;
use windfall_campaign::pipeline::request::FitRequest;
use windfall_campaign::result::outcome::CampaignOutcome;

fn fixtures() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fixtures")
}

/// A copy, because a fit writes its results into the directory.
fn copied(from: &Path, to: &Path) {
    std::fs::create_dir_all(to.join("raw")).unwrap();
    for directory in ["", "raw"] {
        for entry in std::fs::read_dir(from.join(directory)).unwrap() {
            let entry = entry.unwrap();
            if entry.file_type().unwrap().is_file() {
                std::fs::copy(entry.path(), to.join(directory).join(entry.file_name())).unwrap();
            }
        }
    }
}

fn fit(directory: &Path) -> Result<CampaignOutcome, String> {
    fit_campaign(
        directory,
        &FitRequest::default(),
        &windfall_files::progress::quiet,
    )
    .map_err(|error| error.to_string())
}

fn check(name: &str) -> Result<(), String> {
    let expected = std::fs::read_to_string(fixtures().join(name).join("expected.txt")).unwrap();
    let (place, message) = expected.trim_end().split_once('\n').unwrap();
    let scratch = tempfile::tempdir().unwrap();
    let directory = scratch.path().join(name);
    copied(&fixtures().join(name), &directory);
    let found = match (place, fit(&directory)) {
        ("error", Err(error)) => error,
        ("failed", Ok(outcome)) => {
            good_is_fitted(&outcome)?;
            let failed = outcome.failed.iter().find(|failure| failure.id == "bad");
            failed.ok_or("the bad impact was fitted")?.message.clone()
        }
        (place, Ok(outcome)) if place.starts_with("finding ") => {
            good_is_fitted(&outcome)?;
            let code = place.trim_start_matches("finding ");
            let impact = outcome.impacts.iter().find(|impact| impact.id == "bad");
            let impact = impact.ok_or_else(|| format!("not fitted: {:?}", outcome.failed))?;
            let finding = impact.findings.iter().find(|finding| finding.code == code);
            finding
                .ok_or_else(|| format!("only {:?}", impact.findings))?
                .message
                .clone()
        }
        (place, other) => return Err(format!("expected {place}, got {other:?}")),
    };
    match found.contains(message) {
        true => Ok(()),
        false => Err(format!("expected: {message}\n   found: {found}")),
    }
}

/// One bad recording does not stop the campaign: k = 753599 N/m^1.5 and
/// c = 1524 N s/m^1.5 were put into the good one.
fn good_is_fitted(outcome: &CampaignOutcome) -> Result<(), String> {
    let good = outcome.impacts.iter().find(|impact| impact.id == "good");
    let good =
        good.ok_or_else(|| format!("the good impact was not fitted: {:?}", outcome.failed))?;
    for (name, truth) in [("k", 753_599.0), ("c", 1524.0)] {
        let found = good.parameters.get(name).ok_or("no such parameter")?;
        let sd = found.sd.ok_or("no standard deviation")?;
        if (found.value - truth).abs() > 4.0 * sd || sd > 0.05 * truth {
            return Err(format!("{name} = {} ± {sd}, put in {truth}", found.value));
        }
    }
    Ok(())
}

#[test]
fn rejects_every_fixture_with_its_own_message() {
    let mut names: Vec<String> = std::fs::read_dir(fixtures())
        .unwrap()
        .map(|entry| entry.unwrap())
        .filter(|entry| entry.file_type().unwrap().is_dir())
        .map(|entry| entry.file_name().into_string().unwrap())
        .collect();
    names.sort();
    assert_eq!(names.len(), 16, "{names:?}");
    let wrong: Vec<String> = names
        .iter()
        .filter_map(|name| {
            check(name)
                .err()
                .map(|problem| format!("{name}: {problem}"))
        })
        .collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n\n"));
}
