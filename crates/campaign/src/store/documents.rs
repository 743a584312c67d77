//! Results of campaigns that fit no impacts, as documents in results.sqlite.

use crate::store::file::{open_existing, store_error};
use rusqlite::{Connection, OptionalExtension, Transaction, params};
use std::path::Path;
use windfall_files::error::Error;

/// One number of a document, for people with a database browser.
#[derive(Clone, Debug, PartialEq)]
pub struct StoredValue {
    /// Its name.
    pub name: String,
    /// Its value; SI.
    pub value: f64,
    /// Its standard uncertainty, where known; SI.
    pub sd: Option<f64>,
    /// SI unit.
    pub unit: String,
}

/// One result, as it goes into the store.
#[derive(Clone, Debug, PartialEq)]
pub struct DocumentRecord {
    /// Digest of everything that it depends on.
    pub key: String,
    /// Kind of the campaign.
    pub kind: String,
    /// Id in impacts.csv.
    pub item: String,
    /// The specimen.
    pub specimen: String,
    /// The recording.
    pub file: String,
    /// The whole result as JSON.
    pub document: String,
    /// Its numbers.
    pub values: Vec<StoredValue>,
}

/// Documents of earlier runs under some keys, `None` where there is none.
///
/// # Errors
/// The file is damaged, foreign, newer, or cannot be read.
pub fn find_documents(path: &Path, keys: &[String]) -> Result<Vec<Option<String>>, Error> {
    let nothing = Ok(vec![None; keys.len()]);
    let Some(connection) = open_existing(path)? else {
        return nothing;
    };
    let failed = |source| store_error(path, "read", source);
    if !has_documents(&connection).map_err(failed)? {
        return nothing;
    }
    let mut query = connection
        .prepare("SELECT document FROM documents WHERE key = ?1")
        .map_err(failed)?;
    keys.iter()
        .map(|key| query.query_row([key], |row| row.get(0)).optional())
        .collect::<rusqlite::Result<_>>()
        .map_err(failed)
}

/// Adds a document to a run; one that an earlier run has added is only named.
pub(crate) fn insert_document(
    transaction: &Transaction,
    run: i64,
    position: usize,
    record: &DocumentRecord,
) -> rusqlite::Result<()> {
    let added = transaction.execute(
        "INSERT OR IGNORE INTO documents (key, kind, item, specimen, file, document) \
         VALUES (?1, ?2, ?3, ?4, ?5, ?6)",
        params![
            record.key,
            record.kind,
            record.item,
            record.specimen,
            record.file,
            record.document
        ],
    )?;
    if added > 0 {
        for (place, value) in record.values.iter().enumerate() {
            transaction.execute(
                "INSERT INTO document_values (key, position, name, value, sd, unit) \
                 VALUES (?1, ?2, ?3, ?4, ?5, ?6)",
                params![
                    record.key,
                    place as i64,
                    value.name,
                    value.value,
                    value.sd,
                    value.unit
                ],
            )?;
        }
    }
    transaction.execute(
        "INSERT INTO run_documents (run, position, key) VALUES (?1, ?2, ?3)",
        params![run, position as i64, record.key],
    )?;
    Ok(())
}

/// Keys of the documents of a run, in order.
pub(crate) fn document_keys(connection: &Connection, run: i64) -> rusqlite::Result<Vec<String>> {
    if !has_documents(connection)? {
        return Ok(Vec::new());
    }
    let mut query =
        connection.prepare("SELECT key FROM run_documents WHERE run = ?1 ORDER BY position")?;
    query.query_map([run], |row| row.get(0))?.collect()
}

/// Whether the store has tables for documents; version 1 has none.
fn has_documents(connection: &Connection) -> rusqlite::Result<bool> {
    connection
        .pragma_query_value(None, "user_version", |row| row.get::<_, i64>(0))
        .map(|version| version >= 2)
}
