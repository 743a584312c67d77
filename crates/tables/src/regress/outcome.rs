//! Fitted linear models as JSON shows them.

use serde::{Serialize, Serializer};
use windfall_files::text::columns::{Column, text_of_rows};
use windfall_files::text::statistic::number;
use windfall_statistics::model::expression::columns_of;
use windfall_statistics::model::formula::Formula;
use windfall_statistics::model::original_scale::OriginalScale;
use windfall_statistics::model::prediction::Prediction;
use windfall_statistics::residuals::diagnostics::{Influence, RowInfluence};
use windfall_statistics::runs::Runs;
use windfall_statistics::table::Table;

/// A step of a selection.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct StepOutcome {
    /// The term.
    pub term: String,
    /// "removed" or "entered".
    pub action: &'static str,
    /// F of the term.
    #[schema(value_type = Option<f64>)]
    pub f: f64,
    /// Its probability.
    #[schema(value_type = Option<f64>)]
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
pub fn ranges_of(formula: &Formula, table: &Table, kept: &Runs) -> Vec<RangeOutcome> {
    let atoms = formula.atoms.iter();
    let mut names: Vec<String> = atoms.flat_map(|atom| columns_of(&atom.node)).collect();
    names.sort();
    names.dedup();
    let range = |name: String| {
        let values = table.numbers(&name).ok()?;
        let (low, high) = values.range(kept);
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
    /// The same on the scale of the column that the response is a function of.
    pub original: Option<OriginalPrediction>,
}

/// A prediction on the scale of the column that the response is a function of. Of a normal
/// distribution there it is the median; an end that the function never reaches is null.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct OriginalPrediction {
    /// The prediction.
    #[schema(value_type = Option<f64>)]
    pub predicted: f64,
    /// Lower end of its interval.
    #[schema(value_type = Option<f64>)]
    pub mean_low: f64,
    /// Upper end.
    #[schema(value_type = Option<f64>)]
    pub mean_high: f64,
    /// Lower end of the interval of one new measurement.
    #[schema(value_type = Option<f64>)]
    pub low: f64,
    /// Upper end.
    #[schema(value_type = Option<f64>)]
    pub high: f64,
}

/// A prediction on the scale of the column below a response; `None` where that is the model's.
///
/// * `mean`, `measurement`: their intervals on the scale of the model
pub(crate) fn original_prediction(
    scale: Option<&OriginalScale>,
    predicted: f64,
    mean: (f64, f64),
    measurement: (f64, f64),
) -> Option<OriginalPrediction> {
    let scale = scale?;
    let (mean_low, mean_high) = scale.interval(predicted, mean);
    let (low, high) = scale.interval(predicted, measurement);
    Some(OriginalPrediction {
        predicted: scale.value(predicted),
        mean_low,
        mean_high,
        low,
        high,
    })
}

/// Lines of a page for predictions on that scale; empty where there are none.
///
/// * `rows`: lines of the file with their predictions
pub(crate) fn original_text(rows: &[(usize, OriginalPrediction)]) -> String {
    const COLUMNS: [Column<(usize, OriginalPrediction)>; 6] = [
        ("line", |row| row.0.to_string()),
        ("predicted", |row| number(row.1.predicted)),
        ("median from", |row| number(row.1.mean_low)),
        ("to", |row| number(row.1.mean_high)),
        ("observation from", |row| number(row.1.low)),
        ("to ", |row| number(row.1.high)),
    ];
    match rows.is_empty() {
        true => String::new(),
        false => format!(
            "\nThe same on the scale of the column, as medians:\n{}\n",
            text_of_rows(rows, &COLUMNS, &[])
        ),
    }
}

/// A cell of a value on that scale.
pub(crate) fn original_cell(
    original: Option<&OriginalPrediction>,
    of: fn(&OriginalPrediction) -> f64,
) -> String {
    original.map_or_else(String::new, |own| of(own).to_string())
}

/// Rows of a fit with their influence and their lines in the file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RowOutcomes {
    influence: Influence<'static>,
    lines: Runs,
}

impl RowOutcomes {
    /// Of as many lines as there are rows.
    pub fn new(influence: Influence<'static>, lines: Runs) -> Self {
        Self { influence, lines }
    }

    /// Each row.
    pub fn iter(&self) -> impl Iterator<Item = RowOutcome> {
        let rows = self.influence.iter().zip(self.lines.iter());
        rows.map(|(influence, line)| RowOutcome { line, influence })
    }
}

impl Serialize for RowOutcomes {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_seq(self.iter())
    }
}
