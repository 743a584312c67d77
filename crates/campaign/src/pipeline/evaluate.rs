//! Every recording of a campaign evaluated on all cores: results go into the store, and
//! a recording that fails does not stop the others.

use crate::pipeline::request::{PENDING, Reuse};
use crate::recording::digests::{Digests, recording_digests, run_origin};
use crate::recording::read::recording_path;
use crate::result::outcome::{ImpactOutcome, StatusOutcome};
use crate::settings::kind::STORE_FILE;
use crate::settings::model::{Campaign, ImpactEntry};
use crate::store::documents::{DocumentRecord, StoredValue, find_documents};
use crate::store::error::StoreError;
use crate::store::runs::{RunRecord, find_results, latest_run, write_run};
use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::{Map, Value};
use std::borrow::Cow;
use std::collections::BTreeMap;
use std::path::Path;
use windfall_files::error::Error;
use windfall_files::found::FailureOutcome;
use windfall_files::progress::{Progress, for_each};

/// How the recordings of a campaign are evaluated.
///
/// An entry of impacts.csv has one or several results, its parts: one for each law.
pub trait Evaluation: Sync {
    /// What is found in one part.
    type Found: Stored;

    /// The campaign.
    fn campaign(&self) -> &Campaign;

    /// Number of parts of every entry.
    fn parts(&self) -> usize {
        1
    }

    /// Digest of everything that the result of a part depends on.
    ///
    /// * `recording`: SHA-256 of the recording
    fn key(&self, entry: &ImpactEntry, part: usize, recording: &str) -> String;

    /// Results of all parts of an entry; those that are `known` need no work.
    fn evaluate(
        &self,
        entry: &ImpactEntry,
        known: Vec<Option<Self::Found>>,
    ) -> Vec<Result<Self::Found, FailureOutcome>>;

    /// Options that the run keeps beside campaign.toml.
    fn options(&self) -> Map<String, Value> {
        Map::new()
    }
}

/// A result that the store keeps under a key.
pub trait Stored: Clone + Send + Sync {
    /// Results of earlier runs under some keys, `None` where there is none.
    ///
    /// # Errors
    /// The store is damaged, foreign, newer, or cannot be read.
    fn find(store: &Path, keys: &[String]) -> Result<Vec<Option<Self>>, Error>;

    /// Adds the result to a run.
    ///
    /// # Errors
    /// The result cannot be written.
    fn add<'a>(
        &'a self,
        run: &mut RunRecord<'a>,
        campaign: &Campaign,
        entry: &ImpactEntry,
        key: String,
    ) -> Result<(), Error>;
}

/// A result on one recording that is kept as a JSON document.
pub trait Document: Clone + Send + Sync + Serialize + DeserializeOwned {
    /// Its numbers, for people with a database browser.
    fn values(&self) -> Vec<StoredValue>;
}

impl Stored for ImpactOutcome {
    fn find(store: &Path, keys: &[String]) -> Result<Vec<Option<Self>>, Error> {
        find_results(store, keys)
    }

    fn add<'a>(
        &'a self,
        run: &mut RunRecord<'a>,
        _: &Campaign,
        _: &ImpactEntry,
        key: String,
    ) -> Result<(), Error> {
        run.results.push((key, Cow::Borrowed(self)));
        Ok(())
    }
}

impl<T: Document> Stored for T {
    fn find(store: &Path, keys: &[String]) -> Result<Vec<Option<Self>>, Error> {
        let read = |text: String| {
            let damaged = |error| format!("a result cannot be read: {error}");
            serde_json::from_str(&text)
                .map_err(|error: serde_json::Error| StoreError::damaged(store, damaged(error)))
        };
        let found = find_documents(store, keys)?;
        found.into_iter().map(|t| t.map(read).transpose()).collect()
    }

    fn add<'a>(
        &'a self,
        run: &mut RunRecord<'a>,
        campaign: &Campaign,
        entry: &ImpactEntry,
        key: String,
    ) -> Result<(), Error> {
        let document =
            serde_json::to_string(self).map_err(|error| Error::unwritable(&entry.id, error))?;
        run.documents.push(DocumentRecord {
            key,
            kind: campaign.kind.name().to_owned(),
            item: entry.id.clone(),
            specimen: entry.specimen.clone(),
            file: entry.file.clone(),
            document,
            values: self.values(),
        });
        Ok(())
    }
}

/// Results of a campaign.
#[derive(Clone, Debug)]
pub struct Evaluated<T> {
    /// Position in the campaign's entries, and result, in their order.
    pub items: Vec<(usize, T)>,
    /// What could not be evaluated.
    pub failed: Vec<FailureOutcome>,
    /// How the results came about.
    pub status: StatusOutcome,
    /// SHA-256 of the recordings.
    pub digests: Digests,
}

