//! Tables with a schema: what each column is called, holds and means, for CSV and for the
//! column files of other programs alike.

use crate::error::Error;
use crate::table::write::{csv_text, number_cell};
use crate::text::column_title::column_title;
use std::borrow::Cow;

/// What the cells of a column are. A cell of every kind may be blank.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Numbers.
    Number,
    /// Numbers of single precision.
    Single,
    /// Whole numbers from 0.
    Count,
    /// Yes or no.
    Flag,
    /// Texts.
    Text,
}

impl Kind {
    /// What a cell that is not of this kind is.
    pub fn misfit(self) -> &'static str {
        match self {
            Self::Number | Self::Single => "no finite number",
            Self::Count => "no whole number",
            Self::Flag => "neither true nor false",
            Self::Text => "no text",
        }
    }
}

/// A cell.
#[derive(Clone, Debug, PartialEq)]
pub enum Cell<'a> {
    /// No value.
    Blank,
    /// A number.
    Number(f64),
    /// A whole number.
    Count(u64),
    /// Yes or no.
    Flag(bool),
    /// A text.
    Text(Cow<'a, str>),
}

impl<'a> Cell<'a> {
    /// A text, or a blank cell where it is empty.
    pub fn text(text: impl Into<Cow<'a, str>>) -> Self {
        match text.into() {
            text if text.is_empty() => Self::Blank,
            text => Self::Text(text),
        }
    }

    /// A number, where there is one.
    pub fn number(value: Option<f64>) -> Self {
        value.map_or(Self::Blank, Self::Number)
    }

    /// The cell as it stands in CSV, with all digits that a column of this kind has.
    pub fn csv(&self, kind: Kind) -> String {
        match self {
            Self::Blank => String::new(),
            Self::Number(value) if kind == Kind::Single => (*value as f32).to_string(),
            Self::Number(value) => number_cell(Some(*value)),
            Self::Count(count) => count.to_string(),
            Self::Flag(flag) => flag.to_string(),
            Self::Text(text) => text.to_string(),
        }
    }
}

/// A column.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Column {
    /// Its name, with the unit: `peak_force_N`.
    pub name: String,
    /// Unit of its numbers; "" where they have none.
    pub unit: String,
    /// What it holds, for people.
    pub meaning: String,
    /// What its cells are.
    pub kind: Kind,
    /// Whether CSV goes without it where all of its cells are blank.
    pub seldom: bool,
}

impl Column {
    /// A column whose unit stands in its name: `peak_force_N`.
    pub fn titled(name: &str, kind: Kind, meaning: &str) -> Self {
        Self::new(name, kind, meaning).in_unit(column_title(name).1)
    }

    /// A column that is always there.
    pub fn new(name: impl Into<String>, kind: Kind, meaning: impl Into<String>) -> Self {
        Self {
            name: name.into(),
            unit: String::new(),
            meaning: meaning.into(),
            kind,
            seldom: false,
        }
    }

    /// The same with a unit.
    #[must_use]
    pub fn in_unit(mut self, unit: impl Into<String>) -> Self {
        self.unit = unit.into();
        self
    }

    /// The same as one that CSV may go without.
    #[must_use]
    pub fn seldom(mut self) -> Self {
        self.seldom = true;
        self
    }
}

/// What a table is, whatever stands in it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Schema {
    /// What a row is: "fit".
    pub table: &'static str,
    /// Raised when a column goes or changes its meaning; columns may be added without.
    pub version: u32,
    /// Its columns.
    pub columns: Vec<Column>,
    /// What is said of the whole table, as names and texts.
    pub notes: Vec<(String, String)>,
}

impl Schema {
    /// Names of its columns.
    pub fn names(&self) -> Vec<&str> {
        self.columns.iter().map(|own| own.name.as_str()).collect()
    }

    /// Rows as CSV.
    ///
    /// * `rows`: cells in the order of the columns; all rows are looked at twice
    ///
    /// # Errors
    /// A row has not as many cells as there are columns.
    pub fn csv<'a, R>(&self, rows: R) -> Result<String, Error>
    where
        R: Iterator<Item = Vec<Cell<'a>>> + Clone,
    {
        let mut shown: Vec<bool> = self.columns.iter().map(|own| !own.seldom).collect();
        let kinds: Vec<Kind> = self.columns.iter().map(|own| own.kind).collect();
        for row in rows.clone() {
            for (shown, cell) in shown.iter_mut().zip(&row) {
                *shown |= *cell != Cell::Blank;
            }
        }
        let columns = self.columns.iter().zip(&shown);
        let names = columns.filter(|(_, shown)| **shown);
        let header: Vec<&str> = names.map(|(own, _)| own.name.as_str()).collect();
        let lines = rows.map(|row| {
            let cells = row.iter().zip(&kinds).zip(&shown);
            let cells = cells.filter(|(_, shown)| **shown);
            cells.map(|((cell, kind), _)| cell.csv(*kind)).collect()
        });
        csv_text(&header, lines)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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
        let text = schema.csv([row(None), row(Some(0.1))].into_iter()).unwrap();
        assert_eq!(
            text,
            "id,delay_s,samples,converged\n'=a,,3,true\n'=a,0.1,3,true\n"
        );
    }
}
