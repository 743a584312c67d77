//! The file results.sqlite: whose it is, which version, whether it is sound.

use crate::store::error::StoreError;
use rusqlite::{Connection, ErrorCode, OpenFlags, Params, Transaction};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};
use std::time::Duration;
use windfall_files::cache::stamp;
use windfall_files::error::Error;

/// Marks a database as ours: "wfal" in ASCII.
const APPLICATION_ID: i64 = 0x7766_616c;

/// Version of the schema that this windfall writes.
const STORE_VERSION: i64 = 3;

/// How long to wait for another windfall that is writing.
pub(crate) const PATIENCE: Duration = Duration::from_secs(20);

/// Settings of SQLite for writing. With a rollback journal and full synchronisation, a committed
/// run is on disk. The cache holds 8 MiB: with the usual 2 MiB, the pages of a large run are read
/// back from disk while it is written.
pub(crate) const WRITING: [(&str, &str); 4] = [
    ("journal_mode", "DELETE"),
    ("synchronous", "FULL"),
    ("foreign_keys", "ON"),
    ("cache_size", "-8192"),
];

/// Opens the store if it exists, after making sure that it is ours.
pub(crate) fn open_existing(path: &Path) -> Result<Option<Connection>, Error> {
    if !path.exists() {
        return Ok(None);
    }
    let failed = |source| store_error(path, "open", source);
    // Writable, because a journal left by a killed windfall is rolled back here.
    let flags = OpenFlags::SQLITE_OPEN_READ_WRITE | OpenFlags::SQLITE_OPEN_NO_MUTEX;
    let connection = Connection::open_with_flags(path, flags).map_err(failed)?;
    connection.busy_timeout(PATIENCE).map_err(failed)?;
    let integer = |name| {
        connection
            .pragma_query_value(None, name, |row| row.get::<_, i64>(0))
            .map_err(failed)
    };
    let (application_id, version) = (integer("application_id")?, integer("user_version")?);
    let tables: i64 = connection
        .query_row("SELECT COUNT(*) FROM sqlite_master", [], |row| row.get(0))
        .map_err(failed)?;
    // A file of no bytes or without tables is what a kill before the first
    // commit leaves behind.
    if tables == 0 && application_id == 0 {
        return Ok(None);
    }
    let path = path.to_path_buf();
    if application_id != APPLICATION_ID {
        return Err(Error::from(StoreError::Foreign {
            path,
            application_id,
        }));
    }
    if version > STORE_VERSION {
        return Err(Error::from(StoreError::Newer {
            path,
            found: version,
            known: STORE_VERSION,
        }));
    }
    check_integrity(&connection, &path)?;
    Ok(Some(connection))
}

/// Executes a statement that is prepared the first time only.
pub(crate) fn execute(
    connection: &Connection,
    statement: &str,
    values: impl Params,
) -> rusqlite::Result<usize> {
    connection.prepare_cached(statement)?.execute(values)
}

/// The store that was checked last, and by what it is seen to be the same.
static CHECKED: Mutex<Option<(PathBuf, String)>> = Mutex::new(None);

fn check_integrity(connection: &Connection, path: &Path) -> Result<(), Error> {
    let own = stamp(path).ok().map(|stamp| (path.to_path_buf(), stamp));
    let checked = || CHECKED.lock().unwrap_or_else(PoisonError::into_inner);
    // One answer of the page opens it twice in a row.
    if own.is_some() && *checked() == own {
        return Ok(());
    }
    let verdict: String = connection
        .pragma_query_value(None, "quick_check", |row| row.get(0))
        .map_err(|source| store_error(path, "open", source))?;
    if verdict == "ok" {
        *checked() = own;
        return Ok(());
    }
    let detail = verdict.lines().next().unwrap_or_default().to_owned();
    Err(StoreError::damaged(path, detail))
}

/// What the database said, in our words.
pub(crate) fn store_error(path: &Path, action: &'static str, source: rusqlite::Error) -> Error {
    let path = path.to_path_buf();
    match source.sqlite_error_code() {
        Some(ErrorCode::NotADatabase | ErrorCode::DatabaseCorrupt) => {
            StoreError::damaged(&path, source.to_string())
        }
        _ => Error::from(StoreError::Refused {
            path,
            action,
            source,
        }),
    }
}

/// Tables of a new store, and those that an older one lacks.
pub(crate) fn create_schema(transaction: &Transaction) -> rusqlite::Result<()> {
    let version: i64 = transaction.pragma_query_value(None, "user_version", |row| row.get(0))?;
    if version == 0 {
        transaction.execute_batch(include_str!("store_schema.sql"))?;
        transaction.pragma_update(None, "application_id", APPLICATION_ID)?;
    }
    // Version 2 adds documents; what version 1 holds stays as it is.
    if version < 2 {
        transaction.execute_batch(include_str!("store_schema_2.sql"))?;
    }
    // Version 3 adds digests; documents without one are not answered from.
    if version < STORE_VERSION {
        transaction.execute_batch(include_str!("store_schema_3.sql"))?;
        transaction.pragma_update(None, "user_version", STORE_VERSION)?;
    }
    Ok(())
}
