//! Campaigns that fit no impacts: every recording evaluated on all cores, with
//! results in the store and failures that do not stop the others.

use crate::impacts::request::{PENDING, Reuse};
use crate::measure::item_campaign::ItemCampaign;
use crate::recording::digests::{Digests, campaign_text, file_digests, recording_digests};
use crate::recording::read::{read_recording, recording_path};
use crate::result::outcome::StatusOutcome;
use crate::settings::files::fill_placeholders;
use crate::settings::model::{ImpactEntry, TimePlan};
use crate::store::documents::{DocumentRecord, StoredValue, find_documents};
use crate::store::error::StoreError;
use crate::store::runs::{RunRecord, latest_run, write_run};
use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::json;
use std::path::Path;
use windfall_files::error::Error;
use windfall_files::found::FailureOutcome;
use windfall_files::progress::{Progress, for_each};
use windfall_files::provenance::{REVISION, VERSION, digest_text, time_now};
use windfall_signal::recording::Recording;

/// Result on one recording.
pub trait Document: Clone + Send + Sync + Serialize + DeserializeOwned {
    /// Its numbers, for people with a database browser.
    fn values(&self) -> Vec<StoredValue>;
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
}

/// What an evaluation consists of.
pub struct Evaluation<'a, T> {
    /// The campaign.
    pub campaign: &'a ItemCampaign,
    /// Where results are kept.
    pub store: &'a Path,
    /// What becomes of results in the store.
    pub reuse: Reuse,
    /// Everything besides recording, channels and time range that the result on
    /// an entry depends on, as text with all digits: settings, cells used.
    pub depends_on: &'a (dyn Fn(&ImpactEntry) -> String + Sync),
    /// The work.
    pub work: &'a (dyn Fn(&ImpactEntry, &Recording) -> Result<T, Error> + Sync),
}

/// Evaluates every recording of a campaign and keeps the results in its store.
///
/// What has not changed is answered from the store. A recording that cannot be
/// used is reported and does not stop the others. Results do not depend on the
/// number of threads.
///
/// # Errors
/// The store cannot be used, or `progress` stopped the work.
pub fn evaluate<T: Document>(
    evaluation: &Evaluation<T>,
    progress: Progress,
) -> Result<Evaluated<T>, Error> {
    let campaign = evaluation.campaign;
    let digests = recording_digests(&campaign.directory, &campaign.files, &campaign.entries);
    let keys: Vec<Result<String, String>> = campaign
        .entries
        .iter()
        .map(|entry| {
            let digest = &digests[&recording_path(&campaign.files, entry)];
            digest.clone().map(|d| key_of(evaluation, entry, &d))
        })
        .collect();
    let stored = stored_results(evaluation, &keys)?;

    let results = for_each(progress, campaign.entries.len(), |item| {
        let entry = &campaign.entries[item];
        match (&keys[item], &stored[item]) {
            (Err(problem), _) => Err(problem.clone()),
            (Ok(_), Some(known)) => Ok(known.clone()),
            (Ok(_), None) if evaluation.reuse == Reuse::Only => Err(PENDING.to_owned()),
            (Ok(_), None) => read_recording(&campaign.files, entry)
                .and_then(|recording| (evaluation.work)(entry, &recording))
                .map_err(|error| error.to_string()),
        }
    })?;

    let (evaluated, records) = collect(campaign, keys, &stored, results)?;
    keep(evaluation, &digests, evaluated, records)
}

/// SHA-256 over everything that the result on an entry depends on.
fn key_of<T>(evaluation: &Evaluation<T>, entry: &ImpactEntry, digest: &str) -> String {
    let campaign = evaluation.campaign;
    let filled = |text: &str| fill_placeholders(text, &entry.cells).unwrap_or_default();
    let channels: Vec<String> = campaign
        .files
        .channels
        .iter()
        .map(|plan| {
            let time = plan.time.as_deref().map(filled);
            format!("{plan:?} {:?} {time:?}", filled(&plan.column))
        })
        .collect();
    let time = match &campaign.files.time {
        TimePlan::Column(column) => filled(column),
        other => format!("{other:?}"),
    };
    let everything = json!({
        "revision": REVISION,
        "kind": campaign.kind.name(),
        "recording": digest,
        "item": [entry.id, entry.specimen, entry.file],
        "range": format!("{:?} {:?}", entry.from, entry.to),
        "open": format!("{:?}", campaign.files.open),
        "time": format!("{time} {:?}", campaign.files.time_scale),
        "channels": channels,
        "depends_on": (evaluation.depends_on)(entry),
    });
    digest_text(&everything.to_string())
}

