//! The samples before a contact that tell the zero of a force.

use crate::noise::estimate::median_of;
use crate::polynomial::fit_polynomial;
use crate::trigger::scale::GAUSSIAN_OVER_MEDIAN;
use std::f64::consts::SQRT_2;
use std::ops::Range;

/// A zero is level if it changes by less than this part of the largest force; 1.
pub(crate) const LEVEL: f64 = 0.01;

/// … or by no more than this many standard deviations of the change; 1.
const EXPLAINED: f64 = 4.0;

/// Means of the samples through which the line goes that tells whether they are level.
const BLOCKS: usize = 50;

/// Fewest samples of a part of what lies before contact.
const LEAST: usize = 5;

/// Such a part lasts at least this part of the rise of the contact: a shorter one could be its
/// begin, which looks level if one looks briefly enough; 1.
const LEAST_OF_RISE: f64 = 0.25;

/// A zero that is told from a part of what lies before contact has nothing below it by more
/// than this part of the largest force, anywhere: else it is a load that was taken off. Nor
/// does a zero wander as far; 1.
const BELOW: f64 = 0.2;

/// Most parts whose means tell how far a zero wanders.
const PARTS: usize = 8;

/// Ratio of a standard deviation to that of Gaussian noise of the same median magnitude from
/// which it is contacts, not noise, that it shows; 1.
const CONTACTS_AMONG: f64 = 2.0;

/// Of the `before` samples before contact those that are level: all of them, or else the last
/// half, quarter … of them, as few as lie on a zero that drifts slowly. None where even the
/// shortest rises, or where the signal later goes far below: they are in contact and tell
/// nothing about the zero.
///
/// * `largest`: force above zero, of its sign; N
/// * `rise`: time from the begin of the contact to its largest force, about; s
pub(crate) fn quiet_stretch(
    times: &[f64],
    values: &[f64],
    before: usize,
    (largest, rise): (f64, f64),
) -> Range<usize> {
    let mut start = 0;
    while before > start {
        let part = start..before;
        let lasts = times[before - 1] - times[start];
        if start > 0 && (part.len() < LEAST || lasts < LEAST_OF_RISE * rise) {
            break;
        }
        if is_level(&times[part.clone()], &values[part.clone()], largest.abs()) {
            let level = values[part.clone()].iter().sum::<f64>() / part.len() as f64;
            let below = |v: &f64| largest.signum() * (level - v) > BELOW * largest.abs();
            let loaded = start > 0 && values.iter().filter(|v| below(v)).count() > LEAST;
            return if loaded { before..before } else { part };
        }
        start = before - part.len() / 2;
    }
    before..before
}

/// Whether a straight line through the samples changes by little, or by no more than noise does.
///
/// Of many samples the line goes through the means of [`BLOCKS`] blocks. How far one such mean
/// is from the next tells their noise, that which persists from sample to sample included, and
/// hardly knows of a zero that moves slowly or of a few blocks that hold a contact.
fn is_level(times: &[f64], values: &[f64], largest: f64) -> bool {
    let block = (values.len() / BLOCKS).max(1);
    let means = |samples: &[f64]| -> Vec<f64> {
        let blocks = samples.chunks_exact(block);
        blocks
            .map(|own| own.iter().sum::<f64>() / block as f64)
            .collect()
    };
    let (at, level) = (means(times), means(values));
    let Some(fit) = fit_polynomial(&at, &level, times[0], 1) else {
        return true;
    };
    let sd = match block {
        1 => fit.standard_deviations[1],
        _ => {
            let apart = level.windows(2).map(|pair| (pair[1] - pair[0]).abs());
            let noise = GAUSSIAN_OVER_MEDIAN * median_of(apart).unwrap_or(0.0) / SQRT_2;
            // Of the slope of a line through evenly spaced points.
            noise * (12.0 / level.len() as f64).sqrt() / (at[at.len() - 1] - at[0])
        }
    };
    let duration = times[times.len() - 1] - times[0];
    let change = (fit.derivatives[1] * duration).abs();
    change <= LEVEL * largest || change.is_nan() || change <= EXPLAINED * sd * duration
}

