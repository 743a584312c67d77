//! One impact at a time against the accurate solution of its equation of motion.
#![allow(clippy::unwrap_used)]

use crate::common;

use common::{ball, floor, law, scene};
use windfall_scene::event::Event;
use windfall_scene::interaction::Interaction;
use windfall_scene::motion::simulation::Simulation;

/// An apple of 0.2 kg and 40 mm at 0.5 m/s.
fn impact(expression: &str, pair: bool, step: f64) -> Event {
    let mut scene = scene(Interaction::frictionless(law(expression)), step);
    // Touch happens within a step, not at its end.
    let gap = 0.37 * 0.5 * step;
    if pair {
        let apart = 0.04 + 0.5 * gap;
        scene
            .fruit
            .push(ball(0.04, 0.2, [-apart, 0.0, 0.0], [0.25, 0.0, 0.0]));
        scene
            .fruit
            .push(ball(0.04, 0.2, [apart, 0.0, 0.0], [-0.25, 0.0, 0.0]));
    } else {
        scene.walls.push(floor());
        scene
            .fruit
            .push(ball(0.04, 0.2, [0.0, 0.0, 0.04 + gap], [0.0, 0.0, -0.5]));
    }
    let mut simulation = Simulation::new(scene).unwrap();
    while simulation.time() < 0.03 {
        simulation.step().unwrap();
    }
    let events = simulation.take_events();
    assert_eq!(events.len(), 1, "{events:?}");
    events[0]
}

/// Effective mass times half the square of the speed, for the restitution.
fn restitution(event: &Event, mass: f64) -> f64 {
    let before = 0.5 * mass * event.normal_speed.powi(2);
    (1.0 - event.absorbed_energy / before).sqrt()
}

/// Peak force (N), duration (ms), restitution, largest displacement (mm); made with SciPy's
/// DOP853 at a relative tolerance of 1e-11, ended where the force returns to zero.
const REFERENCE: &[(&str, bool, f64, [f64; 4])] = &[
    (
        "kuwabara-kono(k=753599, c=1524)",
        true,
        0.1,
        [21.647365609, 5.6162139690, 0.39628833894, 0.78407477857],
    ),
    (
        "kuwabara-kono(k=753599, c=1524)",
        false,
        0.2,
        [32.866208632, 7.6501369649, 0.47814312909, 1.1099219973],
    ),
];

#[test]
fn reference_impacts_of_the_accurate_equation() {
    for &(expression, pair, mass, [peak, duration, e, displacement]) in REFERENCE {
        let event = impact(expression, pair, 1e-6);
        let close = |found: f64, wanted: f64, tolerance: f64| {
            assert!(
                (found / wanted - 1.0).abs() < tolerance,
                "{expression} {pair}: {found} for {wanted}"
            );
        };
        close(event.normal_speed, 0.5, 1e-12);
        close(event.peak_force, peak, 2e-6);
        close(1e3 * event.duration, duration, 2e-5);
        close(restitution(&event, mass), e, 1e-5);
        close(1e3 * event.largest_displacement, displacement, 1e-6);
    }
}

#[test]
fn closed_form_kelvin_voigt_and_hertz() {
    // A damped oscillator: F = 0 first at a closed-form time; elastic Hertz: T = 2.94 d/v.
    let (k, c, m) = (4e4_f64, 8.0_f64, 0.2_f64);
    let event = impact("kelvin-voigt(k=40000, c=8)", false, 1e-6);
    let (omega, zeta) = ((k / m).sqrt(), c / (2.0 * (k * m).sqrt()));
    let damped = omega * (1.0 - zeta * zeta).sqrt();
    // F ∝ k x + c v = 0: tan(ω_d t) = −2 ζ √(1 − ζ²)/(1 − 2 ζ²)
    let angle = std::f64::consts::PI
        + (-2.0 * zeta * (1.0 - zeta * zeta).sqrt()).atan2(1.0 - 2.0 * zeta * zeta);
    let end = angle / damped;
    assert!(
        (event.duration / end - 1.0).abs() < 1e-5,
        "{} {end}",
        event.duration
    );

    let event = impact("hertz(k=753599)", false, 1e-6);
    // k d^2.5/2.5 = m v²/2
    let depth = (1.25 * m * 0.25 / 753_599.0_f64).powf(0.4);
    assert!((event.largest_displacement / depth - 1.0).abs() < 1e-6);
    let duration = 2.943_275_5 * depth / 0.5;
    assert!(
        (event.duration / duration - 1.0).abs() < 1e-5,
        "{} {duration}",
        event.duration
    );
    // Nothing is lost.
    assert!(event.absorbed_energy.abs() < 1e-6 * 0.5 * m * 0.25);
}

#[test]
fn convergence_is_of_second_order() {
    // Smooth but for its ends: peak and restitution converge with the square of the step.
    let peak = |step: f64| impact("kuwabara-kono(k=753599, c=1524)", false, step).peak_force;
    let e = |step: f64| restitution(&impact("kuwabara-kono(k=753599, c=1524)", false, step), 0.2);
    let error = |found: f64, wanted: f64| (found / wanted - 1.0).abs();
    let (coarse, fine) = (
        error(peak(1e-4), 32.866208632),
        error(peak(1e-5), 32.866208632),
    );
    println!("peak {coarse:e} {fine:e}");
    assert!(coarse < 2e-3 && fine < coarse / 30.0, "{coarse:e} {fine:e}");
    let (coarse, fine) = (error(e(1e-4), 0.47814312909), error(e(1e-5), 0.47814312909));
    println!("restitution {coarse:e} {fine:e}");
    assert!(coarse < 5e-3 && fine < coarse / 20.0, "{coarse:e} {fine:e}");
}
