//! Options of `windfall fit`, which override those of the campaign.

use crate::settings::fit::{
    ENDS, INTERVALS, NOISES, TREATMENTS, WEIGHTS, enough_work, hold_velocity, known_velocity,
    noise_counts, quantities_named, unknown_parameter,
};
use crate::settings::kind::CampaignKind;
use crate::settings::known::{has, known_of};
use crate::settings::model::{
    Campaign, FitPlan, ImpactCampaign, ImpactEntry, KnownKind, KnownText, Specimen,
};
use std::path::PathBuf;
use windfall_cards::user_laws::read::laws_of_option;
use windfall_contact::expression::{LawExpression, parse_law_among};
use windfall_contact::laws::kind::LawKind;
use windfall_draw::files::FigureFolder;
use windfall_files::error::Error;
use windfall_files::option_value::{chosen, positive, unusable};
use windfall_files::text::toml_source::suggestion;
use windfall_files::write_file::check_outputs;
use windfall_identify::fit::problem::FitOptions;
use windfall_identify::samples::Quantity as FitQuantity;

/// Options of `fit`, which override the campaign's settings.
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
pub struct FitRequest {
    /// Law to fit in place of those of the campaign; may be repeated
    #[cfg_attr(feature = "clap", arg(long = "law", value_name = "LAW"))]
    pub laws: Vec<String>,
    /// File of own laws ([laws.NAME] tables) that --law can name, besides those of the campaign
    #[cfg_attr(feature = "clap", arg(long = "laws", value_name = "FILE", value_hint = clap::ValueHint::FilePath))]
    pub laws_file: Option<PathBuf>,
    /// Parameter to estimate although it has a value, such as an exponent; may be repeated
    #[cfg_attr(feature = "clap", arg(long, value_name = "NAME"))]
    pub free: Vec<String>,
    /// What is known of a parameter before the data, "k=2.4e5 ± 0.3e5 N/m^1.5"; may be repeated
    #[cfg_attr(feature = "clap", arg(long = "prior", value_name = "NAME=QUANTITY"))]
    pub priors: Vec<String>,
    /// Values outside of which a parameter is not searched, "c=0 … 50 N s/m"; may be repeated
    #[cfg_attr(feature = "clap", arg(long = "bounds", value_name = "NAME=RANGE"))]
    pub bounds: Vec<String>,
    /// Quantities of the cost function: displacement, rate, force, acceleration
    #[cfg_attr(
        feature = "clap",
        arg(long, value_delimiter = ',', value_name = "NAME,…")
    )]
    pub quantities: Vec<String>,
    /// Weights of the cost function: by each channel's noise, or 1/mean as in the 2003 study
    #[cfg_attr(feature = "clap", arg(long, value_parser = ["inverse-variance", "inverse-mean"], value_name = "WEIGHTS"))]
    pub weights: Option<String>,
    /// Noise of the channels: as the recording shows it, or white sample by sample
    #[cfg_attr(feature = "clap", arg(long, value_parser = ["automatic", "white"], value_name = "NOISE"))]
    pub noise: Option<String>,
    /// Noise of a sample of a quantity, "force=0.2 N", in place of what recordings show; may be
    /// repeated
    #[cfg_attr(feature = "clap", arg(long, value_name = "NAME=QUANTITY"))]
    pub noise_sd: Vec<String>,
    /// How the 95 % intervals are made
    #[cfg_attr(feature = "clap", arg(long, value_parser = ["asymptotic", "profile", "bootstrap", "posterior"], value_name = "HOW"))]
    pub intervals: Option<String>,
    /// Resampled recordings of each impact for --intervals bootstrap (1000)
    #[cfg_attr(feature = "clap", arg(long, value_name = "N"))]
    pub replicates: Option<usize>,
    /// Draws of each of four chains for --intervals posterior (1000)
    #[cfg_attr(feature = "clap", arg(long, value_name = "N"))]
    pub draws: Option<usize>,
    /// Seed of bootstrap and posterior (1)
    #[cfg_attr(feature = "clap", arg(long, value_name = "N"))]
    pub seed: Option<u64>,
    /// Time of first touch: fixed where the force passes its threshold, free, or as the data can tell
    #[cfg_attr(feature = "clap", arg(long, value_parser = ["auto", "free", "fixed"], value_name = "HOW"))]
    pub onset: Option<String>,
    /// Velocity at first touch: auto, free, fixed (as measured), or held at a value ("0.35 m/s")
    #[cfg_attr(feature = "clap", arg(long, value_name = "HOW"))]
    pub initial_velocity: Option<String>,
    /// Zero of the displacement
    #[cfg_attr(feature = "clap", arg(long, value_parser = ["auto", "free", "fixed"], value_name = "HOW"))]
    pub displacement_offset: Option<String>,
    /// When the contact is over
    #[cfg_attr(feature = "clap", arg(long, value_parser = ["force-zero", "gap-zero"], value_name = "END"))]
    pub end: Option<String>,
    /// Column of specimens.csv or impacts.csv by which results are grouped
    #[cfg_attr(feature = "clap", arg(long, value_name = "COLUMN"))]
    pub group: Option<String>,
    /// Estimate one law for all impacts on a specimen, too
    #[cfg_attr(feature = "clap", arg(long))]
    pub joint: bool,
    /// Fit every impact again, even where nothing has changed
    #[cfg_attr(feature = "clap", arg(id = "refit", long, action = clap::ArgAction::SetTrue, value_parser = refit()))]
    pub reuse: Reuse,
    /// A figure of each recording
    #[cfg_attr(feature = "clap", command(flatten))]
    pub figures: Option<FigureFolder>,
    /// Write samples, residuals, weights, covariance and draws of each fit into this directory, as
    /// ID-LAW.json for arviz.from_json; fits every impact once more
    #[cfg_attr(feature = "clap", arg(long, value_name = "DIR", value_hint = clap::ValueHint::DirPath))]
    pub detail: Option<PathBuf>,
    /// Write the law as a law card: the median fruit, how fruit differ, and in what it was seen
    #[cfg_attr(feature = "clap", arg(long, value_name = "FILE", value_hint = clap::ValueHint::FilePath, conflicts_with = "rig"))]
    pub card: Option<PathBuf>,
    /// What the caller will write of the results, besides.
    #[cfg_attr(feature = "clap", arg(skip))]
    pub outputs: Vec<PathBuf>,
    /// Number of threads; all cores if left out. It never changes a result
    #[cfg_attr(feature = "clap", arg(long, value_name = "N"))]
    pub threads: Option<usize>,
}

