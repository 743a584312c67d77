//! A signal that stays at the limit of its instrument.

use crate::finding::Finding;
use crate::noise::estimate::{median, quantum};
use crate::polynomial::{PolynomialFit, fit_polynomial};
use crate::recording::{Quantity, Recording};
use crate::trigger::scale::{index_of_largest, largest, moving_mean, white_noise};
use std::ops::Range;

/// Most samples of a recording that lie beyond a limit: single wrong ones.
const MOST_BEYOND: usize = 3;

/// Fewest successive samples at the largest value.
const LEAST_SUCCESSIVE: usize = 3;

/// Fewest successive samples at the largest value that are clipped whatever the flanks do, and
/// how sharply they must begin or end: one side by this part of the height, both by more steps
/// of a quantised signal than its rounded top has; 1.
const LEAST_SHARP: usize = 4;
const SHARP: f64 = 0.01;
const SHARP_STEPS: f64 = 4.0;

/// Fewest samples at the largest value that need not be successive.
const LEAST_PILED: usize = 8;

/// So many times as many samples lie at a limit as at any value near below it; 1. A rounded
/// top that is quantised has up to 2.4 times as many in its last step as in the one before.
const PILED: usize = 6;

/// Values near below the largest that are compared with it.
const NEAR_BELOW: usize = 12;

/// Part of the samples at the limit that is left out at either end of a plateau: noise
/// reaches it early and late; 1.
const EARLY: f64 = 0.05;

/// Fewest samples on either side that are continued over the top.
const LEAST_FLANK: usize = 4;

/// The flanks must extrapolate above the limit by more than this part of the height; 1.
const EXCESS: f64 = 0.02;

/// … and by more than this many standard deviations of the continuation; 1.
const SIGNIFICANT: f64 = 3.0;

/// Fewest samples of a plateau that carries noise.
const LEAST_NOISY: usize = 24;

/// A plateau that carries noise is looked for in means over this part of the contact; 1.
const SMOOTHING: f64 = 0.02;

/// It reaches this many deviations of such a mean below its highest one; 1.
const NOISE_BAND: f64 = 8.0;

/// … and at most this part of its height; 1.
const WIDEST_BAND: f64 = 0.1;

/// Part of a plateau, in its middle, that must be straight and level; 1.
const MIDDLE: f64 = 0.8;

/// The flanks of such a plateau must bulge by this part of the height between its ends, and
/// its middle be known to bulge by no more than a tenth of that; 1.
const BULGE: f64 = 0.05;
const LEVEL: f64 = 0.1;

/// Clipping of a signal in a contact: a plateau at its largest value that a pulse with such
/// flanks cannot have.
///
/// A plateau is several successive samples at the largest value; many of them in pieces,
/// where noise was in the signal before it met the limit; or a level stretch, where noise came
/// after it. But for the pieces, a parabola through the samples on both sides must rise above
/// it: the rounded top of a quantised signal stays on one value too, but its flanks continue to
/// that value and no further.
///
/// * `values`: samples as they were recorded, before anything is subtracted or filtered
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
    let limit = far_end(values.get(first..last)?, sign)?;
    let beyond = |v: &&f64| sign * **v > sign * limit;
    if values.iter().filter(beyond).count() > MOST_BEYOND {
        return None;
    }
    let height = sign * (limit - far_end(values, -sign)?);
    let pulse = Pulse {
        times,
        values,
        contact: first..last,
        sign,
        limit,
        height,
    };
    let (plateau, samples) = pulse.at_limit().or_else(|| pulse.level())?;
    Some(Finding::Clipped {
        channel: name.to_owned(),
        value: limit,
        samples,
        from: times[plateau.start],
        to: times[plateau.end - 1],
    })
}

/// Channels that stand at the end of their range in a contact, as recorded: forces,
/// accelerations, and positions that stop before the impactor does.
pub(crate) fn clipped_channels(recording: &Recording, window: (f64, f64)) -> Vec<Finding> {
    let found = recording.channels.iter().filter_map(|channel| {
        let looks = matches!(
            channel.quantity,
            Quantity::Force | Quantity::Acceleration | Quantity::Displacement | Quantity::Angle
        );
        if !looks {
            return None;
        }
        let values = &channel.samples;
        let times: Vec<f64> = (0..values.len()).map(|i| channel.times.at(i)).collect();
        let first = times.partition_point(|&t| t < window.0);
        let last = times.partition_point(|&t| t <= window.1);
        let within = values.get(first..last).filter(|own| !own.is_empty())?;
        let (rest, looked_at) = match channel.quantity {
            Quantity::Force | Quantity::Acceleration => (median(values)?, 0..values.len()),
            // A position is far away before contact and after it.
            Quantity::Displacement | Quantity::Angle => (within[0], first..last),
            _ => return None,
        };
        let largest = index_of_largest(within, |v| (v - rest).abs());
        let negative = within[largest] < rest;
        let (times, values) = (&times[looked_at.clone()], &values[looked_at]);
        clipping(&channel.name, times, values, window, negative)
    });
    found.collect()
}

