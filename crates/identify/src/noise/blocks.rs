//! Samples of persistent noise, taken together in blocks.
//!
//! From sample to sample noise of persistence φ hardly changes: 1/(1 − φ)
//! samples hold little more information than their mean. What differences between neighbours
//! say beyond that rests on the noise being a first-order autoregression to its
//! highest frequencies, and on the law being right to the sample at first touch,
//! where a force that begins like √t changes fastest. Neither is so in a
//! laboratory, and the likelihood would be rugged in the onset.

use windfall_signal::impact::Series;

/// Persistence below which samples stay as they are; 1.
const LEAST_PERSISTENCE: f64 = 0.2;
/// A contact keeps at least this many blocks.
const LEAST_BLOCKS: f64 = 100.0;

/// Samples of a block for noise of this persistence, with `inside` samples in
/// the contact.
pub(crate) fn block_length(persistence: f64, inside: usize) -> usize {
    if persistence < LEAST_PERSISTENCE {
        return 1;
    }
    let wanted = (1.0 / (1.0 - persistence)).round();
    let longest = (inside as f64 / LEAST_BLOCKS).floor();
    wanted.min(longest).max(1.0) as usize
}

/// Means of successive samples, `length` at a time; a rest is left out.
pub(crate) fn means(values: &[f64], length: usize) -> Vec<f64> {
    let blocks = values.chunks_exact(length.max(1));
    let mean = |block: &[f64]| block.iter().sum::<f64>() / block.len() as f64;
    blocks.map(mean).collect()
}

/// Variance of the mean of `length` samples over that of one, and correlation of
/// successive means, of noise of persistence φ:
///
/// ```text
/// ratio = (m + 2 Σ_(l<m) (m − l) φ^l)/m²,   ρ = φ (1 − φ^m)²/(1 − φ)²/m²/ratio
/// ```
pub(crate) fn mean_noise(persistence: f64, length: usize) -> (f64, f64) {
    let m = length as f64;
    let mut sum = m;
    let mut power = 1.0;
    for lag in 1..length {
        power *= persistence;
        sum += 2.0 * (m - lag as f64) * power;
    }
    let ends = (1.0 - power * persistence) / (1.0 - persistence);
    (sum / (m * m), persistence * ends * ends / sum)
}

/// Samples of a series within a span of time.
pub(crate) fn samples_between(series: &Series, from: f64, to: f64) -> usize {
    let first = series.times.partition_point(|t| *t < from);
    series.times.partition_point(|t| *t <= to) - first
}

#[cfg(test)]
mod tests {
    use super::*;
    use windfall_signal::noise::gaussian::{noise_source, normal};

    /// Against the moments of a long simulated record.
    #[test]
    fn closed_form_noise_of_means() {
        let (persistence, length) = (0.9_f64, 10);
        let mut source = noise_source(4, 0);
        let mut value = normal(&mut source);
        let values: Vec<f64> = (0..1_000_000)
            .map(|_| {
                value = persistence * value
                    + (1.0 - persistence * persistence).sqrt() * normal(&mut source);
                value
            })
            .collect();
        let means = means(&values, length);
        let square = means.iter().map(|m| m * m).sum::<f64>() / means.len() as f64;
        let product: f64 = means.windows(2).map(|w| w[0] * w[1]).sum();
        let (ratio, correlation) = mean_noise(persistence, length);
        assert!((square / ratio - 1.0).abs() < 0.02, "{square} {ratio}");
        let seen = product / means.len() as f64 / square;
        assert!((seen - correlation).abs() < 0.01, "{seen} {correlation}");
        assert_eq!(mean_noise(0.7, 1), (1.0, 0.7));
    }

    #[test]
    fn closed_form_length_of_blocks() {
        assert_eq!(block_length(0.1, 2000), 1);
        assert_eq!(block_length(0.9, 2000), 10);
        assert_eq!(block_length(0.99, 2000), 20);
        assert_eq!(block_length(0.9, 50), 1);
        assert_eq!(means(&[1.0, 3.0, 5.0, 7.0, 9.0], 2), vec![2.0, 6.0]);
    }
}
