//! SHA-256 of the files of a campaign.

use crate::recording::read::{recording_file, recording_path};
use crate::settings::kind::CAMPAIGN_FILE;
use crate::settings::model::{Campaign, FilePlan, ImpactEntry};
use rayon::prelude::*;
use serde_json::{Map, Value, json};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, SystemTime};
use windfall_files::error::Error;
use windfall_files::inputs::protect;
use windfall_files::provenance::digest_file;

/// SHA-256 of each recording; a message where it cannot be read.
pub type Digests = BTreeMap<PathBuf, Result<String, String>>;

/// SHA-256 of each recording once; a message where it cannot be read.
///
/// * `directory`: of the campaign, for messages
pub fn recording_digests(directory: &Path, files: &FilePlan, entries: &[ImpactEntry]) -> Digests {
    let mut first: BTreeMap<PathBuf, &ImpactEntry> = BTreeMap::new();
    for entry in entries {
        first.entry(recording_path(files, entry)).or_insert(entry);
    }
    let paths: Vec<(PathBuf, &ImpactEntry)> = first.into_iter().collect();
    let digests: Vec<Result<String, String>> = paths
        .par_iter()
        .map(|(path, entry)| {
            let digest = recording_file(files, entry).and_then(|path| digest_once(&path));
            digest.map_err(|error| match error {
                Error::FileAccess { source, .. }
                    if source.kind() == std::io::ErrorKind::NotFound =>
                {
                    absent(directory, entry, path)
                }
                other => other.to_string(),
            })
        })
        .collect();
    paths
        .into_iter()
        .map(|(path, _)| path)
        .zip(digests)
        .collect()
}

/// Digests that this program has made, with size and time of the file then.
static KNOWN: Mutex<BTreeMap<PathBuf, (u64, SystemTime, String)>> = Mutex::new(BTreeMap::new());

/// [`digest_file`] of a file that is the same as at an earlier call, by size and time, without
/// reading it again. A file that has just changed may change again within the same tick of the
/// file system's clock, and is read.
fn digest_once(path: &Path) -> Result<String, Error> {
    let found = std::fs::metadata(path).ok();
    let stamp = found.and_then(|own| Some((own.len(), own.modified().ok()?)));
    let known = || KNOWN.lock().unwrap_or_else(PoisonError::into_inner);
    let settled = stamp.filter(|(_, time)| time.elapsed().is_ok_and(|age| age > SETTLED));
    let earlier = settled.and_then(|(size, time)| {
        let known = known();
        let (of_size, of_time, digest) = known.get(path)?;
        (*of_size == size && *of_time == time).then(|| digest.clone())
    });
    if let Some(digest) = earlier {
        protect(path);
        return Ok(digest);
    }
    let digest = digest_file(path)?;
    if let Some((size, time)) = stamp {
        known().insert(path.to_path_buf(), (size, time, digest.clone()));
    }
    Ok(digest)
}

/// Age of a file whose time tells its content.
const SETTLED: Duration = Duration::from_secs(2);

fn absent(directory: &Path, entry: &ImpactEntry, path: &Path) -> String {
    let list = directory.join("impacts.csv");
    let advice = format!(
        "{}, line {} names it. Put the file there, correct the name, or remove the line",
        list.display(),
        entry.line
    );
    Error::absent(path, advice).to_string()
}

/// What the results of a run rest on.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RunOrigin {
    /// Names and SHA-256 of all files that were read.
    pub inputs: Vec<(String, String)>,
    /// Options as JSON: campaign.toml word for word, and what else was decided.
    pub options: String,
}

/// What the results of a run rest on.
///
/// * `decided`: options that are kept beside campaign.toml
///
/// # Errors
/// A table of the campaign can no longer be read.
pub fn run_origin(
    campaign: &Campaign,
    recordings: &Digests,
    decided: Map<String, Value>,
) -> Result<RunOrigin, Error> {
    let directory = &campaign.directory;
    let mut inputs = Vec::new();
    for name in [CAMPAIGN_FILE, "specimens.csv", "impacts.csv"] {
        let path = directory.join(name);
        if path.exists() {
            inputs.push((name.to_owned(), digest_file(&path)?));
        }
    }
    for (path, digest) in recordings {
        if let Ok(digest) = digest {
            let name = path.strip_prefix(directory).unwrap_or(path);
            inputs.push((name.display().to_string(), digest.clone()));
        }
    }
    let mut options = json!({ CAMPAIGN_FILE: campaign_text(directory)? });
    for (name, option) in decided {
        options[name] = option;
    }
    let options = options.to_string();
    Ok(RunOrigin { inputs, options })
}

/// campaign.toml, word for word.
///
/// # Errors
/// It can no longer be read.
pub fn campaign_text(directory: &Path) -> Result<String, Error> {
    let path = directory.join(CAMPAIGN_FILE);
    std::fs::read_to_string(&path).map_err(|source| Error::access(&path, "read", source))
}
