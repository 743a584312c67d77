//! Tables for statistics: columns of numbers and of categories from CSV.

use crate::error::{Error, Place};
use crate::table::csv::{line_of, next_row, open};
use std::path::Path;
use windfall_statistics::table::{Categories, Cells, Column, Table};

/// Cells that stand for a missing value, in lower case.
const MISSING: [&str; 7] = ["", "na", "nan", "n/a", "null", "none", "."];

/// A table with what its file says beside it.
#[derive(Clone, Debug, PartialEq)]
pub struct Data {
    /// The columns.
    pub table: Table,
    /// Lines before the header that begin with `#`, without it.
    pub comments: Vec<String>,
    /// Line of each row in the file, from 1.
    pub lines: Vec<usize>,
}

/// Reads a table: columns of numbers and missing cells are numeric, others categories.
///
/// Separated by commas, semicolons or tabs; with semicolons or tabs, numbers may
/// have a decimal comma. Missing cells are blank, `NA`, `NaN`, `N/A`, `null`,
/// `none` or a single point.
///
/// # Errors
/// As [`crate::table::csv::read_table`]; there is no row; an infinite number.
pub fn read_data(path: &Path) -> Result<Data, Error> {
    let mut open_file = open(path)?;
    let comma = open_file.separator != "commas";
    let columns = open_file.columns.clone();
    let mut numbers: Vec<Option<Vec<f64>>> = columns.iter().map(|_| Some(Vec::new())).collect();
    let mut lines = Vec::new();
    let mut record = csv::StringRecord::new();
    while next_row(&mut open_file, &mut record)? {
        let line = line_of(&open_file, &record);
        for ((column, cell), name) in numbers.iter_mut().zip(&record).zip(&columns) {
            let Some(values) = column else { continue };
            match number(cell.trim(), comma) {
                Some(value) if value.is_infinite() => {
                    return Err(Error::CellNotFinite {
                        place: Place {
                            file: path.to_path_buf(),
                            line,
                        },
                        column: name.clone(),
                        text: cell.trim().to_owned(),
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
    let mut categories = read_categories(path, &text)?.into_iter();
    let cells = numbers.into_iter().map(|numbers| match numbers {
        Some(numbers) => Cells::Numbers(numbers),
        None => Cells::Categories(categories.next().unwrap_or_default()),
    });
    let columns = columns.iter().zip(cells);
    Ok(Data {
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
    })
}

/// Reads again the columns that turned out to hold text.
fn read_categories(path: &Path, columns: &[usize]) -> Result<Vec<Categories>, Error> {
    if columns.is_empty() {
        return Ok(Vec::new());
    }
    let mut cells: Vec<Vec<String>> = columns.iter().map(|_| Vec::new()).collect();
    let mut open_file = open(path)?;
    let mut record = csv::StringRecord::new();
    while next_row(&mut open_file, &mut record)? {
        for (place, column) in columns.iter().enumerate() {
            let cell = record.get(*column).unwrap_or_default().trim();
            cells[place].push(match is_missing(cell) {
                true => String::new(),
                false => cell.to_owned(),
            });
        }
    }
    Ok(cells
        .iter()
        .map(|cells| Categories::of_cells(cells))
        .collect())
}

fn is_missing(cell: &str) -> bool {
    cell.len() <= 4 && MISSING.contains(&cell.to_ascii_lowercase().as_str())
}

/// * `comma`: whether a comma may be the decimal mark
fn number(cell: &str, comma: bool) -> Option<f64> {
    if let Ok(number) = cell.parse() {
        return Some(number);
    }
    if is_missing(cell) {
        return Some(f64::NAN);
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
