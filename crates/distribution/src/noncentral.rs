//! Tails of the noncentral t and F distributions, on which power rests.

use crate::incomplete_beta::beta_parts;
use crate::log_gamma_rest::{deviance, stirling_rest};
use crate::tail::{f_upper, normal_upper, t_upper};
use std::f64::consts::TAU;

/// Exponent below which a part of an integral is nothing: e⁻⁴² is 6e-19.
const NOTHING: f64 = -42.0;

/// Standard deviations beyond which a normal number is not found: Φ(-39) is 1e-332.
const CERTAIN: f64 = 39.0;

/// Step of the trapezoidal rule in standard deviations of the integrand: the rule's error is
/// e^(-2π²/0.36).
const STEP: f64 = 0.6;

/// Longest step of the logarithm of the scale, whose density is analytic within ±π/4: the
/// rule's error is e^(-2π·0.78/0.1).
const LONGEST_STEP: f64 = 0.1;

/// P(T > t) of noncentral t, T = (Z + ncp)/√(χ²/df).
///
/// The probability of Z alone, averaged over the logarithm of S = √(χ²/df):
///
/// ```text
/// P = ∫ Φ(ncp - t eᵘ) g(u) du,   g(u) = 2 (df/2)^(df/2)/Γ(df/2) exp(df (u - e²ᵘ/2))
/// ```
///
/// * `ncp`: noncentrality, the expected difference in its standard errors
///
/// NaN unless df > 0 and both others are finite.
///
/// # Numerics
/// The trapezoidal rule over the whole line, which converges exponentially; all terms are
/// positive, so that small tails keep their digits. 1e-12 of R's `pt` where that is accurate.
///
/// # Source
/// Johnson, Kotz and Balakrishnan (1995), Continuous univariate distributions 2, 2nd ed.,
/// eq. 31.14; Trefethen and Weideman (2014), SIAM Rev. 56, 385 (the rule).
pub fn noncentral_t_upper(t: f64, df: f64, ncp: f64) -> f64 {
    if df.is_nan() || df <= 0.0 || !t.is_finite() || !ncp.is_finite() {
        return f64::NAN;
    }
    if ncp == 0.0 {
        return t_upper(t, df);
    }
    if df.is_infinite() {
        return normal_upper(t - ncp);
    }
    // beyond all doubt, whatever the scale
    let largest = largest_scale(df);
    if ncp - t.max(0.0) * largest > CERTAIN {
        return 1.0;
    }
    if -ncp - (-t).max(0.0) * largest > CERTAIN {
        return 0.0;
    }
    // ln g(u) = constant + df (u - (e²ᵘ - 1)/2), largest at u = 0
    let exponent = |u: f64| df * (u - 0.5 * (2.0 * u).exp_m1());
    let top = scale_density(df);
    let width = 1.0 / (2.0 * df + ncp * ncp).sqrt();
    let step = (STEP * width).min(LONGEST_STEP);
    let term = |u: f64| exponent(u).exp() * normal_upper(t * u.exp() - ncp);
    let mut sum = term(0.0);
    for side in [-1.0, 1.0] {
        let mut u = side * step;
        while exponent(u) > NOTHING {
            sum += term(u);
            u += side * step;
        }
    }
    at_most_one(top * step * sum)
}

/// What √(χ²/df) exceeds with a probability below e⁻⁴².
///
/// # Source
/// Laurent and Massart (2000), Ann. Statist. 28, 1302, eq. 4.3.
fn largest_scale(df: f64) -> f64 {
    let x = -NOTHING / df;
    (1.0 + 2.0 * x.sqrt() + 2.0 * x).sqrt()
}

/// The density of ln √(χ²/df) at zero, where it is largest: 2 (df/2)^(df/2) e^(-df/2)/Γ(df/2).
fn scale_density(df: f64) -> f64 {
    // Γ(a) = Γ(a + 1)/a, and Stirling's formula with its rest
    let a = 0.5 * df;
    (a / TAU).sqrt() * 2.0 * (-stirling_rest(a)).exp()
}

/// P(F > f) of noncentral F: a mixture of central ones with Poisson weights.
///
/// * `ncp`: sum of squares of the expected effects over the variance
///
/// NaN unless both degrees of freedom are above zero and ncp ≥ 0.
///
/// # Source
/// Johnson, Kotz and Balakrishnan (1995), ch. 30, eq. 30.10.
pub fn noncentral_f_upper(f: f64, df_above: f64, df_below: f64, ncp: f64) -> f64 {
    let known = df_above > 0.0 && df_below > 0.0 && df_below.is_finite();
    if f.is_nan() || !known || !ncp.is_finite() || ncp < 0.0 {
        return f64::NAN;
    }
    if ncp == 0.0 || f <= 0.0 {
        return f_upper(f, df_above, df_below);
    }
    // χ² of ncp is that of 1 and √ncp at least: beyond all doubt, whatever the scale
    if ncp.sqrt() - (df_above * f).sqrt() * largest_scale(df_below) > CERTAIN {
        return 1.0;
    }
    let whole = df_below + df_above * f;
    let (below, above) = (df_below / whole, df_above * f / whole);
    let mean = 0.5 * ncp;
    let term = |k: f64| {
        poisson(k, mean) * beta_parts(0.5 * df_below, 0.5 * df_above + k, below, above).lower
    };
    let middle = mean.ceil();
    let (mut sum, mut k) = (0.0, middle);
    while deviance(k, mean) < -NOTHING {
        sum += term(k);
        k += 1.0;
    }
    k = middle - 1.0;
    while k > 0.0 && deviance(k, mean) < -NOTHING {
        sum += term(k);
        k -= 1.0;
    }
    at_most_one(sum + term(0.0))
}

