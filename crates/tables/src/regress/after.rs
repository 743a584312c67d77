//! Questions after a linear model: marginal means and predictions.

use crate::regress::means::outcome::MeansOutcome;
use crate::regress::means::run::{Model, means_of};
use crate::regress::outcome::{PredictionOutcome, original_prediction};
use crate::regress::request::RegressRequest;
use nalgebra::DMatrix;
use windfall_files::error::Error;
use windfall_files::found::FindingOutcome;
use windfall_files::option_value::unusable;
use windfall_files::table::data::Data;
use windfall_mixed::coefficient::Estimated;
use windfall_statistics::model::formula::Formula;
use windfall_statistics::model::linear_model::LinearFit;
use windfall_statistics::model::mean_contrasts::{JointTest, joint_test};
use windfall_statistics::model::model_frame::prediction_rows;
use windfall_statistics::model::model_rows::FormulaRows;
use windfall_statistics::model::original_scale::OriginalScale;
use windfall_statistics::model::prediction::predict;
use windfall_statistics::model::variance_groups::LevelInference;

/// A sum of coefficients, with weights of all columns of the model.
///
/// * `covariance`: of the estimates; `inference`: where variances differ by level
pub(crate) fn estimated(
    weights: &[f64],
    (fit, covariance): (&LinearFit, &[Vec<f64>]),
    inference: Option<&LevelInference>,
) -> Estimated {
    match inference {
        Some(own) => own.estimate(weights),
        None => fit.estimate(weights, covariance),
    }
}

/// Marginal means, slopes and their comparisons.
///
/// * `inference`: where variances differ by level
///
/// # Errors
/// As [`means_of`]; terms that were selected.
pub(crate) fn means(
    request: &RegressRequest,
    data: &Data,
    formula: &Formula,
    rows: &FormulaRows,
    (fit, covariance): (&LinearFit, &[Vec<f64>]),
    inference: Option<&LevelInference>,
) -> Result<(Vec<MeansOutcome>, Vec<FindingOutcome>), Error> {
    if request.after.is_empty() {
        return Ok((Vec::new(), Vec::new()));
    }
    if request.select.is_some() {
        let problem = "means of a model whose terms were selected leave out what the selection \
                       costs: fit the chosen terms without --select";
        return Err(unusable("--means", problem));
    }
    let estimate = |weights: &[f64]| estimated(weights, (fit, covariance), inference);
    let of_sums = |sums: &DMatrix<f64>| {
        let own = sums.select_columns(&fit.columns);
        let size = covariance.len();
        let inner = DMatrix::from_fn(size, size, |i, j| covariance[i][j]);
        &own * inner * own.transpose()
    };
    let model = Model {
        frame: &rows.frame,
        aliased: &fit.aliased,
        table: &data.table,
        kept: &rows.kept,
        response: formula.response.as_ref(),
        estimate: &estimate,
        covariance: &of_sums,
        test: &|sums| {
            if let Some(own) = inference {
                let test = own.test(sums)?;
                return Some(JointTest {
                    f: test.f,
                    df: test.numerator,
                    df_denominator: test.denominator,
                    p: test.p,
                });
            }
            let values = sums.row_iter().map(|row| {
                let row: Vec<f64> = row.iter().copied().collect();
                estimate(&row).value
            });
            let values: Vec<f64> = values.collect();
            joint_test(&values, of_sums(sums), fit.residual_df as f64)
        },
    };
    means_of(&model, &request.after, request.confidence)
}

/// Predictions of the rows of a table.
///
/// # Errors
/// The table lacks a column, or has levels that the model does not know.
pub(crate) fn predictions(
    asked: Option<&Data>,
    scale: Option<&OriginalScale>,
    rows: &FormulaRows,
    fit: &LinearFit,
) -> Result<Vec<PredictionOutcome>, Error> {
    let Some(asked) = asked else {
        return Ok(Vec::new());
    };
    let x = prediction_rows(&rows.frame, &asked.table).map_err(|error| asked.told(error))?;
    let found = predict(fit, &x).into_iter().zip(asked.lines.iter());
    Ok(found
        .map(|(prediction, line)| PredictionOutcome {
            line,
            original: original_prediction(
                scale,
                prediction.mean,
                (prediction.mean_low, prediction.mean_high),
                (prediction.low, prediction.high),
            ),
            prediction,
        })
        .collect())
}
