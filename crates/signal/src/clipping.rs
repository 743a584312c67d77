//! A signal that stays at the limit of its instrument.

use crate::finding::Finding;
use crate::polynomial::fit_polynomial;

/// Fewest successive samples at the largest value.
const LEAST_SUCCESSIVE: usize = 3;

/// Fewest samples on either side that are continued over the top.
const LEAST_FLANK: usize = 4;

/// The flanks must extrapolate above the limit by more than this part of it; 1.
const EXCESS: f64 = 0.02;

/// … and by more than this many standard deviations of the continuation; 1.
const SIGNIFICANT: f64 = 3.0;

/// Clipping of a signal in a contact: successive samples at the largest value,
/// above which a parabola through the samples on both sides would rise.
///
/// The rounded top of a quantised signal stays on one value too; its flanks
/// continue to that value and no further.
///
/// * `window`: onset and end of the contact; s
/// * `negative`: true if the signal is negative in contact
pub fn clipping(
    name: &str,
    times: &[f64],
    values: &[f64],
    window: (f64, f64),
    negative: bool,
) -> Option<Finding> {
    let first = times.partition_point(|&t| t < window.0);
    let last = times.partition_point(|&t| t <= window.1);
    let sign = if negative { -1.0 } else { 1.0 };
    let limit = values[first..last]
        .iter()
        .copied()
        .reduce(|a, b| if sign * b > sign * a { b } else { a })?;
    let (from, to) = longest_run(values, first, last, limit);
    let length = to - from;
    if length < LEAST_SUCCESSIVE {
        return None;
    }

    // The flanks, without the plateau.
    let flank = (length / 3).max(LEAST_FLANK);
    let left = from.saturating_sub(flank).max(first)..from;
    let right = to..(to + flank).min(last);
    let flank_times = [&times[left.clone()], &times[right.clone()]].concat();
    let flank_values = [&values[left], &values[right]].concat();
    let middle = 0.5 * (times[from] + times[to - 1]);
    let fit = fit_polynomial(&flank_times, &flank_values, middle, 2)?;
    let excess = sign * (fit.derivatives[0] - limit);
    let spread = fit.standard_deviations[0];
    let clipped = excess > EXCESS * limit.abs() && excess > SIGNIFICANT * spread;
    clipped.then(|| Finding::Clipped {
        channel: name.to_owned(),
        value: limit,
        samples: length,
        from: times[from],
        to: times[to - 1],
    })
}

/// The longest run of `limit` within `first..last`, as a range.
fn longest_run(values: &[f64], first: usize, last: usize, limit: f64) -> (usize, usize) {
    let mut longest = (first, first);
    let mut begin = first;
    for (i, &value) in values.iter().enumerate().take(last).skip(first) {
        if value != limit {
            begin = i + 1;
        } else if i + 1 - begin > longest.1 - longest.0 {
            longest = (begin, i + 1);
        }
    }
    longest
}

#[cfg(test)]
mod tests {
    use super::*;

    fn half_sine(limit: f64, step: f64) -> (Vec<f64>, Vec<f64>) {
        let times: Vec<f64> = (0..121).map(|i| f64::from(i) * 5e-5).collect();
        let values = times
            .iter()
            .map(|t| 30.0 * (t / 6e-3 * std::f64::consts::PI).sin())
            .map(|f| ((f / step).round() * step).min(limit))
            .collect();
        (times, values)
    }

    #[test]
    fn closed_form_half_sine_clipped_at_half() {
        // sin is above 1/2 from T/6 to 5T/6: samples 20 to 100.
        let (times, values) = half_sine(15.0, 1e-6);
        let found = clipping("F", &times, &values, (0.0, 6e-3), false);
        let Some(Finding::Clipped {
            value,
            samples,
            from,
            to,
            ..
        }) = found
        else {
            panic!("{found:?}")
        };
        assert_eq!((value, samples), (15.0, 81));
        assert!((from - 1e-3).abs() < 1e-9 && (to - 5e-3).abs() < 1e-9);
    }

    #[test]
    fn closed_form_a_rounded_quantised_top_is_not_clipped() {
        for step in [0.01, 0.1, 1.0] {
            let (times, values) = half_sine(1e9, step);
            assert_eq!(
                clipping("F", &times, &values, (0.0, 6e-3), false),
                None,
                "{step}"
            );
            let negative: Vec<f64> = values.iter().map(|v| -v).collect();
            assert_eq!(clipping("F", &times, &negative, (0.0, 6e-3), true), None);
        }
    }
}
