//! What a result depends on, as one digest: equal keys mean equal results.

use crate::recording::digests::{Digests, campaign_text, file_digests};
use crate::recording::pendulum_angles::angles_of_entry;
use crate::settings::files::fill_placeholders;
use crate::settings::model::{Campaign, ImpactEntry, TimePlan};
use crate::settings::read::CAMPAIGN_FILE;
use serde_json::json;
use windfall_contact::expression::LawExpression;
use windfall_files::error::Error;
use windfall_files::provenance::{REVISION, digest_text};
use windfall_identify::rig::kind::Rig;

/// SHA-256 over everything that the fit of one law to one impact depends on.
///
/// * `digest`: SHA-256 of the recording
///
/// Numbers enter with all their digits. Titles, groups and other columns of the
/// tables do not enter: changing them keeps the results.
#[must_use]
pub fn impact_key(
    campaign: &Campaign,
    entry: &ImpactEntry,
    law: &LawExpression,
    rig: &Rig,
    digest: &str,
) -> String {
    let filled = |text: &str| fill_placeholders(text, &entry.cells).unwrap_or_default();
    let channels: Vec<String> = campaign
        .files
        .channels
        .iter()
        .map(|plan| {
            let time = match (&plan.time, &campaign.files.time) {
                (Some(own), _) => filled(own),
                (None, TimePlan::Column(shared)) => filled(shared),
                (None, TimePlan::Rate(rate)) => format!("{rate:?} Hz"),
                (None, TimePlan::OfChannels | TimePlan::OfFile) => String::new(),
            };
            let (quantity, column) = (plan.quantity, filled(&plan.column));
            format!(
                "{quantity:?} {column:?} {time:?} {:?} {:?} {:?}",
                plan.scale, plan.offset, plan.delay
            )
        })
        .collect();
    let free: Vec<&String> = campaign
        .fit
        .free
        .iter()
        .filter(|name| {
            law.kind
                .describe()
                .parameters
                .iter()
                .any(|p| p.name == name.as_str())
        })
        .collect();
    let everything = json!({
        "revision": REVISION,
        "recording": digest,
        "impact": [entry.id, entry.specimen, entry.file],
        "range": format!("{:?} {:?}", entry.from, entry.to),
        "rig": format!("{rig:?}"),
        "open": format!("{:?}", campaign.files.open),
        "time_scale": format!("{:?}", campaign.files.time_scale),
        "channels": channels,
        "contact": campaign.contact,
        "angles": format!("{:?}", angles_of_entry(campaign, entry).ok()),
        "law": format!("{:?}", law),
        "free": free,
        "fit": campaign.fit.options,
    });
    digest_text(&everything.to_string())
}

/// Names and SHA-256 of all files that a run read, and its options as JSON: the
/// campaign file word for word, and what was fitted in the end.
///
/// # Errors
/// A file of the campaign can no longer be read.
pub fn input_digests(
    campaign: &Campaign,
    recordings: &Digests,
) -> Result<(Vec<(String, String)>, String), Error> {
    let inputs = file_digests(&campaign.directory, recordings)?;
    let text = campaign_text(&campaign.directory)?;
    let options = json!({
        CAMPAIGN_FILE: text,
        "laws": campaign.fit.laws.iter().map(ToString::to_string).collect::<Vec<_>>(),
        "free": campaign.fit.free,
        "contact": campaign.contact,
        "fit": campaign.fit.options,
    });
    Ok((inputs, options.to_string()))
}
