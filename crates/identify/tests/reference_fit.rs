//! The comparison data of the fit benchmark: optima found by another program
//! (Ceres with DOPRI5 at a tolerance of 1e-12) from twenty starts.
//!
//! The data lie in `windfall-test-data`.

#![allow(clippy::unwrap_used, clippy::print_stdout)]

use std::path::PathBuf;
use windfall_contact::law::EndRule;
use windfall_contact::laws::kuwabara_kono::KuwabaraKono;
use windfall_identify::fit::estimator::{
    Coordinate, Estimator, FreeParameter, Setting, Target, Values,
};
use windfall_identify::fit::model::Sampling;
use windfall_identify::rig::kind::{Pendulum, Rig};
use windfall_identify::rig::motion::Motion;
use windfall_identify::samples::SampleGroup;
use windfall_numerics::least_squares::{Options, Stop};
use windfall_numerics::ode::step::Tolerance;

/// Relative agreement with the reference optimum.
const TOLERANCE: f64 = 2e-6;
/// Agreement of the onset, which is zero but for noise; s. The reference's own
/// optimum is no sharper: at a hundredfold tighter tolerance it differs by 4e-11.
const ONSET_TOLERANCE: f64 = 2e-10;
const ARM: f64 = 0.505;

fn folder() -> Option<PathBuf> {
    windfall_test_data::find("fit")
}

fn numbers(path: PathBuf) -> Vec<Vec<f64>> {
    let text = std::fs::read_to_string(path).unwrap();
    let row = |line: &str| {
        let cells = line.split([',', ' ']).map(|cell| cell.trim().parse().ok());
        cells.collect::<Option<Vec<f64>>>()
    };
    text.lines().filter_map(row).collect()
}

fn samples(rows: &[Vec<f64>]) -> SampleGroup {
    let column = |i: usize| rows.iter().map(|row| row[i]).collect::<Vec<f64>>();
    let (x, v, force) = (column(1), column(2), column(3));
    let weight = |q: &[f64]| q.len() as f64 / q.iter().map(|a| a.abs()).sum::<f64>();
    SampleGroup::new(
        &column(0),
        [
            Some((&x, weight(&x))),
            Some((&v, weight(&v))),
            Some((&force, weight(&force))),
            None,
        ],
    )
}

fn parameter(target: Target, coordinate: Coordinate, lower: f64, upper: f64) -> FreeParameter {
    FreeParameter {
        prior: None,
        target,
        coordinate,
        lower,
        upper,
    }
}

/// k, c, velocity and onset from a start, the first `P` of them free.
fn fit<const P: usize>(group: &SampleGroup, start: [f64; 2]) -> [f64; 4] {
    let rig = Rig::Pendulum(Pendulum {
        inertia: 0.2 * ARM * ARM,
        arm: ARM,
        mass: 0.3,
        centre_of_mass: ARM,
        gravity: 9.81,
    });
    let motion = Motion::from(&rig);
    let setting = Setting {
        motion,
        end: EndRule::ForceZero,
        tolerance: Tolerance {
            relative: 1e-8,
            absolute: [1e-12 * ARM, 1e-10 * ARM],
        },
        tied_velocity: None,
        sampling: Sampling::Instantaneous,
    };
    let free = [
        parameter(Target::Law(0), Coordinate::Logarithm, 1e-3, 1e12),
        parameter(Target::Law(1), Coordinate::Logarithm, 1e-6, 1e9),
        parameter(Target::InitialVelocity, Coordinate::Logarithm, 0.01, 5.0),
        parameter(Target::Onset, Coordinate::Linear(1e-3), -1e-3, 1e-3),
    ];
    let base = Values {
        law: start,
        velocity: if P == 4 { 0.34 } else { 0.35 },
        inverse_mass: motion.inverse_mass,
        onset: if P == 4 { 0.02e-3 } else { 0.0 },
        offset: 0.0,
    };
    let law = KuwabaraKono {
        k: start[0],
        c: start[1],
    };
    let mut estimator =
        Estimator::<_, 2, 4, P>::new(law, setting, std::slice::from_ref(group), &free[..P], base);
    let minimum = estimator.minimise(&Options {
        largest_step: [2.0; P],
        ..Options::default()
    });
    assert_eq!(minimum.stop, Stop::Converged, "from {start:?}");
    let values = estimator.values(&minimum.parameters);
    [values.law[0], values.law[1], values.velocity, values.onset]
}

fn check(found: f64, expected: f64, scale: f64, what: &str) {
    let deviation = (found - expected).abs() / scale;
    assert!(
        deviation < TOLERANCE,
        "{what}: {found} for {expected}, off by {deviation:e}"
    );
}

#[test]
fn reference_optima_of_the_comparison_data_from_every_start() {
    let Some(folder) = folder() else { return };
    let starts = numbers(folder.join("starts.csv"));
    assert_eq!(starts.len(), 20);
    for name in ["data", "data100k"] {
        let group = samples(&numbers(folder.join(format!("{name}.csv"))));
        let reference = &numbers(folder.join(format!("{name}_ref.txt")))[0];
        for start in starts.iter().map(|s| [s[0], s[1]]).chain([[2e5, 300.0]]) {
            let two = fit::<2>(&group, start);
            let four = fit::<4>(&group, start);
            for i in 0..2 {
                check(
                    two[i],
                    reference[i],
                    reference[i],
                    &format!("{name} {start:?} two [{i}]"),
                );
            }
            for i in 0..3 {
                let expected = reference[2 + i];
                check(
                    four[i],
                    expected,
                    expected,
                    &format!("{name} {start:?} four [{i}]"),
                );
            }
            let onset = (four[3] - reference[5]).abs();
            assert!(
                onset < ONSET_TOLERANCE,
                "{name} {start:?} onset off by {onset:e} s"
            );
        }
    }
}
