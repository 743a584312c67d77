//! Places in a TOML text of values that do not know their own.

use crate::error::{Error, Place};
use crate::text::toml_source::{TomlSource, invalid};
use std::ops::Range;
use toml::de::{DeTable, DeValue};

/// Where a value stands.
///
/// * `keys`: from the file inwards; numbers, from 0, where a table or value is one of several
///
/// Returns nothing where it is left out.
pub fn span_of(source: &TomlSource, keys: &[&str]) -> Option<Range<usize>> {
    let table = DeTable::parse(&source.text).ok()?;
    let (first, rest) = keys.split_first()?;
    let mut found = table.get_ref().get(*first)?;
    for key in rest {
        found = match found.get_ref() {
            DeValue::Table(table) => table.get(*key)?,
            DeValue::Array(values) => values.get(key.parse::<usize>().ok()?)?,
            _ => return None,
        };
    }
    Some(found.span())
}

/// The error of a value that cannot be used, at its place; of a text that is no TOML, at the
/// file.
///
/// * `keys`: as for [`span_of`]
pub fn invalid_at(source: &TomlSource, keys: &[&str], problem: impl Into<String>) -> Error {
    let named = keys.iter().filter(|key| key.parse::<usize>().is_err());
    let named: Vec<&str> = named.copied().collect();
    let (key, tables) = named.split_last().unwrap_or((&"", &[]));
    let problem = problem.into();
    // Of what is left out, the table in which it is.
    let mut places = (1..=keys.len()).rev().map(|count| &keys[..count]);
    let Some(at) = places.find_map(|keys| span_of(source, keys)) else {
        let problem = format!("{}: {problem}", named.join(" "));
        return Error::Refused {
            place: Place::at(&source.path, 0),
            problem,
        };
    };
    let table = match tables.is_empty() {
        true => "the file".to_owned(),
        false => format!("[{}]", tables.join(".")),
    };
    // Of a table or a long list its beginning says enough.
    let text = source.text[at.clone()].lines().next().unwrap_or_default();
    let text = text.trim_matches(['"', '\'']);
    invalid(source, &at, (&table, key), text, problem)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::text::toml_source::check_values;
    use std::path::PathBuf;

    fn source(text: &str) -> TomlSource {
        TomlSource {
            path: PathBuf::from("a.toml"),
            text: text.to_owned(),
        }
    }

    #[test]
    fn rejects_numbers_that_are_none_wherever_they_stand() {
        let told = |text: &str| check_values(&source(text)).err().map(|own| own.to_string());
        assert_eq!(told("a = 1e99\n[b]\nc = [1, { d = -2.5_0 }]\n"), None);
        for (text, expected) in [
            (
                "a = nan",
                "a.toml, line 1: the file a = \"nan\": expected a number below 1e100",
            ),
            (
                "[b.c]\nd = 1\ne = [0, -inf]",
                "a.toml, line 3: [b.c] e = \"-inf\": expected a number below 1e100",
            ),
            (
                "[[b]]\nc = { d = 1e999 }",
                "a.toml, line 2: [b.c] d = \"1e999\": expected a number below 1e100",
            ),
        ] {
            assert_eq!(told(text).as_deref(), Some(expected), "{text}");
        }
    }

    #[test]
    fn values_are_found_by_their_keys() {
        let own = source("a = 1\n[b.c]\nd = [10, 20]\n[[e]]\nf = 3\n[[e]]\nf = 44\n");
        let found = |keys: &[&str]| span_of(&own, keys).map(|at| &own.text[at]);
        assert_eq!(found(&["b", "c", "d", "1"]), Some("20"));
        assert_eq!(found(&["e", "1", "f"]), Some("44"));
        assert_eq!(found(&["a", "b"]), None);
        assert_eq!(found(&["e", "2", "f"]), None);
    }
}
