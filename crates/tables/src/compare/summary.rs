//! `windfall summary`: what the values of a table look like, group by group.

use crate::compare::group_outcome::{missing_findings, row_count, statistics_error, summaries};
#[cfg(feature = "clap")]
use crate::option_words::trimmed;
use crate::reading::ReadingOptions;
use crate::rows::RowCount;
use serde::Serialize;
use std::path::PathBuf;
use windfall_files::error::Error;
use windfall_files::found::FindingOutcome;
use windfall_files::option_value::unusable;
use windfall_files::table::data::Data;
use windfall_statistics::compare::group_summary::{GroupSummary, split_groups};
use windfall_statistics::table::Cells;

/// What `windfall summary` is asked.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
pub struct SummaryRequest {
    /// Table with a header line (CSV)
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
    /// How the table is read
    #[cfg_attr(feature = "clap", command(flatten))]
    pub reading: ReadingOptions,
}

/// Every group of every value.
#[derive(Clone, Debug, PartialEq, Serialize)]
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
#[derive(Clone, Debug, PartialEq, Serialize)]
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
    let data = request.reading.read(&request.table)?;
    let by: Vec<&str> = request.by.iter().map(String::as_str).collect();
    let mut outcome = SummaryOutcome {
        by: request.by.clone(),
        confidence: request.confidence,
        values: Vec::new(),
        findings: data.left_out_finding().into_iter().collect(),
    };
    for value in values_of(request, &data)? {
        let groups = split_groups(&data.table, &by, &value).map_err(|error| data.told(error))?;
        let found = missing_findings(&groups, &value, &request.by, &data.lines);
        for finding in found {
            // rows without a group are the same for every value
            if !outcome.findings.contains(&finding) {
                outcome.findings.push(finding);
            }
        }
        outcome.values.push(ValueSummary {
            groups: summaries(&groups.groups, request.confidence)?,
            value,
            count: row_count(&groups),
        });
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
