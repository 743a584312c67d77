//! Results of campaigns that fit no impacts, as documents in results.sqlite.

use crate::store::error::StoreError;
use crate::store::file::{execute, open_existing, store_error};
use rusqlite::{Connection, OptionalExtension, Row, Transaction, params};
use serde::de::DeserializeOwned;
use std::path::Path;
use windfall_files::error::Error;
use windfall_files::provenance::digest_text;

/// Results that are read in one transaction: locking the file for each takes longer than reading
/// it, and a writer must not wait for all of them.
const AT_ONCE: usize = 1000;

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

/// What a document and the key that it stands under are known by.
pub(crate) fn document_digest(key: &str, document: &str) -> String {
    digest_text(&format!("{key}\n{document}"))
}

/// Puts a document in the place of one that is not what was written.
pub(crate) fn mend_document(
    transaction: &Transaction,
    table: &str,
    (key, document, sha256): (&str, &str, &str),
) -> rusqlite::Result<()> {
    let change = format!(
        "UPDATE {table} SET document = ?2, sha256 = ?3 \
         WHERE key = ?1 AND (document IS NOT ?2 OR sha256 IS NOT ?3)"
    );
    transaction.execute(&change, params![key, document, sha256])?;
    Ok(())
}

/// Results of earlier runs under some keys, `None` where there is none; a store that does not
/// exist yet holds none.
///
/// * `table`, `item`: the table that holds them, and the column that names them
///
/// # Errors
/// The file is damaged, foreign, newer, or cannot be read.
pub fn find_documents<T: DeserializeOwned>(
    path: &Path,
    keys: &[String],
    (table, item): (&str, &str),
) -> Result<Vec<Option<T>>, Error> {
    let nothing = || Ok(keys.iter().map(|_| None).collect());
    let Some(connection) = open_existing(path)? else {
        return nothing();
    };
    let failed = |source| store_error(path, "read", source);
    // Older stores have no digests to compare with.
    if version_of(&connection).map_err(failed)? < 3 {
        return nothing();
    }
    let query = format!("SELECT document, sha256, {item} FROM {table} WHERE key = ?1");
    let mut query = connection.prepare(&query).map_err(failed)?;
    let mut find = |key: &String| -> Result<Option<T>, Error> {
        let row = |row: &Row| Ok((row.get(0)?, row.get(1)?, row.get(2)?));
        let found: Option<(String, Option<String>, String)> =
            query.query_row([key], row).optional().map_err(failed)?;
        let Some((document, Some(sha256), item)) = found else {
            return Ok(None);
        };
        if document_digest(key, &document) != sha256 {
            let path = path.to_path_buf();
            return Err(StoreError::Altered { path, item }.into());
        }
        // One text at a time: thousands of them are several times their results.
        serde_json::from_str(&document).map(Some).map_err(|error| {
            let detail = format!("the result {key} cannot be read: {error}");
            StoreError::damaged(path, detail)
        })
    };
    let mut all = Vec::with_capacity(keys.len());
    for some in keys.chunks(AT_ONCE) {
        let _locked = connection.unchecked_transaction().map_err(failed)?;
        for key in some {
            all.push(find(key)?);
        }
    }
    Ok(all)
}

/// Adds a document; one that is there and is not what was written is mended.
pub(crate) fn insert_document(
    transaction: &Transaction,
    record: &DocumentRecord,
) -> rusqlite::Result<()> {
    let sha256 = document_digest(&record.key, &record.document);
    let added = execute(
        transaction,
        "INSERT OR IGNORE INTO documents (key, kind, item, specimen, file, document, sha256) \
         VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7)",
        params![
            record.key,
            record.kind,
            record.item,
            record.specimen,
            record.file,
            record.document,
            sha256
        ],
    )?;
    if added == 0 {
        let document = (
            record.key.as_str(),
            record.document.as_str(),
            sha256.as_str(),
        );
        mend_document(transaction, "documents", document)?;
    } else {
        for (place, value) in record.values.iter().enumerate() {
            execute(
                transaction,
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
    Ok(())
}

/// Keys of the documents of a run, in order.
pub(crate) fn document_keys(connection: &Connection, run: i64) -> rusqlite::Result<Vec<String>> {
    if version_of(connection)? < 2 {
        return Ok(Vec::new());
    }
    let mut query =
        connection.prepare("SELECT key FROM run_documents WHERE run = ?1 ORDER BY position")?;
    query.query_map([run], |row| row.get(0))?.collect()
}

/// Version of the store's tables; those for documents came with the second.
fn version_of(connection: &Connection) -> rusqlite::Result<i64> {
    connection.pragma_query_value(None, "user_version", |row| row.get(0))
}
