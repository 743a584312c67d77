//! Published values and models of fruit contacts, each with its source and what
//! to beware of.

use crate::library::file::{
    EntryFile, LibraryFile, LibraryModel, LibraryTerm, LibraryVariable, SourceFile, ValueFile,
};
use serde::Serialize;
use std::path::Path;
use windfall_files::error::Error;
use windfall_files::option_value;
use windfall_files::text::toml_source::{TomlSource, parse_source};
use windfall_numerics::unit::quantity::{parse_as, parse_quantity, parse_unit};

/// One publication's values for one body.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct LibraryEntry {
    /// Name to ask for it.
    pub name: String,
    /// What was struck, dropped or pressed.
    pub body: String,
    /// Its variety or kind.
    pub variety: Option<String>,
    /// What it met.
    pub counterpart: Option<String>,
    /// How it was measured.
    pub conditions: Option<String>,
    /// Values; SI.
    pub values: Vec<LibraryValue>,
    /// Regressions, all in SI.
    pub models: Vec<LibraryModel>,
    /// Variables of the regressions.
    pub variables: Vec<LibraryVariable>,
    /// The force law the values make, as `--law` takes it; for regressions its
    /// name.
    pub law: Option<String>,
    /// The publication.
    pub citation: String,
    /// Its digital object identifier.
    pub doi: Option<String>,
    /// Table or section.
    pub place: String,
    /// What was read of it: "full text" or "abstract".
    pub seen: String,
    /// What to beware of.
    pub cautions: Vec<String>,
}

impl LibraryEntry {
    /// The variable of a name.
    pub(crate) fn variable(&self, name: &str) -> Option<&LibraryVariable> {
        self.variables.iter().find(|variable| variable.name == name)
    }
}

/// One published value.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct LibraryValue {
    /// What it is.
    pub quantity: String,
    /// The value; SI.
    pub value: f64,
    /// Standard deviation; SI.
    pub deviation: Option<f64>,
    /// Dimension in SI units; empty for pure numbers.
    pub unit: String,
    /// As it is printed.
    pub printed: String,
    /// Conditions of this value alone.
    pub conditions: Option<String>,
    /// Its place, where it is not the entry's.
    pub place: Option<String>,
}

/// All published values and models that come with windfall.
///
/// # Errors
/// None as windfall is delivered; the text is part of the program.
pub fn library() -> Result<Vec<LibraryEntry>, Error> {
    let source = TomlSource {
        path: Path::new("library.toml (built in)").to_path_buf(),
        text: include_str!("../../data/library.toml").to_owned(),
    };
    let file: LibraryFile = parse_source(&source)?;
    let entries = file.entry.into_iter();
    entries.map(|entry| entry_of(entry, &file.source)).collect()
}

fn unusable(entry: &EntryFile, problem: impl std::fmt::Display) -> Error {
    option_value::unusable(format!("library entry {}", entry.name), problem.to_string())
}

fn entry_of(entry: EntryFile, sources: &[SourceFile]) -> Result<LibraryEntry, Error> {
    let source = sources.iter().find(|source| source.key == entry.source);
    let source = source.ok_or_else(|| unusable(&entry, format!("no source {}", entry.source)))?;
    let values = entry.value.iter().map(|value| value_of(&entry, value));
    Ok(LibraryEntry {
        values: values.collect::<Result<_, Error>>()?,
        name: entry.name,
        body: entry.body,
        variety: entry.variety,
        counterpart: entry.counterpart,
        conditions: entry.conditions,
        models: entry.model.into_iter().map(with_formula).collect(),
        variables: entry.variable,
        law: entry.law,
        citation: source.citation.clone(),
        doi: source.doi.clone(),
        place: entry.r#where,
        seen: entry.seen,
        cautions: entry.cautions,
    })
}

fn value_of(entry: &EntryFile, value: &ValueFile) -> Result<LibraryValue, Error> {
    let failed = |error| unusable(entry, error);
    let quantity = parse_quantity(&value.value).map_err(failed)?;
    let deviation = match (&value.deviation, &value.variation) {
        (Some(text), _) => Some(parse_quantity(text).map_err(failed)?.value),
        (None, Some(text)) => Some(parse_as(text, "1").map_err(failed)? * quantity.value),
        (None, None) => None,
    };
    let spread = value.deviation.as_ref().or(value.variation.as_ref());
    Ok(LibraryValue {
        quantity: value.quantity.clone(),
        value: quantity.value,
        deviation,
        unit: si_unit(&value.value, &quantity.dimension.to_string()),
        printed: match spread {
            Some(spread) => format!("{} ± {spread}", value.value),
            None => value.value.clone(),
        },
        conditions: value.conditions.clone(),
        place: value.r#where.clone(),
    })
}

/// The unit as printed where it is SI, else the dimension in SI units; empty for
/// pure numbers.
fn si_unit(printed: &str, dimension: &str) -> String {
    let unit = printed.split_once(' ').map_or("", |(_, unit)| unit.trim());
    match parse_unit(unit) {
        Ok(known) if known.multiply == 1.0 && known.divide == 1.0 => unit.to_owned(),
        _ if dimension == "1" => String::new(),
        _ => dimension.to_owned(),
    }
}

fn with_formula(model: LibraryModel) -> LibraryModel {
    LibraryModel {
        formula: formula_of(&model.quantity, &model.terms),
        ..model
    }
}

/// "k = 662728.094 - 328492.591 V + …".
fn formula_of(quantity: &str, terms: &[LibraryTerm]) -> String {
    let mut text = format!("{quantity} =");
    for (place, term) in terms.iter().enumerate() {
        let sign = match (place, term.coefficient < 0.0) {
            (0, false) => "",
            (0, true) => " -",
            (_, false) => " +",
            (_, true) => " -",
        };
        text += &format!("{sign} {}", term.coefficient.abs());
        for name in &term.of {
            text += &format!(" {name}");
        }
    }
    text
}

/// The value of a regression.
///
/// * `at`: symbol and value of every variable; SI
///
/// `None` where a variable has no value.
pub fn evaluate_model(model: &LibraryModel, at: &[(String, f64)]) -> Option<f64> {
    let value_of = |name: &String| at.iter().find(|(known, _)| known == name).map(|(_, v)| v);
    model
        .terms
        .iter()
        .map(|term| {
            term.of.iter().try_fold(term.coefficient, |product, name| {
                value_of(name).map(|value| product * value)
            })
        })
        .sum()
}
