//! From simulated instruments back to the motion that they saw.
//!
//! The motion is the closed form of a damped spring (Kelvin-Voigt), which owes
//! nothing to windfall's integrator or laws.

#![allow(clippy::unwrap_used)]

use windfall_signal::impact::{Impact, Series};
use windfall_signal::instrument::{
    Converter, EncoderOutput, EncoderSensor, InitialPhase, Instrument, Sensor, Trajectory,
    calibrated, pendulum_instrument, record,
};
use windfall_signal::kinematics::{Encoder, count_length};
use windfall_signal::mass::mass_from_impulse;
use windfall_signal::noise::gaussian::{noise_source, normal};
use windfall_signal::options::RateMethod;
use windfall_signal::recording::Recording;
use windfall_signal::trigger::{
    ContactChoice, Contacts, Orientation, Signal, Threshold, TriggerOptions, find_contacts,
};
use windfall_signal::uncertain::Uncertain;
use windfall_signal::{Error, ExtractOptions, Finding, extract_impact};

/// A mass that meets a spring and a damper in parallel at time 0 and leaves
/// them when their force is zero.
#[derive(Clone, Copy)]
struct Bounce {
    mass: f64,
    /// Undamped angular frequency; 1/s.
    frequency: f64,
    /// c/2m; 1/s.
    decay: f64,
    speed: f64,
}

/// About 6 ms of contact: the 2003 pendulum.
const PENDULUM: Bounce = Bounce {
    mass: 0.0563,
    frequency: 450.0,
    decay: 60.0,
    speed: 0.388,
};

/// About 0.25 s of contact: a cart against a foam pad.
const CART: Bounce = Bounce {
    mass: 0.5,
    frequency: 12.0,
    decay: 1.2,
    speed: 0.87,
};

impl Bounce {
    fn damped(&self) -> f64 {
        (self.frequency.powi(2) - self.decay.powi(2)).sqrt()
    }

    /// t_c = (π − atan(2bw/(w² − b²)))/w.
    fn duration(&self) -> f64 {
        let (b, w) = (self.decay, self.damped());
        (std::f64::consts::PI - (2.0 * b * w / (w * w - b * b)).atan()) / w
    }

    /// e = exp(−b t_c).
    fn restitution(&self) -> f64 {
        (-self.decay * self.duration()).exp()
    }

    /// Displacement, rate, acceleration.
    fn at(&self, t: f64) -> (f64, f64, f64) {
        let (b, w, v) = (self.decay, self.damped(), self.speed);
        let contact = |t: f64| {
            let fade = (-b * t).exp();
            let x = v / w * fade * (w * t).sin();
            let rate = v * fade * ((w * t).cos() - b / w * (w * t).sin());
            (x, rate, -self.frequency.powi(2) * x - 2.0 * b * rate)
        };
        let end = self.duration();
        if t < 0.0 {
            (v * t, v, 0.0)
        } else if t <= end {
            contact(t)
        } else {
            let (x, rate, _) = contact(end);
            (x + rate * (t - end), rate, 0.0)
        }
    }

    fn trajectory(&self, from: f64, until: f64, interval: f64) -> Trajectory {
        let n = ((until - from) / interval).round() as usize;
        let mut all = Trajectory::default();
        for i in 0..=n {
            let t = from + i as f64 * interval;
            let (x, rate, acceleration) = self.at(t);
            all.times.push(t);
            all.displacement.push(x);
            all.rate.push(rate);
            all.acceleration.push(acceleration);
            all.force.push(-self.mass * acceleration);
        }
        all
    }
}

fn pendulum_options() -> ExtractOptions {
    ExtractOptions {
        encoder: Some(Encoder::Rotary {
            counts_per_revolution: 360_000.0,
        }),
        arm: Some(0.505),
        effective_mass: Some(PENDULUM.mass),
        ..ExtractOptions::default()
    }
}

fn recording(trajectory: &Trajectory, instrument: &Instrument, seed: u64) -> Recording {
    calibrated(
        "simulated",
        &record(trajectory, instrument, seed).unwrap(),
        instrument,
    )
}

fn codes(findings: &[Finding]) -> Vec<&'static str> {
    findings.iter().map(Finding::code).collect()
}

