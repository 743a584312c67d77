//! Filters, drift, the tip ahead of a sensor, and channels that check each other,
//! on a motion in closed form: a mass on a damped spring.

#![allow(clippy::unwrap_used)]

use windfall_signal::conditioning::ChannelFilter;
use windfall_signal::filter::butterworth::Band;
use windfall_signal::impact::Impact;
use windfall_signal::noise::gaussian::{noise_source, normal};
use windfall_signal::options::RateMethod;
use windfall_signal::recording::{Channel, Quantity, Recording, Times};
use windfall_signal::trigger::{Baseline, Threshold};
use windfall_signal::{Error, ExtractOptions, Finding, extract_impact};

const MASS: f64 = 0.2;
const OMEGA: f64 = 450.0;
const DECAY: f64 = 60.0;
const SPEED: f64 = 0.5;
const INTERVAL: f64 = 1e-5;

/// Displacement, rate and acceleration t after first touch.
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

fn restitution() -> f64 {
    (-DECAY * duration()).exp()
}

/// Channels sampled at 100 kHz from 20 ms before touch to 30 ms after.
fn recording(force: impl FnMut(f64) -> f64, acceleration: bool) -> Recording {
    let times: Vec<f64> = (0..5000).map(|i| f64::from(i) * INTERVAL - 0.02).collect();
    let channel = |name: &str, quantity, samples: Vec<f64>| Channel {
        name: name.to_owned(),
        quantity,
        times: Times::Uniform {
            start: -0.02,
            interval: INTERVAL,
        },
        samples,
    };
    let of = |pick: fn((f64, f64, f64)) -> f64| times.iter().map(|t| pick(motion(*t))).collect();
    let mut channels = vec![
        channel("x", Quantity::Displacement, of(|m| m.0)),
        channel(
            "F",
            Quantity::Force,
            times.iter().copied().map(force).collect(),
        ),
    ];
    if acceleration {
        channels.push(channel("a", Quantity::Acceleration, of(|m| m.2)));
    }
    Recording {
        name: "impact".to_owned(),
        channels,
        missing: Vec::new(),
        doubts: Vec::new(),
    }
}

fn true_force(t: f64) -> f64 {
    -MASS * motion(t).2
}

fn options() -> ExtractOptions {
    let mut options = ExtractOptions {
        effective_mass: Some(MASS),
        ..ExtractOptions::default()
    };
    options.trigger.threshold = Threshold::Fixed(1.0);
    options
}

fn extract(recording: &Recording, options: &ExtractOptions) -> (Impact, Vec<Finding>) {
    extract_impact(recording, options).unwrap()
}

fn has(findings: &[Finding], code: &str) -> bool {
    findings.iter().any(|finding| finding.code() == code)
}

#[test]
fn conserves_energy_between_loop_and_velocities() {
    let (impact, findings) = extract(&recording(true_force, true), &options());
    let measured = impact.measured;
    let absorbed = 0.5 * MASS * SPEED * SPEED * (1.0 - restitution().powi(2));
    // The jump of the force at touch, 12 N, is smeared over a sample.
    assert!((measured.hysteresis_energy.unwrap() / absorbed - 1.0).abs() < 1e-2);
    assert!((measured.absorbed_energy.unwrap() / absorbed - 1.0).abs() < 1e-4);
    assert!(measured.loading_energy.unwrap() > measured.hysteresis_energy.unwrap());
    assert!((measured.acceleration_impulse_ratio.unwrap() - 1.0).abs() < 1e-9);
    assert!((measured.acceleration_peak_ratio.unwrap() - 1.0).abs() < 1e-9);
    assert!(measured.integrated_displacement_error.unwrap() < 1e-5);
    assert!(!has(&findings, "energy-mismatch") && !has(&findings, "accelerometer-disagrees"));
}