/// The extreme of a signal on the side of `sign`.
fn far_end(values: &[f64], sign: f64) -> Option<f64> {
    let largest = sign * largest(values, |v| sign * v);
    largest.is_finite().then_some(largest)
}

/// A signal around the contact that is looked at.
struct Pulse<'a> {
    times: &'a [f64],
    values: &'a [f64],
    contact: Range<usize>,
    sign: f64,
    limit: f64,
    height: f64,
}

impl Pulse<'_> {
    /// Samples that equal the limit, one after the other or in pieces; their number.
    fn at_limit(&self) -> Option<(Range<usize>, usize)> {
        let run = longest_run(self.values, &self.contact, self.limit);
        let length = run.len();
        if self.sharp(&run) {
            return Some((run, length));
        }
        let (plateau, samples) = match self.pieces() {
            Some(pieces) if pieces.1 > 2 * length => return Some(pieces),
            Some(pieces) if pieces.1 > length => pieces,
            _ => (run, length),
        };
        if samples < LEAST_SUCCESSIVE {
            return None;
        }
        let flanks = self.flanks(&plateau)?;
        let excess = self.sign * (flanks.derivatives[0] - self.limit);
        let spread = flanks.standard_deviations[0];
        let clipped = excess > EXCESS * self.height && excess > SIGNIFICANT * spread;
        (clipped && excess > self.step(&plateau)).then_some((plateau, samples))
    }

    /// Whether a run at the limit begins and ends with a corner that no rounded top has.
    fn sharp(&self, run: &Range<usize>) -> bool {
        if run.len() < LEAST_SHARP {
            return false;
        }
        let before = run.start.checked_sub(1).and_then(|i| self.values.get(i));
        let Some((before, after)) = before.zip(self.values.get(run.end)) else {
            return false;
        };
        let drops = [before, after].map(|v| (v - self.limit).abs());
        let least = || SHARP_STEPS * self.step(run);
        drops[0].max(drops[1]) > SHARP * self.height && drops[0].min(drops[1]) > least()
    }

    /// Step of a quantised signal: how far it may rise above the value on which its rounded top
    /// stays. 0 for any other signal.
    ///
    /// Steps may differ, as those of a count of angles that became a position: then their median
    /// is taken, if the signal mostly stays where it is outside of the plateau.
    fn step(&self, plateau: &Range<usize>) -> f64 {
        quantum(self.values).unwrap_or_else(|| {
            let outside = self.contact.clone().skip(1);
            let outside = outside.filter(|i| !(plateau.start..=plateau.end).contains(i));
            let changes = outside.map(|i| (self.values[i] - self.values[i - 1]).abs());
            let (stays, steps): (Vec<f64>, Vec<f64>) = changes.partition(|&change| change == 0.0);
            match stays.len() > steps.len() {
                true => median(&steps).unwrap_or(0.0),
                false => 0.0,
            }
        })
    }

    /// Samples at the limit with others between them, where many more lie there than at the
    /// values just below.
    fn pieces(&self) -> Option<(Range<usize>, usize)> {
        let own = self.contact.clone();
        let at: Vec<usize> = own.filter(|&i| self.values[i] == self.limit).collect();
        if at.len() < LEAST_PILED {
            return None;
        }
        let mut below: Vec<f64> = self.values[self.contact.clone()].to_vec();
        below.sort_by(|a, b| (self.sign * b).total_cmp(&(self.sign * a)));
        let levels = below.chunk_by(|a, b| a == b).skip(1).take(NEAR_BELOW);
        let most = levels.map(<[f64]>::len).max().unwrap_or(0);
        if at.len() < PILED * most {
            return None;
        }
        let early = (EARLY * at.len() as f64) as usize;
        let plateau = at[early]..at[at.len() - 1 - early] + 1;
        Some((plateau, at.len()))
    }

    /// A parabola through the samples on either side of a plateau, about its middle.
    fn flanks(&self, plateau: &Range<usize>) -> Option<PolynomialFit> {
        let flank = (plateau.len() / 3).max(LEAST_FLANK);
        let left = plateau.start.saturating_sub(flank).max(self.contact.start)..plateau.start;
        let right = plateau.end..(plateau.end + flank).min(self.contact.end);
        let times = [&self.times[left.clone()], &self.times[right.clone()]].concat();
        let values = [&self.values[left], &self.values[right]].concat();
        let middle = 0.5 * (self.times[plateau.start] + self.times[plateau.end - 1]);
        fit_polynomial(&times, &values, middle, 2)
    }

    /// A straight and level stretch at the top, in noise; its samples.
    fn level(&self) -> Option<(Range<usize>, usize)> {
        let own = &self.values[self.contact.clone()];
        let length = ((SMOOTHING * own.len() as f64) as usize) | 1;
        let smooth = moving_mean(own, length);
        let top = far_end(&smooth, self.sign)?;
        let band = NOISE_BAND * white_noise(self.values) / (length as f64).sqrt();
        if band > WIDEST_BAND * self.height {
            return None;
        }
        let high = |v: &f64| self.sign * (top - v) <= band;
        let start = self.contact.start + smooth.iter().position(high)?;
        let plateau = start..self.contact.start + smooth.iter().rposition(high)? + 1;
        if plateau.len() < LEAST_NOISY {
            return None;
        }
        let flanks = self.flanks(&plateau)?;
        let cut = (0.5 * (1.0 - MIDDLE) * plateau.len() as f64) as usize;
        let middle = plateau.start + cut..plateau.end - cut;
        let (times, values) = (&self.times[middle.clone()], &self.values[middle]);
        let span = times[times.len() - 1] - times[0];
        let centre = 0.5 * (times[0] + times[times.len() - 1]);
        let inner = fit_polynomial(times, values, centre, 2)?;
        // How far a parabola of this curvature rises between the ends, and a line.
        let bulge = |curvature: f64| -self.sign * curvature * span * span / 8.0;
        let (wanted, found) = (bulge(flanks.derivatives[2]), bulge(inner.derivatives[2]));
        let unsure = SIGNIFICANT * bulge(-self.sign * inner.standard_deviations[2]);
        let slope_unsure = SIGNIFICANT * inner.standard_deviations[1];
        let steep = inner.derivatives[1].abs() > slope_unsure;
        let clear = wanted > (BULGE * self.height).max(self.step(&plateau))
            && wanted > SIGNIFICANT * bulge(-self.sign * flanks.standard_deviations[2]);
        let straight = found.abs() <= unsure && found.abs() + unsure <= LEVEL * wanted;
        (clear && straight && !steep).then(|| (plateau.clone(), plateau.len()))
    }
}

