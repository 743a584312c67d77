//! Tables with a schema, as CSV and as files of columns.

pub mod each_row;
pub mod form;
pub mod found;
pub mod write;

use crate::text::column_title::column_title;
pub use windfall_columnar::schema::{Cell, Column, Kind, Schema};
pub use windfall_columnar::stream::arrow_stream_of;

/// A column whose unit stands in its name: `peak_force_N`.
pub fn titled(name: &str, kind: Kind, meaning: &str) -> Column {
    Column::new(name, kind, meaning).in_unit(column_title(name).1)
}

/// A cell of a kind, where the text is one.
fn cell_of(kind: Kind, text: &str) -> Option<Cell<'_>> {
    if text.is_empty() {
        return Some(Cell::Blank);
    }
    match kind {
        Kind::Number | Kind::Single => {
            let found = text.parse().ok().filter(|own: &f64| own.is_finite());
            found.map(Cell::Number)
        }
        Kind::Count => text.parse().ok().map(Cell::Count),
        Kind::Flag => text.parse().ok().map(Cell::Flag),
        Kind::Text => Some(Cell::Text(text.into())),
    }
}
