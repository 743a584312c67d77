//! Displacement and displacement rate.

use serde::Serialize;

/// What a signal of motion holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Motion {
    /// Displacement; m.
    Displacement,
    /// Displacement rate; m/s.
    Rate,
}

/// What turns the counts of an incremental encoder into a length.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Encoder {
    /// On the axis of a pendulum arm.
    Rotary {
        /// Counts per revolution after ×4 decoding; 1.
        counts_per_revolution: f64,
    },
    /// On a scale or a wheel.
    Linear {
        /// Length of one count; m.
        count_length: f64,
    },
}

/// Length of one count of a rotary encoder at the tip of an arm, 2πL/N; m.
///
/// # Example
/// ```
/// let q = windfall_signal::kinematics::count_length(360_000.0, 0.505);
/// assert!((q - 8.813912723e-6).abs() < 1e-15);
/// ```
pub fn count_length(counts_per_revolution: f64, arm: f64) -> f64 {
    std::f64::consts::TAU * arm / counts_per_revolution
}

/// Displacement of the tip of an arm towards the fruit, x = r sin(θ − θ₀); m.
///
/// * `angles`: θ; rad
/// * `angle_at_contact`: θ₀, where the arm is perpendicular to the displacement; rad
/// * `arm`: r; m
pub fn displacement_from_angles(angles: &[f64], angle_at_contact: f64, arm: f64) -> Vec<f64> {
    // An encoder stays at an angle for several samples.
    let mut last = (f64::NAN, f64::NAN);
    let place = |&angle: &f64| {
        if angle != last.0 {
            last = (angle, arm * (angle - angle_at_contact).sin());
        }
        last.1
    };
    angles.iter().map(place).collect()
}

/// Displacement rate by central difference, for the samples 1 … n − 2:
///
/// ```text
/// v_i = (x_{i+1} − x_{i−1}) / (t_{i+1} − t_{i−1})
/// ```
///
/// On even times this is eq. (1) of the 2003 pendulum study. A displacement in
/// counts of length q gives a rate in steps of [`rate_quantum`]: at high
/// sampling rates coarser than the rate itself.
pub fn central_difference(times: &[f64], displacement: &[f64]) -> Vec<f64> {
    times
        .windows(3)
        .zip(displacement.windows(3))
        .map(|(t, x)| (x[2] - x[0]) / (t[2] - t[0]))
        .collect()
}

/// Smallest step of a rate found by central difference, q/(2 δt); m/s.
///
/// * `count_length`: q; m
/// * `interval`: δt; s
pub fn rate_quantum(count_length: f64, interval: f64) -> f64 {
    count_length / (2.0 * interval)
}

/// Odd number of samples over about a tenth of the contact, enough for a local cubic.
pub fn smoothing_window(contact_duration: f64, interval: f64) -> usize {
    let samples = (contact_duration / (10.0 * interval)).round().max(5.0) as usize;
    samples | 1
}

/// Value at `time`, linear between samples and constant outside.
pub fn value_at(times: &[f64], values: &[f64], time: f64) -> f64 {
    values_at(times, [values], time)[0]
}

/// [`value_at`] of several signals with the same times.
pub fn values_at<const N: usize>(times: &[f64], values: [&[f64]; N], time: f64) -> [f64; N] {
    between(times, values, times.partition_point(|&t| t < time), time)
}

/// [`value_at`] at times that rise.
#[derive(Clone, Debug)]
pub struct Walk<'a> {
    times: &'a [f64],
    values: &'a [f64],
    /// Samples before the last time.
    after: usize,
}

impl<'a> Walk<'a> {
    /// Along a signal, from its start.
    pub fn along(times: &'a [f64], values: &'a [f64]) -> Self {
        let after = 0;
        Self {
            times,
            values,
            after,
        }
    }

    /// Value at `time`, which is no earlier than the one asked for before.
    pub fn at(&mut self, time: f64) -> f64 {
        while self.times.get(self.after).is_some_and(|&t| t < time) {
            self.after += 1;
        }
        between(self.times, [self.values], self.after, time)[0]
    }
}

/// Values at `time`, before which `after` samples lie.
#[inline]
fn between<const N: usize>(
    times: &[f64],
    values: [&[f64]; N],
    after: usize,
    time: f64,
) -> [f64; N] {
    if after == 0 {
        return values.map(|own| own[0]);
    }
    if after == times.len() {
        return values.map(|own| own[after - 1]);
    }
    let (t0, t1) = (times[after - 1], times[after]);
    let part = (time - t0) / (t1 - t0);
    values.map(|own| own[after - 1] + part * (own[after] - own[after - 1]))
}

#[cfg(test)]
mod tests {
    use super::*;

    // windfall reference tables, check_values.json, signal.encoder_vz and
    // signal.encoder_barikloo.
    #[test]
    fn reference_encoder_of_the_2003_study() {
        let q = count_length(360_000.0, 0.505);
        assert!((q / 8.813912723e-6 - 1.0).abs() < 1e-9);
        assert!((rate_quantum(q, 5e-6) / 0.8813912723 - 1.0).abs() < 1e-9);
        assert!((0.001109922 / q / 125.9284103 - 1.0).abs() < 1e-6);
        let q = count_length(20_000.0, 0.577);
        assert!((q / 0.0001812698961 - 1.0).abs() < 1e-9);
    }

    #[test]
    fn closed_form_central_difference_of_a_parabola() {
        // Exact for a parabola on even times; on uneven times it is the slope
        // of the chord: (1 - 0.04)/0.8 = 1.2.
        let times = [0.0, 0.1, 0.2, 0.3];
        let x: Vec<f64> = times.iter().map(|t| 3.0 * t * t - t).collect();
        let v = central_difference(&times, &x);
        assert!((v[0] - -0.4).abs() < 1e-14 && (v[1] - 0.2).abs() < 1e-14);
        let v = central_difference(&[0.2, 0.5, 1.0], &[0.04, 0.25, 1.0]);
        assert!((v[0] - 1.2).abs() < 1e-14);
    }

    #[test]
    fn closed_form_arm_tip() {
        // 30° at 0.5 m: half the arm.
        let x = displacement_from_angles(&[0.1 + std::f64::consts::FRAC_PI_6], 0.1, 0.5);
        assert!((x[0] - 0.25).abs() < 1e-15);
    }
}
