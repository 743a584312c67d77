//! Slow compressions from files to results.

#![allow(clippy::unwrap_used, clippy::print_stdout)]

use std::path::Path;
use windfall_campaign::pipeline::request::FitRequest;
use windfall_measure::any_outcome::AnyOutcome;
use windfall_measure::measured::{MeasuredItem, MeasuredOutcome, value_of};
use windfall_report::fit_any::fit_any;
use windfall_simulate::compression::{SimulateCompressionRequest, simulate_compression};

fn fit(directory: &Path, request: &FitRequest) -> MeasuredOutcome {
    match fit_any(directory, request, &windfall_files::progress::quiet).unwrap() {
        AnyOutcome::Measured(outcome) => *outcome,
        AnyOutcome::Impacts(_) => panic!("no compressions"),
    }
}

fn request() -> SimulateCompressionRequest {
    SimulateCompressionRequest {
        laws: None,
        law: "kuwabara-kono(k=300000, c=20000)".to_owned(),
        rates: ["1 mm/s", "20 mm/s"].map(str::to_owned).to_vec(),
        deformation: "2 mm".to_owned(),
        radius: "38 mm".to_owned(),
        plates: 2,
        yield_force: Some("18 N".to_owned()),
        fruit: 8,
        spread: 0.0,
        force_noise: "0.02 N".to_owned(),
        sampling_rate: "1 kHz".to_owned(),
        seed: 5,
    }
}

fn value(item: &MeasuredItem, name: &str) -> f64 {
    value_of(item, name)
        .unwrap_or_else(|| panic!("no {name}"))
        .value
}

#[test]
fn recovers_the_law_the_yield_and_the_modulus_put_in() {
    let dir = tempfile::tempdir().unwrap();
    let campaign = dir.path().join("campaign");
    simulate_compression(&campaign, &request()).unwrap();
    let outcome = fit(&campaign, &FitRequest::default());
    assert!(outcome.failed.is_empty(), "{:?}", outcome.failed);
    assert_eq!((outcome.impacts.len(), outcome.specimens.len()), (16, 8));
    // 95 % intervals of eight fruit, two parameters each: 13 of 16 or more with
    // a probability of 0.99.
    let inside = outcome.specimens.iter().flat_map(|item| {
        [("k", 300_000.0), ("c", 20_000.0)].map(|(name, truth)| {
            let estimate = item.parameters.get(name).unwrap();
            estimate.low.unwrap() < truth && truth < estimate.high.unwrap()
        })
    });
    let inside = inside.filter(|inside| *inside).count();
    assert!(inside >= 13, "{inside} of 16");
    // Hertz between two plates, the formula of ASAE S368: E = 0.75 (1 − ν²) k 2^1.5/√R.
    let modulus = 0.75 * 0.91 * 300_000.0 * 8.0_f64.sqrt() / 0.038_f64.sqrt();
    for item in outcome.impacts.iter().step_by(2) {
        assert!((value(item, "bioyield_force") / 18.0 - 1.0).abs() < 0.01);
        assert!((value(item, "apparent_modulus") / modulus - 1.0).abs() < 0.01);
        assert!((value(item, "deformation_rate") / 1e-3 - 1.0).abs() < 1e-3);
    }
    let again = fit(&campaign, &FitRequest::default());
    assert!(again.status.up_to_date);
    assert_eq!(again.impacts, outcome.impacts);
}

