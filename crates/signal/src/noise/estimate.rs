//! Standard deviation of a channel's own noise.

use crate::polynomial::fit_polynomial;

/// Samples looked at to find the quantum; more would not change it.
const QUANTUM_SAMPLES: usize = 20_000;

/// Departure of a difference from a multiple of the quantum, for decimals and the arm's cosine; 1.
const MULTIPLE_TOLERANCE: f64 = 0.1;

/// Share of differences that must be multiples; 1.
const MULTIPLE_SHARE: f64 = 0.98;

/// Samples farther from the mean are no noise; standard deviations (1 in 16,000 if Gaussian).
const CLIP: f64 = 4.0;

/// Floor of the noise relative to the largest sample, for noise-free simulations; 1.
pub const RELATIVE_FLOOR: f64 = 1e-6;

/// How a noise was found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NoiseSource {
    /// Scatter about a baseline or a local polynomial.
    Scatter,
    /// Uniform error of quantisation, q/√12.
    Quantisation,
    /// Neither seen: [`RELATIVE_FLOOR`] of the largest sample.
    Floor,
}

/// Noise of one sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Noise {
    /// Standard deviation; unit of the channel. Never zero.
    pub deviation: f64,
    /// How it was found.
    pub source: NoiseSource,
}

/// The larger of scatter and quantisation, or the floor if there is neither.
///
/// * `scatter`: standard deviation seen, if any; unit of the channel
/// * `quantum`: step of the samples, if any; unit of the channel
/// * `largest`: largest magnitude in the impact; unit of the channel
pub fn combined_noise(scatter: Option<f64>, quantum: Option<f64>, largest: f64) -> Noise {
    let scatter = scatter.filter(|s| s.is_finite()).unwrap_or(0.0);
    let rounding = quantum.map_or(0.0, |q| q / 12f64.sqrt());
    let floor = RELATIVE_FLOOR * if largest > 0.0 { largest } else { 1.0 };
    let (deviation, source) = if scatter >= rounding {
        (scatter, NoiseSource::Scatter)
    } else {
        (rounding, NoiseSource::Quantisation)
    };
    if deviation > floor {
        Noise { deviation, source }
    } else {
        Noise {
            deviation: floor,
            source: NoiseSource::Floor,
        }
    }
}

/// Step between neighbouring values of a quantised signal; `None` without one.
pub fn quantum(values: &[f64]) -> Option<f64> {
    // Spread the samples looked at over the whole recording.
    let stride = values.len().div_ceil(QUANTUM_SAMPLES).max(1);
    let mut sorted: Vec<i64> = values.iter().step_by(stride).map(|v| key(*v)).collect();
    sorted.sort_unstable();
    let range = of_key(*sorted.last()?) - of_key(*sorted.first()?);
    // Equal levels that differ by rounding of the arithmetic are one level.
    let gaps: Vec<f64> = sorted
        .windows(2)
        .filter(|pair| pair[0] != pair[1])
        .map(|pair| of_key(pair[1]) - of_key(pair[0]))
        .filter(|&gap| gap > 1e-9 * range)
        .collect();
    let smallest = gaps.iter().copied().fold(f64::INFINITY, f64::min);
    // Levels come back in a quantised signal; in an even ramp they do not.
    let repeated = sorted.len() - 1 - gaps.len();
    if gaps.len() < 3 || repeated < 2 || repeated * 100 < sorted.len() {
        return None;
    }
    // Steps that are about the smallest, averaged, against rounding in files.
    let (mut sum, mut steps) = (0.0, 0);
    for gap in gaps.iter().filter(|&&gap| gap < 1.5 * smallest) {
        sum += gap;
        steps += 1;
    }
    let quantum = sum / f64::from(steps);
    let multiples = gaps
        .iter()
        .filter(|&&gap| (gap / quantum - (gap / quantum).round()).abs() < MULTIPLE_TOLERANCE)
        .count();
    (multiples as f64 >= MULTIPLE_SHARE * gaps.len() as f64).then_some(quantum)
}

/// Mean and standard deviation of a baseline, leaving out samples more than
/// four standard deviations away. `None` if empty; deviation 0 of a single sample.
pub fn baseline(values: &[f64]) -> Option<(f64, f64)> {
    let mut centre = median(values)?;
    let mut limit = f64::INFINITY;
    let mut deviation = 0.0;
    for _ in 0..10 {
        let kept = values.iter().filter(|&&v| (v - centre).abs() <= limit);
        let (mut n, mut sum, mut square) = (0usize, 0.0, 0.0);
        for value in kept {
            n += 1;
            sum += value - centre;
            square += (value - centre).powi(2);
        }
        if n == 0 {
            break;
        }
        let shift = sum / n as f64;
        centre += shift;
        let freedom = n.saturating_sub(1).max(1) as f64;
        deviation = ((square - n as f64 * shift * shift).max(0.0) / freedom).sqrt();
        if CLIP * deviation >= limit || deviation == 0.0 {
            break;
        }
        limit = CLIP * deviation;
    }
    Some((centre, deviation))
}

