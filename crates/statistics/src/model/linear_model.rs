//! Linear models: estimates with their errors, and how good they are.

use crate::error::Error;
use crate::model::anova::{AnovaRow, SumOfSquares};
use crate::model::model_frame::ModelFrame;
use crate::model::model_matrix::{BLOCK, ModelMatrix};
use crate::model::reduced::{Aliased, Reduced, Solved, reduce};
use nalgebra::DMatrix;
use rayon::prelude::*;
use serde::Serialize;
use windfall_distribution::tail::{f_upper, t_two_sided, t_upper_quantile};
use windfall_mixed::coefficient::{Coefficient, Estimated};
use windfall_mixed::weights::Weights;
use windfall_numerics::as_written::as_written;
use windfall_numerics::double_double::DoubleDouble;

/// A fitted linear model.
#[derive(Clone, Debug, PartialEq)]
pub struct LinearFit {
    /// Estimates, without the aliased columns.
    pub coefficients: Vec<Coefficient>,
    /// Columns that depend on those before them.
    pub aliased: Vec<Aliased>,
    /// Columns of the model matrix that were estimated.
    pub columns: Vec<usize>,
    /// (X'X)⁻¹ of these.
    pub unscaled_covariance: DMatrix<f64>,
    /// Inverse of the triangle of these.
    pub inverse_triangle: DMatrix<f64>,
    /// Rows.
    pub rows: usize,
    /// Whether the model has an intercept.
    pub intercept: bool,
    /// What blocks of runs take up, which is no part of the model.
    pub blocks: SumOfSquares,
    /// Sum of squares of the residuals.
    pub residual_ss: f64,
    /// Degrees of freedom of the residuals.
    pub residual_df: usize,
    /// Sum of squares of the response: about its mean if there is an intercept.
    pub total_ss: f64,
    /// Level of the intervals.
    pub confidence: f64,
    /// A bound from below of the condition of the columns at length one.
    pub condition: f64,
    /// What the rows weigh.
    pub weights: Weights,
    /// Observed less fitted.
    pub residuals: Vec<f64>,
    /// Leverages: diagonal of the hat matrix.
    pub leverages: Vec<f64>,
}

/// Fits a linear model by least squares.
///
/// * `x`: model matrix with columns of `frame`; `y`: response
/// * `wanted`: columns that are in the model
/// * `confidence`: level of intervals, 0.95 say
///
/// # Errors
/// [`Error::TooFewRows`]; [`Error::Constant`] for a response of one value.
pub fn fit_linear(
    frame: &ModelFrame,
    x: &DMatrix<f64>,
    y: &[f64],
    wanted: &[usize],
    confidence: f64,
) -> Result<LinearFit, Error> {
    let reduced = reduce(x, y);
    fit_reduced(frame, x, y, &reduced, wanted, confidence)
}

/// As [`fit_linear`], with rows that are reduced already.
pub fn fit_reduced<'a>(
    frame: &ModelFrame,
    x: impl Into<ModelMatrix<'a>>,
    y: &[f64],
    reduced: &Reduced,
    wanted: &[usize],
    confidence: f64,
) -> Result<LinearFit, Error> {
    let rows = (x.into(), y, &Weights::default());
    fit_weighted(frame, rows, reduced, wanted, confidence)
}

/// As [`fit_reduced`], with rows that weigh differently.
///
/// * `reduced`: of the weighted rows
pub fn fit_weighted(
    frame: &ModelFrame,
    (x, y, weights): (ModelMatrix, &[f64], &Weights),
    reduced: &Reduced,
    wanted: &[usize],
    confidence: f64,
) -> Result<LinearFit, Error> {
    let solved = reduced.solve(wanted);
    let (rows, count) = (x.rows(), solved.columns.len());
    if rows < wanted.len() {
        return Err(Error::TooFewRows {
            rows,
            terms: wanted.len(),
        });
    }
    let intercept = frame.intercept && wanted.contains(&0);
    let total_ss = total(reduced, intercept);
    if total_ss == 0.0 {
        return Err(Error::Constant {
            name: "the response".to_owned(),
        });
    }
    let residual_df = rows - count;
    // Exact fits leave the rounding of the data.
    let residual_ss = solved.residual.value().max(0.0);
    let (residuals, leverages) = residuals_and_leverages(&x, y, weights, &solved)?;
    let unscaled = &solved.inverse * solved.inverse.transpose();
    let variance = residual_ss / residual_df as f64;
    let df = residual_df as f64;
    let quantile = student_quantile(0.5 + 0.5 * confidence, df);
    let coefficients = solved
        .columns
        .iter()
        .zip(&solved.estimates)
        .enumerate()
        .map(|(place, (column, estimate))| {
            let row = solved.inverse.row(place);
            let se = (variance * row.dot(&row)).sqrt();
            coefficient(&frame.names[*column], estimate.value(), se, df, quantile)
        })
        .collect();
    Ok(LinearFit {
        coefficients,
        aliased: solved.aliased,
        columns: solved.columns,
        unscaled_covariance: unscaled,
        inverse_triangle: solved.inverse,
        rows,
        intercept,
        blocks: SumOfSquares { ss: 0.0, df: 0.0 },
        residual_ss,
        residual_df,
        total_ss,
        confidence,
        condition: solved.condition,
        weights: weights.clone(),
        residuals,
        leverages,
    })
}

