//! Changes of a scene's text: a value by the path of its key, a wall or a source to another
//! place. Comments and order stay.

use crate::file::walls::PLACES;
use toml_edit::{Array, DocumentMut, Item, Table, TableLike, Value};
use windfall_files::text::toml_source::suggestion;

/// Lists of tables of a scene, in which a table is found by its name.
const LISTS: [&str; 5] = ["walls", "moves", "fruit", "sinks", "contacts"];

/// Puts a value in the place of another.
///
/// * `path`: "walls.pad.material", "fruit.apples.pour.rate", "contacts.apple+steel.friction",
///   "scene.end"
///
/// # Errors
/// What is wrong with the path, in words.
pub fn set_value(
    document: &mut DocumentMut,
    path: &str,
    value: &toml::Value,
) -> Result<(), String> {
    let text = value.to_string();
    let value: Value = text
        .parse()
        .map_err(|_| format!("{text} cannot be put into a scene"))?;
    let mut steps: Vec<&str> = path.split('.').collect();
    let key = steps.pop().unwrap_or_default();
    if steps.is_empty() || key.is_empty() {
        return Err(format!(
            "\"{path}\" is no path of a key; write \"walls.NAME.material\", \
             \"fruit.NAME.pour.rate\", \"contacts.A+B.friction\" or \"scene.end\""
        ));
    }
    let mut table: &mut dyn TableLike = match LISTS.contains(&steps[0]) && steps.len() > 1 {
        true => named(document, steps[0], steps[1])?,
        false => below(document.as_table_mut(), steps[0])?,
    };
    let first = if LISTS.contains(&steps[0]) { 2 } else { 1 };
    for step in steps.iter().skip(first) {
        table = below(table, step)?;
    }
    table.insert(key, Item::Value(value));
    Ok(())
}

fn below<'a>(table: &'a mut dyn TableLike, key: &str) -> Result<&'a mut dyn TableLike, String> {
    let known: Vec<String> = table.iter().map(|(key, _)| key.to_owned()).collect();
    let near = suggestion(key, known.iter().map(String::as_str));
    let found = table.get_mut(key).and_then(Item::as_table_like_mut);
    found.ok_or_else(|| format!("the scene has no table \"{key}\" there{near}"))
}

/// The table of a list that has a name, or a pair of materials.
fn named<'a>(
    document: &'a mut DocumentMut,
    list: &str,
    name: &str,
) -> Result<&'a mut dyn TableLike, String> {
    let tables = document
        .get_mut(list)
        .and_then(Item::as_array_of_tables_mut);
    let Some(tables) = tables else {
        return Err(format!("the scene has no [[{list}]]"));
    };
    let names: Vec<String> = tables.iter().map(|own| name_of(list, own)).collect();
    let Some(place) = names.iter().position(|own| is_name(list, own, name)) else {
        let near = suggestion(name, names.iter().map(String::as_str));
        return Err(format!("no [[{list}]] is called \"{name}\"{near}"));
    };
    match tables.get_mut(place) {
        Some(table) => Ok(table),
        None => Err(format!("no [[{list}]] is called \"{name}\"")),
    }
}

fn is_name(list: &str, own: &str, name: &str) -> bool {
    let turned = |own: &str| own.split_once('+').map(|(a, b)| format!("{b}+{a}"));
    own == name || (list == "contacts" && turned(own).as_deref() == Some(name))
}

fn name_of(list: &str, table: &Table) -> String {
    let text = |key: &str| table.get(key).and_then(Item::as_str).unwrap_or_default();
    match list {
        "contacts" => {
            let pair = table.get("between").and_then(Item::as_array);
            let words = pair.map(|own| own.iter().filter_map(Value::as_str).collect::<Vec<_>>());
            words.unwrap_or_default().join("+")
        }
        // As the reader of scenes names kinds without a name.
        "fruit" if table.get("name").is_none() => text("material").to_owned(),
        _ => text("name").to_owned(),
    }
}

/// Where sources have places: a table in them and its keys.
const SOURCES: [(&str, &[&str]); 4] = [
    ("lattice", &["low", "high"]),
    ("pour", &["low", "high"]),
    ("tree", &["low", "high"]),
    ("drop", &["place"]),
];

