//! Signals of the shapes that real recordings have: a zero that wanders, noise in pieces at the
//! end of a range, ringing, shaking, gravity.

use std::f64::consts::{PI, TAU};
use windfall_signal::impact::Impact;
use windfall_signal::noise::gaussian::{noise_source, normal};
use windfall_signal::recording::{Channel, Quantity, Recording, Times};
use windfall_signal::trigger::{Signal, Threshold, TriggerOptions, find_contacts};
use windfall_signal::{Error, ExtractOptions, Finding, extract_impact};

/// Extracts the impact of one channel.
fn extract(
    quantity: Quantity,
    interval: f64,
    samples: Vec<f64>,
) -> Result<(Impact, Vec<Finding>), Error> {
    let channel = Channel {
        name: "own".to_owned(),
        quantity,
        times: Times::Uniform {
            start: 0.0,
            interval,
        },
        samples,
    };
    let recording = Recording {
        name: "recording".to_owned(),
        channels: vec![channel],
        missing: Vec::new(),
        doubts: Vec::new(),
    };
    extract_impact(&recording, &ExtractOptions::default())
}

fn codes(findings: &[Finding]) -> Vec<&'static str> {
    findings.iter().map(Finding::code).collect()
}

fn samples(count: usize, interval: f64, value: impl FnMut(f64) -> f64) -> Vec<f64> {
    let times = (0..count).map(|i| interval * i as f64);
    times.map(value).collect()
}

/// Half a sine between two times.
fn half_sine(time: f64, from: f64, until: f64) -> f64 {
    let phase = (time - from) / (until - from);
    if (0.0..1.0).contains(&phase) {
        (PI * phase).sin()
    } else {
        0.0
    }
}

#[test]
fn recovers_a_contact_on_a_zero_that_wanders() {
    // 340 samples at 100 Hz about 1.1 N, wandering by 0.05 N and rising, before 4.5 N.
    for rise in [0.0, 0.02, 0.08, -0.08] {
        for phase in 0..6 {
            let mut source = noise_source(phase, 0);
            let force = samples(500, 0.01, |t| {
                let wander = 0.05 * (TAU * t / 2.3 + f64::from(phase as u32)).sin();
                let zero = 1.1 + rise * t + wander + 0.01 * normal(&mut source);
                zero + 4.5 * half_sine(t, 3.4, 3.65)
            });
            let (impact, findings) = extract(Quantity::Force, 0.01, force).unwrap();
            let said = codes(&findings);
            assert!(!said.contains(&"short-baseline"), "{rise} {phase} {said:?}");
            let peak = impact.measured.peak_force.unwrap();
            assert!((peak / 4.5 - 1.0).abs() < 0.04, "{rise} {phase} {peak}");
            assert!((impact.onset - 3.4).abs() < 0.03, "{}", impact.onset);
            let zero_sd = impact.force.unwrap().zero_sd;
            assert!(zero_sd > 0.0 && zero_sd < 0.2, "{zero_sd}");
        }
    }
}

#[test]
fn recovers_a_zero_that_never_rests_with_words() {
    // It rises all the way to the contact, by as much as the contact has.
    let force = samples(500, 0.01, |t| 2.0 * t + 4.5 * half_sine(t, 3.4, 3.65));
    let found = extract(Quantity::Force, 0.01, force);
    if let Ok((_, findings)) = found {
        let said = codes(&findings);
        let about = ["drift-removed", "local-baseline", "short-baseline"];
        assert!(said.iter().any(|code| about.contains(code)), "{said:?}");
    }
}

#[test]
fn recovers_whole_contacts_at_a_threshold_in_the_noise() {
    // 5 N in 1 N of noise whose samples agree (0.8), and a threshold of 1 N.
    let mut whole = 0;
    for seed in 0..60 {
        let mut source = noise_source(seed, 0);
        let mut noise = 0.0;
        let times: Vec<f64> = (0..7000).map(|i| 5e-6 * f64::from(i)).collect();
        let force = times.iter().map(|t| {
            noise = 0.8 * noise + 0.6 * normal(&mut source);
            5.5 * half_sine(*t, 0.012, 0.0175) + noise
        });
        let force: Vec<f64> = force.collect();
        let signal = Signal {
            name: "force",
            unit: "N",
            times: &times,
            values: &force,
        };
        let options = TriggerOptions {
            threshold: Threshold::Fixed(1.0),
            ..TriggerOptions::default()
        };
        let contacts = find_contacts(&signal, &options).unwrap();
        let first = contacts.windows[0];
        let is_whole = first.onset > 0.0115 && first.onset < 0.013 && first.end > 0.0165;
        whole += usize::from(is_whole);
        assert!(is_whole, "{seed}: {first:?} {}", contacts.smoothing);
    }
    assert_eq!(whole, 60);
}

#[test]
fn recovers_one_contact_from_a_shock_that_rings() {
    // 1 ms of shock, then 800 Hz that decay within 20 ms.
    let deceleration = samples(5000, 2e-5, |t| {
        let ring = 0.6 * (-(t - 0.01) / 0.02).exp() * (TAU * 800.0 * (t - 0.0105)).sin();
        let shock = 1000.0 * half_sine(t, 0.009, 0.01);
        -(shock + if t > 0.01 { 1000.0 * ring } else { 0.0 })
    });
    let (impact, findings) = extract(Quantity::Acceleration, 2e-5, deceleration).unwrap();
    let said = codes(&findings);
    assert!(said.contains(&"ringing"), "{said:?}");
    assert!(!said.contains(&"several-contacts"), "{said:?}");
    assert!((impact.onset - 0.009).abs() < 2e-4, "{}", impact.onset);
}

