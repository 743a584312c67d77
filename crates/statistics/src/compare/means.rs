//! Means of one or two samples: paired, with a common variance, and Welch's.

use crate::accurate_sum::{mean, variance};
use crate::sample::{check_pairs, check_probability, check_sample};
use crate::sample_error::SampleError;
use windfall_distribution::tail::{t_two_sided, t_upper_quantile};

/// A difference of means with its t test.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeanDifference {
    /// First mean less the second (or the reference); unit of the values.
    pub difference: f64,
    /// Standard error of the difference; unit of the values.
    pub standard_error: f64,
    /// Student's t.
    pub t: f64,
    /// Degrees of freedom; not whole for Welch's.
    pub df: f64,
    /// P(|T| ≥ |t|) if there were no difference.
    pub p: f64,
    /// Lower end of the interval of the difference.
    pub low: f64,
    /// Upper end.
    pub high: f64,
    /// Confidence of the interval.
    pub confidence: f64,
    /// Cohen's d, in standard deviations: of differences, pooled, or √((s₁² + s₂²)/2) (Welch).
    pub cohen_d: f64,
    /// Hedges' g: d without its bias in small samples.
    pub hedges_g: f64,
}

/// Mean of one sample against a reference.
///
/// # Errors
/// Missing values, fewer than two, no spread, or a confidence outside (0, 1).
pub fn one_sample(
    values: &[f64],
    reference: f64,
    confidence: f64,
) -> Result<MeanDifference, SampleError> {
    check_sample("the sample", values, 2)?;
    check_probability("the confidence", confidence)?;
    let n = values.len() as f64;
    let variance = variance(values);
    let difference = (mean(values) - reference.into()).value();
    let spread = Spread {
        squared_error: variance / n,
        df: n - 1.0,
        unit: variance.sqrt(),
    };
    difference_of(difference, spread, confidence)
}

/// Paired comparison: the same specimens under two conditions, or halves of one fruit.
///
/// # Errors
/// Unequal lengths, missing values, fewer than two pairs, equal differences, or
/// a confidence outside (0, 1).
///
/// # Example
/// ```
/// use windfall_statistics::compare::means::paired;
/// let found = paired(&[3.0, 5.0, 4.0], &[1.0, 4.0, 3.0], 0.95)?;
/// assert!((found.difference - 4.0 / 3.0).abs() < 1e-15);
/// assert!((found.t - 4.0).abs() < 1e-14); // 4/3 against √(1/3)/√3 = 1/3
/// # Ok::<(), windfall_statistics::sample_error::SampleError>(())
/// ```
pub fn paired(
    first: &[f64],
    second: &[f64],
    confidence: f64,
) -> Result<MeanDifference, SampleError> {
    check_pairs("the pairs", first, second, 2)?;
    let differences: Vec<f64> = first.iter().zip(second).map(|(a, b)| a - b).collect();
    one_sample(&differences, 0.0, confidence)
}

/// Two samples with a common variance (Student).
///
/// # Errors
/// Missing values, fewer than two in a sample, no spread, or a confidence
/// outside (0, 1).
pub fn pooled(
    first: &[f64],
    second: &[f64],
    confidence: f64,
) -> Result<MeanDifference, SampleError> {
    let [one, two] = check_two(first, second, confidence)?;
    let df = one.n + two.n - 2.0;
    let common = ((one.n - 1.0) * one.variance + (two.n - 1.0) * two.variance) / df;
    let spread = Spread {
        squared_error: common * (1.0 / one.n + 1.0 / two.n),
        df,
        unit: common.sqrt(),
    };
    difference_of((mean(first) - mean(second)).value(), spread, confidence)
}

/// Two samples with variances of their own (Welch); errors as in [`pooled`].
///
/// # Source
/// Welch (1947), The generalization of Student's problem when several different
/// population variances are involved, Biometrika 34.
pub fn welch(
    first: &[f64],
    second: &[f64],
    confidence: f64,
) -> Result<MeanDifference, SampleError> {
    let [one, two] = check_two(first, second, confidence)?;
    let (a, b) = (one.variance / one.n, two.variance / two.n);
    let squared_error = a + b;
    let spread = Spread {
        squared_error,
        df: squared_error * squared_error / (a * a / (one.n - 1.0) + b * b / (two.n - 1.0)),
        unit: (0.5 * (one.variance + two.variance)).sqrt(),
    };
    difference_of((mean(first) - mean(second)).value(), spread, confidence)
}

struct Moments {
    n: f64,
    variance: f64,
}

fn check_two(first: &[f64], second: &[f64], confidence: f64) -> Result<[Moments; 2], SampleError> {
    check_sample("the first sample", first, 2)?;
    check_sample("the second sample", second, 2)?;
    check_probability("the confidence", confidence)?;
    Ok([first, second].map(|values| Moments {
        n: values.len() as f64,
        variance: variance(values),
    }))
}

struct Spread {
    squared_error: f64,
    df: f64,
    /// The standard deviation that effect sizes are counted in.
    unit: f64,
}

fn difference_of(
    difference: f64,
    spread: Spread,
    confidence: f64,
) -> Result<MeanDifference, SampleError> {
    let Spread {
        squared_error,
        df,
        unit,
    } = spread;
    if squared_error <= 0.0 {
        return Err(SampleError::NoSpread("the samples compared".to_owned()));
    }
    let standard_error = squared_error.sqrt();
    let t = difference / standard_error;
    let reach = t_upper_quantile(0.5 * (1.0 - confidence), df) * standard_error;
    let cohen_d = difference / unit;
    Ok(MeanDifference {
        difference,
        standard_error,
        t,
        df,
        p: t_two_sided(t, df),
        low: difference - reach,
        high: difference + reach,
        confidence,
        cohen_d,
        hedges_g: cohen_d * small_sample_factor(df),
    })
}

/// Γ(m/2) / (√(m/2) Γ((m-1)/2)), which takes the bias from Cohen's d.
///
/// # Source
/// Hedges (1981), Distribution theory for Glass's estimator of effect size,
/// J. Educ. Stat. 6, eq. 6e.
fn small_sample_factor(df: f64) -> f64 {
    let half = 0.5 * df;
    match df > 1.0 {
        true => (libm::lgamma(half) - libm::lgamma(half - 0.5) - 0.5 * half.ln()).exp(),
        // Γ(0) below: no unbiased estimate of one degree of freedom
        false => f64::NAN,
    }
}
