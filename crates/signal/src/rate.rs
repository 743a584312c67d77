//! Displacement rate from displacement.

use crate::kinematics::{central_difference, rate_quantum, smoothing_window};
use crate::measure::Surroundings;
use crate::options::RateMethod;
use crate::polynomial::{evenly_spaced, local_polynomial};
use crate::track::{Track, mean_interval};

/// The rate of a displacement by the method asked for; `None` if that is the
/// measured channel, or if there are too few samples.
pub(crate) fn derived_rate(
    displacement: &Track,
    method: RateMethod,
    place: &Surroundings,
) -> Option<Track> {
    match method {
        RateMethod::Measured => None,
        RateMethod::Automatic if !evenly_spaced(&displacement.times) => None,
        RateMethod::Automatic | RateMethod::CentralDifference => central_rate(displacement),
        RateMethod::LocalPolynomial { order, window } => {
            polynomial_rate(displacement, order, window, place)
        }
    }
}

fn central_rate(track: &Track) -> Option<Track> {
    let n = track.values.len();
    (n >= 3).then(|| Track {
        name: format!("rate of {}", track.name),
        times: track.times[1..n - 1].to_vec(),
        values: central_difference(&track.times, &track.values),
        quantum: track
            .quantum
            .map(|q| rate_quantum(q, mean_interval(&track.times))),
        noise: 0.0,
    })
}

fn polynomial_rate(
    track: &Track,
    order: usize,
    window: Option<usize>,
    place: &Surroundings,
) -> Option<Track> {
    let window =
        window.unwrap_or_else(|| smoothing_window(place.duration(), mean_interval(&track.times)));
    Some(Track {
        name: format!("rate of {}", track.name),
        times: track.times.clone(),
        values: local_polynomial(&track.times, &track.values, window, order, 1)?,
        quantum: None,
        noise: 0.0,
    })
}
