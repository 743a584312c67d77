//! results.sqlite: every result with its provenance.
//!
//! A run is written in one transaction, synchronised to disk before it counts,
//! and never changes an earlier run: killing windfall at any moment leaves the
//! earlier results as they were. A file that is not ours, is damaged or comes
//! from a newer windfall is refused and left alone.

use crate::recording::digests::RunOrigin;
use crate::result::outcome::ImpactOutcome;
use crate::store::documents::{
    DocumentRecord, document_digest, document_keys, find_documents, insert_document, mend_document,
};
use crate::store::file::{PATIENCE, WRITING, create_schema, execute, open_existing, store_error};
use rusqlite::{Connection, OptionalExtension, Transaction, params};
use std::collections::HashSet;
use std::path::Path;
use windfall_files::confined::discard;
use windfall_files::error::Error;
use windfall_files::found::FailureOutcome;
use windfall_files::inputs::note_written;
use windfall_files::name::Name;
use windfall_files::provenance::{VERSION, time_now};

/// One run, as it goes into the store.
#[derive(Clone, Debug)]
pub struct RunRecord<'a> {
    /// When it was done; UTC.
    pub time: String,
    /// Version of windfall.
    pub windfall: String,
    /// All options, as JSON.
    pub options: String,
    /// Files read: name and SHA-256.
    pub inputs: Vec<(String, String)>,
    /// Keys and results, in the order of the campaign.
    pub results: Vec<(String, &'a ImpactOutcome)>,
    /// Results of campaigns that fit no impacts, in the order of the campaign.
    pub documents: Vec<DocumentRecord>,
    /// What could not be fitted.
    pub failures: Vec<FailureOutcome>,
    /// Keys of results and documents that `write_results` has written: they are only named.
    pub saved: HashSet<String>,
}

impl RunRecord<'_> {
    /// Results of work that is not done.
    pub(crate) fn unfinished() -> Self {
        let origin = RunOrigin {
            options: String::new(),
            inputs: Vec::new(),
        };
        Self::new(origin, Vec::new())
    }

    /// A run of now and of this windfall, without results yet.
    pub fn new(origin: RunOrigin, failures: Vec<FailureOutcome>) -> Self {
        Self {
            time: time_now(),
            windfall: VERSION.to_owned(),
            options: origin.options,
            inputs: origin.inputs,
            results: Vec::new(),
            documents: Vec::new(),
            failures,
            saved: HashSet::new(),
        }
    }
}

/// What the store knows of the newest run.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RunIdentity {
    /// When it was done; UTC.
    pub time: String,
    /// Keys of its results and documents, in order.
    pub keys: Vec<String>,
    /// What it could not fit.
    pub failures: Vec<FailureOutcome>,
}

/// Fits of earlier runs under some keys, `None` where there is none.
///
/// # Errors
/// Those of [`find_documents`].
pub fn find_results(path: &Path, keys: &[String]) -> Result<Vec<Option<ImpactOutcome>>, Error> {
    find_documents(path, keys, ("results", "impact"))
}

/// The newest run, if there is one.
///
/// # Errors
/// The file is damaged, foreign, newer, or cannot be read.
pub fn latest_run(path: &Path) -> Result<Option<RunIdentity>, Error> {
    let Some(connection) = open_existing(path)? else {
        return Ok(None);
    };
    read_latest(&connection).map_err(|source| store_error(path, "read", source))
}

/// Number of runs in the store.
///
/// # Errors
/// The file is damaged, foreign, newer, or cannot be read.
pub fn count_runs(path: &Path) -> Result<usize, Error> {
    let Some(connection) = open_existing(path)? else {
        return Ok(0);
    };
    connection
        .query_row("SELECT COUNT(*) FROM runs", [], |row| row.get::<_, i64>(0))
        .map(|count| count as usize)
        .map_err(|source| store_error(path, "read", source))
}

/// Adds a run in one transaction.
///
/// # Errors
/// The file is damaged, foreign, newer, or cannot be written; then it is as it
/// was before.
pub fn write_run(path: &Path, run: &RunRecord) -> Result<(), Error> {
    write(path, &|transaction| insert_run(transaction, run))
}

/// Adds results and documents that belong to no run yet, in one transaction.
///
/// # Errors
/// Those of [`write_run`].
pub(crate) fn write_results(path: &Path, records: &RunRecord) -> Result<(), Error> {
    write(path, &|transaction| {
        let mut results = records.results.iter();
        results.try_for_each(|(key, result)| insert_result(transaction, key, result))?;
        let mut documents = records.documents.iter();
        documents.try_for_each(|document| insert_document(transaction, document))
    })
}

