//! Options of `windfall fit`, which override those of the campaign.

use crate::settings::fit::{
    ENDS, INTERVALS, NOISES, TREATMENTS, WEIGHTS, enough_work, hold_velocity, known_velocity,
    quantities_named, unknown_parameter,
};
use crate::settings::kind::CampaignKind;
use crate::settings::model::{Campaign, ImpactCampaign, ImpactEntry, Specimen};
use std::path::PathBuf;
use windfall_cards::user_laws::read::laws_of_option;
use windfall_contact::expression::{LawExpression, parse_law_among};
use windfall_contact::laws::kind::LawKind;
use windfall_draw::files::FigureFolder;
use windfall_files::error::Error;
use windfall_files::option_value::{chosen, unusable};
use windfall_files::text::toml_source::suggestion;
use windfall_identify::fit::problem::FitOptions;

/// Options of `fit`, which override the campaign's settings.
#[derive(Clone, Debug, Default)]
pub struct FitRequest {
    /// Laws in place of those of the campaign; none keeps them.
    pub laws: Vec<String>,
    /// A file of the user's own laws, besides those of the campaign.
    pub laws_file: Option<PathBuf>,
    /// Parameters to estimate although they have a value; none keeps the campaign's.
    pub free: Vec<String>,
    /// Quantities in place of those of the campaign; none keeps them.
    pub quantities: Vec<String>,
    /// Weights in place of the campaign's: a word of [`WEIGHTS`].
    pub weights: Option<String>,
    /// What is taken for the channels' noise: a word of [`NOISES`].
    pub noise: Option<String>,
    /// How intervals are made: a word of [`INTERVALS`].
    pub intervals: Option<String>,
    /// Resampled recordings of a bootstrap.
    pub replicates: Option<usize>,
    /// Draws of each chain of a posterior.
    pub draws: Option<usize>,
    /// Seed of bootstrap and posterior.
    pub seed: Option<u64>,
    /// Velocity at first touch: a word of [`TREATMENTS`], or the value to hold it at.
    pub initial_velocity: Option<String>,
    /// Treatment of the time of first touch.
    pub onset: Option<String>,
    /// Treatment of the zero of the displacement.
    pub displacement_offset: Option<String>,
    /// End of contact in place of the campaign's: a word of [`ENDS`].
    pub end: Option<String>,
    /// Column to group by in place of the campaign's.
    pub group: Option<String>,
    /// What becomes of results in the store.
    pub reuse: Reuse,
    /// Where a figure of each recording goes, with its data as CSV.
    pub figures: Option<FigureFolder>,
    /// Where the law is written as a law card.
    pub card: Option<PathBuf>,
    /// Number of threads; all cores when `None`. It never changes a result.
    pub threads: Option<usize>,
}

/// Why an impact has no result where nothing is fitted ([`Reuse::Only`]).
pub const PENDING: &str = "not fitted yet, or changed since";

/// What becomes of results in the store.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Reuse {
    /// Impacts that have not changed are answered from it.
    #[default]
    Unchanged,
    /// Every impact is fitted again.
    Nothing,
    /// Nothing is fitted or written; results that are missing are failures, [`PENDING`].
    Only,
}

/// Overrides settings of a campaign of impacts with options.
///
/// # Errors
/// An option cannot be used.
pub fn apply_request(campaign: &mut ImpactCampaign, request: &FitRequest) -> Result<(), Error> {
    campaign.fit.user = merged(&campaign.fit.user, request)?;
    let fit = &mut campaign.fit;
    laws_and_free(&mut fit.laws, &mut fit.free, &fit.user, request)?;
    apply_options(&mut campaign.fit.options, request)?;
    apply_group(&mut campaign.shared, request)
}

/// The user's laws of the campaign, overridden by those of the file of the same name.
fn merged(campaign: &[LawKind], request: &FitRequest) -> Result<Vec<LawKind>, Error> {
    let mut laws = laws_of_option(request.laws_file.as_deref())?;
    let asked = laws.len();
    for kind in campaign {
        if laws[..asked].iter().all(|law| law.name() != kind.name()) {
            laws.push(*kind);
        }
    }
    Ok(laws)
}

/// Groups by another column where the request names one that a table has.
fn apply_group(campaign: &mut Campaign, request: &FitRequest) -> Result<(), Error> {
    let Some(group) = &request.group else {
        return Ok(());
    };
    let names = columns(&campaign.specimens, &campaign.entries);
    if !names.contains(&group.as_str()) {
        let problem = format!(
            "neither specimens.csv nor impacts.csv has this column{}; they have: {}",
            suggestion(group, names.iter().copied()),
            names.join(", ")
        );
        return Err(unusable(format!("--group {group}"), problem));
    }
    campaign.group = Some(group.clone());
    Ok(())
}

