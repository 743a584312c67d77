//! Contact force from the force that supports a ringing plate.

use crate::ringing::model::decay_rate;
use crate::trigger::scale::moving_mean;
use std::f64::consts::TAU;

/// Contact force behind a support force, smoothed.
#[derive(Clone, Debug, PartialEq)]
pub struct ContactForce {
    /// Force; N.
    pub values: Vec<f64>,
    /// Noise of a value over that of a sample of the support force; 1.
    pub noise_gain: f64,
}

/// Contact force behind the support force of a plate that rings in one mode:
///
/// ```text
/// F_c = F_s + (2ζ/ω_n) F_s′ + F_s″/ω_n²
/// ```
///
/// * `force`: support force, evenly sampled; N
/// * `period`, `damping_ratio`: of the damped ringing; in samples, 1
/// * `smoothing`: length of a moving mean that is taken twice; samples, odd
///
/// # Numerics
/// In place of the derivatives, the recurrence that sampled free ringing obeys
/// exactly, whatever the sampling rate, with r = e^(−λ) and φ the phase a sample:
///
/// ```text
/// F_c[i] = (F_s[i+1] − 2 r cos φ F_s[i] + r² F_s[i−1]) / (1 − 2 r cos φ + r²)
/// ```
///
/// Free ringing becomes zero and the integral of a force stays what it is.
///
/// # Source
/// The equation of motion of the plate. Differences: none.
pub fn contact_force(
    force: &[f64],
    (period, damping_ratio): (f64, f64),
    smoothing: usize,
) -> ContactForce {
    let r = (-decay_rate(period, damping_ratio)).exp();
    let weights = [1.0, -2.0 * r * (TAU / period).cos(), r * r];
    let sum: f64 = weights.iter().sum();
    let n = force.len();
    let raw: Vec<f64> = (0..n)
        .map(|i| {
            let after = force[(i + 1).min(n - 1)];
            let before = force[i.saturating_sub(1)];
            (weights[0] * after + weights[1] * force[i] + weights[2] * before) / sum
        })
        .collect();
    ContactForce {
        values: moving_mean(&moving_mean(&raw, smoothing), smoothing),
        noise_gain: gain(&weights.map(|w| w / sum), smoothing),
    }
}

/// The force itself, smoothed: of a support that does not ring.
pub fn smoothed_force(force: &[f64], smoothing: usize) -> ContactForce {
    ContactForce {
        values: moving_mean(&moving_mean(force, smoothing), smoothing),
        noise_gain: gain(&[1.0], smoothing),
    }
}

/// √Σh² of weights folded with two moving means.
fn gain(weights: &[f64], smoothing: usize) -> f64 {
    let mut kernel = weights.to_vec();
    for _ in 0..2 {
        let mut folded = vec![0.0; kernel.len() + smoothing - 1];
        for (i, k) in kernel.iter().enumerate() {
            for value in &mut folded[i..i + smoothing] {
                *value += k / smoothing as f64;
            }
        }
        kernel = folded;
    }
    kernel.iter().map(|h| h * h).sum::<f64>().sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn closed_form_free_ringing_has_no_contact_force() {
        // ζ = 0.07, 35 samples a period.
        let lambda = decay_rate(35.0, 0.07);
        let force: Vec<f64> = (0..400)
            .map(f64::from)
            .map(|t| 10.0 * (-lambda * t).exp() * (TAU * t / 35.0 - 0.4).cos())
            .collect();
        let found = contact_force(&force, (35.0, 0.07), 1);
        for value in &found.values[1..399] {
            assert!(value.abs() < 1e-10, "{value}");
        }
    }

    #[test]
    fn closed_form_constant_force_and_noise_gain() {
        let found = contact_force(&[3.0; 50], (20.0, 0.1), 5);
        assert!(found.values.iter().all(|v| (v - 3.0).abs() < 1e-12));
        // A mean of 3 taken twice has weights 1, 2, 3, 2, 1 over 9.
        let smooth = smoothed_force(&[0.0; 9], 3);
        assert!((smooth.noise_gain - 19f64.sqrt() / 9.0).abs() < 1e-15);
    }
}
