//! Values of options on a command line: texts with units, words.

use crate::error::Error;
use crate::text::toml_source::suggestion;
use windfall_numerics::unit::quantity::parse_as;

/// The error of an option that cannot be used.
pub fn unusable(option: impl Into<String>, problem: impl Into<String>) -> Error {
    Error::OptionInvalid {
        option: option.into(),
        problem: problem.into(),
    }
}

/// Parts between marks. A part that begins with a backtick may hold marks up to the next one.
pub fn parts(text: &str, mark: char) -> impl Iterator<Item = &str> {
    let (mut quoted, mut begins) = (false, true);
    text.split(move |own: char| {
        quoted ^= own == '`' && (quoted || begins);
        let ends = own == mark && !quoted;
        begins = ends || begins && own.is_whitespace();
        ends
    })
}

/// A name without the blanks and the backticks around it, as in a formula.
pub fn plain_name(text: &str) -> String {
    let text = text.trim();
    let inner = text.strip_prefix('`').and_then(|own| own.strip_suffix('`'));
    inner.unwrap_or(text).to_owned()
}

/// A quantity in SI.
///
/// # Errors
/// The text is no quantity of the unit.
pub fn quantity(option: &str, text: &str, unit: &str) -> Result<f64, Error> {
    parse_as(text, unit).map_err(|error| unusable(option, error.to_string()))
}

/// A quantity above zero, in SI.
///
/// # Errors
/// The text is no quantity of the unit, or not above zero.
pub fn positive(option: &str, text: &str, unit: &str) -> Result<f64, Error> {
    match quantity(option, text, unit)? {
        value if value > 0.0 => Ok(value),
        _ => Err(unusable(option, format!("\"{text}\" must be above zero"))),
    }
}

/// A quantity that is zero or above, in SI.
///
/// # Errors
/// The text is no quantity of the unit, or below zero.
pub fn at_least_zero(option: &str, text: &str, unit: &str) -> Result<f64, Error> {
    match quantity(option, text, unit)? {
        value if value >= 0.0 => Ok(value),
        _ => Err(unusable(
            option,
            format!("\"{text}\" must not be below zero"),
        )),
    }
}

/// What a word stands for.
///
/// # Errors
/// Another word, with the nearest of those that are known.
pub fn chosen<T: Copy>(option: &str, word: &str, choices: &[(&str, T)]) -> Result<T, Error> {
    let found = choices.iter().find(|(name, _)| *name == word);
    found.map(|(_, value)| *value).ok_or_else(|| {
        let names: Vec<&str> = choices.iter().map(|(name, _)| *name).collect();
        let hint = suggestion(word, names.iter().copied());
        unusable(
            option,
            format!("\"{word}\": expected {}{hint}", names.join(" or ")),
        )
    })
}
/// The word for a value; empty for one that has no word.
pub fn word_of<T: Copy + PartialEq>(choices: &[(&str, T)], value: T) -> String {
    let found = choices.iter().find(|(_, known)| *known == value);
    found.map_or_else(String::new, |(word, _)| (*word).to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn closed_form_names_in_backticks() {
        let names = |text: &str| parts(text, ',').map(plain_name).collect::<Vec<_>>();
        assert_eq!(names("low, high"), ["low", "high"]);
        assert_eq!(names("`1,5 cm`,`` , 3`"), ["1,5 cm", "", "3`"]);
        // Elsewhere a backtick is a character like others.
        assert_eq!(names("5`,6`, `7`,8`"), ["5`", "6`", "7", "8`"]);
        assert_eq!(parts("a|`b|c`", '|').collect::<Vec<_>>(), ["a", "`b|c`"]);
    }
}
