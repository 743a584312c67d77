//! What readers of scene.toml and writers of its results share.

use std::fmt::Display;
use std::ops::Range;
use std::path::PathBuf;
use toml::de::{DeTable, DeValue};
use windfall_files::confined::named_beside;
use windfall_files::error::Error;
use windfall_files::text::file_quantity::QuantityText;
use windfall_files::text::spanned::Spanned;
use windfall_files::text::toml_source::{TomlSource, invalid, place_at, suggestion};
use windfall_numerics::unit::quantity::parse_as;
use windfall_scene::vector::Vector;

/// What contacts of fruit with fruit are called.
pub const FRUIT: &str = "fruit";

/// A number in a sentence, to four digits.
pub fn short(value: f64) -> String {
    let rounded = format!("{value:.3e}").parse::<f64>();
    rounded.unwrap_or(value).to_string()
}

/// A place in a sentence.
pub fn short_place(place: Vector) -> String {
    format!("[{}]", place.map(short).join(", "))
}

/// Keys whose texts go into decks, tables and pages as they are.
const ONE_LINE: [&str; 6] = ["title", "name", "material", "materials", "mesh", "file"];

/// Refuses names that hold line breaks or other control characters: in a deck for another
/// engine, what follows a line break would be a command.
///
/// # Errors
/// A name holds one.
pub fn check_names(source: &TomlSource) -> Result<(), Error> {
    // That the text is TOML was checked when it was read.
    match DeTable::parse(&source.text) {
        Ok(table) => table
            .get_ref()
            .iter()
            .try_for_each(|(key, value)| check_value(source, key.get_ref(), value)),
        Err(_) => Ok(()),
    }
}

fn check_value(
    source: &TomlSource,
    key: &str,
    value: &toml::Spanned<DeValue>,
) -> Result<(), Error> {
    match value.get_ref() {
        DeValue::String(text) if ONE_LINE.contains(&key) => {
            let breaks = |c: char| c.is_control() || matches!(c, '\u{2028}' | '\u{2029}');
            match text.contains(breaks) {
                true => {
                    let text = text.escape_debug().to_string();
                    let problem = "must be one line, without control characters";
                    let key = ("the scene's", key);
                    Err(invalid(
                        source,
                        &value.span(),
                        key,
                        &text,
                        problem.to_owned(),
                    ))
                }
                false => Ok(()),
            }
        }
        DeValue::Array(values) => {
            let mut values = values.iter();
            values.try_for_each(|value| check_value(source, key, value))
        }
        DeValue::Table(table) => {
            let mut entries = table.iter();
            entries.try_for_each(|(key, value)| check_value(source, key.get_ref(), value))
        }
        _ => Ok(()),
    }
}

/// What is said of a number that may be zero.
const BELOW_ZERO: &str = "it must not be below zero";

/// A table of a scene while it is read.
#[derive(Clone)]
pub struct Section<'a> {
    /// The text that it stands in.
    pub source: &'a TomlSource,
    /// Its name, with brackets.
    pub name: &'static str,
    /// Where it stands.
    pub at: Range<usize>,
}

