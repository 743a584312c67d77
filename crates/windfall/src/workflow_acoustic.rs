//! `windfall fit DIR` for a campaign of taps.

use crate::any_outcome::AnyOutcome;
use crate::error::Error;
use crate::evaluate::{Evaluation, evaluate};
use crate::evaluate_acoustic::{evaluate_taps, taps_of_entry};
use crate::figure_acoustic::figure_of_taps;
use crate::figure_files::write_figure;
use crate::item_campaign::group_of;
use crate::measured::{MeasuredItem, MeasuredOutcome, ShownValue, groups_of, spread_of};
use crate::on_threads::on_threads;
use crate::progress::Progress;
use crate::provenance::VERSION;
use crate::read_acoustic::{AcousticCampaign, read_acoustic};
use crate::read_recording::read_recording;
use crate::request_fit::{FitRequest, apply_request_to_items};
use crate::specimen_acoustic::{METHOD, TapsOfEntry, acoustic_results};
use crate::workflow_fit::STORE_FILE;
use std::path::Path;

const fn shown(name: &'static str, heading: &'static str, factor: f64) -> ShownValue {
    ShownValue {
        name,
        heading,
        factor,
    }
}

const SHOWN: [ShownValue; 3] = [
    shown("acoustic_frequency", "frequency (Hz)", 1.0),
    shown("quality", "Q", 1.0),
    shown("level", "part of highest", 1.0),
];

const SHOWN_OF_SPECIMENS: [ShownValue; 4] = [
    shown("acoustic_frequency", "frequency (Hz)", 1.0),
    shown(
        "acoustic_stiffness",
        "stiffness (10^6 Hz^2 g^(2/3))",
        windfall_signal::acoustic_stiffness::MEGAHERTZ_GRAM,
    ),
    shown("acoustic_stiffness_with_density", "stiffness (MPa)", 1e-6),
    shown("quality", "Q", 1.0),
];

/// Evaluates a campaign of taps and keeps the resonances in its store.
///
/// # Errors
/// The campaign or the request is wrong, or the store cannot be used.
pub fn fit_taps(
    directory: &Path,
    request: &FitRequest,
    progress: Progress,
) -> Result<AnyOutcome, Error> {
    let mut campaign = read_acoustic(directory)?;
    apply_request_to_items(&mut campaign.shared, request)?;
    on_threads(request.threads, || {
        let campaign = &campaign;
        let evaluated = evaluate(
            &Evaluation {
                campaign: &campaign.shared,
                store: &campaign.shared.directory.join(STORE_FILE),
                reuse: request.reuse,
                depends_on: &|_| format!("{:?} {:?}", campaign.taps, campaign.resonances),
                work: &|entry, recording| evaluate_taps(campaign, entry, recording),
            },
            progress,
        )?;
        let entries = evaluated.items.into_iter().map(|(position, taps)| {
            let entry = &campaign.shared.entries[position];
            TapsOfEntry {
                entry,
                group: group_of(&campaign.shared, entry),
                taps,
            }
        });
        let entries: Vec<TapsOfEntry> = entries.collect();
        let results = acoustic_results(campaign, &entries)?;
        if let Some(figures) = &request.figures {
            draw(campaign, &entries, &results.specimens, figures)?;
        }
        Ok(AnyOutcome::Measured(Box::new(MeasuredOutcome {
            parts: Vec::new(),
            shown_of_parts: Vec::new(),
            windfall: VERSION.to_owned(),
            campaign: campaign.shared.title.clone(),
            kind: campaign.shared.kind.name().to_owned(),
            simulated: campaign.shared.simulated.clone(),
            status: evaluated.status,
            failed: evaluated.failed,
            whole: Vec::new(),
            summary: spread_of(&results.specimens, METHOD, None).values,
            groups: groups_of(&results.specimens),
            findings: Vec::new(),
            shown: SHOWN.to_vec(),
            shown_of_specimens: SHOWN_OF_SPECIMENS.to_vec(),
            impacts: results.taps,
            specimens: results.specimens,
        })))
    })
}

/// A figure of every recording that could be evaluated.
fn draw(
    campaign: &AcousticCampaign,
    entries: &[TapsOfEntry],
    specimens: &[MeasuredItem],
    directory: &Path,
) -> Result<(), Error> {
    for evaluated in entries {
        let entry = evaluated.entry;
        let specimen = specimens.iter().find(|item| item.id == entry.specimen);
        let recording = read_recording(&campaign.shared.files, entry)?;
        let (channel, taps) = taps_of_entry(campaign, entry, &recording)?;
        let sounds: Vec<&[f64]> = taps
            .taps
            .iter()
            .map(|tap| &channel.samples[tap.ringing.clone()])
            .collect();
        let band = (campaign.taps.low, campaign.taps.high);
        let accepted = specimen.and_then(|item| item.derived.get("acoustic_frequency"));
        let figure = figure_of_taps(
            &entry.id,
            &sounds,
            taps.interval,
            band,
            (&evaluated.taps, accepted.map(|value| value.value)),
        );
        write_figure(directory, &entry.id, &figure)?;
    }
    Ok(())
}
