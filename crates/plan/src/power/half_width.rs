//! Half-width of a t interval, which is known only after the study: its mean, and the one that
//! is kept with a stated probability.

use crate::power::interval_quantile;
use libm::lgamma;
use windfall_distribution::tail::chi_squared_upper_quantile;

/// Expected value of √(χ²/df): what a standard deviation with df degrees of freedom is on
/// average, in parts of the true one.
///
/// # Source
/// Johnson, Kotz and Balakrishnan (1994), Continuous univariate distributions 1, 2nd ed.,
/// eq. 18.14 (c₄ of quality control).
pub fn mean_deviation(df: f64) -> f64 {
    /// Degrees of freedom beyond which the logarithms would cancel.
    const LARGE: f64 = 1e4;
    if df > LARGE {
        // to the order of df⁻⁴
        let inverse = 1.0 / df;
        return 1.0 - inverse / 4.0 + inverse.powi(2) / 32.0 + 5.0 * inverse.powi(3) / 128.0;
    }
    (2.0 / df).sqrt() * (lgamma(0.5 * (df + 1.0)) - lgamma(0.5 * df)).exp()
}

/// Expected half-width of the interval estimate ± t · se.
///
/// * `se`: true standard error; `df`: degrees of freedom of its estimate
/// * `confidence`: of the interval, as 0.95
///
/// NaN unless df > 0 and 0 < confidence < 1.
pub fn expected_half_width(se: f64, df: f64, confidence: f64) -> f64 {
    interval_quantile(confidence, df) * se * mean_deviation(df)
}

/// Half-width that the interval estimate ± t · se does not exceed with a probability.
///
/// * `assurance`: that probability, as 0.9
///
/// # Source
/// Kupper and Hafner (1989), Am. Stat. 43, 101.
pub fn assured_half_width(se: f64, df: f64, confidence: f64, assurance: f64) -> f64 {
    let chi_squared = chi_squared_upper_quantile(1.0 - assurance, df);
    interval_quantile(confidence, df) * se * (chi_squared / df).sqrt()
}

#[cfg(test)]
#[allow(clippy::excessive_precision)] // as the references printed them
mod tests {
    use super::*;

    #[track_caller]
    fn check(found: f64, expected: f64, tolerance: f64) {
        assert!(
            (found / expected - 1.0).abs() < tolerance,
            "{found} {expected}"
        );
    }

    /// Expected: R 4.2.2, `qt`, `qchisq` and `lgamma`; a mean of 10 values of deviation 12.
    #[test]
    fn reference_half_widths() {
        let se = 12.0 / 10f64.sqrt();
        check(expected_half_width(se, 9.0, 0.95), 8.34958234679, 1e-10);
        check(assured_half_width(se, 9.0, 0.95, 0.9), 10.9647787985, 1e-10);
        assert!(expected_half_width(se, 0.0, 0.95).is_nan());
        assert!(expected_half_width(se, 3.0, -1.0).is_nan());
    }

    #[test]
    fn closed_form_mean_deviation() {
        // one degree of freedom: |Z|; two: √(exponential)
        check(
            mean_deviation(1.0),
            (2.0 / std::f64::consts::PI).sqrt(),
            1e-14,
        );
        check(
            mean_deviation(2.0),
            0.5 * std::f64::consts::PI.sqrt(),
            1e-14,
        );
        check(
            mean_deviation(10_000.0),
            mean_deviation(10_000.000_1),
            1e-11,
        );
    }
}
