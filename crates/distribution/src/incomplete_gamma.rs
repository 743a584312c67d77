//! The regularised incomplete gamma function, upper part.

use crate::log_gamma_rest::{deviance, stirling_rest};
use std::f64::consts::PI;

/// Q(a, x) = Γ(a, x) / Γ(a).
///
/// # Numerics
/// Series of the lower part below a + 1, continued fraction above, times
/// x^a e^-x / Γ(a) in the saddle-point form.
///
/// # Source
/// DLMF 8.7.1 and 8.9.2; Loader (2000).
pub fn upper_gamma(a: f64, x: f64) -> f64 {
    if a.is_nan() || x.is_nan() {
        return f64::NAN;
    }
    if x <= 0.0 {
        return 1.0;
    }
    if x.is_infinite() {
        return 0.0;
    }
    // x^a e^-x / Γ(a)
    let front = (a / (2.0 * PI)).sqrt() * (-stirling_rest(a) - deviance(a, x)).exp();
    match x < a + 1.0 {
        true => 1.0 - front * series(a, x),
        false => front * fraction(a, x),
    }
}

const MOST_TERMS: usize = 1_000_000;

/// Σ xⁿ / (a (a+1) … (a+n)).
fn series(a: f64, x: f64) -> f64 {
    let mut term = 1.0 / a;
    let mut sum = term;
    for n in 1..MOST_TERMS {
        term *= x / (a + n as f64);
        sum += term;
        if term < sum * 1e-17 {
            break;
        }
    }
    sum
}

/// 1/(x + 1 - a - (1 - a)/(x + 3 - a - …)) by Lentz's method.
fn fraction(a: f64, x: f64) -> f64 {
    let mut b = x + 1.0 - a;
    let mut c = 1e300;
    let mut d = 1.0 / b;
    let mut value = d;
    for n in 1..MOST_TERMS {
        let n = n as f64;
        let numerator = -n * (n - a);
        b += 2.0;
        let away = |value: f64| if value.abs() < 1e-300 { 1e-300 } else { value };
        d = 1.0 / away(numerator * d + b);
        c = away(b + numerator / c);
        let factor = d * c;
        value *= factor;
        if (factor - 1.0).abs() < 2e-16 {
            break;
        }
    }
    value
}