/// Adds a document that belongs to no run, in one transaction.
///
/// # Errors
/// Those of [`write_run`].
pub fn write_document(path: &Path, record: &DocumentRecord) -> Result<(), Error> {
    write(path, &|transaction| insert_document(transaction, record))
}

/// What a transaction adds.
type Fill<'a> = dyn Fn(&Transaction) -> rusqlite::Result<()> + 'a;

fn write(path: &Path, fill: &Fill) -> Result<(), Error> {
    let new = !path.exists();
    let written = write_into(path, fill);
    // What a full disk leaves of a new store holds nothing.
    if written.is_err() && new && path.metadata().is_ok_and(|own| own.len() == 0) {
        discard(path);
    }
    written?;
    note_written(path);
    Ok(())
}

fn write_into(path: &Path, fill: &Fill) -> Result<(), Error> {
    let failed = |source| store_error(path, "write", source);
    drop(open_existing(path)?);
    let mut connection = Connection::open(path).map_err(failed)?;
    connection.busy_timeout(PATIENCE).map_err(failed)?;
    for (name, value) in WRITING {
        connection
            .pragma_update(None, name, value)
            .map_err(failed)?;
    }
    let transaction = connection
        .transaction_with_behavior(rusqlite::TransactionBehavior::Immediate)
        .map_err(failed)?;
    create_schema(&transaction).map_err(failed)?;
    fill(&transaction).map_err(failed)?;
    transaction.commit().map_err(failed)
}

fn insert_run(transaction: &Transaction, run: &RunRecord) -> rusqlite::Result<()> {
    execute(
        transaction,
        "INSERT INTO runs (time, windfall, options) VALUES (?1, ?2, ?3)",
        params![run.time, run.windfall, run.options],
    )?;
    let id = transaction.last_insert_rowid();
    for (path, sha256) in &run.inputs {
        execute(
            transaction,
            "INSERT OR IGNORE INTO inputs (run, path, sha256) VALUES (?1, ?2, ?3)",
            params![id, path, sha256],
        )?;
    }
    for (position, (key, result)) in run.results.iter().enumerate() {
        if !run.saved.contains(key) {
            insert_result(transaction, key, result)?;
        }
        execute(
            transaction,
            "INSERT INTO run_results (run, position, key) VALUES (?1, ?2, ?3)",
            params![id, position as i64, key],
        )?;
    }
    for (position, document) in run.documents.iter().enumerate() {
        if !run.saved.contains(&document.key) {
            insert_document(transaction, document)?;
        }
        execute(
            transaction,
            "INSERT INTO run_documents (run, position, key) VALUES (?1, ?2, ?3)",
            params![id, position as i64, document.key],
        )?;
    }
    for (position, failure) in run.failures.iter().enumerate() {
        execute(
            transaction,
            "INSERT INTO failures (run, position, impact, specimen, file, law, message) \
             VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7)",
            params![
                id,
                position as i64,
                failure.id,
                failure.specimen,
                failure.file,
                failure.law,
                failure.message
            ],
        )?;
    }
    Ok(())
}

/// Adds a result unless an earlier run has added it.
fn insert_result(
    transaction: &Transaction,
    key: &str,
    result: &ImpactOutcome,
) -> rusqlite::Result<()> {
    let document = serde_json::to_string(result)
        .map_err(|error| rusqlite::Error::ToSqlConversionFailure(Box::new(error)))?;
    let sha256 = document_digest(key, &document);
    let added = execute(
        transaction,
        "INSERT OR IGNORE INTO results \
         (key, impact, specimen, file, law, cost, samples, converged, document, sha256) \
         VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8, ?9, ?10)",
        params![
            key,
            result.id,
            result.specimen,
            result.file,
            result.law.as_str(),
            result.cost,
            result.samples as i64,
            result.converged,
            document,
            sha256
        ],
    )?;
    if added == 0 {
        return mend_document(transaction, "results", (key, &document, &sha256));
    }
    for (position, (name, estimate)) in result.parameters.0.iter().enumerate() {
        execute(
            transaction,
            "INSERT INTO parameters (key, position, name, value, sd, low, high, unit) \
             VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8)",
            params![
                key,
                position as i64,
                name.as_str(),
                estimate.value,
                estimate.sd,
                estimate.low,
                estimate.high,
                estimate.unit.as_str()
            ],
        )?;
    }
    for (name, value) in &result.derived.0 {
        let from = result.derived_from.get(name).map_or("", Name::as_str);
        execute(
            transaction,
            "INSERT INTO derived (key, name, value, value_from) VALUES (?1, ?2, ?3, ?4)",
            params![key, name.as_str(), value, from],
        )?;
    }
    for (position, finding) in result.findings.iter().enumerate() {
        execute(
            transaction,
            "INSERT INTO findings (key, position, code, message) VALUES (?1, ?2, ?3, ?4)",
            params![key, position as i64, finding.code.as_str(), finding.message],
        )?;
    }
    Ok(())
}

