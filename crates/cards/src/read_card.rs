//! Law cards: file ↔ [`LawCard`], and the law of a card.

use crate::law_card::{CARD_FORMAT, CardDefinedParameter, CardDefinition, LawCard};
use serde::Deserialize;
use std::path::Path;
use windfall_contact::laws::define_law::define_law;
use windfall_contact::laws::force_table::ForceTable;
use windfall_contact::laws::kind::{Law, LawKind};
use windfall_contact::laws::user::{UserForce, UserLawDefinition, UserParameter};
use windfall_contact::parameter::NO_BOUND;
use windfall_files::error::Error;
use windfall_files::option_value::unusable;
use windfall_files::text::toml_source::{TomlSource, parse_source, read_source};
use windfall_files::write_file::write_whole;

/// Ending of a card in JSON; any other is TOML.
const JSON: &str = "json";

fn is_json(path: &Path) -> bool {
    path.extension()
        .is_some_and(|ending| ending.eq_ignore_ascii_case(JSON))
}

/// A law card as TOML.
///
/// # Errors
/// None in practice: every value has a form in TOML.
pub fn card_text(card: &LawCard) -> Result<String, Error> {
    toml::to_string(card)
        .map(|text| {
            format!(
                "# A force law with its uncertainty, range and origin; numbers are SI.\n\
                 # `windfall card show --file FILE` shows it; commands take the file after --law.\n{text}"
            )
        })
        .map_err(|error| unwritable(error.to_string()))
}

fn unwritable(detail: String) -> Error {
    Error::ResultUnwritable {
        item: "law card".to_owned(),
        detail,
    }
}

/// Writes a law card, as JSON where the name ends with ".json", else as TOML; an
/// older file of that name is replaced.
///
/// # Errors
/// The file cannot be written.
pub fn write_card(path: &Path, card: &LawCard) -> Result<(), Error> {
    let text = match is_json(path) {
        true => serde_json::to_string_pretty(card)
            .map(|text| text + "\n")
            .map_err(|error| unwritable(error.to_string()))?,
        false => card_text(card)?,
    };
    write_whole(path, text.as_bytes())
}

/// What is read of a card first.
#[derive(Deserialize)]
struct CardVersion {
    format: i64,
}

/// Reads a law card of this version or an older one.
///
/// # Errors
/// It is no card, or one of a newer windfall, or its law refuses the values.
pub fn read_card(path: &Path) -> Result<LawCard, Error> {
    let advice = "a law card is written by `windfall fit DIR --card FILE` or \
                  `windfall calibrate DIR --card FILE`";
    let source = read_source(path, advice)?;
    let version: CardVersion = parsed(path, &source)?;
    if !(1..=CARD_FORMAT).contains(&version.format) {
        let problem = format!(
            "it has format {}, and this windfall reads formats 1 to {CARD_FORMAT}: use a newer \
             windfall, or write the card again with this one",
            version.format
        );
        return Err(wrong(path, problem));
    }
    let card: LawCard = parsed(path, &source)?;
    law_of_card(&card, path)?;
    check_sizes(&card, path)?;
    Ok(card)
}

/// Matrices must be as large as what they are of.
fn check_sizes(card: &LawCard, path: &Path) -> Result<(), Error> {
    let square = |matrix: &[Vec<f64>], size: usize| {
        matrix.len() == size && matrix.iter().all(|row| row.len() == size)
    };
    let covariance = card.covariance.as_ref();
    let population = card.population.as_ref();
    let bad = match () {
        () if covariance.is_some_and(|c| !square(&c.matrix, c.of.len())) => "[covariance]",
        () if population.is_some_and(|p| {
            let size = p.of.len();
            let within = p.within_fruit.as_ref();
            p.median.len() != size
                || !square(&p.between_fruit, size)
                || within.is_some_and(|within| !square(within, size))
        }) =>
        {
            "[population]"
        }
        () => return Ok(()),
    };
    let problem = format!("the matrices of {bad} are not of the size of its list `of`");
    Err(wrong(path, problem))
}

fn parsed<T: serde::de::DeserializeOwned>(path: &Path, source: &TomlSource) -> Result<T, Error> {
    match is_json(path) {
        true => serde_json::from_str(&source.text).map_err(|error| wrong(path, error.to_string())),
        false => parse_source(source),
    }
}

/// The law of a card.
///
/// # Errors
/// The law is not known or cannot be used, a parameter is missing, or out of
/// bounds.
pub fn law_of_card(card: &LawCard, path: &Path) -> Result<Law, Error> {
    let told = |error: windfall_contact::error::Error| wrong(path, error.to_string());
    let kind = match &card.definition {
        Some(definition) => define_law(&defined(&card.law, definition)).map_err(told)?,
        None => LawKind::from_name(&card.law).map_err(told)?,
    };
    let values = kind.describe().parameters.iter().map(|parameter| {
        let found = card.parameters.get(parameter.name);
        found.map(|found| found.value).ok_or_else(|| {
            let name = parameter.name;
            wrong(path, format!("it has no [parameters.{name}]"))
        })
    });
    let values = values.collect::<Result<Vec<f64>, Error>>()?;
    kind.with_parameters(&values).map_err(told)
}

fn wrong(path: &Path, problem: String) -> Error {
    unusable(
        path.display().to_string(),
        format!("not a usable law card: {problem}"),
    )
}

fn defined(name: &str, card: &CardDefinition) -> UserLawDefinition {
    let force = match &card.force {
        Some(formula) => UserForce::Formula(formula.clone()),
        None => UserForce::Table(ForceTable {
            displacement: card.displacement.clone().unwrap_or_default(),
            force: card.table_force.clone().unwrap_or_default(),
            damping: card.damping.clone(),
        }),
    };
    let parameter = |p: &CardDefinedParameter| UserParameter {
        name: p.name.clone(),
        unit: p.unit.clone(),
        meaning: p.meaning.clone(),
        lower: p.lower.unwrap_or(f64::NEG_INFINITY),
        upper: p.upper.unwrap_or(f64::INFINITY),
        start: p.start,
        default: p.default,
    };
    UserLawDefinition {
        name: name.to_owned(),
        force,
        parameters: card.parameters.iter().map(parameter).collect(),
    }
}

/// The definition that a card carries; none for a built-in law.
pub fn card_definition(kind: LawKind) -> Option<CardDefinition> {
    let LawKind::User(user) = kind else {
        return None;
    };
    let definition = user.definition();
    let parameters = definition.parameters.iter().map(|p| CardDefinedParameter {
        name: p.name.clone(),
        unit: p.unit.clone(),
        meaning: p.meaning.clone(),
        lower: Some(p.lower).filter(|value| *value > -NO_BOUND),
        upper: Some(p.upper).filter(|value| *value < NO_BOUND),
        start: p.start,
        default: p.default,
    });
    let mut card = CardDefinition {
        force: None,
        displacement: None,
        table_force: None,
        damping: None,
        parameters: parameters.collect(),
    };
    match &definition.force {
        UserForce::Formula(formula) => card.force = Some(formula.clone()),
        UserForce::Table(table) => {
            card.displacement = Some(table.displacement.clone());
            card.table_force = Some(table.force.clone());
            card.damping.clone_from(&table.damping);
        }
    }
    Some(card)
}
