//! Rows and columns that a linear model hangs on.

use crate::error::Error;
use crate::model::linear_model::{LinearFit, coefficient, student_quantile};
use crate::model::model_frame::ModelFrame;
use crate::model::model_matrix::{BLOCK, ModelMatrix};
use nalgebra::DMatrix;
use serde::Serialize;
use std::borrow::Cow;
use windfall_mixed::coefficient::Coefficient;
use windfall_mixed::weights::Weights;

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
    #[schema(value_type = Option<f64>)]
    pub standardised: f64,
    /// The same with the variance of the other rows: Student's t of the row.
    #[schema(value_type = Option<f64>)]
    pub studentised: f64,
    /// Cook's distance (Cook 1977, Technometrics 19, 15-18).
    #[schema(value_type = Option<f64>)]
    pub cook: f64,
    /// Change of the prediction in its standard errors when the row is left out.
    #[schema(value_type = Option<f64>)]
    pub dffits: f64,
}

/// Influence of the rows of a fit, calculated where it is asked for.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Influence<'a> {
    observed: Cow<'a, [f64]>,
    residuals: Cow<'a, [f64]>,
    leverages: Cow<'a, [f64]>,
    weights: Cow<'a, Weights>,
    variance: f64,
    df: f64,
    count: f64,
}

/// Influence of each row; `y` is the response.
pub fn influence<'a>(fit: &'a LinearFit, y: &'a [f64]) -> Influence<'a> {
    Influence {
        observed: Cow::Borrowed(y),
        residuals: Cow::Borrowed(&fit.residuals),
        leverages: Cow::Borrowed(&fit.leverages),
        weights: Cow::Borrowed(&fit.weights),
        variance: fit.variance(),
        df: fit.residual_df as f64,
        count: fit.columns.len() as f64,
    }
}

impl Influence<'_> {
    /// The same of a fit and a response that are needed no longer.
    pub fn of(fit: LinearFit, y: Vec<f64>) -> Influence<'static> {
        let (variance, df) = (fit.variance(), fit.residual_df as f64);
        Influence {
            observed: Cow::Owned(y),
            count: fit.columns.len() as f64,
            residuals: Cow::Owned(fit.residuals),
            leverages: Cow::Owned(fit.leverages),
            weights: Cow::Owned(fit.weights),
            variance,
            df,
        }
    }

    /// Number of rows.
    pub fn len(&self) -> usize {
        self.observed.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.observed.is_empty()
    }

    /// The rows in their order.
    pub fn iter(&self) -> impl Iterator<Item = RowInfluence> {
        (0..self.len()).map(|row| self.row(row))
    }

    /// Rows, from 0, of which something holds.
    pub fn places(&self, chosen: fn(&RowInfluence) -> bool) -> Vec<usize> {
        (0..self.len())
            .filter(|row| chosen(&self.row(*row)))
            .collect()
    }

    #[inline]
    fn row(&self, row: usize) -> RowInfluence {
        let (residual, leverage) = (self.residuals[row], self.leverages[row]);
        let (observed, left) = (self.observed[row], 1.0 - leverage);
        // Of one variance in all rows.
        let weighted = residual * self.weights.root(row);
        let standardised = weighted / (self.variance * left).sqrt();
        let without = (self.variance * self.df - weighted * weighted / left) / (self.df - 1.0);
        let studentised = weighted / (without * left).sqrt();
        RowInfluence {
            observed,
            fitted: observed - residual,
            residual,
            leverage,
            standardised,
            studentised,
            cook: standardised * standardised * leverage / left / self.count,
            dffits: studentised * (leverage / left).sqrt(),
        }
    }
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
///
/// * `covariance`: [`robust_covariance`]
pub fn robust_coefficients(fit: &LinearFit, covariance: &[Vec<f64>]) -> Vec<Coefficient> {
    let df = fit.residual_df as f64;
    let quantile = student_quantile(0.5 + 0.5 * fit.confidence, df);
    let pairs = fit.coefficients.iter().enumerate();
    pairs
        .map(|(place, own)| {
            let se = covariance[place][place].sqrt();
            coefficient(&own.name, own.estimate, se, df, quantile)
        })
        .collect()
}

/// Rows of the HC3 covariance of the estimates; `x` is the model matrix.
///
/// # Errors
/// A value of the model matrix is undefined.
pub fn robust_covariance(fit: &LinearFit, x: &ModelMatrix) -> Result<Vec<Vec<f64>>, Error> {
    let count = fit.columns.len();
    let mut middle = DMatrix::zeros(count, count);
    for start in (0..x.rows()).step_by(BLOCK) {
        let x = x.block(start..(start + BLOCK).min(x.rows()))?;
        let rows = fit.residuals.iter().zip(&fit.leverages).skip(start);
        for (row, (residual, leverage)) in rows.take(x.nrows()).enumerate() {
            let own = fit.weights.weight(start + row);
            let weight = (own * residual / (1.0 - leverage)).powi(2);
            for a in 0..count {
                let value = weight * x[(row, fit.columns[a])];
                for b in 0..=a {
                    middle[(a, b)] += value * x[(row, fit.columns[b])];
                }
            }
        }
    }
    middle.fill_upper_triangle_with_lower_triangle();
    let matrix = &fit.unscaled_covariance * middle * &fit.unscaled_covariance;
    let rows = matrix.row_iter();
    Ok(rows.map(|row| row.iter().copied().collect()).collect())
}
