//! Covariances of estimates whose residuals are correlated along a curve.

use windfall_contact::laws::any_law::LARGEST_PARAMETERS;
use windfall_distribution::tail::t_upper_quantile;
use windfall_numerics::cholesky;

/// Probability that an interval holds the value.
const CONFIDENCE: f64 = 0.95;

/// Adds a weighted outer product.
pub(crate) fn add_product<const N: usize>(
    sum: &mut [[f64; N]; N],
    first: &[f64; N],
    second: &[f64; N],
    weight: f64,
) {
    for i in 0..N {
        for j in 0..N {
            sum[i][j] += weight * first[i] * second[j];
        }
    }
}

/// Newey and West's sum over lags, made symmetric.
pub(crate) fn add_scores<const N: usize>(
    meat: &mut [[f64; N]; N],
    scores: &[[f64; N]],
    lag: usize,
) {
    for (i, score) in scores.iter().enumerate() {
        add_product(meat, score, score, 1.0);
        for behind in 1..=lag.min(i) {
            let weight = 1.0 - behind as f64 / (lag + 1) as f64;
            add_product(meat, score, &scores[i - behind], weight);
            add_product(meat, &scores[i - behind], score, weight);
        }
    }
}

/// Lags up to which the residuals are correlated: twice the first at which the
/// autocorrelation is below a tenth.
pub(crate) fn correlation_lag(residuals: &[f64]) -> usize {
    let n = residuals.len();
    let variance: f64 = residuals.iter().map(|r| r * r).sum();
    let most = n / 4;
    let below = (1..most).find(|&lag| {
        let product: f64 = (lag..n).map(|i| residuals[i] * residuals[i - lag]).sum();
        product < 0.1 * variance
    });
    (2 * below.unwrap_or(most)).min(most).max(1)
}

/// A matrix over the parameters of any law.
pub(crate) type Square = [[f64; LARGEST_PARAMETERS]; LARGEST_PARAMETERS];

/// A covariance with variances not below those given: in a short curve the
/// sum over lags is itself uncertain, and more often too small.
pub(crate) fn at_least<const N: usize>(
    mut covariance: [[f64; N]; N],
    variance: impl Fn(usize) -> f64,
) -> [[f64; N]; N] {
    for i in 0..N {
        let factor = (variance(i) / covariance[i][i]).sqrt();
        if factor > 1.0 && factor.is_finite() {
            for j in 0..N {
                covariance[i][j] *= factor;
                covariance[j][i] *= factor;
            }
        }
    }
    covariance
}

/// bread⁻¹ over the free parameters; `None` when singular.
pub(crate) fn inverse_of_free<const N: usize>(
    bread: &[[f64; N]; N],
    free: &[usize],
) -> Option<[[f64; N]; N]> {
    let mut filled = *bread;
    for i in 0..N {
        if !free.contains(&i) {
            filled[i] = [0.0; N];
            for row in &mut filled {
                row[i] = 0.0;
            }
            filled[i][i] = 1.0;
        }
    }
    cholesky::inverse(&filled)
}

/// bread⁻¹ meat bread⁻¹ over the free parameters; `None` when singular.
pub(crate) fn sandwich<const N: usize>(
    bread: &[[f64; N]; N],
    meat: &[[f64; N]; N],
    free: &[usize],
    scale: f64,
) -> Option<[[f64; N]; N]> {
    let inverse = inverse_of_free(bread, free)?;
    let mut out = [[0.0; N]; N];
    for i in 0..N {
        for j in 0..N {
            for a in free {
                for b in free {
                    out[i][j] += scale * inverse[i][*a] * meat[*a][*b] * inverse[*b][j];
                }
            }
        }
    }
    Some(out)
}

/// vᵀ M v.
pub(crate) fn quadratic(matrix: &Square, vector: &[f64; LARGEST_PARAMETERS]) -> f64 {
    let mut sum = 0.0;
    for i in 0..LARGEST_PARAMETERS {
        for j in 0..LARGEST_PARAMETERS {
            sum += vector[i] * matrix[i][j] * vector[j];
        }
    }
    sum
}

/// Two-sided quantile of Student's distribution.
pub(crate) fn student(freedom: f64) -> f64 {
    t_upper_quantile(0.5 * (1.0 - CONFIDENCE), freedom.max(1.0))
}
