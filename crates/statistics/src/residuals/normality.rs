//! Whether values, or residuals, look normal.

use crate::accurate_sum::{mean, squares_about, standard_deviation};
use crate::sample::check_sample;
use crate::sample_error::SampleError;
use windfall_distribution::tail::{normal_lower, normal_quantile, normal_upper};

/// A test of normality.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NormalityTest {
    /// The statistic.
    pub statistic: f64,
    /// Probability of a statistic this far from normal.
    pub p: f64,
}

/// Largest sample for which the p-value of [`shapiro_wilk`] was derived.
pub const SHAPIRO_WILK_LARGEST: usize = 5000;

/// The Shapiro-Wilk test: W near 1 for normal values.
///
/// # Errors
/// Fewer than 3 or more than 5000 values, missing values, or no spread.
///
/// # Source
/// Royston (1995), Remark AS R94: a remark on algorithm AS 181, the W-test for
/// normality, Appl. Stat. 44.
pub fn shapiro_wilk(values: &[f64]) -> Result<NormalityTest, SampleError> {
    check_sample("the sample", values, 3)?;
    if values.len() > SHAPIRO_WILK_LARGEST {
        return Err(SampleError::OutOfRange {
            quantity: "the number of values of the Shapiro-Wilk test",
            value: values.len() as f64,
            expected: "3 to 5000",
        });
    }
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let total = squares_about(&sorted, mean(&sorted)).value();
    if total <= 0.0 {
        return Err(no_spread());
    }
    let weights = royston_weights(sorted.len());
    let last = sorted.len() - 1;
    let contrast: f64 = weights
        .iter()
        .enumerate()
        .map(|(i, a)| a * (sorted[last - i] - sorted[i]))
        .sum();
    // 1 - W, by factors: W near 1 keeps the digits of its distance from 1
    let root = total.sqrt();
    let rest = (root - contrast) * (root + contrast) / total;
    Ok(NormalityTest {
        statistic: 1.0 - rest,
        p: royston_p(rest, sorted.len()),
    })
}

/// Weights of the differences of outer pairs, from the outermost.
fn royston_weights(n: usize) -> Vec<f64> {
    if n == 3 {
        return vec![0.5_f64.sqrt()];
    }
    let count = n as f64;
    let scores: Vec<f64> = (1..=n / 2)
        .map(|i| -normal_quantile((i as f64 - 0.375) / (count + 0.25)))
        .collect();
    let squares = 2.0 * scores.iter().map(|m| m * m).sum::<f64>();
    let norm = squares.sqrt();
    let u = 1.0 / count.sqrt();
    let first = scores[0] / norm
        + polynomial(
            &[0.0, 0.221157, -0.147981, -2.07119, 4.434685, -2.706056],
            u,
        );
    let mut weights = vec![first];
    let mut left = squares - 2.0 * scores[0] * scores[0];
    let mut share = 1.0 - 2.0 * first * first;
    if n > 5 {
        let second = scores[1] / norm
            + polynomial(
                &[0.0, 0.042981, -0.293762, -1.752461, 5.682633, -3.582633],
                u,
            );
        weights.push(second);
        left -= 2.0 * scores[1] * scores[1];
        share -= 2.0 * second * second;
    }
    let factor = (left / share).sqrt();
    weights.extend(scores[weights.len()..].iter().map(|m| m / factor));
    weights
}

/// Probability of a smaller W, from 1 - W.
fn royston_p(rest: f64, n: usize) -> f64 {
    let count = n as f64;
    if n == 3 {
        let angle = (1.0 - rest).sqrt().asin() - 0.75_f64.sqrt().asin();
        return (6.0 / std::f64::consts::PI * angle).clamp(0.0, 1.0);
    }
    let y = rest.ln();
    if n <= 11 {
        let bound = polynomial(&[-2.273, 0.459], count);
        if y >= bound {
            return 0.0;
        }
        let centre = polynomial(&[0.544, -0.39978, 0.025054, -6.714e-4], count);
        let spread = polynomial(&[1.3822, -0.77857, 0.062767, -0.0020322], count).exp();
        return normal_upper((-(bound - y).ln() - centre) / spread);
    }
    let x = count.ln();
    let centre = polynomial(&[-1.5861, -0.31082, -0.083751, 0.0038915], x);
    let spread = polynomial(&[-0.4803, -0.082676, 0.0030302], x).exp();
    normal_upper((y - centre) / spread)
}

fn polynomial(coefficients: &[f64], x: f64) -> f64 {
    coefficients.iter().rev().fold(0.0, |sum, c| sum * x + c)
}

/// The Anderson-Darling test for normal values of unknown mean and deviation.
/// The statistic is A², the p-value of A² (1 + 0.75/n + 2.25/n²).
///
/// # Errors
/// Fewer than 8 values, missing values, or no spread.
///
/// # Source
/// Stephens (1986), in D'Agostino and Stephens, Goodness-of-fit techniques,
/// table 4.9.
pub fn anderson_darling(values: &[f64]) -> Result<NormalityTest, SampleError> {
    check_sample("the sample", values, 8)?;
    let deviation = standard_deviation(values);
    if deviation <= 0.0 {
        return Err(no_spread());
    }
    let centre = mean(values).value();
    let mut scores: Vec<f64> = values.iter().map(|y| (y - centre) / deviation).collect();
    scores.sort_by(f64::total_cmp);
    let n = scores.len() as f64;
    let sum: f64 = (0..scores.len())
        .map(|i| {
            let above = normal_upper(scores[scores.len() - 1 - i]);
            (2 * i + 1) as f64 * (normal_lower(scores[i]).ln() + above.ln())
        })
        .sum();
    let statistic = -n - sum / n;
    Ok(NormalityTest {
        statistic,
        p: stephens_p(statistic * (1.0 + 0.75 / n + 2.25 / (n * n))),
    })
}

fn stephens_p(a: f64) -> f64 {
    match a {
        a if a < 0.2 => 1.0 - polynomial(&[-13.436, 101.14, -223.73], a).exp(),
        a if a < 0.34 => 1.0 - polynomial(&[-8.318, 42.796, -59.938], a).exp(),
        a if a < 0.6 => polynomial(&[0.9177, -4.279, -1.38], a).exp(),
        a if a < 153.467 => polynomial(&[1.2937, -5.709, 0.0186], a).exp(),
        // beyond, the fitted curve turns upwards again
        _ => 0.0,
    }
}

fn no_spread() -> SampleError {
    SampleError::NoSpread("the sample".to_owned())
}
