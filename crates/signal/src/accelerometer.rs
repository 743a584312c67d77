//! An accelerometer beside a force sensor and an encoder: a check of the force,
//! and, for comparison, a source of displacement.

use crate::filter::butterworth::{Band, FilterError, butterworth};
use crate::filter::zero_phase::filter_zero_phase;
use crate::kinematics::value_at;
use crate::measure::Surroundings;
use crate::uncertain::Uncertain;

/// Order of the high-pass filters of a double integration.
const ORDER: usize = 2;

/// Force over mass times acceleration; 1 where sensors and mass agree.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ForceCheck {
    /// Ratio of the impulses over the contact; 1.
    pub impulse_ratio: f64,
    /// Ratio of the largest values; 1.
    pub peak_ratio: f64,
}

/// Part of the contact's duration before onset that is left out of the zero; 1.
const GUARD: f64 = 0.05;

/// Samples before contact from which a zero is known.
const LEAST_ZERO: usize = 5;

/// Mean acceleration in free motion before contact and its standard uncertainty, with any
/// constant acceleration of the motion; m/s². `None` with fewer than 5 samples.
pub fn free_acceleration(times: &[f64], values: &[f64], place: &Surroundings) -> Option<Uncertain> {
    let last = times.partition_point(|&t| t <= place.onset - GUARD * place.duration());
    let first = times.partition_point(|&t| t <= place.from);
    let free = values.get(first..last)?;
    if free.len() < LEAST_ZERO {
        return None;
    }
    let n = free.len() as f64;
    let mean = free.iter().sum::<f64>() / n;
    let squares: f64 = free.iter().map(|a| (a - mean).powi(2)).sum();
    Some(Uncertain::new(mean, (squares / (n - 1.0) / n).sqrt()))
}

/// Compares a force with the acceleration of the mass that it slows down.
///
/// * `force`, `acceleration`: times and samples; acceleration positive into the
///   fruit, so negative in contact
/// * `mass`: effective mass at the contact; kg
/// * `free`: what the accelerometer shows without contact; m/s²
///
/// `None` where the acceleration does not cover the contact or has no impulse.
pub fn check_force(
    force: (&[f64], &[f64]),
    acceleration: (&[f64], &[f64]),
    (onset, end): (f64, f64),
    mass: f64,
    free: f64,
) -> Option<ForceCheck> {
    let covers = |times: &[f64]| {
        times.first().is_some_and(|t| *t <= onset) && times.last().is_some_and(|t| *t >= end)
    };
    if !covers(force.0) || !covers(acceleration.0) {
        return None;
    }
    let inertial: Vec<f64> = acceleration.1.iter().map(|a| mass * (free - a)).collect();
    let (of_force, of_acceleration) = (
        integral(force.0, force.1, onset, end),
        integral(acceleration.0, &inertial, onset, end),
    );
    let peak = |times: &[f64], values: &[f64]| {
        let inside = times
            .iter()
            .zip(values)
            .filter(|(t, _)| (onset..=end).contains(t));
        inside
            .map(|(_, value)| *value)
            .fold(f64::NEG_INFINITY, f64::max)
    };
    let peaks = (peak(force.0, force.1), peak(acceleration.0, &inertial));
    (of_acceleration > 0.0 && peaks.1 > 0.0).then(|| ForceCheck {
        impulse_ratio: of_force / of_acceleration,
        peak_ratio: peaks.0 / peaks.1,
    })
}

/// Trapezoidal rule from `from` to `to`, with values between samples.
fn integral(times: &[f64], values: &[f64], from: f64, to: f64) -> f64 {
    let mut inner: Vec<f64> = times
        .iter()
        .copied()
        .filter(|t| (from..=to).contains(t))
        .collect();
    inner.insert(0, from);
    inner.push(to);
    let at: Vec<f64> = inner.iter().map(|t| value_at(times, values, *t)).collect();
    let pairs = inner.windows(2).zip(at.windows(2));
    pairs
        .map(|(t, v)| 0.5 * (v[0] + v[1]) * (t[1] - t[0]))
        .sum()
}

/// Displacement from an acceleration, integrated twice from its first sample.
///
/// * `velocity`: at the first sample; m/s
/// * `high_pass`: cut-off of a filter of order 2 (zero phase) on the acceleration
///   and after each integration, against drift; Hz. It also takes away the free
///   motion before and after the contact.
///
/// # Errors
/// A cut-off that the sampling cannot show, or too few samples.
pub fn double_integral(
    times: &[f64],
    acceleration: &[f64],
    velocity: f64,
    high_pass: Option<f64>,
) -> Result<Vec<f64>, FilterError> {
    let n = times.len().min(acceleration.len());
    let Some(cutoff) = high_pass else {
        let rate = cumulative(times, &acceleration[..n], velocity);
        return Ok(cumulative(times, &rate, 0.0));
    };
    if n < 2 {
        return Err(FilterError::TooFewSamples {
            samples: n,
            least: 2,
        });
    }
    let rate = (n - 1) as f64 / (times[n - 1] - times[0]);
    let filter = butterworth(Band::HighPass(cutoff), ORDER, rate)?;
    let clean = filter_zero_phase(&filter, &acceleration[..n])?;
    let speed = filter_zero_phase(&filter, &cumulative(times, &clean, velocity))?;
    filter_zero_phase(&filter, &cumulative(times, &speed, 0.0))
}

