//! Why the checks could not be made.

use std::path::PathBuf;

/// Why the checks could not be made; a broken rule is not an error but a
/// text.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// A source file is not Rust.
    #[error("{}:{line}: not valid Rust ({message}); `cargo check` says more", path.display())]
    Source {
        /// File.
        path: PathBuf,
        /// Line, from 1.
        line: usize,
        /// What the tokeniser said.
        message: String,
    },
    /// A file of the workspace cannot be read.
    #[error("{}: cannot be read: {source}", path.display())]
    Read {
        /// File.
        path: PathBuf,
        /// Cause.
        source: std::io::Error,
    },
    /// A program that the checks need cannot be run, or failed.
    #[error("`{command}` failed: {message}; run it in the workspace to see why")]
    Command {
        /// Command line.
        command: String,
        /// What it wrote to standard error, or why it did not start.
        message: String,
    },
    /// `cargo metadata` lacks a field.
    #[error("`cargo metadata` has no {field}; expected format version 1")]
    Metadata {
        /// The missing field.
        field: &'static str,
    },
    /// `cargo metadata` did not print JSON.
    #[error("`cargo metadata` did not print JSON: {source}")]
    Json {
        /// Cause.
        #[from]
        source: serde_json::Error,
    },
}
