//! Impacts repeated on one spot, from files to the critical energy.

#![allow(clippy::unwrap_used, clippy::print_stdout)]

use std::path::Path;
use windfall_campaign::pipeline::request::FitRequest;
use windfall_campaign::settings::template::{TemplateKind, write_template};
use windfall_measure::any_outcome::AnyOutcome;
use windfall_measure::measured::{MeasuredItem, MeasuredOutcome, value_of};
use windfall_report::fit_any::fit_any;
use windfall_simulate::repeats::{SimulateRepeatsRequest, Spots, simulate_repeats};

fn request(seed: u64, spots: Spots) -> SimulateRepeatsRequest {
    let energies = ["40 mJ", "60 mJ", "90 mJ", "130 mJ", "190 mJ", "280 mJ"];
    SimulateRepeatsRequest {
        fruit: 10,
        energies: energies.map(str::to_owned).to_vec(),
        repeats: 2,
        spots,
        critical_energy: "0.12 J".to_owned(),
        spread: 0.25,
        mass: "200 g".to_owned(),
        force_noise: "0.2 N".to_owned(),
        velocity_scatter: 0.003,
        sampling_rate: "25 kHz".to_owned(),
        seed,
    }
}

fn fit(directory: &Path) -> MeasuredOutcome {
    match fit_any(
        directory,
        &FitRequest::default(),
        &windfall_files::progress::quiet,
    )
    .unwrap()
    {
        AnyOutcome::Measured(outcome) => *outcome,
        AnyOutcome::Impacts(_) => panic!("no repeats"),
    }
}

fn find<'a>(items: &'a [MeasuredItem], id: &str) -> &'a MeasuredItem {
    items.iter().find(|item| item.id.starts_with(id)).unwrap()
}

/// truth.csv: specimen and critical energy.
fn truth(directory: &Path) -> Vec<(String, f64)> {
    let text = std::fs::read_to_string(directory.join("truth.csv")).unwrap();
    let row = |line: &str| {
        let (specimen, energy) = line.split_once(',').unwrap();
        (specimen.to_owned(), energy.trim().parse().unwrap())
    };
    text.lines().skip(1).map(row).collect()
}

/// Intervals of single fruit hold the energy put in, and the interval of the
/// median holds the median put in.
#[test]
fn recovers_the_critical_energy_put_in() {
    let dir = tempfile::tempdir().unwrap();
    let (mut fruit, mut held, mut medians) = (0, 0, 0);
    let seeds = 6;
    for seed in 1..=seeds {
        let campaign = dir.path().join(format!("campaign-{seed}"));
        simulate_repeats(&campaign, &request(seed, Spots::Same)).unwrap();
        let outcome = fit(&campaign);
        assert!(outcome.failed.is_empty(), "{:?}", outcome.failed);
        for (specimen, critical) in truth(&campaign) {
            let found = find(&outcome.specimens, &specimen);
            let end = |name: &str| value_of(found, name).map(|value| value.value);
            fruit += 1;
            let inside = end("unchanged_up_to").is_none_or(|low| low < critical)
                && end("changed_at").is_none_or(|high| critical <= high);
            held += usize::from(inside);
        }
        let median = find(&outcome.whole, "log-normal");
        let median = value_of(median, "critical_energy").unwrap();
        let (low, high) = (median.low.unwrap(), median.high.unwrap());
        medians += usize::from(low < 0.12 && 0.12 < high);
    }
    // At a level of 5 % at most one fruit in twenty, and three standard errors;
    // five of six intervals or more with a probability of 0.97.
    println!("{held} of {fruit} fruit, {medians} of {seeds} medians");
    assert!(
        f64::from(held as u32) >= 0.87 * f64::from(fruit),
        "{held} of {fruit}"
    );
    assert!(medians >= 5, "{medians} of {seeds}");
}

