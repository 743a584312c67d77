//! Rows of cells as columns in memory.

use crate::error::Error;
use crate::schema::{Cell, Column, Kind, Schema};
use arrow_array::builder::{
    BooleanBuilder, Float32Builder, Float64Builder, Int64Builder, StringBuilder,
};
use arrow_array::{ArrayRef, RecordBatch};
use arrow_schema::{DataType, Field, Schema as ArrowSchema, SchemaRef};
use std::collections::BTreeMap;
use std::sync::Arc;

/// The schema as Arrow has it: with the unit and the meaning of each column, and with the name
/// and version of the table, as metadata.
pub(crate) fn arrow_schema(schema: &Schema) -> SchemaRef {
    let fields: Vec<Field> = schema.columns.iter().map(field).collect();
    let own = [
        ("windfall", env!("CARGO_PKG_VERSION").to_owned()),
        ("table", schema.table.to_owned()),
        ("schema", schema.version.to_string()),
    ];
    let own = own.map(|(name, text)| (name.to_owned(), text));
    let notes = own.into_iter().chain(schema.notes.iter().cloned());
    Arc::new(ArrowSchema::new_with_metadata(
        fields,
        notes.collect::<BTreeMap<_, _>>(),
    ))
}

fn field(column: &Column) -> Field {
    let kind = match column.kind {
        Kind::Number => DataType::Float64,
        Kind::Single => DataType::Float32,
        Kind::Count => DataType::Int64,
        Kind::Flag => DataType::Boolean,
        Kind::Text => DataType::Utf8,
    };
    let said = [("unit", &column.unit), ("meaning", &column.meaning)];
    let said = said.into_iter().filter(|(_, text)| !text.is_empty());
    let said = said.map(|(name, text)| (name.to_owned(), text.clone()));
    Field::new(&column.name, kind, true).with_metadata(said.collect::<BTreeMap<_, _>>())
}

/// The cells of a column so far.
enum Cells {
    Number(Float64Builder),
    Single(Float32Builder),
    Count(Int64Builder),
    Flag(BooleanBuilder),
    Text(StringBuilder),
}

impl Cells {
    fn new(kind: Kind) -> Self {
        match kind {
            Kind::Number => Self::Number(Float64Builder::new()),
            Kind::Single => Self::Single(Float32Builder::new()),
            Kind::Count => Self::Count(Int64Builder::new()),
            Kind::Flag => Self::Flag(BooleanBuilder::new()),
            Kind::Text => Self::Text(StringBuilder::new()),
        }
    }

    /// Adds a cell; whether it is of the column's kind.
    fn push(&mut self, cell: &Cell) -> bool {
        match (self, cell) {
            (Self::Number(own), Cell::Number(value)) => own.append_value(*value),
            (Self::Number(own), Cell::Blank) => own.append_null(),
            (Self::Single(own), Cell::Number(value)) => own.append_value(*value as f32),
            (Self::Single(own), Cell::Blank) => own.append_null(),
            (Self::Count(own), Cell::Count(count)) => match i64::try_from(*count) {
                Ok(count) => own.append_value(count),
                Err(_) => return false,
            },
            (Self::Count(own), Cell::Blank) => own.append_null(),
            (Self::Flag(own), Cell::Flag(flag)) => own.append_value(*flag),
            (Self::Flag(own), Cell::Blank) => own.append_null(),
            (Self::Text(own), Cell::Text(text)) => own.append_value(text),
            (Self::Text(own), Cell::Blank) => own.append_null(),
            _ => return false,
        }
        true
    }

    fn finish(&mut self) -> ArrayRef {
        match self {
            Self::Number(own) => Arc::new(own.finish()),
            Self::Single(own) => Arc::new(own.finish()),
            Self::Count(own) => Arc::new(own.finish()),
            Self::Flag(own) => Arc::new(own.finish()),
            Self::Text(own) => Arc::new(own.finish()),
        }
    }
}

/// Rows that become a batch of columns.
pub(crate) struct Rows {
    schema: SchemaRef,
    columns: Vec<Cells>,
    rows: usize,
}

impl Rows {
    /// No rows yet.
    pub(crate) fn new(schema: &Schema) -> Self {
        Self {
            schema: arrow_schema(schema),
            columns: schema.columns.iter().map(|c| Cells::new(c.kind)).collect(),
            rows: 0,
        }
    }

    /// The schema as Arrow has it.
    pub(crate) fn schema(&self) -> &SchemaRef {
        &self.schema
    }

    /// Rows so far.
    pub(crate) fn count(&self) -> usize {
        self.rows
    }

    /// Adds a row.
    ///
    /// # Errors
    /// It has not as many cells as there are columns, or a cell of another kind.
    pub(crate) fn push(&mut self, row: &[Cell]) -> Result<(), Error> {
        let odd = |told| Err(Error::Row(told));
        if row.len() != self.columns.len() {
            let (cells, columns) = (row.len(), self.columns.len());
            return odd(format!("{cells} cells in {columns} columns"));
        }
        for (place, (column, cell)) in self.columns.iter_mut().zip(row).enumerate() {
            if !column.push(cell) {
                let name = self.schema.field(place).name();
                return odd(format!("{cell:?} in the column {name}"));
            }
        }
        self.rows += 1;
        Ok(())
    }

    /// The rows so far as columns; none are left.
    ///
    /// # Errors
    /// None in practice: columns are equally long.
    pub(crate) fn take(&mut self) -> Result<RecordBatch, Error> {
        self.rows = 0;
        let columns = self.columns.iter_mut().map(Cells::finish).collect();
        Ok(RecordBatch::try_new(self.schema.clone(), columns)?)
    }
}
