//! The population of a simulated campaign: what is recovered, what is left out
//! and said, what is refused.

#![allow(clippy::unwrap_used, clippy::print_stdout)]

use std::path::Path;
use windfall_campaign::pipeline::request::FitRequest;
use windfall_contact::expression::parse_law;
use windfall_contact::law::EndRule;
use windfall_identify::rig::kind::{Pendulum, Rig};
use windfall_population::outcome::{PopulationOutcome, PopulationPosteriorOutcome};
use windfall_population::run::{PopulationRequest, population};
use windfall_population::text::{csv_of_population, text_of_population};
use windfall_signal::instrument::pendulum_instrument;
use windfall_simulate::campaign::{Batch, write_simulated_campaign};
use windfall_simulate::files::{SimulatedCampaign, Weighed};

const K: f64 = 394_931.0;
const C: f64 = 681.0;

/// Twelve fruit of two varieties with three impacts each; k differs by 15 %, c
/// by 20 %.
fn write_campaign(directory: &Path) {
    let law = parse_law(&format!("kuwabara-kono(k={K}, c={C})")).unwrap();
    let batch = |variety: &str| Batch {
        variety: variety.to_owned(),
        law: law.complete().unwrap(),
        spread: vec![0.15 * K, 0.2 * C],
        specimens: 6,
        repeats: 3,
    };
    let campaign = SimulatedCampaign {
        title: "Simulated".to_owned(),
        label: "simulated".to_owned(),
        rig: Rig::Pendulum(Pendulum {
            inertia: 0.014_35,
            arm: 0.505,
            mass: 0.08,
            centre_of_mass: 0.35,
            gravity: 9.806_65,
        }),
        weighed: Weighed::Given,
        velocity: 0.388,
        end: EndRule::ForceZero,
        instrument: pendulum_instrument(),
        seed: 3,
    };
    write_simulated_campaign(directory, &campaign, &[batch("a"), batch("b")]).unwrap();
    let path = directory.join("specimens.csv");
    let text = std::fs::read_to_string(&path).unwrap();
    let mut lines = text.lines();
    let mut out = format!("{},stiffness,same\n", lines.next().unwrap());
    for (i, line) in lines.enumerate() {
        let stiffness = match i {
            4 => String::new(),
            i => format!("{}", 20 + (7 * i) % 12),
        };
        out += &format!("{line},{stiffness},5\n");
    }
    std::fs::write(path, out).unwrap();
}

fn run(directory: &Path, covariates: &[&str], threads: usize) -> PopulationOutcome {
    let request = PopulationRequest {
        directory: directory.to_path_buf(),
        fit: FitRequest {
            threads: Some(threads),
            ..FitRequest::default()
        },
        covariates: covariates.iter().map(|c| (*c).to_owned()).collect(),
        ..PopulationRequest::default()
    };
    population(&request, &windfall_files::progress::quiet).unwrap()
}

/// Laws of the specimens as they were drawn.
fn truth(directory: &Path) -> Vec<[f64; 2]> {
    let text = std::fs::read_to_string(directory.join("truth.csv")).unwrap();
    let laws = text.lines().skip(1).step_by(3).map(|line| {
        let start = line.find("kuwabara").unwrap();
        let law = parse_law(line[start..].trim_matches('"')).unwrap();
        let parameters = law.complete().unwrap().parameters();
        [parameters[0].ln(), parameters[1].ln()]
    });
    laws.collect()
}

