//! Whether the variance of residuals changes along the regressors.

use crate::compare::equal_variance::ChiSquaredTest;
use crate::orthonormal::{dot, orthonormal_basis, take_out};
use crate::sample::check_sample;
use crate::sample_error::SampleError;
use nalgebra::DMatrix;
use windfall_distribution::tail::chi_squared_upper;

/// Koenker's form n R² of the Breusch-Pagan test, which holds its level for residuals
/// that are not normal.
///
/// * `regressors`: n × p, along which the variance may change; an intercept is added
///
/// # Errors
/// Missing values, lengths that differ, too few residuals, no spread.
///
/// # Source
/// Koenker (1981), A note on studentizing a test for heteroscedasticity,
/// J. Econom. 17.
pub fn koenker(
    residuals: &[f64],
    regressors: &DMatrix<f64>,
) -> Result<ChiSquaredTest, SampleError> {
    let explained = explain_squares(residuals, regressors)?;
    let n = residuals.len() as f64;
    Ok(test_of(
        n * explained.squares / explained.total,
        explained.df,
    ))
}

struct Explained {
    /// Σ (fitted - mean)² of the squared residuals.
    squares: f64,
    /// Σ (e² - mean)².
    total: f64,
    df: f64,
}

/// Regression of the squared residuals on an intercept and the regressors.
fn explain_squares(residuals: &[f64], regressors: &DMatrix<f64>) -> Result<Explained, SampleError> {
    check_sample("the residuals", residuals, 3)?;
    if regressors.nrows() != residuals.len() {
        return Err(SampleError::lengths(
            "residuals and rows of the regressors",
            residuals.len(),
            regressors.nrows(),
        ));
    }
    let n = residuals.len() as f64;
    let squared: Vec<f64> = residuals.iter().map(|e| e * e).collect();
    let centre = squared.iter().sum::<f64>() / n;
    let mut rest: Vec<f64> = squared.iter().map(|value| value - centre).collect();
    let total = dot(&rest, &rest);
    let basis = orthonormal_basis(&regressors.clone().insert_column(0, 1.0));
    if basis.len() < 2 {
        return Err(SampleError::NoSpread("the regressors".to_owned()));
    }
    if basis.len() >= residuals.len() {
        return Err(SampleError::too_few(
            "the residuals, against that many regressors",
            residuals.len(),
            basis.len() + 1,
        ));
    }
    take_out(&basis, &mut rest);
    if total <= 0.0 {
        return Err(SampleError::NoSpread("the squared residuals".to_owned()));
    }
    Ok(Explained {
        squares: total - dot(&rest, &rest),
        total,
        df: (basis.len() - 1) as f64,
    })
}

fn test_of(statistic: f64, df: f64) -> ChiSquaredTest {
    ChiSquaredTest {
        statistic,
        df,
        p: chi_squared_upper(statistic, df),
    }
}