/// The longest run of `limit` in a range.
fn longest_run(values: &[f64], within: &Range<usize>, limit: f64) -> Range<usize> {
    let mut longest = within.start..within.start;
    let mut begin = within.start;
    for i in within.clone() {
        if values[i] != limit {
            begin = i + 1;
        } else if i + 1 - begin > longest.len() {
            longest = begin..i + 1;
        }
    }
    longest
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::noise::gaussian::{noise_source, normal};
    use crate::recording::{Channel, Times};
    use std::f64::consts::{PI, TAU};

    #[test]
    fn recovers_a_position_that_stops_before_the_impactor() {
        // A coarse scale and a fine one, with little noise and much; the approach reaches far
        // below what the contact adds.
        for (step, noise) in [(1e-6, 0.0), (1e-6, 2e-6), (1e-5, 0.0)] {
            for (limit, found) in [(1.0, 0), (0.7e-3, 1), (0.9e-3, 1)] {
                let mut source = noise_source(7, 0);
                let samples = (0..4000).map(|i| {
                    let t = f64::from(i) * 1e-5 - 0.017;
                    let clean = match t {
                        ..0.0 => 0.52 * t,
                        6e-3.. => 0.52 * (6e-3 - t),
                        _ => 1e-3 * (t / 6e-3 * std::f64::consts::PI).sin(),
                    };
                    let noisy = (clean + noise * normal(&mut source)).min(limit);
                    0.4 - (noisy / step).round() * step
                });
                let recording = Recording {
                    name: "pendulum".into(),
                    channels: vec![Channel {
                        name: "x".into(),
                        quantity: Quantity::Displacement,
                        times: Times::Uniform {
                            start: -0.017,
                            interval: 1e-5,
                        },
                        samples: samples.collect(),
                    }],
                    missing: Vec::new(),
                    doubts: Vec::new(),
                };
                let told = clipped_channels(&recording, CONTACT);
                assert_eq!(told.len(), found, "{step} {noise} {limit}: {told:?}");
            }
        }
    }

    /// Half a sine of 30 with noise before the limit and after it, in steps of a converter.
    fn half_sine_in_noise(
        limit: f64,
        (before, after): (f64, f64),
        step: f64,
        seed: u64,
    ) -> (Vec<f64>, Vec<f64>) {
        let mut source = noise_source(seed, 0);
        let times: Vec<f64> = (0..1201).map(|i| f64::from(i) * 5e-6).collect();
        let values = times.iter().map(|t| {
            let clean = 30.0 * (t / 6e-3 * std::f64::consts::PI).sin();
            let limited = (clean + before * normal(&mut source)).min(limit);
            let noisy = limited + after * normal(&mut source);
            if step > 0.0 {
                (noisy / step).round() * step
            } else {
                noisy
            }
        });
        let values = values.collect();
        (times, values)
    }

    const CONTACT: (f64, f64) = (0.0, 6e-3);

    #[test]
    fn recovers_a_limit_that_noise_meets() {
        for part in [0.4, 0.6, 0.8, 0.9] {
            for noise in [0.05, 0.5, 2.0] {
                for seed in 0..10 {
                    let own = half_sine_in_noise(30.0 * part, (noise, 0.0), 0.0, seed);
                    let found = clipping("F", &own.0, &own.1, CONTACT, false);
                    assert!(found.is_some(), "{part} {noise} {seed}");
                    let negative: Vec<f64> = own.1.iter().map(|v| -v).collect();
                    assert!(clipping("F", &own.0, &negative, CONTACT, true).is_some());
                }
            }
        }
    }

    #[test]
    fn recovers_a_limit_under_noise() {
        for part in [0.4, 0.6, 0.8] {
            for noise in [0.02, 0.1, 0.3] {
                for seed in 0..10 {
                    let own = half_sine_in_noise(30.0 * part, (0.0, noise), 0.0, seed);
                    let found = clipping("F", &own.0, &own.1, CONTACT, false);
                    assert!(found.is_some(), "{part} {noise} {seed}");
                }
            }
        }
    }

    #[test]
    fn recovers_a_limit_of_a_pulse_of_few_samples() {
        // Half a swing of a circuit board at 50 kHz, as recorded: m/s².
        let swing = [
            0.0, -517.0, -1028.0, -1694.0, -2368.0, -3030.0, -3675.0, -4163.0, -4474.0, -4750.0,
            -4955.0, -5125.0, -5358.4, -5358.4, -5358.4, -5358.4, -5358.4, -5358.4, -5358.4,
            -5339.0, -4684.0, -4339.0, -3991.0, -4017.0, -4018.0, -3664.0, -3158.0, -2482.0,
            -1804.0, -1102.0, -293.0, 2000.0, 5100.0, 5359.9, 5100.0,
        ];
        let times: Vec<f64> = (0..swing.len()).map(|i| 2e-5 * i as f64).collect();
        let found = clipping("a", &times, &swing, (1e-5, 6.05e-4), true);
        assert!(matches!(found, Some(Finding::Clipped { samples: 7, .. })));
    }

    #[test]
    fn rejects_no_pulse_for_its_noise_or_its_steps() {
        for noise in [0.0, 0.02, 0.1, 0.5, 2.0] {
            for step in [0.0, 0.01, 0.1, 0.5, 1.0] {
                for seed in 0..20 {
                    let own = half_sine_in_noise(1e9, (noise, 0.0), step, seed);
                    let found = clipping("F", &own.0, &own.1, CONTACT, false);
                    assert_eq!(found, None, "{noise} {step} {seed}");
                }
            }
        }
    }

    /// A coarse count of an arm's angle, as a position: its steps differ, and it stands still at
    /// the largest displacement.
    #[test]
    fn rejects_no_count_that_became_a_position() {
        let count = TAU / 20_000.0;
        for part in 0..200 {
            let rest = 0.0017 * f64::from(part);
            let times: Vec<f64> = (0..700).map(|i| f64::from(i) * 1e-5).collect();
            let values: Vec<f64> = times
                .iter()
                .map(|t| 1e-3 * (t / 7e-3 * PI).sin() / 0.505 + rest)
                .map(|angle| 0.505 * ((angle / count).round() * count).sin())
                .collect();
            let found = clipping("x", &times, &values, (0.0, 7e-3), false);
            assert_eq!(found, None, "{part}");
        }
    }

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
