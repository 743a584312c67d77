//! A law card: a fitted law in one file, with what is needed to use it elsewhere.

use crate::error::Error;
use crate::toml_source::{parse_source, read_source};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::path::Path;
use windfall_contact::law_kind::{Law, LawKind};

/// Version of the shape of a law card.
pub const CARD_FORMAT: i64 = 1;

/// A law card; SI throughout.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LawCard {
    /// Version of the shape of the file.
    pub format: i64,
    /// What it is of.
    pub title: String,
    /// Name of the law.
    pub law: String,
    /// The law with all its values, as commands take it.
    pub expression: String,
    /// When a contact is over: "force-zero" or "gap-zero".
    pub end: String,
    /// What must be known before it is used.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub cautions: Vec<String>,
    /// Parameters by name.
    pub parameters: BTreeMap<String, CardParameter>,
    /// Covariance of what was estimated.
    pub covariance: Option<CardCovariance>,
    /// In what it was seen.
    pub range: CardRange,
    /// On what it was measured.
    pub bodies: CardBodies,
    /// Where it comes from.
    pub origin: CardOrigin,
}

/// A parameter of a card.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CardParameter {
    /// Value.
    pub value: f64,
    /// SI unit.
    pub unit: String,
    /// Standard uncertainty; none for what was held.
    pub sd: Option<f64>,
    /// Ends of the 95 % interval.
    pub interval: Option<[f64; 2]>,
}

/// Covariance of a card.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CardCovariance {
    /// Of what: "ln k", "e".
    pub of: Vec<String>,
    /// Rows.
    pub matrix: Vec<Vec<f64>>,
    /// What its scatter is: noise of the recordings, or from drop to drop.
    pub of_what: String,
}

/// Range in which a law was seen; SI.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CardRange {
    /// Velocities at first touch; m/s.
    pub impact_velocity: [f64; 2],
    /// Largest contact forces; N.
    pub peak_force: [f64; 2],
    /// Largest displacements; m.
    pub displacement: [f64; 2],
    /// Masses that struck; kg.
    pub mass: [f64; 2],
}

/// Bodies of a card.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CardBodies {
    /// What struck.
    pub impactor: String,
    /// What was struck.
    pub target: String,
    /// Part of its mass that the contact felt; 1.
    pub effective_mass_factor: f64,
    /// Fruit.
    pub specimens: usize,
    /// Recordings.
    pub recordings: usize,
    /// Radius where it touched, where known; m.
    pub radius: Option<f64>,
}

/// Origin of a card.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CardOrigin {
    /// Title of the campaign.
    pub campaign: String,
    /// How the law was found.
    pub method: String,
    /// Label of simulated recordings.
    pub simulated: Option<String>,
    /// SHA-256 of campaign.toml and of the tables.
    pub digests: BTreeMap<String, String>,
    /// Version of windfall.
    pub windfall: String,
    /// Date, UTC.
    pub date: String,
}

/// A law card as text.
///
/// # Errors
/// None in practice: every value has a form in TOML.
pub fn card_text(card: &LawCard) -> Result<String, Error> {
    toml::to_string(card)
        .map(|text| {
            format!(
                "# A force law with its uncertainty, range and origin; numbers are SI.\n\
                 # `windfall card show FILE` shows it; commands take the file after --law.\n{text}"
            )
        })
        .map_err(|error| Error::ResultUnwritable {
            item: "law card".to_owned(),
            detail: error.to_string(),
        })
}

/// Writes a law card; an older file of that name is replaced.
///
/// # Errors
/// The file cannot be written.
pub fn write_card(path: &Path, card: &LawCard) -> Result<(), Error> {
    let text = card_text(card)?;
    std::fs::write(path, text).map_err(|source| Error::FileAccess {
        path: path.to_path_buf(),
        action: "write",
        source,
    })
}

/// Reads a law card.
///
/// # Errors
/// It is no card, or of another version, or its law refuses the values.
pub fn read_card(path: &Path) -> Result<LawCard, Error> {
    let advice = "a law card is written by `windfall calibrate DIR --card FILE`";
    let source = read_source(path, advice)?;
    let card: LawCard = parse_source(&source)?;
    if card.format != CARD_FORMAT {
        return Err(unusable(
            path,
            format!(
                "it has format {}, this windfall reads {CARD_FORMAT}",
                card.format
            ),
        ));
    }
    law_of_card(&card, path)?;
    Ok(card)
}

/// The law of a card.
///
/// # Errors
/// A parameter is missing, or out of bounds.
pub fn law_of_card(card: &LawCard, path: &Path) -> Result<Law, Error> {
    let kind = LawKind::from_name(&card.law).map_err(|error| unusable(path, error.to_string()))?;
    let values = kind.describe().parameters.iter().map(|parameter| {
        let found = card.parameters.get(parameter.name);
        found.map(|found| found.value).ok_or_else(|| {
            let name = parameter.name;
            unusable(path, format!("it has no [parameters.{name}]"))
        })
    });
    let values = values.collect::<Result<Vec<f64>, Error>>()?;
    kind.with_parameters(&values)
        .map_err(|error| unusable(path, error.to_string()))
}

fn unusable(path: &Path, problem: String) -> Error {
    Error::OptionInvalid {
        option: path.display().to_string(),
        problem: format!("not a usable law card: {problem}"),
    }
}