/// A coefficient with its test and interval.
pub(crate) fn coefficient(
    name: &str,
    estimate: f64,
    se: f64,
    df: f64,
    quantile: f64,
) -> Coefficient {
    let t = estimate / se;
    Coefficient {
        name: name.to_owned(),
        estimate,
        se,
        t,
        p: t_two_sided(t, df),
        low: estimate - quantile * se,
        high: estimate + quantile * se,
        df,
    }
}

/// Sum of squares of the response, about its mean with an intercept.
fn total(reduced: &Reduced, intercept: bool) -> f64 {
    // The first column is the intercept: what it takes up is the mean.
    let columns = reduced.response.iter().skip(usize::from(intercept));
    let sum: DoubleDouble = columns.map(|v| *v * *v).sum();
    (sum + reduced.rest).value()
}

fn residuals_and_leverages(
    x: &ModelMatrix,
    y: &[f64],
    weights: &Weights,
    solved: &Solved,
) -> Result<(Vec<f64>, Vec<f64>), Error> {
    let precise = y.len() * solved.columns.len() <= 1_000_000;
    let mut residuals = y.to_vec();
    let mut leverages = vec![0.0; y.len()];
    let parts = residuals.par_chunks_mut(BLOCK);
    let parts = parts.zip(leverages.par_chunks_mut(BLOCK)).enumerate();
    parts.try_for_each(|(place, (residuals, leverages))| {
        let start = place * BLOCK;
        let x = x.block(start..start + residuals.len())?;
        take_off(&x, solved, precise, residuals);
        add_leverages(&x, solved, leverages);
        for (place, own) in leverages.iter_mut().enumerate() {
            *own = (*own * weights.weight(start + place)).min(1.0);
        }
        Ok::<(), Error>(())
    })?;
    Ok((residuals, leverages))
}

/// Takes what a model predicts off the response.
fn take_off(x: &DMatrix<f64>, solved: &Solved, precise: bool, left: &mut [f64]) {
    let pairs = solved.columns.iter().zip(&solved.estimates);
    if precise {
        let mut exact: Vec<DoubleDouble> = left.iter().map(|y| as_written(*y)).collect();
        for (column, estimate) in pairs {
            for (left, x) in exact.iter_mut().zip(&x.column(*column)) {
                *left -= *estimate * DoubleDouble::from(*x);
            }
        }
        for (left, exact) in left.iter_mut().zip(exact) {
            *left = exact.value();
        }
        return;
    }
    for (column, estimate) in pairs {
        let estimate = estimate.value();
        let own = x.column(*column).data.into_slice();
        for (left, x) in left.iter_mut().zip(own) {
            *left -= estimate * x;
        }
    }
}

/// Squared lengths of the rows of X R⁻¹.
fn add_leverages(x: &DMatrix<f64>, solved: &Solved, found: &mut [f64]) {
    let mut row_of_q = vec![0.0; found.len()];
    for step in 0..solved.columns.len() {
        row_of_q.fill(0.0);
        for (inner, column) in solved.columns[..=step].iter().enumerate() {
            let factor = solved.inverse[(inner, step)];
            let own = x.column(*column).data.into_slice();
            for (sum, x) in row_of_q.iter_mut().zip(own) {
                *sum += factor * x;
            }
        }
        for (sum, q) in found.iter_mut().zip(&row_of_q) {
            *sum += q * q;
        }
    }
}

