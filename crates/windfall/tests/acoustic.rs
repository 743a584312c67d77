//! Taps from files to the stiffness of fruit.

#![allow(clippy::unwrap_used, clippy::print_stdout)]

use std::path::Path;
use windfall_campaign::pipeline::request::FitRequest;
use windfall_measure::any_outcome::AnyOutcome;
use windfall_measure::measured::{MeasuredItem, MeasuredOutcome};
use windfall_report::any_text::{csv_of_any, text_of_any};
use windfall_report::fit_any::fit_any;
use windfall_simulate::taps::{SimulateTapsRequest, simulate_taps};

fn request() -> SimulateTapsRequest {
    SimulateTapsRequest {
        frequency: "800 Hz".to_owned(),
        quality: 20.0,
        mass: "0.2 kg".to_owned(),
        fruit: 5,
        taps: 2,
        spread: 0.08,
        split: 0.0,
        signal_to_noise: 20.0,
        file: "wav".to_owned(),
        sampling_rate: "44100 Hz".to_owned(),
        seed: 3,
    }
}

fn fit(directory: &Path, request: &FitRequest) -> MeasuredOutcome {
    match fit_any(directory, request, &windfall_files::progress::quiet).unwrap() {
        AnyOutcome::Measured(outcome) => *outcome,
        AnyOutcome::Impacts(_) => panic!("no taps"),
    }
}

/// Masses (kg) and frequencies (Hz) that were put in.
fn truth(directory: &Path) -> Vec<(f64, f64)> {
    let text = std::fs::read_to_string(directory.join("specimens.csv")).unwrap();
    let numbers = |line: &str| {
        let cells: Vec<f64> = line
            .split(',')
            .skip(1)
            .map(|c| c.parse().unwrap())
            .collect();
        (1e-3 * cells[0], cells[1])
    };
    text.lines().skip(1).map(numbers).collect()
}

fn frequency(item: &MeasuredItem) -> (f64, f64) {
    let value = item.derived.get("acoustic_frequency").unwrap();
    (value.value, value.sd.unwrap())
}

#[test]
fn recovers_frequencies_and_stiffness_through_files_of_both_formats() {
    for file in ["wav", "csv"] {
        let dir = tempfile::tempdir().unwrap();
        let campaign = dir.path().join("campaign");
        let request = SimulateTapsRequest {
            file: file.to_owned(),
            fruit: if file == "csv" { 2 } else { 5 },
            ..request()
        };
        simulate_taps(&campaign, &request).unwrap();
        let outcome = fit(&campaign, &FitRequest::default());
        assert!(outcome.failed.is_empty(), "{:?}", outcome.failed);
        let truth = truth(&campaign);
        assert_eq!(outcome.specimens.len(), truth.len());
        for (item, (mass, f)) in outcome.specimens.iter().zip(truth) {
            let (found, sd) = frequency(item);
            // 0.1 % of one tap at 20 dB; four taps here. Beyond four standard
            // uncertainties of four taps: 1 in 30 (t, 3 degrees of freedom) for
            // none to differ by six.
            assert!((found / f - 1.0).abs() < 1e-3, "{found} {f}");
            assert!((found - f).abs() < 6.0 * sd, "{found} {f} {sd}");
            let stiffness = item.derived.get("acoustic_stiffness").unwrap().value;
            let expected = f * f * mass.powf(2.0 / 3.0);
            assert!((stiffness / expected - 1.0).abs() < 2e-3);
            assert_eq!(item.words.get("confidence").unwrap(), "high");
            assert_eq!(item.words.get("taps").unwrap(), "4/4");
        }
    }
}

#[test]
fn recovers_both_frequencies_of_fruit_that_are_no_spheres() {
    let dir = tempfile::tempdir().unwrap();
    let campaign = dir.path().join("campaign");
    let request = SimulateTapsRequest {
        split: 0.06,
        ..request()
    };
    simulate_taps(&campaign, &request).unwrap();
    let outcome = fit(&campaign, &FitRequest::default());
    for (item, (_, f)) in outcome.specimens.iter().zip(truth(&campaign)) {
        let (found, sd) = frequency(item);
        assert!((found / f - 1.0).abs() < 3e-3, "{found} {f}");
        // Half of 6 % of the frequency, over √3.
        assert!((sd / (0.03 * f / 3.0_f64.sqrt()) - 1.0).abs() < 0.05);
        assert_eq!(item.findings[0].code, "doublet");
        assert_eq!(item.words.get("confidence").unwrap(), "medium");
    }
}

#[test]
fn recovers_no_mode_where_the_fruit_does_not_ring() {
    let dir = tempfile::tempdir().unwrap();
    let campaign = dir.path().join("campaign");
    let request = SimulateTapsRequest {
        frequency: "300 Hz".to_owned(),
        quality: 3.0,
        fruit: 2,
        ..request()
    };
    simulate_taps(&campaign, &request).unwrap();
    let outcome = fit(&campaign, &FitRequest::default());
    for item in &outcome.specimens {
        assert!(item.derived.get("acoustic_frequency").is_none());
        assert_eq!(item.words.get("confidence").unwrap(), "none");
        assert_eq!(item.findings[0].code, "no_first_mode");
    }
    let csv = csv_of_any(&AnyOutcome::Measured(Box::new(outcome))).unwrap();
    assert!(
        csv.lines()
            .nth(1)
            .unwrap()
            .starts_with("fruit-1,,,,,,0,none,")
    );
}

