//! Files of columns as the text of a table, so that they are read like any other.

use crate::inputs::protect;
use crate::table::write::{csv_header, csv_line, guarded};
use std::fs::File;
use std::io::{Error as IoError, Read, Result as IoResult};
use std::path::{Path, PathBuf};
use windfall_columnar::error::Error as ColumnarError;
use windfall_columnar::read::{ColumnReader, is_columnar};
use windfall_columnar::schema::Kind;

/// Endings of the files that belong to a table which is a folder.
const ENDINGS: [&str; 3] = ["parquet", "arrow", "feather"];

/// The files of columns of which a table consists: itself, or all that lie in a folder, in the
/// order of their names; none where it is a table of text.
///
/// # Errors
/// The file or the folder cannot be read.
pub fn column_files(path: &Path) -> IoResult<Vec<PathBuf>> {
    if !path.is_dir() {
        let mut start = [0; 6];
        let read = File::open(path)?.read(&mut start)?;
        let columnar = is_columnar(&start[..read]);
        return Ok(Vec::from_iter(columnar.then(|| path.to_path_buf())));
    }
    let mut files = Vec::new();
    for entry in std::fs::read_dir(path)? {
        let file = entry?.path();
        let ending = file.extension().and_then(|own| own.to_str()).unwrap_or("");
        if ENDINGS.contains(&ending) {
            protect(&file);
            files.push(file);
        }
    }
    files.sort();
    match files.is_empty() {
        true => Err(IoError::other(
            "it is a folder, and no file in it ends with .parquet or .arrow",
        )),
        false => Ok(files),
    }
}

/// What files that windfall wrote have in common, if they are parts of one table.
type Marks = [Option<String>; 3];

fn marks(open: &ColumnReader) -> Marks {
    ["table", "schema", "options"].map(|name| open.note(name).map(str::to_owned))
}

/// The text of a table of columns, made as it is read.
pub struct ColumnsText {
    /// Files behind the open one, the next last.
    rest: Vec<PathBuf>,
    /// The open file, where it is one of several.
    one: Option<PathBuf>,
    names: Vec<String>,
    marks: Marks,
    open: ColumnReader,
    text: Vec<u8>,
    at: usize,
}

impl ColumnsText {
    /// Opens a table; `None` where there is no file.
    ///
    /// # Errors
    /// The first file cannot be read, is damaged, or has a column that is not read.
    pub fn open(mut files: Vec<PathBuf>) -> IoResult<Option<Self>> {
        let several = files.len() > 1;
        files.reverse();
        let Some(first) = files.pop() else {
            return Ok(None);
        };
        let one = several.then(|| first.clone());
        let open = ColumnReader::open(&first).map_err(|error| failed(one.as_deref(), error))?;
        let names = open.names().to_vec();
        let text = csv_header(&names).map_err(IoError::other)?.into_bytes();
        Ok(Some(Self {
            rest: files,
            one,
            names,
            marks: marks(&open),
            open,
            text,
            at: 0,
        }))
    }

    /// Makes the text of more rows; whether there are any.
    fn more(&mut self) -> IoResult<bool> {
        loop {
            let one = self.one.as_deref();
            let told = |error| failed(one, error);
            if let Some(block) = self.open.next_block().map_err(told)? {
                self.text.clear();
                self.at = 0;
                for row in 0..block.rows() {
                    let cells = block.row(row).map_err(told)?;
                    let cells = cells
                        .iter()
                        .map(|own| guarded(&own.csv(Kind::Number)).into());
                    let line = csv_line(&cells.collect::<Vec<String>>(), b',');
                    self.text.extend(line.map_err(IoError::other)?.into_bytes());
                }
                return Ok(true);
            }
            let Some(next) = self.rest.pop() else {
                return Ok(false);
            };
            self.open = ColumnReader::open(&next).map_err(|error| failed(Some(&next), error))?;
            let what = match () {
                () if self.open.names() != self.names => "has other columns than",
                () if marks(&self.open) != self.marks => "was made with other options than",
                () => "",
            };
            if !what.is_empty() {
                let told = format!(
                    "{} {what} the files before it: make it again as the others, or move it elsewhere",
                    next.display()
                );
                return Err(IoError::other(told));
            }
            self.one = Some(next);
        }
    }
}

impl Read for ColumnsText {
    fn read(&mut self, buffer: &mut [u8]) -> IoResult<usize> {
        while self.at == self.text.len() {
            if !self.more()? {
                return Ok(0);
            }
        }
        let size = buffer.len().min(self.text.len() - self.at);
        buffer[..size].copy_from_slice(&self.text[self.at..self.at + size]);
        self.at += size;
        Ok(size)
    }
}

