//! One entry of impacts.csv → one impact.

use crate::recording::read::{read_with_gaps, recording_path};
use crate::settings::model::{ImpactCampaign, ImpactEntry};
use windfall_files::error::Error;
use windfall_identify::fit::problem::{Treatment, Weighting};
use windfall_signal::impact::Impact;
use windfall_signal::recording::Recording;
use windfall_signal::trigger::ContactChoice;
use windfall_signal::{Finding, extract_impact};

/// Reads the recording of an entry and cuts its impact out.
///
/// * `effective_mass`: for the energies; kg
///
/// # Errors
/// The recording cannot be read, or shows no impact.
pub fn extract_recording(
    campaign: &ImpactCampaign,
    entry: &ImpactEntry,
    effective_mass: Option<f64>,
) -> Result<(Impact, Vec<Finding>), Error> {
    let recording = read_with_gaps(&campaign.shared.files, entry)?;
    extract_entry(campaign, entry, &recording, effective_mass)
}

/// [`extract_recording`] from a recording that has been read.
///
/// # Errors
/// The recording shows no impact.
pub fn extract_entry(
    campaign: &ImpactCampaign,
    entry: &ImpactEntry,
    recording: &Recording,
    effective_mass: Option<f64>,
) -> Result<(Impact, Vec<Finding>), Error> {
    let mut options = campaign.contact;
    options.effective_mass = effective_mass;
    // Free motion tells where touch began: it contradicts an onset that is held at the
    // threshold. Weights without the noise of a channel do not know how well it tells.
    let fit = &campaign.fit.options;
    if fit.onset == Treatment::Fixed || fit.weighting == Weighting::InverseMean {
        options.free_flight = 0.0;
    }
    if entry.from.is_some() || entry.to.is_some() {
        options.trigger.choice = ContactChoice::Within {
            from: entry.from.unwrap_or(f64::NEG_INFINITY),
            to: entry.to.unwrap_or(f64::INFINITY),
        };
    }
    let (impact, mut findings) = extract_impact(recording, &options)
        .map_err(|source| Error::signal(recording_path(&campaign.shared.files, entry), source))?;
    // Contacts outside of the range belong to other rows.
    if let ContactChoice::Within { from, to } = options.trigger.choice {
        let inside = |onset: &&f64| (from..=to).contains(*onset);
        findings.retain(|finding| match finding {
            Finding::SeveralContacts { onsets, .. } => onsets.0.iter().filter(inside).count() > 1,
            _ => true,
        });
    }
    Ok((impact, findings))
}
