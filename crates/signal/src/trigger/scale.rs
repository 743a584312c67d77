//! How long a contact lasts and over what to average it, when noise hides it.

use crate::noise::estimate::median_of;
use std::ops::Range;

/// A pulse stands out if its averaged height is this many standard deviations
/// of the average; 1. So many that its half height is not crossed by chance
/// (the largest of 10⁶ samples of noise is about 5).
const CLEAR: f64 = 20.0;

/// The signal is averaged over this part of the contact at least; 1.
const SMOOTHING_SHARE: f64 = 0.02;

/// It is averaged over at most this part, beyond which the average blurs the
/// onset by more than it gains; 1.
const SMOOTHING_LIMIT: f64 = 0.2;

/// Part of the peak that the threshold from the noise is to stay below; 1.
pub const THRESHOLD_AIM: f64 = 0.1;

/// Times that an average is lengthened against noise.
const QUIETER: usize = 8;

/// Ratio of standard deviation to median magnitude of Gaussian noise; 1.
pub const GAUSSIAN_OVER_MEDIAN: f64 = 1.482_602_218_505_602;

/// Where the strongest pulse of a signal is and how to average it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PulseScale {
    /// Index of its top in the averaged signal.
    pub top: usize,
    /// True if it is negative.
    pub reversed: bool,
    /// Samples to average over; odd.
    pub smoothing: usize,
    /// False if no mean of any length departs from the centre by more than
    /// noise would.
    pub visible: bool,
}

/// The level that pulses are measured from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Level {
    /// Its value; unit of the signal.
    pub value: f64,
    /// Samples whose median it is.
    pub samples: usize,
}

/// The strongest pulse of a signal about a level.
///
/// The signal is averaged over ever more samples until its largest value stands
/// out of the noise. A half sine is above half its height for 2/3 of its
/// duration; the smoothing is 1/50 of that duration, or as much more, up to
/// 1/5, as brings `deviations` of the averaged noise down to 1/10 of the peak.
///
/// * `sums`: of the signal
/// * `noise`: standard deviation of a sample; unit of the signal
/// * `deviations`: standard deviations between noise and threshold; 1
pub fn pulse_scale(sums: &RunningSums, level: Level, noise: f64, deviations: f64) -> PulseScale {
    let (mut length, clear) = length_that_shows(sums, level, noise);
    let centre = level.value;
    let visible = clear >= deviations;
    if !visible {
        length = 1;
    }
    let mut top = 0;
    let mut reversed = false;
    // Noise cuts the stretch above half short, so it is looked for again in the
    // smoother signal.
    for pass in 0..3 {
        let smooth = sums.means(length);
        if pass == 0 {
            top = index_of_largest(&smooth, |v| (v - centre).abs());
            reversed = smooth[top] < centre;
        }
        let sign = if reversed { -1.0 } else { 1.0 };
        top = index_of_largest(&smooth, |v| sign * (v - centre));
        let (peak, duration) = height_and_duration(&smooth, top, centre, sign);
        // deviations · noise / √length ≤ aim · peak
        let quiet = (deviations * noise / (THRESHOLD_AIM * peak)).powi(2);
        let wanted = quiet.clamp(SMOOTHING_SHARE * duration, SMOOTHING_LIMIT * duration);
        length = (wanted as usize) | 1;
    }
    PulseScale {
        top,
        reversed,
        smoothing: length,
        visible,
    }
}

/// Height of the pulse at `top` and its duration in samples, as of a half sine that is above
/// half its height for as long.
fn height_and_duration(smooth: &[f64], top: usize, centre: f64, sign: f64) -> (f64, f64) {
    let peak = sign * (smooth[top] - centre);
    let above = |v: &&f64| sign * (**v - centre) >= 0.5 * peak;
    let after = smooth[top..].iter().take_while(above).count();
    let before = smooth[..top].iter().rev().take_while(above).count();
    (peak, 1.5 * (after + before) as f64)
}

