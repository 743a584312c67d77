//! Figures of a linear model: residuals, influence, effects.

use crate::figures::diagnostics::{Arrangement, Diagnostics, diagnostics_painting};
use crate::figures::effects::{EffectModel, effects_painting};
use crate::regress::outcome::RowOutcome;
use crate::regress::request::RegressRequest;
use windfall_draw::files::{FigureFolder, write_paintings};
use windfall_files::error::Error;
use windfall_files::table::data::Data;
use windfall_statistics::model::linear_model::LinearFit;
use windfall_statistics::model::model_frame::{ModelRows, chosen_rows};
use windfall_statistics::residuals::diagnostics::robust_covariance_rows;

/// Rows of a model with their influence, as panels show them.
pub(crate) fn diagnostics_of(
    response: &str,
    rows: &[RowOutcome],
    (df, parameters): (f64, usize),
    confidence: f64,
) -> Diagnostics {
    Diagnostics {
        response: response.to_owned(),
        lines: rows.iter().map(|row| row.line).collect(),
        rows: rows.iter().map(|row| row.influence).collect(),
        df,
        parameters,
        confidence,
    }
}

/// Draws a linear model.
///
/// # Errors
/// A figure cannot be written.
pub(crate) fn draw_linear(
    folder: &FigureFolder,
    request: &RegressRequest,
    data: &Data,
    (rows, fit): (&ModelRows, &LinearFit),
    (response, influence): (&str, &[RowOutcome]),
) -> Result<(), Error> {
    let size = (fit.residual_df as f64, fit.columns.len());
    let own = diagnostics_of(response, influence, size, request.confidence);
    let mut paintings = vec![diagnostics_painting(
        "diagnostics",
        &own,
        Arrangement::Regression,
        Vec::new(),
    )?];
    let covariance = match request.robust {
        true => robust_covariance_rows(fit, &rows.x),
        false => fit.covariance_rows(),
    };
    let table = chosen_rows(&data.table, &rows.kept);
    paintings.extend(effects_painting(&EffectModel {
        response,
        frame: &rows.frame,
        estimated: &fit.columns,
        aliased: &fit.aliased,
        table: &table,
        lines: &own.lines,
        residuals: &fit.residuals,
        estimate: &|weights| fit.estimate(weights, &covariance),
        confidence: request.confidence,
    })?);
    write_paintings(folder, &paintings).map(|_| ())
}
