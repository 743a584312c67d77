//! Tables written as files of columns, some rows at a time.

use crate::batch::Rows;
use crate::error::Error;
use crate::schema::{Cell, Schema};
use arrow_ipc::writer::FileWriter;
use parquet::arrow::ArrowWriter;
use parquet::basic::Compression;
use parquet::file::metadata::KeyValue;
use parquet::file::properties::WriterProperties;
use parquet::schema::types::ColumnPath;
use std::fs::File;
use std::io::{BufWriter, Write};

/// Rows that are gathered before they are written.
const BATCH: usize = 1 << 12;
/// Rows that readers take at once from a Parquet file.
const GROUP: usize = 1 << 18;

/// Form of a file of columns.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Container {
    /// Apache Parquet, compressed by Snappy.
    Parquet,
    /// An Arrow file (IPC), which programs map into memory as it is.
    Arrow,
}

enum Sink<'a> {
    Parquet(Box<ArrowWriter<&'a mut File>>),
    Arrow(Box<FileWriter<BufWriter<&'a mut File>>>),
}

/// A file of columns that is being written; its memory does not grow with its rows, but for the
/// compressed ones of a group of Parquet.
pub struct ColumnWriter<'a> {
    rows: Rows,
    sink: Sink<'a>,
}

impl<'a> ColumnWriter<'a> {
    /// Begins a file.
    ///
    /// # Errors
    /// It cannot be written.
    pub fn new(file: &'a mut File, container: Container, schema: &Schema) -> Result<Self, Error> {
        let rows = Rows::new(schema);
        let sink = match container {
            Container::Arrow => {
                let writer = FileWriter::try_new(BufWriter::new(file), rows.schema())?;
                Sink::Arrow(Box::new(writer))
            }
            Container::Parquet => {
                let (columns, properties) = (rows.schema().clone(), properties(&rows));
                let writer = ArrowWriter::try_new(file, columns, Some(properties))?;
                Sink::Parquet(Box::new(writer))
            }
        };
        Ok(Self { rows, sink })
    }

    /// Adds a row.
    ///
    /// # Errors
    /// The file cannot be written, or the row does not belong to the schema.
    pub fn push(&mut self, row: &[Cell]) -> Result<(), Error> {
        self.rows.push(row)?;
        match self.rows.count() == BATCH {
            true => self.flush(),
            false => Ok(()),
        }
    }

    fn flush(&mut self) -> Result<(), Error> {
        let batch = self.rows.take()?;
        match &mut self.sink {
            Sink::Parquet(own) => own.write(&batch)?,
            Sink::Arrow(own) => own.write(&batch)?,
        }
        Ok(())
    }

    /// Ends the file.
    ///
    /// # Errors
    /// It cannot be written.
    pub fn finish(mut self) -> Result<(), Error> {
        if self.rows.count() > 0 {
            self.flush()?;
        }
        match self.sink {
            Sink::Parquet(own) => {
                own.close()?;
            }
            Sink::Arrow(own) => own.into_inner()?.flush()?,
        }
        Ok(())
    }
}

fn properties(rows: &Rows) -> WriterProperties {
    // Programs that know Parquet alone read the notes of the table here.
    let notes = rows.schema().metadata().iter();
    let notes = notes.map(|(name, text)| KeyValue::new(name.clone(), text.clone()));
    // Measured numbers hardly repeat: a dictionary of them takes memory, and makes nothing smaller.
    let fields = rows.schema().fields().iter();
    let numbers = fields.filter(|field| field.data_type().is_floating());
    let paths = numbers.map(|field| ColumnPath::from(field.name().as_str()));
    let plan = paths.fold(WriterProperties::builder(), |plan, path| {
        plan.set_column_dictionary_enabled(path, false)
    });
    plan.set_compression(Compression::SNAPPY)
        .set_max_row_group_row_count(Some(GROUP))
        .set_created_by(format!("windfall {}", env!("CARGO_PKG_VERSION")))
        .set_key_value_metadata(Some(notes.collect()))
        .build()
}