/// How far the zero goes, one deviation, in as long as the quiet stretch lasts: root mean square
/// of the differences of means of such stretches, of those before it too, back to a load. Zero
/// where all before contact is one quiet stretch.
pub(crate) fn wander(values: &[f64], quiet: &Range<usize>, largest: f64) -> f64 {
    if quiet.is_empty() || quiet.start < quiet.len() {
        return 0.0;
    }
    let own = values[quiet.clone()].iter().sum::<f64>() / quiet.len() as f64;
    let parts = values[..quiet.end].rchunks_exact(quiet.len()).take(PARTS);
    let means: Vec<f64> = parts
        .map(|part| part.iter().sum::<f64>() / part.len() as f64)
        .take_while(|mean| (mean - own).abs() <= BELOW * largest)
        .collect();
    let square: f64 = means.windows(2).map(|m| (m[1] - m[0]).powi(2)).sum();
    (square / means.len().saturating_sub(1).max(1) as f64).sqrt()
}

/// Standard deviation of a baseline; where contacts are among it, of what most samples do.
///
/// * `found`: their mean and deviation as a baseline
pub(crate) fn usual_deviation(values: &[f64], found: Option<(f64, f64)>) -> Option<f64> {
    let (centre, seen) = found?;
    let apart = values.iter().map(|v| (v - centre).abs());
    let usual = GAUSSIAN_OVER_MEDIAN * median_of(apart)?;
    // None of most samples: they are steps of a converter.
    Some(match usual > 0.0 && seen > CONTACTS_AMONG * usual {
        true => usual,
        false => seen,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(count: usize, value: impl Fn(f64) -> f64) -> (Vec<f64>, Vec<f64>) {
        let times: Vec<f64> = (0..count).map(|i| 0.01 * i as f64).collect();
        let values = times.iter().map(|t| value(*t)).collect();
        (times, values)
    }

    #[test]
    fn closed_form_the_last_part_of_a_slow_drift() {
        // 0.08 N/s before 5 N: 0.05 N are 0.625 s, and 3.2 s halve to 0.4 s.
        let (times, values) = at(320, |t| 0.08 * t);
        let quiet = quiet_stretch(&times, &values, 320, (5.0, 0.1));
        assert_eq!(quiet, 280..320);
        // Means of stretches of 0.4 s differ by 0.032 N.
        assert!((wander(&values, &quiet, 5.0) - 0.032).abs() < 1e-9);
        // Where a load of 3 N lies before it, nothing is known.
        let loaded: Vec<f64> = values
            .iter()
            .enumerate()
            .map(|(i, v)| if i < 280 { v + 3.0 } else { *v })
            .collect();
        assert_eq!(wander(&loaded, &quiet, 5.0), 0.0);
    }

    #[test]
    fn closed_form_a_level_zero_is_used_whole() {
        let (times, values) = at(320, |_| -1.1);
        let quiet = quiet_stretch(&times, &values, 320, (4.5, 0.1));
        assert_eq!(quiet, 0..320);
        assert_eq!(wander(&values, &quiet, 4.5), 0.0);
    }

    #[test]
    fn rejects_a_load_that_is_taken_off_as_a_zero() {
        // Stands for 2 s, swaying, flies, lands.
        let (times, values) = at(400, |t| match t {
            ..2.0 => 700.0 + 30.0 * t,
            2.0..2.5 => 0.0,
            _ => 1500.0,
        });
        assert!(quiet_stretch(&times, &values, 200, (800.0, 0.2)).is_empty());
    }

    #[test]
    fn rejects_the_begin_of_a_contact_as_a_zero() {
        // The first tenth of a rise of 1 s, and the same as a tail of few samples.
        let (times, values) = at(10, |t| 30.0 * t.powf(1.5));
        assert!(quiet_stretch(&times, &values, 10, (30.0, 1.0)).is_empty());
        let (times, values) = at(90, |t| 30.0 * (0.1 + t).powf(1.5));
        assert!(quiet_stretch(&times, &values, 30, (30.0, 1.0)).is_empty());
    }
}