fn cumulative(times: &[f64], values: &[f64], start: f64) -> Vec<f64> {
    let mut sum = start;
    let mut whole = vec![sum; values.len()];
    for i in 1..values.len() {
        sum += 0.5 * (values[i] + values[i - 1]) * (times[i] - times[i - 1]);
        whole[i] = sum;
    }
    whole
}

/// Departure of a displacement from another over a contact, both zero at onset.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DisplacementError {
    /// Root mean square departure; m.
    pub rms: f64,
    /// Largest departure; m.
    pub largest: f64,
    /// Departure at the end of the contact; m.
    pub drift: f64,
}

/// Compares an integrated displacement with a measured one.
pub fn displacement_error(
    integrated: (&[f64], &[f64]),
    measured: (&[f64], &[f64]),
    (onset, end): (f64, f64),
) -> Option<DisplacementError> {
    let zero = |(times, values): (&[f64], &[f64])| value_at(times, values, onset);
    if integrated.0.is_empty() || measured.0.is_empty() {
        return None;
    }
    let (zero_integrated, zero_measured) = (zero(integrated), zero(measured));
    let departure = |time: f64| {
        let own = value_at(integrated.0, integrated.1, time) - zero_integrated;
        own - (value_at(measured.0, measured.1, time) - zero_measured)
    };
    let inside = measured.0.iter().filter(|t| (onset..=end).contains(t));
    let departures: Vec<f64> = inside.map(|t| departure(*t)).collect();
    if departures.is_empty() {
        return None;
    }
    let squares: f64 = departures.iter().map(|d| d * d).sum();
    Some(DisplacementError {
        rms: (squares / departures.len() as f64).sqrt(),
        largest: departures.iter().map(|d| d.abs()).fold(0.0, f64::max),
        drift: departure(end),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A half-sine of force on a mass: x = v t − (A/ω²)(ωt − sin ωt) … exactly.
    fn half_sine() -> (Vec<f64>, Vec<f64>, Vec<f64>) {
        let (amplitude, omega, velocity) = (200.0, 400.0, 0.8);
        let times: Vec<f64> = (0..2000).map(|i| f64::from(i) * 5e-6).collect();
        let contact = std::f64::consts::PI / omega;
        let acceleration = times
            .iter()
            .map(|t| {
                if *t <= contact {
                    -amplitude * (omega * t).sin()
                } else {
                    0.0
                }
            })
            .collect();
        let displacement = times
            .iter()
            .map(|t| {
                let inside = t.min(contact);
                let change = amplitude / omega * (inside - (omega * inside).sin() / omega);
                let rest = (velocity - 2.0 * amplitude / omega) * (t - inside);
                velocity * inside - change + rest
            })
            .collect();
        (times, acceleration, displacement)
    }

    #[test]
    fn closed_form_double_integral_of_a_half_sine() {
        let (times, acceleration, displacement) = half_sine();
        let found = double_integral(&times, &acceleration, 0.8, None).unwrap();
        for (found, expected) in found.iter().zip(&displacement) {
            assert!((found - expected).abs() < 2e-9, "{found} {expected}");
        }
        let error =
            displacement_error((&times, &found), (&times, &displacement), (1e-4, 7e-3)).unwrap();
        assert!(error.largest < 4e-9);
    }

    /// An offset of 1 % of the peak drifts as t²/2.
    #[test]
    fn closed_form_offset_drifts() {
        let (times, acceleration, displacement) = half_sine();
        let biased: Vec<f64> = acceleration.iter().map(|a| a + 2.0).collect();
        let found = double_integral(&times, &biased, 0.8, None).unwrap();
        let error =
            displacement_error((&times, &found), (&times, &displacement), (0.0, 7e-3)).unwrap();
        assert!((error.drift / (0.5 * 2.0 * 7e-3 * 7e-3) - 1.0).abs() < 1e-3);
    }

    #[test]
    fn closed_form_force_and_acceleration_of_one_mass_agree() {
        let (times, acceleration, _) = half_sine();
        let force: Vec<f64> = acceleration.iter().map(|a| -0.15 * a).collect();
        let window = (0.0, std::f64::consts::PI / 400.0);
        let check = check_force((&times, &force), (&times, &acceleration), window, 0.15, 0.0);
        let check = check.unwrap();
        assert!((check.impulse_ratio - 1.0).abs() < 1e-12);
        assert!((check.peak_ratio - 1.0).abs() < 1e-12);
        let heavier = check_force((&times, &force), (&times, &acceleration), window, 0.3, 0.0);
        assert!((heavier.unwrap().impulse_ratio - 0.5).abs() < 1e-12);
    }
}
