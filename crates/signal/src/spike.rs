//! Samples that no sensor could give: a single value far from its neighbours.

use crate::finding::Finding;
use crate::noise::estimate::median;
use crate::track::Track;
use crate::trigger::scale::{largest, white_noise};

/// A spike departs from its neighbours by this many standard deviations of the noise; 1.
const CLEAR: f64 = 10.0;
/// … and by this many steps of a quantised signal; 1.
const STEPS: f64 = 5.0;
/// … and by this part of the range of all samples; 1.
const SMALL: f64 = 0.1;
/// … and by this many times what the samples around it depart from theirs; 1.
const LONELY: f64 = 5.0;
/// Samples on either side whose departures it is compared with.
const AROUND: usize = 10;
/// Fewest samples of pulses in which a single one is no part of a pulse.
const DENSE: usize = 100;
/// A larger part of the samples than this are no spikes but a noise of its own kind; 1.
const RARE: f64 = 0.005;

/// Replaces spikes by the median of the four samples next to them, and says so.
///
/// A spike is one sample among many: where a contact has few samples, each may be its peak, and
/// what looks like a spike is said and kept. The top of a pulse that lasts only a few samples is none: the
/// samples beside it depart from their neighbours too.
pub(crate) fn remove_spikes(track: &mut Track, findings: &mut Vec<Finding>) {
    let spikes = spikes(&track.values, track.quantum.unwrap_or(0.0));
    let Some(&(first, _)) = spikes.first() else {
        return;
    };
    let (channel, time, value) = (track.name.clone(), track.times[first], track.values[first]);
    let samples = spikes.len();
    if samples_of_pulses(&track.values, &spikes) < DENSE {
        findings.push(Finding::SpikesKept {
            channel,
            samples,
            time,
            value,
        });
        return;
    }
    findings.push(Finding::Spikes {
        channel,
        samples,
        time,
        value,
    });
    for (index, value) in spikes {
        track.values[index] = value;
    }
}

/// Spikes with the values that belong there.
pub fn spikes(values: &[f64], quantum: f64) -> Vec<(usize, f64)> {
    let n = values.len();
    if n < 2 * AROUND {
        return Vec::new();
    }
    let (low, high) = (-largest(values, |v| -v), largest(values, |v| v));
    let least = (CLEAR * white_noise(values))
        .max(STEPS * quantum)
        .max(SMALL * (high - low));
    // Few samples are far enough from the mean of their neighbours to be looked at.
    let departs = |i: usize| (values[i] - 0.5 * (values[i - 1] + values[i + 1])).abs();
    let neighbours = |i: usize| {
        let own = [values[i - 2], values[i - 1], values[i + 1], values[i + 2]];
        median(&own).unwrap_or(values[i])
    };
    let mut found = Vec::new();
    for i in 2..n - 2 {
        if departs(i) <= 0.5 * least {
            continue;
        }
        let expected = neighbours(i);
        let size = (values[i] - expected).abs();
        let around = i.saturating_sub(AROUND).max(2)..(i + AROUND + 1).min(n - 2);
        let others = around.filter(|&j| j != i);
        let rough = others.map(|j| (values[j] - neighbours(j)).abs());
        if size > least && size > LONELY * rough.fold(0.0, f64::max) {
            found.push((i, expected));
        }
    }
    if found.len() as f64 > (RARE * n as f64).max(1.0) {
        found.clear();
    }
    found
}

/// Samples that belong to pulses: farther from the median than a tenth of the farthest,
/// spikes apart.
fn samples_of_pulses(values: &[f64], spikes: &[(usize, f64)]) -> usize {
    let mut values = values.to_vec();
    for &(index, value) in spikes {
        values[index] = value;
    }
    let middle = median(&values).unwrap_or(0.0);
    let far = || values.iter().map(|v| (v - middle).abs());
    let farthest = far().fold(0.0, f64::max);
    far().filter(|distance| *distance > 0.1 * farthest).count()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pulse(samples: usize) -> Vec<f64> {
        let phase = |i: usize| (i as f64 - 100.0 + 0.5) / samples as f64;
        let value = |p: f64| (std::f64::consts::PI * p).sin();
        (0..400)
            .map(|i| {
                if (0.0..1.0).contains(&phase(i)) {
                    value(phase(i))
                } else {
                    0.0
                }
            })
            .collect()
    }

    #[test]
    fn closed_form_short_pulses_are_no_spikes() {
        for samples in [2, 3, 4, 5, 8, 20, 200] {
            assert_eq!(spikes(&pulse(samples), 0.0), [], "{samples}");
        }
    }

    #[test]
    fn closed_form_a_spike_beside_a_pulse_of_few_samples_is_said_and_kept() {
        let mut values = pulse(12);
        values[300] = -3.0;
        let mut track = Track {
            name: "force".to_owned(),
            times: (0..400).map(f64::from).collect(),
            values: values.clone(),
            quantum: None,
            noise: 0.0,
            persistence: None,
        };
        let mut findings = Vec::new();
        remove_spikes(&mut track, &mut findings);
        assert_eq!(track.values, values);
        assert_eq!(findings[0].code(), "spike");
    }

    #[test]
    fn closed_form_a_spike_is_replaced_by_its_neighbours() {
        for at in [50, 150, 290] {
            let clean = pulse(200);
            let mut values = clean.clone();
            values[at] += 0.5;
            let found = spikes(&values, 0.0);
            assert_eq!(found.len(), 1, "{at}");
            assert_eq!(found[0].0, at);
            assert!((found[0].1 - clean[at]).abs() < 1e-3);
        }
    }
}
