//! Rows and columns that a linear model hangs on.

use crate::coefficient::Coefficient;
use crate::model::linear_model::{LinearFit, coefficient, student_quantile};
use crate::model::model_frame::ModelFrame;
use nalgebra::DMatrix;
use serde::Serialize;

/// What a row does to a fit.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct RowInfluence {
    /// What was observed.
    pub observed: f64,
    /// What the model predicts.
    pub fitted: f64,
    /// Observed less fitted.
    pub residual: f64,
    /// Diagonal of the hat matrix: 1 where the row alone decides.
    pub leverage: f64,
    /// Residual over its standard error.
    pub standardised: f64,
    /// The same with the variance of the other rows: Student's t of the row.
    #[schema(value_type = Option<f64>)]
    pub studentised: f64,
    /// Cook's distance (Cook 1977, Technometrics 19, 15-18).
    #[schema(value_type = Option<f64>)]
    pub cook: f64,
    /// Change of the prediction in its standard errors when the row is left out.
    pub dffits: f64,
}

/// Influence of each row; `y` is the response.
pub fn influence(fit: &LinearFit, y: &[f64]) -> Vec<RowInfluence> {
    let (variance, df) = (fit.variance(), fit.residual_df as f64);
    let count = fit.columns.len() as f64;
    let rows = fit.residuals.iter().zip(&fit.leverages).zip(y);
    rows.map(|((residual, leverage), observed)| {
        let left = 1.0 - leverage;
        let standardised = residual / (variance * left).sqrt();
        let without = (variance * df - residual * residual / left) / (df - 1.0);
        let studentised = residual / (without * left).sqrt();
        RowInfluence {
            observed: *observed,
            fitted: observed - residual,
            residual: *residual,
            leverage: *leverage,
            standardised,
            studentised,
            cook: standardised * standardised * leverage / left / count,
            dffits: studentised * (leverage / left).sqrt(),
        }
    })
    .collect()
}

/// Variance inflation of a term.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
#[schema(as = InflationOutcome)]
pub struct Inflation {
    /// The term.
    pub term: String,
    /// Columns of it.
    pub df: usize,
    /// 1/(1 - R²) for one column, for several the generalised factor (Fox & Monette 1992,
    /// J. Am. Stat. Assoc. 87, 178-183).
    pub factor: f64,
}

/// Variance inflation; empty without intercept or with a single term.
pub fn inflation(frame: &ModelFrame, fit: &LinearFit) -> Vec<Inflation> {
    let places = |columns: &std::ops::Range<usize>| -> Vec<usize> {
        let estimated = fit.columns.iter().enumerate();
        let own = estimated.filter(|(_, column)| columns.contains(column));
        own.map(|(place, _)| place).collect()
    };
    let terms: Vec<(String, Vec<usize>)> = frame
        .terms
        .iter()
        .map(|term| (term.name.clone(), places(&term.columns)))
        .filter(|(_, places)| !places.is_empty())
        .collect();
    if !fit.intercept || terms.len() < 2 {
        return Vec::new();
    }
    let all: Vec<usize> = terms
        .iter()
        .flat_map(|(_, places)| places.clone())
        .collect();
    let correlation = |chosen: &[usize]| {
        let covariance = &fit.unscaled_covariance;
        DMatrix::from_fn(chosen.len(), chosen.len(), |a, b| {
            let (a, b) = (chosen[a], chosen[b]);
            covariance[(a, b)] / (covariance[(a, a)] * covariance[(b, b)]).sqrt()
        })
    };
    let whole = correlation(&all).determinant();
    terms
        .into_iter()
        .map(|(term, own)| {
            let others: Vec<usize> = all.iter().copied().filter(|p| !own.contains(p)).collect();
            let parts = correlation(&own).determinant() * correlation(&others).determinant();
            Inflation {
                term,
                df: own.len(),
                factor: parts / whole,
            }
        })
        .collect()
}

/// Coefficients with standard errors that hold for unequal variances: HC3
/// (MacKinnon & White 1985, J. Econometrics 29, 305-325).
pub fn robust_coefficients(fit: &LinearFit, x: &DMatrix<f64>) -> Vec<Coefficient> {
    let covariance = robust_covariance(fit, x);
    let df = fit.residual_df as f64;
    let quantile = student_quantile(0.5 + 0.5 * fit.confidence, df);
    let pairs = fit.coefficients.iter().enumerate();
    pairs
        .map(|(place, own)| {
            let se = covariance[(place, place)].sqrt();
            coefficient(&own.name, own.estimate, se, df, quantile)
        })
        .collect()
}

/// Rows of the HC3 covariance of the estimates; `x` is the model matrix.
pub fn robust_covariance_rows(fit: &LinearFit, x: &DMatrix<f64>) -> Vec<Vec<f64>> {
    let matrix = robust_covariance(fit, x);
    let rows = matrix.row_iter();
    rows.map(|row| row.iter().copied().collect()).collect()
}

fn robust_covariance(fit: &LinearFit, x: &DMatrix<f64>) -> DMatrix<f64> {
    let count = fit.columns.len();
    let mut middle = DMatrix::zeros(count, count);
    for (row, (residual, leverage)) in fit.residuals.iter().zip(&fit.leverages).enumerate() {
        let weight = (residual / (1.0 - leverage)).powi(2);
        for a in 0..count {
            let value = weight * x[(row, fit.columns[a])];
            for b in 0..=a {
                middle[(a, b)] += value * x[(row, fit.columns[b])];
            }
        }
    }
    middle.fill_upper_triangle_with_lower_triangle();
    &fit.unscaled_covariance * middle * &fit.unscaled_covariance
}
