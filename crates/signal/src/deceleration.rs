//! Deceleration from motion alone, to find a contact without a force channel.

use crate::kinematics::{Motion, value_at};
use crate::polynomial::evenly_spaced;

/// The block is halved until halving raises the largest deceleration by less than
/// this factor: 2 for a block much longer than the contact, 1 for a much shorter one.
const SATURATION: f64 = 1.25;

/// Blocks that the recording is first divided into.
const FIRST_BLOCKS: usize = 16;

/// Deceleration seen through a block of samples.
#[derive(Clone, Debug, PartialEq)]
pub struct Deceleration {
    /// Times; s.
    pub times: Vec<f64>,
    /// −x″ of the block means, of either sign; m/s².
    pub values: Vec<f64>,
    /// Time over which it is averaged; s.
    pub resolution: f64,
}

/// Deceleration by differences of block means, with the longest block that
/// still resolves the sharpest change of velocity.
///
/// ```text
/// displacement: −(m₊ − 2 m₀ + m₋)/B²      rate: −(m₊ − m₋)/B
/// ```
///
/// with means m over successive blocks of duration B. Differences over a block
/// carry far less quantisation noise than differences between samples.
///
/// * `times`: sampling times; s. Uneven ones are resampled at their mean interval.
///
/// `None` if there are fewer than 3 samples.
pub fn deceleration(times: &[f64], values: &[f64], motion: Motion) -> Option<Deceleration> {
    let n = values.len();
    if n < 3 {
        return None;
    }
    let interval = (times[n - 1] - times[0]) / (n - 1) as f64;
    let even: Vec<f64> = if evenly_spaced(times) {
        values.to_vec()
    } else {
        (0..n)
            .map(|i| value_at(times, values, times[0] + i as f64 * interval))
            .collect()
    };
    let sums = running_sums(&even);
    let mut block = (n / FIRST_BLOCKS).max(1);
    let mut best = differences(&sums, block, interval, motion);
    while block > 1 {
        let finer = differences(&sums, block / 2, interval, motion);
        let growth = largest(&finer) / largest(&best);
        block /= 2;
        best = finer;
        if growth < SATURATION {
            break;
        }
    }
    let reach = reach(block, motion);
    Some(Deceleration {
        times: (0..best.len())
            .map(|i| times[0] + (i as f64 + reach) * interval)
            .collect(),
        values: best,
        resolution: block as f64 * interval,
    })
}

/// Distance of the first result from the first sample, in samples.
fn reach(block: usize, motion: Motion) -> f64 {
    let span = match motion {
        Motion::Displacement => 3 * block,
        Motion::Rate => 2 * block,
    };
    (span as f64 - 1.0) / 2.0
}

fn running_sums(values: &[f64]) -> Vec<f64> {
    let centre = values.iter().sum::<f64>() / values.len() as f64;
    let mut sums = Vec::with_capacity(values.len() + 1);
    let mut sum = 0.0;
    sums.push(sum);
    for value in values {
        sum += value - centre;
        sums.push(sum);
    }
    sums
}

fn differences(sums: &[f64], block: usize, interval: f64, motion: Motion) -> Vec<f64> {
    let duration = block as f64 * interval;
    let mean = |first: usize| (sums[first + block] - sums[first]) / block as f64;
    match motion {
        Motion::Displacement => (0..sums.len().saturating_sub(3 * block))
            .map(|i| {
                let bend = mean(i + 2 * block) - 2.0 * mean(i + block) + mean(i);
                -bend / (duration * duration)
            })
            .collect(),
        Motion::Rate => (0..sums.len().saturating_sub(2 * block))
            .map(|i| -(mean(i + block) - mean(i)) / duration)
            .collect(),
    }
}

fn largest(values: &[f64]) -> f64 {
    values
        .iter()
        .map(|v| v.abs())
        .fold(f64::MIN_POSITIVE, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn closed_form_constant_deceleration() {
        let times: Vec<f64> = (0..64).map(|i| 0.5 + f64::from(i) * 0.01).collect();
        let x: Vec<f64> = times.iter().map(|t| 3.0 - 4.0 * t * t).collect();
        let found = deceleration(&times, &x, Motion::Displacement).unwrap();
        assert!(found.values.iter().all(|d| (d - 8.0).abs() < 1e-6));
        let v: Vec<f64> = times.iter().map(|t| -8.0 * t).collect();
        let found = deceleration(&times, &v, Motion::Rate).unwrap();
        assert!(found.values.iter().all(|d| (d - 8.0).abs() < 1e-6));
    }

    #[test]
    fn closed_form_the_block_follows_the_contact() {
        // Half a sine of deceleration from 0.4 s to 0.6 s in 2 s of free motion.
        let times: Vec<f64> = (0..2001).map(|i| f64::from(i) * 1e-3).collect();
        let v: Vec<f64> = times
            .iter()
            .map(|&t| (((t - 0.4) / 0.2).clamp(0.0, 1.0) * std::f64::consts::PI).cos())
            .collect();
        let found = deceleration(&times, &v, Motion::Rate).unwrap();
        assert!(found.resolution > 0.01 && found.resolution < 0.1);
        let (i, peak) = found
            .values
            .iter()
            .enumerate()
            .max_by(|a, b| a.1.total_cmp(b.1))
            .unwrap();
        assert!((found.times[i] - 0.5).abs() < 2e-3);
        // Largest deceleration of the half cosine: π/0.2.
        assert!((peak / (std::f64::consts::PI / 0.2) - 1.0).abs() < 0.1);
    }
}
