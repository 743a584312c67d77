//! What a table is: what each of its columns is called, holds and means.

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
            Self::Number(value) => value.to_string(),
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
}
