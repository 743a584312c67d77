//! The straight line through points, with its band.

use crate::error::Error;
use crate::model::linear_model::{LinearFit, fit_linear};
use crate::model::model_frame::ModelFrame;
use crate::model::prediction::{Prediction, predict};
use nalgebra::DMatrix;

/// Fits y = a + b x by least squares: the linear model with one term.
///
/// * `confidence`: level of the intervals, 0.95 say
///
/// # Errors
/// [`Error::TooFewRows`] for fewer than three points; [`Error::Constant`] where all
/// x, or all y, are the same.
pub fn fit_straight_line(x: &[f64], y: &[f64], confidence: f64) -> Result<LinearFit, Error> {
    if x.len() < 3 {
        return Err(Error::TooFewRows {
            rows: x.len(),
            terms: 2,
        });
    }
    if x.iter().all(|value| *value == x[0]) {
        return Err(Error::Constant {
            name: "x".to_owned(),
        });
    }
    let frame = ModelFrame {
        atoms: Vec::new(),
        terms: Vec::new(),
        intercept: true,
        names: vec!["intercept".to_owned(), "slope".to_owned()],
    };
    fit_linear(&frame, &rows(x), y, &[0, 1], confidence)
}

/// The line with its intervals at each of some x.
pub fn line_at(line: &LinearFit, x: &[f64]) -> Vec<Prediction> {
    predict(line, &rows(x))
}

fn rows(x: &[f64]) -> DMatrix<f64> {
    DMatrix::from_fn(x.len(), 2, |row, column| match column {
        0 => 1.0,
        _ => x[row],
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// By hand: Sxx = 10, Sxy = 19.9, residual sum of squares 0.107 on 3 degrees of
    /// freedom, t 3.182446 (table): half width of the band of the mean at x = 3 is
    /// t √(s²/5), at x = 5 t √(s² (1/5 + 4/10)).
    #[test]
    fn closed_form_band() {
        let (x, y) = ([1.0, 2.0, 3.0, 4.0, 5.0], [2.1, 3.9, 6.2, 7.8, 10.1]);
        let line = fit_straight_line(&x, &y, 0.95).unwrap();
        assert!((line.coefficients[0].estimate - 0.05).abs() < 1e-12);
        assert!((line.coefficients[1].estimate - 1.99).abs() < 1e-12);
        let variance: f64 = 0.107 / 3.0;
        let found = line_at(&line, &[3.0, 5.0]);
        for (found, leverage) in found.iter().zip([0.2, 0.6]) {
            let half = 3.182_446_305_284 * (variance * leverage).sqrt();
            let (low, high) = (found.mean_low, found.mean_high);
            assert!((0.5 * (high - low) - half).abs() < 1e-9, "{low} {high}");
        }
    }

    #[test]
    fn refuses_what_has_no_slope() {
        assert!(fit_straight_line(&[1.0, 2.0], &[1.0, 2.0], 0.95).is_err());
        assert!(fit_straight_line(&[1.0; 3], &[1.0, 2.0, 3.0], 0.95).is_err());
    }
}
