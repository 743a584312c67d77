//! What can go wrong.

use crate::sample_error::SampleError;
use thiserror::Error;
use windfall_mixed::error::MixedError;

/// Errors of designs and models.
#[derive(Debug, Clone, PartialEq, Error)]
#[allow(missing_docs, reason = "each message names its fields")]
pub enum Error {
    #[error("there is no column {name:?}; the table has {known}{}", nearest(suggestion.as_deref()))]
    UnknownColumn {
        name: String,
        known: String,
        suggestion: Option<String>,
    },
    #[error(
        "column {name:?} holds text (row {row}: {text:?}), and numbers are needed; if that stands \
         for a missing value, say --missing {text:?}"
    )]
    NotNumbers {
        name: String,
        row: usize,
        text: String,
    },
    #[error(
        "column {name:?} holds numbers but for {text:?} in row {row}: mend that cell, leave it \
         blank, say --missing {text:?} if it stands for a missing value, or write C({name}) if \
         the column names categories"
    )]
    NumbersWithText {
        name: String,
        row: usize,
        text: String,
    },
    #[error(
        "the levels of {name:?} have no order, and a polynomial over them needs one: declare it, \
         --levels '{name}={levels}' with the levels from the lowest to the highest"
    )]
    UnorderedLevels { name: String, levels: String },
    #[error("{problem}\n  {formula}\n  {}^", " ".repeat(*column))]
    FormulaSyntax {
        formula: String,
        column: usize,
        problem: String,
    },
    #[error("there is no function {function:?} in formulas; there are {known}")]
    UnknownFunction { function: String, known: String },
    #[error("{rows} rows are too few for {terms} coefficients: take terms out, or measure more")]
    TooFewRows { rows: usize, terms: usize },
    #[error("{expression} is {value} in row {row}: it cannot be taken there")]
    NotFinite {
        expression: String,
        value: f64,
        row: usize,
    },
    #[error(
        "{column:?} has {level:?} in row {row}, which the model was not fitted with; it knows {known}"
    )]
    UnknownLevel {
        column: String,
        level: String,
        row: usize,
        known: String,
    },
    #[error(
        "the weight {name} is {weight} in row {row}: weights must be positive and finite; blank \
         the cell to leave the row out"
    )]
    Weight {
        name: String,
        weight: f64,
        row: usize,
    },
    #[error("{name:?} has one value in all rows: it can explain nothing")]
    Constant { name: String },
    #[error("{what}: {problem}")]
    Request { what: String, problem: String },
    #[error(transparent)]
    Mixed(#[from] MixedError),
    #[error(transparent)]
    Sample(#[from] SampleError),
}

impl Error {
    /// The row of the table that is to blame, from 1, where one is.
    pub fn row(&self) -> Option<usize> {
        self.clone().row_mut().copied()
    }

    fn row_mut(&mut self) -> Option<&mut usize> {
        match self {
            Self::NotNumbers { row, .. }
            | Self::NumbersWithText { row, .. }
            | Self::NotFinite { row, .. }
            | Self::Weight { row, .. }
            | Self::UnknownLevel { row, .. } => Some(row),
            _ => None,
        }
    }

    /// The error of some rows of a table, as one of the table.
    ///
    /// * `whole`: where a row of them is in it, both from 0
    pub(crate) fn of_rows(mut self, whole: impl Fn(usize) -> Option<usize>) -> Self {
        if let Some(row) = self.row_mut() {
            *row = whole(*row - 1).map_or(*row, |whole| whole + 1);
        }
        self
    }
}

fn nearest(suggestion: Option<&str>) -> String {
    suggestion.map_or_else(String::new, |name| format!("; did you mean {name:?}?"))
}