/// Against drift a high-pass filter helps, and costs: it takes away the free
/// motion before contact, of which the displacement consists.
#[test]
fn closed_form_high_pass_integration_is_worse_without_drift_and_bounded_with_it() {
    let error = |offset: f64, high_pass: bool| {
        let mut recording = recording(true_force, true);
        recording.channels[2]
            .samples
            .iter_mut()
            .for_each(|a| *a += offset);
        let mut options = options();
        if high_pass {
            options.conditioning.acceleration = Some(ChannelFilter {
                band: Band::HighPass(20.0),
                order: 2,
            });
        }
        let (impact, _) = extract(&recording, &options);
        impact.measured.integrated_displacement_error.unwrap()
    };
    // 40 m/s² over 7 ms: half of a t².
    let drift = 0.5 * 40.0 * duration() * duration();
    assert!((error(40.0, false) / drift - 1.0).abs() < 0.1);
    assert!(error(0.0, true) > 1e-4);
    assert!((error(40.0, true) / error(0.0, true) - 1.0).abs() < 0.2);
}

#[test]
fn rejects_a_force_of_another_calibration() {
    let (impact, findings) = extract(&recording(|t| 1.2 * true_force(t), true), &options());
    assert!((impact.measured.acceleration_impulse_ratio.unwrap() - 1.2).abs() < 1e-2);
    assert!(has(&findings, "accelerometer-disagrees"));
    let (_, findings) = extract(&recording(|t| 2.0 * true_force(t), false), &options());
    assert!(has(&findings, "energy-mismatch"));
}

#[test]
fn recovers_the_force_ahead_of_a_tip() {
    let tip = 0.012;
    let sensor = |t: f64| (1.0 - tip / MASS) * true_force(t);
    let mut options = options();
    options.conditioning.tip_mass = Some(tip);
    // From the rig's own motion, and from a measured acceleration.
    for acceleration in [false, true] {
        let (impact, findings) = extract(&recording(sensor, acceleration), &options);
        let force = impact.force.unwrap();
        for (time, value) in force.times.iter().zip(&force.values) {
            assert!((value - true_force(*time)).abs() < 1e-9, "{time}: {value}");
        }
        assert!(has(&findings, "tip-mass"));
    }
    options.effective_mass = None;
    let refused = extract_impact(&recording(sensor, false), &options).unwrap_err();
    assert!(matches!(
        refused,
        Error::BadOption {
            option: "tip mass",
            ..
        }
    ));
}

#[test]
fn recovers_the_force_under_a_drift() {
    let drifting = |t: f64| true_force(t) + 3.0 + 150.0 * t;
    let mut options = options();
    options.trigger.threshold = Threshold::Fixed(8.0);
    let (plain, told) = extract(&recording(drifting, false), &options);
    options.trigger.baseline = Baseline::Keep;
    let (kept, _) = extract(&recording(drifting, false), &options);
    options.trigger.baseline = Baseline::Drift;
    let (impact, findings) = extract(&recording(drifting, false), &options);
    let largest = (0..2000)
        .map(|i| true_force(f64::from(i) * INTERVAL))
        .fold(0.0, f64::max);
    let error = |impact: &Impact| (impact.measured.peak_force.unwrap() - largest).abs();
    assert!(error(&impact) < 1e-6, "{}", error(&impact));
    assert!(error(&kept) > 0.5, "{}", error(&kept));
    assert!(has(&findings, "drift-removed"));
    // Without being asked for, too.
    assert!(error(&plain) < 1e-6, "{}", error(&plain));
    assert!(has(&told, "drift-removed"));
}

