//! Displacement rate from displacement.

use crate::encoder::edge_rate::{CountTimes, edge_rate, edges};
use crate::filter::smoothing_spline::smoothing_spline_gcv;
use crate::kinematics::{central_difference, rate_quantum, smoothing_window};
use crate::measure::Surroundings;
use crate::options::{ExtractOptions, RateMethod};
use crate::polynomial::{evenly_spaced, local_polynomial};
use crate::track::{Track, mean_interval};

/// The rate of a displacement; `None` if it was measured or there are too few samples.
pub(crate) fn derived_rate(
    displacement: &Track,
    options: &ExtractOptions,
    place: &Surroundings,
) -> Option<Track> {
    match options.rate {
        RateMethod::Measured => None,
        RateMethod::Automatic if !evenly_spaced(&displacement.times) => None,
        RateMethod::Automatic | RateMethod::CentralDifference => central_rate(displacement),
        RateMethod::SmoothingSpline => spline_rate(displacement, options.count_times, place),
        RateMethod::EdgeTimes => edge_track(displacement, options),
        RateMethod::LocalPolynomial { order, window } => {
            polynomial_rate(displacement, order, window, place)
        }
    }
}

fn central_rate(track: &Track) -> Option<Track> {
    let n = track.values.len();
    (n >= 3).then(|| {
        let rate = central_difference(&track.times, &track.values);
        let quantum = track.quantum;
        Track {
            quantum: quantum.map(|q| rate_quantum(q, mean_interval(&track.times))),
            ..rate_of(track, track.times[1..n - 1].to_vec(), rate)
        }
    })
}

/// A rate of a track whose noise is not known yet.
fn rate_of(track: &Track, times: Vec<f64>, values: Vec<f64>) -> Track {
    Track {
        name: format!("rate of {}", track.name),
        times,
        values,
        quantum: None,
        noise: 0.0,
        persistence: None,
    }
}

fn polynomial_rate(
    track: &Track,
    order: usize,
    window: Option<usize>,
    place: &Surroundings,
) -> Option<Track> {
    let window =
        window.unwrap_or_else(|| smoothing_window(place.duration(), mean_interval(&track.times)));
    let rate = local_polynomial(&track.times, &track.values, window, order, 1)?;
    Some(rate_of(track, track.times.clone(), rate))
}

/// Most knots of a spline; more samples are averaged in blocks.
const MOST_KNOTS: usize = 4000;

/// From so many samples per count on a displacement is taken at its edges.
const SAMPLES_PER_COUNT: usize = 3;

/// Derivative of a smoothing spline, through the edges of slowly changing counts.
fn spline_rate(track: &Track, count_times: CountTimes, place: &Surroundings) -> Option<Track> {
    let around = place.duration();
    let first = track.times.partition_point(|t| *t < place.onset - around);
    let last = track.times.partition_point(|t| *t <= place.end + around);
    let (times, values) = (&track.times[first..last], &track.values[first..last]);
    let edges = edges(times, values, count_times);
    let counted =
        track.quantum.is_some() && times.len() > SAMPLES_PER_COUNT * edges.times.len().max(1);
    let (times, values) = match counted {
        true => (edges.times, edges.values),
        false => {
            let block = times.len().div_ceil(MOST_KNOTS).max(1);
            let mean = |values: &[f64]| -> Vec<f64> {
                let blocks = values.chunks(block);
                blocks
                    .map(|b| b.iter().sum::<f64>() / b.len() as f64)
                    .collect()
            };
            (mean(times), mean(values))
        }
    };
    let spline = smoothing_spline_gcv(&times, &values)?;
    Some(rate_of(track, times, spline.rates))
}

/// Rate between the edges of a counted displacement.
fn edge_track(track: &Track, options: &ExtractOptions) -> Option<Track> {
    let quantum = track.quantum?;
    let end = *track.times.last()?;
    let found = edges(&track.times, &track.values, options.count_times);
    let rate = edge_rate(&found, options.edge_window, quantum, end);
    (rate.times.len() >= 3).then(|| rate_of(track, rate.times, rate.values))
}