/// Largest distance of a displacement series from the truth, both zero at onset.
fn worst(impact: &Impact, truth: &Bounce) -> f64 {
    let zero = truth.at(impact.onset).0;
    let series = impact.displacement.as_ref().unwrap();
    let distance = |(t, x): (&f64, &f64)| (x - (truth.at(*t).0 - zero)).abs();
    series
        .times
        .iter()
        .zip(&series.values)
        .map(distance)
        .fold(0.0, f64::max)
}

#[test]
fn recovers_a_pendulum_impact_from_phases_and_volts() {
    let trajectory = PENDULUM.trajectory(-6e-3, 14e-3, 5e-6);
    let q = count_length(360_000.0, 0.505);
    let peak = trajectory.force.iter().copied().fold(0.0, f64::max);
    for seed in 0..20 {
        let recording = recording(&trajectory, &pendulum_instrument(), seed);
        let (impact, findings) = extract_impact(&recording, &pendulum_options()).unwrap();
        assert_eq!(codes(&findings), Vec::<&str>::new(), "{findings:?}");
        // Two positions, each known to within one count.
        assert!(
            worst(&impact, &PENDULUM) <= q,
            "{}",
            worst(&impact, &PENDULUM) / q
        );

        let measured = impact.measured;
        let rebound = PENDULUM.restitution() * PENDULUM.speed;
        let within = |value: Option<f64>, truth: f64, sd: Option<f64>| {
            assert!(
                (value.unwrap() - truth).abs() < 5.0 * sd.unwrap(),
                "{value:?} {truth} {sd:?}"
            );
        };
        within(measured.impact_velocity, 0.388, measured.impact_velocity_sd);
        assert!(measured.impact_velocity_sd.unwrap() < 0.388e-3);
        assert!((measured.rebound_velocity.unwrap() / rebound - 1.0).abs() < 2e-3);
        assert!((measured.restitution.unwrap() - PENDULUM.restitution()).abs() < 2e-3);
        let impulse = PENDULUM.mass * (0.388 + rebound);
        within(measured.impulse, impulse, measured.impulse_sd);
        // The largest of some thousand samples with 1 N of noise would be 3 N high.
        let found = measured.peak_force.unwrap();
        assert!((found - peak).abs() < 0.5, "{found} {peak}");
        assert!((impact.onset).abs() < 1e-4, "{}", impact.onset);
        assert!((measured.contact_duration.unwrap() - PENDULUM.duration()).abs() < 0.4e-3);
        // t of the largest displacement: tan(wt) = w/b.
        let top = (PENDULUM.damped() / PENDULUM.decay).atan() / PENDULUM.damped();
        let largest = PENDULUM.at(top).0 - PENDULUM.at(impact.onset).0;
        assert!((measured.max_displacement.unwrap() - largest).abs() < q);
        let absorbed = 0.5 * PENDULUM.mass * (0.388f64.powi(2) - rebound.powi(2));
        assert!((measured.absorbed_energy.unwrap() / absorbed - 1.0).abs() < 5e-3);
    }
}

#[test]
fn recovers_the_noise_that_was_put_in() {
    let trajectory = PENDULUM.trajectory(-10e-3, 14e-3, 5e-6);
    let mean = |series: fn(&Impact) -> Option<&Series>, instrument: &Instrument| {
        let noises = (0..20).map(|seed| {
            let recording = recording(&trajectory, instrument, seed);
            let (impact, _) = extract_impact(&recording, &pendulum_options()).unwrap();
            series(&impact).unwrap().noise
        });
        noises.sum::<f64>() / 20.0
    };
    // 20 × 2000 samples of the baseline: standard error 0.35 %.
    let mut instrument = pendulum_instrument();
    let force = mean(|i| i.force.as_ref(), &instrument);
    assert!((force - 1.0).abs() < 0.015, "{force}");
    // Uniform rounding of a count: q/√12.
    let q = count_length(360_000.0, 0.505);
    let displacement = mean(|i| i.displacement.as_ref(), &instrument);
    assert!(
        (displacement / (q / 12f64.sqrt()) - 1.0).abs() < 0.1,
        "{displacement}"
    );
    // A sensor of displacement, of rate and of acceleration in place of the encoder.
    let sensor = |noise| Sensor {
        persistence: 0.0,
        sensitivity: 2.0,
        offset: 0.1,
        noise,
        sampling_rate: 200e3,
        converter: None,
    };
    instrument.encoder = None;
    instrument.displacement = Some(sensor(2e-6));
    instrument.rate = Some(sensor(3e-3));
    instrument.acceleration = Some(sensor(4.0));
    for (found, put_in) in [
        (mean(|i| i.displacement.as_ref(), &instrument), 2e-6),
        (mean(|i| i.rate.as_ref(), &instrument), 3e-3),
        (mean(|i| i.acceleration.as_ref(), &instrument), 4.0),
    ] {
        assert!((found / put_in - 1.0).abs() < 0.05, "{found} {put_in}");
    }
}

