//! Slope on values of x that are drawn with the fruit: normal with a standard deviation, so that
//! their sum of squares is that times χ² with n - 1 degrees of freedom.
//!
//! Given x the test is the t test with n - 2 degrees of freedom; power and half-width are
//! averages over the sum of squares.
//!
//! # Source
//! Gatsonis and Sampson (1989), Psychol. Bull. 106, 516: the unconditional power of a regression.

use crate::power::t_test::t_power;
use crate::power::{Test, interval_quantile};
use windfall_distribution::tail::f_upper_quantile;
use windfall_numerics::root::bracketed_root;

/// Logarithm of a part of the largest density that adds nothing.
const NOTHING: f64 = -40.0;

/// Largest ratio for which one is looked.
const LARGEST_RATIO: f64 = 1e6;

/// Power of the test of a slope, averaged over x.
///
/// * `ratio`: slope times the standard deviation of x, in standard deviations of the residuals
/// * `n`: values
///
/// NaN unless n > 2 and 0 < α < 1.
pub fn drawn_slope_power(ratio: f64, n: usize, test: Test) -> f64 {
    if n < 3 {
        return f64::NAN;
    }
    let (df, k) = (n as f64 - 2.0, n as f64 - 1.0);
    // trapezoidal rule in w = ln χ², in which the density is analytic and vanishes exponentially
    // on both sides
    let exponent = |w: f64| 0.5 * k * (w - k.ln()) - 0.5 * (w.exp() - k);
    let step = (0.5 * (2.0 / k).sqrt()).min(0.2);
    let (mut sum, mut weights) = (0.0, 0.0);
    let mut add = |w: f64| {
        let weight = exponent(w).exp();
        weights += weight;
        sum += weight * t_power(ratio * (0.5 * w).exp(), df, test);
    };
    add(k.ln());
    for side in [-1.0, 1.0] {
        let mut w = k.ln() + side * step;
        while exponent(w) > NOTHING {
            add(w);
            w += side * step;
        }
    }
    sum / weights
}

/// The ratio (see [`drawn_slope_power`]) that is found with this power; NaN where none is.
pub fn drawn_slope_detectable(power: f64, n: usize, test: Test) -> f64 {
    let reached = |ratio: f64| drawn_slope_power(ratio, n, test);
    if !(power > test.alpha && power < 1.0) || reached(1.0).is_nan() {
        return f64::NAN;
    }
    let (mut low, mut high) = (0.0, 1.0);
    while reached(high) < power {
        (low, high) = (high, 2.0 * high);
        if high > LARGEST_RATIO {
            return f64::NAN;
        }
    }
    bracketed_root(low, high, 1e-12 * high, |ratio| power - reached(ratio))
}

/// Expected half-width of the interval of a slope.
///
/// The mean of 1/χ with n - 1 degrees of freedom is 1/√(n - 2) over that of the residual's
/// χ/√(n - 2), which cancels.
///
/// * `scale`: standard deviation of the residuals over that of x
///
/// NaN unless n > 2 and 0 < confidence < 1.
pub fn drawn_slope_half_width(scale: f64, n: usize, confidence: f64) -> f64 {
    let df = n as f64 - 2.0;
    scale * interval_quantile(confidence, df) / df.sqrt()
}

/// Half-width that the interval of a slope does not exceed with a probability: the ratio of the
/// residual variance and the sum of squares of x is that of an F.
///
/// NaN unless n > 2 and both probabilities are between 0 and 1.
pub fn drawn_slope_assured_half_width(
    scale: f64,
    n: usize,
    confidence: f64,
    assurance: f64,
) -> f64 {
    let (df, k) = (n as f64 - 2.0, n as f64 - 1.0);
    let f = f_upper_quantile(1.0 - assurance, df, k);
    scale * interval_quantile(confidence, df) * (f / k).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::power::Sides;

    const TWO: Test = Test {
        alpha: 0.05,
        sides: Sides::Two,
    };

    #[track_caller]
    fn check(found: f64, expected: f64, tolerance: f64) {
        assert!(
            (found / expected - 1.0).abs() < tolerance,
            "{found} {expected}"
        );
    }

    /// Expected: R, `integrate` of `pt(ncp = …)` over `dchisq`; `qf`.
    #[test]
    fn reference_slopes_of_r() {
        let ratio = 0.02 * 8.0 / 0.3;
        for (n, power, half, assured) in [
            (3, 0.062_996_948_448, 0.476_482_677_6, 0.983_813_608_4),
            (5, 0.119_398_125_855, 0.068_901_983_66, 0.122_155_761_7),
            (30, 0.770_688_371_879, 0.014_516_721_11, 0.018_180_955_96),
        ] {
            check(drawn_slope_power(ratio, n, TWO), power, 1e-8);
            check(drawn_slope_half_width(0.3 / 8.0, n, 0.95), half, 1e-9);
            let found = drawn_slope_assured_half_width(0.3 / 8.0, n, 0.95, 0.9);
            check(found, assured, 1e-9);
        }
        let found = drawn_slope_detectable(0.770_688_371_879, 30, TWO);
        check(found, ratio, 1e-9);
        assert!(drawn_slope_power(ratio, 2, TWO).is_nan());
    }
}
