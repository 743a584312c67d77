//! What `inspect` found, as text and CSV.

use crate::error::Error;
use crate::text_number::plain;
use crate::workflow_inspect::{ColumnInspection, Inspection};
use crate::write_csv::csv_text;
use crate::write_table::table_text;
use std::fmt::Write;

/// An inspection as text: a table of columns, then what looks wrong.
#[must_use]
pub fn text_of_inspection(inspection: &Inspection) -> String {
    let header = [
        "column", "unit", "could be", "samples", "rate", "length", "smallest", "largest",
    ];
    let number = |value: Option<f64>| value.map_or_else(|| "-".to_owned(), plain);
    let rows = inspection.columns.iter().map(|column| {
        vec![
            column.column.clone(),
            column.unit.clone().unwrap_or_else(|| "-".to_owned()),
            column.role.unwrap_or("-").to_owned(),
            column.samples.to_string(),
            number(column.rate),
            number(column.length),
            number(column.smallest),
            number(column.largest),
        ]
    });
    let table = table_text(&header.map(str::to_owned), rows, &[0, 1, 2]);
    let mut text = format!("{}: {} rows\n\n{table}\n", inspection.file, inspection.rows);
    if inspection
        .columns
        .iter()
        .any(|column| column.rate.is_some())
    {
        text += "(rate in samples per unit of the time column to the left, length in that unit)\n";
    }
    if inspection.findings.is_empty() {
        text += "nothing looks wrong\n";
    }
    for finding in &inspection.findings {
        let _ = writeln!(text, "{}: {}", finding.code, finding.message);
    }
    text
}

/// Inspections as CSV, one row per column of each file.
///
/// # Errors
/// None in practice: the text is written to memory.
pub fn csv_of_inspections(inspections: &[Inspection]) -> Result<String, Error> {
    let header = [
        "file",
        "column",
        "unit",
        "could_be",
        "samples",
        "rate_per_time_unit",
        "length",
        "smallest",
        "largest",
        "findings",
    ];
    let number = |value: Option<f64>| value.map_or_else(String::new, |value| value.to_string());
    let row = |inspection: &Inspection, column: &ColumnInspection| {
        let named = format!("\"{}\"", column.column);
        let codes: Vec<&str> = inspection
            .findings
            .iter()
            .filter(|finding| finding.message.contains(&named))
            .map(|finding| finding.code.as_str())
            .collect();
        vec![
            inspection.file.clone(),
            column.column.clone(),
            column.unit.clone().unwrap_or_default(),
            column.role.unwrap_or_default().to_owned(),
            column.samples.to_string(),
            number(column.rate),
            number(column.length),
            number(column.smallest),
            number(column.largest),
            codes.join(" "),
        ]
    };
    let rows = inspections.iter().flat_map(|inspection| {
        inspection
            .columns
            .iter()
            .map(move |column| row(inspection, column))
    });
    csv_text(&header.map(str::to_owned), rows)
}
