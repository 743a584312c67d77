//! Shares of variance, and the comparison of two models.

use crate::distribution::tail::chi_squared_upper;
use crate::mixed::error::MixedError;
use crate::mixed::finding::MixedFinding;
use crate::mixed::fit::{MixedFit, MixedMethod};
use nalgebra::DVector;

/// Responses of two fits that differ by more than this share are not the same.
const SAME_RESPONSE: f64 = 1e-9;

/// Where the variance of the response comes from.
#[derive(Clone, Debug, PartialEq)]
pub struct VarianceShares {
    /// Variance of X β over the rows (denominator n - 1).
    pub fixed: f64,
    /// Mean variance of each random term's effects over the rows: z'Σz.
    pub random: Vec<f64>,
    /// Residual variance.
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
#[must_use]
pub fn variance_shares(fit: &MixedFit) -> VarianceShares {
    let n = fit.model.rows() as f64;
    let expected = &fit.model.x * DVector::from_column_slice(&fit.coefficients);
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
                (z.transpose() * &variance.covariance * z)[(0, 0)]
            });
            rows.sum::<f64>() / n
        })
        .collect();
    let residual = fit.residual_sd * fit.residual_sd;
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

/// Likelihood ratio test of two nested models.
#[derive(Clone, Debug, PartialEq)]
pub struct LikelihoodRatio {
    /// Twice the difference of log likelihoods.
    pub chi_square: f64,
    /// Difference in parameters.
    pub df: usize,
    /// p-value of chi-square.
    pub p: f64,
    /// What the reader should know.
    pub findings: Vec<MixedFinding>,
}

/// Tests `small` against `large`, of which it must be a special case; that is the
/// caller's to know.
///
/// # Errors
/// [`MixedError::NotComparable`] unless both are fits by maximum likelihood (or by
/// restricted likelihood with the same fixed effects) of the same response and
/// `large` has more parameters.
pub fn likelihood_ratio(small: &MixedFit, large: &MixedFit) -> Result<LikelihoodRatio, MixedError> {
    let refuse = |reason: &'static str| Err(MixedError::NotComparable { reason });
    if small.method != large.method {
        return refuse("one is fitted by REML and the other by maximum likelihood");
    }
    let same_fixed = small.model.x == large.model.x;
    if small.method == MixedMethod::Reml && !same_fixed {
        return refuse(
            "their fixed effects differ, and restricted likelihoods then do not compare; fit both by maximum likelihood",
        );
    }
    let size = small
        .model
        .y
        .iter()
        .fold(0.0_f64, |size, y| size.max(y.abs()));
    let mut pairs = small.model.y.iter().zip(&large.model.y);
    if small.model.rows() != large.model.rows()
        || pairs.any(|(a, b)| (a - b).abs() > SAME_RESPONSE * size)
    {
        return refuse("their responses differ");
    }
    if large.parameters <= small.parameters {
        return refuse("the second has no more parameters than the first");
    }
    let df = large.parameters - small.parameters;
    let chi_square = (small.criterion - large.criterion).max(0.0);
    let p = chi_squared_upper(chi_square, df as f64);
    let findings = if small.theta.len() == large.theta.len() {
        Vec::new()
    } else {
        vec![MixedFinding::VarianceOnEdge]
    };
    Ok(LikelihoodRatio {
        chi_square,
        df,
        p,
        findings,
    })
}
