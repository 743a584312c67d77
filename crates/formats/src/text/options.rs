//! What is said and found out of a table in text.

use crate::contents::Note;
use crate::text::encoding::Encoding;
use crate::text::number::Marks;
use crate::text::rows::{ColumnKind, Separator};

/// What a user says of a text file; what is left out is found out.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TextOptions {
    /// What stands between cells.
    pub separator: Option<Separator>,
    /// Decimal mark: '.' or ','.
    pub decimal: Option<char>,
    /// Mark between groups of three digits.
    pub thousands: Option<char>,
    /// How characters are written.
    pub encoding: Option<Encoding>,
    /// Line with the names of the columns, counted from 1; 0: there is none.
    pub header_line: Option<u64>,
    /// Beginning of lines that are passed over.
    pub comment: Option<String>,
}

/// Columns and how they are written.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Dialect {
    /// What stands between cells.
    pub separator: Separator,
    /// Marks in numbers.
    pub marks: Marks,
    /// Beginnings of lines that are passed over.
    pub comments: Vec<String>,
    /// Names of the columns, as they stand there; blank where there is none.
    pub names: Vec<String>,
    /// Units from a row of units.
    pub units: Vec<Option<String>>,
    /// What each column holds.
    pub kinds: Vec<ColumnKind>,
    /// Position of the first row among the lines looked at.
    pub first_row: usize,
    /// Whether there are no names and the first column rises evenly, other than
    /// by one: it is then most likely the time.
    pub rising_first: bool,
    /// Lines above the header: name and value.
    pub preamble: Vec<(String, String)>,
    /// What a user must know.
    pub notes: Vec<Note>,
}
