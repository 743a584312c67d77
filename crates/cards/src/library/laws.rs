//! `windfall card show`: what the force laws say about themselves.

use crate::user_laws::read::laws_of_option;
use serde::Serialize;
use std::fmt::Write;
use std::path::Path;
use windfall_contact::laws::kind::LawKind;
use windfall_files::error::Error;
use windfall_files::table::write::csv_text;
use windfall_files::text::table::table_text;

/// A force law, as JSON shows it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LawCardText {
    /// Name in law expressions.
    pub name: &'static str,
    /// Formula.
    pub formula: &'static str,
    /// Force and slope at first touch.
    pub first_touch: &'static str,
    /// Where the formula comes from.
    pub source: &'static str,
    /// Parameters.
    pub parameters: Vec<ParameterText>,
    /// What the user of an own law should know.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub findings: Vec<String>,
}

/// A parameter of a force law, as JSON shows it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ParameterText {
    /// Name in law expressions.
    pub name: &'static str,
    /// What it is.
    pub meaning: &'static str,
    /// SI unit.
    pub unit: &'static str,
    /// Smallest legal value.
    pub lower: f64,
    /// Largest legal value; `None` where there is no bound.
    pub upper: Option<f64>,
    /// Typical value for fruit.
    pub typical: f64,
    /// Value when an expression leaves it out.
    pub default: Option<f64>,
}

/// All laws, or the one that is named; with a file of laws, those of it, or the
/// one that is named among it and the built-in ones.
///
/// # Errors
/// There is no law of that name; names the nearest ones.
pub fn law_cards(name: Option<&str>, laws: Option<&Path>) -> Result<Vec<LawCardText>, Error> {
    let own = laws_of_option(laws)?;
    let kinds =
        match name {
            None if laws.is_some() => own,
            None => LawKind::ALL.to_vec(),
            Some(name) => vec![LawKind::from_name_among(name, &own).map_err(|error| {
                Error::OptionInvalid {
                    option: format!("--law {name}"),
                    problem: error.to_string(),
                }
            })?],
        };
    Ok(kinds.into_iter().map(card_of).collect())
}

/// Bounds from here on only keep the arithmetic finite.
const NO_BOUND: f64 = 1e20;

fn card_of(kind: LawKind) -> LawCardText {
    let law = kind.describe();
    let parameter = |p: &windfall_contact::parameter::ParameterDescription| ParameterText {
        name: p.name,
        meaning: p.meaning,
        unit: p.unit,
        lower: p.lower,
        upper: (p.upper < NO_BOUND).then_some(p.upper),
        typical: p.typical,
        default: p.default,
    };
    LawCardText {
        name: law.name,
        formula: law.formula,
        first_touch: law.first_touch,
        source: law.source,
        parameters: law.parameters.iter().map(parameter).collect(),
        findings: match kind {
            LawKind::User(user) => user.findings().iter().map(ToString::to_string).collect(),
            _ => Vec::new(),
        },
    }
}

/// Laws as text: each with formula, source and a table of its parameters.
#[must_use]
pub fn text_of_laws(laws: &[LawCardText]) -> String {
    let mut text = String::new();
    for law in laws {
        let _ = writeln!(text, "{}", expression(law));
        let _ = writeln!(text, "  formula:     {}", law.formula);
        let _ = writeln!(text, "  first touch: {}", law.first_touch);
        let _ = writeln!(text, "  source:      {}", law.source);
        let header = ["parameter", "unit", "bounds", "typical", "meaning"].map(str::to_owned);
        let rows = law.parameters.iter().map(|p| {
            let upper = p.upper.map_or_else(|| "∞".to_owned(), short);
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
        for finding in &law.findings {
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
fn expression(law: &LawCardText) -> String {
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
    let number = |value: Option<f64>| value.map_or_else(String::new, |value| value.to_string());
    let rows = laws.iter().flat_map(|law| {
        law.parameters.iter().map(|p| {
            vec![
                law.name.to_owned(),
                law.formula.to_owned(),
                law.source.to_owned(),
                p.name.to_owned(),
                p.unit.to_owned(),
                p.lower.to_string(),
                number(p.upper),
                p.typical.to_string(),
                number(p.default),
                p.meaning.to_owned(),
            ]
        })
    });
    csv_text(&header.map(str::to_owned), rows)
}
