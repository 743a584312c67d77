//! Standard uncertainties of what is read off the signals, against the spread over repeated
//! noise on one motion.

use windfall_signal::impact::Measured;
use windfall_signal::noise::gaussian::{noise_source, normal};
use windfall_signal::recording::{Channel, Quantity, Recording, Times};
use windfall_signal::{ExtractOptions, extract_impact};

/// Between samples; s.
const INTERVAL: f64 = 5e-5;
/// Mass of the carriage; kg.
const MASS: f64 = 0.2;
/// Repeats of the noise.
const REPEATS: u64 = 200;

/// Force and position of a carriage that meets a fruit at 0.5 m/s under
/// F = k x^1.5 + c √x v, k = 7e5 N/m^1.5, c = 1200 N s/m^1.5; N, m.
fn motion() -> (Vec<f64>, Vec<f64>) {
    let (mut x, mut v): (f64, f64) = (-0.0101, 0.5);
    let push = |x: f64, v: f64| {
        let depth = x.max(0.0);
        (7e5 * depth.powf(1.5) + 1200.0 * depth.sqrt() * v).max(0.0)
    };
    let (mut force, mut position) = (Vec::new(), Vec::new());
    while x > -0.0101 || v > 0.0 {
        force.push(push(x, v));
        position.push(x);
        for _ in 0..50 {
            let dt = INTERVAL / 50.0;
            let half = v - 0.5 * dt * push(x, v) / MASS;
            x += dt * half;
            v = half - 0.5 * dt * push(x, half) / MASS;
        }
    }
    (force, position)
}

/// What is measured of the motion under each of many noises, in N and m.
fn repeats(of_force: f64, of_position: f64) -> Vec<Measured> {
    let (force, position) = motion();
    let noisy = |values: &[f64], noise: f64, seed: u64| {
        let mut source = noise_source(seed, 0);
        values
            .iter()
            .map(|value| value + noise * normal(&mut source))
            .collect::<Vec<_>>()
    };
    let options = ExtractOptions {
        effective_mass: Some(MASS),
        ..ExtractOptions::default()
    };
    let measured = (0..REPEATS).map(|seed| {
        let channel = |name: &str, quantity, samples| Channel {
            name: name.to_owned(),
            quantity,
            times: Times::Uniform {
                start: 0.0,
                interval: INTERVAL,
            },
            samples,
        };
        let recording = Recording {
            name: "carriage".to_owned(),
            channels: vec![
                channel("force", Quantity::Force, noisy(&force, of_force, 2 * seed)),
                channel(
                    "position",
                    Quantity::Displacement,
                    noisy(&position, of_position, 2 * seed + 1),
                ),
            ],
            missing: Vec::new(),
            doubts: Vec::new(),
        };
        extract_impact(&recording, &options).unwrap().0.measured
    });
    measured.collect()
}

/// The root mean square of the stated deviations over the spread of the values.
fn stated_over_spread(
    measured: &[Measured],
    value: fn(&Measured) -> Option<f64>,
    sd: fn(&Measured) -> Option<f64>,
) -> f64 {
    let values: Vec<f64> = measured.iter().map(|own| value(own).unwrap()).collect();
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    let spread = values.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / (n - 1.0);
    let stated = measured
        .iter()
        .map(|own| sd(own).unwrap().powi(2))
        .sum::<f64>()
        / n;
    (stated / spread).sqrt()
}

/// One quantity of an impact.
type Value = fn(&Measured) -> Option<f64>;

#[test]
fn recovers_the_spread_of_peaks_duration_velocities_and_impulse() {
    for (of_force, of_position) in [(0.1, 2e-6), (0.8, 2e-6)] {
        let measured = repeats(of_force, of_position);
        let checks: [(&str, Value, Value); 6] = [
            (
                "impact velocity",
                |m| m.impact_velocity,
                |m| m.impact_velocity_sd,
            ),
            (
                "rebound velocity",
                |m| m.rebound_velocity,
                |m| m.rebound_velocity_sd,
            ),
            ("impulse", |m| m.impulse, |m| m.impulse_sd),
            ("peak force", |m| m.peak_force, |m| m.peak_force_sd),
            (
                "duration",
                |m| m.contact_duration,
                |m| m.contact_duration_sd,
            ),
            (
                "largest displacement",
                |m| m.max_displacement,
                |m| m.max_displacement_sd,
            ),
        ];
        let ratios =
            checks.map(|(name, value, sd)| (name, stated_over_spread(&measured, value, sd)));
        let bad = ratios
            .iter()
            .filter(|(_, ratio)| !(0.8..1.25).contains(ratio));
        assert_eq!(bad.count(), 0, "noise {of_force} N: {ratios:.3?}");
    }
}