/// A probability without the rounding of its sum; NaN stays NaN, which `min` would hide.
pub fn at_most_one(probability: f64) -> f64 {
    match probability > 1.0 {
        true => 1.0,
        false => probability,
    }
}

/// Poisson probability of k (Loader 2000, see [`deviance`]).
fn poisson(k: f64, mean: f64) -> f64 {
    match k > 0.0 {
        true => (-stirling_rest(k) - deviance(k, mean)).exp() / (TAU * k).sqrt(),
        false => (-mean).exp(),
    }
}

#[cfg(test)]
#[allow(clippy::excessive_precision)] // as the references printed them
mod tests {
    use super::*;

    #[track_caller]
    fn check(found: f64, expected: f64, tolerance: f64, case: &str) {
        let error = (found / expected - 1.0).abs();
        assert!(
            error < tolerance,
            "{case}: {found:e} against {expected:e}: {error:e}"
        );
    }

    #[test]
    fn closed_form_without_noncentrality_and_at_the_limits() {
        // a noncentrality near nothing is none
        for (t, df) in [(2.0, 5.0), (-1.0, 1.0), (3.0, 0.5), (0.0, 7.0), (2.0, 1e6)] {
            let central = t_upper(t, df);
            check(
                noncentral_t_upper(t, df, 1e-14),
                central,
                1e-12,
                &format!("t {t} of {df}"),
            );
        }
        check(
            noncentral_t_upper(2.0, f64::INFINITY, 3.0),
            normal_upper(-1.0),
            1e-15,
            "normal",
        );
        // T > 0 where Z > -ncp, whatever the scale
        check(
            noncentral_t_upper(0.0, 4.0, 1.5),
            normal_upper(-1.5),
            1e-13,
            "t of 0",
        );
        let central = f_upper(3.0, 2.0, 9.0);
        check(
            noncentral_f_upper(3.0, 2.0, 9.0, 1e-14),
            central,
            1e-12,
            "F",
        );
        for (ncp, expected) in [(1e300, 1.0), (60.0, 1.0), (-1e300, 0.0)] {
            assert_eq!(noncentral_t_upper(2.0, 30.0, ncp), expected);
        }
        assert_eq!(noncentral_f_upper(2.0, 3.0, 30.0, 1e300), 1.0);
        assert!(noncentral_t_upper(1.0, 0.0, 1.0).is_nan());
        assert!(noncentral_t_upper(f64::NAN, 3.0, 1.0).is_nan());
        assert!(noncentral_f_upper(1.0, 2.0, 3.0, -1.0).is_nan());
    }

    /// The square of noncentral t is noncentral F.
    #[test]
    fn closed_form_t_squared_is_f() {
        for (t, df, ncp) in [
            (2.1, 3.0, 1.0),
            (2.0, 40.0, 3.3),
            (12.7, 1.0, 5.0),
            (2.5, 9.5, 12.0),
        ] {
            let both = noncentral_t_upper(t, df, ncp) + noncentral_t_upper(t, df, -ncp);
            let f = noncentral_f_upper(t * t, 1.0, df, ncp * ncp);
            check(both, f, 1e-12, &format!("t {t} of {df}, {ncp}"));
        }
    }

    /// Expected: the integral over S by mpmath 1.3 at 30 digits.
    #[test]
    fn reference_tails_of_noncentral_t() {
        for (t, df, ncp, expected) in [
            (2.1, 3.0, 1.0, 0.237559362587424058),
            (2.0, 40.0, 3.3, 0.899885180732461512),
            (12.7, 1.0, 5.0, 0.305300819123482525),
            (-1.0, 2.5, -0.7, 0.573599534329983519),
            (1.96, 1e5, 2.8, 0.799544918814510515),
            (3.0, 8.0, -1.0, 0.000607908450866310249),
            (636.6, 1.0, 3.0, 0.003760519611237858),
            (2.0, 0.7, 1.5, 0.554544824804568173),
            (9.0, 10.0, 1.0, 0.0000348197695609712187),
        ] {
            let found = noncentral_t_upper(t, df, ncp);
            check(found, expected, 1e-12, &format!("t {t} of {df}, {ncp}"));
        }
    }

    /// Expected: the sum of betas by mpmath 1.3 at 30 digits; R 4.2's `pf` is off by 1e-9.
    #[test]
    fn reference_tails_of_noncentral_f() {
        for (f, above, below, ncp, expected) in [
            (3.1, 3.0, 16.0, 5.0, 0.376080412023461823),
            (2.5, 2.0, 57.0, 12.3, 0.923581183982879763),
            (1.2, 9.5, 4.5, 60.0, 0.999458031640812745),
        ] {
            let found = noncentral_f_upper(f, above, below, ncp);
            check(
                found,
                expected,
                2e-12,
                &format!("F {f} of {above}, {below}, {ncp}"),
            );
        }
    }
}
