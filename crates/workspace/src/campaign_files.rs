//! The files that make a campaign: their version, whether they say what they must, and whether
//! changed ones would.

use std::path::{Component, Path};
use windfall_campaign::settings::kind::{CAMPAIGN_FILE, campaign_kind};
use windfall_campaign::settings::model::{Campaign, FilePlan, ImpactCampaign};
use windfall_campaign::settings::read::read_campaign;
use windfall_files::error::Error;
use windfall_files::provenance::digest_text;
use windfall_files::scratch::Scratch;
use windfall_report::fit_any::measurement_of;

/// Files that make a campaign; the store and the recordings are no part of it.
pub const CAMPAIGN_FILES: [&str; 3] = [CAMPAIGN_FILE, "specimens.csv", "impacts.csv"];

/// Digest of the files of a campaign; one that is absent counts as empty.
///
/// # Errors
/// One of them cannot be read.
pub fn campaign_version(directory: &Path) -> Result<String, Error> {
    let mut all = String::new();
    for name in CAMPAIGN_FILES {
        let path = directory.join(name);
        let bytes = match std::fs::read(&path) {
            Ok(bytes) => bytes,
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => Vec::new(),
            Err(source) => return Err(Error::access(&path, "read", source)),
        };
        let text = String::from_utf8_lossy(&bytes);
        all += &format!("{name} {}\n{text}\n", bytes.len());
    }
    Ok(digest_text(&all)[..16].to_owned())
}

/// A campaign of any kind: what all kinds share, and what only impacts have.
pub(crate) fn read_any(directory: &Path) -> Result<(Campaign, Option<ImpactCampaign>), Error> {
    if let Some(measurement) = measurement_of(campaign_kind(directory)?) {
        return Ok(((measurement.read)(directory)?, None));
    }
    let campaign = read_campaign(directory)?;
    Ok((campaign.shared.clone(), Some(campaign)))
}

/// Whether the files of a campaign say what they must.
///
/// # Errors
/// What they do not.
pub fn check_campaign(directory: &Path) -> Result<(), Error> {
    read_any(directory).map(|_| ())
}

/// Where the recordings of a campaign are, and how its files are read.
///
/// # Errors
/// The campaign cannot be read.
pub fn file_plan_of(directory: &Path) -> Result<FilePlan, Error> {
    read_any(directory).map(|(campaign, _)| campaign.files)
}

/// Reads the campaign as it will be, beside the one that is there.
///
/// * `files`: names and texts that are about to be written
///
/// # Errors
/// [`Error::ChangeRefused`]: it is none, or reads files elsewhere.
pub(crate) fn check_changed(
    directory: &Path,
    files: &[(&'static str, String)],
) -> Result<(), Error> {
    let scratch = Scratch::temporary()?;
    let failed = |source| Error::access(directory, "check", source);
    for (name, text) in files {
        let written = scratch.write(Path::new(name), text.as_bytes());
        written.map_err(failed)?;
    }
    // The rest as it is: laws may be tables in files of their own.
    for entry in std::fs::read_dir(directory).map_err(failed)? {
        let entry = entry.map_err(failed)?;
        let name = entry.file_name();
        let name = Path::new(&name);
        let there = scratch.path().join(name).exists();
        let own = CAMPAIGN_FILES.iter().any(|known| name == Path::new(known));
        let plain = entry.file_type().is_ok_and(|kind| kind.is_file());
        if !there && (own || plain && small(&entry)) {
            let bytes = std::fs::read(entry.path()).map_err(failed)?;
            scratch.write(name, &bytes).map_err(failed)?;
        }
    }
    let own = format!("{}/", scratch.path().display());
    check_campaign(scratch.path()).map_err(|error| Error::ChangeRefused {
        problem: error.to_string().replace(&own, ""),
    })?;
    stays_inside(directory, scratch.path())
}

/// Refuses a change that makes the campaign read files elsewhere, unless it did before.
fn stays_inside(directory: &Path, changed: &Path) -> Result<(), Error> {
    let new = file_plan_of(changed)?.directory;
    let plain = |path: &Path| path.components().all(|c| c != Component::ParentDir);
    let same = file_plan_of(directory).is_ok_and(|old| old.directory == new);
    match same || (plain(&new) && new.starts_with(changed)) {
        true => Ok(()),
        false => Err(Error::ChangeRefused {
            problem: "[files] directory must lie in the directory of the campaign; another one \
                      can be given with an editor"
                .to_owned(),
        }),
    }
}

/// Whether a file may be a table of a law.
fn small(entry: &std::fs::DirEntry) -> bool {
    entry.metadata().is_ok_and(|data| data.len() < 1 << 20)
}