/// Samples to average over so that the noise is no more than `wanted`, up to 1/5 of the
/// strongest pulse; no fewer than `smoothing`. A pulse that noise cuts into pieces is seen
/// whole as the average lengthens.
///
/// * `sums`: of the signal above its zero, positive in contact
/// * `noise`: of an average over how many samples
pub fn quieter(
    sums: &RunningSums,
    smoothing: usize,
    wanted: f64,
    noise: impl Fn(usize) -> f64,
) -> usize {
    let mut length = smoothing;
    for _ in 0..QUIETER {
        let now = noise(length);
        if now <= wanted {
            break;
        }
        let smooth = sums.means(length);
        let top = index_of_largest(&smooth, |v| v);
        let (_, duration) = height_and_duration(&smooth, top, 0.0, 1.0);
        let most = SMOOTHING_LIMIT * duration;
        let next = ((now / wanted).powi(2) * length as f64).min(most) as usize | 1;
        if next <= length {
            break;
        }
        length = next;
    }
    length
}

/// Standard deviation of white noise in a signal that is smooth otherwise, from
/// the median magnitude of its second differences: √6 times the noise.
///
/// Zero of fewer than 3 samples and of a signal that mostly does not change.
pub fn white_noise(values: &[f64]) -> f64 {
    let bends = values.windows(3);
    let bends = bends.map(|v| (v[0] - 2.0 * v[1] + v[2]).abs());
    median_of(bends).unwrap_or(0.0) * GAUSSIAN_OVER_MEDIAN / 6f64.sqrt()
}

/// The shortest length, doubled from 1, over which the largest mean is clear of
/// the noise, else the one over which it is clearest; and how many standard
/// deviations of mean and level that is.
fn length_that_shows(sums: &RunningSums, level: Level, noise: f64) -> (usize, f64) {
    let (mut length, mut best) = (1, (1, 0.0));
    while length <= (sums.values.len() / 4).max(1) {
        let smooth = sums.means(length);
        let largest = largest(&smooth, |v| (v - level.value).abs());
        // Variance of a mean, and of a median (π/2 times that of its mean).
        let median = std::f64::consts::FRAC_PI_2 / level.samples as f64;
        let clear = largest / (noise * (1.0 / length as f64 + median).sqrt());
        if clear.is_nan() || clear >= CLEAR {
            return (length, f64::INFINITY);
        }
        if clear > best.1 {
            best = (length, clear);
        }
        length = 2 * length + 1;
    }
    best
}

/// Largest `measure` of values; −∞ of none.
pub fn largest(values: &[f64], measure: impl Fn(f64) -> f64) -> f64 {
    // Several largest ones side by side, which do not wait for each other.
    const SIDES: usize = 8;
    let more = |a: f64, b: f64| if b > a { b } else { a };
    let mut most = [f64::NEG_INFINITY; SIDES];
    let parts = values.chunks_exact(SIDES);
    let rest = parts.remainder().iter().map(|v| measure(*v));
    for part in parts {
        for i in 0..SIDES {
            most[i] = more(most[i], measure(part[i]));
        }
    }
    most.into_iter().chain(rest).fold(f64::NEG_INFINITY, more)
}

/// Index of the value of largest `measure`, the first of equals.
pub fn index_of_largest(values: &[f64], measure: impl Fn(f64) -> f64) -> usize {
    let largest = largest(values, &measure);
    let first = values.iter().position(|v| measure(*v) == largest);
    first.unwrap_or(0)
}

/// Centred mean over `length` samples (odd); at both ends over those that there
/// are, at least half of them, so that noise is averaged there too.
pub fn moving_mean(values: &[f64], length: usize) -> Vec<f64> {
    match length / 2 {
        0 => values.to_vec(),
        _ => RunningSums::of(values).means(length),
    }
}

