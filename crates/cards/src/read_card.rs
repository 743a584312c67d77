//! Law cards: file ↔ [`LawCard`], and the law of a card.

use crate::law_card::{CARD_FORMAT, CardDefinedParameter, CardDefinition, LawCard};
use serde::Deserialize;
use std::path::Path;
use windfall_contact::expression::{LawExpression, parse_law_among};
use windfall_contact::formula::error::FormulaError;
use windfall_contact::laws::define_law::define_law;
use windfall_contact::laws::force_table::ForceTable;
use windfall_contact::laws::kind::{Law, LawKind};
use windfall_contact::laws::user::{UserForce, UserLawDefinition, UserParameter};
use windfall_contact::parameter::NO_BOUND;
use windfall_files::error::Error;
use windfall_files::option_value::unusable;
use windfall_files::text::toml_places::invalid_at;
use windfall_files::text::toml_source::{TomlSource, parse_source, read_piped_source};
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
    let source = read_piped_source(path, advice)?;
    let version: CardVersion = parsed(path, &source)?;
    if !(1..=CARD_FORMAT).contains(&version.format) {
        let problem = format!(
            "this windfall reads law cards of formats 1 to {CARD_FORMAT}: use a newer windfall, or \
             write the card again with this one"
        );
        return Err(invalid_at(&source, &["format"], problem));
    }
    let card: LawCard = parsed(path, &source)?;
    let law = law_at(&card, &source)?;
    check_texts(&card, law, &source)?;
    check_signs(&card, &source)?;
    check_sizes(&card, &source)?;
    Ok(card)
}

/// Relative difference of two values that are the same but for rounding.
const ROUNDED: f64 = 1e-6;

/// The expression says what the parameters say, and the end is known.
fn check_texts(card: &LawCard, law: Law, source: &TomlSource) -> Result<(), Error> {
    if !["force-zero", "gap-zero"].contains(&card.end.as_str()) {
        let problem = "expected \"force-zero\" or \"gap-zero\"";
        return Err(invalid_at(source, &["end"], problem));
    }
    let said = parse_law_among(&card.expression, &[law.kind()]).and_then(|own| own.complete());
    let same = |said: Law| {
        let mut pairs = said.parameters().into_iter().zip(law.parameters());
        let close = |(a, b): (f64, f64)| (a - b).abs() <= ROUNDED * a.abs().max(b.abs());
        said.kind() == law.kind() && pairs.all(close)
    };
    match said.is_ok_and(same) {
        true => Ok(()),
        false => {
            let problem = format!("by [parameters] it is {}", LawExpression::from(law));
            Err(invalid_at(source, &["expression"], problem))
        }
    }
}

/// Sizes of bodies are above zero, and uncertainties are not below it.
fn check_signs(card: &LawCard, source: &TomlSource) -> Result<(), Error> {
    let above = |keys: &[&str], value: f64| match value > 0.0 {
        true => Ok(()),
        false => Err(invalid_at(source, keys, "it must be above zero")),
    };
    if let Some(contact) = &card.contact {
        above(&["contact", "effective_radius"], contact.effective_radius)?;
        above(&["contact", "effective_modulus"], contact.effective_modulus)?;
    }
    let bodies = &card.bodies;
    let factor = bodies.effective_mass_factor;
    above(&["bodies", "effective_mass_factor"], factor)?;
    above(&["bodies", "radius"], bodies.radius.unwrap_or(1.0))?;
    for (name, parameter) in &card.parameters {
        if parameter.sd.is_some_and(|sd| sd < 0.0) {
            let keys = ["parameters", name, "sd"];
            return Err(invalid_at(source, &keys, "it must not be below zero"));
        }
    }
    Ok(())
}

/// Lists and matrices must be as large as what they are of.
fn check_sizes(card: &LawCard, source: &TomlSource) -> Result<(), Error> {
    let square = |matrix: &[Vec<f64>], size: usize| {
        matrix.len() == size && matrix.iter().all(|row| row.len() == size)
    };
    let covariance = card.covariance.as_ref();
    let population = card.population.as_ref();
    for (number, of) in population.iter().flat_map(|own| &own.of).enumerate() {
        let name = of.strip_prefix("ln ").unwrap_or(of);
        if !card.parameters.contains_key(name) {
            let keys = ["population", "of", &number.to_string()];
            let problem = format!("{} has no such parameter", card.law);
            return Err(invalid_at(source, &keys, problem));
        }
    }
    let mut lists = Vec::new();
    if let Some(own) = covariance {
        let matrix = square(&own.matrix, own.of.len());
        lists.push((["covariance", "matrix"], matrix));
    }
    if let Some(own) = population {
        let size = own.of.len();
        let within = own.within_fruit.as_ref();
        lists.push((["population", "median"], own.median.len() == size));
        let between = square(&own.between_fruit, size);
        lists.push((["population", "between_fruit"], between));
        let within = within.is_none_or(|within| square(within, size));
        lists.push((["population", "within_fruit"], within));
    }
    let mut odd = lists.iter().filter(|(_, fits)| !fits).map(|(keys, _)| keys);
    match (odd.next(), odd.next()) {
        (None, _) => Ok(()),
        (Some(keys), None) => {
            let problem = "it is not of the size of the list `of` of this table";
            Err(invalid_at(source, keys, problem))
        }
        (Some([table, _]), Some(_)) => {
            let problem = "the matrices of this table are not of the size of this list";
            Err(invalid_at(source, &[*table, "of"], problem))
        }
    }
}

