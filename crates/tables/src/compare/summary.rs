//! `windfall summary`: what the values of a table look like, group by group.

use crate::compare::figures::summary_painting;
use crate::compare::group_outcome::{missing_findings, row_count, statistics_error, summaries};
#[cfg(feature = "clap")]
use crate::option_words::trimmed;
use crate::reading::ReadingOptions;
use crate::regress::findings::finding;
use crate::rows::RowCount;
use serde::Serialize;
use std::path::PathBuf;
use windfall_draw::files::{FigureFolder, write_paintings};
use windfall_files::error::Error;
use windfall_files::found::FindingOutcome;
use windfall_files::option_value::unusable;
use windfall_files::table::data::{Data, Wanted, open_data};
use windfall_files::write_file::check_outputs;
use windfall_statistics::compare::group_summary::{GroupSummary, split_groups};
use windfall_statistics::table::Cells;

/// What `windfall summary` is asked.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
pub struct SummaryRequest {
    /// Table with a header line (CSV, Parquet or Arrow), or a folder of Parquet files
    #[cfg_attr(feature = "clap", arg(value_hint = clap::ValueHint::FilePath))]
    pub table: PathBuf,
    /// Columns that group the rows, separated by commas; all rows are one group if left out
    #[cfg_attr(feature = "clap", arg(long, value_name = "COLUMNS", value_delimiter = ',', value_parser = trimmed))]
    pub by: Vec<String>,
    /// Column of values; may be repeated; all columns of numbers if left out
    #[cfg_attr(feature = "clap", arg(long = "value", value_name = "COLUMN"))]
    pub values: Vec<String>,
    /// Level of the intervals of means
    #[cfg_attr(
        feature = "clap",
        arg(long, default_value_t = 0.95, value_name = "LEVEL")
    )]
    pub confidence: f64,
    /// Histogram of each column, and its groups with every point
    #[cfg_attr(feature = "clap", command(flatten))]
    pub figures: Option<FigureFolder>,
    /// How the table is read
    #[cfg_attr(feature = "clap", command(flatten))]
    pub reading: ReadingOptions,
}

/// Most columns that are drawn.
const MOST_FIGURES: usize = 24;

/// Every group of every value.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct SummaryOutcome {
    /// Columns that group the rows.
    pub by: Vec<String>,
    /// Confidence of the intervals.
    pub confidence: f64,
    /// One per column of values.
    pub values: Vec<ValueSummary>,
    /// What has to be said beside the numbers.
    pub findings: Vec<FindingOutcome>,
}

/// The groups of one value.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct ValueSummary {
    /// The column.
    pub value: String,
    /// Rows with a value and a group, and those without.
    #[serde(flatten)]
    pub count: RowCount,
    /// Its groups.
    pub groups: Vec<GroupSummary>,
}

/// Describes the values of a table, group by group.
///
/// # Errors
/// The table cannot be read, a column is not there or holds text.
pub fn summarize_table(request: &SummaryRequest) -> Result<SummaryOutcome, Error> {
    check_confidence(request.confidence)?;
    check_outputs([request.figures.as_ref().map(|own| own.directory.as_path())])?;
    let wanted = Wanted {
        named: [&request.by[..], &request.values].concat(),
        numbers: request.values.is_empty(),
        all: request.figures.is_some(),
    };
    let file = open_data(&request.table)?;
    let data = request.reading.read_some(file, wanted)?;
    let by: Vec<&str> = request.by.iter().map(String::as_str).collect();
    let mut outcome = SummaryOutcome {
        by: request.by.clone(),
        confidence: request.confidence,
        values: Vec::new(),
        findings: data.left_out_finding().into_iter().collect(),
    };
    let mut paintings = Vec::new();
    let mut left: Vec<String> = Vec::new();
    for value in values_of(request, &data)? {
        let groups = split_groups(&data.table, &by, &value).map_err(|error| data.told(error))?;
        let found = missing_findings(&groups, &value, &request.by, &data.lines);
        for finding in found {
            // rows without a group are the same for every value
            if !outcome.findings.contains(&finding) {
                outcome.findings.push(finding);
            }
        }
        let described = summaries(&groups.groups, request.confidence)?;
        match (&request.figures, paintings.len() < MOST_FIGURES) {
            (None, _) => (),
            // A column that was named twice has one figure.
            _ if outcome.values.iter().any(|own| own.value == value) => (),
            (Some(_), false) => left.push(value.clone()),
            (Some(_), true) => paintings.push(summary_painting(
                &data,
                &groups,
                (&value, &request.by),
                &described,
                request.confidence,
            )?),
        }
        outcome.values.push(ValueSummary {
            groups: described,
            value,
            count: row_count(&groups),
        });
    }
    if !left.is_empty() {
        let told = format!(
            "figures are drawn of the first {MOST_FIGURES} columns, not of {}; name them with \
             --value",
            left.join(", ")
        );
        outcome.findings.push(finding("not-drawn", told));
    }
    if let Some(folder) = &request.figures {
        write_paintings(folder, &paintings)?;
    }
    Ok(outcome)
}

/// A confidence strictly between 0 and 1.
pub(crate) fn check_confidence(confidence: f64) -> Result<(), Error> {
    windfall_statistics::sample::check_probability("--confidence", confidence)
        .map_err(statistics_error)
}

fn values_of(request: &SummaryRequest, data: &Data) -> Result<Vec<String>, Error> {
    if !request.values.is_empty() {
        return Ok(request.values.clone());
    }
    let columns = data.table.columns.iter();
    let found: Vec<String> = columns
        .filter(|column| matches!(column.cells, Cells::Numbers(_)))
        .filter(|column| !request.by.contains(&column.name))
        .map(|column| column.name.clone())
        .collect();
    match found.is_empty() {
        true => Err(unusable("--value", "no column of the table holds numbers")),
        false => Ok(found),
    }
}
