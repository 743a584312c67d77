//! Faults of a bench, found from what the fits of all its impacts leave.

use crate::rubber::rig;
use windfall_contact::expression::parse_law;
use windfall_contact::law::EndRule;
use windfall_identify::bench::cause::{Cause, CauseFound, likeliest_causes};
use windfall_identify::bench::residuals::{BenchResiduals, bench_residuals};
use windfall_identify::fit::problem::{FitOptions, LawProblem};
use windfall_identify::fit::result::{Fit, fit_impact};
use windfall_identify::rig::simulate::trajectory;
use windfall_identify::samples::Quantity;
use windfall_signal::extract::extract_impact;
use windfall_signal::impact::Impact;
use windfall_signal::instrument::{calibrated, pendulum_instrument, record};
use windfall_signal::kinematics::Encoder;
use windfall_signal::options::ExtractOptions;
use windfall_signal::response::{Bending, Response, Swing};
use windfall_signal::trigger::{Threshold, TriggerOptions};

const INTERVAL: f64 = 5e-6;

fn parameters(index: u64) -> (f64, f64, f64) {
    let part = |step: f64| (index as f64 * step).fract();
    (
        7.5e5 * (0.8 + 0.4 * part(0.618)),
        1500.0 * (0.7 + 0.6 * part(0.414)),
        0.2 + 0.3 * part(0.732),
    )
}

/// An impact as instruments with a fault record it.
fn impact(index: u64, response: &Response, delay: f64) -> Impact {
    impact_of_noise(index, (response, delay), 1.0)
}

/// The same with another noise of the force; N.
fn impact_of_noise(index: u64, (response, delay): (&Response, f64), noise: f64) -> Impact {
    let (k, c, velocity) = parameters(index);
    let law = parse_law(&format!("kuwabara-kono(k={k}, c={c})")).unwrap();
    let law = law.complete().unwrap();
    let before = 800;
    let times = |late: f64| -> Vec<f64> {
        let at = |i: i32| f64::from(i - before) * INTERVAL - late;
        (0..3000).map(at).collect()
    };
    let free = EndRule::ForceZero;
    let mut motion = trajectory(&law, &rig(), velocity, &times(0.0), free).unwrap();
    motion.force = trajectory(&law, &rig(), velocity, &times(delay), free)
        .unwrap()
        .force;
    let errors = [
        response.force_error(INTERVAL, &motion.force),
        response.displacement_error(INTERVAL, &motion.force),
    ];
    for i in 0..motion.force.len() {
        motion.force[i] += errors[0][i];
        motion.displacement[i] += errors[1][i];
    }
    let mut instrument = pendulum_instrument();
    if let Some(force) = &mut instrument.force {
        force.noise = noise;
    }
    let raw = record(&motion, &instrument, index).unwrap();
    let options = ExtractOptions {
        trigger: TriggerOptions {
            threshold: Threshold::Fixed(1.0),
            ..TriggerOptions::default()
        },
        encoder: Some(Encoder::Rotary {
            counts_per_revolution: 360_000.0,
        }),
        arm: Some(0.505),
        effective_mass: Some(rig().effective_mass()),
        ..ExtractOptions::default()
    };
    let recording = calibrated("simulated", &raw, &instrument);
    extract_impact(&recording, &options).unwrap().0
}

fn problem() -> LawProblem {
    LawProblem::from_expression(&parse_law("kuwabara-kono").unwrap())
}

fn residuals(impacts: &[Impact], options: &FitOptions) -> Vec<BenchResiduals> {
    let of = |impact: &Impact| bench_residuals(impact, &rig(), &problem(), options).unwrap();
    impacts.iter().map(of).collect()
}

fn impacts(response: &Response, delay: f64) -> Vec<Impact> {
    (0..16).map(|i| impact(i, response, delay)).collect()
}

fn causes() -> Vec<Cause> {
    let none = Cause::default();
    vec![
        none,
        Cause { gain: true, ..none },
        Cause {
            delay: true,
            ..none
        },
        Cause {
            gain: true,
            delay: true,
            ..none
        },
        Cause { pole: true, ..none },
        Cause {
            sensor: true,
            ..none
        },
        Cause { arm: true, ..none },
    ]
}

