//! What can be wrong with results.sqlite.

use rusqlite::ErrorCode;
use std::path::{Path, PathBuf};
use windfall_files::error::{Error, Fault};

/// What can be wrong with results.sqlite; nothing was written where it is.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum StoreError {
    /// A results file that is no database, or a damaged one.
    #[error(
        "{path}: the results file is damaged or not a database ({detail}); nothing was written. \
         Move it away (or restore a copy) and run again to make a new one", path = path.display()
    )]
    Damaged {
        /// The file.
        path: PathBuf,
        /// What SQLite said.
        detail: String,
    },
    /// A database that another program made.
    #[error(
        "{path}: this is a database of another program (application id {application_id}); \
         nothing was written. Move it away and run again", path = path.display()
    )]
    Foreign {
        /// The file.
        path: PathBuf,
        /// The application id found.
        application_id: i64,
    },
    /// A results file of a newer windfall.
    #[error(
        "{path}: these results were written by a newer windfall (store version {found}, this one \
         knows {known}); nothing was written. Install the newer windfall, or move the file away",
        path = path.display()
    )]
    Newer {
        /// The file.
        path: PathBuf,
        /// Version found.
        found: i64,
        /// Newest version that this windfall knows.
        known: i64,
    },
    /// A stored document that is not what was written.
    #[error(
        "{path}: the stored result of {item} is not what was written (its digest differs); \
         `--refit` fits it anew", path = path.display()
    )]
    Altered {
        /// The file.
        path: PathBuf,
        /// Which result.
        item: String,
    },
    /// The database refused an operation.
    #[error(
        "{path}: cannot {action} the results: {source}{}", after_refusal(action, source),
        path = path.display()
    )]
    Refused {
        /// The file.
        path: PathBuf,
        /// "open", "read" or "write".
        action: &'static str,
        /// What SQLite said.
        source: rusqlite::Error,
    },
}

impl StoreError {
    /// A results file that cannot be read, and why.
    pub(crate) fn damaged(path: &Path, detail: String) -> Error {
        let path = path.to_path_buf();
        Self::Damaged { path, detail }.into()
    }
}

impl Fault for StoreError {
    fn is_request(&self) -> bool {
        false
    }
}

/// What holds after a database refused something, and what to do.
fn after_refusal(action: &str, source: &rusqlite::Error) -> &'static str {
    match (action, source.sqlite_error_code()) {
        ("write", Some(ErrorCode::DiskFull)) => {
            "; earlier results are as they were: make room and run again"
        }
        ("write", Some(ErrorCode::ReadOnly | ErrorCode::CannotOpen)) => {
            "; the directory is read-only for you: copy the campaign to a place where you may write"
        }
        ("write", _) => {
            "; earlier results are as they were. If the disk is full, make room and run again"
        }
        _ => "",
    }
}
