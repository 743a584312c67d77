//! `windfall card show --library`: published values and models.

use crate::library::values::{LibraryEntry, evaluate_model, library};
use serde::Serialize;
use windfall_contact::expression::parse_law;
use windfall_files::error::Error;
use windfall_files::option_value::{quantity, unusable};
use windfall_files::text::toml_source::suggestion;

/// Which entries are wanted.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct LibraryRequest {
    /// Name of an entry; all if left out.
    pub name: Option<String>,
    /// Only entries of this body ("apple") or variety.
    pub fruit: Option<String>,
    /// Where regressions are evaluated: "V=0.34 m/s, R=50 mm, t=6 ms".
    pub at: Option<String>,
}

/// Entries, and what their regressions give.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct LibraryOutcome {
    /// The entries.
    pub entries: Vec<LibraryEntry>,
    /// Values of the entries' regressions, if requested.
    pub evaluated: Vec<Evaluated>,
}

/// What the regressions of one entry give at one place.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct Evaluated {
    /// Name of the entry.
    pub entry: String,
    /// Symbol and value of each variable; SI.
    pub at: Vec<NamedValue>,
    /// What the regressions give; SI.
    pub values: Vec<NamedValue>,
    /// The law of these values, as `--law` takes it.
    pub law: Option<String>,
    /// Variables outside the range they were measured in.
    pub warnings: Vec<String>,
}

/// A number with its name.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct NamedValue {
    /// The name.
    pub name: String,
    /// The number; SI.
    pub value: f64,
    /// Its SI unit.
    pub unit: String,
}

/// The requested entries.
///
/// # Errors
/// No entry of that name or fruit (names the nearest); a place that cannot be
/// read, lacks a variable, or is asked of entries without regressions.
pub fn show_library(request: &LibraryRequest) -> Result<LibraryOutcome, Error> {
    let all = library()?;
    let mut entries: Vec<LibraryEntry> = all
        .iter()
        .filter(|entry| request.name.as_ref().is_none_or(|name| *name == entry.name))
        .filter(|entry| {
            request
                .fruit
                .as_ref()
                .is_none_or(|fruit| is_of(entry, fruit))
        })
        .cloned()
        .collect();
    if entries.is_empty() {
        return Err(nothing_found(request, &all));
    }
    let mut evaluated = Vec::new();
    if let Some(at) = &request.at {
        entries.retain(|entry| !entry.models.is_empty());
        if entries.is_empty() {
            let known: Vec<&str> = all
                .iter()
                .filter(|entry| !entry.models.is_empty())
                .map(|entry| entry.name.as_str())
                .collect();
            return Err(unusable(
                "--at",
                format!(
                    "none of these entries is a regression; those are {}",
                    known.join(", ")
                ),
            ));
        }
        for entry in &entries {
            evaluated.push(evaluate(entry, at)?);
        }
    }
    Ok(LibraryOutcome { entries, evaluated })
}

fn is_of(entry: &LibraryEntry, fruit: &str) -> bool {
    let same = |text: &str| text.eq_ignore_ascii_case(fruit.trim());
    same(&entry.body) || entry.variety.as_deref().is_some_and(same)
}

fn nothing_found(request: &LibraryRequest, all: &[LibraryEntry]) -> Error {
    match (&request.name, &request.fruit) {
        (Some(name), None) => {
            let hint = suggestion(name, all.iter().map(|entry| entry.name.as_str()));
            let advice = "`windfall card show --library` lists all";
            unusable(
                "--library",
                format!("there is no entry \"{name}\"{hint}; {advice}"),
            )
        }
        (_, Some(fruit)) => {
            let mut bodies: Vec<&str> = all.iter().map(|entry| entry.body.as_str()).collect();
            bodies.sort_unstable();
            bodies.dedup();
            unusable(
                "--fruit",
                format!(
                    "nothing is known of \"{fruit}\"; bodies: {}",
                    bodies.join(", ")
                ),
            )
        }
        (None, None) => unusable("--library", "the library is empty"),
    }
}

/// What the regressions of an entry give at a place.
///
/// # Errors
/// The place cannot be read, names another variable, or lacks one.
fn evaluate(entry: &LibraryEntry, text: &str) -> Result<Evaluated, Error> {
    let mut at: Vec<(String, f64)> = Vec::new();
    for part in text.split(',').map(str::trim).filter(|p| !p.is_empty()) {
        let (name, value) = part.split_once('=').ok_or_else(|| {
            unusable(
                "--at",
                format!("\"{part}\": expected NAME=VALUE, as in V=0.34 m/s"),
            )
        })?;
        let name = name.trim();
        let variable = entry.variable(name).ok_or_else(|| {
            let known: Vec<&str> = entry.variables.iter().map(|v| v.name.as_str()).collect();
            unusable(
                "--at",
                format!(
                    "{} has no variable \"{name}\"; it has {}",
                    entry.name,
                    known.join(", ")
                ),
            )
        })?;
        if at.iter().any(|(known, _)| known == name) {
            return Err(unusable("--at", format!("{name} is given twice")));
        }
        at.push((
            name.to_owned(),
            quantity("--at", value.trim(), &variable.unit)?,
        ));
    }
    let values = entry.models.iter().map(|model| {
        let value = evaluate_model(model, &at).ok_or_else(|| missing_variable(entry, &at))?;
        Ok(NamedValue {
            name: model.quantity.clone(),
            value,
            unit: model.unit.clone(),
        })
    });
    let values = values.collect::<Result<Vec<_>, Error>>()?;
    let (law, mut warnings) = law_of(entry, &values);
    warnings.extend(outside(entry, &at));
    Ok(Evaluated {
        entry: entry.name.clone(),
        at: at
            .into_iter()
            .map(|(name, value)| {
                let variable = entry.variable(&name);
                let unit = variable.map_or_else(String::new, |v| v.unit.clone());
                NamedValue { name, value, unit }
            })
            .collect(),
        values,
        law,
        warnings,
    })
}

fn missing_variable(entry: &LibraryEntry, at: &[(String, f64)]) -> Error {
    let missing: Vec<String> = entry
        .variables
        .iter()
        .filter(|variable| at.iter().all(|(name, _)| *name != variable.name))
        .map(|variable| {
            format!(
                "{} ({}, {})",
                variable.name, variable.meaning, variable.unit
            )
        })
        .collect();
    unusable(
        "--at",
        format!("{} also needs {}", entry.name, missing.join(", ")),
    )
}

/// The law with these parameters, where it is one; else why not.
fn law_of(entry: &LibraryEntry, values: &[NamedValue]) -> (Option<String>, Vec<String>) {
    let Some(name) = &entry.law else {
        return (None, Vec::new());
    };
    let parameters: Vec<String> = values
        .iter()
        .map(|value| format!("{}={}", value.name, value.value))
        .collect();
    let expression = format!("{name}({})", parameters.join(", "));
    match parse_law(&expression) {
        Ok(law) => (Some(law.to_string()), Vec::new()),
        Err(error) => (None, vec![format!("no law: {error}")]),
    }
}

fn outside(entry: &LibraryEntry, at: &[(String, f64)]) -> Vec<String> {
    let beyond = |(name, value): &(String, f64)| {
        let variable = entry.variable(name)?;
        (*value < variable.seen_from || *value > variable.seen_to).then(|| {
            format!(
                "{name} = {value} {unit} is outside the {from} to {to} {unit} that were measured",
                unit = variable.unit,
                from = variable.seen_from,
                to = variable.seen_to
            )
        })
    };
    at.iter().filter_map(beyond).collect()
}