#[test]
fn recovers_rates_from_displacement() {
    let trajectory = PENDULUM.trajectory(-6e-3, 14e-3, 5e-6);
    let recording = recording(&trajectory, &pendulum_instrument(), 3);
    let deviation = |rate| {
        let options = ExtractOptions {
            rate,
            ..pendulum_options()
        };
        let (impact, _) = extract_impact(&recording, &options).unwrap();
        let series = impact.rate.unwrap();
        let squares: f64 = series
            .times
            .iter()
            .zip(&series.values)
            .map(|(t, v)| (v - PENDULUM.at(*t).1).powi(2))
            .sum();
        ((squares / series.times.len() as f64).sqrt(), series)
    };
    // Central difference: multiples of half the quantum of 0.88 m/s.
    let (central, series) = deviation(RateMethod::Automatic);
    let quantum = count_length(360_000.0, 0.505) / (2.0 * 5e-6);
    let whole = |v: &f64| (v / quantum - (v / quantum).round()).abs() < 0.01;
    assert!(series.values.iter().all(whole));
    assert!(
        central > 0.2 && (series.noise / central - 1.0).abs() < 0.3,
        "{central} {}",
        series.noise
    );
    // Local cubics: two orders better, with the noise gain of the filter.
    let (smooth, _) = deviation(RateMethod::LocalPolynomial {
        order: 3,
        window: None,
    });
    assert!(smooth < 0.02, "{smooth}");
}

#[test]
fn recovers_a_cart_at_100_and_25_hertz() {
    let slow = |sensitivity, noise, sampling_rate, bits, range: f64| Sensor {
        persistence: 0.0,
        sensitivity,
        offset: 0.0,
        noise,
        sampling_rate,
        converter: Some(Converter {
            bits,
            low: -range,
            high: range,
        }),
    };
    let instrument = Instrument {
        // Force in steps of 0.03 N, compression negative, position in 0.17 mm.
        force: Some(Sensor {
            persistence: 0.0,
            offset: 0.05,
            ..slow(-1.0, 0.018, 100.0, 12, 62.0)
        }),
        displacement: Some(slow(1.0, 0.0, 25.0, 14, 1.4)),
        ..Instrument::default()
    };
    let mut masses = Vec::new();
    for seed in 0..40 {
        // The samples fall anywhere between touch and the next.
        let trajectory = CART.trajectory(-0.4 - 2.5e-4 * seed as f64, 0.8, 2.5e-4);
        let recording = recording(&trajectory, &instrument, seed);
        let (impact, findings) = extract_impact(&recording, &ExtractOptions::default()).unwrap();
        assert_eq!(codes(&findings), ["few-samples"], "{findings:?}");
        assert!(impact.onset.abs() < 0.01 && impact.displacement.is_some());
        let mass = mass_from_impulse(&impact.measured, Uncertain::default()).unwrap();
        assert!(mass.sd < 0.005, "{mass:?}");
        masses.push((mass.value - CART.mass, mass.sd));
    }
    // The stated uncertainty covers the error: RMS of z near 1, and no bias
    // beyond half a percent (trapezoids across the jump at touch).
    let bias = masses.iter().map(|m| m.0).sum::<f64>() / 40.0;
    assert!(bias.abs() < 0.005 * CART.mass, "{bias}");
    let rms = (masses.iter().map(|m| (m.0 / m.1).powi(2)).sum::<f64>() / 40.0).sqrt();
    assert!(rms > 0.5 && rms < 1.5, "{rms}");
}

