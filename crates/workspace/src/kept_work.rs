//! The newest comparison of laws, population and calibration of a campaign, kept in its store
//! with what they were made of, so that the page shows them again at once.

use crate::campaign_files::campaign_version;
use crate::campaign_files::read_any;
use serde::{Deserialize, Serialize};
use serde_json::Value;
use std::path::Path;
use windfall_campaign::recording::digests::recording_digests;
use windfall_campaign::settings::kind::STORE_FILE;
use windfall_campaign::store::documents::{DocumentRecord, find_documents};
use windfall_campaign::store::runs::write_document;
use windfall_files::error::Error;
use windfall_files::provenance::{digest_text, time_now};

/// Work whose newest result is kept, by the names of the commands.
pub const KEPT: [&str; 3] = ["laws", "population", "calibrate"];

/// What a result was made of.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize, Serialize, utoipa::ToSchema)]
pub struct MadeOf {
    /// Version of the files of the campaign.
    pub campaign: String,
    /// Digest of its recordings.
    pub recordings: String,
    /// Version of windfall.
    pub windfall: String,
}

/// A result as it is kept.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
pub struct KeptResult {
    /// When it was calculated; UTC.
    pub time: String,
    /// What it was made of.
    pub made_of: MadeOf,
    /// The work with its result, as it was shown.
    pub shown: Value,
}

/// What a result that begins now is made of.
///
/// # Errors
/// The campaign cannot be read.
pub fn made_of(directory: &Path) -> Result<MadeOf, Error> {
    // Taken first: a change during the reading makes it outdated, never wrong.
    let campaign = campaign_version(directory)?;
    let (shared, _) = read_any(directory)?;
    let digests = recording_digests(&shared.directory, &shared.files, &shared.entries);
    let lines = digests.iter().map(|(path, digest)| {
        let name = path.strip_prefix(&shared.directory).unwrap_or(path);
        let digest = digest.as_deref().unwrap_or("unreadable");
        format!("{} {digest}\n", name.display())
    });
    Ok(MadeOf {
        campaign,
        recordings: digest_text(&lines.collect::<String>()),
        windfall: windfall_files::provenance::VERSION.to_owned(),
    })
}

/// Keeps a result in the place of the one of before.
///
/// * `work`: one of [`KEPT`]
///
/// # Errors
/// The store is damaged, foreign, newer, or cannot be written.
pub fn keep_result(
    directory: &Path,
    work: &str,
    made_of: MadeOf,
    shown: Value,
) -> Result<(), Error> {
    let kept = KeptResult {
        time: time_now(),
        made_of,
        shown,
    };
    let document =
        serde_json::to_string(&kept).map_err(|error| Error::unwritable("this result", error))?;
    let record = DocumentRecord {
        key: key_of(work),
        kind: "kept".to_owned(),
        item: work.to_owned(),
        specimen: String::new(),
        file: String::new(),
        document,
        values: Vec::new(),
    };
    write_document(&directory.join(STORE_FILE), &record)
}

/// The results that are kept.
///
/// # Errors
/// The store is damaged, foreign or newer.
pub fn kept_results(directory: &Path) -> Result<Vec<KeptResult>, Error> {
    let keys = KEPT.map(key_of);
    let found = find_documents(&directory.join(STORE_FILE), &keys, ("documents", "item"))?;
    Ok(found.into_iter().flatten().collect())
}

/// Each work has one result that is kept.
fn key_of(work: &str) -> String {
    digest_text(&format!("kept {work}"))
}