/// * `one`: the file that it is about, where that is not known
fn failed(one: Option<&Path>, error: ColumnarError) -> IoError {
    match (error, one) {
        (ColumnarError::Io(source), None) => source,
        (other, None) => IoError::other(other),
        (other, Some(file)) => IoError::other(format!("{}: {other}", file.display())),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sheet::form::Form;
    use crate::sheet::write::write_rows;
    use crate::sheet::{Cell, Column, Schema};
    use crate::table::csv::read_table;

    const NAMES: [&str; 5] = ["id", "k", "cost", "samples", "converged"];

    fn schema(names: &[&str]) -> Schema {
        let kinds = [
            Kind::Text,
            Kind::Number,
            Kind::Single,
            Kind::Count,
            Kind::Flag,
        ];
        let columns = names.iter().zip(kinds);
        Schema {
            table: "test",
            version: 1,
            columns: columns
                .map(|(name, kind)| Column::new(*name, kind, ""))
                .collect(),
            notes: Vec::new(),
        }
    }

    fn rows(from: u64) -> Vec<Vec<Cell<'static>>> {
        let row = |number: u64| {
            let value = 1.0 / number as f64 - 0.3;
            vec![
                Cell::text(format!("=fruit, \"{number}\"")),
                Cell::Number(value),
                Cell::number((!number.is_multiple_of(7)).then_some(f64::from(value as f32))),
                Cell::Count(number),
                Cell::Flag(number.is_multiple_of(2)),
            ]
        };
        (from..from + 20_000).map(row).collect()
    }

    #[test]
    fn repeats_what_was_written_in_every_form() {
        let folder = tempfile::tempdir().unwrap();
        let write = |name: &str| {
            let path = folder.path().join(name);
            let form = Form::of_path("--out", &path).unwrap();
            write_rows(&path, form, &schema(&NAMES), rows(1).into_iter()).unwrap();
            read_table(&path).unwrap()
        };
        let csv = write("table.csv");
        assert_eq!(csv.columns, NAMES);
        assert_eq!(csv.rows[2].cells[1], (1.0 / 3.0 - 0.3_f64).to_string());
        for name in ["table.parquet", "table.arrow", "table.feather"] {
            let own = write(name);
            assert!(own.columns == csv.columns && own.rows == csv.rows, "{name}");
        }
    }

    #[test]
    fn a_folder_is_one_table() {
        let folder = tempfile::tempdir().unwrap();
        let error = read_table(folder.path()).unwrap_err().to_string();
        assert!(
            error.contains("no file in it ends with .parquet"),
            "{error}"
        );
        let part = |name: &str, from, names: &[&str]| {
            let path = folder.path().join(name);
            let form = Form::of_path("--out", &path).unwrap();
            write_rows(&path, form, &schema(names), rows(from).into_iter()).unwrap();
        };
        part("2.parquet", 20_001, &NAMES);
        part("1.arrow", 1, &NAMES);
        part("notes.csv", 1, &NAMES[..1]);
        let read = read_table(folder.path()).unwrap();
        assert_eq!(read.rows.len(), 40_000);
        assert!(
            read.rows
                .iter()
                .zip(1..)
                .all(|(row, n)| row.cells[3] == n.to_string())
        );

        part(
            "3.parquet",
            1,
            &["id", "k", "price", "samples", "converged"],
        );
        let error = read_table(folder.path()).unwrap_err().to_string();
        assert!(error.contains("3.parquet has other columns"), "{error}");
        std::fs::write(folder.path().join("0.parquet"), "PAR1 and no more").unwrap();
        let error = read_table(folder.path()).unwrap_err().to_string();
        assert!(error.contains("0.parquet: the file is damaged"), "{error}");
    }

    /// A single wrong byte is an error or another value, and no panic gets out.
    #[test]
    fn rejects_damage() {
        let folder = tempfile::tempdir().unwrap();
        for name in ["table.parquet", "table.arrow"] {
            let path = folder.path().join(name);
            let form = Form::of_path("--out", &path).unwrap();
            write_rows(&path, form, &schema(&NAMES), rows(1).into_iter().take(20)).unwrap();
            let bytes = std::fs::read(&path).unwrap();
            let mut refused = 0;
            for at in (0..bytes.len()).step_by(3) {
                let mut own = bytes.clone();
                own[at] ^= 0xff;
                std::fs::write(&path, &own).unwrap();
                refused += usize::from(read_table(&path).is_err());
                std::fs::write(&path, &bytes[..at]).unwrap();
                let whole = at >= 6 && read_table(&path).is_ok();
                assert!(!whole, "{name} of {at} bytes");
            }
            assert!(
                refused > bytes.len() / 30,
                "{name}: {refused} of {}",
                bytes.len()
            );
        }
    }
}
