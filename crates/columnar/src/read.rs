//! Tables read from files of columns, some rows at a time.

use crate::error::Error;
use crate::schema::Cell;
use arrow_array::cast::AsArray;
use arrow_array::temporal_conversions::{as_date, as_datetime};
use arrow_array::types::{
    ArrowPrimitiveType, ArrowTemporalType, Date32Type, Date64Type, Float16Type, Float32Type,
    Float64Type, Int8Type, Int16Type, Int32Type, Int64Type, TimestampMicrosecondType,
    TimestampMillisecondType, TimestampNanosecondType, TimestampSecondType, UInt8Type, UInt16Type,
    UInt32Type, UInt64Type,
};
use arrow_array::{Array, RecordBatch};
use arrow_ipc::reader::FileReader;
use arrow_schema::{ArrowError, DataType, Field, Metadata, TimeUnit};
use parquet::arrow::arrow_reader::{ParquetRecordBatchReader, ParquetRecordBatchReaderBuilder};
use std::fs::File;
use std::io::{BufReader, Read, Seek};
use std::panic::{AssertUnwindSafe, catch_unwind, set_hook, take_hook};
use std::path::Path;
use std::sync::{Mutex, PoisonError};

/// Rows that are read at once.
const BATCH: usize = 1 << 13;

/// First bytes of the files that are read.
pub(crate) const MAGICS: [&[u8]; 2] = [b"PAR1", b"ARROW1"];

/// Whether a file that begins like this is read here.
pub fn is_columnar(start: &[u8]) -> bool {
    MAGICS.iter().any(|own| start.starts_with(own))
}

enum Batches {
    Parquet(ParquetRecordBatchReader),
    Arrow(Box<FileReader<BufReader<File>>>),
}

impl Batches {
    fn next(&mut self) -> Option<Result<RecordBatch, ArrowError>> {
        match self {
            Self::Parquet(own) => own.next(),
            Self::Arrow(own) => own.next(),
        }
    }
}

/// An open file of columns.
pub struct ColumnReader {
    names: Vec<String>,
    notes: Metadata,
    batches: Batches,
}

/// Some rows of a table.
pub struct Block {
    batch: RecordBatch,
}

impl ColumnReader {
    /// Opens a file of columns: Parquet (not compressed, or by Snappy) or an Arrow file.
    ///
    /// # Errors
    /// It cannot be read or is damaged; a column is of a type that is no cell of a table.
    pub fn open(path: &Path) -> Result<Self, Error> {
        let mut file = File::open(path)?;
        let mut start = [0; 4];
        file.read_exact(&mut start)?;
        file.rewind()?;
        without_panic(|| {
            let (schema, batches) = match start == *MAGICS[0] {
                true => {
                    let builder = ParquetRecordBatchReaderBuilder::try_new(file)?;
                    let builder = builder.with_batch_size(BATCH);
                    (builder.schema().clone(), Batches::Parquet(builder.build()?))
                }
                false => {
                    let reader = FileReader::try_new(BufReader::new(file), None)?;
                    (reader.schema(), Batches::Arrow(Box::new(reader)))
                }
            };
            let fields = schema.fields();
            fields.iter().try_for_each(|field| check(field))?;
            let names = fields.iter().map(|own| own.name().clone()).collect();
            let notes = schema.metadata().clone();
            Ok(Self {
                names,
                notes,
                batches,
            })
        })
    }

    /// Names of its columns.
    pub fn names(&self) -> &[String] {
        &self.names
    }

    /// What the file says of itself under a name.
    pub fn note(&self, name: &str) -> Option<&str> {
        self.notes.get(name).map(String::as_str)
    }

    /// The next rows; `None` behind the last.
    ///
    /// # Errors
    /// The file cannot be read, or is damaged.
    pub fn next_block(&mut self) -> Result<Option<Block>, Error> {
        without_panic(|| match self.batches.next() {
            None => Ok(None),
            Some(batch) => Ok(Some(Block { batch: batch? })),
        })
    }
}

impl Block {
    /// Number of its rows.
    pub fn rows(&self) -> usize {
        self.batch.num_rows()
    }

    /// The cells of a row, in the order of the columns; dates and numbers below zero or of single
    /// precision as texts.
    ///
    /// # Errors
    /// The file is damaged.
    pub fn row(&self, row: usize) -> Result<Vec<Cell<'_>>, Error> {
        let columns = self.batch.columns().iter();
        columns.map(|own| cell(own.as_ref(), row)).collect()
    }
}

