//! Two impacts on one spot, laid over each other.

use windfall_signal::error::Error;
use windfall_signal::impact::Series;
use windfall_signal::polynomial::fit_polynomial;

/// A level is never below this many standard deviations of the noise; 1.
const LEAST_LEVEL: f64 = 8.0;

/// A crossing is read from samples between these parts of its level; 1.
const CROSSING_RANGE: (f64, f64) = (0.5, 1.5);

/// The top is fitted where the force is above this part of the largest; 1.
const TOP_SHARE: f64 = 0.9;

/// Fewest samples of a line that is fitted through a crossing.
const LINE_SAMPLES: usize = 3;

/// Iterations of the shift that lays one rise over another.
const SHIFT_ITERATIONS: usize = 20;

/// How two impacts are laid over each other.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Alignment {
    /// Where both cross the same force.
    #[default]
    Crossing,
    /// Least squares of the rises. Part of a change of stiffness becomes a shift.
    Rise,
}

/// How repeated impacts are aligned and what is read off them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AlignOptions {
    /// What is laid over what.
    pub alignment: Alignment,
    /// Force of the crossing, a part of the first peak; at least 8 deviations of noise; 1.
    pub crossing: f64,
    /// The rise is between these parts of the peak of the first impact; 1.
    pub rise: (f64, f64),
    /// Instants at which curves are compared.
    pub points: usize,
    /// The last of them, in contact durations of the first impact; 1.
    pub until: f64,
}

impl Default for AlignOptions {
    fn default() -> Self {
        Self {
            alignment: Alignment::default(),
            crossing: 0.1,
            rise: (0.2, 0.7),
            points: 56,
            until: 1.1,
        }
    }
}

/// What is read off one impact at forces that both of a pair share.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Features {
    /// Largest force, of the parabola through the top; N.
    pub peak: f64,
    /// Time above the level; s.
    pub duration: f64,
    /// Slope of the line through the rise; N/s.
    pub rise_slope: f64,
    /// When the rise crosses the level; s on the recording's clock.
    pub crossing: f64,
}

/// Two impacts on common instants.
#[derive(Clone, Debug, PartialEq)]
pub struct AlignedPair {
    /// Instants from the crossing, in contact durations of the first; 1.
    pub instants: Vec<f64>,
    /// Force of the first; N.
    pub first: Vec<f64>,
    /// Force of the second; N.
    pub second: Vec<f64>,
    /// What is read off the first.
    pub first_features: Features,
    /// What is read off the second, at the forces of the first.
    pub second_features: Features,
}

impl AlignedPair {
    /// Second less first, as a part of the peak of the first; 1.
    pub fn difference(&self) -> Vec<f64> {
        let pairs = self.first.iter().zip(&self.second);
        let peak = self.first_features.peak;
        pairs
            .map(|(first, second)| (second - first) / peak)
            .collect()
    }

    /// Change of peak, duration and rise slope, as parts of the first; 1.
    pub fn changes(&self) -> [f64; 3] {
        let (first, second) = (&self.first_features, &self.second_features);
        [
            second.peak / first.peak - 1.0,
            second.duration / first.duration - 1.0,
            second.rise_slope / first.rise_slope - 1.0,
        ]
    }
}

/// Names of [`AlignedPair::changes`].
pub const CHANGES: [&str; 3] = ["peak_force", "contact_duration", "rise_slope"];