#[test]
fn recovers_bounces_as_several_contacts() {
    let force = samples(2000, 0.01, |t| {
        let bounces = [(5.0, 3.0), (11.0, 1.6), (14.0, 0.8), (15.5, 0.4)];
        let zero = if t > 5.2 { -0.05 } else { 0.03 };
        let sum: f64 = bounces
            .iter()
            .map(|(at, peak)| peak * half_sine(t, *at, at + 0.25))
            .sum();
        zero + sum
    });
    let (_, findings) = extract(Quantity::Force, 0.01, force).unwrap();
    let several = findings.iter().find(|own| own.code() == "several-contacts");
    assert!(several.unwrap().to_string().starts_with("4 contacts"));
    assert!(!codes(&findings).contains(&"ringing"));
}

#[test]
fn rejects_to_and_fro_as_an_impact_with_words() {
    let mut source = noise_source(5, 0);
    let pushed = samples(1200, 0.01, |t| {
        0.02 * normal(&mut source)
            + if t < 7.0 {
                0.0
            } else {
                (1.0 + 0.4 * (1.7 * t).sin()) * (TAU * 0.9 * (t - 4.0)).sin()
            }
    });
    let (_, findings) = extract(Quantity::Acceleration, 0.01, pushed).unwrap();
    let said = codes(&findings);
    assert!(
        said.contains(&"shaking") || said.contains(&"ringing"),
        "{said:?}"
    );
}

#[test]
fn rejects_gravity_as_a_contact() {
    // Let go after 0.2 s: the acceleration steps to 9.8 m/s² and stays.
    let mut source = noise_source(1, 0);
    let falling = samples(80, 0.01, |t| {
        (if t < 0.2 { 0.1 } else { 9.7 }) + 0.05 * normal(&mut source)
    });
    let error = extract(Quantity::Acceleration, 0.01, falling).unwrap_err();
    assert!(matches!(error, Error::OnlyGravity { .. }), "{error}");
    // Rest at 1 g, flight, and an impact: rest is no contact.
    let mut source = noise_source(2, 0);
    let dropped = samples(4000, 2.5e-4, |t| {
        let rest = if t < 0.4 { 9.81 } else { 0.0 };
        rest + 300.0 * half_sine(t, 0.7, 0.72) + 0.05 * normal(&mut source)
    });
    let (impact, findings) = extract(Quantity::Acceleration, 2.5e-4, dropped).unwrap();
    assert!((impact.onset - 0.7).abs() < 3e-3, "{}", impact.onset);
    assert!(!codes(&findings).contains(&"several-contacts"));
}

#[test]
fn rejects_an_acceleration_at_the_end_of_its_range() {
    let mut source = noise_source(3, 0);
    let clipped = samples(2000, 1e-4, |t| {
        let clean = 900.0 * half_sine(t, 0.05, 0.07) + 5.0 * normal(&mut source);
        -clean.clamp(-546.4, 546.4)
    });
    let (_, findings) = extract(Quantity::Acceleration, 1e-4, clipped).unwrap();
    assert!(
        codes(&findings).contains(&"clipped"),
        "{:?}",
        codes(&findings)
    );
}

#[test]
fn rejects_contacts_that_are_too_short_with_words() {
    let short = samples(
        200,
        1e-3,
        |t| if (t - 0.1).abs() < 1e-4 { 50.0 } else { 0.0 },
    );
    let error = extract(Quantity::Force, 1e-3, short)
        .unwrap_err()
        .to_string();
    assert!(error.contains("three successive samples"), "{error}");
}

/// Equal contacts of 4 ms with pauses, in a recording that has little else: the first ones are
/// contacts too, and no noise of the last.
#[test]
fn recovers_equal_contacts_that_fill_the_recording() {
    for count in [2, 3, 4, 6] {
        for (pause, lead) in [(0.5e-3, 1e-3), (1e-3, 1e-3), (3e-3, 1e-3), (3e-3, 4e-3)] {
            for (noise, seed) in [(0.02, 1), (0.3, 2), (0.3, 3)] {
                let mut source = noise_source(seed, 0);
                let period = 4e-3 + pause;
                let samples = ((2.0 * lead + f64::from(count) * period) / 1e-5) as usize;
                let times: Vec<f64> = (0..samples).map(|i| i as f64 * 1e-5).collect();
                let values = times.iter().map(|t| {
                    let since = (t - lead) % period;
                    let inside = *t > lead && *t < lead + f64::from(count) * period;
                    let pushed = match inside && since < 4e-3 {
                        true => 20.0 * (PI * since / 4e-3).sin().powf(1.5),
                        false => 0.0,
                    };
                    pushed + noise * normal(&mut source)
                });
                let values: Vec<f64> = values.collect();
                let signal = Signal {
                    name: "force",
                    unit: "N",
                    times: &times,
                    values: &values,
                };
                let found = find_contacts(&signal, &TriggerOptions::default());
                let case = format!("{count} contacts, {pause} s, {lead} s, {noise} N");
                let windows = found.map(|own| own.windows.len());
                assert_eq!(windows.ok(), Some(count as usize), "{case}");
            }
        }
    }
}