#[test]
fn recovers_the_contact_without_a_force_channel() {
    let trajectory = PENDULUM.trajectory(-30e-3, 40e-3, 5e-6);
    let mut instrument = pendulum_instrument();
    instrument.force = None;
    let recording = recording(&trajectory, &instrument, 5);
    let (impact, findings) = extract_impact(&recording, &pendulum_options()).unwrap();
    assert_eq!(codes(&findings), ["window-from-motion"]);
    let Finding::WindowFromMotion { resolution, .. } = findings[0] else {
        panic!("{findings:?}")
    };
    let late = impact.end - PENDULUM.duration();
    assert!(resolution < 0.25 * PENDULUM.duration(), "{resolution}");
    assert!(
        impact.onset.abs() < resolution,
        "{} {resolution}",
        impact.onset
    );
    assert!(late.abs() < resolution, "{late} {resolution}");
    assert!((impact.measured.restitution.unwrap() - PENDULUM.restitution()).abs() < 0.01);
    assert!(impact.force.is_none() && impact.measured.impulse.is_none());
}

#[test]
fn recovers_from_counts_with_any_initial_phase() {
    let trajectory = PENDULUM.trajectory(-6e-3, 14e-3, 5e-6);
    let q = count_length(360_000.0, 0.505);
    for phase in [0.0, 0.5, 1.25, 3.999] {
        let mut instrument = pendulum_instrument();
        let encoder = instrument.encoder.unwrap();
        instrument.encoder = Some(EncoderSensor {
            line_error: 0.0,
            phase: InitialPhase::Given(phase),
            output: EncoderOutput::Counts,
            ..encoder
        });
        let counts = recording(&trajectory, &instrument, 1);
        instrument.encoder = Some(EncoderSensor {
            line_error: 0.0,
            phase: InitialPhase::Given(phase),
            noise: 0.2,
            ..encoder
        });
        let phases = recording(&trajectory, &instrument, 1);
        let (a, _) = extract_impact(&counts, &pendulum_options()).unwrap();
        let (b, _) = extract_impact(&phases, &pendulum_options()).unwrap();
        assert!(worst(&a, &PENDULUM) <= q && worst(&b, &PENDULUM) <= q);
        // Decoding is exact: both give the same counts, up to the rounding of
        // sines of angles from another zero.
        let (a, b) = (a.displacement.unwrap(), b.displacement.unwrap());
        assert!(
            a.values
                .iter()
                .zip(&b.values)
                .all(|(a, b)| (a - b).abs() < 1e-12)
        );
    }
}

#[test]
fn recovers_wrong_signs_and_says_so() {
    let trajectory = PENDULUM.trajectory(-6e-3, 14e-3, 5e-6);
    let instrument = pendulum_instrument();
    let straight = recording(&trajectory, &instrument, 9);
    let (expected, _) = extract_impact(&straight, &pendulum_options()).unwrap();
    // Phases swapped, force upside down.
    let mut wrong = straight.clone();
    let a = wrong.channels[0].samples.clone();
    wrong.channels[0].samples = std::mem::replace(&mut wrong.channels[1].samples, a);
    wrong.channels[2].samples.iter_mut().for_each(|f| *f = -*f);
    let (found, findings) = extract_impact(&wrong, &pendulum_options()).unwrap();
    assert_eq!(codes(&findings), ["reversed", "reversed"]);
    assert_eq!(
        findings[1].to_string(),
        "channel 'phase A and phase B' has the opposite sign of the convention (motion into the fruit and repulsive force are positive); its sign has been changed. Set its sign in campaign.toml, or swap the phases of an encoder"
    );
    assert_eq!(found, expected);
    let kept = ExtractOptions {
        orientation: Orientation::AsRecorded,
        ..pendulum_options()
    };
    let (found, findings) = extract_impact(&wrong, &kept).unwrap();
    assert_eq!(codes(&findings), ["reversed", "reversed"]);
    let negative = |series: &Option<Series>| {
        let series = series.as_ref().unwrap();
        let samples = series.times.iter().zip(&series.values);
        let within = samples.filter(|(t, _)| (found.onset..found.end).contains(*t));
        within.map(|(_, value)| value).sum::<f64>() < 0.0
    };
    assert!(negative(&found.force) && negative(&found.displacement));
}

