//! `windfall fit DIR` for a campaign of slow compressions.

use crate::compression::evaluate::{
    evaluate_compression, fitted_part, loading_curve, parameters_of, radii_of_entry,
};
use crate::compression::figure::figure_of_compression;
use crate::compression::methods::methods_of_compression;
use crate::compression::read::{CompressionCampaign, read_compression};
use crate::impacts::request::{FitRequest, laws_and_free};
use crate::impacts::run::STORE_FILE;
use crate::measure::any_outcome::AnyOutcome;
use crate::measure::evaluate::{Evaluation, evaluate};
use crate::measure::measured::{
    MeasuredItem, MeasuredItems, MeasuredOutcome, ShownValue, groups_of, laws_of, plain_value,
    spread_of,
};
use crate::measure::reported_items::{ReportedItems, reported_items};
use crate::measure::request::apply_request_to_items;
use crate::recording::read::read_recording;
use crate::settings::model::ImpactEntry;
use std::path::Path;
use windfall_draw::files::{FigureFolder, NamedFigure, file_name, write_figure};
use windfall_files::error::Error;
use windfall_files::found::FindingOutcome;
use windfall_files::named::Named;
use windfall_files::on_threads::on_threads;
use windfall_files::progress::Progress;
use windfall_files::provenance::VERSION;
use windfall_identify::compression_fit::fit_compression;

const fn shown(name: &'static str, heading: &'static str, factor: f64) -> ShownValue {
    ShownValue {
        name,
        heading,
        factor,
    }
}

/// What the tables show.
const SHOWN: [ShownValue; 12] = [
    shown("k", "k (SI)", 1.0),
    shown("n", "n", 1.0),
    shown("c", "c (SI)", 1.0),
    shown("apparent_modulus", "apparent modulus (MPa)", 1e-6),
    shown("stiffness", "stiffness (N/mm)", 1e-3),
    shown("bioyield_force", "bioyield (N)", 1.0),
    shown("bioyield_deformation", "at (mm)", 1e3),
    shown("softening_force", "softening (N)", 1.0),
    shown("softening_deformation", "at (mm) ", 1e3),
    shown("energy_to_yield", "energy to yield (mJ)", 1e3),
    shown("fitted_force", "fitted to (N)", 1.0),
    shown("deformation_rate", "rate (mm/s)", 1e3),
];

