//! A counted displacement at the instants where its count changes.
//!
//! Between changes an encoder adds no information: its error is a sawtooth, neither
//! small nor independent from sample to sample. Where the count changes, the
//! displacement is known exactly, at a time known to one sampling interval Δt:
//! an error of displacement uniform over v Δt, independent from edge to edge.
//!
//! A line that lies beside its place is passed twice, on the way in and out, with one error.

use crate::samples::EdgeError;
use std::collections::HashMap;
use windfall_signal::encoder::edge_rate::{CountTimes, edges};
use windfall_signal::impact::Series;

/// Fewest edges that replace the samples.
const LEAST_EDGES: usize = 4;
/// More edges than this part of the samples, and several counts pass between
/// samples: then each sample is rounded by itself; 1.
const MOST_EDGES: f64 = 0.5;
/// More changes of direction than this part of the edges, and noise moves the
/// count to and fro; 1.
const MOST_REVERSALS: f64 = 0.2;
/// Steps longer than this many counts are no single ones.
const SINGLE: f64 = 1.5;
/// Share of the steps that must be single; 1.
const MOSTLY: f64 = 0.9;
/// Lines of an encoder are no more accurate than this part of a count: where the impactor
/// turns around, it accelerates by about as much between two readings; 1.
pub(crate) const LINE_ACCURACY: f64 = 0.005;
/// Steps in which the jitter settles.
const JITTER_STEPS: usize = 10;

/// Displacements at the changes of a count.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct EdgeSamples {
    /// Times; s on the clock of the series.
    pub times: Vec<f64>,
    /// Displacements; m.
    pub values: Vec<f64>,
    /// Sampling interval around each; s.
    pub intervals: Vec<f64>,
    /// Velocity there by the neighbouring edges; m/s.
    pub velocities: Vec<f64>,
    /// Whether the same line is passed a second time.
    pub repeated: Vec<bool>,
    /// Length of a count; m.
    pub quantum: f64,
}

/// The edges of a displacement, if it is counted and they hold all its information.
pub(crate) fn edge_samples(series: &Series) -> Option<EdgeSamples> {
    let quantum = series.quantum?;
    let (times, values) = (&series.times, &series.values);
    let found = edges(times, values, CountTimes::Sampled);
    let count = found.times.len();
    if count < LEAST_EDGES || count as f64 > MOST_EDGES * times.len() as f64 {
        return None;
    }
    let steps: Vec<(f64, f64)> = (1..times.len())
        .filter(|&i| values[i] != values[i - 1])
        .map(|i| (values[i] - values[i - 1], times[i] - times[i - 1]))
        .collect();
    let share = |n: usize| n as f64 / count as f64;
    let single = steps
        .iter()
        .filter(|s| s.0.abs() < SINGLE * quantum)
        .count();
    let reversals = steps.windows(2).filter(|w| w[0].0 * w[1].0 < 0.0).count();
    if share(single) < MOSTLY || share(reversals) > MOST_REVERSALS {
        return None;
    }
    let velocities = (0..count)
        .map(|i| {
            let (from, to) = (i.saturating_sub(1), (i + 1).min(count - 1));
            let span = found.times[to] - found.times[from];
            (found.values[to] - found.values[from]) / span
        })
        .collect();
    let line = |value: f64| (2.0 * value / quantum).round() as i64;
    let mut passes: HashMap<i64, u32> = HashMap::new();
    for value in &found.values {
        *passes.entry(line(*value)).or_default() += 1;
    }
    let repeated = found.values.iter().map(|value| passes[&line(*value)] > 1);
    Some(EdgeSamples {
        repeated: repeated.collect(),
        times: found.times,
        values: found.values,
        intervals: steps.iter().map(|s| s.1).collect(),
        velocities,
        quantum,
    })
}

