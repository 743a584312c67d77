//! Tail probabilities and quantiles of the normal, Student's t, F and χ² distributions,
//! accurate in relative terms far out in the tails: never computed as 1 - P.

use crate::incomplete_beta::{BetaParts, beta_parts};
use crate::incomplete_gamma::upper_gamma;
use std::f64::consts::SQRT_2;

/// P(Z > z) of the standard normal distribution.
pub fn normal_upper(z: f64) -> f64 {
    0.5 * libm::erfc(z / SQRT_2)
}

/// P(Z ≤ z) of the standard normal distribution.
pub fn normal_lower(z: f64) -> f64 {
    normal_upper(-z)
}

/// The z with P(Z ≤ z) = `probability`.
pub fn normal_quantile(probability: f64) -> f64 {
    match probability > 0.5 {
        // 1 - p is exact here, and small tails keep their digits
        true => normal_upper_quantile(1.0 - probability),
        false => -normal_upper_quantile(probability),
    }
}

/// The z with P(Z > z) = `probability`.
pub fn normal_upper_quantile(probability: f64) -> f64 {
    upper_quantile_on_line(probability, normal_upper)
}

/// Above zero, and a number.
fn has_freedom(df: f64) -> bool {
    df > 0.0
}

/// P(|T| > |t|) of Student's t: the two-sided p-value.
pub fn t_two_sided(t: f64, df: f64) -> f64 {
    if t.is_nan() || !has_freedom(df) {
        return f64::NAN;
    }
    if df.is_infinite() {
        return 2.0 * normal_upper(t.abs());
    }
    if t.is_infinite() {
        return 0.0;
    }
    let square = t * t;
    beta_parts(0.5 * df, 0.5, df / (df + square), square / (df + square)).lower
}

/// P(T > t) of Student's t.
pub fn t_upper(t: f64, df: f64) -> f64 {
    let half = 0.5 * t_two_sided(t, df);
    if t >= 0.0 { half } else { 1.0 - half }
}

/// The t with P(T > t) = `probability`, 0.025 for a two-sided interval of 0.95.
pub fn t_upper_quantile(probability: f64, df: f64) -> f64 {
    upper_quantile_on_line(probability, |t| t_upper(t, df))
}

/// P(F > f) of Fisher's F.
pub fn f_upper(f: f64, df_above: f64, df_below: f64) -> f64 {
    if f.is_nan() || !has_freedom(df_above) || !has_freedom(df_below) {
        return f64::NAN;
    }
    if f <= 0.0 {
        return 1.0;
    }
    if f.is_infinite() {
        return 0.0;
    }
    if df_below.is_infinite() {
        return chi_squared_upper(f * df_above, df_above);
    }
    let whole = df_below + df_above * f;
    let below = df_below / whole;
    beta_parts(0.5 * df_below, 0.5 * df_above, below, df_above * f / whole).lower
}

/// The f with P(F > f) = `probability`.
pub fn f_upper_quantile(probability: f64, df_above: f64, df_below: f64) -> f64 {
    upper_quantile_positive(probability, |f| f_upper(f, df_above, df_below))
}

/// P(X > x) of χ².
pub fn chi_squared_upper(x: f64, df: f64) -> f64 {
    match has_freedom(df) {
        true => upper_gamma(0.5 * df, 0.5 * x),
        false => f64::NAN,
    }
}

/// The x with P(X > x) = `probability` of χ².
pub fn chi_squared_upper_quantile(probability: f64, df: f64) -> f64 {
    upper_quantile_positive(probability, |x| chi_squared_upper(x, df))
}

/// P(B ≤ x) of the beta distribution.
pub fn beta_lower(x: f64, a: f64, b: f64) -> f64 {
    let BetaParts { lower, .. } = beta_parts(a, b, x, 1.0 - x);
    lower
}

/// Quantile of a symmetric distribution on the line.
fn upper_quantile_on_line(probability: f64, upper: impl Fn(f64) -> f64) -> f64 {
    if !(0.0..=1.0).contains(&probability) || upper(1.0).is_nan() {
        return f64::NAN;
    }
    if probability > 0.5 {
        // by symmetry; 1 - p loses nothing that p holds
        return -upper_quantile_positive(1.0 - probability, upper);
    }
    if probability == 0.5 {
        return 0.0;
    }
    upper_quantile_positive(probability, upper)
}