/// Quantile of Student's t; NaN without degrees of freedom.
pub fn student_quantile(probability: f64, df: f64) -> f64 {
    -t_upper_quantile(probability, df)
}

/// The whole model against none.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct WholeModel {
    /// Sum of squares.
    #[schema(value_type = Option<f64>)]
    pub ss: f64,
    /// Degrees of freedom, without the intercept.
    pub df: f64,
    /// Mean square over that of the residuals.
    #[schema(value_type = Option<f64>)]
    pub f: f64,
    /// Probability of F or more without the model.
    #[schema(value_type = Option<f64>)]
    pub p: f64,
}

impl WholeModel {
    /// As a row of an analysis of variance.
    pub fn row(&self) -> AnovaRow {
        AnovaRow {
            term: "model".to_owned(),
            ss: self.ss,
            df: self.df,
            f: self.f,
            p: self.p,
        }
    }
}

/// How well a model describes what it was fitted to, and what it was not.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, utoipa::ToSchema)]
#[schema(as = QualityOutcome)]
pub struct Quality {
    /// Part of the total sum of squares that is described.
    #[schema(value_type = Option<f64>)]
    pub r2: f64,
    /// The same per degree of freedom.
    #[schema(value_type = Option<f64>)]
    pub r2_adjusted: f64,
    /// Part of the total that predictions of each row by a fit without it describe.
    #[schema(value_type = Option<f64>)]
    pub r2_predicted: f64,
    /// Sum of squares of these errors; infinite where a row decides a coefficient alone.
    #[schema(value_type = Option<f64>)]
    pub press: f64,
    /// Range of predictions over their mean standard error; more than 4 is wanted.
    #[schema(value_type = Option<f64>)]
    pub adequate_precision: f64,
    /// Residual standard deviation: with weights that of a row of weight 1, with variances by
    /// level the root of their mean over the rows.
    #[schema(value_type = Option<f64>)]
    pub sigma: f64,
    /// Log-likelihood of normal residuals.
    #[schema(value_type = Option<f64>)]
    pub log_likelihood: f64,
    /// Akaike's criterion, counting the variance as a parameter.
    #[schema(value_type = Option<f64>)]
    pub aic: f64,
    /// The same for small samples (Hurvich & Tsai 1989, Biometrika 76, 297-307).
    #[schema(value_type = Option<f64>)]
    pub aicc: f64,
    /// Schwarz' criterion.
    #[schema(value_type = Option<f64>)]
    pub bic: f64,
}

impl LinearFit {
    /// Covariance of the estimates, for residuals of one variance; rows.
    pub fn covariance_rows(&self) -> Vec<Vec<f64>> {
        let variance = self.residual_ss / self.residual_df as f64;
        let rows = self.unscaled_covariance.row_iter();
        rows.map(|row| row.iter().map(|own| variance * own).collect())
            .collect()
    }

    /// The same fit with some of its columns as blocks of runs: what they take up before the
    /// other columns is part of neither the model nor the variation that it describes.
    pub fn in_blocks(mut self, reduced: &Reduced, columns: &[usize]) -> Self {
        let base: Vec<usize> = self.intercept.then_some(0).into_iter().collect();
        let solved = reduced.solve(&[&base[..], columns].concat());
        self.blocks = SumOfSquares {
            ss: (self.total_ss - solved.residual.value()).max(0.0),
            df: (solved.columns.len() - base.len()) as f64,
        };
        self
    }

    /// Model sum of squares.
    pub fn model_ss(&self) -> f64 {
        self.described() - self.residual_ss
    }

    /// Sum of squares of the response within blocks.
    fn described(&self) -> f64 {
        self.total_ss - self.blocks.ss
    }

    /// Degrees of freedom of the model, without the intercept and blocks.
    pub fn model_df(&self) -> usize {
        self.columns.len() - usize::from(self.intercept) - self.blocks.df as usize
    }

    /// Residual variance; NaN without degrees of freedom.
    pub fn variance(&self) -> f64 {
        match self.residual_df {
            0 => f64::NAN,
            df => self.residual_ss / df as f64,
        }
    }

