//! A position that moves farther between two samples than anything can.

use crate::encoder::edge_rate::{CountTimes, edges};
use crate::finding::Finding;
use crate::linear_fit::linear_fit;
use crate::track::{Track, mean_interval};
use windfall_numerics::cholesky::SINGULAR;
use windfall_numerics::fast::fast;

/// Steps on either side with which each is compared.
const NEIGHBOURS: usize = 10;

/// A jump is this many times what the speed around it explains; 1.
const FACTOR: f64 = 3.0;

/// … and more than that by this many counts, or by this many deviations of the noise.
const COUNTS: f64 = 1.5;
const CLEAR: f64 = 8.0;

/// Noise of a counted position, at most, in steps; the steps alone leave 0.29; 1.
const ROUNDED: f64 = 0.5;

/// Points on either side of a small jump, at least and at most.
const POINTS: (usize, usize) = (8, 16);

/// These points lie within this part of the contact's duration; 1.
const NEAR: f64 = 0.12;

/// A small jump is at least as long as the way in this many sampling intervals: the rows that
/// are missing.
const ROWS: f64 = 3.0;

/// A step below this part of the least needs no fit that agrees to the last digit; 1.
const NEARLY: f64 = 0.99;

/// The largest jump of a position in a span of time: rows are missing there, or counts.
///
/// A single sample that departs and comes back is none: it has a neighbour of its own size.
///
/// * `duration`: of the contact; s
pub(crate) fn jump(track: &Track, (from, until): (f64, f64), duration: f64) -> Option<Finding> {
    let first = track.times.partition_point(|&t| t < from);
    let last = track.times.partition_point(|&t| t <= until).max(first);
    let (times, values) = (&track.times[first..last], &track.values[first..last]);
    let (time, size) =
        lonely_step(track, times, values).or_else(|| small_jump(track, times, values, duration))?;
    Some(Finding::GapInContact {
        channel: track.name.clone(),
        time,
        size,
    })
}

