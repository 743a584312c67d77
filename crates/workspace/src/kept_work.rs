//! The newest comparison of laws, population and calibration of a campaign, kept in its store
//! with what they were made of, so that the page shows them again at once.

use crate::campaign_files::read_any;
use serde::{Deserialize, Serialize};
use serde_json::Value;
use std::path::{Path, PathBuf};
use windfall_campaign::recording::digests::{campaign_text, recording_digests};
use windfall_campaign::result::counted::{NOTE_COLUMN, without_notes};
use windfall_campaign::settings::kind::STORE_FILE;
use windfall_campaign::store::documents::{DocumentRecord, find_documents};
use windfall_campaign::store::runs::write_document;
use windfall_files::error::Error;
use windfall_files::provenance::{digest_text, time_now};

/// Work whose newest result is kept, by the names of the commands.
pub const KEPT: [&str; 3] = ["laws", "population", "calibrate"];

/// The table of the store that holds them, and its column of names.
const DOCUMENTS: (&str, &str) = ("documents", "item");

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
    /// The work, one of [`KEPT`].
    pub work: String,
    /// The command that does it.
    pub command: String,
    /// What the command gives in JSON.
    pub result: Value,
}

/// Work that has begun, and whose result will be kept.
#[derive(Debug)]
pub struct Keeping {
    directory: PathBuf,
    made_of: MadeOf,
    work: &'static str,
    command: String,
}

impl Keeping {
    /// Before the work begins: a change of the campaign meanwhile makes the result outdated.
    ///
    /// * `command`: the command that does it
    ///
    /// Nothing where the result is none of [`KEPT`], or the campaign cannot be read, which the
    /// work will tell.
    pub fn begin(directory: &Path, work: &'static str, command: String) -> Option<Self> {
        if !KEPT.contains(&work) {
            return None;
        }
        Some(Self {
            directory: directory.to_path_buf(),
            made_of: made_of(directory).ok()?,
            work,
            command,
        })
    }

    /// Keeps the result in the place of the one of before; one that says the same stays.
    ///
    /// # Errors
    /// The store is damaged, foreign, newer, or cannot be written.
    pub fn end<T: Serialize>(self, result: &T) -> Result<(), Error> {
        let unwritable = |error| Error::unwritable("this result", error);
        let kept = KeptResult {
            time: time_now(),
            made_of: self.made_of,
            work: self.work.to_owned(),
            command: self.command,
            result: serde_json::to_value(result).map_err(unwritable)?,
        };
        // One that is damaged is replaced.
        let store = self.directory.join(STORE_FILE);
        let before: Vec<Option<KeptResult>> =
            find_documents(&store, &[key_of(self.work)], DOCUMENTS).unwrap_or_default();
        let same = |before: &KeptResult| {
            (&before.made_of, &before.command, &before.result)
                == (&kept.made_of, &kept.command, &kept.result)
        };
        if before.iter().flatten().any(same) {
            return Ok(());
        }
        let record = DocumentRecord {
            key: key_of(self.work),
            kind: "kept".to_owned(),
            item: self.work.to_owned(),
            specimen: String::new(),
            file: String::new(),
            document: serde_json::to_string(&kept).map_err(unwritable)?,
            values: Vec::new(),
        };
        write_document(&store, &record)
    }
}

/// What a result that begins now is made of.
///
/// # Errors
/// The campaign cannot be read.
pub fn made_of(directory: &Path) -> Result<MadeOf, Error> {
    // Taken first: a change during the reading makes it outdated, never wrong.
    let mut settings: toml::Table = toml::from_str(&campaign_text(directory)?).unwrap_or_default();
    if let Some(toml::Value::Table(campaign)) = settings.get_mut("campaign") {
        campaign.remove("note");
    }
    let (shared, _) = read_any(directory)?;
    let entries = match shared.group.as_deref() == Some(NOTE_COLUMN) {
        true => shared.entries.clone(),
        false => without_notes(&shared.entries),
    };
    let campaign = format!("{settings:?} {:?} {entries:?}", shared.specimens);
    let digests = recording_digests(&shared.directory, &shared.files, &shared.entries);
    let lines = digests.iter().map(|(path, digest)| {
        let name = path.strip_prefix(&shared.directory).unwrap_or(path);
        let digest = digest.as_deref().unwrap_or("unreadable");
        format!("{} {digest}\n", name.display())
    });
    Ok(MadeOf {
        campaign: digest_text(&campaign),
        recordings: digest_text(&lines.collect::<String>()),
        windfall: windfall_files::provenance::VERSION.to_owned(),
    })
}

/// Does work and keeps its result, which is given whether it can be kept or not: a store may be
/// read-only.
///
/// * `work`: one of [`KEPT`]
/// * `command`: the command that does it
///
/// # Errors
/// Those of the work.
pub fn kept<T: Serialize, E>(
    directory: &Path,
    (work, command): (&'static str, String),
    result: impl FnOnce() -> Result<T, E>,
) -> Result<T, E> {
    let keeping = Keeping::begin(directory, work, command);
    let result = result()?;
    let _ = keeping.map(|keeping| keeping.end(&result));
    Ok(result)
}

/// The results that are kept.
///
/// # Errors
/// The store is damaged, foreign or newer.
pub fn kept_results(directory: &Path) -> Result<Vec<KeptResult>, Error> {
    let keys = KEPT.map(key_of);
    let found = find_documents(&directory.join(STORE_FILE), &keys, DOCUMENTS)?;
    Ok(found.into_iter().flatten().collect())
}

/// Each work has one result that is kept.
fn key_of(work: &str) -> String {
    digest_text(&format!("kept result of {work}"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use windfall_campaign::settings::kind::CAMPAIGN_FILE;
    use windfall_campaign::settings::template::{TemplateKind, write_template};

    /// What no result rests on is a note: on the campaign, and on an impact that counts.
    #[test]
    fn closed_form_notes_make_nothing_stale() {
        let folder = tempfile::tempdir().unwrap();
        let directory = folder.path().join("campaign");
        write_template(TemplateKind::Carriage, &directory).unwrap();
        let write = |name: &str, from: &str, to: &str| {
            let path = directory.join(name);
            let text = std::fs::read_to_string(&path).unwrap();
            assert!(text.contains(from), "{text}");
            std::fs::write(path, text.replacen(from, to, 1)).unwrap();
            made_of(&directory).unwrap()
        };
        let table = "id,specimen,file,exclude,note\na,fruit-1,a.csv,,\nb,fruit-1,b.csv,yes,\n";
        std::fs::write(directory.join("impacts.csv"), table).unwrap();
        let before = made_of(&directory).unwrap();
        let title = "title = \"My carriage campaign\"\n";
        let noted = format!("{title}note = \"on a wet day\"\n");
        assert_eq!(write(CAMPAIGN_FILE, title, &noted), before);
        assert_eq!(write("impacts.csv", "a.csv,,", "a.csv,,soft"), before);
        // A result tells why an impact is left out.
        let excluded = write("impacts.csv", "b.csv,yes,", "b.csv,yes,fell");
        assert_ne!(excluded, before);
        assert_ne!(write(CAMPAIGN_FILE, "0.5 kg", "0.6 kg"), excluded);
    }
}