/// Evaluates a campaign of slow compressions and keeps the results in its store.
///
/// # Errors
/// The campaign or the request is wrong, or the store cannot be used.
pub fn fit_compressions(
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

/// [`fit_compressions`], with what a report says and shows of it.
pub fn reported_compressions(
    directory: &Path,
    request: &FitRequest,
    progress: Progress,
) -> Result<ReportedItems, Error> {
    let campaign = campaign_of(directory, request)?;
    on_threads(request.threads, || {
        let outcome = evaluated(&campaign, request, progress)?;
        let methods = methods_of_compression(&campaign);
        let figure = |entry: &ImpactEntry| figure_of_entry(&campaign, entry);
        Ok(reported_items(&campaign.shared, outcome, methods, figure))
    })
}

fn campaign_of(directory: &Path, request: &FitRequest) -> Result<CompressionCampaign, Error> {
    let mut campaign = read_compression(directory)?;
    apply_request_to_items(&mut campaign.shared, request)?;
    laws_and_free(&mut campaign.laws, &mut campaign.free, &[], request)?;
    Ok(campaign)
}

fn evaluated(
    campaign: &CompressionCampaign,
    request: &FitRequest,
    progress: Progress,
) -> Result<MeasuredOutcome, Error> {
    let evaluated = evaluate::<MeasuredItems>(
        &Evaluation {
            campaign: &campaign.shared,
            store: &campaign.shared.directory.join(STORE_FILE),
            reuse: request.reuse,
            depends_on: &|entry| depends_on(campaign, entry),
            work: &|entry, recording| evaluate_compression(campaign, entry, recording),
        },
        progress,
    )?;
    let items: Vec<MeasuredItem> = evaluated
        .items
        .into_iter()
        .flat_map(|(_, items)| items.items)
        .collect();
    let first_law = laws_of(&items).first().map_or("", |law| *law).to_owned();
    Ok(MeasuredOutcome {
        parts: Vec::new(),
        shown_of_parts: Vec::new(),
        windfall: VERSION.to_owned(),
        campaign: campaign.shared.title.clone(),
        kind: campaign.shared.kind.name().to_owned(),
        simulated: campaign.shared.simulated.clone(),
        status: evaluated.status,
        failed: evaluated.failed,
        specimens: joint_fits(campaign)?,
        whole: Vec::new(),
        summary: spread_of(&items, &first_law, None).values,
        groups: groups_of(&items),
        findings: Vec::new(),
        shown: SHOWN.to_vec(),
        shown_of_specimens: SHOWN[..3].to_vec(),
        impacts: items,
    })
}

/// A figure of every recording that can be evaluated.
fn draw(campaign: &CompressionCampaign, folder: &FigureFolder) -> Result<(), Error> {
    for entry in &campaign.shared.entries {
        if let Some(named) = figure_of_entry(campaign, entry) {
            write_figure(folder, &named.name, &named.figure)?;
        }
    }
    Ok(())
}

/// The figure of a recording; `None` of one that cannot be read, which is told among
/// the recordings.
fn figure_of_entry(campaign: &CompressionCampaign, entry: &ImpactEntry) -> Option<NamedFigure> {
    let curve = read_recording(&campaign.shared.files, entry)
        .and_then(|recording| loading_curve(campaign, entry, &recording))
        .ok()?;
    let fit = |law| {
        let part = fitted_part(campaign, &curve, law);
        let fit = fit_compression(std::slice::from_ref(&part), law, &campaign.free).ok()?;
        Some((part, fit))
    };
    let fits: Vec<_> = campaign.laws.iter().filter_map(fit).collect();
    Some(NamedFigure {
        name: file_name(&entry.id),
        caption: format!(
            "{}: loading curve with bioyield and softening where it shows them, and the fitted \
             laws over the part that they were fitted to.",
            entry.id
        ),
        figure: figure_of_compression(&entry.id, &curve, &fits),
    })
}

/// Everything besides the recording that a result depends on.
fn depends_on(campaign: &CompressionCampaign, entry: &ImpactEntry) -> String {
    let laws: Vec<String> = campaign.laws.iter().map(|law| format!("{law:?}")).collect();
    format!(
        "{:?} {:?} {} {} {:?} {laws:?} {:?} {:?} {:?}",
        campaign.options,
        campaign.fit_to,
        campaign.plates,
        campaign.poisson_ratio,
        campaign.indenter,
        campaign.free,
        radii_of_entry(campaign, entry).ok(),
        crate::measure::item_campaign::group_of(&campaign.shared, entry),
    )
}

/// Specimens with several compressions: one law for all of them, so that
/// different rates tell its damping.
fn joint_fits(campaign: &CompressionCampaign) -> Result<Vec<MeasuredItem>, Error> {
    let mut specimens: Vec<&str> = Vec::new();
    for entry in &campaign.shared.entries {
        if !specimens.contains(&entry.specimen.as_str()) {
            specimens.push(&entry.specimen);
        }
    }
    let mut items = Vec::new();
    for specimen in specimens {
        let all = campaign.shared.entries.iter();
        let entries: Vec<&ImpactEntry> = all.filter(|e| e.specimen == specimen).collect();
        if entries.len() < 2 {
            continue;
        }
        // One that cannot be read is told among the recordings.
        let curves: Vec<_> = entries
            .iter()
            .filter_map(|entry| {
                let recording = read_recording(&campaign.shared.files, entry).ok()?;
                loading_curve(campaign, entry, &recording).ok()
            })
            .collect();
        if curves.len() < 2 {
            continue;
        }
        for law in &campaign.laws {
            let parts = curves.iter().map(|curve| fitted_part(campaign, curve, law));
            let parts: Vec<_> = parts.collect();
            let Ok(fit) = fit_compression(&parts, law, &campaign.free) else {
                continue;
            };
            let mut findings = Vec::new();
            if !fit.converged {
                findings.push(FindingOutcome {
                    code: "fit_not_converged".to_owned(),
                    message: "the fit of all curves together did not converge".to_owned(),
                });
            }
            items.push(MeasuredItem {
                id: specimen.to_owned(),
                specimen: specimen.to_owned(),
                group: None,
                file: format!("{} recordings together", curves.len()),
                law: law.kind.name().to_owned(),
                words: Named(vec![("recordings".to_owned(), curves.len().to_string())]),
                parameters: parameters_of(&fit),
                derived: Named(vec![("residual_rms".to_owned(), plain_value(fit.rms, "N"))]),
                findings,
            });
        }
    }
    Ok(items)
}
