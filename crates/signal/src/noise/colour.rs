//! Correlation of a channel's noise in time, from quiet samples.

/// Fewest samples that tell it.
const LEAST_SAMPLES: usize = 50;

/// Correlations below this many standard errors are taken for none; 1.
const SIGNIFICANT: f64 = 2.0;

/// Largest value; nearer to 1 a record is a drift and not a noise; 1.
const LARGEST: f64 = 0.995;

/// Persistence φ of noise that is a first-order autoregression about its mean,
/// e_i = φ e_{i−1} + innovation; 0 where it is white. `None` if there are fewer
/// than fifty samples, or all are equal.
///
/// # Numerics
/// First autocorrelation (a sum of n − 1 products over one of n squares),
/// corrected for its bias, (1 + 4 φ)/n.
///
/// # Source
/// Marriott and Pope (1954), Bias in the estimation of autocorrelations,
/// Biometrika 41:390, with the missing product counted.
pub fn persistence(values: &[f64]) -> Option<f64> {
    let n = values.len();
    if n < LEAST_SAMPLES {
        return None;
    }
    let mean = values.iter().sum::<f64>() / n as f64;
    let power: f64 = values.iter().map(|v| (v - mean).powi(2)).sum();
    if power <= 0.0 {
        return None;
    }
    let products = values.windows(2).map(|w| (w[0] - mean) * (w[1] - mean));
    let first = products.sum::<f64>() / power;
    if first.abs() < SIGNIFICANT / (n as f64).sqrt() {
        return Some(0.0);
    }
    Some((first + (1.0 + 4.0 * first) / n as f64).clamp(-LARGEST, LARGEST))
}

/// Factor on the variance of a mean over many samples: (1 + φ)/(1 − φ).
pub fn mean_inflation(persistence: f64) -> f64 {
    (1.0 + persistence) / (1.0 - persistence)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::noise::gaussian::{noise_source, normal};

    fn autoregression(phi: f64, n: usize, seed: u64) -> Vec<f64> {
        let mut source = noise_source(seed, 0);
        let mut state = normal(&mut source);
        (0..n)
            .map(|_| {
                state = phi * state + (1.0 - phi * phi).sqrt() * normal(&mut source);
                state
            })
            .collect()
    }

    /// Over many records the mean is φ within its standard error, which the
    /// uncorrected correlation of 200 samples is not.
    #[test]
    fn recovers_the_persistence_of_short_records() {
        let records = 4000;
        for phi in [0.6, 0.9] {
            let found: Vec<f64> = (0..records)
                .map(|seed| persistence(&autoregression(phi, 200, seed)).unwrap())
                .collect();
            let n = records as f64;
            let mean = found.iter().sum::<f64>() / n;
            let square: f64 = found.iter().map(|f| (f - mean).powi(2)).sum();
            let error = (square / (n - 1.0) / n).sqrt();
            // What is left of the bias is of order 1/n².
            assert!((mean - phi).abs() < 4.0 * error + 2e-3, "{mean} {phi}");
        }
    }

    #[test]
    fn closed_form_no_persistence_of_white_or_constant_noise() {
        let white = autoregression(0.0, 5000, 3);
        assert_eq!(persistence(&white), Some(0.0));
        assert_eq!(persistence(&[1.0; 100]), None);
        assert_eq!(persistence(&white[..20]), None);
        assert_eq!(mean_inflation(0.5), 3.0);
    }
}
