//! Time from first touch to the first visible force, directly or behind a plate.

use crate::ringing::model::decay_rate;
use std::f64::consts::TAU;

/// Nodes of the integral over the plate's answer.
const NODES: usize = 32;
/// Halvings of the interval that holds the beginning.
const HALVINGS: usize = 40;
/// Longest time from first touch to a visible force behind a plate; periods.
const LONGEST: f64 = 2.0;

/// Time from first touch to the lower of two levels of a rising force; s.
///
/// * `rise`: time from the lower level to the upper; s
/// * `ratio`: upper over lower level, above 1
/// * `exponent`: q of the contact force, F = K (t − t₀)^q
/// * `plate`: damped period and damping ratio of the plate that the force is
///   measured behind
///
/// Directly, (t_b − t₀)/(t_a − t₀) = ratio^(1/q). Behind a plate the force is
/// K ∫ s^q h(t − t₀ − s) ds with h(t) = exp(−λ t) sin(ω_d t), which rises like
/// t^(q+2) as long as the plate is inert and like t^q once it follows; the
/// beginning is where the ratio of the two is that of the levels.
pub fn time_before(rise: f64, ratio: f64, exponent: f64, plate: Option<(f64, f64)>) -> f64 {
    let Some((period, damping_ratio)) = plate else {
        return rise / (ratio.powf(1.0 / exponent) - 1.0);
    };
    let decay = decay_rate(period, damping_ratio);
    let answer = |t: f64| -> f64 {
        // s = t u²: smooth at the beginning for any exponent.
        let at = |i: usize| {
            let u = (i as f64 + 0.5) / NODES as f64;
            let s = t * u * u;
            let after = t - s;
            s.powf(exponent) * (-decay * after).exp() * (TAU * after / period).sin() * u
        };
        t * (0..NODES).map(at).sum::<f64>()
    };
    let (mut short, mut long) = (0.0, LONGEST * period);
    for _ in 0..HALVINGS {
        let middle = 0.5 * (short + long);
        match answer(middle + rise) > ratio * answer(middle) {
            true => short = middle,
            false => long = middle,
        }
    }
    long
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn closed_form_a_power_of_time() {
        // (t/1 ms)^2 passes 1 at 1 ms and 9 at 3 ms.
        let found = time_before(2e-3, 9.0, 2.0, None);
        assert!((found - 1e-3).abs() < 1e-15, "{found}");
    }

    /// A plate that is slow beside the rise: its force is the contact force
    /// integrated twice, here (t/1 ms)^3.
    #[test]
    fn closed_form_behind_an_inert_plate() {
        let found = time_before(2e-3, 27.0, 1.0, Some((10.0, 0.07)));
        assert!((found - 1e-3).abs() < 1e-5, "{found}");
    }

    /// A ramp behind an undamped plate: F = t − sin(ω t)/ω.
    #[test]
    fn closed_form_a_ramp_behind_a_plate_that_follows() {
        let period = 3.5e-3;
        let force = |t: f64| t - (TAU * t / period).sin() * period / TAU;
        for begin in [0.3e-3, 0.8e-3, 1.5e-3] {
            let end = begin + 0.7e-3;
            let found = time_before(0.7e-3, force(end) / force(begin), 1.0, Some((period, 0.0)));
            assert!((found - begin).abs() < 3e-6, "{found}, not {begin}");
        }
    }
}
