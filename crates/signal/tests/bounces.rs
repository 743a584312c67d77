//! Bounces of simulated drop rigs: an independent plate, exact in time.

#![allow(clippy::unwrap_used, clippy::print_stdout)]

use crate::plate;

use plate::{Contact, PLATE, Plate, RECORD, Record, bounces, channel};
use windfall_signal::bounce::find::find_bounces;
use windfall_signal::bounce::train::{BounceOptions, BounceTrain, PlateRinging, StaticLevel};
use windfall_signal::recording::{Channel, Times};

/// A fruit of 4.8 g from 0.5 m with restitution 0.6, contacts of 3.7 ms.
fn fruit(count: usize) -> Vec<Contact> {
    bounces(4.8e-3, 0.5, 0.6, 3.7e-3, count)
}

fn find(contacts: &[Contact], plate: Option<&Plate>, record: &Record) -> BounceTrain {
    find_bounces(&channel(contacts, plate, record), &BounceOptions::default()).unwrap()
}

fn codes(train: &BounceTrain) -> Vec<&'static str> {
    train.findings.iter().map(|f| f.code()).collect()
}

/// Every contact is found, once, where it is, with its impulse.
fn check(train: &BounceTrain, contacts: &[Contact]) {
    assert_eq!(train.bounces.len(), contacts.len(), "{:?}", codes(train));
    for (bounce, contact) in train.bounces.iter().zip(contacts) {
        let late = bounce.onset.value - contact.onset;
        let allowed = 4.0 * bounce.onset.sd + 2.5 * bounce.onset_shape;
        assert!(late.abs() < allowed, "onset {late} {bounce:?}");
        assert!(
            bounce.onset.sd < 1e-4 && bounce.onset_shape < 2e-4,
            "{bounce:?}"
        );
        let end = bounce.end.value - contact.onset - contact.duration;
        assert!(end.abs() < 4.0 * bounce.end.sd, "end {end} {bounce:?}");
        let impulse = bounce.impulse.value - contact.impulse();
        assert!(
            impulse.abs() < 4.0 * bounce.impulse.sd,
            "J {impulse} {bounce:?}"
        );
        assert!(
            bounce.impulse.sd < 0.01 * contact.impulse() + 5e-5,
            "{bounce:?}"
        );
    }
    for (interval, pair) in train.intervals.iter().zip(contacts.windows(2)) {
        let off = interval.value - (pair[1].onset - pair[0].onset);
        assert!(
            off.abs() < 4.0 * interval.sd && interval.sd < 2e-4,
            "{off} {interval:?}"
        );
    }
}

#[test]
fn recovers_bounces_on_a_ringing_plate() {
    for seed in 1..=10 {
        let record = Record { seed, ..RECORD };
        let contacts = fruit(6);
        let train = find(&contacts, Some(&PLATE), &record);
        check(&train, &contacts);
        assert!(train.findings.is_empty(), "{:?}", codes(&train));
        // The support overshoots what the contact does by half and more.
        assert!(train.bounces[0].first_peak > 1.5 * contacts[0].peak);
        let ringing = train.ringing.unwrap();
        assert!((ringing.period.value / PLATE.period() - 1.0).abs() < 1e-3);
        assert!((ringing.damping_ratio.value / PLATE.ratio() - 1.0).abs() < 0.01);
    }
}

#[test]
fn recovers_bounces_on_a_rigid_support() {
    let contacts = fruit(6);
    let train = find(&contacts, None, &RECORD);
    check(&train, &contacts);
    assert_eq!(train.ringing, None);
    assert!(train.findings.is_empty(), "{:?}", codes(&train));
    for (bounce, contact) in train.bounces.iter().zip(&contacts) {
        let off = bounce.first_peak - contact.peak;
        assert!(off.abs() < 0.02, "{off}");
    }
}

/// Plates and contacts of other proportions: contact shorter and longer than
/// the period, little damping and much.
#[test]
fn recovers_bounces_of_other_proportions() {
    for period in [1.5e-3, 3.5e-3, 8e-3] {
        for ratio in [0.02_f64, 0.073, 0.2] {
            for duration in [2e-3, 3.7e-3, 8e-3] {
                let natural = 2.0 * std::f64::consts::PI / period / (1.0 - ratio * ratio).sqrt();
                let plate = Plate {
                    mass: 0.2,
                    stiffness: 0.2 * natural * natural,
                    damping: 2.0 * ratio * 0.2 * natural,
                };
                let contacts = bounces(4.8e-3, 0.3, 0.6, duration, 3);
                let train = find(&contacts, Some(&plate), &RECORD);
                assert_eq!(train.bounces.len(), 3, "{period} {ratio} {duration}");
                for (bounce, contact) in train.bounces.iter().zip(&contacts) {
                    let off = bounce.impulse.value - contact.impulse();
                    assert!(
                        off.abs() < 4.0 * bounce.impulse.sd
                            && bounce.impulse.sd < 0.02 * contact.impulse(),
                        "{period} {ratio} {duration}: {off} {bounce:?}"
                    );
                    let late = bounce.onset.value - contact.onset;
                    let allowed = 4.0 * bounce.onset.sd + 2.5 * bounce.onset_shape;
                    assert!(
                        late.abs() < allowed,
                        "{period} {ratio} {duration}: {late} {bounce:?}"
                    );
                }
            }
        }
    }
}