impl EdgeSamples {
    /// Variance of each displacement: that of its time, and `jitter`²; m².
    pub(crate) fn variances(&self, velocities: &[f64], jitter: f64) -> Vec<f64> {
        let jitter = jitter.max(LINE_ACCURACY * self.quantum);
        let timed = self.timing_variances(velocities);
        timed.map(|variance| variance + jitter * jitter).collect()
    }

    /// The same where lines have errors of their own, of which two passes share one: no
    /// combination of the edges has more, since for a pair of variance τ² each
    /// (τ² + 2j²) 1 − [τ² + j², j²; j², τ² + j²] is positive semidefinite.
    pub(crate) fn variances_of_lines(&self, velocities: &[f64], jitter: f64) -> Vec<f64> {
        let square = jitter.max(LINE_ACCURACY * self.quantum).powi(2);
        let once = self.variances(velocities, jitter).into_iter();
        once.zip(&self.repeated)
            .map(|(variance, again)| variance + if *again { square } else { 0.0 })
            .collect()
    }

    /// Root mean square error of an edge by its time alone; m.
    pub(crate) fn typical_deviation(&self) -> f64 {
        let variances = self.variances(&self.velocities, 0.0);
        (variances.iter().sum::<f64>() / variances.len() as f64).sqrt()
    }

    /// What is not known of each displacement, where it has these variances in all; m².
    ///
    /// * `velocities`: velocity at each edge, signed; m/s
    pub(crate) fn errors(&self, velocities: &[f64], variances: &[f64]) -> Vec<EdgeError> {
        let moved = velocities.iter().zip(&self.intervals).zip(variances);
        moved
            .map(|((speed, interval), variance)| {
                let span = speed * interval;
                let beyond = (variance - span * span / 12.0).max(0.0);
                EdgeError { span, beyond }
            })
            .collect()
    }

    fn timing_variances<'a>(&'a self, velocities: &'a [f64]) -> impl Iterator<Item = f64> + 'a {
        let pairs = velocities.iter().zip(&self.intervals);
        pairs.map(|(speed, interval)| (speed * interval).powi(2) / 12.0)
    }

