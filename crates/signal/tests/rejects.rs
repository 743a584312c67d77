//! Bad recordings, each with the message that it must give.

#![allow(clippy::unwrap_used)]

use std::f64::consts::PI;
use windfall_signal::kinematics::Encoder;
use windfall_signal::recording::{Channel, Quantity, Recording, Times};
use windfall_signal::trigger::Threshold;
use windfall_signal::{ExtractOptions, Finding, extract_impact};

const INTERVAL: f64 = 1e-3;

fn channel(quantity: Quantity, samples: Vec<f64>) -> Channel {
    Channel {
        name: format!("the {quantity}"),
        quantity,
        times: Times::Uniform {
            start: 0.0,
            interval: INTERVAL,
        },
        samples,
    }
}

/// A half sine of 20 N from 20 ms to 60 ms, between ±0.01 N.
fn force() -> Vec<f64> {
    (0..100)
        .map(|i| {
            let noise = 0.01 * f64::from(i % 3 - 1);
            let part = (f64::from(i) - 20.0) / 40.0;
            let contact = if (0.0..=1.0).contains(&part) {
                20.0 * (PI * part).sin()
            } else {
                0.0
            };
            noise + contact
        })
        .collect()
}

fn recording(channels: Vec<Channel>) -> Recording {
    Recording {
        name: "bad".to_owned(),
        channels,
        missing: Vec::new(),
        doubts: Vec::new(),
    }
}

fn error(channels: Vec<Channel>, options: &ExtractOptions) -> String {
    extract_impact(&recording(channels), options)
        .unwrap_err()
        .to_string()
}

fn default_error(channels: Vec<Channel>) -> String {
    error(channels, &ExtractOptions::default())
}

fn finding(channels: Vec<Channel>, options: &ExtractOptions, code: &str) -> String {
    let (_, findings) = extract_impact(&recording(channels), options).unwrap();
    let found: Vec<&Finding> = findings.iter().filter(|f| f.code() == code).collect();
    assert_eq!(found.len(), 1, "{findings:?}");
    found[0].to_string()
}

#[test]
fn rejects_a_recording_without_a_channel_to_find_a_contact_in() {
    assert_eq!(
        default_error(vec![]),
        "the recording has no channel for force, acceleration, displacement or displacement rate; found no channel at all. Map a column to it under [channels]"
    );
    assert_eq!(
        default_error(vec![channel(Quantity::PhaseA, vec![0.0, 5.0])]),
        "the recording has no channel for phase B of the encoder, beside phase A; found 'the phase A' (phase A). Map a column to it under [channels]"
    );
}

#[test]
fn rejects_two_channels_of_one_quantity() {
    let mut second = channel(Quantity::Force, force());
    second.name = "spare".to_owned();
    assert_eq!(
        default_error(vec![channel(Quantity::Force, force()), second]),
        "channels 'the force' and 'spare' both hold force; keep one of them"
    );
}

#[test]
fn rejects_nan() {
    let mut samples = force();
    samples[37] = f64::NAN;
    assert_eq!(
        default_error(vec![channel(Quantity::Force, samples)]),
        "channel 'the force': sample 37 at 0.037 s is NaN, not a finite number; leave the cell blank if there was no sample, or cut the recording"
    );
}

#[test]
fn rejects_time_that_runs_backwards_or_repeats() {
    let mut times: Vec<f64> = (0..100).map(|i| f64::from(i) * INTERVAL).collect();
    times[50] = 0.01;
    let listed = |times: &[f64]| {
        let mut channel = channel(Quantity::Force, force());
        channel.times = Times::Listed(times.to_vec());
        default_error(vec![channel])
    };
    assert_eq!(
        listed(&times),
        "channel 'the force': time does not increase at sample 50: 0.01 s after 0.049 s; split the recording there, or give a sampling rate in place of the time column"
    );
    times[50] = times[49];
    assert_eq!(
        listed(&times),
        "channel 'the force': time does not increase at sample 50: 0.049 s after 0.049 s; split the recording there, or give a sampling rate in place of the time column"
    );
    assert_eq!(
        listed(&times[..99]),
        "channel 'the force' has 100 samples but 99 sampling times; one time per sample is needed"
    );
}

