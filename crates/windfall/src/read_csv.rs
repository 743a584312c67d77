//! CSV recordings and tables: a header, then numbers or text.
//!
//! The separator (comma, semicolon or tab) is found from the header; a byte
//! order mark is passed over; names may be quoted and hold commas and units.

use crate::error::{Error, Place};
use std::fs::File;
use std::io::{BufRead, BufReader, Read};
use std::path::{Path, PathBuf};
use windfall_numerics::nearest_name::nearest_names;

/// Byte order mark of UTF-8.
const MARK: &[u8] = b"\xef\xbb\xbf";

/// Samples of the columns that were asked for, in that order.
///
/// A blank cell is `None`: the channel has no sample in that row.
#[derive(Clone, Debug, PartialEq)]
pub struct NumberColumns {
    /// One vector per column asked for, one entry per row.
    pub columns: Vec<Vec<Option<f64>>>,
}

/// A table of text, as specimens.csv and impacts.csv are.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Table {
    /// The file it came from.
    pub path: PathBuf,
    /// Names of the columns.
    pub columns: Vec<String>,
    /// Rows below the header.
    pub rows: Vec<Row>,
}

/// One row of a [`Table`].
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Row {
    /// Line in the file, from 1.
    pub line: usize,
    /// Cells, without surrounding blanks, one per column.
    pub cells: Vec<String>,
}

/// Names of the columns of a file.
///
/// # Errors
/// The file cannot be read, is empty or not UTF-8, or repeats a name.
pub fn read_header(path: &Path) -> Result<Vec<String>, Error> {
    Ok(open(path)?.columns)
}

/// Reads the named columns of numbers in one pass over the file.
///
/// `asked_by[i]` says in messages who wants column `i`.
///
/// # Errors
/// The file cannot be read, is empty, has no rows or is not UTF-8; a column is
/// missing or named twice; a row is ragged; a cell is neither blank nor a
/// finite number.
pub fn read_numbers(
    path: &Path,
    wanted: &[String],
    asked_by: &[String],
) -> Result<NumberColumns, Error> {
    let mut open = open(path)?;
    let indices = wanted
        .iter()
        .zip(asked_by)
        .map(|(column, by)| index_of(path, &open.columns, column, by))
        .collect::<Result<Vec<_>, _>>()?;
    let mut columns = vec![Vec::new(); wanted.len()];
    let mut record = csv::StringRecord::new();
    while next_row(&mut open, &mut record)? {
        let place = Place {
            file: path.to_path_buf(),
            line: line_of(&record),
        };
        for ((&index, name), column) in indices.iter().zip(wanted).zip(&mut columns) {
            column.push(number(&record[index], &place, name)?);
        }
    }
    if columns.first().is_some_and(Vec::is_empty) {
        return Err(Error::TableWithoutRows {
            path: path.to_path_buf(),
            row_is: "sample",
        });
    }
    Ok(NumberColumns { columns })
}

/// Most faulty cells that [`read_loose_numbers`] describes.
pub const DESCRIBED_FAULTS: usize = 10;

/// Every column of a file as far as it is numbers.
#[derive(Debug)]
pub struct LooseNumbers {
    /// One vector per column, one entry per row; blank and faulty are `None`.
    pub columns: Vec<Vec<Option<f64>>>,
    /// The first faulty cells.
    pub faults: Vec<Error>,
    /// How many more there are.
    pub more_faults: usize,
}

/// Reads every column of a file and goes on after faulty cells.
///
/// # Errors
/// The file cannot be read, is empty or not UTF-8; a row is ragged.
pub fn read_loose_numbers(path: &Path) -> Result<LooseNumbers, Error> {
    let mut open = open(path)?;
    let mut loose = LooseNumbers {
        columns: vec![Vec::new(); open.columns.len()],
        faults: Vec::new(),
        more_faults: 0,
    };
    let mut record = csv::StringRecord::new();
    while next_row(&mut open, &mut record)? {
        let place = Place {
            file: path.to_path_buf(),
            line: line_of(&record),
        };
        for ((cell, name), column) in record.iter().zip(&open.columns).zip(&mut loose.columns) {
            let value = number(cell, &place, name);
            column.push(value.as_ref().ok().copied().flatten());
            match value {
                Err(fault) if loose.faults.len() < DESCRIBED_FAULTS => loose.faults.push(fault),
                Err(_) => loose.more_faults += 1,
                Ok(_) => {}
            }
        }
    }
    Ok(loose)
}

/// Reads a whole table as text.
///
/// # Errors
/// The file cannot be read, is empty or not UTF-8; a column is named twice; a
/// row is ragged.
pub fn read_table(path: &Path) -> Result<Table, Error> {
    let mut open = open(path)?;
    let mut rows = Vec::new();
    let mut record = csv::StringRecord::new();
    while next_row(&mut open, &mut record)? {
        let cells = record.iter().map(|cell| cell.trim().to_owned()).collect();
        rows.push(Row {
            line: line_of(&record),
            cells,
        });
    }
    Ok(Table {
        path: path.to_path_buf(),
        columns: open.columns,
        rows,
    })
}