#[test]
fn conserves_the_peak_under_a_filter_above_its_band() {
    let mut noise = noise_source(7, 0);
    let mut noisy = recording(|_| 0.0, false);
    for (i, sample) in noisy.channels[1].samples.iter_mut().enumerate() {
        *sample = true_force(i as f64 * INTERVAL - 0.02) + 2.0 * normal(&mut noise);
    }
    let mut options = options();
    options.trigger.threshold = Threshold::Fixed(8.0);
    options.conditioning.force = Some(ChannelFilter {
        band: Band::LowPass(2e3),
        order: 4,
    });
    let (impact, findings) = extract(&noisy, &options);
    let largest = (0..2000)
        .map(|i| true_force(f64::from(i) * INTERVAL))
        .fold(0.0, f64::max);
    let peak = impact.measured.peak_force.unwrap();
    assert!((peak / largest - 1.0).abs() < 0.02, "{peak} {largest}");
    let filtered = findings
        .iter()
        .find(|f| f.code() == "filtered")
        .unwrap()
        .to_string();
    assert!(
        filtered.contains("low-pass filtered at 2000 Hz"),
        "{filtered}"
    );
    options.conditioning.force = Some(ChannelFilter {
        band: Band::LowPass(6e4),
        order: 4,
    });
    let refused = extract_impact(&noisy, &options).unwrap_err().to_string();
    assert!(refused.contains("half the sampling rate"), "{refused}");
}

/// An encoder of 8.8 µm: DOMAIN-typical numbers of the 2003 pendulum at 100 kHz.
/// Standard errors of the rate over the contact, in m/s.
#[test]
fn closed_form_errors_of_the_rates() {
    let quantum = 8.8e-6;
    let mut counted = recording(true_force, false);
    for sample in &mut counted.channels[0].samples {
        *sample = (*sample / quantum).floor() * quantum;
    }
    let error = |rate: RateMethod| {
        let options = ExtractOptions { rate, ..options() };
        let (impact, _) = extract(&counted, &options);
        let series = impact.rate.unwrap();
        let inside = series.times.iter().zip(&series.values);
        // Away from touch and end, where the acceleration jumps.
        let inside = inside.filter(|(t, _)| **t > 3e-4 && **t < duration() - 3e-4);
        let squares: Vec<f64> = inside.map(|(t, v)| (v - motion(*t).1).powi(2)).collect();
        (squares.iter().sum::<f64>() / squares.len() as f64).sqrt()
    };
    let central = error(RateMethod::CentralDifference);
    let edges = error(RateMethod::EdgeTimes);
    let spline = error(RateMethod::SmoothingSpline);
    let polynomial = error(RateMethod::LocalPolynomial {
        order: 3,
        window: None,
    });
    // The quantum of the central difference is 0.44 m/s at 10 µs.
    assert!(central > 0.1, "{central}");
    assert!(edges < 0.4 * central, "{edges} {central}");
    assert!(spline < 0.05 * central, "{spline}");
    assert!(polynomial < 0.05 * central, "{polynomial}");
}

fn with_acceleration(change: impl Fn(usize, f64) -> f64) -> Recording {
    let mut recording = recording(true_force, true);
    let samples = recording.channels[2].samples.iter_mut().enumerate();
    samples.for_each(|(i, a)| *a = change(i, *a));
    recording
}

/// An accelerometer that shows 40 m/s² at rest says the same of a tip and of the
/// force as one that shows 0.
#[test]
fn conserves_tip_and_check_under_an_offset_of_the_accelerometer() {
    let tip = 0.012;
    let mut offset = with_acceleration(|_, a| a + 40.0);
    let (impact, findings) = extract(&offset, &options());
    assert!((impact.measured.acceleration_impulse_ratio.unwrap() - 1.0).abs() < 1e-9);
    assert!((impact.measured.acceleration_peak_ratio.unwrap() - 1.0).abs() < 1e-9);
    assert!(!has(&findings, "accelerometer-disagrees"));
    let force = &mut offset.channels[1].samples;
    force.iter_mut().for_each(|f| *f *= 1.0 - tip / MASS);
    let mut options = options();
    options.conditioning.tip_mass = Some(tip);
    let (impact, _) = extract(&offset, &options);
    let force = impact.force.unwrap();
    for (time, value) in force.times.iter().zip(&force.values) {
        assert!((value - true_force(*time)).abs() < 1e-9, "{time}: {value}");
    }
}

