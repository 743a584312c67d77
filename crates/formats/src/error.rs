//! Why a file cannot be read, said so that it can be mended.

use std::path::PathBuf;

/// Where in a file the fault is.
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
    /// A channel, dataset, variable or other named thing in the file.
    Object(String),
    /// A sample of a channel, counted from 0.
    Sample {
        /// Name of the channel.
        channel: String,
        /// Position in it.
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
    /// There is no such file.
    #[error("{path}: there is no such file; check the name and the directory", path = path.display())]
    Absent {
        /// The file.
        path: PathBuf,
    },
    /// The system refuses.
    #[error("{path}: cannot read: {source}", path = path.display())]
    Access {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// A file of no bytes, or without anything to read.
    #[error("{path}: the file is empty; expected {expected}", path = path.display())]
    Empty {
        /// The file.
        path: PathBuf,
        /// What a file of its kind holds.
        expected: &'static str,
    },
    /// The format could not be told, or is one that windfall does not read.
    #[error("{path}: {found}; {advice}", path = path.display())]
    UnknownFormat {
        /// The file.
        path: PathBuf,
        /// What it seems to be.
        found: String,
        /// What to do.
        advice: String,
    },
    /// The file ends before what it declares.
    #[error(
        "{path}{place}: the file ends too early: {what} needs {needed} bytes, {left} are left; \
         it was cut off while it was written or copied", path = path.display()
    )]
    Truncated {
        /// The file.
        path: PathBuf,
        /// Where.
        place: Place,
        /// What should have stood there.
        what: String,
        /// Bytes that it needs.
        needed: u64,
        /// Bytes that the file still has.
        left: u64,
    },
    /// The file breaks the rules of its format.
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
    /// A part of the format that windfall does not read.
    #[error("{path}{place}: windfall does not read {what}; {advice}", path = path.display())]
    Unsupported {
        /// The file.
        path: PathBuf,
        /// Where.
        place: Place,
        /// What is not read.
        what: String,
        /// What to do.
        advice: String,
    },
    /// A declared size that the file cannot hold.
    #[error(
        "{path}{place}: {what} claims {declared}, the file has room for {possible}; \
         the file is damaged", path = path.display()
    )]
    TooLarge {
        /// The file.
        path: PathBuf,
        /// Where.
        place: Place,
        /// What claims a size.
        what: String,
        /// The claim, in the unit of `what`.
        declared: u64,
        /// The most that can be.
        possible: u64,
    },
    /// A cell of a text file that is no number.
    #[error("{path}{place}: \"{text}\" is not a number{hint}", path = path.display())]
    NotNumber {
        /// The file.
        path: PathBuf,
        /// Where.
        place: Place,
        /// What stands there.
        text: String,
        /// A remark that starts with a blank, or nothing.
        hint: String,
    },
    /// A setting that does not fit the file or makes no sense.
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