#[test]
fn rejects_empty_channels_and_bad_intervals() {
    assert_eq!(
        default_error(vec![channel(Quantity::Force, vec![])]),
        "channel 'the force' has 0 samples; at least 1 are needed"
    );
    assert_eq!(
        default_error(vec![channel(Quantity::Force, vec![0.0, 1.0])]),
        "channel 'the force' has 2 samples; at least 3 are needed"
    );
    let mut still = channel(Quantity::Force, force());
    still.times = Times::Uniform {
        start: 0.0,
        interval: 0.0,
    };
    assert_eq!(
        default_error(vec![still]),
        "channel 'the force': the sampling interval is 0 s; a positive interval is needed"
    );
}

#[test]
fn rejects_a_recording_without_contact() {
    let quiet: Vec<f64> = (0..100).map(|i| 0.01 * f64::from(i % 3 - 1)).collect();
    let mut options = ExtractOptions::default();
    options.trigger.threshold = Threshold::Fixed(1.0);
    assert_eq!(
        error(vec![channel(Quantity::Force, quiet.clone())], &options),
        "no contact in channel 'the force': the largest value is 0.0100 N and the threshold 1.0000 N; lower the threshold (`threshold` in [contact]), or leave this recording out"
    );
    // Automatic: five standard deviations, of which the largest sample is 1.2.
    // All is baseline then: -0.01 against a mean of -0.0001.
    let message = default_error(vec![channel(Quantity::Force, quiet)]);
    assert!(
        message.starts_with("no contact in channel 'the force': the largest value is 0.0099 N"),
        "{message}"
    );
    // An instrument that was not connected.
    let message = default_error(vec![channel(Quantity::Force, vec![0.0; 100])]);
    assert!(
        message.starts_with("no contact in channel 'the force': the largest value is 0.0000 N"),
        "{message}"
    );
}

#[test]
fn rejects_an_encoder_without_geometry() {
    let counts = (0..100).map(f64::from).collect::<Vec<_>>();
    let channels = || {
        vec![
            channel(Quantity::Force, force()),
            channel(Quantity::EncoderCount, counts.clone()),
        ]
    };
    assert_eq!(
        default_error(channels()),
        "channel 'the encoder count' gives encoder count, and to make a displacement of it the encoder, for example counts_per_revolution = 360000 is needed"
    );
    let options = ExtractOptions {
        encoder: Some(Encoder::Rotary {
            counts_per_revolution: 360_000.0,
        }),
        ..ExtractOptions::default()
    };
    assert_eq!(
        error(channels(), &options),
        "channel 'the encoder count' gives encoder count, and to make a displacement of it the length of the arm, for example arm = \"0.505 m\" is needed"
    );
    let options = ExtractOptions {
        arm: Some(-0.505),
        ..options
    };
    assert_eq!(
        error(channels(), &options),
        "arm = -0.505: expected a positive number"
    );
}

#[test]
fn rejects_options_that_make_no_sense() {
    let channels = || vec![channel(Quantity::Force, force())];
    let mut options = ExtractOptions::default();
    options.trigger.threshold = Threshold::Fixed(0.0);
    assert_eq!(
        error(channels(), &options),
        "contact threshold = 0: expected a positive force"
    );
    let options = ExtractOptions {
        margin_before: -0.1,
        ..ExtractOptions::default()
    };
    assert_eq!(
        error(channels(), &options),
        "margin before contact = -0.1: expected a part of the contact's duration, 0 or more"
    );
}

