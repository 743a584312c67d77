//! Tables with a schema written into files.

use crate::error::Error;
use crate::sheet::form::Form;
use crate::sheet::{Cell, Kind, Schema};
use crate::table::write::{csv_header, csv_line, csv_text, guarded};
use crate::write_file::{write_streamed, write_whole};
use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};
use windfall_columnar::error::Error as ColumnarError;
use windfall_columnar::write::ColumnWriter;

enum Sink<'a> {
    Csv(BufWriter<&'a mut File>, Vec<Kind>),
    Columns(ColumnWriter<'a>),
}

/// A table that is being written; its memory does not grow with its rows.
pub struct TableWriter<'a> {
    path: PathBuf,
    sink: Sink<'a>,
}

impl<'a> TableWriter<'a> {
    fn new(path: &Path, file: &'a mut File, form: Form, schema: &Schema) -> Result<Self, Error> {
        let sink = match form {
            Form::Csv => {
                let mut file = BufWriter::new(file);
                let written = file.write_all(csv_header(&schema.names())?.as_bytes());
                written.map_err(|error| unwritable(path, error.into()))?;
                let kinds = schema.columns.iter().map(|own| own.kind);
                Sink::Csv(file, kinds.collect())
            }
            Form::Columns(container) => {
                let writer = ColumnWriter::new(file, container, schema);
                Sink::Columns(writer.map_err(|error| unwritable(path, error))?)
            }
        };
        let path = path.to_path_buf();
        Ok(Self { path, sink })
    }

    /// Adds a row.
    ///
    /// # Errors
    /// The file cannot be written, or the row does not belong to the schema.
    pub fn push(&mut self, row: &[Cell]) -> Result<(), Error> {
        let pushed = match &mut self.sink {
            Sink::Columns(own) => own.push(row),
            Sink::Csv(file, kinds) => {
                let cells = row.iter().zip(&*kinds);
                let cells = cells.map(|(cell, kind)| guarded(&cell.csv(*kind)).into());
                let line = csv_line(&cells.collect::<Vec<String>>(), b',')?;
                file.write_all(line.as_bytes()).map_err(Into::into)
            }
        };
        pushed.map_err(|error| unwritable(&self.path, error))
    }

    fn finish(self) -> Result<(), Error> {
        let finished = match self.sink {
            Sink::Columns(own) => own.finish(),
            Sink::Csv(mut file, _) => file.flush().map_err(Into::into),
        };
        finished.map_err(|error| unwritable(&self.path, error))
    }
}

fn unwritable(path: &Path, error: ColumnarError) -> Error {
    let source = match error {
        ColumnarError::Io(source) => source,
        other => std::io::Error::other(other),
    };
    Error::access(path, "write", source)
}

/// Writes a table; it is there whole or not at all.
///
/// * `fill`: adds its rows
///
/// # Errors
/// It would replace an input, or a file that windfall did not write; the file cannot be written;
/// and those of `fill`.
pub fn write_table(
    path: &Path,
    form: Form,
    schema: &Schema,
    fill: impl FnOnce(&mut TableWriter) -> Result<(), Error>,
) -> Result<(), Error> {
    write_streamed(path, |file| {
        let mut writer = TableWriter::new(path, file, form, schema)?;
        fill(&mut writer)?;
        writer.finish()
    })
}

/// Writes rows in the form that is asked for; CSV as [`csv_of_table`] has it.
///
/// # Errors
/// Those of [`write_table`].
pub fn write_rows<'a, R>(path: &Path, form: Form, schema: &Schema, rows: R) -> Result<(), Error>
where
    R: Iterator<Item = Vec<Cell<'a>>> + Clone,
{
    match form {
        Form::Csv => write_whole(path, csv_of_table(schema, rows)?.as_bytes()),
        Form::Columns(_) => write_table(path, form, schema, |table| {
            rows.into_iter().try_for_each(|row| table.push(&row))
        }),
    }
}

/// Rows as CSV, without columns that are seldom and here blank.
///
/// * `rows`: cells in the order of the columns; all rows are looked at twice
///
/// # Errors
/// A row has not as many cells as there are columns.
pub fn csv_of_table<'a, R>(schema: &Schema, rows: R) -> Result<String, Error>
where
    R: Iterator<Item = Vec<Cell<'a>>> + Clone,
{
    let columns = &schema.columns;
    let mut shown: Vec<bool> = columns.iter().map(|own| !own.seldom).collect();
    for row in rows.clone() {
        for (shown, cell) in shown.iter_mut().zip(&row) {
            *shown |= *cell != Cell::Blank;
        }
    }
    let header = columns.iter().zip(&shown).filter(|(_, shown)| **shown);
    let header: Vec<&str> = header.map(|(own, _)| own.name.as_str()).collect();
    let lines = rows.map(|row| {
        let cells = row.iter().zip(columns).zip(&shown);
        let cells = cells.filter(|(_, shown)| **shown);
        cells.map(|((cell, own), _)| cell.csv(own.kind)).collect()
    });
    csv_text(&header, lines)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sheet::Column;

    #[test]
    fn closed_form_csv_goes_without_what_is_seldom_and_blank() {
        let column = |name: &str, kind| Column::new(name, kind, "");
        let schema = Schema {
            table: "test",
            version: 1,
            columns: vec![
                column("id", Kind::Text),
                column("gain", Kind::Number).seldom(),
                column("delay_s", Kind::Number).in_unit("s").seldom(),
                column("samples", Kind::Count),
                column("converged", Kind::Flag),
            ],
            notes: Vec::new(),
        };
        let row = |delay| {
            vec![
                Cell::text("=a"),
                Cell::Blank,
                Cell::number(delay),
                Cell::Count(3),
                Cell::Flag(true),
            ]
        };
        let rows = [row(None), row(Some(0.1))];
        let text = csv_of_table(&schema, rows.into_iter()).unwrap();
        assert_eq!(
            text,
            "id,delay_s,samples,converged\n'=a,,3,true\n'=a,0.1,3,true\n"
        );
    }
}
