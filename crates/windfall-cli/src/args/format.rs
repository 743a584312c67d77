//! How results are shown.

use clap::ValueEnum;

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