impl FitRequest {
    /// Refuses outputs that may not be written, before any work is done.
    ///
    /// # Errors
    /// Those of [`check_outputs`].
    pub fn check_outputs(&self) -> Result<(), Error> {
        let figures = self.figures.as_ref().map(|own| own.directory.as_path());
        let further = self.outputs.iter().map(|own| Some(own.as_path()));
        let own = [figures, self.detail.as_deref(), self.card.as_deref()];
        check_outputs(own.into_iter().chain(further))
    }
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

/// Whether --refit was given.
#[cfg(feature = "clap")]
fn refit() -> impl clap::builder::TypedValueParser<Value = Reuse> {
    use clap::builder::{BoolValueParser, TypedValueParser};
    BoolValueParser::new().map(|refit| match refit {
        true => Reuse::Nothing,
        false => Reuse::Unchanged,
    })
}

/// Overrides settings of a campaign of impacts with options.
///
/// # Errors
/// An option cannot be used, or something is to be calculated and nobody has said what the rig
/// is.
pub fn apply_request(campaign: &mut ImpactCampaign, request: &FitRequest) -> Result<(), Error> {
    campaign.fit.user = merged(&campaign.fit.user, request)?;
    let fit = &mut campaign.fit;
    laws_and_free(&mut fit.laws, &mut fit.free, &fit.user, request)?;
    apply_options(&mut campaign.fit.options, request)?;
    apply_known(&mut campaign.fit, request)?;
    apply_group(&mut campaign.shared, request)?;
    check_rig(&campaign.shared, request)
}

/// Stored results are shown whatever the rig is.
fn check_rig(campaign: &Campaign, request: &FitRequest) -> Result<(), Error> {
    match request.reuse {
        Reuse::Only => Ok(()),
        Reuse::Unchanged | Reuse::Nothing => campaign.check_rig_given(),
    }
}

/// Puts priors and bounds of the request in the place of those of the campaign on the same
/// parameters, and says what all mean for the laws that are fitted.
fn apply_known(plan: &mut FitPlan, request: &FitRequest) -> Result<(), Error> {
    let priors = request.priors.iter().map(|own| (KnownKind::Prior, own));
    let bounds = request.bounds.iter().map(|own| (KnownKind::Bounds, own));
    let mut asked = Vec::new();
    for (kind, text) in priors.chain(bounds) {
        let option = format!("--{} {text}", kind.name());
        let Some((name, quantity)) = text.split_once('=') else {
            let problem = match kind {
                KnownKind::Prior => "expected NAME=QUANTITY, such as \"k=2.4e5 ± 0.3e5 N/m^1.5\"",
                KnownKind::Bounds => "expected NAME=RANGE, such as \"c=0 … 50 N s/m\"",
            };
            return Err(unusable(option, problem));
        };
        let (name, text) = (name.trim().to_owned(), quantity.trim().to_owned());
        if asked
            .iter()
            .any(|own: &KnownText| own.kind == kind && own.name == name)
        {
            return Err(unusable(option, "it is given twice; keep one"));
        }
        asked.push(KnownText { kind, name, text });
    }
    let laws = &plan.laws;
    plan.known_texts.retain(|own| {
        let replaced = asked
            .iter()
            .any(|new| new.kind == own.kind && new.name == own.name);
        // The campaign's list may name parameters of laws that are not fitted now.
        !replaced && laws.iter().any(|law| has(law, &own.name))
    });
    let told = plan.known_texts.len();
    plan.known_texts.extend(asked);
    plan.known = known_of(plan).map_err(|(index, problem)| {
        let KnownText { kind, name, text } = &plan.known_texts[index];
        match index < told {
            true => unusable(
                format!("[fit.{}] {name} = \"{text}\"", kind.name()),
                problem,
            ),
            false => unusable(format!("--{} {name}={text}", kind.name()), problem),
        }
    })?;
    Ok(())
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
    for text in &request.noise_sd {
        let (quantity, sd) = noise_sd(text)?;
        options.noise_sd[quantity as usize] = Some(sd);
    }
    noise_counts(options).map_err(|problem| unusable("--weights inverse-mean", problem))?;
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

/// "force=0.2 N"
fn noise_sd(text: &str) -> Result<(FitQuantity, f64), Error> {
    let option = format!("--noise-sd {text}");
    let (name, value) = text.split_once('=').unwrap_or((text, ""));
    let Some(quantity) = FitQuantity::ALL.into_iter().find(|own| own.name() == name) else {
        let names = FitQuantity::ALL.map(FitQuantity::name);
        let hint = suggestion(name, names);
        let problem = format!(
            "expected NAME=QUANTITY with one of {}{hint}",
            names.join(", ")
        );
        return Err(unusable(option, problem));
    };
    Ok((quantity, positive(&option, value, quantity.unit())?))
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
/// An option that only impacts have, or one that cannot be used; something is to be calculated
/// and nobody has said what the rig is.
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
        ("--detail", request.detail.is_some()),
        ("--joint", request.joint),
        ("--prior", !request.priors.is_empty()),
        ("--bounds", !request.bounds.is_empty()),
        ("--quantities", !request.quantities.is_empty()),
        ("--weights", request.weights.is_some()),
        ("--noise-sd", !request.noise_sd.is_empty()),
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
    apply_group(campaign, request)?;
    check_rig(campaign, request)
}
