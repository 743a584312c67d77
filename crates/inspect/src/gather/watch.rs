//! `windfall fit DIR --watch`: each recording is fitted as it is closed.

use crate::gather::add::add_recordings;
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
            let earlier = told_of.as_ref();
            let found = fit(directory, request, progress, (earlier, &now), tell);
            tried = Some(now.clone());
            let told = match found {
                Ok(told) => {
                    (told_of, broken) = (Some(now.clone()), None);
                    told
                }
                Err(told) => {
                    broken = Some(seen);
                    told
                }
            };
            if told.is_break() {
                return Ok(());
            }
        }
        before = Some(now);
        sleep(LOOK);
    }
}

/// What `tell` says of a fit, or of an error of one.
fn fit(
    directory: &Path,
    request: &FitRequest,
    progress: Progress,
    (earlier, now): (Option<&Stamp>, &Stamp),
    tell: &mut dyn FnMut(Result<&Watched, &Error>) -> ControlFlow<()>,
) -> Result<ControlFlow<()>, ControlFlow<()>> {
    let added = add_recordings(directory, &[], None);
    let outcome = added.and_then(|added| Ok((added, fit_campaign(directory, request, progress)?)));
    let (added, outcome) = match &outcome {
        Ok(found) => found,
        // A table that is being written, or a wrong one: the next look may find it right.
        Err(error) => return Err(tell(Err(error))),
    };
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
    Ok(tell(Ok(&Watched {
        new: &new,
        outcome,
        left_out: &added.left_out,
    })))
}

fn stamp(files: Vec<PathBuf>) -> Stamp {
    let stamped = |path: PathBuf| {
        // What has just gone is gone.
        let found = std::fs::metadata(&path).ok()?;
        Some((path, found.len(), found.modified().ok()))
    };
    files.into_iter().filter_map(stamped).collect()
}
