//! Errors of reading a file.

use std::path::PathBuf;

/// Location of a fault in a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Place {
    /// The file as a whole.
    File,
    /// A byte, counted from 0.
    Byte(u64),
    /// A line of a text file, counted from 1.
    Line(u64),
    /// A cell of a text file.
    Cell {
        /// Line, counted from 1.
        line: u64,
        /// Name of the column.
        column: String,
    },
    /// A channel, dataset, variable or other named object.
    Object(String),
    /// A sample of a channel, counted from 0.
    Sample {
        /// Name of the channel.
        channel: String,
        /// Index of the sample.
        sample: u64,
    },
}

impl std::fmt::Display for Place {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::File => Ok(()),
            Self::Byte(byte) => write!(f, ", at byte {byte}"),
            Self::Line(line) => write!(f, ", line {line}"),
            Self::Cell { line, column } => write!(f, ", line {line}, column \"{column}\""),
            Self::Object(name) => write!(f, ", \"{name}\""),
            Self::Sample { channel, sample } => write!(f, ", \"{channel}\", sample {sample}"),
        }
    }
}

/// Why a file cannot be read.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
#[allow(missing_docs, reason = "each message names its fields")]
pub enum Error {
    #[error("{path}: there is no such file; check the name and the directory", path = path.display())]
    Absent { path: PathBuf },
    #[error("{path}: cannot read: {source}", path = path.display())]
    Access {
        path: PathBuf,
        source: std::io::Error,
    },
    #[error("{path}: the file is empty; expected {expected}", path = path.display())]
    Empty {
        path: PathBuf,
        expected: &'static str,
    },
    #[error("{path}: {found}; {advice}", path = path.display())]
    UnknownFormat {
        path: PathBuf,
        found: String,
        advice: String,
    },
    #[error(
        "{path}{place}: the file ends too early: {what} needs {needed} bytes, {left} are left; \
         it was cut off while it was written or copied", path = path.display()
    )]
    Truncated {
        path: PathBuf,
        place: Place,
        what: String,
        needed: u64,
        left: u64,
    },
    #[error("{path}{place}: {problem}; {advice}", path = path.display())]
    Malformed {
        path: PathBuf,
        place: Place,
        problem: String,
        advice: String,
    },
    #[error("{path}{place}: windfall does not read {what}; {advice}", path = path.display())]
    Unsupported {
        path: PathBuf,
        place: Place,
        what: String,
        advice: String,
    },
    #[error(
        "{path}{place}: {what} claims {declared}, the file has room for {possible}; \
         the file is damaged", path = path.display()
    )]
    TooLarge {
        path: PathBuf,
        place: Place,
        what: String,
        declared: u64,
        possible: u64,
    },
    #[error("{path}{place}: \"{text}\" is not a number{hint}", path = path.display())]
    NotNumber {
        path: PathBuf,
        place: Place,
        text: String,
        /// Starts with a space or semicolon, or is empty.
        hint: String,
    },
    #[error("{path}: the setting {option} does not fit: {problem}", path = path.display())]
    Setting {
        path: PathBuf,
        option: String,
        problem: String,
    },
}
