//! A directory with campaigns in it, or a campaign itself: which there are, and in what
//! state.

use crate::campaign_files::CAMPAIGN_FILES;
use crate::campaign_files::file_plan_of;
use crate::campaign_view::{check_confined, name_of, names_in, view_campaign};
use itertools::Itertools;
use memchr::memmem;
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};
use windfall_campaign::pipeline::request::{FitRequest, PENDING, Reuse};
use windfall_campaign::result::outcome::ImpactOutcome;
use windfall_campaign::settings::kind::CAMPAIGN_FILE;
use windfall_campaign::settings::kind::{STORE_FILE, UNDO_FILE};
use windfall_campaign::settings::model::FilePlan;
use windfall_campaign::store::runs::{RunIdentity, latest_run};
use windfall_files::confined::path_inside;
use windfall_files::error::Error;
use windfall_files::finding_kind::FindingKind;
use windfall_files::found::FailureOutcome;
use windfall_files::option_value::unusable;
use windfall_files::progress::quiet;
use windfall_files::scratch::sweep_temporary;
use windfall_files::write_file::sweep;
use windfall_measure::any_outcome::AnyOutcome;
use windfall_report::fit_any::fit_any;

/// A directory with campaigns in it, or a campaign.
#[derive(Clone, Debug)]
pub struct Workspace {
    root: PathBuf,
    single: bool,
}

/// A campaign in a list.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct CampaignEntry {
    /// Name of its directory.
    pub id: String,
    /// Title.
    pub title: String,
    /// What it measures, where that can be read.
    pub kind: Option<&'static str>,
    /// Rows of impacts.csv.
    pub recordings: usize,
    /// Newest run in its store.
    pub run: Option<RunView>,
    /// Why it cannot be read.
    pub problem: Option<String>,
}

/// A run in a store.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct RunView {
    /// When it was; UTC.
    pub time: String,
    /// Its results.
    pub results: usize,
    /// What it could not fit.
    pub failures: usize,
}

/// How much of the results is asked for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, utoipa::ToSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Detail {
    /// All of each impact.
    #[default]
    Whole,
    /// Of each impact what tables show; what only its own view shows is empty.
    Brief,
}

/// What the store holds of a campaign as it is now.
#[derive(Clone, Debug, Serialize, utoipa::ToSchema)]
pub struct StoredResults {
    /// As `fit` gives it; `None` where nothing is stored.
    pub outcome: Option<AnyOutcome>,
    /// Its findings, each kind once with the impacts that have it: the list that `fit` prints.
    pub findings: Vec<FindingKind>,
    /// Impacts without a result: never fitted, or changed since.
    pub pending: usize,
    /// When the newest run was; UTC.
    pub time: Option<String>,
}

impl Workspace {
    /// Opens a directory.
    ///
    /// # Errors
    /// There is none.
    pub fn open(directory: &Path) -> Result<Self, Error> {
        let root = directory.canonicalize().map_err(|_| Error::FileAbsent {
            path: directory.to_path_buf(),
            advice: "give a campaign directory, or a directory with campaigns in it".to_owned(),
        })?;
        if !root.is_dir() {
            let problem = "is a file; give a campaign directory, or one with campaigns in it";
            return Err(unusable(directory.display().to_string(), problem));
        }
        // What killed programs have left, here and in the folder for temporary files.
        sweep(&root.join(STORE_FILE));
        sweep_temporary();
        let single = root.join(CAMPAIGN_FILE).is_file();
        Ok(Self { root, single })
    }

    /// Name of the directory.
    pub fn name(&self) -> String {
        name_of(&self.root)
    }

    /// The directory.
    pub fn root(&self) -> &Path {
        &self.root
    }

    /// Whether the directory is a campaign itself.
    pub fn is_campaign(&self) -> bool {
        self.single
    }

    /// The directory of a campaign.
    ///
    /// # Errors
    /// There is no campaign of this name, or its files lead out of its directory.
    pub fn campaign(&self, id: &str) -> Result<PathBuf, Error> {
        let directory = match self.single {
            true => (id == self.name()).then(|| self.root.clone()),
            // A name that is refused is that of no campaign.
            false => self.place(id).ok(),
        };
        let directory = directory.filter(|own| own.join(CAMPAIGN_FILE).is_file());
        let directory = directory.ok_or_else(|| Error::CampaignUnknown { id: id.to_owned() })?;
        check_confined(&directory)?;
        Ok(directory)
    }