    /// The model against none.
    pub fn whole(&self) -> WholeModel {
        let (ss, df) = (self.model_ss(), self.model_df() as f64);
        let f = ss / df / self.variance();
        WholeModel {
            ss,
            df,
            f,
            p: f_upper(f, df, self.residual_df as f64),
        }
    }

    /// A sum of coefficients: `weights` of all columns of the model, also of those without an
    /// estimate, which do not count.
    ///
    /// * `covariance`: of the estimates, in their order; rows
    pub fn estimate(&self, weights: &[f64], covariance: &[Vec<f64>]) -> Estimated {
        let own: Vec<f64> = self.columns.iter().map(|column| weights[*column]).collect();
        let pairs = own.iter().zip(&self.coefficients);
        let quadratic: f64 = own
            .iter()
            .zip(covariance)
            .map(|(a, row)| a * row.iter().zip(&own).map(|(v, b)| v * b).sum::<f64>())
            .sum();
        Estimated {
            value: pairs.map(|(weight, own)| weight * own.estimate).sum(),
            se: quadratic.sqrt(),
            df: self.residual_df as f64,
        }
    }

    /// The residuals.
    pub fn residual(&self) -> SumOfSquares {
        SumOfSquares {
            ss: self.residual_ss,
            df: self.residual_df as f64,
        }
    }

    /// The response.
    pub fn total(&self) -> SumOfSquares {
        SumOfSquares {
            ss: self.total_ss,
            df: (self.residual_df + self.model_df()) as f64 + self.blocks.df,
        }
    }

    /// Predictions of the rows it was fitted to.
    pub fn fitted(&self, y: &[f64]) -> Vec<f64> {
        y.iter().zip(&self.residuals).map(|(y, e)| y - e).collect()
    }

    /// Sum over the rows of the variance of their prediction over σ².
    fn squared_reach(&self) -> f64 {
        match self.weights.is_empty() {
            true => self.columns.len() as f64,
            false => {
                let rows = self.leverages.iter().enumerate();
                rows.map(|(row, own)| own / self.weights.weight(row)).sum()
            }
        }
    }

    /// How good it is.
    pub fn quality(&self, y: &[f64]) -> Quality {
        let (rows, count) = (self.rows as f64, self.columns.len() as f64);
        let total_df = rows - f64::from(u8::from(self.intercept)) - self.blocks.df;
        let total_ss = self.described();
        let press = press(&self.weights.weigh(&self.residuals), &self.leverages);
        let fitted = y.iter().zip(&self.residuals).map(|(y, e)| y - e);
        let (low, high) = fitted.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| {
            (l.min(v), h.max(v))
        });
        let variance = self.variance();
        let log_likelihood = log_likelihood(self.residual_ss, rows) + 0.5 * self.weights.log_sum();
        let parameters = count + 1.0;
        let aic = 2.0 * parameters - 2.0 * log_likelihood;
        Quality {
            r2: 1.0 - self.residual_ss / total_ss,
            r2_adjusted: 1.0 - variance / (total_ss / total_df),
            press,
            r2_predicted: 1.0 - press / total_ss,
            adequate_precision: (high - low) / (self.squared_reach() * variance / rows).sqrt(),
            sigma: variance.sqrt(),
            log_likelihood,
            aic,
            aicc: small_sample(aic, parameters, rows),
            bic: parameters * rows.ln() - 2.0 * log_likelihood,
        }
    }
}

/// Log-likelihood of normal residuals with their most likely variance.
pub(crate) fn log_likelihood(residual_ss: f64, rows: f64) -> f64 {
    -0.5 * rows * ((2.0 * std::f64::consts::PI * residual_ss / rows).ln() + 1.0)
}

/// Akaike's criterion for small samples; infinite where it is not defined.
pub fn small_sample(aic: f64, parameters: f64, rows: f64) -> f64 {
    match rows - parameters - 1.0 {
        left if left > 0.0 => aic + 2.0 * parameters * (parameters + 1.0) / left,
        _ => f64::INFINITY,
    }
}

fn press(residuals: &[f64], leverages: &[f64]) -> f64 {
    let terms = residuals.iter().zip(leverages).map(|(e, h)| {
        let left = 1.0 - h;
        // A leverage of one: no other row tells of this one.
        match left <= 1e-12 {
            true => f64::INFINITY,
            false => DoubleDouble::from((e / left).powi(2)).value(),
        }
    });
    terms.map(DoubleDouble::from).sum::<DoubleDouble>().value()
}
