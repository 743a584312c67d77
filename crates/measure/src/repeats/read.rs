//! campaign.toml of impacts repeated on one spot → [`RepeatsCampaign`].

use crate::repeats::file::{ComparisonFile, RepeatsFile};
use std::path::Path;
use windfall_campaign::error::CampaignError;
use windfall_campaign::settings::channels::channel_plans;
use windfall_campaign::settings::conditioning::conditioning_plan;
use windfall_campaign::settings::files::check_format;
use windfall_campaign::settings::kind::{CAMPAIGN_FILE, CampaignKind};
use windfall_campaign::settings::model::Campaign;
use windfall_campaign::settings::model::ImpactEntry;
use windfall_campaign::settings::rig::STANDARD_GRAVITY;
use windfall_campaign::settings::shared::read_shared;
use windfall_files::error::{Error, Place};
use windfall_files::text::cell_quantity::cell_quantity;
use windfall_files::text::spanned::Spanned;
use windfall_files::text::toml_source::{
    Needed, TomlSource, choice, number_that, parse_source, positive_quantity, quantity_from_zero,
    read_source, refused,
};
use windfall_repeat::align::{AlignOptions, Alignment};
use windfall_repeat::permutation::SignFlipOptions;
use windfall_repeat::threshold::Family;
use windfall_signal::conditioning::Conditioning;

/// Words of `alignment`.
pub(crate) const ALIGNMENTS: [(&str, Alignment); 2] =
    [("crossing", Alignment::Crossing), ("rise", Alignment::Rise)];

/// Words of `distribution`.
pub(crate) const FAMILIES: [(&str, Family); 2] = [
    ("log-normal", Family::LogNormal),
    ("weibull", Family::Weibull),
];

/// A campaign of impacts repeated on one spot.
#[derive(Clone, Debug)]
pub struct RepeatsCampaign {
    /// What all kinds share.
    pub shared: Campaign,
    /// Mass that falls, where the campaign has one for all; kg.
    pub mass: Option<f64>,
    /// Acceleration of gravity; m/s².
    pub gravity: f64,
    /// Column and value that mark the reference.
    pub reference: (String, String),
    /// Change that does not matter.
    pub margin: Margin,
    /// What is done to the channels before they are used.
    pub conditioning: Conditioning,
    /// How two impacts are laid over each other.
    pub align: AlignOptions,
    /// How all fruit are tested together, with the level of all tests.
    pub test: SignFlipOptions,
    /// Distribution of critical energies.
    pub family: Family,
}

/// Change of peak, duration and rise slope that does not matter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Margin {
    /// A part of the value, given; 1.
    Given(f64),
    /// Standard deviations of the changes of the reference; 1.
    Deviations(f64),
}

/// Default of [`Margin::Deviations`].
const DEVIATIONS: f64 = 4.0;

const TABLE: &str = "[repeats]";
const ADVICE: &str = "`windfall new repeats DIR` writes a template";

/// Reads a campaign directory of repeated impacts.
///
/// # Errors
/// A file of the campaign is missing or does not say what it must.
pub fn read_repeats(directory: &Path) -> Result<RepeatsCampaign, Error> {
    let source = read_source(&directory.join(CAMPAIGN_FILE), ADVICE)?;
    let file: RepeatsFile = parse_source(&source)?;
    check_format(&source, file.format.as_ref())?;
    let needed = |key, meaning, unit, example| Needed::of("[rig]", key, meaning, unit, example);
    let mass = needed("mass", "mass that falls", "kg", "mass = \"200 g\"");
    let gravity = needed(
        "gravity",
        "acceleration of gravity",
        "m/s^2",
        "gravity = \"9.81 m/s^2\"",
    );
    let rig = file.rig.get_ref();
    let channels = channel_plans(&source, file.channels.as_ref())?;
    let shared = (&file.campaign, &file.files, &file.summary);
    let kind = CampaignKind::Repeats;
    let mut campaign = RepeatsCampaign {
        mass: positive_quantity(&source, rig.mass.as_ref(), &mass)?,
        gravity: quantity_from_zero(&source, rig.gravity.as_ref(), &gravity)?
            .unwrap_or(STANDARD_GRAVITY),
        reference: (
            word(file.repeats.reference_column.as_ref(), "role"),
            word(file.repeats.reference_value.as_ref(), "reference"),
        ),
        conditioning: conditioning_plan(&source, file.channels.as_ref())?,
        margin: margin(&source, &file.repeats)?,
        align: align(&source, &file.repeats)?,
        test: test(&source, &file.repeats)?,
        family: family(&source, &file.repeats)?,
        shared: read_shared(&source, directory, kind, shared, channels)?,
    };
    for entry in &campaign.shared.entries {
        energy_of(&campaign, entry)?;
    }
    // Where the tables have all energies, the mass of [rig] is not used.
    let tables = |entry| energy_with(&campaign, entry, None).is_ok();
    let entries = &campaign.shared.entries;
    if !entries.is_empty() && entries.iter().all(tables) {
        campaign.shared.rig_asked = None;
    }
    Ok(campaign)
}