#[test]
fn recovers_a_bounce_that_begins_in_the_ringing() {
    // 12 ms after the first touch the plate still rings with a third of its
    // amplitude; the second impact is a fifth of the first.
    let contacts = [
        Contact {
            onset: 0.05,
            peak: 10.0,
            duration: 3.7e-3,
        },
        Contact {
            onset: 0.062,
            peak: 2.0,
            duration: 3.7e-3,
        },
        Contact {
            onset: 0.3,
            peak: 1.0,
            duration: 3.7e-3,
        },
    ];
    let train = find(&contacts, Some(&PLATE), &RECORD);
    assert_eq!(train.bounces.len(), 3);
    assert!(
        codes(&train).contains(&"still_ringing"),
        "{:?}",
        codes(&train)
    );
    for (bounce, contact) in train.bounces.iter().zip(&contacts) {
        assert!(
            (bounce.onset.value - contact.onset).abs() < 3e-4,
            "{bounce:?}"
        );
        assert!(
            (bounce.impulse.value / contact.impulse() - 1.0).abs() < 0.02,
            "{bounce:?}"
        );
    }
    let message = train
        .findings
        .iter()
        .find(|f| f.code() == "still_ringing")
        .unwrap()
        .to_string();
    assert!(message.contains("bounce 2 begins at 0.06"), "{message}");
}

#[test]
fn recovers_from_volts_of_twelve_bits_and_a_reversed_wire() {
    // 12 bits over 5 V at 10 N/V are 12 mN.
    let record = Record {
        quantum: 50.0 / 4096.0,
        noise: 0.005,
        sign: -1.0,
        ..RECORD
    };
    let contacts = fruit(5);
    let train = find(&contacts, Some(&PLATE), &record);
    assert_eq!(codes(&train), ["force_reversed"]);
    check(&train, &contacts);
}

#[test]
fn recovers_from_a_drifting_level() {
    let record = Record {
        drift: 0.5,
        ..RECORD
    };
    let contacts = fruit(5);
    let train = find(&contacts, Some(&PLATE), &record);
    assert_eq!(train.bounces.len(), 5);
    assert_eq!(codes(&train), ["static_level_drifts"]);
    let message = train.findings[0].to_string();
    assert!(message.contains("static_level = \"follow\""), "{message}");
    // Followed, the drift matters no more.
    let options = BounceOptions {
        static_level: StaticLevel::Follow,
        ..BounceOptions::default()
    };
    let train = find_bounces(&channel(&contacts, Some(&PLATE), &record), &options).unwrap();
    assert!(train.findings.is_empty(), "{:?}", codes(&train));
    check(&train, &contacts);
}

#[test]
fn rejects_a_clipped_peak() {
    let record = Record {
        limit: 1.96 + 12.0,
        ..RECORD
    };
    let train = find(&fruit(4), Some(&PLATE), &record);
    assert_eq!(train.bounces.len(), 4);
    assert!(
        codes(&train).contains(&"bounce_clipped"),
        "{:?}",
        codes(&train)
    );
    assert!(train.bounces[0].clipped && !train.bounces[1].clipped);
    let message = train
        .findings
        .iter()
        .find(|f| f.code() == "bounce_clipped")
        .unwrap()
        .to_string();
    assert!(
        message.starts_with("bounce 1 is clipped") && message.contains("range"),
        "{message}"
    );
}

#[test]
fn rejects_the_swing_of_a_mount_as_a_bounce() {
    // Two cycles of an overshoot, too few to be known as ringing.
    let mut contacts = fruit(2);
    for (delay, peak) in [(8e-3, 0.15), (13e-3, 0.07)] {
        contacts.push(Contact {
            onset: contacts[0].onset + delay,
            peak,
            duration: 2e-3,
        });
    }
    let train = find(&contacts, None, &RECORD);
    assert_eq!(train.bounces.len(), 2);
    let all = BounceOptions {
        smallest_impulse: Some(0.0),
        ..BounceOptions::default()
    };
    let train = find_bounces(&channel(&contacts, None, &RECORD), &all).unwrap();
    assert_eq!(train.bounces.len(), 4);
}

#[test]
fn rejects_one_impact_as_not_valid() {
    let train = find(&fruit(1), Some(&PLATE), &RECORD);
    assert_eq!((train.bounces.len(), codes(&train)), (1, vec!["not_valid"]));
    assert!(train.findings[0].to_string().contains("two are needed"));
}

