//! Every recording of a campaign evaluated on all cores: results go into the store, and
//! a recording that fails does not stop the others.

use crate::pipeline::request::{PENDING, Reuse};
use crate::pipeline::saved_results::{Keyed, SavedResults};
use crate::recording::digests::{Digests, recording_digests, run_origin};
use crate::recording::read::recording_path;
use crate::result::outcome::{ImpactOutcome, StatusOutcome};
use crate::settings::kind::STORE_FILE;
use crate::settings::model::{Campaign, ImpactEntry};
use crate::store::documents::{DocumentRecord, StoredValue, find_documents};
use crate::store::runs::{RunRecord, find_results, latest_run, write_results, write_run};
use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::{Map, Value};
use std::collections::HashSet;
use std::mem::take;
use std::path::Path;
use std::sync::{Mutex, PoisonError};
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
    ) -> Vec<Result<Self::Found, Box<FailureOutcome>>>;

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
        run.results.push((key, self));
        Ok(())
    }
}

impl<T: Document> Stored for T {
    fn find(store: &Path, keys: &[String]) -> Result<Vec<Option<Self>>, Error> {
        find_documents(store, keys, ("documents", "item"))
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
/// number of threads. They go into the store as they come: work that is stopped goes on
/// where it was.
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
    let stored = stored_results::<E::Found>(&store, reuse, &keys)?;
    let keeps = !matches!(reuse, None | Some(Reuse::Only));
    let saved = SavedResults::new(|found: &[Keyed<E::Found>]| write_found(campaign, &store, found));
    let results = for_each(progress, campaign.entries.len(), |position| {
        if saved.failed() {
            return Vec::new();
        }
        let entry = &campaign.entries[position];
        let keys = match &keys[position] {
            Ok(keys) => keys,
            Err(problem) => return vec![(false, Err(failure(entry, None, problem.clone())))],
        };
        let mut known = match stored.get(position) {
            Some(own) => take(&mut *own.lock().unwrap_or_else(PoisonError::into_inner)),
            None => Vec::new(),
        };
        known.resize_with(keys.len(), || None);
        let was_known: Vec<bool> = known.iter().map(Option::is_some).collect();
        let results = match reuse {
            Some(Reuse::Only) => {
                let pending = || failure(entry, None, PENDING.to_owned());
                known
                    .into_iter()
                    .map(|found| found.ok_or_else(pending))
                    .collect()
            }
            _ => evaluation.evaluate(entry, known),
        };
        for ((was_known, result), key) in was_known.iter().zip(&results).zip(keys) {
            if let (true, false, Ok(found)) = (keeps, was_known, result) {
                saved.add(position, key, found);
            }
        }
        was_known.into_iter().zip(results).collect()
    });
    let saved = saved.finish(results.is_err())?;
    let results = results?;

    let mut evaluated = Evaluated {
        items: Vec::with_capacity(results.len() * evaluation.parts()),
        failed: Vec::new(),
        status: StatusOutcome::default(),
        digests,
    };
    let mut kept = Vec::new();
    for (position, (results, keys)) in results.into_iter().zip(keys).enumerate() {
        // A recording without a digest has no keys, and one failure.
        let mut keys = keys.unwrap_or_default().into_iter();
        for (was_known, result) in results {
            let key = keys.next().unwrap_or_default();
            match result {
                Ok(item) => {
                    match was_known {
                        true => evaluated.status.stored += 1,
                        false => evaluated.status.fitted += 1,
                    }
                    kept.push(key);
                    evaluated.items.push((position, item));
                }
                // A recording that cannot be read is one failure, not one for each part.
                Err(failure) if evaluated.failed.contains(&failure) => {}
                Err(failure) => evaluated.failed.push(*failure),
            }
        }
    }
    evaluated.status.failed = evaluated.failed.len();
    if keeps {
        keep(evaluation, &store, (kept, saved), &mut evaluated)?;
    }
    Ok(evaluated)
}

/// Writes results that belong to no run yet.
fn write_found<T: Stored>(
    campaign: &Campaign,
    store: &Path,
    found: &[Keyed<T>],
) -> Result<(), Error> {
    let mut records = RunRecord::unfinished();
    for (position, key, found) in found {
        let entry = &campaign.entries[*position];
        found.add(&mut records, campaign, entry, key.clone())?;
    }
    write_results(store, &records)
}

/// An entry, or one law on it, that could not be evaluated.
pub fn failure(entry: &ImpactEntry, law: Option<&str>, message: String) -> Box<FailureOutcome> {
    Box::new(FailureOutcome {
        id: entry.id.clone(),
        specimen: entry.specimen.clone(),
        file: entry.file.clone(),
        law: law.map(str::to_owned),
        message,
        findings: Vec::new(),
    })
}

/// Results in the store, of all parts of each entry; nothing where all are to be made anew.
///
/// Each is taken out where it is used: of a result there is one copy.
fn stored_results<T: Stored>(
    store: &Path,
    reuse: Option<Reuse>,
    keys: &[Result<Vec<String>, String>],
) -> Result<Vec<Mutex<Vec<Option<T>>>>, Error> {
    match reuse {
        None => return Ok(Vec::new()),
        Some(Reuse::Nothing) => {
            // Fails before the work, not after it, on a store that cannot be written.
            latest_run(store)?;
            return Ok(Vec::new());
        }
        Some(_) => {}
    }
    let all: Vec<String> = keys.iter().flatten().flatten().cloned().collect();
    let mut found = T::find(store, &all)?.into_iter();
    let parts = keys.iter().map(|own| own.as_ref().map_or(0, Vec::len));
    Ok(parts
        .map(|parts| Mutex::new(found.by_ref().take(parts).collect()))
        .collect())
}

/// Writes the run, unless the newest one in the store is the same.
///
/// * `keys`: of the results, in their order; and those that are in the store since this work began
fn keep<E: Evaluation>(
    evaluation: &E,
    store: &Path,
    (keys, saved): (Vec<String>, HashSet<String>),
    evaluated: &mut Evaluated<E::Found>,
) -> Result<(), Error> {
    // A run of nothing but failures is reported, not kept.
    if keys.is_empty() {
        return Ok(());
    }
    let failed: Vec<FailureOutcome> = evaluated.failed.iter().map(FailureOutcome::bare).collect();
    let same = latest_run(store)?.is_some_and(|run| run.keys == keys && run.failures == failed);
    if same && evaluated.status.fitted == 0 {
        evaluated.status.up_to_date = true;
        return Ok(());
    }
    let campaign = evaluation.campaign();
    let origin = run_origin(campaign, &evaluated.digests, evaluation.options())?;
    let mut run = RunRecord::new(origin, failed);
    run.saved = saved;
    for ((position, item), key) in evaluated.items.iter().zip(keys) {
        item.add(&mut run, campaign, &campaign.entries[*position], key)?;
    }
    write_run(store, &run)
}
