//! Calibration on waveforms: truth is recovered from noisy records.

#![allow(clippy::unwrap_used)]

use windfall_contact::expression::parse_law;
use windfall_contact::law::EndRule;
use windfall_contact::laws::kind::Law;
use windfall_drop_rig::rig::{DropRig, Plate};
use windfall_drop_rig::simulate::{drop_trajectory, simulate_drop};
use windfall_drop_rig::waveform::{
    DropRecord, Knowledge, WaveformFit, WaveformPlate, WaveformProblem, WaveformRig,
};
use windfall_drop_rig::waveform_fit::calibrate_waveform;
use windfall_signal::noise::gaussian::{noise_source, normal};
use windfall_signal::uncertain::Uncertain;

const GRAVITY: f64 = 9.80665;
const RATE: f64 = 10_000.0;
const NOISE: f64 = 0.02;
const PLATE: Plate = Plate {
    mass: 0.2,
    stiffness: 647_998.8,
    damping: 52.47,
};

fn law(text: &str) -> Law {
    parse_law(text).unwrap().complete().unwrap()
}

fn rig(mass: f64, plate: Option<Plate>) -> DropRig {
    DropRig {
        mass,
        effective_mass_factor: 1.0,
        gravity: GRAVITY,
        plate,
    }
}

/// A drop of `impacts` bounces with its noise.
fn record(truth: &Law, rig: &DropRig, height: f64, impacts: usize, seed: u64) -> DropRecord {
    let end = EndRule::ForceZero;
    let mut source = noise_source(seed, 7);
    let drop = simulate_drop(truth, rig, height, impacts, end).unwrap();
    let from = drop.impacts[0].onset_time - 0.0123;
    let last = drop.impacts[impacts - 1].onset_time + 0.1;
    let count = ((last - from) * RATE) as usize;
    let times: Vec<f64> = (0..count).map(|i| from + i as f64 / RATE).collect();
    let motion = drop_trajectory(truth, rig, height, &times, end).unwrap();
    let force = motion.support_force.iter();
    let force = force.map(|force| force + NOISE * normal(&mut source));
    let onsets: Vec<f64> = drop.impacts.iter().map(|i| i.onset_time + 1.5e-4).collect();
    let windows = onsets.iter().map(|onset| (onset - 3e-3, onset + 0.04));
    let speed = (2.0 * GRAVITY * height).sqrt();
    DropRecord {
        force: force.collect(),
        windows: windows.collect(),
        onsets,
        times,
        noise: NOISE,
        velocity: Knowledge::Prior(Uncertain {
            value: speed,
            sd: 2e-3 * speed,
        }),
        mass: Knowledge::Prior(Uncertain {
            value: rig.mass,
            sd: 2e-3 * rig.mass,
        }),
    }
}

fn problem(start: &str, free: Vec<usize>, records: Vec<DropRecord>) -> WaveformProblem {
    WaveformProblem {
        law: law(start),
        free,
        end: EndRule::ForceZero,
        rig: WaveformRig {
            gravity: GRAVITY,
            effective_mass_factor: Knowledge::Fixed(1.0),
            plate: Some(WaveformPlate {
                mass: Knowledge::Fixed(PLATE.mass),
                stiffness: Knowledge::Free(640_000.0),
                damping: Knowledge::Free(45.0),
            }),
        },
        records,
    }
}

/// Within four standard uncertainties and within `part` of the truth.
fn check(fit: &WaveformFit, truth: &[(&str, f64)], part: f64) {
    assert!(fit.converged);
    assert!((fit.misfit - 1.0).abs() < 0.1, "{fit:?}");
    for (name, truth) in truth {
        let place = fit.names.iter().position(|known| known == name).unwrap();
        let found = fit.estimates[place];
        let error = (found.value - truth).abs();
        assert!(
            error < part * truth.abs(),
            "{name}: {found:?}, truth {truth}"
        );
        assert!(error < 4.0 * found.sd, "{name}: {found:?}, truth {truth}");
        assert!(found.sd < part * truth.abs(), "{name}: {found:?}");
    }
}