/// Time and size of the largest step between two samples that is far larger than its
/// neighbours; s, m.
fn lonely_step(track: &Track, times: &[f64], values: &[f64]) -> Option<(f64, f64)> {
    let steps: Vec<f64> = values.windows(2).map(|x| (x[1] - x[0]).abs()).collect();
    let least = match counted(track) {
        Some(quantum) => COUNTS * quantum,
        None => CLEAR * track.noise,
    };
    let excess = |i: usize| {
        if steps[i] <= least {
            return None;
        }
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
    Some((times[at], steps[at]))
}

/// Step of a position that is counted; `None` where its noise drowns the steps, as those of
/// a printed decimal.
fn counted(track: &Track) -> Option<f64> {
    track
        .quantum
        .filter(|quantum| track.noise < ROUNDED * quantum)
}

/// Time and size of the clearest step in a motion that is smooth on either side, with a change
/// of velocity at it: the motion went on while nothing was recorded; s, m. A counted position
/// is taken where its count changes.
fn small_jump(track: &Track, times: &[f64], values: &[f64], duration: f64) -> Option<(f64, f64)> {
    counted(track)?;
    let found = edges(times, values, CountTimes::Sampled);
    let (points, places) = (&found.times, &found.values);
    let interval = mean_interval(times);
    let clearest = (0..points.len().saturating_sub(1)).filter_map(|i| {
        let at = 0.5 * (points[i] + points[i + 1]);
        let near = |t: f64| (t - at).abs() <= NEAR * duration;
        let begin = (i + 1).saturating_sub(POINTS.1);
        let end = (i + 1 + POINTS.1).min(points.len());
        let begin = begin + points[begin..=i].iter().take_while(|t| !near(**t)).count();
        let end = end
            - points[i + 1..end]
                .iter()
                .rev()
                .take_while(|t| !near(**t))
                .count();
        if i + 1 - begin < POINTS.0 || end - i - 1 < POINTS.0 {
            return None;
        }
        let speed = (places[end - 1] - places[begin]).abs() / (points[end - 1] - points[begin]);
        let least = ROWS * speed * interval;
        let (times, values) = (&points[begin..end], &places[begin..end]);
        let place = |t: f64| (t - at) / (NEAR * duration);
        let step = fast(
            #[inline(always)]
            || step_between(times, values, i + 1 - begin, place),
        );
        if step.is_some_and(|size| size.abs() < NEARLY * least) {
            return None;
        }
        let fit = linear_fit(times, values, |t| {
            let u = place(t);
            let after = f64::from(u8::from(u > 0.0));
            [1.0, u, u * u, u * u * u, after, after * u]
        })?;
        let (size, sd) = (fit.coefficients[4].abs(), fit.deviations[4]);
        (size > least && size > CLEAR * sd).then_some((at, size, size / sd))
    });
    let (at, size, _) = clearest.max_by(|a, b| a.2.total_cmp(&b.2))?;
    Some((at, size))
}

/// The step alone of the fit in [`small_jump`], from moments: most places are none, and need
/// no uncertainty. `None` where the functions depend on each other.
///
/// * `before`: points before the step
/// * `place`: u of a time
#[inline(always)]
fn step_between(
    times: &[f64],
    values: &[f64],
    before: usize,
    place: impl Fn(f64) -> f64,
) -> Option<f64> {
    // Σ uᵖ and Σ uᵖ y of either side, y from the first point on.
    let side = |times: &[f64], own: &[f64]| {
        let (mut powers, mut moments) = ([0.0; 7], [0.0; 4]);
        for (time, value) in times.iter().zip(own) {
            let (u, y) = (place(*time), value - values[0]);
            let square = u * u;
            let of = [1.0, u, square, square * u];
            for p in 0..4 {
                powers[p] += of[p];
                moments[p] += of[p] * y;
            }
            for p in 0..3 {
                powers[4 + p] += of[1 + p] * of[3];
            }
        }
        (powers, moments)
    };
    let (left, left_moments) = side(&times[..before], &values[..before]);
    let (right, right_moments) = side(&times[before..], &values[before..]);
    let power = |j: usize| if j < 4 { j } else { j - 4 };
    let entry = |i: usize, j: usize| {
        let p = power(i) + power(j);
        right[p] + if i.max(j) < 4 { left[p] } else { 0.0 }
    };
    // L D Lᵀ x = b, of which x₅ and x₄ come first.
    let (mut lower, mut inverse, mut x) = ([[0.0; 6]; 6], [0.0; 6], [0.0; 6]);
    for i in 0..6 {
        let mut scaled = [0.0; 6];
        let mut pivot = entry(i, i);
        x[i] = right_moments[power(i)] + if i < 4 { left_moments[i] } else { 0.0 };
        for j in 0..i {
            scaled[j] = entry(i, j);
            for k in 0..j {
                scaled[j] -= scaled[k] * lower[j][k];
            }
            lower[i][j] = scaled[j] * inverse[j];
            pivot -= scaled[j] * lower[i][j];
            x[i] -= lower[i][j] * x[j];
        }
        if pivot.is_nan() || pivot <= SINGULAR * entry(i, i) {
            return None;
        }
        inverse[i] = pivot.recip();
    }
    Some(x[4] * inverse[4] - lower[5][4] * x[5] * inverse[5])
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
        assert_eq!(jump(&track(0..0, 0.0), SPAN, 5e-3), None);
        assert_eq!(jump(&track(0..0, 3e-4), SPAN, 5e-3), None);
        let Some(Finding::GapInContact { time, size, .. }) =
            jump(&track(200..250, 0.0), SPAN, 5e-3)
        else {
            panic!("no jump")
        };
        // 50 rows at 7e-4 π/1000 cos(0.225 π) m each.
        assert!((time - 199.0 * 5e-6).abs() < 1e-9);
        assert!((size - 8.36e-5).abs() < 1e-5, "{size}");
    }

    #[test]
    fn closed_form_noise_above_the_printed_decimals_is_no_jump() {
        for seed in 0..20 {
            let mut source = crate::noise::gaussian::noise_source(seed, 0);
            let mut noisy = track(0..0, 0.0);
            for (i, value) in noisy.values.iter_mut().enumerate() {
                let place = 7e-4 * (i as f64 / 1000.0 * std::f64::consts::PI).sin();
                let read = place + 1e-6 * crate::noise::gaussian::normal(&mut source);
                *value = (read / 1e-7).round() * 1e-7;
            }
            (noisy.quantum, noisy.noise) = (Some(1e-7), 1e-6);
            assert_eq!(jump(&noisy, SPAN, 5e-3), None, "{seed}");
        }
    }

    /// Both ways to the step of the same least squares.
    #[test]
    fn closed_form_step_from_moments_is_that_of_the_fit() {
        let times: Vec<f64> = (0..24)
            .map(|i| 0.2 + 0.01 * f64::from(i * i % 7 + 7 * i))
            .collect();
        let value = |i: usize, t: &f64| 3.0 + 2.0 * t - t * t + 0.01 * (7.0 * t + i as f64).sin();
        let mut values: Vec<f64> = times.iter().enumerate().map(|(i, t)| value(i, t)).collect();
        values[11..].iter_mut().for_each(|value| *value += 0.05);
        let place = |t: f64| t - 0.5 * (times[10] + times[11]);
        let found = step_between(&times, &values, 11, place).unwrap();
        let fit = linear_fit(&times, &values, |t| {
            let u = place(t);
            let after = f64::from(u8::from(u > 0.0));
            [1.0, u, u * u, u * u * u, after, after * u]
        });
        let expected = fit.unwrap().coefficients[4];
        assert!((found / expected - 1.0).abs() < 1e-9 && (found - 0.05).abs() < 0.03);
    }

    #[test]
    fn closed_form_few_rows_that_are_lost() {
        // Eight rows, on the way in and out: 8 times 7e-4 π/1000 cos(0.2 π) m.
        for lost in [200..208, 792..800] {
            let at = 5e-6 * lost.start as f64;
            let Some(Finding::GapInContact { time, size, .. }) =
                jump(&track(lost, 0.0), SPAN, 5e-3)
            else {
                panic!("no jump")
            };
            assert!((time - at).abs() < 5e-5, "{time}");
            assert!((size - 1.42e-5).abs() < 3e-6, "{size}");
        }
    }
}