#[test]
fn repeats_from_the_store_and_for_any_number_of_threads() {
    let dir = tempfile::tempdir().unwrap();
    let campaign = dir.path().join("campaign");
    let request = SimulateTapsRequest {
        fruit: 2,
        ..request()
    };
    simulate_taps(&campaign, &request).unwrap();
    let threads = |n| FitRequest {
        threads: Some(n),
        reuse: windfall_campaign::pipeline::request::Reuse::Nothing,
        ..FitRequest::default()
    };
    let one = fit(&campaign, &threads(1));
    let two = fit(&campaign, &threads(2));
    let stored = fit(&campaign, &FitRequest::default());
    assert!(stored.status.up_to_date);
    assert_eq!(one.specimens, two.specimens);
    assert_eq!(one.specimens, stored.specimens);
    assert_eq!(one.impacts, stored.impacts);
}

#[test]
fn pinned_columns_for_specimens_csv_and_figures() {
    let dir = tempfile::tempdir().unwrap();
    let campaign = dir.path().join("campaign");
    let request = SimulateTapsRequest {
        fruit: 1,
        ..request()
    };
    simulate_taps(&campaign, &request).unwrap();
    let toml = campaign.join("campaign.toml");
    let text = std::fs::read_to_string(&toml).unwrap();
    let text = text.replace("kind = \"acoustic\"", "kind = \"acoustic\"\ndensity = 850");
    std::fs::write(&toml, text).unwrap();
    let figures = dir.path().join("figures");
    let outcome = fit(
        &campaign,
        &FitRequest {
            figures: Some(windfall_draw::files::FigureFolder::of(&figures)),
            ..FitRequest::default()
        },
    );
    let outcome = AnyOutcome::Measured(Box::new(outcome));
    let csv = csv_of_any(&outcome).unwrap();
    assert_eq!(
        csv.lines().next().unwrap(),
        "specimen,acoustic_frequency_Hz,acoustic_frequency_sd_Hz,acoustic_stiffness_Hz2_kg2_3,\
         acoustic_stiffness_sd_Hz2_kg2_3,acoustic_stiffness_1e6_Hz2_g2_3,acoustic_stiffness_Pa,\
         acoustic_stiffness_sd_Pa,taps,confidence,simulated"
    );
    let cells: Vec<f64> = csv
        .lines()
        .nth(1)
        .unwrap()
        .split(',')
        .skip(1)
        .take(7)
        .map(|cell| cell.parse().unwrap())
        .collect();
    assert!((cells[4] / cells[2] - 1e-4).abs() < 1e-15);
    // The cube root of 850 is 9.472682.
    assert!((cells[5] / cells[2] - 9.472_682).abs() < 1e-6);
    assert!(text_of_any(&outcome).contains("SIMULATED recordings"));
    let svg = std::fs::read_to_string(figures.join("fruit-1-1.svg")).unwrap();
    assert!(svg.contains("first mode of the fruit"));
    assert!(figures.join("fruit-1-1.csv").is_file());
}

#[test]
fn rejects_settings_that_make_no_sense() {
    let dir = tempfile::tempdir().unwrap();
    let campaign = dir.path().join("campaign");
    let request = SimulateTapsRequest {
        fruit: 1,
        taps: 1,
        ..request()
    };
    simulate_taps(&campaign, &request).unwrap();
    let toml = campaign.join("campaign.toml");
    let good = std::fs::read_to_string(&toml).unwrap();
    let message = |more: &str| {
        std::fs::write(&toml, format!("{good}\n{more}\n")).unwrap();
        match fit_any(
            &campaign,
            &FitRequest::default(),
            &windfall_files::progress::quiet,
        ) {
            Ok(outcome) => outcome.failed()[0].message.clone(),
            Err(error) => error.to_string(),
        }
    };
    for (more, expected) in [
        ("[acoustic]\nband = \"2500 Hz … 150 Hz\"", "the lower first"),
        ("[acoustic]\nband = \"150 Hz\"", "two frequencies"),
        ("[acoustic]\nband = \"150 Hz … 30 kHz\"", "sampling rate"),
        ("[acoustic]\nleast_quality = 0", "at least 0.5"),
        ("[acoustic]\nagreement = 2", "a part above 0"),
        ("[acoustic]\nhit = \"2 Hz\"", "hit"),
        ("[acoustic]\nlongest = \"1 ms\"", "at least 0.02 s"),
        ("[acoustic]\nleast_Q = 4", "least_Q"),
        ("[acoustic]\nshared = \"keeep\"", "did you mean"),
    ] {
        let message = message(more);
        assert!(message.contains(expected), "{more}: {message}");
    }
    let text = good.replace("[channels.sound]\ncolumn = \"channel 1\"", "");
    std::fs::write(&toml, text).unwrap();
    let error = fit_any(
        &campaign,
        &FitRequest::default(),
        &windfall_files::progress::quiet,
    )
    .unwrap_err();
    assert!(
        error.to_string().contains("[channels] needs `sound`"),
        "{error}"
    );
    std::fs::write(&toml, &good).unwrap();
    let law = FitRequest {
        laws: vec!["hertz".to_owned()],
        ..FitRequest::default()
    };
    let error = fit_any(&campaign, &law, &windfall_files::progress::quiet).unwrap_err();
    assert!(error.to_string().contains("acoustic"), "{error}");
    // A recording that is cut short is one failure, not the end.
    let wav = campaign.join("raw/fruit-1-1.wav");
    let bytes = std::fs::read(&wav).unwrap();
    std::fs::write(&wav, &bytes[..2000]).unwrap();
    let outcome = fit(&campaign, &FitRequest::default());
    assert_eq!((outcome.failed.len(), outcome.impacts.len()), (1, 1));
}
