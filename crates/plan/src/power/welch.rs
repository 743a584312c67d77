//! Welch's t test of two groups with variances of their own, planned exactly.

use crate::power::half_width::mean_deviation;
use crate::power::{Sides, Test, interval_quantile};
use std::f64::consts::TAU;
use windfall_distribution::log_gamma_rest::stirling_rest;
use windfall_distribution::noncentral::{at_most_one, noncentral_t_upper};
use windfall_distribution::tail::{chi_squared_upper, t_upper_quantile};
use windfall_numerics::root::bracketed_root;

/// Two groups whose means are to be compared.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TwoGroups {
    /// Standard deviations; above zero.
    pub sds: [f64; 2],
    /// Members of each; at least two.
    pub sizes: [usize; 2],
}

/// A share b of the sum of squares within groups that falls to the first group.
///
/// With A = (n₁ - 1) s₁²/σ₁² and B alike, A + B is χ² of n₁ + n₂ - 2 degrees of freedom and
/// independent of b = A/(A + B), which is beta distributed. The squared standard error is
/// (A + B) q(b), and Welch's degrees of freedom depend on b alone.
struct Share {
    /// Weight in the integral over b.
    weight: f64,
    /// q over the squared true standard error.
    q: f64,
    /// Welch's degrees of freedom.
    df: f64,
}

/// Exponent below which a part of the integral is nothing.
const NOTHING: f64 = -42.0;

/// Power of Welch's t test: exact, where usual formulas put the true variances into Welch's
/// degrees of freedom.
///
/// * `difference`: first mean less the second; the sign counts for one-sided tests
///
/// NaN unless all sizes are at least two, standard deviations positive, 0 < α < 1.
///
/// # Source
/// Welch (1938), Biometrika 29, 350, for the degrees of freedom; the average over the share of
/// the variances is ours.
pub fn welch_power(groups: &TwoGroups, difference: f64, test: Test) -> f64 {
    let (error, df) = (true_error(groups), pooled_df(groups));
    let effect = difference / error;
    at_most_one(average(groups, |share| {
        // T < t(ν) is Z/√(χ²/df) < t(ν) √(df q)
        let critical = t_upper_quantile(test.tail(), share.df) * (df * share.q).sqrt();
        let above = noncentral_t_upper(critical, df, effect);
        match test.sides {
            Sides::One => above,
            Sides::Two => above + noncentral_t_upper(critical, df, -effect),
        }
    }))
}

/// Expected half-width of Welch's interval of the difference; exact.
pub fn welch_half_width(groups: &TwoGroups, confidence: f64) -> f64 {
    let df = pooled_df(groups);
    let root = df.sqrt() * mean_deviation(df);
    true_error(groups) * root * average(groups, |share| width(share, confidence))
}

/// Half-width that Welch's interval does not exceed with a probability; exact.
pub fn welch_assured_half_width(groups: &TwoGroups, confidence: f64, assurance: f64) -> f64 {
    let (error, df) = (true_error(groups), pooled_df(groups));
    // P(W² ≤ w²) with W² = t² q χ²
    let wider = |half: f64| {
        average(groups, |share| {
            chi_squared_upper((half / error / width(share, confidence)).powi(2), df)
        })
    };
    let (mut low, mut high) = (0.0, welch_half_width(groups, confidence));
    while wider(high) > 1.0 - assurance {
        (low, high) = (high, 2.0 * high);
        if !high.is_finite() {
            return f64::NAN;
        }
    }
    bracketed_root(low, high, 1e-12 * high, |half| {
        wider(half) - (1.0 - assurance)
    })
}

/// Welch's degrees of freedom with the true variances.
pub fn welch_df(groups: &TwoGroups) -> f64 {
    let [first, second] = shares(groups);
    let [df_first, df_second] = dfs(groups);
    (first + second).powi(2) / (first * first / df_first + second * second / df_second)
}

/// True standard error of the difference.
pub fn true_error(groups: &TwoGroups) -> f64 {
    let [first, second] = [0, 1].map(|k| groups.sds[k] / (groups.sizes[k] as f64).sqrt());
    first.hypot(second)
}

fn width(share: &Share, confidence: f64) -> f64 {
    interval_quantile(confidence, share.df) * share.q.sqrt()
}

/// Shares of the two groups in the squared true standard error.
fn shares(groups: &TwoGroups) -> [f64; 2] {
    let error = true_error(groups);
    [0, 1].map(|k| (groups.sds[k] / error).powi(2) / groups.sizes[k] as f64)
}

fn dfs(groups: &TwoGroups) -> [f64; 2] {
    groups.sizes.map(|size| size as f64 - 1.0)
}

fn pooled_df(groups: &TwoGroups) -> f64 {
    dfs(groups).iter().sum()
}

