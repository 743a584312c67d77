//! `windfall fit DIR` for a campaign of taps.

use crate::impacts::request::FitRequest;
use crate::impacts::run::STORE_FILE;
use crate::measure::any_outcome::AnyOutcome;
use crate::measure::evaluate::{Evaluation, evaluate};
use crate::measure::item_campaign::group_of;
use crate::measure::measured::{MeasuredItem, MeasuredOutcome, ShownValue, groups_of, spread_of};
use crate::measure::reported_items::{ReportedItems, shown_entries, shown_words};
use crate::measure::request::apply_request_to_items;
use crate::recording::read::read_recording;
use crate::settings::model::ImpactEntry;
use crate::taps::evaluate::{evaluate_taps, taps_of_entry};
use crate::taps::figure::figure_of_taps;
use crate::taps::methods::methods_of_taps;
use crate::taps::read::{AcousticCampaign, read_acoustic};
use crate::taps::specimen::{METHOD, TapsOfEntry, acoustic_results};
use std::path::Path;
use windfall_draw::files::{FigureFolder, NamedFigure, file_name, write_figure};
use windfall_files::error::Error;
use windfall_files::on_threads::on_threads;
use windfall_files::progress::Progress;
use windfall_files::provenance::VERSION;

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
        windfall_signal::tap::acoustic_stiffness::MEGAHERTZ_GRAM,
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
    let campaign = campaign_of(directory, request)?;
    on_threads(request.threads, || {
        evaluated(&campaign, request, progress, |entries, outcome| {
            if let Some(figures) = &request.figures {
                draw(&campaign, entries, &outcome.specimens, figures)?;
            }
            Ok(AnyOutcome::Measured(Box::new(outcome)))
        })
    })
}

/// [`fit_taps`], with what a report says and shows of it.
pub fn reported_taps(
    directory: &Path,
    request: &FitRequest,
    progress: Progress,
) -> Result<ReportedItems, Error> {
    let campaign = campaign_of(directory, request)?;
    on_threads(request.threads, || {
        evaluated(&campaign, request, progress, |entries, outcome| {
            let of = |entry: &ImpactEntry| entries.iter().find(|e| e.entry.id == entry.id);
            let shown = shown_entries(&campaign.shared, |entry| of(entry).is_some());
            let figures = shown
                .iter()
                .filter_map(|entry| of(entry))
                .map(|own| figure_of_entry(&campaign, own, &outcome.specimens))
                .collect::<Result<_, Error>>()?;
            Ok(ReportedItems {
                figures,
                shown: shown_words(&campaign.shared, shown.len()),
                methods: methods_of_taps(&campaign),
                campaign: campaign.shared.clone(),
                outcome,
            })
        })
    })
}

fn campaign_of(directory: &Path, request: &FitRequest) -> Result<AcousticCampaign, Error> {
    let mut campaign = read_acoustic(directory)?;
    apply_request_to_items(&mut campaign.shared, request)?;
    Ok(campaign)
}

/// Evaluates the taps, and goes on with those of each recording and the results.
fn evaluated<T>(
    campaign: &AcousticCampaign,
    request: &FitRequest,
    progress: Progress,
    go_on: impl FnOnce(&[TapsOfEntry], MeasuredOutcome) -> Result<T, Error>,
) -> Result<T, Error> {
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
    let outcome = MeasuredOutcome {
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
    };
    go_on(&entries, outcome)
}

/// A figure of every recording that could be evaluated.
fn draw(
    campaign: &AcousticCampaign,
    entries: &[TapsOfEntry],
    specimens: &[MeasuredItem],
    folder: &FigureFolder,
) -> Result<(), Error> {
    for evaluated in entries {
        let named = figure_of_entry(campaign, evaluated, specimens)?;
        write_figure(folder, &named.name, &named.figure)?;
    }
    Ok(())
}

/// The figure of a recording.
fn figure_of_entry(
    campaign: &AcousticCampaign,
    evaluated: &TapsOfEntry,
    specimens: &[MeasuredItem],
) -> Result<NamedFigure, Error> {
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
    Ok(NamedFigure {
        name: file_name(&entry.id),
        caption: format!(
            "{}: spectrum of each tap with its resonances, and the one taken for the first \
             spheroidal mode of the fruit.",
            entry.id
        ),
        figure,
    })
}
