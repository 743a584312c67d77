//! Tables for statistics: columns of numbers and of categories from CSV.

use crate::error::{Error, Place};
use crate::found::FindingOutcome;
use crate::table::columns::{Held, Manner, Reading, read_columns};
use crate::table::csv::{Open, open};
use std::path::{Path, PathBuf};
use windfall_statistics::error::Error as StatisticsError;
use windfall_statistics::model::model_frame::chosen_rows;
use windfall_statistics::runs::Runs;
use windfall_statistics::table::{Column, Table};

pub use crate::table::columns::{EXCLUDE_COLUMN, LEFT_OUT_COLUMN, excludes};

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
    pub lines: Runs,
    /// Rows that do not count: something stands in their column [`LEFT_OUT_COLUMN`] or
    /// [`EXCLUDE_COLUMN`]. They are not in the table.
    pub left_out: usize,
}

impl Data {
    /// Names of its columns.
    pub fn names(&self) -> Vec<String> {
        let columns = self.table.columns.iter();
        columns.map(|column| column.name.clone()).collect()
    }

    /// Line of a row in the file; 0 of a row that is not there.
    pub fn line(&self, row: usize) -> usize {
        self.lines.get(row).unwrap_or_default()
    }

    /// Keeps some rows, in their order.
    pub fn keep(&mut self, rows: &[usize]) {
        self.table = chosen_rows(&self.table, rows).into_owned();
        self.lines = rows.iter().map(|row| self.line(*row)).collect();
    }

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

impl Data {
    /// What statistics say about the table, with the file and the line that it is about.
    pub fn told(&self, error: StatisticsError) -> Error {
        let line = error
            .row()
            .and_then(|row| self.lines.get(row.checked_sub(1)?));
        match line {
            Some(line) => Error::Refused {
                place: Place::at(&self.path, line),
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

/// Which columns of a table are read.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Wanted {
    /// Those of these names, whatever they hold. Where one is not in the table, all are read,
    /// so that what is said about it can name them.
    pub named: Vec<String>,
    /// Others too, where they hold numbers.
    pub numbers: bool,
    /// All of them.
    pub all: bool,
}

impl Wanted {
    /// All columns.
    pub fn all() -> Self {
        Self {
            all: true,
            ..Self::default()
        }
    }

    fn readings(&self, columns: &[String]) -> Vec<Reading> {
        let all = self.all || !self.named.iter().all(|name| columns.contains(name));
        let reading = |name: &String| match (all || self.named.contains(name), self.numbers) {
            _ if name.is_empty() => Reading::Nothing,
            (true, _) => Reading::Anything,
            (false, true) => Reading::Numbers,
            (false, false) => Reading::Nothing,
        };
        columns.iter().map(reading).collect()
    }
}

/// A table whose header has been read.
pub struct DataFile {
    open: Open,
}

/// Opens a table.
///
/// # Errors
/// It cannot be read, is empty, or names a column twice.
pub fn open_data(path: &Path) -> Result<DataFile, Error> {
    Ok(DataFile { open: open(path)? })
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
    open_data(path)?.read(&[MISSING.to_owned()], &Wanted::all())
}

impl DataFile {
    /// Names of the columns that have one.
    pub fn names(&self) -> Vec<String> {
        let names = self.open.form.columns.iter();
        names.filter(|name| !name.is_empty()).cloned().collect()
    }

    /// Reads columns of the table, where some words stand for a missing value, and blank cells.
    ///
    /// # Errors
    /// As [`read_data`]; numbers in columns that are not read are not looked at.
    pub fn read(mut self, missing: &[String], wanted: &Wanted) -> Result<Data, Error> {
        let form = &self.open.form;
        let (path, names) = (form.path.clone(), form.columns.clone());
        let manner = Manner::new(form, missing);
        let mut read = read_columns(&mut self.open, &manner, &wanted.readings(&names))?;
        if read.lines.is_empty() {
            return Err(Error::TableWithoutRows {
                path,
                row_is: "observation",
            });
        }
        if !read.again.is_empty() {
            let mut readings = vec![Reading::Nothing; names.len()];
            for column in &read.again {
                readings[*column] = Reading::Text;
            }
            let text = read_columns(&mut open(&path)?, &manner, &readings)?;
            for (held, text) in read.cells.iter_mut().zip(text.cells) {
                if let Held::Text(_) = text {
                    *held = text;
                }
            }
        }
        let cells = read.cells.into_iter().zip(names);
        let columns = cells.filter_map(|(cells, name)| {
            Some(Column {
                name,
                cells: cells.whole()?,
            })
        });
        Ok(Data {
            path,
            table: Table {
                columns: columns.collect(),
            },
            comments: self.open.comments,
            lines: read.lines,
            left_out: read.left_out,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use windfall_statistics::table::Cells;

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
        assert!(data.lines.iter().eq([5, 6, 7]));
        let numbers = data.table.numbers("k").unwrap();
        assert_eq!((numbers.at(0), numbers.at(2)), (1.5, 2.5));
        assert!(numbers.at(1).is_nan());
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
