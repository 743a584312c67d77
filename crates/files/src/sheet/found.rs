//! Tables that windfall made as CSV, with a schema that their cells show.

use crate::error::Error;
use crate::sheet::each_row::{damaged, reader};
use crate::sheet::{Cell, Column, Kind, Schema, cell_of, titled};
use crate::table::write::unguarded;
use crate::text::column_title::column_title;
use csv::StringRecord;
use std::path::Path;

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
            titled(&name, kind, &column_title(&name).0)
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
