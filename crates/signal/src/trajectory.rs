//! A motion with its force, and its values at any times.

use crate::error::{Error, positive};

/// A motion and the force that goes with it, at increasing times.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Trajectory {
    /// Times, from first touch where a law is simulated; s.
    pub times: Vec<f64>,
    /// Displacement, zero at first contact, positive into the fruit; m.
    pub displacement: Vec<f64>,
    /// Displacement rate; m/s.
    pub rate: Vec<f64>,
    /// Contact force, repulsive positive; N.
    pub force: Vec<f64>,
    /// Acceleration; m/s².
    pub acceleration: Vec<f64>,
}

pub(crate) fn check_trajectory(trajectory: &Trajectory) -> Result<(), Error> {
    let n = trajectory.times.len();
    for (name, values) in [
        ("displacement", &trajectory.displacement),
        ("rate", &trajectory.rate),
        ("force", &trajectory.force),
        ("acceleration", &trajectory.acceleration),
    ] {
        if values.len() != n {
            return Err(Error::UnequalLengths {
                channel: format!("trajectory {name}"),
                samples: values.len(),
                times: n,
            });
        }
    }
    if n < 2 {
        return Err(Error::too_few_samples("trajectory".to_owned(), n, 2));
    }
    let times = &trajectory.times;
    let backwards = |pair: &[f64]| pair[1] <= pair[0] || !(pair[1] - pair[0]).is_finite();
    match times.windows(2).position(backwards) {
        Some(i) => Err(Error::TimeNotIncreasing {
            channel: "trajectory".to_owned(),
            sample: i + 1,
            before: times[i],
            time: times[i + 1],
        }),
        None => Ok(()),
    }
}

/// Sampling times of a rate over the trajectory.
pub(crate) fn sampling_times(trajectory: &Trajectory, rate: f64) -> Result<Vec<f64>, Error> {
    let rate = positive("sampling rate", rate)?;
    let times = &trajectory.times;
    let start = times[0];
    // A sample that falls on the last time up to rounding is taken.
    let count = ((times[times.len() - 1] - start) * rate * (1.0 + 1e-12) + 1e-9).floor() as usize;
    Ok((0..=count).map(|i| start + i as f64 / rate).collect())
}

/// Values at sampling times by cubics through values and their derivatives.
pub(crate) fn cubic(
    trajectory: &Trajectory,
    values: &[f64],
    slopes: &[f64],
    at: &[f64],
) -> Vec<f64> {
    each_interval(&trajectory.times, at, |i, u, h| {
        let rise = values[i + 1] - values[i];
        let a = slopes[i] * h - rise;
        let b = -slopes[i + 1] * h + rise;
        values[i] + u * rise + u * (1.0 - u) * ((1.0 - u) * a + u * b)
    })
}

pub(crate) fn linear(trajectory: &Trajectory, values: &[f64], at: &[f64]) -> Vec<f64> {
    each_interval(&trajectory.times, at, |i, u, _| {
        values[i] + u * (values[i + 1] - values[i])
    })
}

/// For each time the interval it lies in, its place there (0 to 1), the length.
fn each_interval(times: &[f64], at: &[f64], value: impl Fn(usize, f64, f64) -> f64) -> Vec<f64> {
    let mut i = 0;
    at.iter()
        .map(|&t| {
            while i + 2 < times.len() && times[i + 1] <= t {
                i += 1;
            }
            let h = times[i + 1] - times[i];
            value(i, ((t - times[i]) / h).clamp(0.0, 1.0), h)
        })
        .collect()
}