    /// Where a campaign of that name is or would be.
    ///
    /// # Errors
    /// The name is refused, or the workspace is one campaign.
    pub fn place(&self, id: &str) -> Result<PathBuf, Error> {
        if self.single || id.contains('/') {
            return Err(Error::NameRefused {
                name: id.to_owned(),
                problem: match self.single {
                    true => "cannot be made here: the directory served is itself a campaign",
                    false => "is a path; campaigns lie side by side",
                }
                .to_owned(),
            });
        }
        path_inside(&self.root, id)
    }

    /// A text without the path of the workspace on this machine.
    pub fn without_path(&self, text: &str) -> String {
        let root = self.root.display().to_string();
        let above = self.root.parent().map(|p| p.display().to_string());
        // Results of many impacts are long, and hardly ever name a path.
        let begins = above.as_ref().unwrap_or(&root);
        if memmem::find(text.as_bytes(), begins.as_bytes()).is_none() {
            return text.to_owned();
        }
        let text = match self.single {
            true => text.replace(&root, &self.name()),
            false => text
                .replace(&format!("{root}/"), "")
                .replace(&root, &self.name()),
        };
        match above.filter(|above| above.len() > 1) {
            Some(above) => text.replace(&format!("{above}/"), ""),
            None => text,
        }
    }

    /// All campaigns, by name.
    ///
    /// # Errors
    /// The directory cannot be read.
    pub fn campaigns(&self) -> Result<Vec<CampaignEntry>, Error> {
        if self.single {
            return Ok(vec![entry_of(&self.root)]);
        }
        let failed = |source| Error::access(&self.root, "read", source);
        let mut directories = Vec::new();
        for entry in std::fs::read_dir(&self.root).map_err(failed)? {
            let entry = entry.map_err(failed)?;
            let name = entry.file_name();
            let plain = name.to_str().is_some_and(|name| self.place(name).is_ok());
            if plain && entry.path().join(CAMPAIGN_FILE).is_file() {
                directories.push(entry.path());
            }
        }
        directories.sort();
        Ok(directories.iter().map(|path| entry_of(path)).collect())
    }
}

fn entry_of(directory: &Path) -> CampaignEntry {
    let confined = check_confined(directory);
    let run = confined.and_then(|()| latest_run(&directory.join(STORE_FILE)));
    let mut entry = CampaignEntry {
        id: name_of(directory),
        title: name_of(directory),
        kind: None,
        recordings: 0,
        run: None,
        problem: None,
    };
    let shown = |run: RunIdentity| RunView {
        time: run.time,
        results: run.keys.len(),
        failures: run.failures.len(),
    };
    match run {
        Ok(run) => entry.run = run.map(shown),
        Err(error) => {
            entry.problem = Some(error.to_string());
            return entry;
        }
    }
    match view_campaign(directory) {
        Ok(view) => {
            entry.title = view.title;
            entry.kind = Some(view.kind);
            entry.recordings = view.impacts.rows.len();
        }
        Err(error) => entry.problem = Some(error.to_string()),
    }
    entry
}

/// What the store holds of a campaign as it is now; nothing is fitted or written.
///
/// # Errors
/// The campaign is wrong, or its store cannot be read.
pub fn stored_results(directory: &Path, detail: Detail) -> Result<StoredResults, Error> {
    let store = directory.join(STORE_FILE);
    let run = latest_run(&store)?;
    // A command that still fits writes its results before its run.
    if run.is_none() && !store.exists() {
        let view = view_campaign(directory)?;
        return Ok(StoredResults {
            outcome: None,
            findings: Vec::new(),
            pending: view.impacts.rows.len(),
            time: None,
        });
    }
    let request = FitRequest {
        reuse: Reuse::Only,
        ..FitRequest::default()
    };
    let mut outcome = fit_any(directory, &request, &quiet)?;
    let failed = match &mut outcome {
        AnyOutcome::Impacts(outcome) => &mut outcome.failed,
        AnyOutcome::Measured(outcome) => &mut outcome.failed,
    };
    let (time, failures) = run.map(|run| (run.time, run.failures)).unzip();
    let pending = with_reasons(failed, failures.into_iter().flatten());
    if let (AnyOutcome::Impacts(outcome), Detail::Brief) = (&mut outcome, detail) {
        outcome.impacts.iter_mut().for_each(ImpactOutcome::abridge);
    }
    Ok(StoredResults {
        // Where everything failed, its reasons are a result.
        findings: outcome.finding_kinds(),
        outcome: (outcome.results() + outcome.failed().len() > 0).then_some(outcome),
        pending,
        time,
    })
}

