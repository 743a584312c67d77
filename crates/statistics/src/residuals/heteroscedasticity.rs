//! Whether the variance of residuals changes along the regressors.

use crate::compare::equal_variance::ChiSquaredTest;
use crate::distribution::tail::chi_squared_upper;
use crate::orthonormal::{dot, orthonormal_basis, take_out};
use crate::sample::check_sample;
use crate::sample_error::SampleError;
use nalgebra::DMatrix;

/// The Breusch-Pagan test, for normal residuals.
///
/// * `residuals`: of the model
/// * `regressors`: n × p, the columns along which the variance may change,
///   usually the design matrix; an intercept is added, sums of others left out
///
/// # Errors
/// Missing values, lengths that differ, too few residuals, no spread.
///
/// # Source
/// Breusch and Pagan (1979), A simple test for heteroscedasticity and random
/// coefficient variation, Econometrica 47.
pub fn breusch_pagan(
    residuals: &[f64],
    regressors: &DMatrix<f64>,
) -> Result<ChiSquaredTest, SampleError> {
    let explained = explain_squares(residuals, regressors)?;
    let n = residuals.len() as f64;
    let variance = dot(residuals, residuals) / n;
    Ok(test_of(
        0.5 * explained.squares / (variance * variance),
        explained.df,
    ))
}

/// Koenker's form of the Breusch-Pagan test, n R², which holds its level for
/// residuals that are not normal: the one to use.
///
/// # Errors
/// As [`breusch_pagan`].
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

/// White's test: Koenker's along the regressors, their squares and products.
///
/// # Errors
/// As [`breusch_pagan`]; with many regressors the products soon outnumber the
/// residuals.
///
/// # Source
/// White (1980), A heteroskedasticity-consistent covariance matrix estimator and
/// a direct test for heteroskedasticity, Econometrica 48.
pub fn white(residuals: &[f64], regressors: &DMatrix<f64>) -> Result<ChiSquaredTest, SampleError> {
    let p = regressors.ncols();
    let mut columns: Vec<_> = (0..p).map(|j| regressors.column(j).into_owned()).collect();
    for i in 0..p {
        for j in i..p {
            columns.push(regressors.column(i).component_mul(&regressors.column(j)));
        }
    }
    koenker(residuals, &DMatrix::from_columns(&columns))
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
        return Err(SampleError::LengthsDiffer {
            what: "residuals and rows of the regressors".to_owned(),
            first: residuals.len(),
            second: regressors.nrows(),
        });
    }
    let n = residuals.len() as f64;
    let squared: Vec<f64> = residuals.iter().map(|e| e * e).collect();
    let centre = squared.iter().sum::<f64>() / n;
    let mut rest: Vec<f64> = squared.iter().map(|value| value - centre).collect();
    let total = dot(&rest, &rest);
    let basis = orthonormal_basis(&regressors.clone().insert_column(0, 1.0));
    if basis.len() < 2 {
        return Err(SampleError::NoSpread {
            what: "the regressors".to_owned(),
        });
    }
    if basis.len() >= residuals.len() {
        return Err(SampleError::TooFewValues {
            what: "the residuals, against that many regressors".to_owned(),
            found: residuals.len(),
            needed: basis.len() + 1,
        });
    }
    take_out(&basis, &mut rest);
    if total <= 0.0 {
        return Err(SampleError::NoSpread {
            what: "the squared residuals".to_owned(),
        });
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
