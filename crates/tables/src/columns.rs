//! Tables column by column: a title and how a row's cell is written.

use windfall_files::error::Error;
use windfall_files::table::write::csv_text;
use windfall_files::text::table::page_tables;

/// Title of a column, and the cell of a row in it.
pub(crate) type Column<T> = (&'static str, fn(&T) -> String);

/// Rows as a table of text.
///
/// * `left`: places of the columns that are flush left
pub(crate) fn text_of_rows<T>(rows: &[T], columns: &[Column<T>], left: &[usize]) -> String {
    page_tables(&titles(columns), &cells(rows, columns), left)
}

pub(crate) fn csv_of_rows<T>(rows: &[T], columns: &[Column<T>]) -> Result<String, Error> {
    csv_text(&titles(columns), cells(rows, columns))
}

/// A value where there is one, else a dash.
pub(crate) fn given(value: Option<f64>, write: fn(f64) -> String) -> String {
    value.map_or_else(|| "-".to_owned(), write)
}

pub(crate) fn strings(texts: &[&str]) -> Vec<String> {
    texts.iter().map(|text| (*text).to_owned()).collect()
}

fn titles<T>(columns: &[Column<T>]) -> Vec<String> {
    columns.iter().map(|column| column.0.to_owned()).collect()
}

fn cells<T>(rows: &[T], columns: &[Column<T>]) -> Vec<Vec<String>> {
    let cells_of = |row: &T| columns.iter().map(|(_, cell)| cell(row)).collect();
    rows.iter().map(cells_of).collect()
}
