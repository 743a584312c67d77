//! Shares of variance.

use crate::fit::MixedFit;
use nalgebra::DVector;

/// Where the variance of the response comes from.
#[derive(Clone, Debug, PartialEq)]
pub struct VarianceShares {
    /// Variance of X β over the rows (denominator n - 1).
    pub fixed: f64,
    /// Mean variance of each random term's effects over the rows: z'Σz.
    pub random: Vec<f64>,
    /// Mean residual variance over the rows: σ² over their weights.
    pub residual: f64,
    /// R² of the fixed effects.
    pub r2_marginal: f64,
    /// R² of fixed and random effects.
    pub r2_conditional: f64,
    /// Intraclass correlation of each term: its share of what the fixed effects leave.
    pub intraclass: Vec<f64>,
}

/// Shares of variance.
///
/// # Source
/// Nakagawa and Schielzeth (2013), Methods Ecol. Evol. 4, 133-142; random slopes as
/// in Johnson (2014), 5, 944-946.
pub fn variance_shares(fit: &MixedFit) -> VarianceShares {
    let n = fit.model.rows() as f64;
    let weights = &fit.model.weights;
    let mut expected = &fit.model.x * DVector::from_column_slice(&fit.coefficients);
    let rows = expected.iter_mut().enumerate();
    rows.for_each(|(row, own)| *own /= weights.root(row));
    let mean = expected.mean();
    let fixed = expected
        .iter()
        .map(|value| (value - mean).powi(2))
        .sum::<f64>()
        / (n - 1.0);
    let random: Vec<f64> = fit
        .model
        .terms
        .iter()
        .zip(&fit.variances)
        .map(|(term, variance)| {
            let rows = (0..fit.model.rows()).map(|row| {
                let z =
                    DVector::from_iterator(term.columns.len(), term.columns.iter().map(|c| c[row]));
                (z.transpose() * &variance.covariance * z)[(0, 0)] / weights.weight(row)
            });
            rows.sum::<f64>() / n
        })
        .collect();
    let rows = (0..fit.model.rows()).map(|row| 1.0 / weights.weight(row));
    let residual = fit.residual_sd * fit.residual_sd * (rows.sum::<f64>() / n);
    let groups: f64 = random.iter().sum();
    let total = fixed + groups + residual;
    VarianceShares {
        r2_marginal: fixed / total,
        r2_conditional: (fixed + groups) / total,
        intraclass: random.iter().map(|r| r / (groups + residual)).collect(),
        fixed,
        random,
        residual,
    }
}
