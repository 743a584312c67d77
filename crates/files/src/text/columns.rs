//! Tables column by column: a title and how a row's cell is written.

use crate::error::Error;
use crate::table::write::csv_text;
use crate::text::table::{Cells, page_tables};

/// Title of a column, and the cell of a row in it.
pub type Column<T> = (&'static str, fn(&T) -> String);

/// Rows as a table of text, none wider than a page.
///
/// * `left`: places of the columns that are flush left
pub fn text_of_rows<T>(rows: &[T], columns: &[Column<T>], left: &[usize]) -> String {
    page_tables(&titles(columns), &cells(rows, columns), left)
}

/// Rows as CSV.
///
/// # Errors
/// A cell cannot be written.
pub fn csv_of_rows<T>(rows: &[T], columns: &[Column<T>]) -> Result<String, Error> {
    csv_text(&titles(columns), cells(rows, columns))
}

/// A value where there is one, else a dash.
pub fn given(value: Option<f64>, write: fn(f64) -> String) -> String {
    value.map_or_else(|| "-".to_owned(), write)
}

/// Texts that own their letters.
pub fn strings(texts: &[&str]) -> Vec<String> {
    texts.iter().map(|text| (*text).to_owned()).collect()
}

/// Rows as cells, for a page.
pub fn cells_of_rows<T>(rows: &[T], columns: &[Column<T>]) -> Cells {
    Cells {
        header: titles(columns),
        rows: cells(rows, columns),
    }
}

fn titles<T>(columns: &[Column<T>]) -> Vec<String> {
    columns.iter().map(|column| column.0.to_owned()).collect()
}

fn cells<T>(rows: &[T], columns: &[Column<T>]) -> Vec<Vec<String>> {
    let cells_of = |row: &T| columns.iter().map(|(_, cell)| cell(row)).collect();
    rows.iter().map(cells_of).collect()
}