fn read_latest(connection: &Connection) -> rusqlite::Result<Option<RunIdentity>> {
    let newest = connection
        .query_row(
            "SELECT id, time FROM runs ORDER BY id DESC LIMIT 1",
            [],
            |row| Ok((row.get::<_, i64>(0)?, row.get::<_, String>(1)?)),
        )
        .optional()?;
    let Some((id, time)) = newest else {
        return Ok(None);
    };
    let mut query =
        connection.prepare("SELECT key FROM run_results WHERE run = ?1 ORDER BY position")?;
    let mut keys: Vec<String> = query
        .query_map([id], |row| row.get(0))?
        .collect::<Result<_, _>>()?;
    keys.extend(document_keys(connection, id)?);
    let mut query = connection.prepare(
        "SELECT impact, specimen, file, law, message FROM failures WHERE run = ?1 ORDER BY position",
    )?;
    let failures = query
        .query_map([id], |row| {
            Ok(FailureOutcome {
                id: row.get(0)?,
                specimen: row.get(1)?,
                file: row.get(2)?,
                law: row.get(3)?,
                message: row.get(4)?,
                findings: Vec::new(),
            })
        })?
        .collect::<Result<_, _>>()?;
    Ok(Some(RunIdentity {
        time,
        keys,
        failures,
    }))
}

#[cfg(test)]
mod tests {
    use super::*;
    use windfall_files::found::{EstimateOutcome, FindingOutcome};
    use windfall_files::named::Named;

    fn outcome(id: &str) -> ImpactOutcome {
        let estimate = EstimateOutcome {
            value: 0.1 + 0.2,
            sd: Some(1e-300),
            low: Some(-0.0),
            high: None,
            unit: "N/m^1.5".into(),
            held: false,
        };
        ImpactOutcome {
            id: id.to_owned(),
            specimen: "s".to_owned(),
            group: None,
            file: "r.csv".to_owned(),
            law: "kuwabara-kono".into(),
            quantities: vec!["force".into()],
            parameters: Named::of([("k", estimate.clone()), ("c", estimate)]),
            nuisances: Named::default(),
            correlations: Named::default(),
            cost: 2.0 / 3.0,
            samples: 1111,
            evaluations: 5,
            converged: true,
            residual_norm: 0.8,
            residuals: Named::default(),
            regression: Named::default(),
            derived: Named::of([("restitution", Some(0.47))]),
            derived_sd: Named::default(),
            derived_from: Named::of([("restitution", "signal".into())]),
            fitted: Named::default(),
            directions: Vec::new(),
            common: Named::default(),
            intervals: crate::result::interval_outcome::IntervalOutcome::default(),
            findings: vec![FindingOutcome::new("x", "y")],
            left_out: Vec::new(),
        }
    }

