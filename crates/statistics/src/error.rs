//! What can go wrong.

use crate::mixed::error::MixedError;
use crate::sample_error::SampleError;
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
    /// A column of numbers with text among them.
    #[error(
        "column {name:?} holds numbers but for {text:?} in row {row}: mend that cell, leave it \
         blank, or write C({name}) if the column names categories"
    )]
    NumbersWithText {
        /// The column.
        name: String,
        /// Row, from 1.
        row: usize,
        /// What stands there.
        text: String,
    },
    /// A formula cannot be read.
    #[error("{problem}\n  {formula}\n  {}^", " ".repeat(*column))]
    FormulaSyntax {
        /// The formula.
        formula: String,
        /// Characters before the place.
        column: usize,
        /// What is wrong there.
        problem: String,
    },
    /// A function of a formula is not known.
    #[error("there is no function {function:?} in formulas; there are {known}")]
    UnknownFunction {
        /// Its name.
        function: String,
        /// Those there are.
        known: String,
    },
    /// Too few rows for a model.
    #[error("{rows} rows are too few for {terms} coefficients: take terms out, or measure more")]
    TooFewRows {
        /// Rows without missing cells.
        rows: usize,
        /// Coefficients of the model.
        terms: usize,
    },
    /// A formula gives a value that is no number.
    #[error("{expression} is {value} in row {row}: it cannot be taken there")]
    NotFinite {
        /// The expression.
        expression: String,
        /// Its value.
        value: f64,
        /// Row, from 1.
        row: usize,
    },
    /// A category that the model has not seen.
    #[error(
        "{column:?} has {level:?} in row {row}, which the model was not fitted with; it knows {known}"
    )]
    UnknownLevel {
        /// The column.
        column: String,
        /// The level.
        level: String,
        /// Row, from 1.
        row: usize,
        /// Levels it knows.
        known: String,
    },
    /// A column is constant where it must vary.
    #[error("{name:?} has one value in all rows: it can explain nothing")]
    Constant {
        /// The column.
        name: String,
    },
    /// A part of a request that does not fit the data.
    #[error("{what}: {problem}")]
    Request {
        /// What was asked for.
        what: String,
        /// Why it cannot be.
        problem: String,
    },
    /// A mixed model cannot be fitted or used.
    #[error(transparent)]
    Mixed(#[from] MixedError),
    /// A sample cannot be described, compared or tested.
    #[error(transparent)]
    Sample(#[from] SampleError),
}

fn nearest(suggestion: Option<&str>) -> String {
    suggestion.map_or_else(String::new, |name| format!("; did you mean {name:?}?"))
}
