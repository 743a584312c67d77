//! Real bounce trains: a cart that rebounds until it rests, read in place.
//!
//! The recording is somebody else's and is not part of this repository: the
//! folder comes from `WINDFALL_DATA` (default `../shared/data` beside the
//! workspace). Without it the test says what it leaves out.

#![allow(clippy::unwrap_used, clippy::print_stdout, dead_code)]

#[path = "../examples/bounce_train/analysis.rs"]
mod analysis;

use analysis::{LEAST_SPEED, MASS, Run, calibrate, evaluate, masses};
use std::path::PathBuf;
use windfall_signal::restitution::estimate::{Restitution, RestitutionMethod};

fn file() -> Option<PathBuf> {
    windfall_test_data::find("impact/foam_pads/bounce_train.csv")
}

fn by(run: &Run, method: RestitutionMethod, bounce: usize) -> Option<&Restitution> {
    let mut all = run.restitutions.iter();
    all.find(|r| r.method == method && r.bounce == bounce)
}

/// Peaks above 0.2 N counted by eye in a plot of each run; the last of Run 3 is
/// cut by the end of the recording.
const BOUNCES: [usize; 5] = [4, 3, 4, 6, 5];

#[test]
fn recovers_bounces_restitution_and_law_from_real_trains() {
    let Some(file) = file() else { return };
    let runs = evaluate(&file).unwrap();
    let counts: Vec<usize> = runs.iter().map(|r| r.train.bounces.len()).collect();
    assert_eq!(counts, BOUNCES);
    for run in &runs {
        check_times(run);
        check_friction(run);
        check_masses(run);
    }
    // A linear spring: half a period is the contact, whatever the speed.
    let all: Vec<&Run> = runs.iter().collect();
    let fit = calibrate(&all, "kelvin-voigt", LEAST_SPEED).unwrap();
    let k = fit.estimates[fit.names.iter().position(|n| n == "k").unwrap()].value;
    let half = std::f64::consts::PI * (MASS.value / k).sqrt();
    let first = &runs[0].train.bounces[0];
    let duration = first.end.value - first.onset.value;
    assert!(
        fit.converged && (duration / half - 1.0).abs() < 0.2,
        "{half}"
    );
    // Hertz, which it is not, is much worse.
    let hertz = calibrate(&all, "hertz", LEAST_SPEED).unwrap();
    assert!(
        hertz.misfit > 2.0 * fit.misfit,
        "{} {}",
        hertz.misfit,
        fit.misfit
    );
}

/// Bounces follow each other and become weaker.
fn check_times(run: &Run) {
    for pair in run.train.bounces.windows(2) {
        assert!(pair[1].onset.value > pair[0].end.value, "{}", run.name);
        assert!(pair[1].peak < pair[0].peak, "{}", run.name);
    }
}

/// Flights and heights take the acceleration for one and the same up and down;
/// it is not, and by √(a down/a up) of it they fall short of the velocities.
fn check_friction(run: &Run) {
    for motion in run.motions.iter().filter(|m| m.before.value > 0.2) {
        let by_velocity = by(run, RestitutionMethod::Velocities, motion.bounce).unwrap();
        let (Some(down), Some(up)) = (motion.acceleration_before, motion.acceleration_after) else {
            continue;
        };
        // The cart accelerates down the track, and slows down faster going up.
        assert!(down.value > 0.05 && up.value > down.value, "{}", run.name);
        if let Some(by_height) = by(run, RestitutionMethod::Heights, motion.bounce) {
            let expected = by_velocity.restitution.value * (down.value / up.value).sqrt();
            let ratio = by_height.restitution.value / expected;
            // The accelerations are those near the contact; they change along the way.
            assert!((ratio - 1.0).abs() < 0.25, "{} {ratio}", run.name);
            assert!(by_height.restitution.value < 0.85 * by_velocity.restitution.value);
        }
    }
}

/// Impulse and change of velocity give the mass that other recordings gave.
fn check_masses(run: &Run) {
    for (speed, mass) in masses(run).into_iter().filter(|(speed, _)| *speed > 0.2) {
        assert!(
            (mass / MASS.value - 1.0).abs() < 0.06,
            "{} {speed}: {mass}",
            run.name
        );
    }
}
