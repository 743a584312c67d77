//! Figures of a linear model: residuals, influence, effects.

use crate::figures::diagnostics::{Arrangement, Diagnostics, diagnostics_painting};
use crate::figures::effects::{EffectModel, effects_painting};
use crate::regress::after::estimated;
use crate::regress::request::RegressRequest;
use windfall_draw::files::{FigureFolder, write_paintings};
use windfall_files::error::Error;
use windfall_files::table::data::Data;
use windfall_statistics::model::linear_model::LinearFit;
use windfall_statistics::model::model_frame::chosen_rows;
use windfall_statistics::model::model_rows::FormulaRows;
use windfall_statistics::model::variance_groups::LevelInference;
use windfall_statistics::residuals::diagnostics::{Influence, influence};
use windfall_statistics::runs::Runs;

/// Rows of a model with their influence, as panels show them.
pub(crate) fn diagnostics_of(
    response: &str,
    (rows, lines): (&Influence, &Runs),
    (df, parameters): (f64, usize),
    confidence: f64,
) -> Diagnostics {
    Diagnostics {
        response: response.to_owned(),
        lines: lines.iter().collect(),
        rows: rows.iter().collect(),
        df,
        parameters,
        confidence,
    }
}

/// Draws a linear model.
///
/// * `inference`: where variances differ by level
///
/// # Errors
/// A figure cannot be written.
pub(crate) fn draw_linear(
    folder: &FigureFolder,
    request: &RegressRequest,
    data: &Data,
    (rows, fit, inference): (&FormulaRows, &LinearFit, Option<&LevelInference>),
    (response, lines, covariance): (&str, &Runs, &[Vec<f64>]),
) -> Result<(), Error> {
    let size = (fit.residual_df as f64, fit.columns.len());
    let influence = influence(fit, &rows.y);
    let own = diagnostics_of(response, (&influence, lines), size, request.confidence);
    let mut paintings = vec![diagnostics_painting(
        "diagnostics",
        &own,
        Arrangement::Regression,
        Vec::new(),
    )?];
    let kept: Vec<usize> = rows.kept.iter().collect();
    let table = chosen_rows(&data.table, &kept);
    paintings.extend(effects_painting(&EffectModel {
        response,
        frame: &rows.frame,
        estimated: &fit.columns,
        aliased: &fit.aliased,
        table: &table,
        lines: &own.lines,
        residuals: &fit.residuals,
        estimate: &|weights| estimated(weights, (fit, covariance), inference),
        confidence: request.confidence,
    })?);
    write_paintings(folder, &paintings).map(|_| ())
}