/// A signal with the sums of its first 0, 1, … samples, from which means over any number of
/// them come.
pub struct RunningSums<'a> {
    values: &'a [f64],
    sums: Vec<f64>,
}

impl<'a> RunningSums<'a> {
    /// Sums up a signal.
    pub fn of(values: &'a [f64]) -> Self {
        let mut sums = Vec::with_capacity(values.len() + 1);
        sums.push(0.0);
        let mut sum = 0.0;
        sums.extend(values.iter().map(|value| {
            sum += value;
            sum
        }));
        Self { values, sums }
    }

    /// [`moving_mean`] of the signal.
    pub fn means(&self, length: usize) -> Vec<f64> {
        self.means_in(0..self.values.len(), length)
    }

    /// [`moving_mean`] of the signal, at some of the samples.
    pub fn means_in(&self, range: Range<usize>, length: usize) -> Vec<f64> {
        let (half, n, sums) = (length / 2, self.values.len(), &self.sums);
        if half == 0 {
            return self.values[range].to_vec();
        }
        let mean = |i: usize| {
            let (first, last) = (i.saturating_sub(half), (i + half + 1).min(n));
            (sums[last] - sums[first]) / (last - first) as f64
        };
        // The windows that are whole, apart: they need no limits.
        let from = half.clamp(range.start, range.end);
        let to = n.saturating_sub(half).clamp(from, range.end);
        let mut means = Vec::with_capacity(range.len());
        means.extend((range.start..from).map(mean));
        let share = ((2 * half + 1) as f64).recip();
        if to > from {
            let (first, last) = (&sums[from - half..], &sums[from + half + 1..]);
            let windows = first.iter().zip(last).take(to - from);
            means.extend(windows.map(|(first, last)| (last - first) * share));
        }
        means.extend((to..range.end).map(mean));
        means
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn closed_form_moving_mean_of_a_ramp_is_the_ramp() {
        let ramp: Vec<f64> = (0..20).map(f64::from).collect();
        let smooth = moving_mean(&ramp, 5);
        assert!((2..18).all(|i| (smooth[i] - ramp[i]).abs() < 1e-12));
        // The first three samples, and the last three.
        assert!((smooth[0] - 1.0).abs() < 1e-12 && (smooth[19] - 18.0).abs() < 1e-12);
    }

    #[test]
    fn closed_form_white_noise_of_alternating_samples() {
        // ±1 by turns bends by 4 everywhere; a straight line not at all.
        let turns: Vec<f64> = (0..50).map(|i| f64::from(1 - 2 * (i % 2))).collect();
        let expected = 4.0 * GAUSSIAN_OVER_MEDIAN / 6f64.sqrt();
        assert!((white_noise(&turns) - expected).abs() < 1e-12);
        let line: Vec<f64> = (0..50).map(f64::from).collect();
        assert_eq!(white_noise(&line), 0.0);
        assert_eq!(white_noise(&[1.0, 2.0]), 0.0);
    }

    #[test]
    fn closed_form_smoothing_of_a_half_sine() {
        // 600 samples of half sine: above half for 400; 1/50 of 600 is 12, odd 13.
        let wave = |i: i32| -> f64 {
            let phase = f64::from(i - 500) / 600.0;
            if (0.0..1.0).contains(&phase) {
                -(std::f64::consts::PI * phase).sin()
            } else {
                0.0
            }
        };
        let values: Vec<f64> = (0..1600).map(wave).collect();
        let zero = Level {
            value: 0.0,
            samples: 400,
        };
        let sums = RunningSums::of(&values);
        let scale = pulse_scale(&sums, zero, 0.0, 5.0);
        assert!(scale.reversed && scale.top.abs_diff(800) <= 1);
        assert_eq!(scale.smoothing, 13);
        // With noise of half the peak the most that is allowed: 600/5.
        let scale = pulse_scale(&sums, zero, 0.5, 5.0);
        assert!(scale.smoothing.abs_diff(120) <= 6, "{}", scale.smoothing);
    }
}
