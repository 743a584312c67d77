//! Taps with known resonances in noise.

use std::f64::consts::{PI, TAU};
use windfall_signal::noise_gaussian::{noise_source, normal, uniform};
use windfall_signal::recording::{Channel, Quantity, Times};
use windfall_signal::resonance::{Resonance, ResonanceOptions, quiet_spectrum, resonances};
use windfall_signal::tap::{TapOptions, Taps, find_taps};

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