#[test]
fn rejects_silence_about_illegal_transitions() {
    // 1000 transitions forward; every 200th sample skips a state.
    let mut count = 0;
    let states: Vec<u8> = (0..1000)
        .map(|i| {
            count += if i % 200 == 199 { 2 } else { 1 };
            [0, 1, 3, 2][count % 4]
        })
        .collect();
    let phase = |bit: u8| {
        states
            .iter()
            .map(|s| f64::from((s >> bit) & 1) * 5.0)
            .collect()
    };
    let mut a = channel(Quantity::PhaseA, phase(0));
    let mut b = channel(Quantity::PhaseB, phase(1));
    for phase in [&mut a, &mut b] {
        phase.times = Times::Uniform {
            start: 0.0,
            interval: 1e-4,
        };
    }
    let options = ExtractOptions {
        encoder: Some(Encoder::Linear { count_length: 1e-5 }),
        ..ExtractOptions::default()
    };
    let force = channel(Quantity::Force, force());
    assert_eq!(
        finding(vec![a, b, force], &options, "illegal-transitions"),
        "the phase A and the phase B: 5 of 999 transitions skip a state (0.50 %), the first at 0.0199 s; the displacement is wrong from there by 2 counts each. Raise the sampling rate (now 10000 Hz; it must exceed speed / count length) or check the wiring"
    );
}

#[test]
fn rejects_silence_about_clipping() {
    let clipped = force().iter().map(|f| f.min(15.0)).collect();
    assert_eq!(
        finding(
            vec![channel(Quantity::Force, clipped)],
            &ExtractOptions::default(),
            "clipped"
        ),
        // 20 sin(π i/40) > 15 for i from 11 to 29, with 0.01 N added at most.
        "channel 'the force' is clipped: 19 successive samples at 15 from 0.031 s to 0.049 s; peak, impulse and fitted parameters are biased. Enlarge the measuring range"
    );
}

#[test]
fn rejects_silence_about_irregular_sampling() {
    let mut force = channel(Quantity::Force, force());
    let jittered = |i: i32| f64::from(i) * INTERVAL + if i == 70 { 2e-4 } else { 0.0 };
    force.times = Times::Listed((0..100).map(jittered).collect());
    assert_eq!(
        finding(
            vec![force],
            &ExtractOptions::default(),
            "irregular-sampling"
        ),
        "channel 'the force' is sampled irregularly: the interval departs by up to 0.0002000 s from its median of 0.001000 s, most at 0.069 s; the recorded times are used as they are"
    );
}

#[test]
fn rejects_silence_about_truncated_contacts() {
    let options = ExtractOptions::default();
    let whole = force();
    let early = channel(Quantity::Force, whole[..45].to_vec());
    assert_eq!(
        finding(vec![early], &options, "contact-at-end"),
        "the recording ends in contact (0.044 s): separation and rebound are not seen. Record longer"
    );
    let late = channel(Quantity::Force, whole[30..].to_vec());
    let (impact, findings) = extract_impact(&recording(vec![late.clone()]), &options).unwrap();
    assert!(impact.measured.contact_duration.is_none() && impact.measured.impulse.is_none());
    // No zero can be had from samples in contact: the force is as recorded.
    assert_eq!(impact.force.unwrap().values[0], whole[30]);
    assert!(findings.iter().any(|f| f.code() == "short-baseline"));
    assert_eq!(
        finding(vec![late], &options, "contact-at-start"),
        "the recording begins in contact (0 s): onset and impact velocity are not seen. Record some samples before the trigger"
    );
}

#[test]
fn rejects_silence_about_an_offset() {
    let raised = force().iter().map(|f| f + 3.0).collect();
    let message = finding(
        vec![channel(Quantity::Force, raised)],
        &ExtractOptions::default(),
        "offset-removed",
    );
    // Sixteen samples -0.01, 0, 0.01, … from -0.01: mean -0.01/16, deviation 0.0081.
    assert_eq!(
        message,
        "channel 'the force' reads 2.9994 ± 0.0020 N before contact; this offset has been subtracted"
    );
}
