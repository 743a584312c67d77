//! How results are shown.

use clap::{Args, ValueEnum, ValueHint};
use std::path::PathBuf;

/// How results are written to standard output.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum Format {
    /// Tables for people
    #[default]
    Text,
    /// JSON, all numbers SI
    Json,
    /// CSV, units in the header
    Csv,
}

/// How a result is shown, and where it is kept.
#[derive(Clone, Debug, Default, Args)]
pub struct Shown {
    /// How the result is shown
    #[arg(long, value_enum, default_value_t)]
    pub format: Format,
    /// Write the result into a file, too: .csv, .json or .txt
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub out: Option<PathBuf>,
}

/// Results of commands whose files have names of their own.
impl From<Format> for Shown {
    fn from(format: Format) -> Self {
        Self { format, out: None }
    }
}
