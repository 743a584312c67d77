//! `windfall fit DIR --watch`: each recording is fitted as it is closed.

use crate::gather::add::{Added, add_recordings};
use crate::gather::folder::files_in;
use std::collections::BTreeSet;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::thread::sleep;
use std::time::{Duration, SystemTime};
use windfall_campaign::impacts::run::fit_campaign;
use windfall_campaign::pipeline::request::FitRequest;
use windfall_campaign::result::outcome::CampaignOutcome;
use windfall_campaign::settings::kind::CAMPAIGN_FILE;
use windfall_files::error::Error;
use windfall_files::progress::Progress;

/// Time between two looks; a file counts as closed when two looks find it the same. One that
/// grows later is fitted again.
const LOOK: Duration = Duration::from_millis(150);

/// What a person may have to mend before a campaign can be fitted again.
const TABLES: [&str; 3] = [CAMPAIGN_FILE, "impacts.csv", "specimens.csv"];

/// What is told after each fit.
pub struct Watched<'a> {
    /// Ids of impacts that are new, or whose recordings have changed.
    pub new: &'a BTreeSet<String>,
    /// Results of the campaign.
    pub outcome: &'a CampaignOutcome,
    /// Files that are not of the pattern of names.
    pub left_out: &'a [String],
}

/// Size and time of each recording.
type Stamp = Vec<(PathBuf, u64, Option<SystemTime>)>;

/// Fits a campaign, and again whenever a recording lands in raw/, which is listed by the
/// pattern of names of the campaign.
///
/// * `tell`: is told of the first fit and of each further one, and says whether to go on
///
/// # Errors
/// The campaign cannot be read or its tables not written, or `tell` fails.
pub fn watch(
    directory: &Path,
    request: &FitRequest,
    progress: Progress,
    tell: &mut dyn FnMut(Result<&Watched, &Error>) -> ControlFlow<()>,
) -> Result<(), Error> {
    let raw = directory.join("raw");
    let (mut tried, mut before): (Option<Stamp>, Option<Stamp>) = (None, None);
    // What was last told of, and the tables of a campaign that could not be fitted since.
    let (mut told_of, mut broken): (Option<Stamp>, Option<Stamp>) = (None, None);
    loop {
        let now = stamp(files_in(&raw)?);
        let tables = || stamp(TABLES.map(|name| directory.join(name)).to_vec());
        let mended = broken.as_ref().is_some_and(|seen| *seen != tables());
        let closed = before.as_ref() == Some(&now);
        if closed && (mended || tried.as_ref() != Some(&now)) {
            let seen = tables();
            let found = fit(directory, request, progress, (told_of.as_ref(), &now));
            let told = match &found {
                Ok((new, outcome, added)) => tell(Ok(&Watched {
                    new,
                    outcome,
                    left_out: &added.left_out,
                })),
                // A table that is being written, or a wrong one: a later look may find it right.
                Err(error) => tell(Err(error)),
            };
            if told.is_break() {
                return Ok(());
            }
            broken = found.is_err().then_some(seen);
            if found.is_ok() {
                told_of = Some(now.clone());
            }
            tried = Some(now.clone());
        }
        before = Some(now);
        sleep(LOOK);
    }
}

/// Lists what is new and fits the campaign: ids of impacts whose recordings are new or have
/// changed, results, and what was added.
fn fit(
    directory: &Path,
    request: &FitRequest,
    progress: Progress,
    (earlier, now): (Option<&Stamp>, &Stamp),
) -> Result<(BTreeSet<String>, CampaignOutcome, Added), Error> {
    let added = add_recordings(directory, &[], None)?;
    let outcome = fit_campaign(directory, request, progress)?;
    let known: BTreeSet<_> = earlier.into_iter().flatten().collect();
    let changed = now.iter().filter(|own| !known.contains(own));
    let changed: BTreeSet<&str> = changed
        .filter_map(|(path, ..)| path.file_name()?.to_str())
        .collect();
    let impacts = outcome.impacts.iter().map(|own| (&own.file, &own.id));
    let failed = outcome.failed.iter().map(|own| (&own.file, &own.id));
    let new = impacts
        .chain(failed)
        .filter(|(file, _)| changed.contains(file.as_str()));
    let new = new.map(|(_, id)| id.clone()).collect();
    Ok((new, outcome, added))
}

fn stamp(files: Vec<PathBuf>) -> Stamp {
    let stamped = |path: PathBuf| {
        // What has just gone is gone.
        let found = std::fs::metadata(&path).ok()?;
        Some((path, found.len(), found.modified().ok()))
    };
    files.into_iter().filter_map(stamped).collect()
}