/// Runs the decoder, which panics on some damaged files: that it does is told as damage.
fn without_panic<T>(work: impl FnOnce() -> Result<T, Error>) -> Result<T, Error> {
    // The report of a panic would go to standard error, past whoever shows the error.
    static ONE: Mutex<()> = Mutex::new(());
    let held = ONE.lock().unwrap_or_else(PoisonError::into_inner);
    let hook = take_hook();
    set_hook(Box::new(|_| {}));
    let done = catch_unwind(AssertUnwindSafe(work));
    set_hook(hook);
    drop(held);
    done.unwrap_or_else(|_| Err(Error::Damaged("its parts do not fit together".to_owned())))
}

/// Refuses what is no cell of a table.
fn check(field: &Field) -> Result<(), Error> {
    use DataType::*;
    let inner = match field.data_type() {
        Dictionary(_, values) => values,
        own => own,
    };
    match inner {
        Null | Boolean | Utf8 | LargeUtf8 | Utf8View | Date32 | Date64 | Timestamp(..) => Ok(()),
        own if own.is_integer() || own.is_floating() => Ok(()),
        other => Err(Error::Kind {
            column: field.name().clone(),
            found: other.to_string(),
        }),
    }
}

fn cell(column: &dyn Array, row: usize) -> Result<Cell<'_>, Error> {
    use DataType::*;
    if column.is_null(row) {
        return Ok(Cell::Blank);
    }
    Ok(match column.data_type() {
        Boolean => Cell::Flag(column.as_boolean().value(row)),
        Utf8 => Cell::text(column.as_string::<i32>().value(row)),
        LargeUtf8 => Cell::text(column.as_string::<i64>().value(row)),
        Utf8View => Cell::text(column.as_string_view().value(row)),
        Dictionary(..) => {
            let found = column.as_any_dictionary();
            let key = integer(found.keys(), row).and_then(|own| usize::try_from(own).ok());
            let key = key.filter(|own| *own < found.values().len());
            let key = key.ok_or_else(|| Error::Damaged("a category that is none".to_owned()))?;
            return cell(found.values().as_ref(), key);
        }
        Float64 => Cell::Number(value::<Float64Type>(column, row)),
        Float32 => Cell::text(value::<Float32Type>(column, row).to_string()),
        Float16 => Cell::Number(value::<Float16Type>(column, row).into()),
        Date32 => date::<Date32Type>(i64::from(value::<Date32Type>(column, row)))?,
        Date64 => date::<Date64Type>(value::<Date64Type>(column, row))?,
        Timestamp(unit, _) => instant(column, row, *unit)?,
        other => match integer(column, row) {
            Some(own) => {
                u64::try_from(own).map_or_else(|_| Cell::text(own.to_string()), Cell::Count)
            }
            None => return Err(Error::Damaged(format!("a column of type {other}"))),
        },
    })
}

/// A whole number of any size.
fn integer(column: &dyn Array, row: usize) -> Option<i128> {
    use DataType::*;
    Some(match column.data_type() {
        Int8 => value::<Int8Type>(column, row).into(),
        Int16 => value::<Int16Type>(column, row).into(),
        Int32 => value::<Int32Type>(column, row).into(),
        Int64 => value::<Int64Type>(column, row).into(),
        UInt8 => value::<UInt8Type>(column, row).into(),
        UInt16 => value::<UInt16Type>(column, row).into(),
        UInt32 => value::<UInt32Type>(column, row).into(),
        UInt64 => value::<UInt64Type>(column, row).into(),
        _ => return None,
    })
}

fn value<T: ArrowPrimitiveType>(column: &dyn Array, row: usize) -> T::Native {
    column.as_primitive::<T>().value(row)
}

/// A day as ISO 8601 has it.
fn date<T: ArrowTemporalType>(value: i64) -> Result<Cell<'static>, Error> {
    let found =
        as_date::<T>(value).ok_or_else(|| Error::Damaged("a date that is none".to_owned()))?;
    Ok(Cell::text(found.to_string()))
}

/// An instant as ISO 8601 has it, in universal time where it has a time zone.
fn instant(column: &dyn Array, row: usize, unit: TimeUnit) -> Result<Cell<'_>, Error> {
    let found = match unit {
        TimeUnit::Second => of::<TimestampSecondType>(column, row),
        TimeUnit::Millisecond => of::<TimestampMillisecondType>(column, row),
        TimeUnit::Microsecond => of::<TimestampMicrosecondType>(column, row),
        TimeUnit::Nanosecond => of::<TimestampNanosecondType>(column, row),
    };
    found.ok_or_else(|| Error::Damaged("a time that is none".to_owned()))
}

fn of<T>(column: &dyn Array, row: usize) -> Option<Cell<'static>>
where
    T: ArrowTemporalType + ArrowPrimitiveType<Native = i64>,
{
    let found = as_datetime::<T>(value::<T>(column, row))?;
    Some(Cell::text(found.format("%Y-%m-%dT%H:%M:%S%.f").to_string()))
}
