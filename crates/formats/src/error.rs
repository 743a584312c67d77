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
pub enum Error {
    /// The file does not exist.
    #[error("{path}: there is no such file; check the name and the directory", path = path.display())]
    Absent {
        /// The file.
        path: PathBuf,
    },
    /// The operating system reported an error.
    #[error("{path}: cannot read: {source}", path = path.display())]
    Access {
        /// The file.
        path: PathBuf,
        /// The error reported.
        source: std::io::Error,
    },
    /// The file is empty.
    #[error("{path}: the file is empty; expected {expected}", path = path.display())]
    Empty {
        /// The file.
        path: PathBuf,
        /// What such a file should contain.
        expected: &'static str,
    },
    /// The format is unknown or unsupported.
    #[error("{path}: {found}; {advice}", path = path.display())]
    UnknownFormat {
        /// The file.
        path: PathBuf,
        /// What the file seems to be.
        found: String,
        /// What to do.
        advice: String,
    },
    /// The file is truncated.
    #[error(
        "{path}{place}: the file ends too early: {what} needs {needed} bytes, {left} are left; \
         it was cut off while it was written or copied", path = path.display()
    )]
    Truncated {
        /// The file.
        path: PathBuf,
        /// Where.
        place: Place,
        /// What should be there.
        what: String,
        /// Bytes needed.
        needed: u64,
        /// Bytes left in the file.
        left: u64,
    },
    /// The file violates its format.
    #[error("{path}{place}: {problem}; {advice}", path = path.display())]
    Malformed {
        /// The file.
        path: PathBuf,
        /// Where.
        place: Place,
        /// What was expected and what was found.
        problem: String,
        /// What to do.
        advice: String,
    },
    /// The file uses an unsupported part of its format.
    #[error("{path}{place}: windfall does not read {what}; {advice}", path = path.display())]
    Unsupported {
        /// The file.
        path: PathBuf,
        /// Where.
        place: Place,
        /// What is not supported.
        what: String,
        /// What to do.
        advice: String,
    },
    /// A declared size exceeds the file.
    #[error(
        "{path}{place}: {what} claims {declared}, the file has room for {possible}; \
         the file is damaged", path = path.display()
    )]
    TooLarge {
        /// The file.
        path: PathBuf,
        /// Where.
        place: Place,
        /// What has this size.
        what: String,
        /// Declared size, in the unit of `what`.
        declared: u64,
        /// Largest possible size.
        possible: u64,
    },
    /// A cell is not a number.
    #[error("{path}{place}: \"{text}\" is not a number{hint}", path = path.display())]
    NotNumber {
        /// The file.
        path: PathBuf,
        /// Where.
        place: Place,
        /// Text of the cell.
        text: String,
        /// A remark that starts with a space or semicolon, or nothing.
        hint: String,
    },
    /// A setting does not fit the file.
    #[error("{path}: the setting {option} does not fit: {problem}", path = path.display())]
    Setting {
        /// The file.
        path: PathBuf,
        /// Name and value of the setting.
        option: String,
        /// What is wrong and what to do.
        problem: String,
    },
}
