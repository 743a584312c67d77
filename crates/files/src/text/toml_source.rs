//! A TOML text and the places in it, so that messages name file, line and key.

use crate::error::{Error, Place};
use crate::inputs::{check_piped, check_regular, protect};
use crate::text::file_quantity::QuantityText;
use crate::text::spanned::Spanned;
use std::fmt::Display;
use std::io::ErrorKind;
use std::ops::Range;
use std::path::{Path, PathBuf};
use toml::de::{DeTable, DeValue};
use windfall_numerics::unit::nearest_name::nearest_names;
use windfall_numerics::unit::quantity::{LARGEST, parse_as};
use windfall_numerics::unit::uncertain::parse_uncertain;
use windfall_source::stream::{is_stream, stream_bytes};

/// A TOML file in memory.
pub struct TomlSource {
    /// The file, for messages.
    pub path: PathBuf,
    /// Its text.
    pub text: String,
}

/// A value that must stand in a table: what the message says when it does not.
#[derive(Clone, Copy, Debug)]
pub struct Needed {
    /// The table, with brackets.
    pub table: &'static str,
    /// The key.
    pub key: &'static str,
    /// What it is.
    pub meaning: &'static str,
    /// SI unit of the quantity; empty for other values.
    pub unit: &'static str,
    /// A line that would do.
    pub example: &'static str,
}

impl Needed {
    /// A value of a table, with its meaning, SI unit and a line that would do.
    pub const fn of(
        table: &'static str,
        key: &'static str,
        meaning: &'static str,
        unit: &'static str,
        example: &'static str,
    ) -> Self {
        Self {
            table,
            key,
            meaning,
            unit,
            example,
        }
    }
}

/// Reads a TOML file as text.
///
/// # Errors
/// The file is absent or unreadable, no regular file, or not UTF-8.
pub fn read_source(path: &Path, advice: &str) -> Result<TomlSource, Error> {
    check_regular(path)?;
    read_text(path, advice)
}

/// [`read_source`] of a file that the command line names, which may be a stream.
///
/// # Errors
/// The file is absent or unreadable, a device, or not UTF-8.
pub fn read_piped_source(path: &Path, advice: &str) -> Result<TomlSource, Error> {
    check_piped(path)?;
    read_text(path, advice)
}

fn read_text(path: &Path, advice: &str) -> Result<TomlSource, Error> {
    protect(path);
    let text = match is_stream(path) {
        true => stream_bytes(path).and_then(|bytes| {
            let told = |error| std::io::Error::new(ErrorKind::InvalidData, error);
            String::from_utf8(bytes.to_vec()).map_err(told)
        }),
        false => std::fs::read_to_string(path),
    };
    match text {
        Ok(text) => Ok(TomlSource {
            path: path.to_path_buf(),
            text,
        }),
        Err(error) if error.kind() == ErrorKind::NotFound => Err(Error::absent(path, advice)),
        Err(source) => Err(Error::access(path, "read", source)),
    }
}

/// Reads the file struct out of the text.
///
/// # Errors
/// The text is no TOML, holds an unknown key, a value of the wrong type, or a number that is
/// not finite.
pub fn parse_source<T: serde::de::DeserializeOwned>(source: &TomlSource) -> Result<T, Error> {
    let file = toml::from_str(&source.text).map_err(|error| {
        let span = error.span().unwrap_or(0..0);
        syntax_error(source, &span, error.message())
    })?;
    check_values(source)?;
    Ok(file)
}

fn syntax_error(source: &TomlSource, span: &Range<usize>, message: &str) -> Error {
    let place = place_at(source, span);
    // How a date looks from inside.
    let date = message.contains("$__toml_private");
    if message.starts_with("unknown field") && !date {
        return key_unknown(source, span, message, place);
    }
    let message = match date {
        true => "invalid type: date, expected a table",
        false => message,
    };
    Error::CampaignSyntax {
        place,
        message: syntax_message(source, span, message),
    }
}

/// Refuses numbers that are none, and dates: no key of any file takes them.
///
/// # Errors
/// The first NaN, infinity, number beyond the largest, or date.
pub(crate) fn check_values(source: &TomlSource) -> Result<(), Error> {
    // That the text is TOML was found before.
    DeTable::parse(&source.text).map_or(Ok(()), |table| {
        let mut values = table.get_ref().iter();
        values.try_for_each(|(key, value)| check_value(source, ("the file", key.get_ref()), value))
    })
}

