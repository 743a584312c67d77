//! Rows of CSV that windfall wrote, as cells of a schema.

use crate::error::{Error, Place};
use crate::inputs::{check_regular, protect};
use crate::sheet::{Cell, Schema, cell_of};
use crate::table::write::unguarded;
use csv::{Reader, ReaderBuilder, StringRecord};
use std::fs::File;
use std::io::Read;
use std::path::Path;

/// Goes through the rows of a table that windfall wrote; it is never in memory as a whole.
///
/// * `push`: takes each row
///
/// # Errors
/// The table cannot be read, has other columns, or a cell that is not of its column's kind;
/// and those of `push`.
pub fn each_row(
    path: &Path,
    schema: &Schema,
    mut push: impl FnMut(&[Cell]) -> Result<(), Error>,
) -> Result<(), Error> {
    check_regular(path)?;
    protect(path);
    let file = File::open(path).map_err(|source| Error::access(path, "read", source))?;
    let mut reader = reader(file);
    let header = reader.headers().map_err(|error| damaged(path, &error))?;
    if !header.iter().eq(schema.names()) {
        let problem = "the columns are not those of this version of windfall: make the table again";
        return Err(refused(path, 1, problem));
    }
    let mut record = StringRecord::new();
    while reader
        .read_record(&mut record)
        .map_err(|error| damaged(path, &error))?
    {
        let cells = schema.columns.iter().zip(&record);
        let row = cells.map(|(column, cell)| {
            cell_of(column.kind, unguarded(cell)).ok_or_else(|| {
                let line = record.position().map_or(0, csv::Position::line);
                let problem = format!(
                    "{cell:?} in the column {} is {}",
                    column.name,
                    column.kind.misfit()
                );
                refused(path, line, &problem)
            })
        });
        push(&row.collect::<Result<Vec<Cell>, Error>>()?)?;
    }
    Ok(())
}

pub(crate) fn reader<R: Read>(source: R) -> Reader<R> {
    let mut builder = ReaderBuilder::new();
    builder.comment(Some(b'#')).from_reader(source)
}

pub(crate) fn damaged(path: &Path, error: &csv::Error) -> Error {
    let line = error.position().map_or(0, csv::Position::line);
    refused(path, line, &error.to_string())
}

fn refused(path: &Path, line: u64, problem: &str) -> Error {
    let line = usize::try_from(line).unwrap_or(usize::MAX);
    Error::Refused {
        place: Place::at(path, line),
        problem: problem.to_owned(),
    }
}