/// Quantile of a distribution on positive numbers: bracketed in steps of its logarithm,
/// comparing logarithms of the probability, in which tails are close to straight lines.
pub(crate) fn upper_quantile_positive(probability: f64, upper: impl Fn(f64) -> f64) -> f64 {
    if !(0.0..=1.0).contains(&probability) || upper(1.0).is_nan() {
        return f64::NAN;
    }
    if probability == 0.0 {
        return f64::INFINITY;
    }
    if probability == 1.0 {
        return 0.0;
    }
    let target = probability.ln();
    let excess = |log_x: f64| upper(log_x.exp()).max(f64::MIN_POSITIVE).ln() - target;
    let (mut low, mut high) = (-1.0, 1.0);
    while excess(low) < 0.0 && low > -700.0 {
        (low, high) = (2.0 * low, low);
    }
    while excess(high) > 0.0 && high < 700.0 {
        (low, high) = (high, 2.0 * high);
    }
    let tolerance = 4.0 * f64::EPSILON * low.abs().max(high.abs()).max(0.25);
    let log_x = windfall_numerics::root::bracketed_root(low, high, tolerance, excess);
    log_x.exp()
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

    // Expected tails: mpmath 1.3 at 50 digits (betainc, gammainc, erfc).

    #[test]
    fn reference_tails_of_students_t() {
        for (t, df, expected) in [
            (2.0, 5.0, 0.101939478829858356),
            (5.0, 30.0, 2.32966854670077951e-5),
            (8.0, 1e3, 3.4266614823914744e-15),
            (1.5, 1e6, 0.133614718236792769),
            (20.0, 7.0, 1.95488271080039929e-7),
            (40.0, 100.0, 2.46210760214007082e-63),
            (0.001, 3.0, 0.999264894969460938),
            (0.5, 2.75, 0.654315866641037482),
            (2.0, 1e8, 0.0455002665959067529),
            (3.0, 1.0, 0.204832764699133452),
        ] {
            check(
                t_two_sided(t, df),
                expected,
                5e-14,
                &format!("t {t} of {df}"),
            );
        }
    }

    #[test]
    fn reference_tails_of_f() {
        for (f, above, below, expected) in [
            (3.0, 2.0, 20.0, 0.0725381502864057202),
            (21.0, 8.0, 180.0, 2.58326433726897139e-22),
            (158.0, 7.0, 7.0, 3.62993636254367713e-7),
            (1.01, 10.0, 1e6, 0.431765136134842569),
            (2.0, 1.0, 1e6, 0.157299518380834687),
            (300.0, 3.0, 1000.0, 7.30617940152532948e-139),
            (0.25, 3.0, 17.5, 0.860245608730132623),
            (0.01, 4.0, 4.0, 0.999707852365473779),
            (1.1, 1000.0, 1000.0, 0.0659919262868824124),
        ] {
            check(
                f_upper(f, above, below),
                expected,
                2e-13,
                &format!("F {f} of {above}, {below}"),
            );
        }
    }

    #[test]
    fn reference_tails_of_chi_squared_and_normal() {
        for (x, df, expected) in [
            (3.84, 1.0, 0.0500435212487051032),
            (30.0, 10.0, 0.000856641210775300392),
            (300.0, 100.0, 7.41210085732287679e-22),
            (500.0, 20.0, 2.91026687302731008e-93),
            (0.1, 3.0, 0.991837423731876478),
            (1100.0, 1e3, 0.014614408126295194),
            (2.0, 7.0, 0.959840368730101557),
        ] {
            check(
                chi_squared_upper(x, df),
                expected,
                5e-14,
                &format!("χ² {x} of {df}"),
            );
        }
        for (z, expected) in [
            (0.1, 0.460172162722971016),
            (1.0, 0.158655253931457051),
            (6.0, 9.86587645037698141e-10),
            (20.0, 2.7536241186062337e-89),
            (-2.0, 0.977249868051820793),
        ] {
            check(normal_upper(z), expected, 5e-14, &format!("normal {z}"));
        }
    }

    /// Expected: R 4.2.2, qt, qf, qchisq and qnorm.
    #[test]
    fn reference_quantiles() {
        for (df, expected) in [
            (1.0, 12.7062047361746941),
            (5.0, 2.5705818356363137),
            (30.0, 2.0422724563012378),
            (1e6, 1.9599663568141066),
            (2.5, 3.5746548420036919),
        ] {
            check(
                t_upper_quantile(0.025, df),
                expected,
                1e-12,
                &format!("t of {df}"),
            );
        }
        check(
            f_upper_quantile(0.05, 3.0, 17.0),
            3.1967768409433428,
            1e-12,
            "F",
        );
        check(
            f_upper_quantile(1e-6, 8.0, 1e5),
            5.3385938230982033,
            1e-11,
            "F",
        );
        for (df, expected) in [
            (1.0, 3.841458820694124),
            (10.0, 18.307038053275146),
            (500.0, 553.126808934256815),
        ] {
            check(
                chi_squared_upper_quantile(0.05, df),
                expected,
                1e-12,
                &format!("χ² of {df}"),
            );
        }
        for (p, expected) in [
            (0.975, 1.95996398454005361),
            (0.3, -0.52440051270804067),
            (1e-10, -6.36134090240405570),
            (1e-300, -37.04709629936120052),
        ] {
            check(normal_quantile(p), expected, 1e-13, &format!("normal {p}"));
        }
    }

    #[test]
    fn closed_form_ends() {
        assert_eq!(t_two_sided(0.0, 7.0), 1.0);
        assert_eq!(t_two_sided(f64::INFINITY, 7.0), 0.0);
        assert!((t_upper(-1.0, 1.0) - 0.75).abs() < 1e-15);
        assert_eq!(f_upper(0.0, 2.0, 3.0), 1.0);
        assert_eq!(normal_quantile(0.5), 0.0);
        assert!(t_two_sided(f64::NAN, 7.0).is_nan());
        assert!(t_two_sided(1.0, 0.0).is_nan() && f_upper(1.0, 2.0, 0.0).is_nan());
        assert!(t_upper_quantile(0.1, 0.0).is_nan() && t_upper_quantile(1.1, 3.0).is_nan());
        // one degree of freedom: t of 1/4 is tan(π/4)
        assert!((t_upper_quantile(0.25, 1.0) - 1.0).abs() < 1e-14);
    }
}