#[test]
fn rejects_a_recording_without_a_bounce() {
    for seed in 1..=20 {
        let train = find(&[], Some(&PLATE), &Record { seed, ..RECORD });
        assert_eq!((train.bounces.len(), codes(&train)), (0, vec!["no_bounce"]));
    }
}

#[test]
fn rejects_sampling_too_slow_for_the_contact() {
    let record = Record {
        rate: 1_500.0,
        ..RECORD
    };
    let train = find(&fruit(2), None, &record);
    assert_eq!(train.bounces.len(), 2);
    assert!(
        codes(&train).contains(&"slow_sampling"),
        "{:?}",
        codes(&train)
    );
    let message = train
        .findings
        .iter()
        .find(|f| f.code() == "slow_sampling")
        .unwrap()
        .to_string();
    assert!(message.contains("samples in contact"), "{message}");
}

#[test]
fn rejects_a_recording_that_begins_in_contact_or_ends_in_one() {
    let contacts = fruit(3);
    let begins = Record {
        from: contacts[0].onset + 1e-3,
        ..RECORD
    };
    let train = find(&contacts, Some(&PLATE), &begins);
    assert!(
        codes(&train).contains(&"begins_in_contact"),
        "{:?}",
        codes(&train)
    );
    assert_eq!(train.bounces.len(), 3);
    assert!(!train.bounces[0].complete);
    let ends = Record {
        to: contacts[2].onset + 2e-3,
        ..RECORD
    };
    let train = find(&contacts, Some(&PLATE), &ends);
    assert!(
        codes(&train).contains(&"ends_in_contact"),
        "{:?}",
        codes(&train)
    );
    let rings = Record {
        to: contacts[2].onset + 15e-3,
        ..RECORD
    };
    let train = find(&contacts, Some(&PLATE), &rings);
    assert_eq!(codes(&train), ["ends_in_ringing"]);
    // … and the impulse of the last is right all the same.
    let last = &train.bounces[2];
    assert!(
        (last.impulse.value / contacts[2].impulse() - 1.0).abs() < 0.02,
        "{last:?}"
    );
}

#[test]
fn rejects_options_and_channels_that_make_no_sense() {
    let contacts = fruit(2);
    let good = channel(&contacts, None, &RECORD);
    let with = |options: BounceOptions| find_bounces(&good, &options).unwrap_err().to_string();
    let message = with(BounceOptions {
        release: 2.0,
        ..BounceOptions::default()
    });
    assert!(message.contains("part of the threshold"), "{message}");
    let plate = PlateRinging::Known {
        period: -1.0,
        damping_ratio: 0.1,
    };
    let message = with(BounceOptions {
        plate,
        ..BounceOptions::default()
    });
    assert!(message.contains("positive period"), "{message}");
    let short = Channel {
        samples: vec![0.0; 5],
        ..good.clone()
    };
    let message = find_bounces(&short, &BounceOptions::default())
        .unwrap_err()
        .to_string();
    assert!(message.contains("5 samples"), "{message}");
    let mut nan = good;
    nan.samples[70] = f64::NAN;
    assert!(find_bounces(&nan, &BounceOptions::default()).is_err());
}

#[test]
fn closed_form_bounces_without_noise() {
    let record = Record {
        noise: 0.0,
        ..RECORD
    };
    let contacts = fruit(6);
    let train = find(&contacts, Some(&PLATE), &record);
    assert_eq!(train.bounces.len(), 6, "{:?}", codes(&train));
    for (bounce, contact) in train.bounces.iter().zip(&contacts) {
        let off = bounce.impulse.value / contact.impulse() - 1.0;
        assert!(off.abs() < 2e-3, "{off}");
    }
    let ringing = train.ringing.unwrap();
    assert!(
        (ringing.period.value / PLATE.period() - 1.0).abs() < 1e-5,
        "{ringing:?}"
    );
    assert!(
        (ringing.damping_ratio.value / PLATE.ratio() - 1.0).abs() < 1e-3,
        "{ringing:?}"
    );
}

#[test]
fn repeats_for_listed_times() {
    let contacts = fruit(4);
    let uniform = channel(&contacts, Some(&PLATE), &RECORD);
    let listed = Channel {
        times: Times::Listed(plate::times(&RECORD)),
        ..uniform.clone()
    };
    let options = BounceOptions::default();
    let (a, b) = (
        find_bounces(&uniform, &options).unwrap(),
        find_bounces(&listed, &options).unwrap(),
    );
    assert_eq!(a.bounces.len(), b.bounces.len());
    for (a, b) in a.bounces.iter().zip(&b.bounces) {
        assert!((a.onset.value - b.onset.value).abs() < 1e-9);
    }
}