/// Mean of a function over the beta distributed share, by the trapezoidal rule in ln(b/(1 - b)),
/// in which the density is analytic and vanishes exponentially on both sides.
fn average(groups: &TwoGroups, function: impl Fn(&Share) -> f64) -> f64 {
    let [a, b] = dfs(groups).map(|df| 0.5 * df);
    let [first, second] = shares(groups);
    if !(a > 0.0 && b > 0.0 && first > 0.0 && second > 0.0) {
        return f64::NAN;
    }
    let (df_first, df_second) = (2.0 * a, 2.0 * b);
    // the density a ln x + b ln(1 - x) is largest at x = a/(a + b)
    let centre = (a / b).ln();
    let exponent = |w: f64| {
        let (x, y) = logistic(w);
        a * (x * (a + b) / a).ln() + b * (y * (a + b) / b).ln()
    };
    let constant = stirling_rest(a + b) - stirling_rest(a) - stirling_rest(b);
    let top = (a * b / (TAU * (a + b))).sqrt() * constant.exp();
    let width = ((a + b) / (a * b)).sqrt();
    let step = (0.5 * width).min(0.2);
    let term = |w: f64| {
        let (x, y) = logistic(w);
        let (own, other) = (first * x / df_first, second * y / df_second);
        let share = Share {
            weight: exponent(w).exp(),
            q: own + other,
            df: (own + other).powi(2) / (own * own / df_first + other * other / df_second),
        };
        share.weight * function(&share)
    };
    let mut sum = term(centre);
    for side in [-1.0, 1.0] {
        let mut w = centre + side * step;
        while exponent(w) > NOTHING {
            sum += term(w);
            w += side * step;
        }
    }
    top * step * sum
}

/// x = 1/(1 + e⁻ʷ) and 1 - x, both with all digits.
fn logistic(w: f64) -> (f64, f64) {
    let small = (-w.abs()).exp() / (1.0 + (-w.abs()).exp());
    let large = 1.0 / (1.0 + (-w.abs()).exp());
    if w > 0.0 {
        (large, small)
    } else {
        (small, large)
    }
}

#[cfg(test)]
#[allow(clippy::excessive_precision)] // as the references printed them
mod tests {
    use super::*;
    use crate::power::t_test::t_power;

    const TWO: Test = Test {
        alpha: 0.05,
        sides: Sides::Two,
    };

    fn groups(sds: [f64; 2], sizes: [usize; 2]) -> TwoGroups {
        TwoGroups { sds, sizes }
    }

    #[track_caller]
    fn check(found: f64, expected: f64, tolerance: f64) {
        assert!(
            (found / expected - 1.0).abs() < tolerance,
            "{found} {expected}"
        );
    }

    /// Expected: R 4.2.2, `integrate` over the two sums of squares from the test's definition
    /// (`bench/compare_statistics.R`), good to 1e-8 and better.
    #[test]
    fn reference_power_by_integration_in_r() {
        let one = Test {
            sides: Sides::One,
            ..TWO
        };
        for (own, difference, test, expected) in [
            (groups([1.0, 2.0], [10, 15]), 1.5, TWO, 0.655580258075),
            (groups([3.0, 1.0], [4, 12]), 2.0, TWO, 0.173646315233),
            (groups([1.0, 1.0], [30, 30]), 0.5, TWO, 0.477341849558),
            (groups([12.0, 15.0], [25, 50]), 8.0, one, 0.794736410465),
            (groups([1.0, 2.0], [3, 5]), 0.0, TWO, 0.0416744579719),
        ] {
            check(welch_power(&own, difference, test), expected, 1e-9);
        }
    }

    /// Expected: R 4.2.2, `integrate` and `uniroot`.
    #[test]
    fn reference_half_widths_by_integration_in_r() {
        let own = groups([1.0, 2.0], [10, 15]);
        check(welch_half_width(&own, 0.95), 1.24621021977, 1e-10);
        check(
            welch_assured_half_width(&own, 0.95, 0.9),
            1.49532651973,
            1e-9,
        );
    }

    /// With many members Welch's test is the pooled one.
    #[test]
    fn closed_form_limits() {
        let own = groups([1.0, 1.0], [20_000, 20_000]);
        let effect = 0.02 / true_error(&own);
        check(
            welch_power(&own, 0.02, TWO),
            t_power(effect, 39_998.0, TWO),
            1e-6,
        );
        check(welch_df(&own), 39_998.0, 1e-12);
        assert!(welch_power(&groups([1.0, 1.0], [1, 5]), 1.0, TWO).is_nan());
        assert!(welch_power(&groups([0.0, 1.0], [4, 5]), 1.0, TWO).is_nan());
        // the smallest groups that there are
        let least = welch_power(&groups([1.0, 5.0], [2, 2]), 3.0, TWO);
        assert!(least > 0.0 && least < 1.0, "{least}");
    }
}
