//! What `inspect` found, as text and CSV.

use crate::run::{ColumnInspection, Inspection};
use std::fmt::Write;
use windfall_draw::terminal_plot::terminal_plot;
use windfall_files::error::Error;
use windfall_files::table::write::{csv_text, number_cell};
use windfall_files::text::number::plain;
use windfall_files::text::table::{finding_lines, table_text};

/// Most properties of a file that the text shows.
const SHOWN_PROPERTIES: usize = 12;

/// Most channels that the text plots.
const PLOTTED: usize = 6;

/// Height of a plot; lines.
const PLOT_ROWS: usize = 6;

/// An inspection as text: a table of channels, small plots, what looks wrong.
///
/// * `columns`: width of the terminal; characters
pub fn text_of_inspection(inspection: &Inspection, columns: usize) -> String {
    let header = [
        "channel",
        "unit",
        "could be",
        "samples",
        "rate (Hz)",
        "length (s)",
        "smallest",
        "largest",
        "stored as",
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
            column.stored_as.clone(),
        ]
    });
    let table = table_text(&header.map(str::to_owned), rows, &[0, 1, 2, 8]);
    let mut text = format!(
        "{}: {}, {} rows\n\n{table}\n",
        inspection.file, inspection.format, inspection.rows
    );
    for (name, value) in inspection.properties.0.iter().take(SHOWN_PROPERTIES) {
        let _ = writeln!(text, "{name}: {value}");
    }
    if inspection.properties.0.len() > SHOWN_PROPERTIES {
        let more = inspection.properties.0.len() - SHOWN_PROPERTIES;
        let _ = writeln!(text, "and {more} more properties (--format json shows all)");
    }
    for curve in inspection.curves.iter().take(PLOTTED) {
        let _ = writeln!(text, "\n{}", terminal_plot(curve, columns, PLOT_ROWS));
    }
    if inspection.curves.len() > PLOTTED {
        let more = inspection.curves.len() - PLOTTED;
        let _ = writeln!(text, "({more} more channels; --channel NAME plots one)\n");
    }
    if inspection.findings.is_empty() {
        text += "nothing looks wrong\n";
    }
    for line in finding_lines(&inspection.findings) {
        let _ = writeln!(text, "{line}");
    }
    text
}

/// Inspections as CSV, one row per column of each file.
pub fn csv_of_inspections(inspections: &[Inspection]) -> Result<String, Error> {
    let header = [
        "file", "column", "unit", "could_be", "samples", "rate_Hz", "length_s", "smallest",
        "largest", "findings",
    ];
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
            number_cell(column.rate),
            number_cell(column.length),
            number_cell(column.smallest),
            number_cell(column.largest),
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
