//! Tables written as files of columns, some rows at a time.

use crate::batch::Rows;
use crate::container::Container;
use crate::error::unwritable;
use arrow_ipc::writer::FileWriter;
use parquet::arrow::ArrowWriter;
use parquet::basic::Compression;
use parquet::file::metadata::KeyValue;
use parquet::file::properties::WriterProperties;
use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};
use windfall_files::error::Error;
use windfall_files::provenance::VERSION;
use windfall_files::sheet::{Cell, Kind, Schema};
use windfall_files::table::write::{csv_header, csv_line, guarded};
use windfall_files::write_file::{write_streamed, write_whole};

/// Rows that are gathered before they are written.
const BATCH: usize = 1 << 14;
/// Rows that readers take at once from a Parquet file.
const GROUP: usize = 1 << 18;

enum Sink<'a> {
    Csv(BufWriter<&'a mut File>),
    Parquet(ArrowWriter<&'a mut File>),
    Arrow(FileWriter<BufWriter<&'a mut File>>),
}

/// A table that is being written; its memory does not grow with its rows, but for the
/// compressed ones of a group of Parquet.
pub struct TableWriter<'a> {
    path: PathBuf,
    kinds: Vec<Kind>,
    rows: Rows,
    sink: Sink<'a>,
}

impl<'a> TableWriter<'a> {
    fn new(
        path: &Path,
        file: &'a mut File,
        container: Container,
        schema: &Schema,
    ) -> Result<Self, Error> {
        let rows = Rows::new(schema);
        let sink = match container {
            Container::Csv => {
                let mut file = BufWriter::new(file);
                let written = file.write_all(csv_header(&schema.names())?.as_bytes());
                written.map_err(|error| unwritable(path, error))?;
                Sink::Csv(file)
            }
            Container::Arrow => {
                let writer = FileWriter::try_new(BufWriter::new(file), rows.schema());
                Sink::Arrow(writer.map_err(|error| unwritable(path, error))?)
            }
            Container::Parquet => {
                let properties = properties(&rows);
                let writer = ArrowWriter::try_new(file, rows.schema().clone(), Some(properties));
                Sink::Parquet(writer.map_err(|error| unwritable(path, error))?)
            }
        };
        Ok(Self {
            path: path.to_path_buf(),
            kinds: schema.columns.iter().map(|own| own.kind).collect(),
            rows,
            sink,
        })
    }

    /// Adds a row.
    ///
    /// # Errors
    /// The file cannot be written, or the row does not belong to the schema.
    pub fn push(&mut self, row: &[Cell]) -> Result<(), Error> {
        if let Sink::Csv(file) = &mut self.sink {
            let cells = row.iter().zip(&self.kinds);
            let cells = cells.map(|(cell, kind)| guarded(&cell.csv(*kind)).into());
            let cells: Vec<String> = cells.collect();
            let written = file.write_all(csv_line(&cells, b',')?.as_bytes());
            return written.map_err(|error| unwritable(&self.path, error));
        }
        let pushed = self.rows.push(row);
        pushed.map_err(|error| unwritable(&self.path, error))?;
        match self.rows.len() == BATCH {
            true => self.flush(),
            false => Ok(()),
        }
    }

    fn flush(&mut self) -> Result<(), Error> {
        let path = &self.path;
        let batch = self.rows.take().map_err(|error| unwritable(path, error))?;
        match &mut self.sink {
            Sink::Csv(_) => Ok(()),
            Sink::Parquet(own) => own.write(&batch).map_err(|error| unwritable(path, error)),
            Sink::Arrow(own) => own.write(&batch).map_err(|error| unwritable(path, error)),
        }
    }

    fn finish(mut self) -> Result<(), Error> {
        if !self.rows.is_empty() {
            self.flush()?;
        }
        let path = &self.path;
        match self.sink {
            Sink::Csv(mut own) => own.flush().map_err(|error| unwritable(path, error)),
            Sink::Parquet(own) => {
                let closed = own.close().map(|_| ());
                closed.map_err(|error| unwritable(path, error))
            }
            Sink::Arrow(mut own) => own.finish().map_err(|error| unwritable(path, error)),
        }
    }
}

fn properties(rows: &Rows) -> WriterProperties {
    // Programs that know Parquet alone read the notes of the table here.
    let mut notes: Vec<KeyValue> = rows
        .schema()
        .metadata()
        .iter()
        .map(|(name, text)| KeyValue::new(name.clone(), text.clone()))
        .collect();
    notes.sort_by(|a, b| a.key.cmp(&b.key));
    WriterProperties::builder()
        .set_compression(Compression::SNAPPY)
        .set_max_row_group_row_count(Some(GROUP))
        .set_created_by(format!("windfall {VERSION}"))
        .set_key_value_metadata(Some(notes))
        .build()
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
    container: Container,
    schema: &Schema,
    fill: impl FnOnce(&mut TableWriter) -> Result<(), Error>,
) -> Result<(), Error> {
    write_streamed(path, |file| {
        let mut writer = TableWriter::new(path, file, container, schema)?;
        fill(&mut writer)?;
        writer.finish()
    })
}

/// Writes rows in the form that is asked for.
///
/// # Errors
/// Those of [`write_table`].
pub fn write_rows<'a, R>(
    path: &Path,
    container: Container,
    schema: &Schema,
    rows: R,
) -> Result<(), Error>
where
    R: Iterator<Item = Vec<Cell<'a>>> + Clone,
{
    match container {
        Container::Csv => write_whole(path, schema.csv(rows)?.as_bytes()),
        _ => write_table(path, container, schema, |table| {
            rows.into_iter().try_for_each(|row| table.push(&row))
        }),
    }
}
