//! Power of t tests and of F tests of several means.

use crate::power::{Sides, Test};
use windfall_distribution::noncentral::{at_most_one, noncentral_f_upper, noncentral_t_upper};
use windfall_distribution::tail::{f_upper_quantile, t_upper_quantile};
use windfall_numerics::root::bracketed_root;

/// Largest effect in standard errors for which one is looked.
const LARGEST_EFFECT: f64 = 1e6;

/// Power of a t test: the probability that it rejects.
///
/// * `effect`: expected estimate in its standard errors, as (μ₁ - μ₂)/(σ √(2/n)) for two
///   groups of n; the sign counts for one-sided tests
/// * `df`: degrees of freedom of the standard error
///
/// NaN unless df > 0 and 0 < α < 1.
///
/// # Source
/// Cohen (1988), Statistical power analysis for the behavioral sciences, 2nd ed., ch. 2.
pub fn t_power(effect: f64, df: f64, test: Test) -> f64 {
    let critical = t_upper_quantile(test.tail(), df);
    let above = noncentral_t_upper(critical, df, effect);
    match test.sides {
        Sides::One => above,
        Sides::Two => at_most_one(above + noncentral_t_upper(critical, df, -effect)),
    }
}

/// The effect in standard errors that a t test finds with this power: times the standard
/// error, the smallest detectable difference.
///
/// NaN unless df > 0 and α < power < 1.
pub fn detectable_effect(power: f64, df: f64, test: Test) -> f64 {
    if !(power > test.alpha && power < 1.0) || t_power(1.0, df, test).is_nan() {
        return f64::NAN;
    }
    let mut high = 1.0;
    while t_power(high, df, test) < power {
        high *= 2.0;
        if high > LARGEST_EFFECT {
            return f64::NAN;
        }
    }
    let low = if high > 1.0 { 0.5 * high } else { 0.0 };
    bracketed_root(low, high, 1e-13 * high, |effect| {
        power - t_power(effect, df, test)
    })
}

/// Power of the F test that several means are equal.
///
/// * `noncentrality`: Σ n (μᵢ - μ̄)²/σ² over the groups, n of each
///
/// NaN unless both degrees of freedom are above zero and 0 < α < 1.
///
/// # Source
/// Cohen (1988), ch. 8; R's `power.anova.test`.
pub fn f_power(noncentrality: f64, df_above: f64, df_below: f64, alpha: f64) -> f64 {
    let critical = f_upper_quantile(alpha, df_above, df_below);
    noncentral_f_upper(critical, df_above, df_below, noncentrality)
}

#[cfg(test)]
#[allow(clippy::excessive_precision)] // as the references printed them
mod tests {
    use super::*;

    const TWO: Test = Test {
        alpha: 0.05,
        sides: Sides::Two,
    };

    #[track_caller]
    fn check(found: f64, expected: f64) {
        assert!((found / expected - 1.0).abs() < 1e-10, "{found} {expected}");
    }

    /// Expected: R 4.2.2, `power.t.test(…, strict = TRUE)` and `power.anova.test`.
    #[test]
    fn reference_power_of_r() {
        let two_groups = |n: f64, delta: f64, sd: f64| delta / (sd * (2.0 / n).sqrt());
        check(
            t_power(two_groups(20.0, 1.0, 1.5), 38.0, TWO),
            0.537786846676,
        );
        let one_sided = Test {
            sides: Sides::One,
            ..TWO
        };
        check(
            t_power(two_groups(20.0, 1.0, 1.5), 38.0, one_sided),
            0.664786359001,
        );
        check(t_power(2.0 / 1.2 * 6f64.sqrt(), 5.0, TWO), 0.898771623846);
        let strict = Test { alpha: 0.01, ..TWO };
        check(t_power(0.3 * 2f64.sqrt(), 1.0, strict), 0.0108865867117);
        check(
            t_power(two_groups(300.0, 0.1, 1.0), 598.0, TWO),
            0.231234202683,
        );
        // variance between groups 1, within 3: Σ n (μᵢ - μ̄)²/σ² = n (k - 1) / 3; by mpmath 1.3,
        // as R's `pf` is off by 1e-9 here (0.353559423815, 0.101210040663)
        check(f_power(5.0, 3.0, 16.0, 0.05), 0.353559423722993394);
        check(
            f_power(12.0 * 2.0 / 9.0, 2.0, 33.0, 0.01),
            0.101210040467492886,
        );
    }

    /// Expected: the root of R's `pt`, by `uniroot`.
    #[test]
    fn reference_detectable_effect() {
        check(detectable_effect(0.8, 18.0, TWO), 2.96267243642);
    }

    #[test]
    fn closed_form_limits() {
        check(t_power(0.0, 7.0, TWO), 0.05);
        check(f_power(0.0, 2.0, 7.0, 0.05), 0.05);
        let found = detectable_effect(0.9, 3.0, TWO);
        check(t_power(found, 3.0, TWO), 0.9);
        assert!(detectable_effect(0.05, 3.0, TWO).is_nan());
        assert!(detectable_effect(1.0, 3.0, TWO).is_nan());
        assert!(t_power(1.0, 0.0, TWO).is_nan());
        assert!(t_power(1.0, 5.0, Test { alpha: 1.5, ..TWO }).is_nan());
    }
}