/// Two bounces of drops from three heights, from Hertz's start, on a plate that
/// rings: stiffness, exponent and damping within 1 %.
#[test]
fn recovers_an_impact_law_through_the_plate() {
    let truth = law("adams-impact(k=466143.6, e=1.91, c=0.556, d=1e-6)");
    let records = [(0.1, 4.5e-3), (0.3, 4.8e-3), (0.5, 5.2e-3), (0.5, 4.7e-3)];
    let records = records
        .iter()
        .enumerate()
        .map(|(i, &(height, mass))| record(&truth, &rig(mass, Some(PLATE)), height, 2, i as u64));
    let start = "adams-impact(k=170763, e=1.5, c=0.4, d=1e-6)";
    let fit = calibrate_waveform(&problem(start, vec![0, 1, 2], records.collect())).unwrap();
    let truth = [("k", 466_143.6), ("e", 1.91), ("c", 0.556)];
    check(&fit, &truth, 0.02);
    check(
        &fit,
        &[
            ("e", 1.91),
            ("c", 0.556),
            ("plate_stiffness", PLATE.stiffness),
            ("plate_damping", PLATE.damping),
        ],
        0.01,
    );
    assert_eq!(fit.names.len(), fit.covariance.len());
    let weak = fit.weakest.unwrap();
    assert_eq!(weak.shares.len(), fit.names.len());
}

/// Another law of the registry, one bounce each, a plate that does not move.
#[test]
fn recovers_kuwabara_kono_on_a_rigid_plate() {
    let truth = law("kuwabara-kono(k=4e5, c=250)");
    let records = [0.1, 0.3].iter().map(|height| {
        let mut record = record(&truth, &rig(4.8e-3, None), *height, 1, 3);
        record.windows[0].1 = record.onsets[0] + 0.02;
        record
    });
    let mut problem = problem("kuwabara-kono(k=1e5, c=50)", vec![0, 1], records.collect());
    problem.rig.plate = None;
    let fit = calibrate_waveform(&problem).unwrap();
    check(&fit, &[("k", 4e5), ("c", 250.0)], 0.02);
}

/// The effective mass factor is told by the bounces.
#[test]
fn recovers_the_effective_mass_factor() {
    let truth = law("adams-impact(k=466143.6, e=1.91, c=0.556, d=1e-6)");
    let records = [0.2, 0.5].iter().map(|height| {
        let mut rig = rig(4.8e-3, Some(PLATE));
        rig.effective_mass_factor = 0.818;
        record(&truth, &rig, *height, 2, 11)
    });
    let start = "adams-impact(k=300000, e=1.8, c=0.4, d=1e-6)";
    let mut problem = problem(start, vec![0, 1, 2], records.collect());
    problem.rig.effective_mass_factor = Knowledge::Free(0.9);
    let fit = calibrate_waveform(&problem).unwrap();
    check(
        &fit,
        &[("effective_mass_factor", 0.818), ("e", 1.91), ("c", 0.556)],
        0.02,
    );
}

/// Fruit that differ: the intervals are then those of the scatter between them.
#[test]
fn recovers_with_intervals_of_the_scatter_between_fruit() {
    let records = (0..10).map(|i| {
        let factor = 1.0 + 0.05 * (f64::from(i) - 4.5) / 3.0;
        let truth = law(&format!("kuwabara-kono(k={}, c=250)", 4e5 * factor));
        record(&truth, &rig(4.8e-3, Some(PLATE)), 0.3, 1, i as u64)
    });
    let start = "kuwabara-kono(k=3e5, c=100)";
    let fit = calibrate_waveform(&problem(start, vec![0, 1], records.collect())).unwrap();
    assert!(fit.by_records);
    let k = fit.estimates[0];
    assert!(k.low < 4e5 && 4e5 < k.high, "{k:?}");
    // Ten fruit with a spread of 4.8 %: 1.6 % of the mean (Hertz's waveform
    // weighs them about alike).
    assert!((0.008..0.03).contains(&(k.sd / k.value)), "{k:?}");
    assert!(fit.misfit > 1.1, "{}", fit.misfit);
}

#[test]
fn rejects_what_cannot_be_fitted() {
    let truth = law("kuwabara-kono(k=4e5, c=250)");
    let one = record(&truth, &rig(4.8e-3, Some(PLATE)), 0.3, 1, 1);
    let nothing = calibrate_waveform(&problem("hertz(k=4e5)", vec![], vec![one.clone()]));
    assert!(nothing.unwrap_err().to_string().contains("nothing to fit"));
    let none = calibrate_waveform(&problem("hertz(k=4e5)", vec![0], vec![]));
    assert!(none.unwrap_err().to_string().contains("0 samples"));
    let mut silent = one;
    silent.noise = 0.0;
    let error = calibrate_waveform(&problem("hertz(k=4e5)", vec![0], vec![silent])).unwrap_err();
    assert!(error.to_string().starts_with("noise is 0"), "{error}");
}