fn parsed<T: serde::de::DeserializeOwned>(path: &Path, source: &TomlSource) -> Result<T, Error> {
    if !is_json(path) {
        return parse_source(source);
    }
    let wrong = |error: serde_json::Error| wrong(path, error.to_string());
    let mut value: serde_json::Value = serde_json::from_str(&source.text).map_err(wrong)?;
    let shown = value.as_object_mut().is_some_and(|keys| {
        // What a command that shows a card says of its own.
        let head = ["windfall", "schema"].map(|key| keys.remove(key).is_some());
        head.contains(&true)
    });
    match shown {
        true => serde_json::from_value(value).map_err(wrong),
        // Its errors tell the line.
        false => serde_json::from_str(&source.text).map_err(wrong),
    }
}

/// The law of a card.
///
/// # Errors
/// The law is not known or cannot be used, a parameter is missing, or out of
/// bounds.
pub fn law_of_card(card: &LawCard, path: &Path) -> Result<Law, Error> {
    let path = path.to_path_buf();
    // Of a card that was read before, what is wrong is nowhere in a text.
    let text = String::new();
    law_at(card, &TomlSource { path, text })
}

/// [`law_of_card`] whose errors name the place in its text.
fn law_at(card: &LawCard, source: &TomlSource) -> Result<Law, Error> {
    use windfall_contact::error::Error as LawError;
    let kind = match &card.definition {
        Some(own) if own.force.is_none() && own.unloading.is_some() => {
            let problem = "unloading belongs to a formula `force`; a table has no memory";
            return Err(invalid_at(source, &["definition", "unloading"], problem));
        }
        Some(definition) => define_law(&defined(&card.law, definition)).map_err(|error| {
            let key = match (&error, &definition.force) {
                (LawError::UserLaw { problem, .. }, _)
                    if matches!(**problem, FormulaError::Unloading(_)) =>
                {
                    "unloading"
                }
                (_, Some(_)) => "force",
                (_, None) => "displacement_m",
            };
            invalid_at(source, &["definition", key], error.to_string())
        })?,
        None => LawKind::from_name(&card.law)
            .map_err(|error| invalid_at(source, &["law"], error.to_string()))?,
    };
    let values = kind.describe().parameters.iter().map(|parameter| {
        let found = card.parameters.get(parameter.name);
        found.map(|found| found.value).ok_or_else(|| {
            let keys = ["parameters", parameter.name];
            invalid_at(source, &keys, "this parameter of the law is missing")
        })
    });
    let values = values.collect::<Result<Vec<f64>, Error>>()?;
    kind.with_parameters(&values).map_err(|error| match error {
        LawError::OutOfBounds { parameter, .. } => {
            let keys = ["parameters", parameter, "value"];
            invalid_at(source, &keys, error.to_string())
        }
        _ => invalid_at(source, &["parameters"], error.to_string()),
    })
}

fn wrong(path: &Path, problem: String) -> Error {
    unusable(
        path.display().to_string(),
        format!("not a usable law card: {problem}"),
    )
}

fn defined(name: &str, card: &CardDefinition) -> UserLawDefinition {
    let force = match (&card.force, &card.unloading) {
        (Some(formula), None) => UserForce::Formula(formula.clone()),
        (Some(formula), Some(unloading)) => UserForce::WithMemory {
            force: formula.clone(),
            unloading: unloading.clone(),
        },
        (None, _) => UserForce::Table(ForceTable {
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
        unloading: None,
        displacement: None,
        table_force: None,
        damping: None,
        parameters: parameters.collect(),
    };
    match &definition.force {
        UserForce::Formula(formula) => card.force = Some(formula.clone()),
        UserForce::WithMemory { force, unloading } => {
            card.force = Some(force.clone());
            card.unloading = Some(unloading.clone());
        }
        UserForce::Table(table) => {
            card.displacement = Some(table.displacement.clone());
            card.table_force = Some(table.force.clone());
            card.damping.clone_from(&table.damping);
        }
    }
    Some(card)
}