/// Index of a column of a table.
///
/// # Errors
/// The column is missing; names the nearest ones.
pub fn column_index(table: &Table, column: &str) -> Result<usize, Error> {
    index_of(&table.path, &table.columns, column, "")
}

/// A file whose header has been read.
struct Open {
    path: PathBuf,
    columns: Vec<String>,
    separator: &'static str,
    reader: csv::Reader<Box<dyn Read>>,
}

fn open(path: &Path) -> Result<Open, Error> {
    let file = File::open(path).map_err(|source| access(path, source))?;
    let mut reader = BufReader::with_capacity(1 << 16, file);
    let start = reader.fill_buf().map_err(|source| access(path, source))?;
    if start.starts_with(MARK) {
        reader.consume(MARK.len());
    }
    // The header is read to its end, however long, before anything is decided.
    let mut header = Vec::new();
    while header.iter().all(u8::is_ascii_whitespace) {
        header.clear();
        let read = reader
            .read_until(b'\n', &mut header)
            .map_err(|source| access(path, source))?;
        if read == 0 {
            return Err(Error::TableEmpty {
                path: path.to_path_buf(),
            });
        }
    }
    let (byte, separator) = separator_of(&header);
    let whole: Box<dyn Read> = Box::new(std::io::Cursor::new(header).chain(reader));
    let mut reader = csv::ReaderBuilder::new()
        .delimiter(byte)
        .flexible(true)
        .from_reader(whole);
    let columns: Vec<String> = reader
        .headers()
        .map_err(|error| csv_error(path, &error))?
        .iter()
        .map(|name| name.trim().to_owned())
        .collect();
    for (index, column) in columns.iter().enumerate() {
        if !column.is_empty() && columns[..index].contains(column) {
            let column = column.clone();
            return Err(Error::ColumnRepeated {
                path: path.to_path_buf(),
                column,
            });
        }
    }
    Ok(Open {
        path: path.to_path_buf(),
        columns,
        separator,
        reader,
    })
}

/// The separator that occurs most often outside quotes; a comma if none does.
fn separator_of(header: &[u8]) -> (u8, &'static str) {
    let mut best = (b',', "commas");
    let mut most = 0;
    for (byte, name) in [(b',', "commas"), (b';', "semicolons"), (b'\t', "tabs")] {
        let mut quoted = false;
        let mut count = 0;
        for &b in header {
            quoted ^= b == b'"';
            count += usize::from(b == byte && !quoted);
        }
        if count > most {
            most = count;
            best = (byte, name);
        }
    }
    best
}

/// Reads the next row that is not blank; false at the end of the file.
fn next_row(open: &mut Open, record: &mut csv::StringRecord) -> Result<bool, Error> {
    while open
        .reader
        .read_record(record)
        .map_err(|error| csv_error(&open.path, &error))?
    {
        if record.len() == open.columns.len() {
            return Ok(true);
        }
        // A line of nothing but blanks is no row.
        if record.iter().all(|cell| cell.trim().is_empty()) {
            continue;
        }
        return Err(Error::RowRagged {
            place: Place {
                file: open.path.clone(),
                line: line_of(record),
            },
            expected: open.columns.len(),
            found: record.len(),
            separator: open.separator,
        });
    }
    Ok(false)
}

fn line_of(record: &csv::StringRecord) -> usize {
    record
        .position()
        .map_or(0, |position| position.line() as usize)
}

fn number(cell: &str, place: &Place, column: &str) -> Result<Option<f64>, Error> {
    let text = cell.trim();
    if text.is_empty() {
        return Ok(None);
    }
    match text.parse::<f64>() {
        Ok(value) if value.is_finite() => Ok(Some(value)),
        Ok(_) => Err(Error::CellNotFinite {
            place: place.clone(),
            column: column.to_owned(),
            text: text.to_owned(),
        }),
        Err(_) => Err(Error::CellNotNumber {
            place: place.clone(),
            column: column.to_owned(),
            text: text.to_owned(),
            hint: if text.replacen(',', ".", 1).parse::<f64>().is_ok() {
                " (windfall reads a decimal point, not a decimal comma)"
            } else {
                ""
            },
        }),
    }
}

fn index_of(path: &Path, columns: &[String], column: &str, by: &str) -> Result<usize, Error> {
    columns
        .iter()
        .position(|name| name == column)
        .ok_or_else(|| Error::ColumnMissing {
            path: path.to_path_buf(),
            column: column.to_owned(),
            asked_by: by.to_owned(),
            nearest: nearest_names(column, columns.iter().map(String::as_str))
                .into_iter()
                .map(str::to_owned)
                .collect(),
            columns: columns.len(),
        })
}