#[test]
fn conserves_results_whatever_the_file_holds_after_the_yield() {
    let dir = tempfile::tempdir().unwrap();
    let campaign = dir.path().join("campaign");
    let one = SimulateCompressionRequest {
        rates: vec!["1 mm/s".to_owned()],
        fruit: 1,
        ..request()
    };
    simulate_compression(&campaign, &one).unwrap();
    let before = fit(&campaign, &FitRequest::default());
    let file = campaign.join("raw/fruit-1-1.csv");
    let text = std::fs::read_to_string(&file).unwrap();
    // The yield is at 1.49 mm, 1.69 s; its detection a tenth of the way later.
    let changed: String = text
        .lines()
        .map(
            |line| match line.split(',').next().and_then(|t| t.parse::<f64>().ok()) {
                Some(time) if time > 1.9 => {
                    format!("{time:.6},{:.5},{:.6}\n", 9.0 * time, 3.0 * time)
                }
                _ => format!("{line}\n"),
            },
        )
        .collect();
    assert_ne!(changed, text);
    std::fs::write(&file, changed).unwrap();
    let after = fit(&campaign, &FitRequest::default());
    assert_eq!(after.status.fitted, 1);
    assert_eq!(after.impacts, before.impacts);
}

/// Bioyield forces read by eye off the loading curves, to their reading error;
/// the other four recordings have none.
#[test]
fn reference_kiwi_and_mango() {
    if windfall_test_data::find("compression/fruit_grip").is_none() {
        return;
    }
    let data = windfall_test_data::recordings();
    windfall_files::confined::also_read(vec![data.clone()]);
    let example = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples/fruit_grip");
    let dir = tempfile::tempdir().unwrap();
    for name in ["campaign.toml", "specimens.csv", "impacts.csv"] {
        let text = std::fs::read_to_string(example.join(name)).unwrap();
        let placed = text.replace("${WINDFALL_DATA}", &data.display().to_string());
        std::fs::write(dir.path().join(name), placed).unwrap();
    }
    let figures = dir.path().join("figures");
    let request = FitRequest {
        laws: vec!["hertz".to_owned()],
        figures: Some(windfall_draw::files::FigureFolder::of(&figures)),
        ..FitRequest::default()
    };
    let outcome = fit(dir.path(), &request);
    assert!(outcome.failed.is_empty(), "{:?}", outcome.failed);
    let by_eye = [
        ("kiwi-1", None),
        ("kiwi-2", Some(6.2)),
        ("kiwi-3", Some(3.7)),
        ("kiwi-4", None),
        ("kiwi-5", None),
        ("kiwi-6", Some(7.1)),
        ("mango-1", Some(14.0)),
        ("mango-2", None),
        ("mango-3", Some(11.2)),
        ("mango-4", Some(9.3)),
    ];
    for (item, (id, force)) in outcome.impacts.iter().zip(by_eye) {
        assert_eq!(item.id, id);
        let found = value_of(item, "bioyield_force").map(|v| v.value);
        assert_eq!(found.is_some(), force.is_some(), "{id}: {found:?}");
        if let (Some(found), Some(force)) = (found, force) {
            assert!((found - force).abs() < 0.25, "{id}: {found}");
        }
        // The law ends before the yield and follows what it was fitted to.
        let part = value(item, "residual_rms") / value(item, "fitted_force");
        assert!(value(item, "fitted_force") < value(item, "loading_force"));
        assert!(part < 0.05, "{id}: {part}");
        assert!(figures.join(format!("{id}.svg")).is_file());
    }
}

#[test]
fn rejects_options_that_only_impacts_have() {
    let dir = tempfile::tempdir().unwrap();
    let campaign = dir.path().join("campaign");
    simulate_compression(&campaign, &request()).unwrap();
    for (request, expected) in [
        (
            FitRequest {
                weights: Some("inverse-mean".to_owned()),
                ..FitRequest::default()
            },
            "--weights",
        ),
        (
            FitRequest {
                laws: vec!["thornton".to_owned()],
                ..FitRequest::default()
            },
            "choose hertz",
        ),
        (
            FitRequest {
                group: Some("varity".to_owned()),
                ..FitRequest::default()
            },
            "neither specimens.csv",
        ),
    ] {
        let message = match fit_any(&campaign, &request, &windfall_files::progress::quiet) {
            Err(error) => error.to_string(),
            Ok(outcome) => outcome.failed()[0].message.clone(),
        };
        assert!(message.contains(expected), "{message}");
    }
}
