//! Taps with known resonances in noise.

#![allow(clippy::unwrap_used, clippy::print_stdout)]

use std::f64::consts::{PI, TAU};
use windfall_signal::noise::gaussian::{noise_source, normal, uniform};
use windfall_signal::recording::{Channel, Quantity, Times};
use windfall_signal::tap::find::{TapOptions, Taps, find_taps};
use windfall_signal::tap::resonance::{Resonance, ResonanceOptions, quiet_spectrum, resonances};

const RATE: f64 = 44_100.0;
/// Begin of the tap; s.
const ONSET: f64 = 0.1;
/// Length of the recording; s.
const LENGTH: f64 = 0.4;

/// A damped sinusoid: frequency (Hz), quality, amplitude, phase.
type Sinusoid = (f64, f64, f64, f64);

fn sound(modes: &[Sinusoid], noise: f64, seed: u64) -> Channel {
    let mut source = noise_source(seed, 0);
    let samples = (0..(LENGTH * RATE) as usize).map(|i| {
        let t = i as f64 / RATE - ONSET;
        let ring = |&(f, q, a, phase): &Sinusoid| {
            a * (-PI * f / q * t).exp() * (TAU * f * t - phase).cos()
        };
        let clean: f64 = if t >= 0.0 {
            modes.iter().map(ring).sum()
        } else {
            0.0
        };
        clean + noise * normal(&mut source)
    });
    Channel {
        name: "channel 1".to_owned(),
        quantity: Quantity::Sound,
        times: Times::Uniform {
            start: 0.0,
            interval: 1.0 / RATE,
        },
        samples: samples.collect(),
    }
}

fn evaluate(channel: &Channel) -> (Taps, Vec<Resonance>) {
    let taps = find_taps(channel, &TapOptions::default()).unwrap();
    assert_eq!(taps.taps.len(), 1);
    let quiet = channel.samples[taps.quiet.clone().unwrap()].to_vec();
    let quiet = quiet_spectrum(&quiet, taps.interval).unwrap();
    let ringing = &channel.samples[taps.taps[0].ringing.clone()];
    let options = ResonanceOptions::default();
    let found = resonances(ringing, taps.interval, Some(&quiet), &options).unwrap();
    (taps, found)
}

/// Relative errors of the frequency and of Q, each with its standard error.
fn errors(f: f64, q: f64, noise: f64, seed: u64) -> [(f64, f64); 2] {
    let phase = TAU * uniform(&mut noise_source(seed, 7));
    let (_, found) = evaluate(&sound(&[(f, q, 1.0, phase)], noise, seed));
    let near = found
        .iter()
        .filter(|r| (r.mode.frequency / f - 1.0).abs() < 0.05);
    let mode = near
        .max_by(|a, b| a.level.total_cmp(&b.level))
        .unwrap()
        .mode;
    [
        (mode.frequency / f - 1.0, mode.frequency_sd / f),
        (mode.quality / q - 1.0, mode.quality_sd / q),
    ]
}

/// Root mean square and largest of the errors, and the part of the truths that
/// lies within 1.96 standard errors.
fn statistics(errors: &[(f64, f64)]) -> (f64, f64, f64) {
    let n = errors.len() as f64;
    let rms = (errors.iter().map(|(e, _)| e * e).sum::<f64>() / n).sqrt();
    let largest = errors.iter().fold(0.0, |a: f64, (e, _)| a.max(e.abs()));
    let inside = errors.iter().filter(|(e, sd)| e.abs() <= 1.96 * sd).count();
    (rms, largest, inside as f64 / n)
}

#[test]
fn recovers_the_frequency_of_a_tap_within_a_thousandth_at_20_db() {
    // Signal over noise in power, the signal taken as the mean square of the
    // first 50 ms: 20 dB.
    for (f, q) in [(400.0, 10.0), (800.0, 20.0), (1500.0, 30.0)] {
        let decay = PI * f / q;
        let power = (1.0 - (-2.0 * decay * 0.05_f64).exp()) / (4.0 * decay * 0.05);
        let noise = (power / 100.0).sqrt();
        let both: Vec<[(f64, f64); 2]> = (0..200).map(|seed| errors(f, q, noise, seed)).collect();
        for (which, name) in ["frequency", "quality"].iter().enumerate() {
            let errors: Vec<(f64, f64)> = both.iter().map(|pair| pair[which]).collect();
            let (rms, largest, inside) = statistics(&errors);
            println!(
                "{f} Hz, Q {q}, {name}: rms {rms:.2e}, largest {largest:.2e}, inside {inside}"
            );
            // 190 of 200 are expected; outside 0.90 to 0.99 at 1 in 500.
            assert!((0.90..=0.99).contains(&inside), "{name} {inside}");
            if *name == "frequency" {
                assert!(largest < 1e-3 && rms < 3e-4, "{largest} {rms}");
            }
        }
    }
}