/// On fresh spots all fruit change above the largest critical energy, and none
/// below the least: the test over fruit says so.
#[test]
fn recovers_changes_over_fruit_on_fresh_spots() {
    let dir = tempfile::tempdir().unwrap();
    let campaign = dir.path().join("campaign");
    let request = SimulateRepeatsRequest {
        spread: 0.05,
        ..request(3, Spots::Fresh)
    };
    simulate_repeats(&campaign, &request).unwrap();
    let outcome = fit(&campaign);
    for (energy, expected) in [
        ("0.0400 J", "unchanged"),
        ("0.0600 J", "unchanged"),
        ("0.1900 J", "changed"),
        ("0.2800 J", "changed"),
    ] {
        let found = find(&outcome.whole, energy);
        assert_eq!(found.words.get("verdict").unwrap(), expected, "{energy}");
        let p = value_of(found, "p").unwrap().value;
        assert_eq!(p <= 0.05, expected == "changed", "{energy}: {p}");
    }
}

/// The same bits for any number of threads, and from the store.
#[test]
fn repeats_results_from_the_store() {
    let dir = tempfile::tempdir().unwrap();
    let campaign = dir.path().join("campaign");
    simulate_repeats(&campaign, &request(2, Spots::Same)).unwrap();
    let first = fit(&campaign);
    let again = fit(&campaign);
    assert!(again.status.up_to_date && !first.status.up_to_date);
    assert_eq!(first.impacts, again.impacts);
    assert_eq!(
        (first.whole, first.specimens),
        (again.whole, again.specimens)
    );
}

/// Without the ball nothing is decided on single fruit, and the reader is told.
#[test]
fn rejects_decisions_without_a_reference() {
    let dir = tempfile::tempdir().unwrap();
    let campaign = dir.path().join("campaign");
    let few = SimulateRepeatsRequest {
        fruit: 4,
        ..request(2, Spots::Same)
    };
    simulate_repeats(&campaign, &few).unwrap();
    let specimens = campaign.join("specimens.csv");
    let text = std::fs::read_to_string(&specimens).unwrap();
    std::fs::write(&specimens, text.replace("reference", "fruit")).unwrap();
    let outcome = fit(&campaign);
    let codes: Vec<&str> = outcome.findings.iter().map(|f| f.code.as_str()).collect();
    assert!(outcome.specimens.is_empty());
    assert_eq!(codes[..2], ["no-reference", "no-margin"]);

    // Four fruit and the ball: no p below 1/8.
    let campaign = dir.path().join("few");
    simulate_repeats(&campaign, &few).unwrap();
    let outcome = fit(&campaign);
    let message = &outcome
        .findings
        .iter()
        .find(|f| f.code == "few-fruit")
        .unwrap()
        .message;
    assert!(
        message.contains("0.125") && message.contains("6 fruit"),
        "{message}"
    );
}

#[test]
fn rejects_impacts_without_an_energy() {
    let dir = tempfile::tempdir().unwrap();
    let campaign = dir.path().join("campaign");
    simulate_repeats(&campaign, &request(2, Spots::Same)).unwrap();
    let toml = campaign.join("campaign.toml");
    let text = std::fs::read_to_string(&toml).unwrap();
    std::fs::write(&toml, text.replace("mass = ", "# mass = ")).unwrap();
    let error = fit_any(
        &campaign,
        &FitRequest::default(),
        &windfall_files::progress::quiet,
    )
    .unwrap_err();
    let message = error.to_string();
    assert!(
        message.contains("line 2") && message.contains("drop_height_m"),
        "{message}"
    );
    std::fs::write(&toml, text.replace("level = 0.05", "level = 5")).unwrap();
    let error = fit_any(
        &campaign,
        &FitRequest::default(),
        &windfall_files::progress::quiet,
    )
    .unwrap_err();
    assert!(error.to_string().contains("[repeats] level"), "{error}");
}

/// The template reads, but for the recordings that it names.
#[test]
fn closed_form_template_is_a_campaign() {
    let dir = tempfile::tempdir().unwrap();
    let campaign = dir.path().join("campaign");
    write_template(TemplateKind::Repeats, &campaign).unwrap();
    // With the mass by somebody who says so.
    let path = campaign.join("campaign.toml");
    let text = std::fs::read_to_string(&path).unwrap();
    std::fs::write(&path, text.replace("\"200 g\"", "\"0.2 kg\"")).unwrap();
    let outcome = fit(&campaign);
    assert_eq!((outcome.impacts.len(), outcome.failed.len()), (0, 6));
}
