//! Settings and detected dialect of a text table.

use crate::contents::Note;
use crate::text::encoding::Encoding;
use crate::text::number::Marks;
use crate::text::rows::{ColumnKind, Separator};

/// User settings for a text file; whatever is not set is detected.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TextOptions {
    /// Separator between cells.
    pub separator: Option<Separator>,
    /// Decimal mark: '.' or ','.
    pub decimal: Option<char>,
    /// Thousands separator.
    pub thousands: Option<char>,
    /// Encoding of characters.
    pub encoding: Option<Encoding>,
    /// Line with the column names, counted from 1; 0 if there is none.
    pub header_line: Option<u64>,
    /// Prefix of comment lines.
    pub comment: Option<String>,
    /// Words and numbers that stand for a missing sample, beside the usual words.
    pub missing: Vec<String>,
    /// Number of lines at the end of the file that are not rows.
    pub footer: u64,
    /// Lines of the file above the first byte, where a part of it is read: for messages.
    pub lines_above: u64,
}

/// Detected columns and notation.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Dialect {
    pub separator: Separator,
    pub marks: Marks,
    /// Prefixes of comment lines.
    pub comments: Vec<String>,
    /// Column names as written; blank if missing.
    pub names: Vec<String>,
    /// Units from a row of units.
    pub units: Vec<Option<String>>,
    pub kinds: Vec<ColumnKind>,
    /// Index of the first row among the lines inspected.
    pub first_row: usize,
    /// Whether there are no names and the first column, rising evenly, is likely the time.
    pub rising_first: bool,
    /// Lines above the header: name and value.
    pub preamble: Vec<(String, String)>,
    pub notes: Vec<Note>,
}
