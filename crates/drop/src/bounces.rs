//! `[bounces]` of campaign.toml.

use crate::file::BouncesFile;
use windfall_campaign::settings::file::QuantityText;
use windfall_files::error::Error;
use windfall_files::text::spanned::Spanned;
use windfall_files::text::toml_source::{
    Needed, TomlSource, number_that, optional_quantity, positive_quantity, refused,
};
use windfall_signal::bounce::train::{BounceOptions, StaticLevel};
use windfall_signal::trigger::Threshold;

/// How bounces are separated from noise and ringing of the plate.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BouncePlan {
    /// How bounces are found.
    pub options: BounceOptions,
    /// Least impulse of a bounce, as a part of m v; from the noise if `None`. 1.
    pub least_impulse: Option<f64>,
    /// Cycles of the logarithmic decrement; those with the least uncertainty if `None`.
    pub ringing_cycles: Option<usize>,
}

const TABLE: &str = "[bounces]";

/// Asks for a threshold from the noise.
const AUTO: &str = "auto";

/// Most cycles of a logarithmic decrement.
const MOST_CYCLES: u32 = 100;

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
    let needed = |key, meaning, unit, example| Needed::of(TABLE, key, meaning, unit, example);
    let threshold = needed(
        "threshold",
        "contact force above which a contact begins",
        "N",
        "threshold = \"0.3 N\"   or   threshold = \"auto\"",
    );
    let gap = needed(
        "minimum_gap",
        "contacts closer than this are one",
        "s",
        "minimum_gap = \"1 ms\"",
    );
    let given = file.threshold.as_ref();
    let given = given.filter(|text| text.get_ref().0 != AUTO);
    let force = positive_quantity(source, given, &threshold)?;
    Ok(BouncePlan {
        options: BounceOptions {
            static_level: static_level(source, file.static_level.as_ref())?,
            threshold: force.map_or(defaults.threshold, Threshold::Fixed),
            release: part(source, file.release.as_ref(), "release")?.unwrap_or(defaults.release),
            smallest_gap: positive_quantity(source, file.minimum_gap.as_ref(), &gap)?,
            ..defaults
        },
        least_impulse: part(source, file.least_impulse.as_ref(), "least_impulse")?,
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
        refused(source, text, (TABLE, needed.key), problem)
    })?;
    Ok(level.map_or(StaticLevel::default(), StaticLevel::Given))
}

fn part(
    source: &TomlSource,
    value: Option<&Spanned<f64>>,
    key: &'static str,
) -> Result<Option<f64>, Error> {
    let (fits, expected) = (
        |part| part > 0.0 && part < 1.0,
        "a part above 0 and below 1",
    );
    number_that(source, value, (TABLE, key), fits, expected)
}

fn cycles(source: &TomlSource, value: Option<&Spanned<u32>>) -> Result<Option<usize>, Error> {
    let fits = |n| (1..=MOST_CYCLES).contains(&n);
    let expected = format!("a whole number from 1 to {MOST_CYCLES}");
    let cycles = number_that(source, value, (TABLE, "ringing_cycles"), fits, &expected)?;
    Ok(cycles.map(|cycles| cycles as usize))
}
