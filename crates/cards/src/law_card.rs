//! A law card: a fitted law in one file, ready for use elsewhere.
//! Its file is read and written by the module `read_card`.

use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Version of the shape of a law card; older ones are read too.
pub const CARD_FORMAT: i64 = 2;

/// A law card; SI throughout.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, utoipa::ToSchema)]
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
    /// R* and E* of its contact, where they are known.
    pub contact: Option<CardContact>,
    /// How fruit differ.
    pub population: Option<CardPopulation>,
    /// The law itself, where it is the user's own.
    pub definition: Option<CardDefinition>,
}

/// The contact that a card's law belongs to; SI.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, utoipa::ToSchema)]
#[serde(deny_unknown_fields)]
pub struct CardContact {
    /// R*, of 1/R* = 1/R1 + 1/R2 (of Hertz's general contact where curvatures
    /// differ); m.
    pub effective_radius: f64,
    /// E*, of 1/E* = (1 − ν1²)/E1 + (1 − ν2²)/E2; Pa.
    pub effective_modulus: f64,
    /// What touches what.
    pub bodies: String,
}

/// How the parameters of a law differ from fruit to fruit.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, utoipa::ToSchema)]
#[serde(deny_unknown_fields)]
pub struct CardPopulation {
    /// Of what: "ln k", "n".
    pub of: Vec<String>,
    /// Median of each parameter; SI.
    pub median: Vec<f64>,
    /// Covariance between fruit; rows.
    pub between_fruit: Vec<Vec<f64>>,
    /// Covariance between the impacts of one fruit; rows.
    pub within_fruit: Option<Vec<Vec<f64>>>,
    /// Fruit.
    pub fruit: usize,
    /// Impacts on them.
    pub impacts: usize,
    /// How it was estimated.
    pub method: String,
    /// Effects of covariates.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub covariates: Vec<CardCovariate>,
}

/// Effect of a covariate on a parameter.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, utoipa::ToSchema)]
#[serde(deny_unknown_fields)]
pub struct CardCovariate {
    /// The covariate, such as "impact_velocity".
    pub name: String,
    /// Its unit.
    pub unit: String,
    /// On what: "ln k".
    pub on: String,
    /// Value of the covariate at which the median holds.
    pub centre: f64,
    /// Change of what it is on per unit of the covariate.
    pub effect: f64,
    /// Standard uncertainty of the effect.
    pub sd: Option<f64>,
}

/// A user's law on a card.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, utoipa::ToSchema)]
#[serde(deny_unknown_fields)]
pub struct CardDefinition {
    /// Formula of the force in x (m) and v (m/s); N.
    pub force: Option<String>,
    /// Formula below the largest displacement so far, where the law has memory; N.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schema(nullable = false)]
    pub unloading: Option<String>,
    /// Displacements of a table; m.
    #[serde(rename = "displacement_m")]
    pub displacement: Option<Vec<f64>>,
    /// Its forces; N.
    #[serde(rename = "force_N")]
    pub table_force: Option<Vec<f64>>,
    /// Its damping; N s/m.
    #[serde(rename = "damping_N_s_m")]
    pub damping: Option<Vec<f64>>,
    /// Parameters of the formula, in their order.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub parameters: Vec<CardDefinedParameter>,
}

/// A parameter of a user's law on a card; SI.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, utoipa::ToSchema)]
#[serde(deny_unknown_fields)]
pub struct CardDefinedParameter {
    /// Name.
    pub name: String,
    /// SI unit.
    pub unit: String,
    /// What it is.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub meaning: String,
    /// Smallest value.
    pub lower: Option<f64>,
    /// Largest value.
    pub upper: Option<f64>,
    /// Where a fit begins.
    pub start: Option<f64>,
    /// Value where none is given.
    pub default: Option<f64>,
}

/// A parameter of a card.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, utoipa::ToSchema)]
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
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, utoipa::ToSchema)]
#[serde(deny_unknown_fields)]
pub struct CardCovariance {
    /// Of what: "ln k", "e".
    pub of: Vec<String>,
    /// Rows.
    pub matrix: Vec<Vec<f64>>,
    /// What its scatter is: noise of the recordings, or from drop to drop.
    pub of_what: String,
}

/// What a covariance or a population is of: "ln k", "e".
pub fn labels_of(names: &[String], logarithmic: &[bool]) -> Vec<String> {
    let label = |(name, logarithmic): (&String, &bool)| match logarithmic {
        true => format!("ln {name}"),
        false => name.clone(),
    };
    names.iter().zip(logarithmic).map(label).collect()
}

/// Range in which a law was seen; SI.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, utoipa::ToSchema)]
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

/// Lowest and highest of some values.
pub fn range_of_values(values: impl IntoIterator<Item = f64>) -> [f64; 2] {
    let nothing = [f64::INFINITY, f64::NEG_INFINITY];
    values.into_iter().fold(nothing, |range, value| {
        [range[0].min(value), range[1].max(value)]
    })
}

/// Bodies of a card.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, utoipa::ToSchema)]
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
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, utoipa::ToSchema)]
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
