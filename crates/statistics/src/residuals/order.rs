//! Whether successive residuals are correlated.

use crate::orthonormal::{dot, orthonormal_basis, take_out};
use crate::sample::check_sample;
use crate::sample_error::SampleError;
use nalgebra::{DMatrix, DVector};
use std::f64::consts::PI;
use windfall_distribution::tail::beta_lower;

/// The Durbin-Watson statistic.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DurbinWatson {
    /// Σ (eᵢ - eᵢ₋₁)² / Σ eᵢ²: 2 if independent, less if neighbours are alike.
    pub statistic: f64,
    /// Probability of a smaller statistic of independent residuals.
    pub p_alike: f64,
    /// Probability of a larger one: small where they alternate.
    pub p_alternating: f64,
    /// Twice the smaller of both.
    pub p: f64,
}

/// Most residuals with an exact p-value, which needs as many eigenvalues.
pub const EXACT_UP_TO: usize = 200;

/// The Durbin-Watson statistic of residuals of a linear model.
///
/// * `design`: n × p, with the intercept as a column if the model has one
///
/// # Errors
/// Missing values, lengths that differ, fewer than three residuals more than
/// terms, no spread.
///
/// # Numerics
/// Exact for this design up to [`EXACT_UP_TO`] residuals; beyond, the p-value of
/// a beta distribution on (0, 4) with the exact mean and variance of the
/// statistic, which is within a thousandth of the exact one there.
///
/// # Source
/// Durbin and Watson (1951), Testing for serial correlation in least squares
/// regression II, Biometrika 38; Imhof (1961), Computing the distribution of
/// quadratic forms in normal variables, Biometrika 48.
pub fn durbin_watson(
    residuals: &[f64],
    design: &DMatrix<f64>,
) -> Result<DurbinWatson, SampleError> {
    check_sample("the residuals", residuals, 3)?;
    if design.nrows() != residuals.len() {
        return Err(SampleError::lengths(
            "residuals and rows of the design",
            residuals.len(),
            design.nrows(),
        ));
    }
    let basis = orthonormal_basis(design);
    let df = residuals.len() as f64 - basis.len() as f64;
    if df < 3.0 {
        return Err(SampleError::too_few(
            "the residuals",
            residuals.len(),
            basis.len() + 3,
        ));
    }
    let squares = dot(residuals, residuals);
    if squares <= 0.0 {
        return Err(SampleError::NoSpread("the residuals".to_owned()));
    }
    let steps = residuals.windows(2).map(|pair| pair[1] - pair[0]);
    let statistic = steps.map(|step| step * step).sum::<f64>() / squares;
    let (p_alike, p_alternating) = match residuals.len() <= EXACT_UP_TO {
        true => {
            let smaller = smaller_exact(statistic, &basis, residuals.len());
            (smaller, 1.0 - smaller)
        }
        false => smaller_beta(statistic, moments(&basis, residuals.len() as f64, df)),
    };
    Ok(DurbinWatson {
        statistic,
        p_alike,
        p_alternating,
        p: (2.0 * p_alike.min(p_alternating)).min(1.0),
    })
}

/// P(D < d) = P(Σ (λᵢ - d) zᵢ² < 0) with eigenvalues λ of MAM, by Imhof's integral.
fn smaller_exact(d: f64, basis: &[Vec<f64>], n: usize) -> f64 {
    let differences = |mut v: Vec<f64>| {
        take_out(basis, &mut v);
        v = second_differences(&v);
        take_out(basis, &mut v);
        v
    };
    let columns: Vec<_> = (0..n)
        .map(|j| (0..n).map(|i| f64::from(u8::from(i == j))).collect())
        .map(|unit| DVector::from_vec(differences(unit)))
        .collect();
    let matrix = DMatrix::from_columns(&columns);
    let symmetric = 0.5 * (&matrix + matrix.transpose());
    let mut weights: Vec<f64> = symmetric.symmetric_eigenvalues().iter().copied().collect();
    weights.sort_by(f64::total_cmp);
    // the smallest are the zeros of what the model takes out
    let weights: Vec<f64> = weights[basis.len()..].iter().map(|l| l - d).collect();
    // P(Σ μ z² > 0) = 1/2 + 1/π ∫ sin θ(u) / ρ(u) d ln u
    const STEP: f64 = 0.1;
    let integral: f64 = (-420..=420)
        .map(|i| (f64::from(i) * STEP).exp())
        .map(|u| {
            let angle: f64 = weights.iter().map(|m| (m * u).atan()).sum();
            let size: f64 = weights.iter().map(|m| (m * u).powi(2).ln_1p()).sum();
            (0.5 * angle).sin() * (-0.25 * size).exp()
        })
        .sum::<f64>()
        * STEP;
    (0.5 - integral / PI).clamp(0.0, 1.0)
}

/// P(D < d) and P(D > d) of a beta distribution of d/4 with these moments.
fn smaller_beta(d: f64, (mean, variance): (f64, f64)) -> (f64, f64) {
    let (m, v) = (0.25 * mean, variance / 16.0);
    let whole = m * (1.0 - m) / v - 1.0;
    let (a, b) = (whole * m, whole * (1.0 - m));
    let x = (0.25 * d).clamp(0.0, 1.0);
    (beta_lower(x, a, b), beta_lower(1.0 - x, b, a))
}

/// Mean and variance of the statistic: traces of (MA) and (MA)².
fn moments(basis: &[Vec<f64>], n: f64, df: f64) -> (f64, f64) {
    let differences: Vec<Vec<f64>> = basis.iter().map(|v| second_differences(v)).collect();
    let mut once = 2.0 * (n - 1.0);
    let mut twice = 2.0 * (3.0 * n - 4.0);
    for (i, row) in differences.iter().enumerate() {
        once -= dot(&basis[i], row);
        twice -= 2.0 * dot(row, row);
        for vector in basis {
            twice += dot(vector, row).powi(2);
        }
    }
    let mean = once / df;
    let variance = 2.0 * (twice - once * mean) / (df * (df + 2.0));
    (mean, variance)
}

fn second_differences(v: &[f64]) -> Vec<f64> {
    let last = v.len() - 1;
    (0..v.len())
        .map(|i| {
            let before = if i > 0 { v[i] - v[i - 1] } else { 0.0 };
            let after = if i < last { v[i] - v[i + 1] } else { 0.0 };
            before + after
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Both ways to the p-value agree where either is good.
    #[test]
    fn converges_to_the_beta_distribution() {
        let n = 150;
        let design = DMatrix::from_fn(n, 2, |i, j| if j == 0 { 1.0 } else { i as f64 });
        let basis = orthonormal_basis(&design);
        for d in [1.5, 1.8, 2.0, 2.3] {
            let exact = smaller_exact(d, &basis, n);
            let (beta, _) = smaller_beta(d, moments(&basis, n as f64, n as f64 - 2.0));
            assert!((exact - beta).abs() < 1e-3, "{d}: {exact} {beta}");
        }
    }

    /// Two residuals of no model: D = 1 - sin 2φ of a uniform angle φ.
    #[test]
    fn closed_form_two_values() {
        // D = (x - y)²/(x² + y²) = 1 - sin 2φ; P(D < 1/2) = P(sin 2φ > 1/2) = 1/3
        let p = smaller_exact(0.5, &[], 2);
        assert!((p - 1.0 / 3.0).abs() < 1e-12, "{p}");
    }
}
