//! Where something is wrong, or what is missing: parts of errors.

use std::path::{Path, PathBuf};

/// A line in a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Place {
    /// The file.
    pub file: PathBuf,
    /// Line, counted from 1; 0 when the fault is in the file as a whole.
    pub line: usize,
}

impl Place {
    /// A line of a file; 0 for the file as a whole.
    pub fn at(file: &Path, line: usize) -> Self {
        let file = file.to_path_buf();
        Self { file, line }
    }
}

impl std::fmt::Display for Place {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self.line {
            0 => write!(f, "{}", self.file.display()),
            line => write!(f, "{}, line {line}", self.file.display()),
        }
    }
}

/// A quantity that every drop must have.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DropQuantity {
    /// "mass" or "drop height".
    pub name: &'static str,
    /// The column that would tell it, with its tables.
    pub column: &'static str,
    /// Begin of the names of such columns.
    pub prefix: &'static str,
    /// A line of `[rig]` that would do.
    pub example: &'static str,
}
