//! Errors of the displacement rate by each method, on a motion in closed form
//! as encoders of three rigs count it: the table of docs/guide/src/rates.md.
//!
//! `cargo run --release -p windfall-signal --example rates`

#![allow(clippy::print_stdout)]

use windfall_signal::options::RateMethod;
use windfall_signal::recording::{Channel, Quantity, Recording, Times};
use windfall_signal::trigger::Threshold;
use windfall_signal::{ExtractOptions, extract_impact};

/// A mass on a damped spring: 6.5 ms of contact, 0.39 m/s, as on the 2003 pendulum.
const OMEGA: f64 = 450.0;
const DECAY: f64 = 60.0;
const SPEED: f64 = 0.388;
const MASS: f64 = 0.0563;

fn motion(t: f64) -> (f64, f64, f64) {
    let w = (OMEGA * OMEGA - DECAY * DECAY).sqrt();
    let contact = |t: f64| {
        let fade = (-DECAY * t).exp();
        let x = SPEED / w * fade * (w * t).sin();
        let rate = SPEED * fade * ((w * t).cos() - DECAY / w * (w * t).sin());
        (x, rate, -OMEGA * OMEGA * x - 2.0 * DECAY * rate)
    };
    match t {
        t if t < 0.0 => (SPEED * t, SPEED, 0.0),
        t if t <= duration() => contact(t),
        t => {
            let (x, rate, _) = contact(duration());
            (x + rate * (t - duration()), rate, 0.0)
        }
    }
}

fn duration() -> f64 {
    let w = (OMEGA * OMEGA - DECAY * DECAY).sqrt();
    (std::f64::consts::PI - (2.0 * DECAY * w / (w * w - DECAY * DECAY)).atan()) / w
}

/// Position in counts, and force, from 8 ms before touch to 8 ms after the end.
fn recording(quantum: f64, rate: f64) -> Recording {
    let start = -8e-3;
    let samples = ((duration() + 16e-3) * rate) as usize;
    let at = |i: usize| motion(start + i as f64 / rate);
    let channel = |name: &str, quantity, samples: Vec<f64>| Channel {
        name: name.to_owned(),
        quantity,
        times: Times::Uniform {
            start,
            interval: 1.0 / rate,
        },
        samples,
    };
    let counts = (0..samples).map(|i| (at(i).0 / quantum).floor() * quantum);
    let force = (0..samples).map(|i| -MASS * at(i).2);
    Recording {
        name: "impact".to_owned(),
        channels: vec![
            channel("x", Quantity::Displacement, counts.collect()),
            channel("F", Quantity::Force, force.collect()),
        ],
        missing: Vec::new(),
        doubts: Vec::new(),
    }
}

fn error(recording: &Recording, rate: RateMethod) -> Option<f64> {
    let mut options = ExtractOptions {
        rate,
        ..ExtractOptions::default()
    };
    options.trigger.threshold = Threshold::Fixed(0.5);
    let (impact, _) = extract_impact(recording, &options).ok()?;
    let series = impact.rate?;
    let inside = series.times.iter().zip(&series.values);
    let squares: Vec<f64> = inside
        .filter(|(t, _)| **t > 0.0 && **t < duration())
        .map(|(t, v)| (v - motion(*t).1).powi(2))
        .collect();
    Some((squares.iter().sum::<f64>() / squares.len() as f64).sqrt())
}

fn main() {
    println!("| encoder | central difference | edge times | Savitzky-Golay | smoothing spline |");
    println!("|---|---|---|---|---|");
    for (quantum, rate) in [(8.814e-6, 200e3), (8.814e-6, 2e6), (181.3e-6, 200e3)] {
        let recording = recording(quantum, rate);
        let polynomial = RateMethod::LocalPolynomial {
            order: 2,
            window: None,
        };
        let cells = [
            RateMethod::CentralDifference,
            RateMethod::EdgeTimes,
            polynomial,
            RateMethod::SmoothingSpline,
        ]
        .map(|method| match error(&recording, method) {
            Some(error) => format!("{:.1} mm/s ({:.1} %)", 1e3 * error, 100.0 * error / SPEED),
            None => "none".to_owned(),
        });
        println!(
            "| {:.1} µm at {:.0} kHz | {} |",
            1e6 * quantum,
            rate / 1e3,
            cells.join(" | ")
        );
    }
}
