//! `windfall fit DIR` of a campaign that fits no impacts, and what its report shows.

use crate::kind::{MeasuredResults, Measurement};
use crate::measured::MeasuredOutcome;
use itertools::Itertools;
use serde_json::json;
use std::path::Path;
use windfall_campaign::pipeline::evaluate::{Evaluated, Evaluation, evaluate, failure};
use windfall_campaign::pipeline::request::{FitRequest, Reuse};
use windfall_campaign::recording::digests::Digests;
use windfall_campaign::recording::read::read_recording;
use windfall_campaign::result::counted::excluded;
use windfall_campaign::result::outcome::StatusOutcome;
use windfall_campaign::settings::files::fill_placeholders;
use windfall_campaign::settings::model::{Campaign, ImpactEntry, TimePlan};
use windfall_draw::files::{NamedFigure, write_figure, write_figures};
use windfall_files::error::Error;
use windfall_files::found::FailureOutcome;
use windfall_files::named::grouped;
use windfall_files::on_threads::on_threads;
use windfall_files::option_value::unusable;
use windfall_files::progress::{Progress, quiet};
use windfall_files::provenance::{REVISION, VERSION, digest_text};

/// Recordings that a report shows one by one, at most, besides one of each group.
const SHOWN: usize = 6;

/// Recordings of a measurement, as the pipeline evaluates them.
struct Recordings<'a, K>(&'a K);

impl<K: Measurement> Evaluation for Recordings<'_, K> {
    type Found = K::Found;

    fn campaign(&self) -> &Campaign {
        self.0.shared()
    }

    fn key(&self, entry: &ImpactEntry, _: usize, recording: &str) -> String {
        let campaign = self.0.shared();
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
            "recording": recording,
            "item": [entry.id, entry.specimen, entry.file],
            "range": format!("{:?} {:?}", entry.from, entry.to),
            "open": format!("{:?}", campaign.files.open),
            "time": format!("{time} {:?}", campaign.files.time_scale),
            "channels": channels,
            "depends_on": self.0.depends_on(entry),
        });
        digest_text(&everything.to_string())
    }

    fn evaluate(
        &self,
        entry: &ImpactEntry,
        known: Vec<Option<K::Found>>,
    ) -> Vec<Result<K::Found, Box<FailureOutcome>>> {
        if let Some(reason) = excluded(entry) {
            return vec![Err(failure(entry, None, reason.message)); known.len()];
        }
        let work = || {
            read_recording(&self.0.shared().files, entry)
                .and_then(|recording| self.0.evaluate(entry, &recording))
                .map_err(|error| failure(entry, None, error.to_string()))
        };
        let known = known.into_iter();
        known.map(|found| found.map_or_else(work, Ok)).collect()
    }
}

/// Evaluates the recordings of a campaign; what has not changed is answered from its store.
///
/// # Errors
/// The store cannot be used, or `progress` stopped the work.
pub fn measure_recordings<K: Measurement>(
    campaign: &K,
    reuse: Reuse,
    progress: Progress,
) -> Result<Evaluated<K::Found>, Error> {
    evaluate(&Recordings(campaign), Some(reuse), progress)
}

/// Evaluates a campaign and keeps the results in its store.
///
/// # Errors
/// The campaign or the request is wrong, or the store cannot be used.
pub fn measure_campaign<K: Measurement>(
    directory: &Path,
    request: &FitRequest,
    progress: Progress,
) -> Result<MeasuredOutcome, Error> {
    let campaign: K = requested(directory, request)?;
    on_threads(request.threads, || {
        let measured = Measured::of(campaign, request.reuse, progress)?;
        if let Some(folder) = &request.figures {
            if let Some((_, figures)) = &measured.results.figures {
                write_figures(folder, &figures.iter().collect::<Vec<_>>())?;
            }
            for entry in &measured.campaign.shared().entries {
                if let Some(named) = measured.figure(entry)? {
                    write_figure(folder, &named.name, &named.figure)?;
                }
            }
        }
        Ok(measured.into_outcome())
    })
}

/// A measured campaign with what its report says and shows.
#[derive(Clone, Debug)]
pub struct ReportedItems {
    /// The campaign.
    pub campaign: Campaign,
    /// Digests of its recordings.
    pub digests: Digests,
    /// Results.
    pub outcome: MeasuredOutcome,
    /// Paragraphs that say how the results came about.
    pub methods: Vec<String>,
    /// Figures of the whole, or of some recordings.
    pub figures: Vec<NamedFigure>,
    /// Which recordings the figures show.
    pub shown: String,
}

/// [`measure_campaign`], with what a report says and shows of it.
///
/// # Errors
/// As [`measure_campaign`].
pub fn reported_campaign<K: Measurement>(
    directory: &Path,
    request: &FitRequest,
    progress: Progress,
) -> Result<ReportedItems, Error> {
    let campaign: K = requested(directory, request)?;
    on_threads(request.threads, || {
        let measured = Measured::of(campaign, request.reuse, progress)?;
        let shown = measured.shown_entries();
        Ok(ReportedItems {
            campaign: measured.campaign.shared().clone(),
            digests: measured.evaluated.digests.clone(),
            methods: measured.campaign.methods(),
            figures: measured.figures(&shown)?,
            shown: measured.shown_words(shown.len()),
            outcome: measured.into_outcome(),
        })
    })
}