/// Scatter about polynomials of `order` fitted to successive blocks of `block`
/// samples: the median over the blocks, corrected for the median of χ². `None`
/// if there is no full block.
pub fn scatter_about_polynomial(
    times: &[f64],
    values: &[f64],
    block: usize,
    order: usize,
) -> Option<f64> {
    if block <= order + 1 {
        return None;
    }
    let variances: Vec<f64> = times
        .chunks_exact(block)
        .zip(values.chunks_exact(block))
        .filter_map(|(t, x)| fit_polynomial(t, x, t[block / 2], order))
        .map(|fit| fit.residual_deviation.powi(2))
        .collect();
    // Median of χ²/ν by Wilson and Hilferty (1931).
    let freedom = (block - order - 1) as f64;
    let correction = (1.0 - 2.0 / (9.0 * freedom)).powi(3);
    Some((median(&variances)? / correction).sqrt())
}

/// Median; `None` of nothing.
pub fn median(values: &[f64]) -> Option<f64> {
    median_of(values.iter().copied())
}

/// [`median`] of what an iterator gives.
pub fn median_of(values: impl Iterator<Item = f64>) -> Option<f64> {
    let mut keys: Vec<i64> = values.map(key).collect();
    let middle = keys.len() / 2;
    if keys.is_empty() {
        return None;
    }
    let odd = keys.len() % 2 == 1;
    let (below, &mut upper, _) = keys.select_nth_unstable(middle);
    let upper = of_key(upper);
    if odd {
        return Some(upper);
    }
    let lower = below.iter().max().map_or(upper, |lower| of_key(*lower));
    Some(0.5 * (lower + upper))
}

/// A whole number that orders as [`f64::total_cmp`] does: sorted in half the time.
fn key(value: f64) -> i64 {
    let bits = value.to_bits().cast_signed();
    bits ^ ((bits >> 63).cast_unsigned() >> 1).cast_signed()
}

/// The value of a [`key`].
fn of_key(key: i64) -> f64 {
    let bits = key ^ ((key >> 63).cast_unsigned() >> 1).cast_signed();
    f64::from_bits(bits.cast_unsigned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn closed_form_median() {
        assert_eq!(median(&[3.0, 1.0, 2.0]), Some(2.0));
        assert_eq!(median(&[4.0, 1.0, 2.0, 3.0]), Some(2.5));
        assert_eq!(median(&[]), None);
    }

    #[test]
    fn closed_form_quantum_of_counts() {
        let x: Vec<f64> = (0..500)
            .map(|i| (f64::from(i) * 0.37).floor() * 1.715e-4)
            .collect();
        assert!((quantum(&x).unwrap() / 1.715e-4 - 1.0).abs() < 1e-9);
        let smooth: Vec<f64> = (0..500).map(|i| (f64::from(i) * 0.37).sin()).collect();
        assert_eq!(quantum(&smooth), None);
        assert_eq!(quantum(&[1.0; 20]), None);
    }

    #[test]
    fn closed_form_noise_is_never_zero() {
        let noise = combined_noise(Some(0.0), None, 30.0);
        assert_eq!(noise.source, NoiseSource::Floor);
        assert!((noise.deviation - 3e-5).abs() < 1e-18);
        let noise = combined_noise(Some(0.0), Some(12f64.sqrt()), 30.0);
        assert_eq!(noise.source, NoiseSource::Quantisation);
        assert!((noise.deviation - 1.0).abs() < 1e-15);
        assert!(combined_noise(None, None, 0.0).deviation > 0.0);
    }

    #[test]
    fn closed_form_baseline_leaves_out_a_spike() {
        // ±1 alternating: mean 0, SD √(n/(n−1)).
        let mut values: Vec<f64> = (0..100)
            .map(|i| if i % 2 == 0 { 1.0 } else { -1.0 })
            .collect();
        let (mean, deviation) = baseline(&values).unwrap();
        assert!(mean.abs() < 1e-15 && (deviation - (100f64 / 99.0).sqrt()).abs() < 1e-12);
        values.push(80.0);
        let spiked = baseline(&values).unwrap();
        assert!((spiked.0 - mean).abs() < 1e-12 && (spiked.1 - deviation).abs() < 1e-12);
    }
}