fn found(response: &Response, delay: f64) -> Vec<CauseFound> {
    let all = residuals(&impacts(response, delay), &FitOptions::default());
    likeliest_causes(&all, &causes())
}

#[test]
fn recovers_a_sensor_that_swings() {
    let sensor = Some(Swing {
        frequency: 2e3,
        damping: 0.05,
    });
    let all = found(
        &Response {
            sensor,
            ..Response::default()
        },
        0.0,
    );
    let best = &all[0];
    assert!(best.cause.sensor, "{best:?}");
    assert!((best.frequency.value - 2e3).abs() < 4.0 * best.frequency.sd);
    assert!((best.damping.value - 0.05).abs() < 4.0 * best.damping.sd);
    assert!(all[1].aic - best.aic > 20.0);
}

#[test]
fn recovers_an_arm_that_bends() {
    let swing = Swing {
        frequency: 1500.0,
        damping: 0.02,
    };
    let arm = Some(Bending {
        swing,
        compliance: 1e-7,
    });
    let all = found(
        &Response {
            arm,
            ..Response::default()
        },
        0.0,
    );
    let best = &all[0];
    assert!(best.cause.arm, "{best:?}");
    assert!((best.frequency.value - 1500.0).abs() < 4.0 * best.frequency.sd);
    assert!((best.compliance.value - 1e-7).abs() < 4.0 * best.compliance.sd);
}

#[test]
fn recovers_a_delay_and_a_filter_of_first_order() {
    let late = found(&Response::default(), 20e-6);
    assert!(late[0].cause.delay && late[0].cause.parameters() <= 2);
    assert!((late[0].delay.value - 20e-6).abs() < 4.0 * late[0].delay.sd);
    let filtered = found(
        &Response {
            pole: Some(2e3),
            ..Response::default()
        },
        0.0,
    );
    assert!(filtered[0].cause.pole);
    let corner = filtered[0].frequency;
    assert!((corner.value - 2e3).abs() < 4.0 * corner.sd);
}

#[test]
fn recovers_stiffness_and_damping_behind_a_sensor_that_swings() {
    let sensor = Some(Swing {
        frequency: 2e3,
        damping: 0.05,
    });
    let response = Response {
        sensor,
        ..Response::default()
    };
    let options = FitOptions {
        response,
        ..FitOptions::default()
    };
    let mut mended = [0.0; 2];
    for (index, own) in impacts(&response, 0.0).iter().enumerate() {
        let (k, c, _) = parameters(index as u64);
        let fit = fit_impact(own, &rig(), &problem(), &options).unwrap();
        let plain = fit_impact(own, &rig(), &problem(), &FitOptions::default()).unwrap();
        assert!(fit.converged);
        for (i, truth) in [k, c].into_iter().enumerate() {
            mended[i] += (fit.parameters[i].value - truth) / fit.parameters[i].sd / 4.0;
        }
        let force = |fit: &Fit| {
            let mut own = fit.quantities.iter();
            own.find(|own| own.quantity == Quantity::Force)
                .unwrap()
                .rms_residual
        };
        assert!(
            force(&fit) < force(&plain),
            "{} {}",
            force(&fit),
            force(&plain)
        );
    }
    assert!(mended.iter().all(|z| z.abs() < 3.0), "{mended:?}");
}

/// Thirty times less noise: the shift of each fit is many of its deviations.
#[test]
fn comes_to_rest_behind_a_sensor_with_little_noise() {
    let response = Response {
        sensor: Some(Swing {
            frequency: 2e3,
            damping: 0.05,
        }),
        ..Response::default()
    };
    let options = FitOptions {
        response,
        ..FitOptions::default()
    };
    for index in 0..16 {
        let own = impact_of_noise(index, (&response, 0.0), 0.03);
        let fit = fit_impact(&own, &rig(), &problem(), &options).unwrap();
        let (k, c, _) = parameters(index);
        for (i, truth) in [k, c].into_iter().enumerate() {
            let off = fit.parameters[i].value / truth - 1.0;
            assert!(off.abs() < 2e-3, "{index}: {off}");
        }
    }
}