fn access(path: &Path, source: std::io::Error) -> Error {
    let path = path.to_path_buf();
    if source.kind() == std::io::ErrorKind::NotFound {
        return Error::FileAbsent {
            path,
            advice: "check the name and the directory".to_owned(),
        };
    }
    Error::FileAccess {
        path,
        action: "read",
        source,
    }
}

fn csv_error(path: &Path, error: &csv::Error) -> Error {
    let line = error
        .position()
        .map_or(0, |position| position.line() as usize);
    match error.kind() {
        csv::ErrorKind::Io(source) => Error::FileAccess {
            path: path.to_path_buf(),
            action: "read",
            source: std::io::Error::new(source.kind(), source.to_string()),
        },
        _ => Error::NotUtf8 {
            place: Place {
                file: path.to_path_buf(),
                line,
            },
        },
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn file(text: &[u8]) -> (tempfile::TempDir, PathBuf) {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("r.csv");
        std::fs::write(&path, text).unwrap();
        (dir, path)
    }

    fn numbers(text: &str, wanted: &[&str]) -> Result<Vec<Vec<Option<f64>>>, Error> {
        let (_dir, path) = file(text.as_bytes());
        let wanted: Vec<String> = wanted.iter().map(|w| (*w).to_owned()).collect();
        let by = vec![String::new(); wanted.len()];
        Ok(read_numbers(&path, &wanted, &by)?.columns)
    }

    fn message(text: &str, wanted: &[&str]) -> String {
        let text = numbers(text, wanted).unwrap_err().to_string();
        text.split_once("r.csv").unwrap().1.to_owned()
    }

    #[test]
    fn closed_form_cells_of_three_separators() {
        for s in [',', ';', '\t'] {
            let text = format!(
                "\u{feff}\"Run 1: Time (s)\"{s}\"F, tip (N)\"\n0{s}1\n\n0.5{s}\n1e0{s}-2\n"
            );
            let columns = numbers(&text, &["F, tip (N)", "Run 1: Time (s)"]).unwrap();
            assert_eq!(columns[0], [Some(1.0), None, Some(-2.0)]);
            assert_eq!(columns[1], [Some(0.0), Some(0.5), Some(1.0)]);
        }
    }

    #[test]
    fn rejects_what_is_no_table_of_numbers() {
        for (text, expected) in [
            (
                "",
                ": the file is empty; expected a header line with the names of the columns, then one line per sample",
            ),
            (
                "\n\n",
                ": the file is empty; expected a header line with the names of the columns, then one line per sample",
            ),
            (
                "t,F\n",
                ": the file has a header and no rows; expected one line per sample",
            ),
            (
                "t,Force\n0,1\n",
                ": there is no column \"F\"; the header has 2 columns",
            ),
            (
                "t,F,F\n0,1,2\n",
                ", line 1: the column \"F\" appears twice in the header; rename one of them, or map the channel to another column",
            ),
            (
                "t,F\n0,1\n1,x2\n",
                ", line 3, column \"F\": \"x2\" is not a number; leave the cell blank where there is no sample",
            ),
            (
                "t;F\n0;1,5\n",
                ", line 2, column \"F\": \"1,5\" is not a number (windfall reads a decimal point, not a decimal comma); leave the cell blank where there is no sample",
            ),
            (
                "t,F\n0,NaN\n",
                ", line 2, column \"F\": the value is NaN, which is not a finite number; leave the cell blank where there is no sample",
            ),
            (
                "t,F\n0,1\n1,-inf\n",
                ", line 3, column \"F\": the value is -inf, which is not a finite number; leave the cell blank where there is no sample",
            ),
            (
                "t,F\n0,1\n1\n",
                ", line 3: the row has 1 cells where the header has 2; the file may be cut short, or use another separator in this line (it is read with commas)",
            ),
        ] {
            assert_eq!(message(text, &["F"]), expected, "{text:?}");
        }
    }

    #[test]
    fn rejects_text_that_is_not_utf8() {
        let (_dir, path) = file(b"t,F\n0,1\n1,\xb5\n");
        let error = read_table(&path).unwrap_err().to_string();
        assert!(error.ends_with("line 3: the text is not UTF-8; save the file as UTF-8 (in a spreadsheet: \"CSV UTF-8\")"), "{error}");
    }

    #[test]
    fn rejects_a_misspelt_column_with_the_nearest_names() {
        let text = message("Time (s),Force (N),Position (m)\n0,1,2\n", &["force (n)"]);
        assert_eq!(
            text,
            ": there is no column \"force (n)\"; nearest in the header: \"Force (N)\" (3 columns in all)"
        );
    }
}