#[test]
fn recovers_two_contacts_and_chooses() {
    let mut trajectory = PENDULUM.trajectory(-6e-3, 24e-3, 5e-6);
    // The same contact again, 40 ms later and half as fast.
    let second = Bounce {
        speed: 0.194,
        ..PENDULUM
    };
    let later = second.trajectory(-16e-3 + 5e-6, 14e-3, 5e-6);
    let shift = trajectory.displacement.last().unwrap() - later.displacement[0];
    trajectory
        .times
        .extend(later.times.iter().map(|t| t + 40e-3));
    trajectory
        .displacement
        .extend(later.displacement.iter().map(|x| x + shift));
    trajectory.rate.extend(&later.rate);
    trajectory.force.extend(&later.force);
    trajectory.acceleration.extend(&later.acceleration);
    let mut instrument = pendulum_instrument();
    instrument.force = instrument.force.map(|f| Sensor { noise: 0.1, ..f });
    let recording = recording(&trajectory, &instrument, 4);

    let (first, findings) = extract_impact(&recording, &pendulum_options()).unwrap();
    assert_eq!(codes(&findings), ["several-contacts"]);
    let text = findings[0].to_string();
    assert!(text.starts_with("2 contacts, beginning at "), "{text}");
    assert!(
        text.ends_with(
            " s is used. Give each a row of its own in impacts.csv, with from_s and to_s around it"
        ),
        "{text}"
    );
    assert!(first.onset.abs() < 1e-4);

    let mut options = pendulum_options();
    options.trigger.choice = ContactChoice::Within {
        from: 0.02,
        to: 0.06,
    };
    let (chosen, _) = extract_impact(&recording, &options).unwrap();
    assert!((chosen.onset - 40e-3).abs() < 1e-4);
    assert!((chosen.measured.impact_velocity.unwrap() - 0.194).abs() < 1e-3);
    // Samples outside of the range take no part; what the contact shows of itself stays.
    let middle = 0.5 * (chosen.onset + chosen.end);
    options.trigger.choice = ContactChoice::Within {
        from: 0.02,
        to: middle,
    };
    let (cut, _) = extract_impact(&recording, &options).unwrap();
    assert_eq!((cut.onset, cut.end), (chosen.onset, chosen.end));
    let (force, whole) = (cut.force.unwrap(), chosen.force.unwrap());
    assert!(force.times.last().unwrap() <= &middle);
    assert_eq!(force.values, whole.values[..force.values.len()]);
    options.trigger.choice = ContactChoice::Strongest;
    assert_eq!(
        extract_impact(&recording, &options).unwrap().0.onset,
        first.onset
    );
    options.trigger.choice = ContactChoice::Within { from: 0.1, to: 0.2 };
    let error = extract_impact(&recording, &options).unwrap_err();
    assert!(matches!(error, Error::NoContactInRange { .. }));
    assert!(
        error
            .to_string()
            .starts_with("no contact begins between 0.1 s and 0.2 s; the contacts found begin at ")
    );
}

#[test]
fn recovers_a_fixed_threshold_of_one_newton() {
    // No noise: the force of a damped spring jumps to c v = 2.6 N at touch, so
    // onset is the sample; it ends when the force falls through 1 N.
    let trajectory = PENDULUM.trajectory(-6e-3, 14e-3, 5e-6);
    let mut instrument = pendulum_instrument();
    instrument.force = instrument.force.map(|f| Sensor { noise: 0.0, ..f });
    let mut options = pendulum_options();
    options.trigger.threshold = Threshold::Fixed(1.0);
    let recording = recording(&trajectory, &instrument, 0);
    let (impact, findings) = extract_impact(&recording, &options).unwrap();
    assert_eq!(codes(&findings), ["noise-at-floor"]);
    let force = |t: f64| -PENDULUM.mass * PENDULUM.at(t).2;
    assert!(
        (force(impact.end) - 1.0).abs() < 0.02,
        "{}",
        force(impact.end)
    );
    assert!(impact.onset.abs() < 1e-4);
}