/// Lays the second impact over the first and reads both at common instants.
///
/// The same force marks the time of both: a part of the peak of the first. The
/// crossing is that of a line through the samples around it, so that it is finer
/// than a sampling interval. A value at an instant is the mean of the samples
/// that are nearer to it than to its neighbours, or between two samples.
///
/// # Errors
/// [`Error::BadOption`]; [`Error::CrossingUnseen`] for a curve that does not
/// begin or end below the level.
pub fn align_pair(
    first: &Series,
    second: &Series,
    options: &AlignOptions,
) -> Result<AlignedPair, Error> {
    check_options(options)?;
    let peak = peak_force(first);
    let noise = first.noise.max(second.noise);
    let first_features = features_at(first, peak, noise, options)?;
    let second_features = features_at(second, peak, noise, options)?;
    let duration = first_features.duration;
    let step = options.until / (options.points - 1) as f64;
    let instants: Vec<f64> = (0..options.points).map(|i| i as f64 * step).collect();
    let on_instants = |series: &Series, zero: f64| {
        let at = |instant: &f64| local_mean(series, zero + instant * duration, step * duration);
        instants.iter().map(at).collect::<Vec<f64>>()
    };
    let zero = match options.alignment {
        Alignment::Crossing => second_features.crossing,
        Alignment::Rise => {
            let crossings = (first_features.crossing, second_features.crossing);
            zero_of_rise(first, second, crossings, peak, options)
        }
    };
    Ok(AlignedPair {
        first: on_instants(first, first_features.crossing),
        second: on_instants(second, zero),
        instants,
        first_features,
        second_features,
    })
}

/// Features of one impact at parts of its own peak; errors as in [`align_pair`].
pub fn features(series: &Series, options: &AlignOptions) -> Result<Features, Error> {
    check_options(options)?;
    features_at(series, peak_force(series), series.noise, options)
}

fn check_options(options: &AlignOptions) -> Result<(), Error> {
    let bad = |option, value, expected| Err(Error::bad_option(option, value, expected));
    let (low, high) = options.rise;
    if !(options.crossing > 0.0 && options.crossing < 0.5) {
        return bad("crossing", options.crossing, "a part between 0 and 0.5");
    }
    if !(low > 0.0 && low < high && high < 1.0) {
        return bad("rise", low, "two rising parts of the peak between 0 and 1");
    }
    if options.points < 2 {
        return bad("points", options.points as f64, "at least 2");
    }
    if !(options.until > 0.0 && options.until.is_finite()) {
        return bad("until", options.until, "a positive number");
    }
    Ok(())
}

fn features_at(
    series: &Series,
    peak: f64,
    noise: f64,
    options: &AlignOptions,
) -> Result<Features, Error> {
    let level = (options.crossing * peak).max(LEAST_LEVEL * noise);
    let top = top_index(series);
    let unseen = |side| Error::CrossingUnseen {
        side,
        level,
        largest: series.values[top],
    };
    let up = crossing(series, level, Flank::Rise).ok_or_else(|| unseen("rise"))?;
    let down = crossing(series, level, Flank::Fall).ok_or_else(|| unseen("fall"))?;
    Ok(Features {
        peak: peak_force(series),
        duration: down - up,
        rise_slope: rise_slope(series, peak, options).ok_or_else(|| unseen("rise"))?,
        crossing: up,
    })
}

fn top_index(series: &Series) -> usize {
    let values = &series.values;
    (0..values.len()).fold(0, |top, i| if values[i] > values[top] { i } else { top })
}

