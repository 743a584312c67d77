//! What readers of scene.toml and writers of what came of it share.

use std::ops::Range;
use windfall_files::error::Error;
use windfall_files::text::toml_source::{Needed, TomlSource, invalid, suggestion};

/// What contacts of fruit with fruit are called.
pub const FRUIT: &str = "fruit";

/// A value that must stand in a table.
#[must_use]
pub const fn needed(
    table: &'static str,
    key: &'static str,
    meaning: &'static str,
    unit: &'static str,
    example: &'static str,
) -> Needed {
    Needed {
        table,
        key,
        meaning,
        unit,
        example,
    }
}

/// A number in a sentence, to four digits.
#[must_use]
pub fn short(value: f64) -> String {
    let rounded = format!("{value:.3e}").parse::<f64>();
    rounded.unwrap_or(value).to_string()
}

/// The number of a material.
///
/// # Errors
/// There is none of that name.
pub fn material(
    source: &TomlSource,
    span: &Range<usize>,
    (table, key): (&str, &str),
    name: &str,
    materials: &[String],
) -> Result<usize, Error> {
    materials.iter().position(|own| own == name).ok_or_else(|| {
        let near = suggestion(name, materials.iter().map(String::as_str));
        let problem = format!("there is no such material in `materials`{near}");
        invalid(source, span, (table, key), name, problem)
    })
}
