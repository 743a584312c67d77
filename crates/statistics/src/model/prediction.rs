//! Predictions of linear models.

use crate::model::linear_model::{LinearFit, student_quantile};
use nalgebra::DMatrix;
use serde::Serialize;
use windfall_numerics::double_double::DoubleDouble;

/// A prediction with its intervals.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct Prediction {
    /// The mean at this place.
    #[serde(rename = "predicted")]
    pub mean: f64,
    /// Its standard error.
    #[schema(value_type = Option<f64>)]
    pub se: f64,
    /// Interval of the mean.
    #[schema(value_type = Option<f64>)]
    pub mean_low: f64,
    /// Its upper end.
    #[schema(value_type = Option<f64>)]
    pub mean_high: f64,
    /// Interval of one further observation.
    #[schema(value_type = Option<f64>)]
    pub low: f64,
    /// Its upper end.
    #[schema(value_type = Option<f64>)]
    pub high: f64,
}

/// Predictions at rows of a model matrix with the columns of the fitted one.
pub fn predict(fit: &LinearFit, x: &DMatrix<f64>) -> Vec<Prediction> {
    let variance = fit.variance();
    let quantile = student_quantile(0.5 + 0.5 * fit.confidence, fit.residual_df as f64);
    let count = fit.columns.len();
    let row = |row: usize| {
        let values: Vec<f64> = fit.columns.iter().map(|c| x[(row, *c)]).collect();
        let pairs = values.iter().zip(&fit.coefficients);
        let mean: DoubleDouble = pairs
            .map(|(x, c)| DoubleDouble::from(*x) * DoubleDouble::from(c.estimate))
            .sum();
        let leverage: f64 = (0..count)
            .map(|step| {
                let inner = (0..=step).map(|i| fit.inverse_triangle[(i, step)] * values[i]);
                inner.sum::<f64>().powi(2)
            })
            .sum();
        let (mean, se) = (mean.value(), (variance * leverage).sqrt());
        let (near, far) = (
            quantile * se,
            quantile * (variance * (1.0 + leverage)).sqrt(),
        );
        Prediction {
            mean,
            se,
            mean_low: mean - near,
            mean_high: mean + near,
            low: mean - far,
            high: mean + far,
        }
    };
    (0..x.nrows()).map(row).collect()
}