#[test]
fn recovers_the_fruit_that_were_drawn() {
    let dir = tempfile::tempdir().unwrap();
    let directory = dir.path().join("campaign");
    write_campaign(&directory);
    let outcome = run(&directory, &[], 1);
    println!("{}", text_of_population(&outcome));
    assert_eq!((outcome.fruits, outcome.impacts), (12, 36));
    assert!(outcome.converged && outcome.failed.is_empty());

    // Mean and standard deviation of the logarithms that were drawn; three
    // impacts tell each within 1 %.
    let truth = truth(&directory);
    for (i, parameter) in outcome.parameters.iter().enumerate() {
        let mean = truth.iter().map(|law| law[i]).sum::<f64>() / 12.0;
        let square: f64 = truth.iter().map(|law| (law[i] - mean).powi(2)).sum();
        let sd = (square / 11.0).sqrt();
        assert!(
            (parameter.median.value.ln() - mean).abs() < 0.01,
            "{parameter:?} {mean}"
        );
        assert!(
            (parameter.between.value / sd - 1.0).abs() < 0.1,
            "{parameter:?} {sd}"
        );
        assert!(parameter.between.low.unwrap() < sd && sd < parameter.between.high.unwrap());
        // All impacts of one fruit have one law: next to no variation is left.
        assert!(parameter.within.value < 0.02, "{parameter:?}");
        assert!(outcome.two_stage.between[i].value > 0.0);
    }
    for (fruit, law) in outcome.fruit.iter().zip(&truth) {
        assert!((fruit.parameters[0].ln() - law[0]).abs() < 0.02);
    }

    // The same bits on two threads.
    assert_eq!(outcome, run(&directory, &[], 2));
    check_posterior(&directory, &outcome);
    let csv = csv_of_population(&outcome).unwrap();
    assert!(csv.contains("mixed,sd_between,k,,"), "{csv}");

    // Words, numbers with a blank cell, a constant and a collinear covariate.
    let asked = ["variety", "log(stiffness)", "same", "stiffness"];
    let outcome = run(&directory, &asked, 2);
    println!("{}", text_of_population(&outcome));
    assert_eq!((outcome.fruits, outcome.impacts), (11, 33));
    assert_eq!(outcome.failed.len(), 3);
    assert!(
        outcome.failed[0]
            .message
            .contains("covariate stiffness has no value")
    );
    let covariates: Vec<&str> = outcome
        .effects
        .iter()
        .map(|e| e.covariate.as_str())
        .collect();
    assert_eq!(
        covariates[..3],
        ["variety=b", "log(stiffness)", "stiffness"]
    );
    let codes: Vec<&str> = outcome.findings.iter().map(|f| f.code.as_str()).collect();
    assert!(
        codes.contains(&"constant-covariate") && codes.contains(&"fruit-left-out"),
        "{codes:?}"
    );

    // A column that is not there, and a logarithm of words.
    for (covariate, expected) in [
        ("stifness", "did you mean \"stiffness\""),
        ("log(variety)", "a logarithm needs a number above zero"),
    ] {
        let request = PopulationRequest {
            directory: directory.clone(),
            covariates: vec![covariate.to_owned()],
            ..PopulationRequest::default()
        };
        let error = population(&request, &windfall_files::progress::quiet).unwrap_err();
        assert!(error.to_string().contains(expected), "{error}");
        assert!(error.is_request());
    }
}

/// The posterior of the same campaign: around the estimate, its intervals as wide;
/// drawn again, the same, and its draws are those that the ranges are of.
fn check_posterior(directory: &Path, estimate: &PopulationOutcome) {
    let file = directory.with_file_name("draws.json");
    let drawn = |threads: usize| {
        let request = PopulationRequest {
            directory: directory.to_path_buf(),
            fit: FitRequest {
                threads: Some(threads),
                draws: Some(400),
                ..FitRequest::default()
            },
            posterior: true,
            // Not from the store.
            detail: Some(file.clone()),
            ..PopulationRequest::default()
        };
        population(&request, &windfall_files::progress::quiet).unwrap()
    };
    let outcome = drawn(2);
    let posterior = outcome.posterior.as_ref().unwrap();
    println!("{}", text_of_population(&outcome));
    for (i, parameter) in estimate.parameters.iter().enumerate() {
        let (median, drawn) = (&parameter.median, &posterior.medians[i]);
        let width = median.high.unwrap() - median.low.unwrap();
        assert!(
            (drawn.value - median.value).abs() < 0.1 * width,
            "{drawn:?}"
        );
        let ratio = (drawn.high.unwrap() - drawn.low.unwrap()) / width;
        assert!((0.85..1.35).contains(&ratio), "{ratio}");
        let (spread, drawn) = (&parameter.between, &posterior.between[i]);
        assert!(spread.low.unwrap() < drawn.value && drawn.value < spread.high.unwrap());
    }
    assert!(
        csv_of_population(&outcome)
            .unwrap()
            .contains("posterior,sd_between,k,,")
    );
    let first = std::fs::read_to_string(&file).unwrap();
    assert_eq!(drawn(1).posterior.as_ref(), Some(posterior));
    assert_eq!(std::fs::read_to_string(&file).unwrap(), first);
    check_draws(&serde_json::from_str(&first).unwrap(), posterior);
}

/// Four chains of 400 draws, whose medians are those of the outcome.
fn check_draws(file: &serde_json::Value, posterior: &PopulationPosteriorOutcome) {
    assert_eq!(file["coords"]["parameter"], serde_json::json!(["k", "c"]));
    assert_eq!(file["coords"]["pair"], serde_json::json!(["k, c"]));
    let median = |name: &str, i: usize| {
        let chains = file["posterior"][name].as_array().unwrap();
        assert_eq!(chains.len(), 4, "{name}");
        let mut draws: Vec<f64> = chains
            .iter()
            .flat_map(|chain| chain.as_array().unwrap())
            .map(|draw| draw[i].as_f64().unwrap())
            .collect();
        assert_eq!(draws.len(), 1600, "{name}");
        draws.sort_by(f64::total_cmp);
        (draws[799], draws[800])
    };
    let of = [
        ("median", &posterior.medians),
        ("sd_between", &posterior.between),
        ("sd_within", &posterior.within),
        ("correlation_between", &posterior.between_correlations),
        ("correlation_within", &posterior.within_correlations),
    ];
    for (name, ranges) in of {
        assert_eq!(file["dims"][name].as_array().unwrap().len(), 1, "{name}");
        for (i, range) in ranges.iter().enumerate() {
            let (low, high) = median(name, i);
            assert!((low..=high).contains(&range.value), "{name} {i}");
        }
    }
    assert!(file["posterior"].get("effect").is_none());
}