/// Evaluates every recording of a campaign and keeps the results in its store.
///
/// * `reuse`: what becomes of results in the store; nothing is read, digested or kept
///   without one (`None`), for a recording that belongs to no campaign
///
/// What has not changed is answered from the store. A recording that cannot be
/// used is reported and does not stop the others. Results do not depend on the
/// number of threads.
///
/// # Errors
/// The store cannot be used, or `progress` stopped the work.
pub fn evaluate<E: Evaluation>(
    evaluation: &E,
    reuse: Option<Reuse>,
    progress: Progress,
) -> Result<Evaluated<E::Found>, Error> {
    let campaign = evaluation.campaign();
    let store = campaign.directory.join(STORE_FILE);
    let digests = match reuse {
        Some(_) => recording_digests(&campaign.directory, &campaign.files, &campaign.entries),
        None => Digests::new(),
    };
    let keys: Vec<Result<Vec<String>, String>> = campaign
        .entries
        .iter()
        .map(
            |entry| match digests.get(&recording_path(&campaign.files, entry)) {
                None => Ok(vec![String::new(); evaluation.parts()]),
                Some(Err(problem)) => Err(problem.clone()),
                Some(Ok(digest)) => {
                    let key = |part| evaluation.key(entry, part, digest);
                    Ok((0..evaluation.parts()).map(key).collect())
                }
            },
        )
        .collect();
    let stored = match reuse {
        Some(reuse) => stored_results::<E::Found>(&store, reuse, &keys)?,
        None => BTreeMap::new(),
    };
    let results = for_each(progress, campaign.entries.len(), |position| {
        let entry = &campaign.entries[position];
        let keys = match &keys[position] {
            Ok(keys) => keys,
            Err(problem) => return vec![Err(failure(entry, None, problem.clone()))],
        };
        let known: Vec<_> = keys.iter().map(|key| stored.get(key).cloned()).collect();
        match reuse {
            Some(Reuse::Only) => {
                let pending = || failure(entry, None, PENDING.to_owned());
                known
                    .into_iter()
                    .map(|found| found.ok_or_else(pending))
                    .collect()
            }
            _ => evaluation.evaluate(entry, known),
        }
    })?;

    let mut evaluated = Evaluated {
        items: Vec::with_capacity(results.len() * evaluation.parts()),
        failed: Vec::new(),
        status: StatusOutcome::default(),
        digests,
    };
    let mut kept = Vec::new();
    for (position, results) in results.into_iter().enumerate() {
        for (part, result) in results.into_iter().enumerate() {
            match result {
                Ok(item) => {
                    let key = keys[position].as_ref().map_or("", |keys| &keys[part]);
                    match stored.contains_key(key) {
                        true => evaluated.status.stored += 1,
                        false => evaluated.status.fitted += 1,
                    }
                    kept.push(key.to_owned());
                    evaluated.items.push((position, item));
                }
                // A recording that cannot be read is one failure, not one for each part.
                Err(failure) if evaluated.failed.contains(&failure) => {}
                Err(failure) => evaluated.failed.push(failure),
            }
        }
    }
    evaluated.status.failed = evaluated.failed.len();
    match reuse {
        None | Some(Reuse::Only) => {}
        Some(_) => keep(evaluation, &store, kept, &mut evaluated)?,
    }
    Ok(evaluated)
}

/// An entry, or one law on it, that could not be evaluated.
pub fn failure(entry: &ImpactEntry, law: Option<&str>, message: String) -> FailureOutcome {
    FailureOutcome {
        id: entry.id.clone(),
        specimen: entry.specimen.clone(),
        file: entry.file.clone(),
        law: law.map(str::to_owned),
        message,
    }
}

/// Results in the store by their keys.
fn stored_results<T: Stored>(
    store: &Path,
    reuse: Reuse,
    keys: &[Result<Vec<String>, String>],
) -> Result<BTreeMap<String, T>, Error> {
    if reuse == Reuse::Nothing {
        // Fails before the work, not after it, on a store that cannot be written.
        latest_run(store)?;
        return Ok(BTreeMap::new());
    }
    let keys: Vec<String> = keys.iter().flatten().flatten().cloned().collect();
    let found = T::find(store, &keys)?;
    let known = keys.into_iter().zip(found);
    Ok(known
        .filter_map(|(key, found)| Some((key, found?)))
        .collect())
}

/// Writes the run, unless the newest one in the store is the same.
///
/// * `keys`: of the results, in their order
fn keep<E: Evaluation>(
    evaluation: &E,
    store: &Path,
    keys: Vec<String>,
    evaluated: &mut Evaluated<E::Found>,
) -> Result<(), Error> {
    // A run of nothing but failures is reported, not kept.
    if keys.is_empty() {
        return Ok(());
    }
    let same =
        latest_run(store)?.is_some_and(|run| run.keys == keys && run.failures == evaluated.failed);
    if same && evaluated.status.fitted == 0 {
        evaluated.status.up_to_date = true;
        return Ok(());
    }
    let campaign = evaluation.campaign();
    let origin = run_origin(campaign, &evaluated.digests, evaluation.options())?;
    let mut run = RunRecord::new(origin, evaluated.failed.clone());
    for ((position, item), key) in evaluated.items.iter().zip(keys) {
        item.add(&mut run, campaign, &campaign.entries[*position], key)?;
    }
    write_run(store, &run)
}
