//! `windfall card show`: what the force laws say about themselves.

use crate::user_laws::read::laws_of_option;
use serde::Serialize;
use std::fmt::Write;
use std::path::Path;
use windfall_contact::laws::kind::LawKind;
use windfall_contact::parameter::LawDescription;
use windfall_files::error::Error;
use windfall_files::option_value::unusable;
use windfall_files::table::write::{csv_text, number_cell};
use windfall_files::text::table::table_text;

/// A force law, as JSON shows it.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct LawCardText {
    /// Description of the law.
    #[serde(flatten)]
    pub law: &'static LawDescription,
    /// What the user of an own law should know.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub findings: Vec<String>,
}

/// All laws, or the one that is named; with a file of laws, those of it, or the
/// one that is named among it and the built-in ones.
///
/// # Errors
/// There is no law of that name; names the nearest ones.
pub fn law_cards(name: Option<&str>, laws: Option<&Path>) -> Result<Vec<LawCardText>, Error> {
    let own = laws_of_option(laws)?;
    let kinds = match name {
        None if laws.is_some() => own,
        None => LawKind::ALL.to_vec(),
        Some(name) => {
            let found = LawKind::from_name_among(name, &own);
            vec![found.map_err(|error| unusable(format!("--law {name}"), error.to_string()))?]
        }
    };
    Ok(kinds.into_iter().map(card_of).collect())
}

fn card_of(kind: LawKind) -> LawCardText {
    LawCardText {
        law: kind.describe(),
        findings: match kind {
            LawKind::User(user) => user.findings().iter().map(ToString::to_string).collect(),
            _ => Vec::new(),
        },
    }
}

/// Laws as text: each with formula, source and a table of its parameters.
pub fn text_of_laws(laws: &[LawCardText]) -> String {
    let mut text = String::new();
    for LawCardText { law, findings } in laws {
        let _ = writeln!(text, "{}", expression(law));
        let _ = writeln!(text, "  formula:     {}", law.formula);
        let _ = writeln!(text, "  first touch: {}", law.first_touch);
        let _ = writeln!(text, "  source:      {}", law.source);
        let header = ["parameter", "unit", "bounds", "typical", "meaning"].map(str::to_owned);
        let rows = law.parameters.iter().map(|p| {
            let upper = p.bound_above().map_or_else(|| "∞".to_owned(), short);
            let bounds = format!("{} … {upper}", short(p.lower));
            let usual = p
                .default
                .map_or_else(|| short(p.typical), |d| format!("{} held", short(d)));
            [p.name, p.unit, &bounds, &usual, p.meaning]
                .map(str::to_owned)
                .to_vec()
        });
        for line in table_text(&header, rows, &[0, 1, 4]).lines() {
            let _ = writeln!(text, "  {line}");
        }
        for finding in findings {
            let _ = writeln!(text, "  finding: {finding}");
        }
        text.push('\n');
    }
    text
}

/// A number without long rows of zeros: "1e30".
fn short(value: f64) -> String {
    match value != 0.0 && !(1e-4..1e7).contains(&value.abs()) {
        true => format!("{value:e}"),
        false => value.to_string(),
    }
}

/// "power-law(k, n=1.5, c, p=0.5)".
fn expression(law: &LawDescription) -> String {
    let parameters: Vec<String> = law
        .parameters
        .iter()
        .map(|p| {
            p.default
                .map_or_else(|| p.name.to_owned(), |d| format!("{}={d}", p.name))
        })
        .collect();
    format!("{}({})", law.name, parameters.join(", "))
}

/// Laws as CSV: one row per parameter.
///
/// # Errors
/// None in practice: the text is written to memory.
pub fn csv_of_laws(laws: &[LawCardText]) -> Result<String, Error> {
    let header = [
        "law",
        "formula",
        "source",
        "parameter",
        "unit",
        "lower",
        "upper",
        "typical",
        "default",
        "meaning",
    ];
    let rows = laws.iter().flat_map(|LawCardText { law, .. }| {
        law.parameters.iter().map(|p| {
            vec![
                law.name.to_owned(),
                law.formula.to_owned(),
                law.source.to_owned(),
                p.name.to_owned(),
                p.unit.to_owned(),
                p.lower.to_string(),
                number_cell(p.bound_above()),
                p.typical.to_string(),
                number_cell(p.default),
                p.meaning.to_owned(),
            ]
        })
    });
    csv_text(&header.map(str::to_owned), rows)
}
