//! Displacement rate from the times at which an encoder's count changes.

use serde::Serialize;

/// What the time beside a count means.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum CountTimes {
    /// The count was looked at then: it changed since the sample before.
    #[default]
    Sampled,
    /// The count changed then.
    Events,
}

/// Where a count changed: the displacement is exact, the time known to half an interval.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Edges {
    /// Times of the edges; s.
    pub times: Vec<f64>,
    /// Displacement at the edges: midway between the two counts; m (or counts).
    pub values: Vec<f64>,
}

/// Displacement rate between edges.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct EdgeRate {
    /// Times midway between edges; s.
    pub times: Vec<f64>,
    /// Rates there; m/s.
    pub values: Vec<f64>,
    /// Largest mean speed after the last edge; m/s. `None` without any edge.
    pub bound_after: Option<f64>,
}

/// The edges of a counted displacement.
///
/// Sampled counts change between two samples: the edge is put midway. Where each
/// time is that of an event, the count changed at the time itself.
///
/// A step of several counts within one interval is one edge, at its middle.
pub fn edges(times: &[f64], values: &[f64], count_times: CountTimes) -> Edges {
    let mut edges = Edges::default();
    for i in 1..times.len().min(values.len()) {
        if values[i] == values[i - 1] {
            continue;
        }
        edges.times.push(match count_times {
            CountTimes::Events => times[i],
            CountTimes::Sampled => 0.5 * (times[i - 1] + times[i]),
        });
        edges.values.push(0.5 * (values[i - 1] + values[i]));
    }
    edges
}

/// Rate between edges, v = Δx/(t_j − t_i), at the middle of each pair; 0 at a reversal.
///
/// * `window`: j is the first edge at least this long after i; s. 0: the next one.
///   The times of two edges are each known to a sampling interval; over a longer
///   time that matters less.
/// * `quantum`: length of a count; m
/// * `end`: when the recording ended; s
pub fn edge_rate(edges: &Edges, window: f64, quantum: f64, end: f64) -> EdgeRate {
    let (mut times, mut values) = (Vec::new(), Vec::new());
    let mut j = 0;
    for (i, (&from, &first)) in edges.times.iter().zip(&edges.values).enumerate() {
        j = j.max(i + 1);
        while j < edges.times.len() && (edges.times[j] - from < window || edges.times[j] <= from) {
            j += 1;
        }
        let Some((&to, &second)) = edges.times.get(j).zip(edges.values.get(j)) else {
            break;
        };
        times.push(0.5 * (from + to));
        values.push((second - first) / (to - from));
    }
    let last = edges.times.last().copied();
    EdgeRate {
        times,
        values,
        bound_after: last
            .filter(|last| end > *last)
            .map(|last| quantum / (end - last)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn closed_form_constant_rate_and_reversal() {
        // 0.1 counts a sample up, then down: edges every ten samples.
        let triangle = |i: i32| f64::from(if i <= 505 { i } else { 1010 - i }) * 0.1;
        let times: Vec<f64> = (0..1011).map(|i| f64::from(i) * 1e-3).collect();
        let counts: Vec<f64> = (0..1011).map(|i| (triangle(i) + 1e-9).floor()).collect();
        let edges = edges(&times, &counts, CountTimes::Sampled);
        assert_eq!(edges.times.len(), 100);
        let rate = edge_rate(&edges, 0.0, 1.0, 1.01);
        // 100 counts a second up, zero at the reversal, down.
        for (time, value) in rate.times.iter().zip(&rate.values) {
            let expected = match time {
                t if *t < 0.5 => 100.0,
                t if *t > 0.511 => -100.0,
                _ => 0.0,
            };
            assert!((value - expected).abs() < 1e-6, "{time}: {value}");
        }
        assert!(rate.bound_after.unwrap() > 99.0);
    }

    #[test]
    fn closed_form_events_are_edges_themselves() {
        let edges = edges(&[0.0, 0.5, 0.7], &[3.0, 4.0, 5.0], CountTimes::Events);
        assert_eq!(
            (edges.times, edges.values),
            (vec![0.5, 0.7], vec![3.5, 4.5])
        );
    }
}
