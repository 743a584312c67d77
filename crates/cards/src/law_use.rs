//! A law in use: where it comes from, and whether it is used in the range in
//! which it was seen.

use crate::law_card::CardRange;
use crate::read_card::{law_of_card, read_card};
use crate::user_laws::read::laws_of_option;
use std::path::Path;
use windfall_contact::expression::parse_law_among;
use windfall_contact::law::EndRule;
use windfall_contact::laws::kind::{Law, LawKind};
use windfall_files::error::Error;
use windfall_files::found::FindingOutcome;
use windfall_files::option_value::unusable;
use windfall_files::text::statistic::number;

/// Endings of a law card's name.
pub const CARD_ENDINGS: [&str; 2] = [".toml", ".json"];
/// Rounding that is no excess over a range; 1.
const ROUNDING: f64 = 1e-6;

/// A law with all its parameters, as requested.
#[derive(Clone, Debug, PartialEq)]
pub struct ChosenLaw {
    /// The law.
    pub law: Law,
    /// In what it was seen, where it comes from a card.
    pub range: Option<CardRange>,
}

/// A force law with all its parameters: from an expression of a built-in law or
/// one of `laws`, or from a law card (a text that ends with ".toml" or ".json"
/// is the path of one).
///
/// * `laws`: a file of the user's own laws
///
/// # Errors
/// The expression cannot be read or lacks a parameter; a file cannot be used.
pub fn chosen_law(text: &str, laws: Option<&Path>) -> Result<ChosenLaw, Error> {
    if CARD_ENDINGS.iter().any(|ending| text.ends_with(ending)) {
        let path = Path::new(text);
        let card = read_card(path)?;
        return Ok(ChosenLaw {
            law: law_of_card(&card, path)?,
            range: Some(card.range),
        });
    }
    let law = complete_law_among(text, &laws_of_option(laws)?)?;
    Ok(ChosenLaw { law, range: None })
}

/// A force law with all its parameters from an expression.
///
/// # Errors
/// It cannot be read or lacks a parameter.
pub fn complete_law_among(text: &str, user: &[LawKind]) -> Result<Law, Error> {
    let law = parse_law_among(text, user).and_then(|expression| expression.complete());
    law.map_err(|error| unusable(format!("--law {text}"), error.to_string()))
}

/// A remark on the use of a law.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum LawUseFinding {
    /// A card used outside the range in which its law was seen.
    #[error(
        "{quantity} of {} {unit} is {} than the law's card has seen ({} to {} {unit}), by {}: the law is extrapolated",
        number(*.value), side(.value, .range), number(.range[0]), number(.range[1]), excess(.value, .range)
    )]
    OutsideRange {
        /// What is outside.
        quantity: &'static str,
        /// Its value; SI.
        value: f64,
        /// Lowest and highest that was seen; SI.
        range: [f64; 2],
        /// Unit.
        unit: &'static str,
    },
    /// A table used beyond its end.
    #[error(
        "the displacement reaches {} m, beyond the end of the law's table at {} m: the force is taken as a straight line there",
        number(*.displacement), number(*.end)
    )]
    BeyondTable {
        /// Largest displacement; m.
        displacement: f64,
        /// End of the table; m.
        end: f64,
    },
}

impl LawUseFinding {
    /// Stable name for scripts.
    pub fn code(&self) -> &'static str {
        match self {
            Self::OutsideRange { .. } => "outside-card-range",
            Self::BeyondTable { .. } => "beyond-table",
        }
    }
}

fn side(value: &f64, range: &[f64; 2]) -> &'static str {
    match *value < range[0] {
        true => "lower",
        false => "higher",
    }
}

/// "23 %", or "a factor of 4.2".
fn excess(value: &f64, range: &[f64; 2]) -> String {
    let ratio = match *value < range[0] {
        true => range[0] / value,
        false => value / range[1],
    };
    match ratio < 2.0 {
        true => format!("{:.0} %", (100.0 * (ratio - 1.0)).max(1.0)),
        false => format!("a factor of {}", number(ratio)),
    }
}

/// What a law was used for; SI.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LawUse {
    /// Velocity at first touch.
    pub impact_velocity: f64,
    /// Largest force.
    pub peak_force: f64,
    /// Largest displacement.
    pub displacement: f64,
    /// Effective mass.
    pub mass: f64,
}

/// Remarks on the use of a law: on its formula, its table's end and its card's
/// range.
pub fn findings_of_use(
    law: &Law,
    range: Option<&CardRange>,
    used: &[LawUse],
) -> Vec<FindingOutcome> {
    let mut findings = Vec::new();
    if let LawKind::User(user) = law.kind() {
        findings.extend(
            user.findings()
                .iter()
                .map(|finding| FindingOutcome::new(finding.code(), finding.to_string())),
        );
        let deepest = used
            .iter()
            .map(|used| used.displacement)
            .fold(0.0, f64::max);
        if let Some(end) = user.table_end().filter(|end| deepest > *end) {
            findings.push(outcome(&LawUseFinding::BeyondTable {
                displacement: deepest,
                end,
            }));
        }
    }
    if let Some(range) = range {
        findings.extend(outside(range, used).iter().map(outcome));
    }
    findings
}

fn outcome(finding: &LawUseFinding) -> FindingOutcome {
    FindingOutcome::new(finding.code(), finding.to_string())
}

/// Of each quantity the value that is farthest above and below its range.
fn outside(range: &CardRange, used: &[LawUse]) -> Vec<LawUseFinding> {
    type Part = fn(&LawUse) -> f64;
    let quantities: [(&'static str, &'static str, [f64; 2], Part); 4] = [
        ("an impact velocity", "m/s", range.impact_velocity, |u| {
            u.impact_velocity
        }),
        ("a peak force", "N", range.peak_force, |u| u.peak_force),
        ("a displacement", "m", range.displacement, |u| {
            u.displacement
        }),
        ("a mass", "kg", range.mass, |u| u.mass),
    ];
    let mut findings = Vec::new();
    for (quantity, unit, range, part) in quantities {
        // A card that does not know a range cannot be left.
        if !(range[0].is_finite() && range[1].is_finite()) {
            continue;
        }
        let lowest = used.iter().map(part).fold(f64::INFINITY, f64::min);
        let highest = used.iter().map(part).fold(f64::NEG_INFINITY, f64::max);
        // What grows during an impact passes through all that is below.
        let below = matches!(quantity, "an impact velocity" | "a mass")
            && lowest < range[0] * (1.0 - ROUNDING);
        let above = highest > range[1] * (1.0 + ROUNDING);
        for (found, value) in [(below, lowest), (above, highest)] {
            if found && value.is_finite() {
                findings.push(LawUseFinding::OutsideRange {
                    quantity,
                    value,
                    range,
                    unit,
                });
            }
        }
    }
    findings
}

/// Name of an end rule in files and results.
pub fn end_name(end: EndRule) -> &'static str {
    match end {
        EndRule::ForceZero => "force-zero",
        EndRule::GapZero => "gap-zero",
    }
}
