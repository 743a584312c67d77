//! `[bounces]` of campaign.toml.

use crate::error::Error;
use crate::file_campaign::QuantityText;
use crate::file_drop::BouncesFile;
use crate::toml_source::{Needed, TomlSource, invalid, optional_quantity};
use toml::Spanned;
use windfall_signal::bounce_train::{BounceOptions, StaticLevel};

/// How bounces are told from noise and from the ringing of the plate.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BouncePlan {
    /// How bounces are found.
    pub options: BounceOptions,
    /// Cycles over which the logarithmic decrement is taken; as many as rise
    /// above the noise where there is none.
    pub ringing_cycles: Option<usize>,
}

const TABLE: &str = "[bounces]";

/// Most cycles of a logarithmic decrement.
const MOST_CYCLES: u32 = 100;

/// Largest threshold; standard deviations of the noise.
const LARGEST_THRESHOLD: f64 = 1e4;

const STATIC_LEVELS: [(&str, StaticLevel); 2] = [
    ("before-first", StaticLevel::BeforeFirst),
    ("follow", StaticLevel::Follow),
];

/// How the bounces of a campaign are found.
///
/// # Errors
/// A value cannot be used.
pub fn bounce_plan(source: &TomlSource, file: &BouncesFile) -> Result<BouncePlan, Error> {
    let defaults = BounceOptions::default();
    let needed = |key, meaning, unit, example| Needed {
        table: TABLE,
        key,
        meaning,
        unit,
        example,
    };
    let gap = needed(
        "smallest_gap",
        "contacts closer than this are one",
        "s",
        "smallest_gap = \"1 ms\"",
    );
    let impulse = needed(
        "smallest_impulse",
        "bounces with less impulse are none",
        "N s",
        "smallest_impulse = \"0.5 mN s\"",
    );
    let between =
        |value: &Option<Spanned<f64>>, key, range| number(source, value.as_ref(), key, range);
    let on = between(&file.on, "on", (0.0, LARGEST_THRESHOLD))?.unwrap_or(defaults.on);
    let off = between(&file.off, "off", (0.0, on))?;
    Ok(BouncePlan {
        options: BounceOptions {
            static_level: static_level(source, file.static_level.as_ref())?,
            on,
            // Half of a threshold that is lower than the usual lower one.
            off: off.unwrap_or(defaults.off.min(0.5 * on)),
            least_share: between(&file.least_share, "least_share", (0.0, 1.0))?
                .unwrap_or(defaults.least_share),
            smallest_gap: positive(source, file.smallest_gap.as_ref(), &gap)?,
            smallest_impulse: positive(source, file.smallest_impulse.as_ref(), &impulse)?,
            ..defaults
        },
        ringing_cycles: cycles(source, file.ringing_cycles.as_ref())?,
    })
}

fn static_level(
    source: &TomlSource,
    value: Option<&Spanned<QuantityText>>,
) -> Result<StaticLevel, Error> {
    let Some(text) = value else {
        return Ok(StaticLevel::default());
    };
    let word = STATIC_LEVELS
        .iter()
        .find(|(name, _)| *name == text.get_ref().0);
    if let Some((_, level)) = word {
        return Ok(*level);
    }
    let needed = Needed {
        table: TABLE,
        key: "static_level",
        meaning: "force of the plate at rest",
        unit: "N",
        example: "static_level = \"1.96 N\"   or   \"before-first\"   or   \"follow\"",
    };
    let level = optional_quantity(source, value, &needed).map_err(|_| {
        let problem = format!("expected a force or a word: {}", needed.example);
        let (at, key) = (text.span(), (TABLE, needed.key));
        invalid(source, &at, key, &text.get_ref().0, problem)
    })?;
    Ok(level.map_or(StaticLevel::default(), StaticLevel::Given))
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

fn number(
    source: &TomlSource,
    value: Option<&Spanned<f64>>,
    key: &'static str,
    (low, high): (f64, f64),
) -> Result<Option<f64>, Error> {
    match value {
        Some(value) if !(*value.get_ref() > low && *value.get_ref() < high) => {
            let problem = format!("expected a number between {low} and {high}");
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