/// Largest force, of a parabola through the samples above nine tenths of it if possible.
pub fn peak_force(series: &Series) -> f64 {
    let top = top_index(series);
    let Some(&largest) = series.values.get(top) else {
        return 0.0;
    };
    let above = |i: &usize| series.values[*i] > TOP_SHARE * largest;
    let first = (0..=top).rev().take_while(above).last().unwrap_or(top);
    let last = (top..series.values.len())
        .take_while(above)
        .last()
        .unwrap_or(top);
    let (times, values) = (&series.times[first..=last], &series.values[first..=last]);
    if times.len() < 5 {
        return largest;
    }
    let origin = 0.5 * (times[0] + times[times.len() - 1]);
    match fit_polynomial(times, values, origin, 2).map(|fit| fit.derivatives) {
        Some(d) if d[2] < 0.0 => d[0] - 0.5 * d[1] * d[1] / d[2],
        _ => largest,
    }
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Flank {
    Rise,
    Fall,
}

/// Time at which a flank of the pulse crosses a level.
fn crossing(series: &Series, level: f64, flank: Flank) -> Option<f64> {
    let (values, top) = (&series.values, top_index(series));
    let below = |i: &usize| values[*i] < CROSSING_RANGE.0 * level;
    let above = |i: &usize| values[*i] > CROSSING_RANGE.1 * level;
    // From the top outwards to the samples that bound the range.
    let (first, last) = match flank {
        Flank::Rise => {
            let low = (0..top).rev().find(below)?;
            (low, (low..=top).find(above)?)
        }
        Flank::Fall => {
            let low = (top..values.len()).find(below)?;
            ((top..low).rev().find(above)?, low)
        }
    };
    // Of the bounding samples only the flank's own belong to the line.
    let inner = first + 1..last;
    if inner.len() >= LINE_SAMPLES {
        let times = &series.times[inner.clone()];
        let origin = times[times.len() / 2];
        let fit = fit_polynomial(times, &values[inner], origin, 1)?;
        let at = origin + (level - fit.derivatives[0]) / fit.derivatives[1];
        if at > series.times[first] && at < series.times[last] {
            return Some(at);
        }
    }
    let crosses = |i: &usize| (values[*i] - level) * (values[i + 1] - level) <= 0.0;
    let i = (first..last).find(crosses)?;
    let (before, after) = (values[i], values[i + 1]);
    let share = if after == before {
        0.5
    } else {
        (level - before) / (after - before)
    };
    Some(series.times[i] + share * (series.times[i + 1] - series.times[i]))
}

/// Samples of the rise between the two parts of a peak.
fn rise_samples(series: &Series, peak: f64, options: &AlignOptions) -> std::ops::Range<usize> {
    let (low, high) = (options.rise.0 * peak, options.rise.1 * peak);
    let top = top_index(series);
    let first = (0..top)
        .rev()
        .find(|&i| series.values[i] < low)
        .map_or(0, |i| i + 1);
    let last = (first..top)
        .find(|&i| series.values[i] > high)
        .unwrap_or(top);
    first..last
}

fn rise_slope(series: &Series, peak: f64, options: &AlignOptions) -> Option<f64> {
    let range = rise_samples(series, peak, options);
    if range.len() < LINE_SAMPLES {
        let (low, high) = (options.rise.0 * peak, options.rise.1 * peak);
        let at = |level| crossing(series, level, Flank::Rise);
        return Some((high - low) / (at(high)? - at(low)?));
    }
    let times = &series.times[range.clone()];
    let fit = fit_polynomial(times, &series.values[range], times[0], 1)?;
    Some(fit.derivatives[1])
}

/// Time shift at which the rises differ least: Gauss-Newton.
fn zero_of_rise(
    first: &Series,
    second: &Series,
    (zero_first, zero_second): (f64, f64),
    peak: f64,
    options: &AlignOptions,
) -> f64 {
    let range = rise_samples(first, peak, options);
    let mut shift = zero_second - zero_first;
    let step = (first.times[range.end.min(first.times.len() - 1)] - first.times[range.start])
        / range.len().max(1) as f64;
    for _ in 0..SHIFT_ITERATIONS {
        let (mut numerator, mut denominator) = (0.0, 0.0);
        for i in range.clone() {
            let time = first.times[i] + shift;
            let slope = (interpolate(second, time + step) - interpolate(second, time - step))
                / (2.0 * step);
            numerator += slope * (first.values[i] - interpolate(second, time));
            denominator += slope * slope;
        }
        if denominator <= 0.0 {
            break;
        }
        let change = numerator / denominator;
        shift += change;
        if change.abs() < 1e-6 * step {
            break;
        }
    }
    zero_first + shift
}

/// Mean of the samples within half a width of a time, or interpolated.
fn local_mean(series: &Series, time: f64, width: f64) -> f64 {
    let from = series.times.partition_point(|&t| t < time - 0.5 * width);
    let until = series.times.partition_point(|&t| t < time + 0.5 * width);
    if until - from < 2 {
        return interpolate(series, time);
    }
    // A line through them, read at the time: samples need not lie evenly.
    let (times, values) = (&series.times[from..until], &series.values[from..until]);
    match fit_polynomial(times, values, time, 1) {
        Some(fit) if times.len() > 2 => fit.derivatives[0],
        _ => interpolate(series, time),
    }
}

fn interpolate(series: &Series, time: f64) -> f64 {
    let (times, values) = (&series.times, &series.values);
    let next = times.partition_point(|&t| t < time);
    // Before and after the recorded part there is no contact.
    if next == 0 || next == times.len() {
        return 0.0;
    }
    let share = (time - times[next - 1]) / (times[next] - times[next - 1]);
    values[next - 1] + share * (values[next] - values[next - 1])
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    /// A half sine from `onset`, sampled at its own phase.
    fn pulse(onset: f64, phase: f64, peak: f64, duration: f64) -> Series {
        let times: Vec<f64> = (0..400).map(|i| (f64::from(i) + phase) * 2e-5).collect();
        let force = |t: &f64| match (t - onset) / duration {
            s if (0.0..1.0).contains(&s) => peak * (PI * s).sin(),
            _ => 0.0,
        };
        let values = times.iter().map(force).collect();
        Series {
            times,
            values,
            noise: 0.0,
            ..Series::default()
        }
    }

    #[test]
    fn closed_form_features_of_a_half_sine() {
        let series = pulse(1e-3, 0.3, 50.0, 4e-3);
        let found = features(&series, &AlignOptions::default()).unwrap();
        let at = 0.1_f64.asin() / PI * 4e-3;
        assert!((found.peak / 50.0 - 1.0).abs() < 1e-3, "{found:?}");
        assert!((found.crossing - 1e-3 - at).abs() < 1e-6);
        assert!((found.duration - (4e-3 - 2.0 * at)).abs() < 2e-6);
        // Slope of the chord from 0.2 to 0.7; the curvature adds a little.
        let chord = 25.0 / ((0.7_f64.asin() - 0.2_f64.asin()) / PI * 4e-3);
        assert!((found.rise_slope / chord - 1.0).abs() < 0.02);
    }

    #[test]
    fn closed_form_equal_pulses_on_other_clocks_agree() {
        for alignment in [Alignment::Crossing, Alignment::Rise] {
            let options = AlignOptions {
                alignment,
                ..AlignOptions::default()
            };
            let (first, second) = (
                pulse(1e-3, 0.1, 50.0, 4e-3),
                pulse(1.4937e-3, 0.77, 50.0, 4e-3),
            );
            let pair = align_pair(&first, &second, &options).unwrap();
            // A sampling interval is 1.6 % of the peak at the steepest.
            let largest = pair
                .difference()
                .iter()
                .fold(0.0_f64, |m, d| m.max(d.abs()));
            assert!(largest < 2e-3, "{alignment:?}: {largest}");
            assert!(pair.changes().iter().all(|change| change.abs() < 1e-3));
        }
    }

    #[test]
    fn closed_form_changes_of_a_stiffer_pulse() {
        let (first, second) = (
            pulse(1e-3, 0.1, 50.0, 4e-3),
            pulse(1.2e-3, 0.4, 55.0, 3.6e-3),
        );
        let pair = align_pair(&first, &second, &AlignOptions::default()).unwrap();
        let time = |peak: f64, duration: f64| (1.0 - 2.0 * (5.0 / peak).asin() / PI) * duration;
        let duration = time(55.0, 3.6e-3) / time(50.0, 4e-3) - 1.0;
        let [peak, found, slope] = pair.changes();
        assert!((peak - 0.1).abs() < 1e-3 && (found - duration).abs() < 1e-3);
        assert!((0.15..0.3).contains(&slope));
    }

    #[test]
    fn rejects_a_curve_that_begins_in_contact() {
        let whole = pulse(1e-3, 0.1, 50.0, 4e-3);
        let cut = Series {
            times: whole.times[100..].to_vec(),
            values: whole.values[100..].to_vec(),
            ..whole.clone()
        };
        let error = align_pair(&whole, &cut, &AlignOptions::default()).unwrap_err();
        assert!(error.to_string().contains("rise"), "{error}");
    }
}
