//! The studentised range: the largest difference among `means` normal values, over a
//! standard deviation estimated with `df` degrees of freedom.

use crate::log_gamma_rest::stirling_rest;
use crate::tail::{normal_lower, upper_quantile_positive};
use std::f64::consts::PI;

/// P(Q > q) of the studentised range.
///
/// * `means`: how many means are compared, at least 2
/// * `df`: degrees of freedom of the standard deviation; may be infinite
///
/// NaN for fewer than two means or no degrees of freedom.
///
/// # Numerics
/// The tail itself is integrated, so that 1e-20 keeps its digits. Both
/// integrals, over the place of the range and over the logarithm of the
/// standard deviation, are sums in equal steps of functions that are analytic
/// and vanish at both ends, whose error falls as exp(-const/step).
///
/// # Source
/// Hartley (1942), The range in random samples, Biometrika 32; definition in
/// Copenhaver and Holland (1988), J. Stat. Comput. Simul. 30.
pub fn studentized_range_upper(q: f64, means: usize, df: f64) -> f64 {
    if means < 2 || q.is_nan() || df.is_nan() || df <= 0.0 {
        return f64::NAN;
    }
    if q <= 0.0 {
        return 1.0;
    }
    let means = means as f64;
    if df.is_infinite() {
        return range_upper(q, means);
    }
    // Far out only deviations near zero matter, whose density is a power: so is the tail.
    let far = FAR * df.max(1.0).sqrt();
    match q > far {
        true => over_deviations(far, means, df) * (far / q).powf(df),
        false => over_deviations(q, means, df),
    }
}

/// Beyond this times √ν the tail falls as q^-ν, to 1 part in 10⁴.
const FAR: f64 = 500.0;

/// The q with P(Q > q) = `probability`.
pub fn studentized_range_upper_quantile(probability: f64, means: usize, df: f64) -> f64 {
    upper_quantile_positive(probability, |q| studentized_range_upper(q, means, df))
}

/// Exponent at which the integrands end: exp(-45) is 3e-20 of their peak.
const NEGLIGIBLE: f64 = 45.0;

/// ∫ f(s) P(range > q s) ds over u = ln s, where s² df is χ².
fn over_deviations(q: f64, means: f64, df: f64) -> f64 {
    // the peak of the product lies between ln(2/q) and 0
    let reach = (NEGLIGIBLE / df).sqrt();
    let start = (2.0 / q).ln().min(0.0) - reach - NEGLIGIBLE / df;
    // steps well within the width 1/√(2 df) and the strip |Im u| < π/4
    let step = (0.6 / (2.0 * df).sqrt()).min(0.11);
    let steps = ((reach - start) / step).ceil() as usize;
    let sum: f64 = (0..=steps)
        .map(|i| start + i as f64 * step)
        .map(|u| {
            let density = (-df * (0.5 * (2.0 * u).exp_m1() - u)).exp();
            match density > 0.0 {
                true => density * range_upper(q * u.exp(), means),
                false => 0.0,
            }
        })
        .sum();
    let half = 0.5 * df;
    let front = 2.0 * (half / (2.0 * PI)).sqrt() * (-stirling_rest(half)).exp();
    (front * step * sum).min(1.0)
}

/// P(range > w) of normal values of known deviation,
///
/// r ∫ φ(z) (Φ(z)^(r-1) - [Φ(z) - Φ(z - w)]^(r-1)) dz.
fn range_upper(w: f64, means: f64) -> f64 {
    const START: f64 = -9.0;
    let end = 0.5 * w + 9.0;
    let step = 0.6 / means.sqrt();
    let steps = ((end - START) / step).ceil() as usize;
    let sum: f64 = (0..=steps)
        .map(|i| START + i as f64 * step)
        .map(|z| {
            let all = normal_lower(z);
            let ratio = normal_lower(z - w) / all;
            let power = (means - 1.0) * (-ratio).ln_1p();
            (-0.5 * z * z).exp() * all.powf(means - 1.0) * -power.exp_m1()
        })
        .sum();
    means * sum * step / (2.0 * PI).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The power of the far tail against the integral itself.
    #[test]
    fn closed_form_far_tails_are_powers() {
        for (means, df) in [(3, 1.0), (3, 4.0), (10, 8.0), (20, 15.0)] {
            let q = 2.0 * FAR * f64::sqrt(df);
            let found = studentized_range_upper(q, means, df);
            let integral = over_deviations(q, means as f64, df);
            assert!(
                (found / integral - 1.0).abs() < 1e-3,
                "{means} {df}: {found:e} {integral:e}"
            );
        }
        assert!(studentized_range_upper(1e300, 3, 9.0) < 1e-300);
    }
}
