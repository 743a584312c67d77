//! `windfall compare --measured … --predicted …`: predicted against measured.

use crate::compare::group_outcome::statistics_error;
use crate::goodness_index::{CHI_SQUARED_CAVEAT, goodness_index};
use crate::regress::findings::finding;
use crate::rows::lines_text;
use serde::Serialize;
use windfall_files::error::Error;
use windfall_files::found::FindingOutcome;
use windfall_files::table::data::Data;
use windfall_statistics::numbers::Numbers;

/// What is asked.
#[derive(Clone, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
pub struct AgreementRequest {
    /// Column of measured values, to hold predictions against
    #[cfg_attr(feature = "clap", arg(long, required = false, value_name = "COLUMN", requires = "predicted", conflicts_with_all = ["value", "by"]))]
    pub measured: String,
    /// Column of predicted values
    #[cfg_attr(
        feature = "clap",
        arg(long, required = false, value_name = "COLUMN", requires = "measured")
    )]
    pub predicted: String,
    /// Parameters that were fitted to these values
    #[cfg_attr(
        feature = "clap",
        arg(long, default_value_t = 0, value_name = "N", requires = "measured")
    )]
    pub parameters: usize,
}

/// Distances between predicted and measured values.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct AgreementOutcome {
    /// Column of measured values.
    pub measured: String,
    /// Column of predicted values.
    pub predicted: String,
    /// Rows with both.
    pub n: usize,
    /// Parameters that were fitted.
    pub parameters: usize,
    /// Mean of predicted less measured.
    pub bias: f64,
    /// Root mean square of the differences.
    pub rmse: f64,
    /// Mean of |difference|.
    pub mae: f64,
    /// Mean of |difference| over |measured|; a fraction.
    pub mape: Option<f64>,
    /// 1 - Σ(O - P)²/Σ(O - Ō)².
    pub r2: Option<f64>,
    /// Squared correlation.
    pub correlation_squared: Option<f64>,
    /// Σ (O - P)²/P.
    pub chi_squared: Option<f64>,
    /// Σ (O - P)²/(N - p).
    pub reduced_chi_squared: Option<f64>,
    /// What has to be said beside the numbers.
    pub findings: Vec<FindingOutcome>,
}

/// Compares predictions of a table with its measured values.
///
/// # Errors
/// A column is missing or holds text, or no row has both values.
pub fn agreement(data: &Data, request: &AgreementRequest) -> Result<AgreementOutcome, Error> {
    let column = |name: &str| {
        let numbers = data.table.numbers(name);
        numbers
            .map(Numbers::values)
            .map_err(|error| data.told(error))
    };
    let (measured, predicted) = (column(&request.measured)?, column(&request.predicted)?);
    let whole = |row: &usize| !measured[*row].is_nan() && !predicted[*row].is_nan();
    let (kept, left_out): (Vec<usize>, Vec<usize>) = (0..measured.len()).partition(whole);
    let of = |values: &[f64]| -> Vec<f64> { kept.iter().map(|row| values[*row]).collect() };
    let found = goodness_index(&of(&measured), &of(&predicted), request.parameters)
        .map_err(statistics_error)?;
    let mut findings: Vec<FindingOutcome> = data.left_out_finding().into_iter().collect();
    if !left_out.is_empty() {
        let lines: Vec<usize> = left_out.iter().map(|row| data.line(*row)).collect();
        findings.push(finding(
            "missing",
            format!("a value is missing in {}, left out", lines_text(&lines)),
        ));
    }
    findings.push(finding("index", CHI_SQUARED_CAVEAT.to_owned()));
    if found.chi_squared.is_none() {
        findings.push(finding(
            "not-positive",
            "a prediction is zero or below: Σ(O-P)²/P has no meaning".to_owned(),
        ));
    }
    Ok(AgreementOutcome {
        measured: request.measured.clone(),
        predicted: request.predicted.clone(),
        n: found.n,
        parameters: request.parameters,
        bias: found.bias,
        rmse: found.root_mean_square,
        mae: found.mean_absolute,
        mape: found.mean_absolute_relative,
        r2: found.r_squared,
        correlation_squared: found.correlation_squared,
        chi_squared: found.chi_squared,
        reduced_chi_squared: found.reduced_chi_squared,
        findings,
    })
}
