use super::*;
use crate::relaxation::peleg::fit_peleg;
use windfall_signal::noise::gaussian::{noise_source, normal};

#[track_caller]
fn close(found: f64, expected: f64, tolerance: f64) {
    let error = (found / expected - 1.0).abs();
    assert!(error < tolerance, "{found} against {expected}: {error:e}");
}

fn held(times: Vec<f64>, force: impl Fn(usize, f64) -> f64) -> HeldForce {
    let force = times.iter().enumerate().map(|(i, t)| force(i, *t));
    HeldForce {
        force: force.collect(),
        times,
        ramp: None,
        exponent: 1.5,
    }
}

/// 400 samples in 100 s, with a disturbance that any program can make again.
fn disturbed() -> HeldForce {
    let times = (0..400).map(|i| 0.25 * f64::from(i)).collect();
    held(times, |i, t| {
        let i = i as f64;
        let noise = 0.02 * (1.7 * i * i + 0.3 * i).sin();
        6.0 + 3.0 * (-t / 2.5).exp() + 2.0 * (-t / 30.0).exp() + noise
    })
}

/// SciPy 1.17, `curve_fit` with tolerances of 1e-14: the same samples, the same models.
#[test]
fn reference_fits_of_scipy() {
    let held = disturbed();
    let one = fit_maxwell(&held, Elements::Given(1)).unwrap();
    close(one.equilibrium_force.value, 6.228320732416408, 1e-7);
    close(one.elements[0].time.value, 2.535811724404203f64.exp(), 1e-7);
    close(one.rms, (14.573230681805715f64 / 400.0).sqrt(), 1e-9);
    let two = fit_maxwell(&held, Elements::Given(2)).unwrap();
    let expected = [
        (2.484460506318303, 0.27212224),
        (29.76454251006244, 0.18262891),
    ];
    for (element, (time, fraction)) in two.elements.iter().zip(expected) {
        close(element.time.value, time, 1e-7);
        close(element.fraction.value, fraction, 1e-7);
    }
    close(two.equilibrium.value, 0.54524885, 1e-7);
    close(two.initial_force.value, 11.006534079897726, 1e-7);
    close(two.rms, (0.07419927054134237f64 / 400.0).sqrt(), 1e-8);
    // Its covariance takes residuals as independent; ours is never less.
    let sd = 0.00615581 * 2.484460506318303;
    assert!(two.elements[0].time.sd > 0.999 * sd && two.elements[0].time.sd < 3.0 * sd);
    let peleg = fit_peleg(&held.times, &held.force);
    close(peleg.initial_force.value, 10.553646467221634, 1e-7);
    close(peleg.k1.value, 12.504088001464332, 1e-7);
    close(peleg.k2.value, 2.26551280154619, 1e-7);
    close(peleg.rms, (3.44019046313239f64 / 400.0).sqrt(), 1e-8);
}

/// The third element lowers the sum of squares by a thousandth: two are chosen, and of a single
/// exponential one.
#[test]
fn reference_number_of_elements() {
    let chosen = fit_maxwell(&disturbed(), Elements::Chosen).unwrap();
    assert_eq!(chosen.elements.len(), 2);
    assert!(chosen.criteria[1] < chosen.criteria[0]);
    let disturbed = disturbed();
    let single = held(disturbed.times.clone(), |i, t| {
        let i = i as f64;
        6.0 + 5.0 * (-t / 12.0).exp() + 0.02 * (1.7 * i * i + 0.3 * i).sin()
    });
    let chosen = fit_maxwell(&single, Elements::Chosen).unwrap();
    assert_eq!(chosen.elements.len(), 1);
    close(chosen.elements[0].time.value, 12.0, 0.01);
}

/// By superposition: of a ramp of 1 s whose elastic force grows as t^1.5, summed in 20,000 steps.
#[test]
fn closed_form_ramp_is_corrected() {
    let (forces, times, stays) = ([3.0, 2.0], [0.8, 12.0], 5.0);
    let steps = 20_000;
    let after = |t: f64| {
        let step = |k: usize| {
            let (from, to) = (
                k as f64 / f64::from(steps),
                (k + 1) as f64 / f64::from(steps),
            );
            let rise = to.powf(1.5) - from.powf(1.5);
            let since = 1.0 + t - 0.5 * (from + to);
            let left: f64 = (0..2).map(|i| forces[i] * (-since / times[i]).exp()).sum();
            rise * (stays + left)
        };
        (0..steps as usize).map(step).sum::<f64>()
    };
    let grid = (0..120).map(|i| 0.25 * f64::from(i)).collect();
    let mut own = held(grid, |_, t| after(t));
    own.ramp = Some(1.0);
    let found = fit_maxwell(&own, Elements::Given(2)).unwrap();
    close(found.initial_force.value, 10.0, 1e-4);
    close(found.equilibrium.value, 0.5, 1e-4);
    for (i, element) in found.elements.iter().enumerate() {
        close(element.time.value, times[i], 1e-4);
        close(element.fraction.value, 0.1 * forces[i], 1e-4);
    }
    // Without the correction the fast element seems half as strong.
    own.ramp = None;
    let sudden = fit_maxwell(&own, Elements::Given(2)).unwrap();
    assert!(sudden.elements[0].fraction.value < 0.25);
}

/// 200 holds with noise of first-order persistence 0.7: intervals of 95 % hold the truth.
#[test]
fn recovers_intervals_in_correlated_noise() {
    let mut held_within = [0.0; 3];
    for seed in 0..200 {
        let mut source = noise_source(seed, 0);
        let mut state = normal(&mut source);
        let noise: Vec<f64> = (0..600)
            .map(|_| {
                state = 0.7 * state + 0.51f64.sqrt() * normal(&mut source);
                0.03 * state
            })
            .collect();
        let times = (0..600).map(|i| 0.1 * f64::from(i)).collect();
        let own = held(times, |i, t| 6.0 + 4.0 * (-t / 6.0).exp() + noise[i]);
        let found = fit_maxwell(&own, Elements::Given(1)).unwrap();
        let inside = |estimate: &CompressionEstimate, truth: f64| {
            f64::from(u8::from((estimate.low..=estimate.high).contains(&truth)))
        };
        held_within[0] += inside(&found.elements[0].time, 6.0);
        held_within[1] += inside(&found.elements[0].fraction, 0.4);
        held_within[2] += inside(&found.equilibrium_force, 6.0);
    }
    for count in held_within {
        let rate = count / 200.0;
        assert!((0.90..=0.99).contains(&rate), "{held_within:?}");
    }
}
