//! A position that moves farther between two samples than anything can.

use crate::finding::Finding;
use crate::track::Track;

/// Steps on either side with which each is compared.
const NEIGHBOURS: usize = 10;

/// A jump is this many times what the speed around it explains; 1.
const FACTOR: f64 = 3.0;

/// … and more than that by this many counts, or by this many deviations of the noise.
const COUNTS: f64 = 1.5;
const CLEAR: f64 = 8.0;

/// The largest jump of a position in a span of time: rows are missing there, or counts.
///
/// A single sample that departs and comes back is none: it has a neighbour of its own size.
pub(crate) fn jump(track: &Track, (from, until): (f64, f64)) -> Option<Finding> {
    let first = track.times.partition_point(|&t| t < from);
    let last = track.times.partition_point(|&t| t <= until).max(first);
    let (times, values) = (&track.times[first..last], &track.values[first..last]);
    let steps: Vec<f64> = values.windows(2).map(|x| (x[1] - x[0]).abs()).collect();
    let least = match track.quantum {
        Some(quantum) => COUNTS * quantum,
        None => CLEAR * track.noise,
    };
    let excess = |i: usize| {
        let near = i.saturating_sub(NEIGHBOURS)..(i + NEIGHBOURS + 1).min(steps.len());
        let others = || near.clone().filter(|&j| j != i);
        let largest = others().map(|j| steps[j]).fold(0.0, f64::max);
        let way: f64 = others().map(|j| steps[j]).sum();
        let time: f64 = others().map(|j| times[j + 1] - times[j]).sum();
        let explained = way / time * (times[i + 1] - times[i]);
        let lonely = steps[i] > largest + least && steps[i] > FACTOR * explained;
        (near.len() > NEIGHBOURS && lonely).then(|| steps[i] - explained)
    };
    let jumps = (0..steps.len()).filter_map(|i| Some((i, excess(i)?)));
    let (at, _) = jumps
        .filter(|(_, excess)| *excess > least)
        .max_by(|a, b| a.1.total_cmp(&b.1))?;
    Some(Finding::GapInContact {
        channel: track.name.clone(),
        time: times[at],
        size: steps[at],
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A half sine of 600 samples in counts of 9 µm, less the rows of `lost`.
    fn track(lost: std::ops::Range<usize>, spike: f64) -> Track {
        let rows = (0..1000).filter(|row| !lost.contains(row));
        let place = |row: usize| 7e-4 * (row as f64 / 1000.0 * std::f64::consts::PI).sin();
        let mut values: Vec<f64> = rows.map(|row| (place(row) / 9e-6).floor() * 9e-6).collect();
        values[700] += spike;
        Track {
            name: "count".to_owned(),
            times: (0..values.len()).map(|i| 5e-6 * i as f64).collect(),
            values,
            quantum: Some(9e-6),
            noise: 9e-6 / 12f64.sqrt(),
            persistence: None,
        }
    }

    const SPAN: (f64, f64) = (0.0, 5e-3);

    #[test]
    fn closed_form_lost_rows_are_a_jump_and_a_glitch_is_none() {
        assert_eq!(jump(&track(0..0, 0.0), SPAN), None);
        assert_eq!(jump(&track(0..0, 3e-4), SPAN), None);
        let Some(Finding::GapInContact { time, size, .. }) = jump(&track(200..250, 0.0), SPAN)
        else {
            panic!("no jump")
        };
        // 50 rows at 7e-4 π/1000 cos(0.225 π) m each.
        assert!((time - 199.0 * 5e-6).abs() < 1e-9);
        assert!((size - 8.36e-5).abs() < 1e-5, "{size}");
    }
}