/// Replaces results that are only missing by the failures of the newest run, which have
/// their reasons; how many were never tried, or changed since.
pub(crate) fn with_reasons(
    failed: &mut Vec<FailureOutcome>,
    newest: impl IntoIterator<Item = FailureOutcome>,
) -> usize {
    let all = failed.len();
    failed.retain(|failure| failure.message != PENDING);
    let mut pending = all - failed.len();
    for failure in newest {
        if pending > 0 && !failed.iter().any(|known| known.id == failure.id) {
            pending -= 1;
            failed.push(failure);
        }
    }
    pending
}

/// A file of recordings.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct RecordingEntry {
    /// Name below the directory of recordings.
    pub file: String,
    /// Its size.
    pub bytes: u64,
    /// Impacts that lie in it.
    pub impacts: Vec<String>,
}

/// How the recordings of a campaign are read, where they lie in its directory.
///
/// # Errors
/// The campaign cannot be read, or its recordings lie elsewhere.
pub fn recordings_inside(directory: &Path) -> Result<FilePlan, Error> {
    let plan = file_plan_of(directory)?;
    // One that is still to be made lies where its name says.
    let place = plan.directory.canonicalize();
    let inside = match (&place, directory.canonicalize()) {
        (Ok(place), Ok(own)) => place.starts_with(own),
        _ => {
            let name = plan.directory.strip_prefix(directory).ok();
            let name = name.and_then(Path::to_str);
            name.is_some_and(|name| path_inside(directory, name).is_ok())
        }
    };
    match inside {
        true => Ok(plan),
        false => Err(Error::RecordingsElsewhere),
    }
}

/// The recordings of a campaign, with one level of directories.
///
/// # Errors
/// The campaign cannot be read, or its recordings lie elsewhere.
pub fn recordings_of(directory: &Path) -> Result<Vec<RecordingEntry>, Error> {
    let view = view_campaign(directory)?;
    let raw = recordings_inside(directory)?.directory;
    let mut names = names_in(&raw)?;
    // Where recordings lie beside them, the files of the campaign are none.
    if raw.as_path() == directory {
        let own = |name: &String| {
            CAMPAIGN_FILES.contains(&name.as_str())
                || [STORE_FILE, UNDO_FILE].contains(&name.as_str())
        };
        names.retain(|name| !own(name));
    }
    for folder in folders_in(&raw) {
        let below = names_in(&raw.join(&folder))?;
        names.extend(below.into_iter().map(|name| format!("{folder}/{name}")));
    }
    let column = |name: &str| view.impacts.columns.iter().position(|known| known == name);
    let (id, file) = (column("id"), column("file"));
    Ok(names
        .into_iter()
        .map(|name| {
            let own = view.impacts.rows.iter().filter_map(|row| {
                let (id, file) = (id?, file?);
                (row[file] == name).then(|| row[id].clone())
            });
            RecordingEntry {
                bytes: std::fs::metadata(raw.join(&name)).map_or(0, |data| data.len()),
                impacts: own.collect(),
                file: name,
            }
        })
        .collect())
}

fn folders_in(raw: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(raw).into_iter().flatten().flatten();
    let folders = entries.filter(|entry| entry.file_type().is_ok_and(|kind| kind.is_dir()));
    let names = folders.filter_map(|entry| entry.file_name().into_string().ok());
    names
        .filter(|name| !name.starts_with('.'))
        .sorted()
        .collect()
}
