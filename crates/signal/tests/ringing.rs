//! Period and damping of a ringing plate from simulated drops: by a fit and by
//! the logarithmic decrement, with intervals that cover.

#![allow(clippy::unwrap_used, clippy::print_stdout)]

use crate::plate;

use plate::{PLATE, RECORD, Record, bounces, channel};
use windfall_signal::bounce::find::find_bounces;
use windfall_signal::bounce::train::{BounceOptions, BounceTrain};
use windfall_signal::ringing::peaks::{Decrement, FreeRinging, logarithmic_decrement};
use windfall_signal::ringing::plate::plate_dynamics;
use windfall_signal::uncertain::Uncertain;

fn train(height: f64, seed: u64) -> BounceTrain {
    let contacts = bounces(4.8e-3, height, 0.6, 3.7e-3, 1);
    let record = Record {
        to: 0.2,
        seed,
        ..RECORD
    };
    find_bounces(
        &channel(&contacts, Some(&PLATE), &record),
        &BounceOptions::default(),
    )
    .unwrap()
}

/// The classical way, on the stretch that the fit found free of contact.
fn classical(train: &BounceTrain) -> Decrement {
    let ringing = train.bounces[0].ringing.unwrap();
    let from = train.times.partition_point(|t| *t < ringing.from);
    let to = train.times.partition_point(|t| *t < ringing.to);
    let free = FreeRinging {
        times: &train.times[from..to],
        force: &train.force[from..to],
        noise: train.noise,
        level_sd: train.static_level.sd,
        period: ringing.period.value,
    };
    logarithmic_decrement(&free, None).unwrap()
}

#[test]
fn recovers_period_and_damping_and_their_intervals_cover() {
    let replicates = 300;
    let mut covered = [0; 4];
    let mut sums = [0.0; 4];
    for seed in 0..replicates {
        let train = train(0.3, seed);
        let fit = train.bounces[0].ringing.unwrap();
        let hand = classical(&train);
        let pairs = [
            (fit.period, PLATE.period()),
            (fit.damping_ratio, PLATE.ratio()),
            (hand.period, PLATE.period()),
            (hand.damping_ratio, PLATE.ratio()),
        ];
        for (i, (found, truth)) in pairs.into_iter().enumerate() {
            covered[i] += usize::from((found.value - truth).abs() <= 1.96 * found.sd);
            sums[i] += (found.value - truth) / found.sd;
        }
    }
    println!("covered {covered:?} of {replicates}, mean deviations {sums:?}");
    // 95 % of 300 is 285, with a standard deviation of 3.8.
    for covered in covered {
        assert!((270..=300).contains(&covered), "{covered}");
    }
    // No bias beyond half a standard uncertainty.
    for sum in sums {
        assert!((sum / replicates as f64).abs() < 0.5, "{sum}");
    }
}

#[test]
fn recovers_stiffness_and_damping_of_the_plate() {
    let train = train(0.5, 3);
    let ringing = train.ringing.unwrap();
    let mass = Uncertain {
        value: PLATE.mass,
        sd: 0.0,
    };
    let found = plate_dynamics(ringing.period, ringing.damping_ratio, mass);
    let off = found.stiffness.value - PLATE.stiffness;
    assert!(
        off.abs() < 4.0 * found.stiffness.sd && off.abs() < 1e-3 * PLATE.stiffness,
        "{found:?}"
    );
    let off = found.damping.value - PLATE.damping;
    assert!(
        off.abs() < 4.0 * found.damping.sd && off.abs() < 0.01 * PLATE.damping,
        "{found:?}"
    );
}

#[test]
fn recovers_the_classical_decrement_only_after_separation() {
    // The study's second and third peak lie behind a contact of 3.7 ms; one that
    // begins with the contact's own peak is off by far more than its uncertainty.
    let train = train(0.5, 1);
    let bounce = &train.bounces[0];
    let from = train
        .times
        .partition_point(|t| *t < bounce.peak_time - 1e-3);
    let free = FreeRinging {
        times: &train.times[from..],
        force: &train.force[from..],
        noise: train.noise,
        level_sd: train.static_level.sd,
        period: PLATE.period(),
    };
    let early = logarithmic_decrement(&free, Some(1)).unwrap();
    assert!(
        (early.damping_ratio.value / PLATE.ratio() - 1.0).abs() > 0.3,
        "{early:?}"
    );
    let late = classical(&train);
    assert!(
        (late.damping_ratio.value / PLATE.ratio() - 1.0).abs() < 0.01,
        "{late:?}"
    );
    assert!(bounce.ringing.unwrap().from > bounce.end.value - 1e-4);
}
