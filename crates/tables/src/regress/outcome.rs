//! Fitted linear models as JSON shows them.

use serde::Serialize;
use windfall_statistics::model::expression::columns_of;
use windfall_statistics::model::formula::Formula;
use windfall_statistics::model::linear_model::Prediction;
use windfall_statistics::residuals::diagnostics::RowInfluence;
use windfall_statistics::table::Table;

/// A step of a selection.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct StepOutcome {
    /// The term.
    pub term: String,
    /// "removed" or "entered".
    pub action: &'static str,
    /// F of the term.
    pub f: f64,
    /// Its probability.
    pub p: f64,
    /// The criterion after the step, where one decides.
    pub criterion: Option<f64>,
    /// R² after the step.
    pub r2: f64,
}

/// Range of a column in the rows of a fit.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
#[schema(as = ModelRange)]
pub struct RangeOutcome {
    /// The column.
    pub column: String,
    /// Its smallest value.
    pub low: f64,
    /// Its largest.
    pub high: f64,
}

/// Ranges of the numeric columns on the right side of a formula, in the rows `kept`.
pub fn ranges_of(formula: &Formula, table: &Table, kept: &[usize]) -> Vec<RangeOutcome> {
    let atoms = formula.atoms.iter();
    let mut names: Vec<String> = atoms.flat_map(|atom| columns_of(&atom.node)).collect();
    names.sort();
    names.dedup();
    let range = |name: String| {
        let values = table.numbers(&name).ok()?;
        let own = kept.iter().map(|row| values[*row]);
        let (low, high) = own.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
            (low.min(value), high.max(value))
        });
        Some(RangeOutcome {
            column: name,
            low,
            high,
        })
    };
    names.into_iter().filter_map(range).collect()
}

/// Influence of a row on the fit.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct RowOutcome {
    /// Line of the table's file.
    pub line: usize,
    /// Residual and influence.
    #[serde(flatten)]
    pub influence: RowInfluence,
}

/// A prediction with intervals.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct PredictionOutcome {
    /// Line of the file that asks for it.
    pub line: usize,
    /// Mean and intervals.
    #[serde(flatten)]
    pub prediction: Prediction,
}

/// Rows with their influence and their lines in the file.
pub fn rows_of(influence: Vec<RowInfluence>, lines: &[usize]) -> Vec<RowOutcome> {
    let rows = influence.into_iter().zip(lines);
    rows.map(|(influence, &line)| RowOutcome { line, influence })
        .collect()
}
