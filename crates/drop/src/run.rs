//! `windfall fit DIR` for a campaign of drops.

use crate::evaluate::{MeasuredDrop, bounce_options, bounce_train, evaluate_drop};
use crate::figure::figure_of_drop;
use crate::methods::methods_of_drops;
use crate::plate_ringing::plate_items;
use crate::read::{DropCampaign, drop_of, read_drop};
use std::path::Path;
use windfall_campaign::impacts::request::{FitRequest, Reuse};
use windfall_campaign::impacts::run::STORE_FILE;
use windfall_campaign::measure::any_outcome::AnyOutcome;
use windfall_campaign::measure::evaluate::{Evaluated, Evaluation, evaluate};
use windfall_campaign::measure::item_campaign::group_of;
use windfall_campaign::measure::measured::{
    MeasuredItem, MeasuredOutcome, ShownValue, groups_of, spread_of,
};
use windfall_campaign::measure::reported_items::{ReportedItems, reported_items};
use windfall_campaign::measure::request::apply_request_to_items;
use windfall_campaign::recording::read::read_recording;
use windfall_campaign::settings::model::ImpactEntry;
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

/// What the table of drops shows.
const SHOWN: [ShownValue; 7] = [
    shown("drop_height", "height (mm)", 1e3),
    shown("mass", "mass (g)", 1e3),
    shown("peak_force", "peak (N)", 1.0),
    shown("peak_force_2", "2nd peak (N)", 1.0),
    shown("interval", "interval (ms)", 1e3),
    shown("restitution", "restitution", 1.0),
    shown("restitution_by_impulse", "by impulse", 1.0),
];

/// What the table of bounces shows.
const SHOWN_OF_BOUNCES: [ShownValue; 6] = [
    shown("impact_velocity", "speed (m/s)", 1.0),
    shown("restitution", "restitution", 1.0),
    shown("restitution_by_impulse", "by impulse", 1.0),
    shown("contact_duration", "contact (ms)", 1e3),
    shown("peak_force", "peak (N)", 1.0),
    shown("impulse", "impulse (mN s)", 1e3),
];

/// What the tables of the plate show.
const SHOWN_OF_PLATE: [ShownValue; 10] = [
    shown("damping_ratio_by_decrement", "damping ratio by peaks", 1.0),
    shown("damping_ratio_by_decrement_spread", "SD", 1.0),
    shown("damping_ratio", "damping ratio by fit", 1.0),
    shown("damping_ratio_spread", "SD ", 1.0),
    shown("damped_period", "period (ms)", 1e3),
    shown("damped_period_spread", "SD  ", 1e3),
    shown("plate_mass", "mass (kg)", 1.0),
    shown("natural_frequency", "undamped (rad/s)", 1.0),
    shown("plate_stiffness", "stiffness (N/mm)", 1e-3),
    shown("plate_damping", "damping (N s/m)", 1.0),
];

/// The bounces of every recording of a campaign, from the store where nothing
/// has changed.
///
/// # Errors
/// The store cannot be used.
pub fn measured_drops(
    campaign: &DropCampaign,
    reuse: Reuse,
    progress: Progress,
) -> Result<Evaluated<MeasuredDrop>, Error> {
    evaluate::<MeasuredDrop>(
        &Evaluation {
            campaign: &campaign.shared,
            store: &campaign.shared.directory.join(STORE_FILE),
            reuse,
            depends_on: &|entry| {
                format!(
                    "{:?} {:?} {:?} {:?}",
                    bounce_options(campaign, entry).ok(),
                    (campaign.rig.gravity, campaign.bounces.ringing_cycles),
                    drop_of(campaign, entry).ok(),
                    group_of(&campaign.shared, entry),
                )
            },
            work: &|entry, recording| evaluate_drop(campaign, entry, recording),
        },
        progress,
    )
}

/// Evaluates a campaign of drops and keeps the results in its store.
///
/// # Errors
/// The campaign or the request is wrong, or the store cannot be used.
pub fn fit_drops(
    directory: &Path,
    request: &FitRequest,
    progress: Progress,
) -> Result<AnyOutcome, Error> {
    let campaign = campaign_of(directory, request)?;
    on_threads(request.threads, || {
        let outcome = evaluated(&campaign, request, progress)?;
        if let Some(figures) = &request.figures {
            draw(&campaign, figures)?;
        }
        Ok(AnyOutcome::Measured(Box::new(outcome)))
    })
}

/// [`fit_drops`], with what a report says and shows of it.
pub fn reported_drops(
    directory: &Path,
    request: &FitRequest,
    progress: Progress,
) -> Result<ReportedItems, Error> {
    let campaign = campaign_of(directory, request)?;
    on_threads(request.threads, || {
        let outcome = evaluated(&campaign, request, progress)?;
        let methods = methods_of_drops(&campaign);
        let figure = |entry: &ImpactEntry| figure_of_entry(&campaign, entry);
        Ok(reported_items(&campaign.shared, outcome, methods, figure))
    })
}

fn campaign_of(directory: &Path, request: &FitRequest) -> Result<DropCampaign, Error> {
    let mut campaign = read_drop(directory)?;
    apply_request_to_items(&mut campaign.shared, request)?;
    Ok(campaign)
}

fn evaluated(
    campaign: &DropCampaign,
    request: &FitRequest,
    progress: Progress,
) -> Result<MeasuredOutcome, Error> {
    let evaluated = measured_drops(campaign, request.reuse, progress)?;
    let drops: Vec<MeasuredDrop> = evaluated.items.into_iter().map(|(_, drop)| drop).collect();
    let items: Vec<MeasuredItem> = drops.iter().map(|drop| drop.item.clone()).collect();
    let law = items.first().map_or("", |item| &item.law);
    Ok(MeasuredOutcome {
        windfall: VERSION.to_owned(),
        campaign: campaign.shared.title.clone(),
        kind: campaign.shared.kind.name().to_owned(),
        simulated: campaign.shared.simulated.clone(),
        status: evaluated.status,
        parts: drops.iter().flat_map(|drop| drop.parts.clone()).collect(),
        failed: evaluated.failed,
        specimens: Vec::new(),
        whole: plate_items(campaign, &drops),
        summary: spread_of(&items, law, None).values,
        groups: groups_of(&items),
        findings: Vec::new(),
        shown: SHOWN.to_vec(),
        shown_of_parts: SHOWN_OF_BOUNCES.to_vec(),
        shown_of_specimens: SHOWN_OF_PLATE.to_vec(),
        impacts: items,
    })
}

/// A figure of every recording that can be evaluated.
fn draw(campaign: &DropCampaign, folder: &FigureFolder) -> Result<(), Error> {
    for entry in &campaign.shared.entries {
        if let Some(named) = figure_of_entry(campaign, entry) {
            write_figure(folder, &named.name, &named.figure)?;
        }
    }
    Ok(())
}

/// The figure of a recording; `None` of one that cannot be read, which is told among
/// the recordings.
fn figure_of_entry(campaign: &DropCampaign, entry: &ImpactEntry) -> Option<NamedFigure> {
    let train = read_recording(&campaign.shared.files, entry)
        .and_then(|recording| bounce_train(campaign, entry, &recording))
        .ok()?;
    let drop = drop_of(campaign, entry).ok()?;
    Some(NamedFigure {
        name: file_name(&entry.id),
        caption: format!(
            "{}: force on the plate with the contacts that were found, and the ringing of the \
             plate between them.",
            entry.id
        ),
        figure: figure_of_drop(&entry.id, &drop, &train),
    })
}