/// Overrides laws and free parameters with options.
///
/// # Errors
/// A law or a parameter is not known.
pub fn laws_and_free(
    laws: &mut Vec<LawExpression>,
    free: &mut Vec<String>,
    user: &[LawKind],
    request: &FitRequest,
) -> Result<(), Error> {
    if !request.laws.is_empty() {
        *laws = laws_named(&request.laws, user)?;
        // The campaign's list may name parameters of laws that are not fitted now.
        free.retain(|name| unknown_parameter(std::slice::from_ref(name), laws).is_none());
    }
    if !request.free.is_empty() {
        if let Some((index, problem)) = unknown_parameter(&request.free, laws) {
            return Err(unusable(format!("--free {}", request.free[index]), problem));
        }
        free.clone_from(&request.free);
    }
    Ok(())
}

fn laws_named(texts: &[String], user: &[LawKind]) -> Result<Vec<LawExpression>, Error> {
    let mut laws: Vec<LawExpression> = Vec::new();
    for text in texts {
        let option = || format!("--law {text}");
        let law =
            parse_law_among(text, user).map_err(|error| unusable(option(), error.to_string()))?;
        // Results are told apart by the name of the law.
        if laws.iter().any(|known| known.kind == law.kind) {
            let problem = "this law is named twice; each law can be fitted once";
            return Err(unusable(option(), problem));
        }
        laws.push(law);
    }
    Ok(laws)
}

fn apply_options(options: &mut FitOptions, request: &FitRequest) -> Result<(), Error> {
    if !request.quantities.is_empty() {
        let words = request.quantities.iter().map(String::as_str);
        options.quantities = quantities_named(words)
            .map_err(|(word, problem)| unusable(format!("--quantities {word}"), problem))?;
    }
    if let Some(word) = &request.weights {
        options.weighting = chosen("--weights", word, &WEIGHTS)?;
    }
    if let Some(word) = &request.noise {
        options.noise = chosen("--noise", word, &NOISES)?;
    }
    if let Some(word) = &request.intervals {
        options.intervals.method = chosen("--intervals", word, &INTERVALS)?;
    }
    let numbers = [
        (
            "replicates",
            request.replicates,
            &mut options.intervals.replicates,
        ),
        ("draws", request.draws, &mut options.intervals.draws),
    ];
    for (name, given, place) in numbers {
        if let Some(value) = given {
            *place = enough_work(name, value)
                .map_err(|problem| unusable(format!("--{name} {value}"), problem))?;
        }
    }
    if let Some(seed) = request.seed {
        options.intervals.seed = seed;
    }
    if let Some(word) = &request.end {
        options.end = chosen("--end", word, &ENDS)?;
    }
    if let Some(text) = &request.initial_velocity {
        match known_velocity(text) {
            Some(known) => hold_velocity(options, known),
            None => {
                options.known_velocity = None;
                options.initial_velocity = chosen("--initial-velocity", text, &TREATMENTS)?;
            }
        }
    }
    let treatments = [
        ("--onset", &request.onset, &mut options.onset),
        (
            "--displacement-offset",
            &request.displacement_offset,
            &mut options.displacement_offset,
        ),
    ];
    for (option, word, treatment) in treatments {
        if let Some(word) = word {
            *treatment = chosen(option, word, &TREATMENTS)?;
        }
    }
    Ok(())
}

/// Columns of both tables.
fn columns<'a>(specimens: &'a [Specimen], entries: &'a [ImpactEntry]) -> Vec<&'a str> {
    let specimen = specimens.first().map_or(&[][..], |s| &s.cells);
    let entry = entries.first().map_or(&[][..], |i| &i.cells);
    let cells = specimen.iter().chain(entry);
    cells.map(|(name, _)| name.as_str()).collect()
}

/// Overrides the group of a campaign that fits no impacts; laws are overridden where it
/// fits some ([`laws_and_free`]).
///
/// # Errors
/// An option that only impacts have, or one that cannot be used.
pub fn apply_request_to_measurement(
    campaign: &mut Campaign,
    request: &FitRequest,
) -> Result<(), Error> {
    let kind = campaign.kind;
    let fits_laws = kind == CampaignKind::Compression;
    let laws = !(request.laws.is_empty() && request.free.is_empty());
    let strangers = [
        ("--law and --free", laws && !fits_laws),
        ("--laws", request.laws_file.is_some()),
        ("--card", request.card.is_some()),
        ("--quantities", !request.quantities.is_empty()),
        ("--weights", request.weights.is_some()),
        ("--noise", request.noise.is_some()),
        ("--intervals", request.intervals.is_some()),
        ("--initial-velocity", request.initial_velocity.is_some()),
        ("--onset", request.onset.is_some()),
        (
            "--displacement-offset",
            request.displacement_offset.is_some(),
        ),
        ("--end", request.end.is_some()),
    ];
    if let Some((option, _)) = strangers.iter().find(|(_, given)| *given) {
        let problem = format!("a campaign of kind \"{}\" has no such option", kind.name());
        return Err(unusable((*option).to_owned(), problem));
    }
    apply_group(campaign, request)
}
