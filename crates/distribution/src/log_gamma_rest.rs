//! The rest of ln Γ after Stirling's formula, and the deviance, for densities without cancellation.

use std::f64::consts::PI;

/// ln Γ(x + 1) - [(x + ½) ln x - x + ½ ln 2π], for x > 0.
///
/// # Source
/// DLMF 5.11.1; Loader (2000), Fast and accurate computation of binomial
/// probabilities.
pub fn stirling_rest(x: f64) -> f64 {
    if x < 16.0 {
        let stirling = (x + 0.5) * x.ln() - x + 0.5 * (2.0 * PI).ln();
        return libm::lgamma(x + 1.0) - stirling;
    }
    const TERMS: [f64; 7] = [
        1.0 / 12.0,
        -1.0 / 360.0,
        1.0 / 1260.0,
        -1.0 / 1680.0,
        1.0 / 1188.0,
        -691.0 / 360_360.0,
        1.0 / 156.0,
    ];
    let square = 1.0 / (x * x);
    TERMS
        .iter()
        .rev()
        .fold(0.0, |sum, term| sum * square + term)
        / x
}

/// x ln(x / m) + m - x, without cancellation where x is near m.
///
/// # Source
/// Loader (2000), as above.
pub fn deviance(x: f64, m: f64) -> f64 {
    let difference = x - m;
    if difference.abs() > 0.1 * (x + m) {
        return x * (x / m).ln() - difference;
    }
    // with v = (x - m)/(x + m): ln(x/m) = 2 Σ v^(2j+1)/(2j+1)
    let v = difference / (x + m);
    let mut sum = difference * v;
    let mut term = 2.0 * x * v;
    for j in 1..1000 {
        term *= v * v;
        let next = sum + term / (2 * j + 1) as f64;
        if next == sum {
            break;
        }
        sum = next;
    }
    sum
}
