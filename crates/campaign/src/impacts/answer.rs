//! Answers on a campaign as a whole (a comparison of laws, a population), kept in its store.

use crate::impacts::key::{CommonKey, impact_key};
use crate::impacts::mass::RigFound;
use crate::pipeline::request::Reuse;
use crate::recording::digests::recording_digests;
use crate::recording::read::recording_path;
use crate::result::counted::{NOTE_COLUMN, without_notes};
use crate::settings::kind::STORE_FILE;
use crate::settings::model::ImpactCampaign;
use crate::store::documents::{DocumentRecord, find_documents};
use crate::store::runs::write_document;
use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::json;
use windfall_files::error::Error;
use windfall_files::found::FindingOutcome;
use windfall_files::provenance::{VERSION, digest_text};

/// A question on a whole campaign.
pub struct Question<'a> {
    /// The campaign, with the options of the question.
    pub campaign: &'a ImpactCampaign,
    /// Its rig.
    pub rig: &'a RigFound,
    /// The command that asks.
    pub command: &'static str,
    /// Options that the campaign does not have.
    pub options: String,
}

/// The answer to a question: that of the store where nothing has changed that it depends on, else
/// what `work` finds, which is kept.
///
/// A finding says so where an answer cannot be kept. Nothing is kept of a campaign with a
/// recording that cannot be read.
///
/// # Errors
/// The store is damaged, foreign or newer; those of `work`.
pub fn answer<T: Serialize + DeserializeOwned + PartialEq>(
    question: &Question,
    reuse: Reuse,
    work: impl FnOnce() -> Result<T, Error>,
) -> Result<(T, Option<FindingOutcome>), Error> {
    let store = question.campaign.shared.directory.join(STORE_FILE);
    let Some(key) = key(question) else {
        return work().map(|found| (found, None));
    };
    if reuse != Reuse::Nothing {
        let keys = std::slice::from_ref(&key);
        let known = find_documents::<T>(&store, keys, ("documents", "item"))?;
        if let Some(known) = known.into_iter().flatten().next() {
            return Ok((known, None));
        }
    }
    let found = work()?;
    let document = serde_json::to_string(&found)
        .map_err(|error| Error::unwritable(question.command, error))?;
    // What JSON cannot say, as a value that is not finite, is not kept.
    if !serde_json::from_str::<T>(&document).is_ok_and(|again| again == found) {
        return Ok((found, None));
    }
    let record = DocumentRecord {
        key,
        kind: question.campaign.shared.kind.name().to_owned(),
        item: question.command.to_owned(),
        specimen: String::new(),
        file: String::new(),
        document,
        values: Vec::new(),
    };
    let told = write_document(&store, &record).err().map(|error| {
        let told = format!("this answer is found anew each time: {error}");
        FindingOutcome::new("answer-not-kept", told)
    });
    Ok((found, told))
}

/// Digest of everything that an answer depends on; `None` where a recording cannot be read.
///
/// All columns of the tables enter: levels, groups, covariates and exclusions are among them. A
/// note enters where the question is about it, or an impact is left out for it.
fn key(question: &Question) -> Option<String> {
    let campaign = question.campaign;
    let shared = &campaign.shared;
    let digests = recording_digests(&shared.directory, &shared.files, &shared.entries);
    let common = CommonKey::of(campaign, &question.rig.rig);
    let mut impacts = Vec::new();
    for entry in &shared.entries {
        let digest = digests.get(&recording_path(&shared.files, entry))?;
        let digest = digest.as_ref().ok()?;
        for law in &campaign.fit.laws {
            impacts.push(impact_key(campaign, entry, law, &common, digest));
        }
    }
    let columns = shared.group.iter().chain(&campaign.covariates);
    let entries = match columns.into_iter().any(|own| own == NOTE_COLUMN) {
        true => shared.entries.clone(),
        false => without_notes(&shared.entries),
    };
    let everything = json!({
        "version": VERSION,
        "command": question.command,
        "options": question.options,
        "impacts": impacts,
        "laws": format!("{:?}", campaign.fit.laws),
        "free": campaign.fit.free,
        "campaign": [&shared.title, &format!("{:?}", (&shared.simulated, &shared.group))],
        "covariates": campaign.covariates,
        "entries": format!("{entries:?}"),
        "specimens": format!("{:?}", shared.specimens),
        "rig": format!("{:?}", (&question.rig.mass, &question.rig.findings)),
    });
    Some(digest_text(&everything.to_string()))
}