/// * `key`: table and key of the value
fn check_value(
    source: &TomlSource,
    (table, key): (&str, &str),
    value: &toml::Spanned<DeValue>,
) -> Result<(), Error> {
    match value.get_ref() {
        DeValue::Float(number) => {
            let text = number.as_str();
            let found = text.replace('_', "").parse::<f64>();
            if found.is_ok_and(|number| number.abs() <= LARGEST) {
                return Ok(());
            }
            let problem = "expected a number below 1e100".to_owned();
            Err(invalid(source, &value.span(), (table, key), text, problem))
        }
        DeValue::Datetime(date) => {
            let text = date.to_string();
            let problem = "no key takes a date; a text stands in quotes".to_owned();
            Err(invalid(source, &value.span(), (table, key), &text, problem))
        }
        DeValue::Array(values) => values
            .iter()
            .try_for_each(|value| check_value(source, (table, key), value)),
        DeValue::Table(inner) => {
            let name = match table {
                "the file" => format!("[{key}]"),
                outer => format!("{}.{key}]", outer.trim_end_matches(']')),
            };
            inner
                .iter()
                .try_for_each(|(key, value)| check_value(source, (&name, key.get_ref()), value))
        }
        _ => Ok(()),
    }
}

/// Line of a place in the text.
pub fn place_at(source: &TomlSource, span: &Range<usize>) -> Place {
    let before = &source.text.as_bytes()[..span.start.min(source.text.len())];
    let line = 1 + before.iter().filter(|&&byte| byte == b'\n').count();
    Place {
        file: source.path.clone(),
        line,
    }
}

/// A quantity that may be left out; its SI value.
///
/// # Errors
/// The text is no quantity of the unit.
pub fn optional_quantity(
    source: &TomlSource,
    value: Option<&Spanned<QuantityText>>,
    needed: &Needed,
) -> Result<Option<f64>, Error> {
    let Some(value) = value else { return Ok(None) };
    let number = parse_as(&value.get_ref().0, needed.unit);
    number.map(Some).map_err(|error| {
        let key = (needed.table, needed.key);
        refused(source, value, key, error.to_string())
    })
}

/// A quantity that may be left out, with its standard uncertainty, zero without one; SI.
///
/// # Errors
/// The text is no quantity of the unit, or its uncertainty cannot be used.
pub fn uncertain_quantity(
    source: &TomlSource,
    value: Option<&Spanned<QuantityText>>,
    needed: &Needed,
) -> Result<Option<(f64, f64)>, Error> {
    let Some(value) = value else { return Ok(None) };
    match parse_uncertain(&value.get_ref().0, needed.unit) {
        Ok((number, sd)) => Ok(Some((number, sd.unwrap_or(0.0)))),
        Err(error) => {
            let key = (needed.table, needed.key);
            Err(refused(source, value, key, error.to_string()))
        }
    }
}

/// A quantity that must be there; its SI value.
///
/// * `table_at`: where its table stands, for the message
///
/// # Errors
/// It is left out, or its text is no quantity of the unit.
pub fn needed_quantity(
    source: &TomlSource,
    table_at: &Range<usize>,
    value: Option<&Spanned<QuantityText>>,
    needed: &Needed,
) -> Result<f64, Error> {
    optional_quantity(source, value, needed)?
        .ok_or_else(|| missing(source, table_at, needed, needed.table.to_owned()))
}

/// A quantity above zero that may be left out; SI.
///
/// # Errors
/// The text is no quantity of the unit, or not above zero.
pub fn positive_quantity(
    source: &TomlSource,
    value: Option<&Spanned<QuantityText>>,
    needed: &Needed,
) -> Result<Option<f64>, Error> {
    bounded(
        source,
        value,
        needed,
        |number| number > 0.0,
        "be above zero",
    )
}

/// A quantity at or above zero that may be left out; SI.
///
/// # Errors
/// The text is no quantity of the unit, or below zero.
pub fn quantity_from_zero(
    source: &TomlSource,
    value: Option<&Spanned<QuantityText>>,
    needed: &Needed,
) -> Result<Option<f64>, Error> {
    let fits = |number| number >= 0.0;
    bounded(source, value, needed, fits, "not be below zero")
}

/// A standard uncertainty, zero where it is left out; SI.
///
/// # Errors
/// Those of [`quantity_from_zero`].
pub fn uncertainty(
    source: &TomlSource,
    value: Option<&Spanned<QuantityText>>,
    needed: &Needed,
) -> Result<f64, Error> {
    Ok(quantity_from_zero(source, value, needed)?.unwrap_or(0.0))
}

fn bounded(
    source: &TomlSource,
    value: Option<&Spanned<QuantityText>>,
    needed: &Needed,
    fits: impl Fn(f64) -> bool,
    bound: &str,
) -> Result<Option<f64>, Error> {
    match (value, optional_quantity(source, value, needed)?) {
        (Some(value), Some(number)) if !fits(number) => {
            let problem = format!("must {bound}, for example: {}", needed.example);
            Err(refused(source, value, (needed.table, needed.key), problem))
        }
        (_, number) => Ok(number),
    }
}