/// Figures of the whole of what the store holds, of kinds that draw it. Nothing is
/// evaluated anew or written.
///
/// # Errors
/// The campaign or its store cannot be read.
pub fn stored_figures<K: Measurement>(directory: &Path) -> Result<Vec<NamedFigure>, Error> {
    let measured = Measured::of(K::read(directory)?, Reuse::Only, &quiet)?;
    Ok(measured.results.figures.map_or_else(Vec::new, |own| own.1))
}

/// What the store holds of one recording.
#[derive(Clone, Debug)]
pub struct StoredItem {
    /// Results on it and on the others of its specimen.
    pub outcome: MeasuredOutcome,
    /// Its figure, where its kind draws single recordings.
    pub figure: Option<NamedFigure>,
}

/// What the store holds of one recording. Nothing is evaluated anew or written.
///
/// # Errors
/// The campaign or its store cannot be read, or it has no such recording.
pub fn stored_item<K: Measurement>(directory: &Path, id: &str) -> Result<StoredItem, Error> {
    let mut campaign = K::read(directory)?;
    let entries = &mut campaign.shared_mut().entries;
    let entry = entries.iter().find(|entry| entry.id == id).cloned();
    let entry = entry.ok_or_else(|| unusable(id.to_owned(), "is no id in impacts.csv"))?;
    // All taps of a fruit say which of their resonances is its first mode.
    entries.retain(|other| other.specimen == entry.specimen);
    let measured = Measured::of(campaign, Reuse::Only, &quiet)?;
    Ok(StoredItem {
        figure: measured.figure(&entry)?,
        outcome: measured.into_outcome(),
    })
}

/// A campaign with its settings overridden by the options.
fn requested<K: Measurement>(directory: &Path, request: &FitRequest) -> Result<K, Error> {
    let mut campaign = K::read(directory)?;
    campaign.apply(request)?;
    request.check_outputs()?;
    Ok(campaign)
}

/// An evaluated campaign.
struct Measured<K: Measurement> {
    campaign: K,
    evaluated: Evaluated<K::Found>,
    results: MeasuredResults,
}

impl<K: Measurement> Measured<K> {
    fn of(campaign: K, reuse: Reuse, progress: Progress) -> Result<Self, Error> {
        let evaluated = measure_recordings(&campaign, reuse, progress)?;
        let results = campaign.results(&evaluated.items)?;
        Ok(Self {
            campaign,
            evaluated,
            results,
        })
    }

    /// The figure of an entry.
    fn figure(&self, entry: &ImpactEntry) -> Result<Option<NamedFigure>, Error> {
        let all = &self.campaign.shared().entries;
        let mut items = self.evaluated.items.iter();
        let own = items.find(|(position, _)| all[*position].id == entry.id);
        let found = own.map(|(_, found)| found);
        self.campaign.figure(entry, found, &self.results)
    }

    /// Figures of the whole where the kind draws those, and otherwise of some entries.
    fn figures(&self, entries: &[&ImpactEntry]) -> Result<Vec<NamedFigure>, Error> {
        if let Some((_, figures)) = &self.results.figures {
            return Ok(figures.clone());
        }
        let figures = entries.iter().map(|entry| self.figure(entry).transpose());
        figures.flatten().collect()
    }

    /// Recordings for a report: the middle one of each group, and some evenly over the table.
    fn shown_entries(&self) -> Vec<&ImpactEntry> {
        let campaign = self.campaign.shared();
        let items = self.evaluated.items.iter();
        let entries: Vec<&ImpactEntry> = items.map(|(p, _)| &campaign.entries[*p]).collect();
        let places = entries.iter().enumerate();
        let groups = grouped(places.map(|(place, entry)| (campaign.group_of(entry), place)));
        let most = SHOWN.min(entries.len());
        let middle = groups.iter().map(|(_, members)| members[members.len() / 2]);
        let spread = (0..most).map(|part| part * entries.len() / most);
        let chosen = middle.chain(spread).unique().take(most.max(groups.len()));
        chosen
            .sorted_unstable()
            .map(|place| entries[place])
            .collect()
    }

    /// Says which recordings the figures show.
    fn shown_words(&self, shown: usize) -> String {
        let all = self.campaign.shared().entries.len();
        match &self.results.figures {
            Some((words, _)) => words.clone(),
            None if shown == all => "Every recording.".to_owned(),
            None => format!(
                "{shown} of {all} recordings: the middle one of each group, and others spread \
                 evenly over the table. `windfall fit --figures` draws all of them."
            ),
        }
    }

    fn into_outcome(self) -> MeasuredOutcome {
        let (campaign, results) = (self.campaign.shared(), self.results);
        let failed = self.evaluated.failed.into_iter().chain(results.failed);
        let failed: Vec<FailureOutcome> = failed.collect();
        MeasuredOutcome {
            windfall: VERSION.to_owned(),
            campaign: campaign.title.clone(),
            kind: campaign.kind.name().to_owned(),
            simulated: campaign.simulated.clone(),
            note: campaign.note.clone(),
            status: StatusOutcome {
                failed: failed.len(),
                ..self.evaluated.status
            },
            impacts: results.items,
            parts: results.parts,
            failed,
            specimens: results.specimens,
            whole: results.whole,
            summary: results.summary,
            groups: results.groups,
            findings: results.findings,
            shown: K::SHOWN,
        }
    }
}