    fn run(ids: &[&str]) -> RunRecord<'static> {
        RunRecord {
            time: "2026-11-20T00:00:00Z".to_owned(),
            windfall: "0.1.0".to_owned(),
            options: "{}".to_owned(),
            inputs: vec![("r.csv".to_owned(), "00".to_owned())],
            results: ids
                .iter()
                .map(|id| (format!("key-{id}"), &*Box::leak(Box::new(outcome(id)))))
                .collect(),
            documents: Vec::new(),
            failures: Vec::new(),
            saved: HashSet::new(),
        }
    }

    fn keys(ids: &[&str]) -> Vec<String> {
        ids.iter().map(|id| format!("key-{id}")).collect()
    }

    #[test]
    fn conserves_every_bit_of_a_result() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("results.sqlite");
        assert_eq!(find_results(&path, &keys(&["a"])).unwrap(), [None]);
        write_run(&path, &run(&["a", "b"])).unwrap();
        let found = find_results(&path, &keys(&["b", "c"])).unwrap();
        assert_eq!(found, [Some(outcome("b")), None]);
        assert_eq!(latest_run(&path).unwrap().unwrap().keys, keys(&["a", "b"]));
    }

    #[test]
    fn rejects_a_result_that_is_not_what_was_written_and_mends_it() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("results.sqlite");
        write_run(&path, &run(&["a", "b"])).unwrap();
        let change = "UPDATE results SET document = replace(document, '1111', '1112')";
        let connection = Connection::open(&path).unwrap();
        let changed = connection.execute(&format!("{change} WHERE impact = 'a'"), []);
        assert_eq!(changed.unwrap(), 1);
        drop(connection);
        let error = find_results(&path, &keys(&["a"])).unwrap_err().to_string();
        assert!(
            error.contains("result of a is not what was written"),
            "{error}"
        );
        assert_eq!(
            find_results(&path, &keys(&["b"])).unwrap(),
            [Some(outcome("b"))]
        );
        write_run(&path, &run(&["a"])).unwrap();
        assert_eq!(
            find_results(&path, &keys(&["a"])).unwrap(),
            [Some(outcome("a"))]
        );
    }

    #[test]
    fn conserves_earlier_results_when_a_run_is_cut_off() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("results.sqlite");
        write_run(&path, &run(&["a"])).unwrap();
        // Half of a second run, never committed: what a kill leaves behind.
        let mut connection = Connection::open(&path).unwrap();
        let transaction = connection.transaction().unwrap();
        transaction.execute("DELETE FROM runs", []).unwrap_err();
        insert_run(&transaction, &run(&["b", "c"])).unwrap();
        drop(transaction);
        drop(connection);
        assert_eq!(count_runs(&path).unwrap(), 1);
        assert_eq!(
            find_results(&path, &keys(&["a", "b"])).unwrap(),
            [Some(outcome("a")), None]
        );
    }

    #[test]
    fn conserves_earlier_results_beside_a_hot_journal() {
        let dir = tempfile::tempdir().unwrap();
        let (path, copy) = (
            dir.path().join("results.sqlite"),
            dir.path().join("copy.sqlite"),
        );
        write_run(&path, &run(&["a"])).unwrap();
        let mut connection = Connection::open(&path).unwrap();
        // A cache of one page spills unfinished pages into the file itself.
        connection.pragma_update(None, "cache_size", 1).unwrap();
        let transaction = connection.transaction().unwrap();
        let ids: Vec<String> = (0..500).map(|i| format!("n{i}")).collect();
        let ids: Vec<&str> = ids.iter().map(String::as_str).collect();
        insert_run(&transaction, &run(&ids)).unwrap();
        // The files as a power cut would leave them.
        std::fs::copy(&path, &copy).unwrap();
        let journal = dir.path().join("results.sqlite-journal");
        assert!(std::fs::metadata(&journal).unwrap().len() > 0);
        assert!(
            std::fs::metadata(&copy).unwrap().len() > 200_000,
            "pages were spilt"
        );
        std::fs::copy(&journal, dir.path().join("copy.sqlite-journal")).unwrap();
        assert_eq!(count_runs(&copy).unwrap(), 1);
        assert_eq!(
            find_results(&copy, &keys(&["a", "n0"])).unwrap(),
            [Some(outcome("a")), None]
        );
    }

    #[test]
    fn rejects_foreign_damaged_and_newer_files_and_leaves_them_alone() {
        let dir = tempfile::tempdir().unwrap();
        let check = |name: &str, expected: &str| {
            let path = dir.path().join(name);
            let before = std::fs::read(&path).unwrap();
            let error = write_run(&path, &run(&["a"])).unwrap_err().to_string();
            assert!(error.contains(expected), "{error}");
            assert_eq!(std::fs::read(&path).unwrap(), before, "{name} was changed");
        };
        std::fs::write(
            dir.path().join("text"),
            "this is no database, but long enough to look like one".repeat(20),
        )
        .unwrap();
        check(
            "text",
            "the results file is damaged or not a database (file is not a database); nothing was written",
        );

        let foreign = Connection::open(dir.path().join("foreign")).unwrap();
        foreign
            .execute_batch("PRAGMA application_id = 7; CREATE TABLE t (x)")
            .unwrap();
        drop(foreign);
        check(
            "foreign",
            "this is a database of another program (application id 7); nothing was written",
        );

        let newer = dir.path().join("newer");
        write_run(&newer, &run(&["a"])).unwrap();
        Connection::open(&newer)
            .unwrap()
            .pragma_update(None, "user_version", 99)
            .unwrap();
        check(
            "newer",
            "these results were written by a newer windfall (store version 99, this one knows 3)",
        );

        let cut = dir.path().join("cut");
        write_run(&cut, &run(&["a"])).unwrap();
        let bytes = std::fs::read(&cut).unwrap();
        std::fs::write(&cut, &bytes[..bytes.len() / 2]).unwrap();
        check("cut", "the results file is damaged or not a database");
    }
}