/// White noise of the accelerometer: the ratio of the impulses scatters as its
/// stated uncertainty says, 40 recordings within a third.
#[test]
fn recovers_the_ratio_of_impulses_within_its_uncertainty() {
    let mut squares = 0.0;
    for seed in 0..40 {
        let mut noise = noise_source(seed, 0);
        let values: Vec<f64> = (0..5000).map(|_| 8.0 * normal(&mut noise)).collect();
        let (impact, _) = extract(&with_acceleration(|i, a| a + values[i]), &options());
        let measured = impact.measured;
        let sd = measured.acceleration_impulse_ratio_sd.unwrap();
        assert!(sd > 1e-4 && sd < 1e-2, "{sd}");
        squares += ((measured.acceleration_impulse_ratio.unwrap() - 1.0) / sd).powi(2);
        assert!(measured.acceleration_peak_ratio_sd.unwrap() > 0.0);
    }
    let scatter = (squares / 40.0).sqrt();
    assert!((0.67..1.5).contains(&scatter), "{scatter}");
}

/// A zero that wanders by four peaks over the recording, either way.
#[test]
fn recovers_the_force_under_a_drift_larger_than_itself() {
    let largest = (0..2000)
        .map(|i| true_force(f64::from(i) * INTERVAL))
        .fold(0.0, f64::max);
    let mut options = options();
    options.trigger.threshold = Threshold::Fixed(8.0);
    options.trigger.baseline = Baseline::Drift;
    for slope in [-80.0, 80.0] {
        let drifting = |t: f64| true_force(t) + slope * largest * t;
        let (impact, findings) = extract(&recording(drifting, false), &options);
        assert!((impact.measured.peak_force.unwrap() - largest).abs() < 1e-6);
        assert!(has(&findings, "drift-removed"));
    }
}

#[test]
fn closed_form_what_is_kept_before_and_after() {
    let mut options = options();
    options.pre_trigger = 0.012;
    options.post_trigger = 0.009;
    let (impact, _) = extract(&recording(true_force, false), &options);
    let times = impact.force.unwrap().times;
    let before = impact.onset - times[0];
    let after = times[times.len() - 1] - impact.end;
    assert!((before - 0.012).abs() < 2.0 * INTERVAL, "{before}");
    assert!((after - 0.009).abs() < 2.0 * INTERVAL, "{after}");
}

/// Over a twentieth of the contact the rounding of edges to samples hardly matters.
#[test]
fn converges_edge_times_with_their_window() {
    let quantum = 8.8e-6;
    let mut counted = recording(true_force, false);
    let position = &mut counted.channels[0];
    position.quantity = Quantity::EncoderCount;
    let samples = position.samples.iter_mut();
    samples.for_each(|x| *x = (*x / quantum).floor());
    let error = |window: f64| {
        let options = ExtractOptions {
            encoder: Some(windfall_signal::kinematics::Encoder::Linear {
                count_length: quantum,
            }),
            rate: RateMethod::EdgeTimes,
            edge_window: window,
            ..options()
        };
        let (impact, _) = extract(&counted, &options);
        let rate = impact.rate.unwrap();
        let inside = |t: f64| t > impact.onset + 2e-4 && t < impact.end - 2e-4;
        let squares: Vec<f64> = rate
            .times
            .iter()
            .zip(&rate.values)
            .filter(|(t, _)| inside(**t))
            .map(|(t, v)| (v - motion(*t).1).powi(2))
            .collect();
        (squares.iter().sum::<f64>() / squares.len() as f64).sqrt()
    };
    let (neighbours, twentieth) = (error(0.0), error(duration() / 20.0));
    assert!(neighbours > 0.02, "{neighbours}");
    assert!(twentieth < neighbours / 10.0, "{neighbours} {twentieth}");
}
