//! Coverage of the waveform calibration: simulated campaigns of five heights
//! and five drops each, calibrated from a poor start, over and over.
//!
//!     cargo run --release -p windfall-identify --example drop_coverage -- 200
//!
//! Noise, 12-bit converter, sampling at 10 kHz and the ringing plate are those
//! of the study's bench; masses and heights are known with error.

#![allow(clippy::print_stdout, clippy::unwrap_used)]

use std::time::Instant;
use windfall_contact::expression::parse_law;
use windfall_contact::law::EndRule;
use windfall_contact::laws::kind::Law;
use windfall_drop_rig::rig::{DropRig, Plate};
use windfall_drop_rig::simulate::{drop_trajectory, simulate_drop};
use windfall_drop_rig::waveform::{
    DropRecord, Knowledge, WaveformFit, WaveformPlate, WaveformProblem, WaveformRig,
};
use windfall_drop_rig::waveform_fit::calibrate_waveform;
use windfall_signal::noise::gaussian::{noise_source, normal, uniform};
use windfall_signal::uncertain::Uncertain;

const GRAVITY: f64 = 9.80665;
const HEIGHTS: [f64; 5] = [0.1, 0.2, 0.3, 0.4, 0.5];
const DROPS: usize = 5;
const RATE: f64 = 10_000.0;
/// 10 mV of a transmitter of 0.1 V/N.
const NOISE: f64 = 0.02;
/// 12 bits over 5 V at 0.1 V/N.
const QUANTUM: f64 = 5.0 / 4096.0 / 0.1;
const MASS: f64 = 4.8e-3;
const MASS_SPREAD: f64 = 3e-4;
const MASS_SD: f64 = 2e-5;
const HEIGHT_SD: f64 = 1e-3;
const PLATE: Plate = Plate {
    mass: 0.2,
    stiffness: 647_998.8,
    damping: 52.47,
};
const TRUTH: &str = "adams-impact(k=466143.6, e=1.91, c=0.556, d=1e-6)";
const START: &str = "adams-impact(k=170763, e=1.5, c=0.4, d=1e-6)";

fn law(text: &str) -> Law {
    parse_law(text)
        .and_then(|law| law.complete())
        .unwrap_or_else(|error| panic!("{error}"))
}

/// One recorded drop of a campaign.
fn record(seed: u64, number: u64, height: f64, impacts: usize) -> DropRecord {
    let mut source = noise_source(seed, number);
    let mass = MASS + MASS_SPREAD * normal(&mut source);
    let true_height = height + HEIGHT_SD * normal(&mut source);
    let weighed = mass + MASS_SD * normal(&mut source);
    let rig = DropRig {
        mass,
        effective_mass_factor: 1.0,
        gravity: GRAVITY,
        plate: Some(PLATE),
    };
    let truth = law(TRUTH);
    let end = EndRule::ForceZero;
    let drop = simulate_drop(&truth, &rig, true_height, impacts + 1, end).unwrap();
    let from = drop.impacts[0].onset_time - 0.02 - uniform(&mut source) / RATE;
    let last = drop.impacts[impacts].onset_time - 0.02;
    let count = ((last - from) * RATE) as usize;
    let times: Vec<f64> = (0..count).map(|i| from + i as f64 / RATE).collect();
    let motion = drop_trajectory(&truth, &rig, true_height, &times, end).unwrap();
    let force = motion.support_force.iter().map(|force| {
        let noisy = force + NOISE * normal(&mut source);
        (noisy / QUANTUM).round() * QUANTUM
    });
    let force: Vec<f64> = force.collect();
    // What a threshold would see: a little late, to a sample.
    let seen = |onset: f64| ((onset + 1e-4 - from) * RATE).ceil() / RATE + from;
    let onsets: Vec<f64> = drop.impacts[..impacts]
        .iter()
        .map(|i| seen(i.onset_time))
        .collect();
    let speed = (2.0 * GRAVITY * height).sqrt();
    DropRecord {
        windows: onsets
            .iter()
            .map(|onset| (onset - 3e-3, onset + 0.06))
            .collect(),
        onsets,
        times,
        force,
        noise: NOISE.hypot(QUANTUM / 12f64.sqrt()),
        velocity: Knowledge::Prior(Uncertain {
            value: speed,
            sd: GRAVITY * HEIGHT_SD / speed,
        }),
        mass: Knowledge::Prior(Uncertain {
            value: weighed,
            sd: MASS_SD,
        }),
    }
}

fn problem(seed: u64, impacts: usize) -> WaveformProblem {
    let drops = HEIGHTS
        .iter()
        .flat_map(|height| std::iter::repeat_n(*height, DROPS));
    let records = drops
        .enumerate()
        .map(|(i, height)| record(seed, i as u64, height, impacts));
    let law = law(START);
    WaveformProblem {
        law,
        free: vec![0, 1, 2],
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
        records: records.collect(),
    }
}

/// Truth of each estimate, with k in N/mm^e as the study gives it.
fn truths(fit: &WaveformFit) -> Vec<f64> {
    let law = law(TRUTH).parameters();
    let of = |name: &String| match name.as_str() {
        "k" => law[0],
        "e" => law[1],
        "c" => law[2],
        "plate_stiffness" => PLATE.stiffness,
        _ => PLATE.damping,
    };
    fit.names.iter().map(of).collect()
}

fn main() {
    let mut arguments = std::env::args().skip(1);
    let replicates: u64 = arguments.next().and_then(|a| a.parse().ok()).unwrap_or(20);
    let impacts: usize = arguments.next().and_then(|a| a.parse().ok()).unwrap_or(2);
    let mut covered = [0u64; 5];
    let mut errors = vec![Vec::new(); 5];
    let mut sds = [0.0; 5];
    let mut names = Vec::new();
    let (mut time, mut failed, mut by_records) = (0.0, 0, 0);
    for seed in 1..=replicates {
        let problem = problem(seed, impacts);
        let begun = Instant::now();
        let fit = calibrate_waveform(&problem).unwrap();
        time += begun.elapsed().as_secs_f64();
        failed += u64::from(!fit.converged);
        by_records += u64::from(fit.by_records);
        for (i, (estimate, truth)) in fit.estimates.iter().zip(truths(&fit)).enumerate() {
            covered[i] += u64::from(estimate.low <= truth && truth <= estimate.high);
            errors[i].push(estimate.value / truth - 1.0);
            sds[i] += estimate.sd / truth / replicates as f64;
        }
        if seed == 1 {
            println!(
                "first: misfit {:.4}, {} samples, {} evaluations",
                fit.misfit, fit.samples, fit.evaluations
            );
            println!("weakest: {:?}", fit.weakest);
        }
        names = fit.names;
    }
    println!(
        "{replicates} campaigns, {impacts} impacts of each drop, {:.2} s each, {failed} not converged, {by_records} by records",
        time / replicates as f64
    );
    println!("parameter        covered   bias %    spread %   mean sd %   largest error %");
    for (i, name) in names.iter().enumerate() {
        let n = errors[i].len() as f64;
        let mean = errors[i].iter().sum::<f64>() / n;
        let spread = (errors[i].iter().map(|e| (e - mean).powi(2)).sum::<f64>() / (n - 1.0)).sqrt();
        let largest = errors[i].iter().map(|e| e.abs()).fold(0.0, f64::max);
        println!(
            "{name:<16} {:>6.1} %  {:>8.4}  {:>8.4}   {:>8.4}   {:>8.4}",
            100.0 * covered[i] as f64 / n,
            100.0 * mean,
            100.0 * spread,
            100.0 * sds[i],
            100.0 * largest
        );
    }
}