/// Moves a wall, a kind of fruit's source or a sink.
///
/// # Errors
/// Nothing has that name, or it has no place that can be moved.
pub fn move_named(document: &mut DocumentMut, name: &str, by: [f64; 3]) -> Result<(), String> {
    let mut names = Vec::new();
    for list in ["walls", "moves", "fruit", "sinks"] {
        let tables = document
            .get_mut(list)
            .and_then(Item::as_array_of_tables_mut);
        for table in tables
            .into_iter()
            .flat_map(toml_edit::ArrayOfTables::iter_mut)
        {
            let own = name_of(list, table);
            if own != name {
                names.push(own);
                continue;
            }
            let moved = match list {
                "sinks" => moved_keys(table, &["low", "high"], by),
                _ => PLACES.iter().chain(&SOURCES).fold(0, |moved, (key, keys)| {
                    let inner = table.get_mut(key).and_then(Item::as_table_like_mut);
                    moved + inner.map_or(0, |inner| moved_keys(inner, keys, by))
                }),
            };
            return match moved > 0 {
                true => Ok(()),
                false => Err(format!("\"{name}\" has no place that can be moved")),
            };
        }
    }
    let near = suggestion(name, names.iter().map(String::as_str));
    Err(format!(
        "the scene has no wall, fruit or sink called \"{name}\"{near}; it has {}",
        names.join(", ")
    ))
}

/// How many of these places were moved.
fn moved_keys(table: &mut dyn TableLike, keys: &[&str], by: [f64; 3]) -> usize {
    let mut moved = 0;
    for key in keys {
        let place = table.get_mut(key).and_then(Item::as_array_mut);
        moved += usize::from(place.is_some_and(|place| moved_place(place, by)));
    }
    moved
}

fn moved_place(place: &mut Array, by: [f64; 3]) -> bool {
    let number = |own: &Value| own.as_float().or(own.as_integer().map(|own| own as f64));
    let numbers: Vec<f64> = place.iter().filter_map(number).collect();
    if numbers.len() != 3 || place.len() != 3 {
        return false;
    }
    // Sums such as 0.3 + 0.1 lose their rounding error.
    let sums = numbers.iter().zip(by).map(|(own, by)| rounded(own + by));
    *place = sums.collect();
    true
}

/// To a nanometre.
fn rounded(value: f64) -> f64 {
    (value * 1e9).round() / 1e9
}

#[cfg(test)]
mod tests {
    use super::*;

    const SCENE: &str = "# kept
[scene]
end = \"1 s\"
[[contacts]]
between = [\"apple\", \"steel\"]
friction = 0.3
[[fruit]]
material = \"apple\"
pour = { low = [0, 0, 1], high = [1, 1, 1.2], rate = \"5 Hz\" }
[[walls]]
name = \"pad\"
material = \"foam\"
plate = { corner = [0, 0, 0.3], edges = [[1, 0, 0], [0, 1, 0]] }
";

    #[test]
    fn closed_form_changes_of_a_text() {
        let mut document: DocumentMut = SCENE.parse().unwrap();
        let text = |text: &str| toml::Value::String(text.to_owned());
        set_value(&mut document, "walls.pad.material", &text("steel")).unwrap();
        set_value(&mut document, "fruit.apple.pour.rate", &text("9 Hz")).unwrap();
        let friction = toml::Value::Float(0.5);
        set_value(&mut document, "contacts.steel+apple.friction", &friction).unwrap();
        set_value(&mut document, "scene.end", &text("2 s")).unwrap();
        move_named(&mut document, "pad", [0.0, 0.0, 0.1]).unwrap();
        move_named(&mut document, "apple", [0.0, 0.0, -0.5]).unwrap();
        let found = document.to_string();
        for words in [
            "# kept",
            "end = \"2 s\"",
            "friction = 0.5",
            "low = [0.0, 0.0, 0.5], high = [1.0, 1.0, 0.7], rate = \"9 Hz\"",
            "material = \"steel\"",
            "corner = [0.0, 0.0, 0.4]",
        ] {
            assert!(found.contains(words), "{words}\n{found}");
        }
    }

    #[test]
    fn rejects_paths_that_lead_nowhere() {
        let mut document: DocumentMut = SCENE.parse().unwrap();
        for (path, words) in [
            ("walls.pat.material", "did you mean \"pad\""),
            ("end", "is no path"),
            ("scen.end", "did you mean \"scene\""),
            ("walls.pad.plat.corner", "did you mean \"plate\""),
            ("sinks.a.low", "no [[sinks]]"),
        ] {
            let error = set_value(&mut document, path, &toml::Value::Integer(1)).unwrap_err();
            assert!(error.contains(words), "{error}");
        }
        let error = move_named(&mut document, "pats", [0.0; 3]).unwrap_err();
        assert!(error.contains("it has pad, apple"), "{error}");
    }
}