fn stored_results<T: Document>(
    evaluation: &Evaluation<T>,
    keys: &[Result<String, String>],
) -> Result<Vec<Option<T>>, Error> {
    let known: Vec<String> = keys.iter().map(|k| k.clone().unwrap_or_default()).collect();
    // Also where nothing is reused: a store that could not be written is found
    // out before the work.
    let found = find_documents(evaluation.store, &known)?;
    if evaluation.reuse == Reuse::Nothing {
        return Ok(vec![None; keys.len()]);
    }
    let read = |text: String| {
        serde_json::from_str(&text).map_err(|error| {
            Error::from(StoreError::Damaged {
                path: evaluation.store.to_path_buf(),
                detail: format!("a result cannot be read: {error}"),
            })
        })
    };
    found.into_iter().map(|t| t.map(read).transpose()).collect()
}

fn collect<T: Document>(
    campaign: &ItemCampaign,
    keys: Vec<Result<String, String>>,
    stored: &[Option<T>],
    results: Vec<Result<T, String>>,
) -> Result<(Evaluated<T>, Vec<DocumentRecord>), Error> {
    let mut evaluated = Evaluated {
        items: Vec::new(),
        failed: Vec::new(),
        status: StatusOutcome::default(),
    };
    let mut records = Vec::new();
    for (position, (key, result)) in keys.into_iter().zip(results).enumerate() {
        let entry = &campaign.entries[position];
        match result {
            Ok(item) => {
                match stored[position].is_some() {
                    true => evaluated.status.stored += 1,
                    false => evaluated.status.fitted += 1,
                }
                records.push(record(campaign, entry, key.unwrap_or_default(), &item)?);
                evaluated.items.push((position, item));
            }
            Err(message) => evaluated.failed.push(FailureOutcome {
                id: entry.id.clone(),
                specimen: entry.specimen.clone(),
                file: entry.file.clone(),
                law: None,
                message,
            }),
        }
    }
    evaluated.status.failed = evaluated.failed.len();
    Ok((evaluated, records))
}

fn record<T: Document>(
    campaign: &ItemCampaign,
    entry: &ImpactEntry,
    key: String,
    item: &T,
) -> Result<DocumentRecord, Error> {
    let document = serde_json::to_string(item).map_err(|error| Error::ResultUnwritable {
        item: entry.id.clone(),
        detail: error.to_string(),
    })?;
    Ok(DocumentRecord {
        key,
        kind: campaign.kind.name().to_owned(),
        item: entry.id.clone(),
        specimen: entry.specimen.clone(),
        file: entry.file.clone(),
        document,
        values: item.values(),
    })
}

/// Writes the run, unless the newest one in the store is the same.
fn keep<T>(
    evaluation: &Evaluation<T>,
    digests: &Digests,
    mut evaluated: Evaluated<T>,
    records: Vec<DocumentRecord>,
) -> Result<Evaluated<T>, Error> {
    // A run of nothing but failures is told, not kept.
    if records.is_empty() || evaluation.reuse == Reuse::Only {
        return Ok(evaluated);
    }
    let keys: Vec<&String> = records.iter().map(|record| &record.key).collect();
    let same = latest_run(evaluation.store)?.is_some_and(|run| {
        run.keys.iter().eq(keys.iter().copied()) && run.failures == evaluated.failed
    });
    if same && evaluated.status.fitted == 0 {
        evaluated.status.up_to_date = true;
        return Ok(evaluated);
    }
    let campaign = evaluation.campaign;
    let options = json!({ "campaign.toml": campaign_text(&campaign.directory)? });
    let run = RunRecord {
        time: time_now(),
        windfall: VERSION.to_owned(),
        options: options.to_string(),
        seed: None,
        inputs: file_digests(&campaign.directory, digests)?,
        results: Vec::new(),
        documents: records,
        failures: evaluated.failed.clone(),
    };
    write_run(evaluation.store, &run)?;
    Ok(evaluated)
}