impl Section<'_> {
    /// A quantity in SI.
    ///
    /// # Errors
    /// The text is no quantity of the unit.
    pub fn given(
        &self,
        value: &Spanned<QuantityText>,
        key: &str,
        unit: &str,
    ) -> Result<f64, Error> {
        let text = &value.get_ref().0;
        parse_as(text, unit)
            .map_err(|error| self.refused(&value.span(), key, text, error.to_string()))
    }

    /// A quantity that may be left out; in SI.
    pub fn optional(
        &self,
        value: &Option<Spanned<QuantityText>>,
        key: &str,
        unit: &str,
    ) -> Result<Option<f64>, Error> {
        let given = value.as_ref().map(|own| self.given(own, key, unit));
        given.transpose()
    }

    /// A quantity above zero that may be left out; in SI.
    pub fn above_zero(
        &self,
        value: &Option<Spanned<QuantityText>>,
        key: &str,
        unit: &str,
    ) -> Result<Option<f64>, Error> {
        let found = self.optional(value, key, unit)?;
        self.that(
            value,
            key,
            (found, |own| own > 0.0),
            "it must be above zero",
        )
    }

    /// A quantity at or above zero that may be left out; in SI.
    pub fn at_least_zero(
        &self,
        value: &Option<Spanned<QuantityText>>,
        key: &str,
        unit: &str,
    ) -> Result<Option<f64>, Error> {
        let found = self.optional(value, key, unit)?;
        self.that(value, key, (found, |own| own >= 0.0), BELOW_ZERO)
    }

    /// A number at or above zero that may be left out.
    pub fn number_from_zero(
        &self,
        value: &Option<Spanned<f64>>,
        key: &str,
    ) -> Result<Option<f64>, Error> {
        let found = value.as_ref().map(|own| *own.get_ref());
        self.that(value, key, (found, |own| own >= 0.0), BELOW_ZERO)
    }

    fn that<T: Display>(
        &self,
        value: &Option<Spanned<T>>,
        key: &str,
        (found, fits): (Option<f64>, fn(f64) -> bool),
        problem: &str,
    ) -> Result<Option<f64>, Error> {
        match (value, found) {
            (Some(value), Some(number)) if !fits(number) => {
                Err(self.refused(&value.span(), key, value.get_ref(), problem))
            }
            _ => Ok(found),
        }
    }

    /// What stands at a place of the file.
    pub fn written(&self, at: &Range<usize>) -> &str {
        self.source.text.get(at.clone()).unwrap_or_default()
    }

    /// The error of a value that is left out.
    pub fn lacks(&self, key: &'static str, meaning: &'static str, example: &'static str) -> Error {
        Error::ValueMissing {
            place: place_at(self.source, &self.at),
            table: self.name.to_owned(),
            key,
            meaning,
            example,
        }
    }

    /// Refuses a second of several keys of which one can be given.
    ///
    /// * `given`: the keys, with the places of those that are there
    /// * `advice`: what to do
    pub fn alone(
        &self,
        given: &[(&'static str, Option<Range<usize>>)],
        advice: &str,
    ) -> Result<(), Error> {
        let mut there = given
            .iter()
            .filter_map(|(key, at)| Some((key, at.as_ref()?)));
        match (there.next(), there.next()) {
            (Some((first, _)), Some((second, at))) => {
                let problem = format!("it has {first} already: {advice}");
                Err(self.refused(at, second, self.written(at), problem))
            }
            _ => Ok(()),
        }
    }

    /// The error of a value that cannot be used.
    pub fn refused(
        &self,
        at: &Range<usize>,
        key: &str,
        text: impl ToString,
        problem: impl Into<String>,
    ) -> Error {
        let key = (self.name, key);
        invalid(self.source, at, key, &text.to_string(), problem.into())
    }

    /// The path of a file that the table names, beside its own file.
    ///
    /// # Errors
    /// It lies elsewhere, is not there, or is no regular file.
    pub fn named_file(&self, key: &str, name: &Spanned<String>) -> Result<PathBuf, Error> {
        let text = name.get_ref();
        let wrong = |problem: String| self.refused(&name.span(), key, text, problem);
        let path = named_beside(&self.source.path, text).map_err(wrong)?;
        match path.exists() {
            true => Ok(path),
            false => Err(wrong(format!("there is no file {}", path.display()))),
        }
    }

    /// The number of a material.
    ///
    /// # Errors
    /// There is none of that name.
    pub fn material(
        &self,
        at: &Range<usize>,
        key: &str,
        name: &str,
        materials: &[String],
    ) -> Result<usize, Error> {
        materials.iter().position(|own| own == name).ok_or_else(|| {
            let near = suggestion(name, materials.iter().map(String::as_str));
            let problem = format!("there is no such material in `materials`{near}");
            self.refused(at, key, name, problem)
        })
    }
}
