//! One recording of taps → resonances of each tap.

use crate::taps::document::{TapDocument, TapsDocument, kept};
use crate::taps::read::AcousticCampaign;
use windfall_campaign::recording::channel::channel_samples;
use windfall_campaign::recording::read::recording_path;
use windfall_campaign::settings::model::ImpactEntry;
use windfall_files::error::Error;
use windfall_files::found::FindingOutcome;
use windfall_signal::recording::{Channel, Quantity, Recording, Times};
use windfall_signal::tap::find::{Taps, find_taps};
use windfall_signal::tap::finding::TapFinding;
use windfall_signal::tap::resonance::{quiet_spectrum, resonances};

/// The sound of an entry and its taps.
///
/// # Errors
/// The recording has no sound in the range of the entry, or no tap.
pub fn taps_of_entry(
    campaign: &AcousticCampaign,
    entry: &ImpactEntry,
    recording: &Recording,
) -> Result<(Channel, Taps), Error> {
    let samples = channel_samples(recording, Quantity::Sound, entry)?;
    let names = recording.channels.iter();
    let name = names.clone().find(|c| c.quantity == Quantity::Sound);
    let channel = Channel {
        name: name.map_or_else(String::new, |channel| channel.name.clone()),
        quantity: Quantity::Sound,
        times: Times::Listed(samples.times),
        samples: samples.values,
    };
    let taps =
        find_taps(&channel, &campaign.taps).map_err(|error| failed(campaign, entry, error))?;
    Ok((channel, taps))
}

/// Resonances of all taps of an entry.
///
/// # Errors
/// As [`taps_of_entry`].
pub fn evaluate_taps(
    campaign: &AcousticCampaign,
    entry: &ImpactEntry,
    recording: &Recording,
) -> Result<TapsDocument, Error> {
    let (channel, taps) = taps_of_entry(campaign, entry, recording)?;
    let failed = |error| failed(campaign, entry, error);
    let quiet = taps.quiet.clone().map(|range| &channel.samples[range]);
    let quiet = quiet.map(|samples| quiet_spectrum(samples, taps.interval));
    let quiet = quiet.transpose().map_err(failed)?;
    let mut findings = taps.findings.clone();
    let mut documents = Vec::new();
    for tap in &taps.taps {
        let ringing = &channel.samples[tap.ringing.clone()];
        let found = resonances(ringing, taps.interval, quiet.as_ref(), &campaign.resonances);
        let found = found.map_err(failed)?;
        if found.is_empty() {
            findings.push(TapFinding::NoPeak { time: tap.onset });
        }
        documents.push(TapDocument {
            onset: tap.onset,
            peak: tap.peak,
            resonances: found.into_iter().map(kept).collect(),
        });
    }
    let told = |finding: &TapFinding| FindingOutcome::new(finding.code(), finding.to_string());
    Ok(TapsDocument {
        taps: documents,
        findings: findings.iter().map(told).collect(),
    })
}

fn failed(
    campaign: &AcousticCampaign,
    entry: &ImpactEntry,
    source: windfall_signal::Error,
) -> Error {
    Error::signal(recording_path(&campaign.shared.files, entry), source)
}
