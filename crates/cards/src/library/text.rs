//! Published values and models as text and CSV.

use crate::library::show::{Evaluated, LibraryOutcome};
use crate::library::values::LibraryEntry;
use std::fmt::Write;
use windfall_files::error::Error;
use windfall_files::table::write::csv_text;
use windfall_files::text::table::{page_tables, paragraph};

/// From this many entries on, a list is shown instead of each in full.
const LIST_FROM: usize = 4;
/// Columns of the CSV.
const HEADER: &str = "name,body,variety,counterpart,quantity,value_SI,deviation_SI,unit_SI,printed,\
                      law,conditions,source,doi,place,seen,cautions";

/// A list of entries, or each in full where there are few.
pub fn text_of_library(outcome: &LibraryOutcome) -> String {
    if outcome.entries.len() >= LIST_FROM {
        return list(&outcome.entries);
    }
    let mut text = String::new();
    for entry in &outcome.entries {
        write_entry(&mut text, entry);
        let values = outcome.evaluated.iter().filter(|e| e.entry == entry.name);
        for evaluated in values {
            write_evaluated(&mut text, evaluated);
        }
        text.push('\n');
    }
    text
}

fn list(entries: &[LibraryEntry]) -> String {
    let header = ["name", "body", "against", "values"].map(str::to_owned);
    let rows = entries.iter().map(|entry| {
        let values = entry.values.iter().map(|value| value.quantity.as_str());
        let models = entry.models.iter().map(|model| model.quantity.as_str());
        let quantities: Vec<&str> = values.chain(models).collect();
        let regression = if entry.models.is_empty() {
            ""
        } else {
            " (regression)"
        };
        vec![
            entry.name.clone(),
            body_of(entry),
            entry.counterpart.clone().unwrap_or_default(),
            format!("{}{regression}", quantities.join(", ")),
        ]
    });
    let rows: Vec<Vec<String>> = rows.collect();
    let table = page_tables(&header, &rows, &[0, 1, 2, 3]);
    format!("{table}\n\nOne in full, with source and cautions: windfall card show --library NAME\n")
}

fn body_of(entry: &LibraryEntry) -> String {
    match &entry.variety {
        Some(variety) => format!("{}, {variety}", entry.body),
        None => entry.body.clone(),
    }
}

fn write_entry(text: &mut String, entry: &LibraryEntry) {
    let _ = writeln!(text, "{}", entry.name);
    let mut line = |name: &str, value: &str| {
        let line = format!("  {:<11} {value}", format!("{name}:"));
        let _ = writeln!(text, "{}", paragraph(&line, 14));
    };
    line("body", &body_of(entry));
    if let Some(counterpart) = &entry.counterpart {
        line("against", counterpart);
    }
    if let Some(conditions) = &entry.conditions {
        line("conditions", conditions);
    }
    for value in &entry.values {
        let conditions = value.conditions.as_ref();
        let note = conditions.map_or_else(String::new, |text| format!(" ({text})"));
        line(&value.quantity, &format!("{}{note}", value.printed));
    }
    for model in &entry.models {
        line(
            &model.quantity,
            &format!(
                "{}   [{}; R² {}]",
                model.formula, model.unit, model.r_squared
            ),
        );
    }
    for variable in &entry.variables {
        let range = format!(
            "{} to {} {}",
            variable.seen_from, variable.seen_to, variable.unit
        );
        line(
            &variable.name,
            &format!("{}, measured from {range}", variable.meaning),
        );
    }
    if let Some(law) = entry.law.as_ref().filter(|_| entry.models.is_empty()) {
        line("law", law);
    }
    let doi = entry.doi.as_ref();
    let doi = doi.map_or_else(String::new, |doi| format!(", doi:{doi}"));
    line(
        "source",
        &format!(
            "{}{doi}; {} (read: {})",
            entry.citation, entry.place, entry.seen
        ),
    );
    for caution in &entry.cautions {
        line("caution", caution);
    }
}

fn write_evaluated(text: &mut String, evaluated: &Evaluated) {
    let place: Vec<String> = evaluated
        .at
        .iter()
        .map(|at| format!("{} = {} {}", at.name, at.value, at.unit))
        .collect();
    let _ = writeln!(text, "\n  at {}:", place.join(", "));
    for value in &evaluated.values {
        let _ = writeln!(text, "    {} = {} {}", value.name, value.value, value.unit);
    }
    if let Some(law) = &evaluated.law {
        let _ = writeln!(text, "    --law '{law}'");
    }
    for warning in &evaluated.warnings {
        let _ = writeln!(text, "    warning: {warning}");
    }
}

/// Entries as CSV: one row per value or regression, SI.
///
/// # Errors
/// None in practice: the text is written to memory.
pub fn csv_of_library(outcome: &LibraryOutcome) -> Result<String, Error> {
    let rows = outcome.entries.iter().flat_map(|entry| {
        let evaluated = outcome.evaluated.iter().find(|e| e.entry == entry.name);
        let values = entry.values.iter().map(|value| Cells {
            quantity: value.quantity.clone(),
            value: value.value.to_string(),
            deviation: value.deviation.map_or_else(String::new, |d| d.to_string()),
            unit: value.unit.clone(),
            printed: value.printed.clone(),
            law: entry.law.clone(),
            conditions: value.conditions.clone().or(entry.conditions.clone()),
        });
        let models = entry.models.iter().map(move |model| {
            let found = evaluated.and_then(|e| e.values.iter().find(|v| v.name == model.quantity));
            Cells {
                quantity: model.quantity.clone(),
                value: found.map_or_else(String::new, |value| value.value.to_string()),
                deviation: String::new(),
                unit: model.unit.clone(),
                printed: model.formula.clone(),
                law: evaluated.and_then(|e| e.law.clone()),
                conditions: entry.conditions.clone(),
            }
        });
        values.chain(models).map(|cells| row_of(entry, cells))
    });
    let header: Vec<String> = HEADER.split(',').map(str::to_owned).collect();
    csv_text(&header, rows)
}

/// The cells of a row that differ within an entry.
struct Cells {
    quantity: String,
    value: String,
    deviation: String,
    unit: String,
    printed: String,
    law: Option<String>,
    conditions: Option<String>,
}

fn row_of(entry: &LibraryEntry, cells: Cells) -> Vec<String> {
    let or_blank = |text: &Option<String>| text.clone().unwrap_or_default();
    vec![
        entry.name.clone(),
        entry.body.clone(),
        or_blank(&entry.variety),
        or_blank(&entry.counterpart),
        cells.quantity,
        cells.value,
        cells.deviation,
        cells.unit,
        cells.printed,
        or_blank(&cells.law),
        or_blank(&cells.conditions),
        entry.citation.clone(),
        or_blank(&entry.doi),
        entry.place.clone(),
        entry.seen.clone(),
        entry.cautions.join("; "),
    ]
}
