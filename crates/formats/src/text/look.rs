//! What cells look like before the dialect of a table is known.

use crate::text::date::{Moment, moment};
use crate::text::missing::MissingWords;
use crate::text::number::{Cell, Marks, bare, cell, leading_number};
use crate::text::rows::Separator;

/// Candidate thousands separators.
pub const THOUSANDS: [char; 5] = ['.', ',', '\'', ' ', '\u{a0}'];

/// What a cell looks like in a notation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Look {
    /// Blank, or a word for a missing value.
    Blank,
    Number,
    Moment(Moment),
    Text,
}

/// How numbers and missing values are written.
#[derive(Clone, Copy, Debug)]
pub struct Notation<'a> {
    pub marks: Marks,
    pub missing: &'a MissingWords,
}

impl Notation<'_> {
    pub fn look(self, text: &str) -> Look {
        // Most cells are plain numbers.
        let plain = leading_number(text.as_bytes(), self.marks.decimal);
        if plain.is_some_and(|(_, used)| used == text.len()) {
            return Look::Number;
        }
        let text = bare(text);
        if text.is_empty() {
            return Look::Blank;
        }
        // Most text is recognised by its first character.
        let start = |c: char| c.is_ascii_digit() || "+-.,\u{2212}".contains(c);
        if text.starts_with(start) {
            match cell(text, self.marks) {
                Cell::Blank => return Look::Blank,
                Cell::Number(_) => return Look::Number,
                Cell::Other => {}
            }
            if let Some(moment) = moment(text) {
                return Look::Moment(moment);
            }
        }
        match self.missing.has(text) {
            true => Look::Blank,
            false => Look::Text,
        }
    }

    /// What a cell looks like where numbers with any thousands separator count as numbers.
    ///
    /// * `plain`: what it looks like otherwise
    pub fn grouped(self, text: &str, plain: Look, separator: Separator) -> Look {
        if plain != Look::Text
            || !bare(text).starts_with(|c: char| c.is_ascii_digit() || "+-".contains(c))
        {
            return plain;
        }
        let decimal = char::from(self.marks.decimal);
        let usable =
            |mark: char| mark != decimal && !(mark == ' ' && separator == Separator::Blanks);
        let grouped = THOUSANDS.into_iter().filter(|mark| usable(*mark));
        let mut grouped = grouped.map(|mark| Marks {
            thousands: Some(mark),
            ..self.marks
        });
        match grouped.any(|marks| matches!(cell(text, marks), Cell::Number(_))) {
            true => Look::Number,
            false => Look::Text,
        }
    }
}