/// Half a sine of force, 6 ms long from 10 ms on, in 30 ms at 200 kHz, with
/// noise of 1 N: of each sample `persistence` times that of the one before, and a new part.
fn noisy_pulse(peak: f64, persistence: f64, seed: u64) -> (Vec<f64>, Vec<f64>) {
    let mut source = noise_source(seed, 0);
    let mut noise = 0.0;
    let times: Vec<f64> = (0..6000).map(|i| f64::from(i) * 5e-6).collect();
    let force = times.iter().map(|t| {
        let phase = (t - 0.010) / 0.006;
        let pulse = if (0.0..1.0).contains(&phase) {
            peak * (std::f64::consts::PI * phase).sin()
        } else {
            0.0
        };
        noise = persistence * noise + (1.0 - persistence.powi(2)).sqrt() * normal(&mut source);
        // Compression negative, with an offset: neither must matter.
        0.4 - pulse + noise
    });
    let force = force.collect();
    (times, force)
}

fn contacts_of(peak: f64, persistence: f64, seed: u64) -> Result<Contacts, Error> {
    let (times, values) = noisy_pulse(peak, persistence, seed);
    let signal = Signal {
        name: "force",
        unit: "N",
        times: &times,
        values: &values,
    };
    find_contacts(&signal, &TriggerOptions::default())
}

#[test]
fn recovers_weak_contacts_in_white_noise() {
    // Peak over noise of a sample; onset late by at most this part of the
    // contact, which is what `find_contacts` states.
    for (ratio, late) in [
        (2.0, 0.1),
        (3.0, 0.09),
        (5.0, 0.07),
        (10.0, 0.05),
        (20.0, 0.05),
    ] {
        for seed in 0..100 {
            let contacts = contacts_of(ratio, 0.0, seed).unwrap();
            assert_eq!(contacts.windows.len(), 1, "{ratio} {seed} {contacts:?}");
            assert!(contacts.reversed, "{ratio} {seed}");
            let window = contacts.windows[0];
            let onset = (window.onset - 0.010) / 0.006;
            let end = (0.016 - window.end) / 0.006;
            assert!(onset > -0.02 && onset < late, "{ratio} {seed} {onset}");
            assert!(end > -0.04 && end < late, "{ratio} {seed} {end}");
            let (zero, noise) = (contacts.offset - 0.4, contacts.deviation - 1.0);
            assert!(zero.abs() < 0.15 && noise.abs() < 0.1, "{zero} {noise}");
        }
    }
}

#[test]
fn recovers_whole_contacts_in_noise_that_persists() {
    // From sample to sample by 0.8: a mean over many samples has three times the noise that it
    // has of white noise, and differences of samples show 0.4 of it.
    for (ratio, late) in [(6.0, 0.2), (10.0, 0.08), (20.0, 0.08)] {
        for seed in 0..100 {
            let contacts = contacts_of(ratio, 0.8, seed).unwrap();
            assert_eq!(contacts.windows.len(), 1, "{ratio} {seed} {contacts:?}");
            let window = contacts.windows[0];
            let onset = (window.onset - 0.010) / 0.006;
            let end = (0.016 - window.end) / 0.006;
            assert!(onset > -0.05 && onset < late, "{ratio} {seed} {onset}");
            assert!(end > -0.05 && end < late, "{ratio} {seed} {end}");
        }
    }
}

#[test]
fn rejects_noise_as_a_contact() {
    // 100 recordings of 6000 samples: five standard deviations are not reached.
    for seed in 0..100 {
        let contacts = contacts_of(0.0, 0.0, seed);
        assert!(
            matches!(contacts, Err(Error::NoContact { .. })),
            "{seed} {contacts:?}"
        );
    }
}

#[test]
fn repeats_for_a_seed() {
    let trajectory = PENDULUM.trajectory(-6e-3, 14e-3, 5e-6);
    let instrument = pendulum_instrument();
    let one = record(&trajectory, &instrument, 11).unwrap();
    assert_eq!(one, record(&trajectory, &instrument, 11).unwrap());
    assert_ne!(one, record(&trajectory, &instrument, 12).unwrap());
    assert_eq!(
        one.iter().map(|c| c.unit).collect::<Vec<_>>(),
        ["V", "V", "V"]
    );
    assert_eq!(one[0].samples.len(), 4001);
    assert!(one[0].samples.iter().all(|&v| v == 0.0 || v == 5.0));
}
