//! What can be wrong with a file of columns.

use arrow_schema::ArrowError;
use parquet::errors::ParquetError;

/// What can be wrong with a file of columns.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// The system does not let it be read or written.
    #[error(transparent)]
    Io(#[from] std::io::Error),
    /// Its bytes are not those of a table.
    #[error("the file is damaged: {0}")]
    Damaged(String),
    /// A row that does not belong to the schema.
    #[error("{0}")]
    Row(String),
    /// A column of a type that is not read.
    #[error(
        "the column {column} is of type {found}: numbers, texts, dates and yes or no are read; write the \
         table without it, or with its parts as columns of their own"
    )]
    Kind {
        /// Its name.
        column: String,
        /// Its type.
        found: String,
    },
}

impl From<ArrowError> for Error {
    fn from(error: ArrowError) -> Self {
        match error {
            ArrowError::IoError(_, source) => Self::Io(source),
            other => Self::Damaged(other.to_string()),
        }
    }
}

impl From<ParquetError> for Error {
    fn from(error: ParquetError) -> Self {
        match error {
            ParquetError::External(source) => match source.downcast::<std::io::Error>() {
                Ok(source) => Self::Io(*source),
                Err(other) => Self::Damaged(other.to_string()),
            },
            other => Self::Damaged(other.to_string()),
        }
    }
}
