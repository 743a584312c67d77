//! Restitution of simulated drops by every estimator, against the restitution
//! that the drops were made with.

#![allow(clippy::unwrap_used, clippy::print_stdout)]

use crate::plate;

use plate::{PLATE, Plate, RECORD, Record, bounces, channel};
use windfall_signal::bounce::find::find_bounces;
use windfall_signal::bounce::train::{BounceOptions, BounceTrain};
use windfall_signal::restitution::check::check_restitutions;
use windfall_signal::restitution::estimate::{
    DropConditions, Restitution, RestitutionMethod, restitution_from_impulse, restitution_from_time,
};
use windfall_signal::restitution::finding::RestitutionFinding;
use windfall_signal::uncertain::Uncertain;

const E: f64 = 0.6;

fn drop(seed: u64, plate: Option<&Plate>, scale: f64, count: usize) -> BounceTrain {
    let contacts: Vec<_> = bounces(4.8e-3, 0.5, E, 3.7e-3, count)
        .into_iter()
        .map(|c| plate::Contact {
            peak: scale * c.peak,
            ..c
        })
        .collect();
    let record = Record { seed, ..RECORD };
    find_bounces(
        &channel(&contacts, plate, &record),
        &BounceOptions::default(),
    )
    .unwrap()
}

fn conditions() -> DropConditions {
    DropConditions {
        height: Some(Uncertain {
            value: 0.5,
            sd: 1e-3,
        }),
        mass: Some(Uncertain {
            value: 4.8e-3,
            sd: 2e-5,
        }),
        ..DropConditions::default()
    }
}

fn all(train: &BounceTrain, conditions: &DropConditions) -> Vec<Restitution> {
    let mut found = restitution_from_time(&train.bounces, conditions);
    found.extend(restitution_from_impulse(&train.bounces, conditions));
    found
}

fn codes(findings: &[RestitutionFinding]) -> Vec<&'static str> {
    findings.iter().map(|f| f.code()).collect()
}

#[test]
fn recovers_restitution_by_time_and_impulse() {
    for plate in [None, Some(&PLATE)] {
        for seed in 1..=10 {
            let train = drop(seed, plate, 1.0, 5);
            let found = all(&train, &conditions());
            // Of 5 bounces, 4 have a flight after them; all have an impulse.
            assert_eq!(found.len(), 9);
            for one in &found {
                let off = one.restitution.value - E;
                assert!(off.abs() < 4.0 * one.restitution.sd, "{one:?}");
                assert!(one.restitution.sd < 0.06, "{one:?}");
                let speed = (2.0 * 9.80665 * 0.5_f64).sqrt() * E.powi(one.bounce as i32);
                let off = one.impact_speed.value - speed;
                // The height is known to 1 mm: its truth is exact here.
                assert!(off.abs() < 4.0 * one.impact_speed.sd, "{one:?}");
            }
            assert_eq!(found[0].method, RestitutionMethod::DropHeight);
            assert_eq!(found[1].method, RestitutionMethod::Flights);
            let findings = check_restitutions(&train.bounces, &conditions(), &found);
            assert!(findings.is_empty(), "{:?}", codes(&findings));
        }
    }
}

#[test]
fn recovers_the_scale_of_a_wrong_volts_per_newton() {
    // Forces 20 % too small: times 1.25 they would fit.
    let train = drop(1, Some(&PLATE), 0.8, 4);
    let found = all(&train, &conditions());
    let findings = check_restitutions(&train.bounces, &conditions(), &found);
    assert_eq!(codes(&findings), ["force_scale"]);
    let RestitutionFinding::ForceScale { factor, impacts } = &findings[0] else {
        panic!("{findings:?}")
    };
    assert_eq!(*impacts, 3);
    assert!(
        (factor.value - 1.25).abs() < 4.0 * factor.sd && factor.sd < 0.02,
        "{factor:?}"
    );
    let message = findings[0].to_string();
    assert!(message.contains("volts per newton"), "{message}");
}

#[test]
fn rejects_one_bounce_for_time_and_bounds_the_scale() {
    let train = drop(1, Some(&PLATE), 1.0, 1);
    let found = all(&train, &conditions());
    assert_eq!(found.len(), 1);
    assert_eq!(found[0].method, RestitutionMethod::Impulse);
    let findings = check_restitutions(&train.bounces, &conditions(), &found);
    assert_eq!(codes(&findings), ["no_second_impact"]);
    // Half the force: e would be −0.2, and the factor lies between 1/0.8 and 2/0.8.
    let train = drop(1, Some(&PLATE), 0.5, 1);
    let found = all(&train, &conditions());
    let findings = check_restitutions(&train.bounces, &conditions(), &found);
    assert_eq!(codes(&findings), ["no_second_impact", "force_scale"]);
    let RestitutionFinding::ForceScaleRange { least, most, .. } = findings[1] else {
        panic!("{findings:?}")
    };
    assert!(
        (least - 1.25).abs() < 0.02 && (most - 2.5).abs() < 0.04,
        "{least} {most}"
    );
}

#[test]
fn rejects_a_wrong_height_and_a_slanted_rebound() {
    // A drop from 0.5 m written down as 0.1 m: e₁ = 0.6 √5 = 1.34.
    let train = drop(1, Some(&PLATE), 1.0, 4);
    let wrong = DropConditions {
        height: Some(Uncertain {
            value: 0.1,
            sd: 1e-3,
        }),
        mass: None,
        ..conditions()
    };
    let found = all(&train, &wrong);
    let findings = check_restitutions(&train.bounces, &wrong, &found);
    assert!(
        codes(&findings).contains(&"restitution_out_of_range"),
        "{findings:?}"
    );
    assert!(codes(&findings).contains(&"weak_rebound"), "{findings:?}");
    // Without height and mass, time alone gives what it can.
    let nothing = DropConditions::default();
    let found = all(&train, &nothing);
    assert_eq!(found.len(), 2);
    assert!(found.iter().all(|r| r.method == RestitutionMethod::Flights));
}
