//! CSV that windfall wrote, as rows of a schema.

use csv::{Reader, ReaderBuilder, StringRecord};
use std::fs::File;
use std::io::Read;
use std::path::Path;
use windfall_files::error::{Error, Place};
use windfall_files::inputs::{check_regular, protect};
use windfall_files::sheet::{Cell, Column, Kind, Schema};
use windfall_files::table::write::unguarded;
use windfall_files::text::column_title::column_title;

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

fn reader<R: Read>(source: R) -> Reader<R> {
    let mut builder = ReaderBuilder::new();
    builder.comment(Some(b'#')).from_reader(source)
}

fn damaged(path: &Path, error: &csv::Error) -> Error {
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

/// A cell of a kind, where the text is one.
fn cell_of(kind: Kind, text: &str) -> Option<Cell<'_>> {
    if text.is_empty() {
        return Some(Cell::Blank);
    }
    match kind {
        Kind::Number | Kind::Single => text
            .parse()
            .ok()
            .filter(|own: &f64| own.is_finite())
            .map(Cell::Number),
        Kind::Count => text.parse().ok().map(Cell::Count),
        Kind::Flag => text.parse().ok().map(Cell::Flag),
        Kind::Text => Some(Cell::Text(text.into())),
    }
}

/// A table in memory, of kinds that its cells show.
pub struct FoundTable {
    /// What its columns are: numbers where all cells are finite numbers or blank, yes or no
    /// where all are `true` or `false`, else texts. Units are those in the columns' names.
    pub schema: Schema,
    records: Vec<StringRecord>,
}

impl FoundTable {
    /// Reads CSV that windfall made.
    ///
    /// * `table`: what a row is
    ///
    /// # Errors
    /// The text is no table.
    pub fn read(table: &'static str, text: &str) -> Result<Self, Error> {
        let whole = Path::new("the table in memory");
        let mut reader = reader(text.as_bytes());
        let header = reader.headers().map_err(|error| damaged(whole, &error))?;
        let names: Vec<String> = header.iter().map(|own| unguarded(own).to_owned()).collect();
        let records: Result<Vec<StringRecord>, csv::Error> = reader.into_records().collect();
        let records = records.map_err(|error| damaged(whole, &error))?;
        let column = |(place, name): (usize, String)| {
            let cells = || records.iter().filter_map(|own| own.get(place));
            let all = |kind| cells().all(|own| cell_of(kind, unguarded(own)).is_some());
            let blank = cells().all(str::is_empty);
            let kind = match () {
                () if blank => Kind::Text,
                () if all(Kind::Number) => Kind::Number,
                () if all(Kind::Flag) => Kind::Flag,
                () => Kind::Text,
            };
            Column::titled(&name, kind, &column_title(&name).0)
        };
        let columns = names.into_iter().enumerate().map(column).collect();
        let schema = Schema {
            table,
            version: 1,
            columns,
            notes: Vec::new(),
        };
        Ok(Self { schema, records })
    }

    /// Its rows.
    pub fn rows(&self) -> impl Iterator<Item = Vec<Cell<'_>>> + Clone {
        self.records.iter().map(|record| {
            let cells = self.schema.columns.iter().zip(record);
            let cell = |(column, text): (&Column, _)| cell_of(column.kind, unguarded(text));
            // Kinds were found from these cells.
            cells.map(|own| cell(own).unwrap_or(Cell::Blank)).collect()
        })
    }
}
