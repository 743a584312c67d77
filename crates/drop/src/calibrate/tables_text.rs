//! Tables of a calibration as files: NAME.csv and NAME.txt.

use crate::calibrate::outcome::CalibrateOutcome;
use crate::calibrate::tables::{
    CalibrateTable, Cell, closing_table, design_tables, line_table, next_table,
};
use std::path::Path;
use windfall_files::error::Error;
use windfall_files::table::write::csv_text;
use windfall_files::text::number::plain;
use windfall_files::text::statistic::probability;
use windfall_files::text::table::{page_tables, paragraph};
use windfall_files::write_file::{make_directory, write_whole};

/// All tables of a calibration.
pub fn tables_of(outcome: &CalibrateOutcome) -> Vec<CalibrateTable> {
    let line = line_table(outcome).into_iter();
    let others = line
        .chain([closing_table(outcome)])
        .chain(next_table(outcome));
    others.chain(design_tables(outcome)).collect()
}

/// A table with its title, for people.
pub fn text_of_table(table: &CalibrateTable) -> String {
    let cell = |cell: &Cell| match cell {
        Cell::Word(text) => text.clone(),
        Cell::Number(value) if !value.is_finite() => "-".to_owned(),
        Cell::Number(value) if value.fract() == 0.0 && value.abs() < 1e6 => value.to_string(),
        Cell::Number(value) => plain(*value),
        Cell::Part(part) => format!("{:.2} %", 100.0 * part),
        Cell::Probability(p) => probability(*p),
        Cell::Blank => String::new(),
    };
    let rows: Vec<Vec<String>> = table
        .rows
        .iter()
        .map(|r| r.iter().map(cell).collect())
        .collect();
    let words = |column: &usize| {
        let mut cells = table.rows.iter().filter_map(|row| row.get(*column));
        cells.all(|cell| matches!(cell, Cell::Word(_)))
    };
    let left: Vec<usize> = (0..table.header.len()).filter(words).collect();
    format!(
        "{}\n{}\n",
        paragraph(&table.title, 2),
        page_tables(&table.header, &rows, &left)
    )
}

/// A table as CSV, with all digits.
pub fn csv_of_table(table: &CalibrateTable) -> Result<String, Error> {
    let cell = |cell: &Cell| match cell {
        Cell::Word(text) => text.clone(),
        Cell::Number(v) | Cell::Part(v) | Cell::Probability(v) if v.is_finite() => v.to_string(),
        _ => String::new(),
    };
    let rows = table.rows.iter().map(|row| row.iter().map(cell).collect());
    csv_text(&table.header, rows)
}

/// Writes every table into a directory, which is made where it is missing.
///
/// # Errors
/// The directory or a file cannot be written.
pub fn write_calibrate_tables(directory: &Path, outcome: &CalibrateOutcome) -> Result<(), Error> {
    make_directory(directory)?;
    for table in tables_of(outcome) {
        let path = directory.join(table.name);
        write_whole(
            &path.with_extension("csv"),
            csv_of_table(&table)?.as_bytes(),
        )?;
        write_whole(
            &path.with_extension("txt"),
            text_of_table(&table).as_bytes(),
        )?;
    }
    Ok(())
}
