//! Displacement rate from the times at which an encoder's count changes.

/// Where a count changed: the displacement there is known exactly, the time to
/// half a sampling interval.
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
    /// After the last edge no count was passed until the recording ended: the
    /// speed there is below this, on average; m/s. `None` without any edge.
    pub bound_after: Option<f64>,
}

/// The edges of a counted displacement.
///
/// Sampled counts change between two samples: the edge is put midway. Where each
/// time is that of an event (`events`), the count changed at the time itself.
///
/// A step of several counts within one interval is one edge, at its middle.
#[must_use]
pub fn edges(times: &[f64], values: &[f64], events: bool) -> Edges {
    let mut edges = Edges::default();
    for i in 1..times.len().min(values.len()) {
        if values[i] == values[i - 1] {
            continue;
        }
        edges.times.push(match events {
            true => times[i],
            false => 0.5 * (times[i - 1] + times[i]),
        });
        edges.values.push(0.5 * (values[i - 1] + values[i]));
    }
    edges
}

/// Rate between successive edges, v = Δx/(t_i − t_{i−1}), at the middle of each
/// pair. At a reversal the same edge is passed twice, and the rate is zero.
///
/// * `quantum`: length of a count; m
/// * `end`: when the recording ended; s
#[must_use]
pub fn edge_rate(edges: &Edges, quantum: f64, end: f64) -> EdgeRate {
    let pairs = edges.times.windows(2).zip(edges.values.windows(2));
    let (times, values) = pairs
        .filter(|(t, _)| t[1] > t[0])
        .map(|(t, x)| (0.5 * (t[0] + t[1]), (x[1] - x[0]) / (t[1] - t[0])))
        .unzip();
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
        let edges = edges(&times, &counts, false);
        assert_eq!(edges.times.len(), 100);
        let rate = edge_rate(&edges, 1.0, 1.01);
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
        let edges = edges(&[0.0, 0.5, 0.7], &[3.0, 4.0, 5.0], true);
        assert_eq!(
            (edges.times, edges.values),
            (vec![0.5, 0.7], vec![3.5, 4.5])
        );
    }
}
