//! What can go wrong.

use crate::mixed_error::MixedError;
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
    /// A mixed model cannot be fitted or used.
    #[error(transparent)]
    Mixed(#[from] MixedError),
}

fn nearest(suggestion: Option<&str>) -> String {
    suggestion.map_or_else(String::new, |name| format!("; did you mean {name:?}?"))
}
