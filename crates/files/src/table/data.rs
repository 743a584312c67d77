//! Tables for statistics: columns of numbers and of categories from CSV.

use crate::error::{Error, Place};
use crate::found::FindingOutcome;
use crate::table::csv::{line_of, next_row, open};
use crate::table::write::plain_cell;
use std::path::{Path, PathBuf};
use windfall_numerics::unit::quantity::LARGEST;
use windfall_statistics::error::Error as StatisticsError;
use windfall_statistics::table::{Categories, Cells, Column, LevelCodes, Table};

/// The word that stands for a missing value where no others are told.
pub const MISSING: &str = "NA";

/// A table with what its file says beside it.
#[derive(Clone, Debug, PartialEq)]
pub struct Data {
    /// Its file.
    pub path: PathBuf,
    /// The columns.
    pub table: Table,
    /// Lines before the header that begin with `#`, without it.
    pub comments: Vec<String>,
    /// Line of each row in the file, from 1.
    pub lines: Vec<usize>,
    /// Rows that do not count: something stands in their column [`LEFT_OUT_COLUMN`] or
    /// [`EXCLUDE_COLUMN`]. They are not in the table.
    pub left_out: usize,
}

impl Data {
    /// Says how many rows do not count, if any.
    pub fn left_out_finding(&self) -> Option<FindingOutcome> {
        let rows = match self.left_out {
            0 => return None,
            1 => "1 row does".to_owned(),
            n => format!("{n} rows do"),
        };
        let told = format!(
            "{rows} not count, as the columns {LEFT_OUT_COLUMN} or {EXCLUDE_COLUMN} say; empty \
             these cells for rows that are to count"
        );
        Some(FindingOutcome::new("rows-left-out", told))
    }
}

/// Column in which windfall says why an impact does not count.
pub const LEFT_OUT_COLUMN: &str = "left_out";
/// Column by which the user leaves a row out.
pub const EXCLUDE_COLUMN: &str = "exclude";
/// Cells of [`EXCLUDE_COLUMN`] that leave nothing out.
const KEPT: [&str; 5] = ["", "0", "no", "false", "n"];

/// Whether a cell of [`EXCLUDE_COLUMN`] leaves its row out.
pub fn excludes(cell: &str) -> bool {
    !KEPT.contains(&cell.trim().to_lowercase().as_str())
}

/// Whether a row counts.
fn counts(columns: &[String], record: &csv::StringRecord) -> bool {
    columns
        .iter()
        .zip(record)
        .all(|(name, cell)| match name.as_str() {
            LEFT_OUT_COLUMN => cell.trim().is_empty(),
            EXCLUDE_COLUMN => !excludes(cell),
            _ => true,
        })
}

impl Data {
    /// What statistics say about the table, with the file and the line that it is about.
    pub fn told(&self, error: StatisticsError) -> Error {
        let line = error.row().and_then(|row| self.lines.get(row - 1));
        match line {
            Some(line) => Error::Refused {
                place: Place::at(&self.path, *line),
                problem: error.to_string(),
            },
            None if is_of_request(&error) => Error::Statistics(error),
            None => Error::Refused {
                place: Place::at(&self.path, 0),
                problem: error.to_string(),
            },
        }
    }
}

/// Whether what was asked for is wrong, whatever the table.
fn is_of_request(error: &StatisticsError) -> bool {
    use StatisticsError::{FormulaSyntax, Request, UnknownFunction};
    matches!(
        error,
        FormulaSyntax { .. } | UnknownFunction { .. } | Request { .. }
    )
}

/// Reads a table: columns of numbers and missing cells are numeric, others categories.
///
/// Separated by commas, semicolons or tabs; with semicolons or tabs, numbers may
/// have a decimal comma. Missing cells are blank or `NA`, and `NaN` in a column of numbers.
///
/// # Errors
/// As [`crate::table::csv::read_table`]; there is no row; a number that is infinite or beyond
/// 1e100.
pub fn read_data(path: &Path) -> Result<Data, Error> {
    read_data_without(path, &[MISSING.to_owned()])
}

