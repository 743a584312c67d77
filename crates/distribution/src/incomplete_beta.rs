//! The regularised incomplete beta function, in relative accuracy on both sides.

use crate::log_gamma_rest::{deviance, stirling_rest};
use std::f64::consts::PI;

/// Both parts of the regularised incomplete beta function.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BetaParts {
    /// I_x(a, b).
    pub lower: f64,
    /// 1 - I_x(a, b) = I_y(b, a), not by subtraction where it is small.
    pub upper: f64,
}

/// I_x(a, b) and its complement.
///
/// * `x`, `y`: both given, with x + y = 1, so that neither loses digits
///
/// # Numerics
/// Continued fraction on the side where it converges, times
/// x^a y^b / B(a, b) in the saddle-point form, which keeps its digits for any
/// a and b.
///
/// # Source
/// DLMF 8.17.22; Loader (2000), Fast and accurate computation of binomial
/// probabilities.
pub fn beta_parts(a: f64, b: f64, x: f64, y: f64) -> BetaParts {
    if x <= 0.0 || y >= 1.0 && x == 0.0 {
        return BetaParts {
            lower: 0.0,
            upper: 1.0,
        };
    }
    if y <= 0.0 {
        return BetaParts {
            lower: 1.0,
            upper: 0.0,
        };
    }
    let front = power_over_beta(a, b, x, y);
    // the fraction converges fast below the mean a / (a + b)
    let below = below_mean(a, b, x, y);
    if below >= 0.0 {
        let lower = front * fraction(a, b, x, y, below);
        BetaParts {
            lower,
            upper: 1.0 - lower,
        }
    } else {
        let upper = front * fraction(b, a, y, x, -below);
        BetaParts {
            lower: 1.0 - upper,
            upper,
        }
    }
}

/// a - (a + b) x = (a + b) y - b, by the smaller of its parts.
fn below_mean(a: f64, b: f64, x: f64, y: f64) -> f64 {
    match a > b {
        true => (a + b) * y - b,
        false => a - (a + b) * x,
    }
}

/// x^a y^b / B(a, b).
fn power_over_beta(a: f64, b: f64, x: f64, y: f64) -> f64 {
    let n = a + b;
    let rest = stirling_rest(n) - stirling_rest(a) - stirling_rest(b);
    let exponent = rest - deviance(a, n * x) - deviance(b, n * y);
    (a * b / (2.0 * PI * n)).sqrt() * exponent.exp()
}

/// Terms of the fraction; for a and b in the millions some thousand are used.
const MOST_TERMS: usize = 1_000_000;
/// Stands for a denominator of zero.
const TINY: f64 = 1e-300;

/// The continued fraction of I_x(a, b) B(a, b) / (x^a y^b), by Lentz's method.
///
/// * `below`: a - (a + b) x, not negative
///
/// # Source
/// DiDonato and Morris (1992), Algorithm 708, eq. 9: the even part of DLMF
/// 8.17.22, whose terms cancel less.
fn fraction(a: f64, b: f64, x: f64, y: f64, below: f64) -> f64 {
    let away = |value: f64| if value.abs() < TINY { TINY } else { value };
    let mut value = away(a / (a + 1.0) * (below + 1.0));
    let mut c = value;
    let mut d = 0.0;
    for n in 1..MOST_TERMS {
        let n = n as f64;
        let odd = a + 2.0 * n - 1.0;
        let step = n * (b - n) * x / odd;
        let numerator = (a + n - 1.0) / odd * (a + b + n - 1.0) * x * step;
        let denominator = n + step + (a + n) / (odd + 2.0) * (below + 1.0 + n * (1.0 + y));
        d = 1.0 / away(denominator + numerator * d);
        c = away(denominator + numerator / c);
        let factor = c * d;
        value *= factor;
        if (factor - 1.0).abs() < 2e-16 {
            break;
        }
    }
    1.0 / value
}