/// A number that may be left out.
///
/// * `expected`: what the message asks for
///
/// # Errors
/// The number does not fit.
pub fn number_that<T: Copy + Display>(
    source: &TomlSource,
    value: Option<&Spanned<T>>,
    key: (&str, &str),
    fits: impl Fn(T) -> bool,
    expected: &str,
) -> Result<Option<T>, Error> {
    match value {
        Some(value) if !fits(*value.get_ref()) => {
            Err(refused(source, value, key, format!("expected {expected}")))
        }
        value => Ok(value.map(|value| *value.get_ref())),
    }
}

/// The error of a value that is left out.
pub fn missing(
    source: &TomlSource,
    table_at: &Range<usize>,
    needed: &Needed,
    table: String,
) -> Error {
    Error::ValueMissing {
        place: place_at(source, table_at),
        table,
        key: needed.key,
        meaning: needed.meaning,
        example: needed.example,
    }
}

/// The error of a value that cannot be used.
pub fn refused<T: Display>(
    source: &TomlSource,
    value: &Spanned<T>,
    key: (&str, &str),
    problem: impl Into<String>,
) -> Error {
    let text = value.get_ref().to_string();
    invalid(source, &value.span(), key, &text, problem.into())
}

/// The error of a value that cannot be used.
pub fn invalid(
    source: &TomlSource,
    span: &Range<usize>,
    (table, key): (&str, &str),
    text: &str,
    problem: String,
) -> Error {
    Error::ValueInvalid {
        place: place_at(source, span),
        key: format!("{table} {key}"),
        text: text.to_owned(),
        problem,
    }
}

/// One of several words, or the first when the key is left out.
///
/// # Errors
/// Another word.
pub fn choice<T: Copy>(
    source: &TomlSource,
    value: Option<&Spanned<String>>,
    (table, key): (&str, &str),
    choices: &[(&str, T)],
) -> Result<Option<T>, Error> {
    let Some(value) = value else { return Ok(None) };
    let word = value.get_ref();
    let found = choices
        .iter()
        .find(|(name, _)| name == word)
        .map(|(_, chosen)| *chosen);
    found.map(Some).ok_or_else(|| {
        let names: Vec<String> = choices
            .iter()
            .map(|(name, _)| format!("\"{name}\""))
            .collect();
        let problem = format!(
            "expected {}{}",
            names.join(" or "),
            suggestion(word, choices.iter().map(|(name, _)| *name))
        );
        invalid(source, &value.span(), (table, key), word, problem)
    })
}

/// " (did you mean \"arm\"?)", or nothing when no candidate is similar.
pub fn suggestion<'a>(name: &str, candidates: impl IntoIterator<Item = &'a str>) -> String {
    match nearest_names(name, candidates).first() {
        Some(best) => format!(" (did you mean \"{best}\"?)"),
        None => String::new(),
    }
}

/// serde says: unknown field `x`, expected one of `a`, `b`.
fn key_unknown(source: &TomlSource, span: &Range<usize>, message: &str, place: Place) -> Error {
    let mut quoted = message.split('`').skip(1).step_by(2).map(str::to_owned);
    let key = quoted
        .next()
        .unwrap_or_else(|| source.text[span.clone()].to_owned());
    let known: Vec<String> = quoted.collect();
    let nearest = suggestion(&key, known.iter().map(String::as_str));
    Error::KeyUnknown {
        place,
        key,
        nearest,
        known,
    }
}

/// What serde calls a type, and what a person would.
const TYPES: [(&str, &str); 9] = [
    (
        "expected a sequence",
        "expected a list in brackets, [\"…\", \"…\"]",
    ),
    ("expected f64", "expected a number without quotes"),
    ("expected u64", WHOLE),
    ("expected u32", WHOLE),
    ("expected usize", WHOLE),
    ("expected i64", "expected a whole number"),
    ("expected a string", "expected a text in quotes"),
    ("expected a boolean", "expected true or false"),
    ("expected a map", "expected a table"),
];

const WHOLE: &str = "expected a whole number, 0 or more";

/// The reader's message with the line that it is about.
fn syntax_message(source: &TomlSource, span: &Range<usize>, message: &str) -> String {
    let start = source.text[..span.start.min(source.text.len())]
        .rfind('\n')
        .map_or(0, |at| at + 1);
    let line = source.text[start..].lines().next().unwrap_or_default();
    let mut message = message.trim().replace('\n', "; ");
    if message.starts_with("invalid type") || message.starts_with("invalid value") {
        for (own, plain) in TYPES {
            message = message.replace(own, plain);
        }
        // The name that a program has for a table tells nobody anything.
        if let Some((before, name)) = message.split_once("expected struct ") {
            let after = name.trim_start_matches(|c: char| c.is_alphanumeric());
            message = format!("{before}expected a table, {{ key = value }}{after}");
        }
    }
    format!("{message} in: {}", line.trim())
}
