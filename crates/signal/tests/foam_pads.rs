//! Real recordings: a cart on an incline runs into a foam pad, five runs side
//! by side, force at 100 Hz and motion at 25 Hz, compression negative.
//!
//! The data are not part of windfall. `WINDFALL_DATA` names their folder.

#![allow(clippy::unwrap_used, clippy::print_stdout)]

use std::path::PathBuf;
use windfall_signal::mass::mass_from_impulse;
use windfall_signal::recording::{Channel, Quantity, Recording, Times};
use windfall_signal::uncertain::Uncertain;
use windfall_signal::{ExtractOptions, Finding, extract_impact};

fn pads() -> Option<PathBuf> {
    windfall_test_data::find("impact/foam_pads")
}

/// One run of the five in a file: force, position and velocity.
fn run(text: &str, number: usize) -> Recording {
    let mut lines = text.lines();
    let header: Vec<&str> = lines
        .next()
        .unwrap()
        .split(',')
        .map(|h| h.trim_matches('"'))
        .collect();
    let column = |name: &str| {
        let wanted = format!("Run {number}: {name}");
        header.iter().position(|h| h.starts_with(&wanted)).unwrap()
    };
    let rows: Vec<Vec<&str>> = lines.map(|line| line.split(',').collect()).collect();
    let time = column("Time");
    let channel = |name: &str, quantity| {
        let values = column(name);
        let filled = rows.iter().filter(|row| !row[values].trim().is_empty());
        let (times, samples) = filled
            .map(|row| {
                (
                    row[time].parse::<f64>().unwrap(),
                    row[values].parse::<f64>().unwrap(),
                )
            })
            .unzip();
        Channel {
            name: format!("Run {number}: {name}"),
            quantity,
            times: Times::Listed(times),
            samples,
        }
    };
    Recording {
        name: format!("run {number}"),
        channels: vec![
            channel("Force", Quantity::Force),
            channel("Position", Quantity::Displacement),
            channel("Velocity", Quantity::Rate),
        ],
        missing: Vec::new(),
        doubts: Vec::new(),
    }
}

/// Contact duration and peak force of the authors' own analysis
/// (`author_tau_Fpeak_table.csv` beside the data); s, N. Their file of 4 mm
/// holds other runs than `pad_4mm.csv`, so only 40 mm can be compared.
const AUTHORS_40MM: [(f64, f64); 5] = [
    (0.250, 5.31),
    (0.250, 5.37),
    (0.250, 5.20),
    (0.260, 5.40),
    (0.260, 5.38),
];

#[test]
fn reference_foam_pads_agree_with_their_authors() {
    let Some(folder) = pads() else { return };
    let text = std::fs::read_to_string(folder.join("pad_40mm.csv")).unwrap();
    for (number, (duration, peak)) in (1..).zip(AUTHORS_40MM) {
        let (impact, findings) =
            extract_impact(&run(&text, number), &ExtractOptions::default()).unwrap();
        let measured = impact.measured;
        // Theirs are whole samples of 10 ms above an unknown threshold.
        assert!((measured.contact_duration.unwrap() - duration).abs() < 0.025);
        assert!((measured.peak_force.unwrap() - peak).abs() < 0.06);
        let codes: Vec<_> = findings.iter().map(Finding::code).collect();
        // Compression is negative in the files; motion is at 25 Hz.
        assert_eq!(
            codes,
            ["reversed", "few-samples", "few-samples"],
            "{findings:?}"
        );
    }
}

#[test]
fn conserves_one_mass_over_both_pads() {
    let Some(folder) = pads() else { return };
    let mut masses = Vec::new();
    for file in ["pad_4mm.csv", "pad_40mm.csv"] {
        let text = std::fs::read_to_string(folder.join(file)).unwrap();
        for number in 1..=5 {
            let (impact, _) =
                extract_impact(&run(&text, number), &ExtractOptions::default()).unwrap();
            // The slopes of the velocity before and after lie between 0 and 0.6 m/s².
            let driving = Uncertain {
                value: 0.3,
                sd: 0.17,
            };
            let mass = mass_from_impulse(&impact.measured, driving).unwrap();
            println!("{file} run {number}: {:.4} ± {:.4} kg", mass.value, mass.sd);
            masses.push(mass.value);
        }
    }
    // The notes beside the data say "near 0.5 kg"; one cart has one mass.
    assert!(
        masses.iter().all(|mass| (0.45..0.6).contains(mass)),
        "{masses:?}"
    );
    let largest = masses.iter().copied().fold(0.0, f64::max);
    let smallest = masses.iter().copied().fold(1.0, f64::min);
    assert!(largest < 1.1 * smallest, "{masses:?}");
}