fn word(value: Option<&String>, default: &str) -> String {
    value.cloned().unwrap_or_else(|| default.to_owned())
}

fn number(
    source: &TomlSource,
    value: Option<&Spanned<f64>>,
    key: &str,
    (low, high): (f64, f64),
) -> Result<Option<f64>, Error> {
    let expected = format!("a number between {low} and {high}");
    let fits = |number| number > low && number < high;
    number_that(source, value, (TABLE, key), fits, &expected)
}

fn margin(source: &TomlSource, file: &ComparisonFile) -> Result<Margin, Error> {
    let given = number(source, file.margin.as_ref(), "margin", (0.0, 1.0))?;
    let deviations = file.margin_deviations.as_ref();
    let deviations = number(source, deviations, "margin_deviations", (0.0, 100.0))?;
    match (given, &file.margin_deviations) {
        (Some(_), Some(twice)) => {
            let problem = "`margin` is given too; keep one of them";
            Err(refused(
                source,
                twice,
                (TABLE, "margin_deviations"),
                problem,
            ))
        }
        (Some(margin), None) => Ok(Margin::Given(margin)),
        (None, _) => Ok(Margin::Deviations(deviations.unwrap_or(DEVIATIONS))),
    }
}

fn align(source: &TomlSource, file: &ComparisonFile) -> Result<AlignOptions, Error> {
    let defaults = AlignOptions::default();
    let alignment = choice(
        source,
        file.alignment.as_ref(),
        (TABLE, "alignment"),
        &ALIGNMENTS,
    )?;
    let crossing = number(source, file.crossing.as_ref(), "crossing", (0.0, 0.5))?;
    Ok(AlignOptions {
        alignment: alignment.unwrap_or(defaults.alignment),
        crossing: crossing.unwrap_or(defaults.crossing),
        ..defaults
    })
}

/// Levels of a test: below, the quantiles of its intervals are beyond any number.
const LEVELS: (f64, f64) = (1e-9, 0.5);

fn test(source: &TomlSource, file: &ComparisonFile) -> Result<SignFlipOptions, Error> {
    let defaults = SignFlipOptions::default();
    let level = number(source, file.level.as_ref(), "level", LEVELS)?;
    let (key, fits) = ((TABLE, "draws"), |draws| (99..=1_000_000).contains(&draws));
    let expected = "a number from 99 to 1000000";
    let draws = number_that(source, file.draws.as_ref(), key, fits, expected)?;
    Ok(SignFlipOptions {
        level: level.unwrap_or(defaults.level),
        draws: draws.map_or(defaults.draws, |draws| draws as usize),
        seed: file.seed.unwrap_or(defaults.seed),
        ..defaults
    })
}

fn family(source: &TomlSource, file: &ComparisonFile) -> Result<Family, Error> {
    let key = (TABLE, "distribution");
    Ok(choice(source, file.distribution.as_ref(), key, &FAMILIES)?.unwrap_or_default())
}

/// Impact energy of an entry: given, or m g h; J.
///
/// # Errors
/// Neither is known, or a cell is no positive number.
pub fn energy_of(campaign: &RepeatsCampaign, entry: &ImpactEntry) -> Result<f64, Error> {
    energy_with(campaign, entry, campaign.mass)
}

/// * `all`: mass that falls where the entry has none; kg
fn energy_with(
    campaign: &RepeatsCampaign,
    entry: &ImpactEntry,
    all: Option<f64>,
) -> Result<f64, Error> {
    let file = campaign.shared.directory.join("impacts.csv");
    let place = Place::at(&file, entry.line);
    let cell = |name, unit| cell_quantity(&entry.cells, name, unit, &place);
    if let Some(energy) = cell("energy", "J")? {
        return Ok(energy);
    }
    let mass = cell("mass", "kg")?.or(all);
    match (cell("drop_height", "m")?, mass) {
        (Some(height), Some(mass)) => Ok(mass * campaign.gravity * height),
        _ => Err(Error::from(CampaignError::EnergyUnknown { place })),
    }
}

/// A cell of an entry or of its specimen; empty where there is none.
pub fn cell_of<'a>(campaign: &'a RepeatsCampaign, entry: &'a ImpactEntry, name: &str) -> &'a str {
    let specimen = campaign.shared.specimen_of(entry);
    let cells = specimen.map_or(&[][..], |specimen| &specimen.cells);
    let mut all = entry.cells.iter().chain(cells);
    all.find(|(column, _)| column == name)
        .map_or("", |(_, cell)| cell)
}
