//! `[bounces]` of campaign.toml.

use crate::error::Error;
use crate::file_campaign::QuantityText;
use crate::file_drop::BouncesFile;
use crate::toml_source::{Needed, TomlSource, invalid, optional_quantity};
use toml::Spanned;

/// How bounces are told from noise and from the ringing of the plate.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BouncePlan {
    /// Force above which a bounce begins; from the noise where there is none. N.
    pub threshold: Option<f64>,
    /// Part of the threshold below which it is over; 1.
    pub release: Option<f64>,
    /// Least time from the end of one bounce to the next; s.
    pub minimum_gap: Option<f64>,
    /// Least impulse of a bounce, as a part of m v; 1.
    pub least_impulse: Option<f64>,
    /// Force at rest; from before the first bounce where there is none. N.
    pub static_level: Option<f64>,
    /// Cycles over which the logarithmic decrement is taken.
    pub ringing_cycles: Option<usize>,
}

const TABLE: &str = "[bounces]";

/// Most cycles of a logarithmic decrement.
const MOST_CYCLES: u32 = 100;

/// How the bounces of a campaign are found.
///
/// # Errors
/// A value cannot be used.
pub fn bounce_plan(source: &TomlSource, file: &BouncesFile) -> Result<BouncePlan, Error> {
    let needed = |key, meaning, unit, example| Needed {
        table: TABLE,
        key,
        meaning,
        unit,
        example,
    };
    let threshold = needed(
        "threshold",
        "force above which a bounce begins",
        "N",
        "threshold = \"0.3 N\"   or   threshold = \"auto\"",
    );
    let gap = needed(
        "minimum_gap",
        "least time from the end of one bounce to the next",
        "s",
        "minimum_gap = \"20 ms\"",
    );
    let level = needed(
        "static_level",
        "force at rest",
        "N",
        "static_level = \"1.96 N\"   or   static_level = \"before\"",
    );
    let given =
        |value: &Option<Spanned<QuantityText>>, word: &str| -> Option<Spanned<QuantityText>> {
            value.clone().filter(|text| text.get_ref().0 != word)
        };
    let at_rest = given(&file.static_level, "before");
    Ok(BouncePlan {
        threshold: positive(source, given(&file.threshold, "auto").as_ref(), &threshold)?,
        release: part(source, file.release.as_ref(), "release")?,
        minimum_gap: positive(source, file.minimum_gap.as_ref(), &gap)?,
        least_impulse: part(source, file.least_impulse.as_ref(), "least_impulse")?,
        static_level: optional_quantity(source, at_rest.as_ref(), &level)?,
        ringing_cycles: cycles(source, file.ringing_cycles.as_ref())?,
    })
}

/// A quantity above zero that may be left out; SI.
///
/// # Errors
/// It is no such quantity, or not above zero.
pub fn positive(
    source: &TomlSource,
    value: Option<&Spanned<QuantityText>>,
    needed: &Needed,
) -> Result<Option<f64>, Error> {
    match (value, optional_quantity(source, value, needed)?) {
        (Some(text), Some(number)) if number <= 0.0 => {
            let problem = format!("must be above zero, for example: {}", needed.example);
            let key = (needed.table, needed.key);
            let at = text.span();
            Err(invalid(source, &at, key, &text.get_ref().0, problem))
        }
        (_, number) => Ok(number),
    }
}

fn part(
    source: &TomlSource,
    value: Option<&Spanned<f64>>,
    key: &'static str,
) -> Result<Option<f64>, Error> {
    match value {
        Some(value) if !(*value.get_ref() > 0.0 && *value.get_ref() <= 1.0) => {
            let problem = "expected a part above 0 and up to 1".to_owned();
            let text = value.get_ref().to_string();
            Err(invalid(source, &value.span(), (TABLE, key), &text, problem))
        }
        value => Ok(value.map(|value| *value.get_ref())),
    }
}

fn cycles(source: &TomlSource, value: Option<&Spanned<u32>>) -> Result<Option<usize>, Error> {
    match value {
        Some(value) if !(1..=MOST_CYCLES).contains(value.get_ref()) => {
            let problem = format!("expected a whole number from 1 to {MOST_CYCLES}");
            let text = value.get_ref().to_string();
            let key = (TABLE, "ringing_cycles");
            Err(invalid(source, &value.span(), key, &text, problem))
        }
        value => Ok(value.map(|value| *value.get_ref() as usize)),
    }
}
