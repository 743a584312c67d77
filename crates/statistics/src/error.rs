//! What can go wrong.

use thiserror::Error;

/// Errors of designs and models.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum Error {
    /// A column is not in the table.
    #[error("there is no column {name:?}; the table has {known}{}", nearest(suggestion.as_deref()))]
    UnknownColumn {
        /// The name that was asked for.
        name: String,
        /// The columns there are, for the message.
        known: String,
        /// The nearest of them.
        suggestion: Option<String>,
    },
    /// A column of categories where numbers are needed.
    #[error("column {name:?} holds text (row {row}: {text:?}), and numbers are needed")]
    NotNumbers {
        /// The column.
        name: String,
        /// Row, from 1.
        row: usize,
        /// What stands there.
        text: String,
    },
    /// Too few values for what was asked.
    #[error("{what}: {found} values, and at least {needed} are needed")]
    TooFewValues {
        /// Which values.
        what: String,
        /// How many there are.
        found: usize,
        /// How many are needed.
        needed: usize,
    },
    /// Nothing to compare a group with.
    #[error("{found} group; a comparison needs at least two")]
    TooFewGroups {
        /// How many there are.
        found: usize,
    },
    /// A value is missing, infinite or not a number.
    #[error("{what}: value {place} is {value}; leave out missing values first")]
    NotFinite {
        /// Which values.
        what: String,
        /// Place, from 1.
        place: usize,
        /// The value.
        value: f64,
    },
    /// A value that is zero or below.
    #[error("{what}: value {place} is {value}, and all have to be above zero")]
    NotPositive {
        /// Which values.
        what: String,
        /// Place, from 1.
        place: usize,
        /// The value.
        value: f64,
    },
    /// Two lists that belong together have different lengths.
    #[error("{what}: {first} values against {second}; each needs its partner")]
    LengthsDiffer {
        /// Which values.
        what: String,
        /// Length of the first.
        first: usize,
        /// Length of the second.
        second: usize,
    },
    /// All values are the same where their spread is needed.
    #[error("{what}: all values are equal, so there is no spread to compare with")]
    NoSpread {
        /// Which values.
        what: String,
    },
    /// A setting outside its range.
    #[error("{quantity} is {value}; {expected} is expected")]
    OutOfRange {
        /// Which setting.
        quantity: &'static str,
        /// Its value.
        value: f64,
        /// What is legal.
        expected: &'static str,
    },
}

fn nearest(suggestion: Option<&str>) -> String {
    suggestion.map_or_else(String::new, |name| format!("; did you mean {name:?}?"))
}