    /// Standard deviation of what the residuals have beyond the timing; m. Maximum likelihood of
    /// normal errors: slow edges, whose time hardly matters, say most.
    pub(crate) fn jitter(&self, residuals: &[f64], velocities: &[f64], parameters: usize) -> f64 {
        let count = residuals.len();
        let freedom = count as f64 / count.saturating_sub(parameters).max(1) as f64;
        let floor = (LINE_ACCURACY * self.quantum).powi(2);
        let timed: Vec<f64> = self.timing_variances(velocities).collect();
        let mut jitter = floor;
        for _ in 0..JITTER_STEPS {
            let (mut beyond, mut total) = (0.0, 0.0);
            for (residual, timed) in residuals.iter().zip(&timed) {
                let weight = (timed + jitter).powi(-2);
                beyond += weight * (freedom * residual * residual - timed);
                total += weight;
            }
            jitter = (beyond / total).max(floor);
        }
        jitter.sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use windfall_signal::noise::gaussian::{noise_source, normal, uniform};

    fn counted(speed: f64, interval: f64, quantum: f64, samples: usize, phase: f64) -> Series {
        let times: Vec<f64> = (0..samples).map(|i| i as f64 * interval).collect();
        let values = times
            .iter()
            .map(|t| ((speed * t / quantum + phase).floor() - phase) * quantum)
            .collect();
        Series {
            times,
            values,
            quantum: Some(quantum),
            ..Series::default()
        }
    }

    /// Uniform motion: the edge lies midway between two counts, where the true
    /// displacement departs by a uniform error of v Δt.
    #[test]
    fn closed_form_error_of_an_edge() {
        let (speed, interval, quantum) = (0.31, 5e-6, 8.8e-6);
        let (mut square, mut count) = (0.0, 0);
        let mut source = noise_source(1, 0);
        for _ in 0..200 {
            let phase = uniform(&mut source);
            let series = counted(speed, interval, quantum, 600, phase);
            let edges = edge_samples(&series).unwrap();
            for (time, value) in edges.times.iter().zip(&edges.values) {
                // Half a count: a floor is half a count low on average.
                square += (speed * time - value - 0.5 * quantum).powi(2);
                count += 1;
            }
            let told =
                edges.variances(&edges.velocities, 0.0)[20] - (LINE_ACCURACY * quantum).powi(2);
            let expected = (speed * interval).powi(2) / 12.0;
            assert!((told / expected - 1.0).abs() < 0.2, "{told} {expected}");
        }
        let ratio = square / f64::from(count) / ((speed * interval).powi(2) / 12.0);
        assert!((ratio - 1.0).abs() < 0.05, "{ratio}");
    }

    /// Ten lines in, the same ten out, and two beyond: an error of the lines counts twice
    /// where they are passed twice.
    #[test]
    fn closed_form_lines_that_are_passed_twice() {
        let position = |i: i32| f64::from(if i < 105 { i } else { 210 - i }) / 10.0;
        let values = (0..230).map(|i| position(i).floor() * 1e-5).collect();
        let series = Series {
            times: (0..230).map(|i| 5e-6 * f64::from(i)).collect(),
            values,
            quantum: Some(1e-5),
            ..Series::default()
        };
        let edges = edge_samples(&series).unwrap();
        assert_eq!(edges.repeated.iter().filter(|again| **again).count(), 20);
        let jitter = 3e-7;
        let once = edges.variances(&edges.velocities, jitter);
        let shared = edges.variances_of_lines(&edges.velocities, jitter);
        for (i, again) in edges.repeated.iter().enumerate() {
            let more = if *again { jitter * jitter } else { 0.0 };
            assert!((shared[i] - once[i] - more).abs() < 1e-20, "{i}");
        }
    }

    /// Errors of lines of 0.05 counts beside timing errors that are larger where the motion is
    /// fast, over 20 draws; none is told where there is none.
    #[test]
    fn recovers_the_jitter_of_lines() {
        let (interval, quantum, count) = (5e-6, 8.8e-6, 400);
        let velocities: Vec<f64> = (0..count)
            .map(|i| 0.4 - 2e-3 * f64::from(i))
            .filter(|v| *v != 0.0)
            .collect();
        let edges = EdgeSamples {
            times: vec![0.0; velocities.len()],
            values: vec![0.0; velocities.len()],
            intervals: vec![interval; velocities.len()],
            repeated: vec![false; velocities.len()],
            velocities: velocities.clone(),
            quantum,
        };
        let told = |jitter: f64, seed: u64| {
            let mut source = noise_source(seed, 0);
            let errors = velocities.iter().map(|v| {
                let timed = v * interval * (uniform(&mut source) - 0.5);
                timed + jitter * normal(&mut source)
            });
            let errors: Vec<f64> = errors.collect();
            edges.jitter(&errors, &velocities, 0)
        };
        let mean = |jitter: f64| (0..20).map(|seed| told(jitter, seed)).sum::<f64>() / 20.0;
        let found = mean(0.05 * quantum) / quantum;
        assert!((found / 0.05 - 1.0).abs() < 0.05, "{found}");
        let none = mean(0.0) / quantum;
        assert!(none < 1.5 * LINE_ACCURACY, "{none}");
    }

    #[test]
    fn rejects_samples_that_are_rounded_one_by_one() {
        // Three counts pass between samples.
        assert!(edge_samples(&counted(0.3, 1e-4, 1e-5, 300, 0.2)).is_none());
        assert!(edge_samples(&counted(0.3, 5e-6, 1e-5, 10, 0.2)).is_none());
        let smooth = Series {
            quantum: None,
            ..counted(0.3, 5e-6, 1e-5, 600, 0.2)
        };
        assert!(edge_samples(&smooth).is_none());
    }
}