#[test]
fn recovers_a_split_mode_and_higher_modes() {
    let modes = [
        (780.0, 20.0, 1.0, 0.3),
        (840.0, 22.0, 0.6, 1.9),
        (1180.0, 25.0, 0.5, -0.7),
    ];
    let mut outside = 0;
    for seed in 0..20 {
        let (taps, found) = evaluate(&sound(&modes, 0.02, seed));
        assert!((taps.taps[0].onset - ONSET).abs() < 1e-3);
        assert_eq!(found.len(), 3, "{found:?}");
        for (found, (f, q, ..)) in found.iter().zip(modes) {
            let mode = found.mode;
            assert!((mode.frequency / f - 1.0).abs() < 2e-3, "{mode:?}");
            assert!((mode.quality / q - 1.0).abs() < 0.15, "{mode:?}");
            outside += usize::from((mode.frequency - f).abs() > 1.96 * mode.frequency_sd);
            assert!(!found.in_quiet);
        }
    }
    // 3 of 60 are expected; 9 or more at 1 in 300.
    assert!(outside < 9, "{outside} of 60 outside their intervals");
}

#[test]
fn recovers_taps_in_their_order_with_bounds_that_leave_out_the_next() {
    let mut channel = sound(&[(800.0, 20.0, 1.0, 0.3)], 0.005, 3);
    let second = sound(&[(800.0, 20.0, 0.4, 1.3)], 0.005, 4);
    channel.samples.extend(second.samples);
    let taps = find_taps(&channel, &TapOptions::default()).unwrap();
    let onsets: Vec<f64> = taps.taps.iter().map(|tap| tap.onset).collect();
    assert_eq!(onsets.len(), 2);
    assert!((onsets[0] - ONSET).abs() < 1e-3 && (onsets[1] - LENGTH - ONSET).abs() < 1e-3);
    assert!(taps.findings.is_empty());
    // A recording that was triggered by the tap.
    let begin = ((ONSET + 1e-4) * RATE) as usize;
    channel.samples.drain(..begin);
    let taps = find_taps(&channel, &TapOptions::default()).unwrap();
    let codes: Vec<&str> = taps.findings.iter().map(|finding| finding.code()).collect();
    assert_eq!((taps.taps.len(), codes), (2, vec!["begins_in_tap"]));
}

#[test]
fn recovers_a_beating_pair_as_one_tap() {
    let channel = sound(
        &[(600.0, 30.0, 1.0, 0.0), (640.0, 30.0, 1.0, 0.0)],
        0.003,
        5,
    );
    assert_eq!(
        find_taps(&channel, &TapOptions::default())
            .unwrap()
            .taps
            .len(),
        1
    );
}

#[test]
fn recovers_nothing_from_noise_alone_and_from_hum() {
    for seed in 0..10 {
        let error = find_taps(&sound(&[], 1.0, seed), &TapOptions::default()).unwrap_err();
        assert!(
            error
                .to_string()
                .starts_with("no tap in channel 'channel 1'"),
            "{error}"
        );
    }
    for hum in [0.05, 0.15] {
        let mut channel = sound(&[(800.0, 20.0, 1.0, 0.3)], 0.005, 3);
        for (i, x) in channel.samples.iter_mut().enumerate() {
            *x += hum * (TAU * 450.0 * i as f64 / RATE).sin();
        }
        let (_, found) = evaluate(&channel);
        assert_eq!(found.len(), 1, "{found:?}");
        assert!((found[0].mode.frequency - 800.0).abs() < 1.0);
    }
}

#[test]
fn rejects_channels_that_cannot_be_used() {
    let options = TapOptions::default();
    let good = sound(&[(800.0, 20.0, 1.0, 0.3)], 0.005, 3);
    let message = |channel: &Channel, options: &TapOptions| {
        find_taps(channel, options).unwrap_err().to_string()
    };
    let mut times: Vec<f64> = (0..good.samples.len()).map(|i| i as f64 / RATE).collect();
    let mut gap = good.clone();
    for time in times.iter_mut().skip(9000) {
        *time += 0.01;
    }
    gap.times = Times::Listed(times);
    assert!(
        message(&gap, &options).contains("not evenly")
            || message(&gap, &options).contains("even spacing")
    );
    let mut broken = good.clone();
    broken.samples[77] = f64::NAN;
    assert!(message(&broken, &options).contains("sample 77"));
    let mut short = good.clone();
    short.samples.truncate(50);
    assert!(message(&short, &options).contains("50 samples"));
    let wide = TapOptions {
        high: 22_000.0,
        ..options
    };
    assert!(message(&good, &wide).starts_with("band = 22000"));
}