/// [`read_data`], where these words stand for a missing value, and blank cells.
pub fn read_data_without(path: &Path, missing: &[String]) -> Result<Data, Error> {
    let mut open_file = open(path)?;
    let comma = open_file.separator != "commas";
    let columns = open_file.columns.clone();
    let mut numbers: Vec<Option<Vec<f64>>> = columns.iter().map(|_| Some(Vec::new())).collect();
    let mut lines = Vec::new();
    let (mut record, mut left_out) = (csv::StringRecord::new(), 0);
    while next_row(&mut open_file, &mut record)? {
        if !counts(&columns, &record) {
            left_out += 1;
            continue;
        }
        let line = line_of(&open_file, &record);
        for ((column, cell), name) in numbers.iter_mut().zip(&record).zip(&columns) {
            let Some(values) = column else { continue };
            let cell = plain_cell(cell);
            match number(cell, comma, missing) {
                Some(value) if value.abs() > LARGEST => {
                    return Err(Error::CellNotFinite {
                        place: Place {
                            file: path.to_path_buf(),
                            line,
                        },
                        column: name.clone(),
                        text: cell.to_owned(),
                    });
                }
                Some(value) => values.push(value),
                None => *column = None,
            }
        }
        lines.push(line);
    }
    if lines.is_empty() {
        return Err(Error::TableWithoutRows {
            path: path.to_path_buf(),
            row_is: "observation",
        });
    }
    let text = numbers.iter().enumerate().filter(|(_, n)| n.is_none());
    let text: Vec<usize> = text.map(|(index, _)| index).collect();
    let comments = std::mem::take(&mut open_file.comments);
    let mut categories = read_categories(path, &text, missing)?.into_iter();
    let cells = numbers.into_iter().map(|numbers| match numbers {
        Some(numbers) => Cells::Numbers(numbers),
        None => Cells::Categories(categories.next().unwrap_or_default()),
    });
    let columns = columns.iter().zip(cells);
    Ok(Data {
        path: path.to_path_buf(),
        table: Table {
            columns: columns
                .filter(|(name, _)| !name.is_empty())
                .map(|(name, cells)| Column {
                    name: name.clone(),
                    cells,
                })
                .collect(),
        },
        comments,
        lines,
        left_out,
    })
}

/// Reads again the columns that turned out to hold text.
fn read_categories(
    path: &Path,
    columns: &[usize],
    missing: &[String],
) -> Result<Vec<Categories>, Error> {
    if columns.is_empty() {
        return Ok(Vec::new());
    }
    let mut found = vec![LevelCodes::default(); columns.len()];
    let mut open_file = open(path)?;
    let mut record = csv::StringRecord::new();
    while next_row(&mut open_file, &mut record)? {
        if !counts(&open_file.columns, &record) {
            continue;
        }
        for (levels, column) in found.iter_mut().zip(columns) {
            let cell = plain_cell(record.get(*column).unwrap_or_default());
            levels.push(Some(cell).filter(|cell| !is_missing(cell, missing)));
        }
    }
    Ok(found.into_iter().map(LevelCodes::sorted).collect())
}

/// Whether a cell is blank or one of the words that stand for a missing value.
fn is_missing(cell: &str, words: &[String]) -> bool {
    cell.is_empty() || words.iter().any(|word| word == cell)
}

/// * `comma`: whether a comma may be the decimal mark
fn number(cell: &str, comma: bool, missing: &[String]) -> Option<f64> {
    if is_missing(cell, missing) {
        return Some(f64::NAN);
    }
    if let Ok(number) = cell.parse() {
        return Some(number);
    }
    match comma && cell.matches(',').count() == 1 {
        true => cell.replace(',', ".").parse().ok(),
        false => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<Data, Error> {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("table.csv");
        std::fs::write(&path, text).unwrap();
        read_data(&path)
    }

    #[test]
    fn closed_form_numbers_categories_and_missing_cells() {
        let data = read("# one\n#two\n\nk;variety;n\n1,5;Gala;1\nNA;;2\n2.5;Fuji;x\n").unwrap();
        assert_eq!(data.comments, ["one", "two"]);
        assert_eq!(data.lines, [5, 6, 7]);
        let numbers = data.table.numbers("k").unwrap();
        assert_eq!((numbers[0], numbers[2]), (1.5, 2.5));
        assert!(numbers[1].is_nan());
        match &data.table.column("variety").unwrap().cells {
            Cells::Categories(found) => {
                assert_eq!(found.levels, ["Fuji", "Gala"]);
                assert_eq!(found.codes, [Some(1), None, Some(0)]);
            }
            Cells::Numbers(_) => panic!("categories"),
        }
        let error = data.table.numbers("n").unwrap_err().to_string();
        assert!(error.contains("row 3: \"x\""), "{error}");
    }

    #[test]
    fn rejects_infinities_and_tables_without_rows() {
        assert!(matches!(
            read("a,b\n1,inf\n"),
            Err(Error::CellNotFinite { .. })
        ));
        assert!(matches!(read("a,b\n"), Err(Error::TableWithoutRows { .. })));
        assert!(matches!(read("a,b\n1\n"), Err(Error::RowRagged { .. })));
    }
}
