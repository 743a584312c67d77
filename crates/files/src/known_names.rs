//! Names that there are, where one is asked for that is not among them.

use windfall_numerics::unit::nearest_name::names_nearest_first;

/// Of more names than this only so many are told.
const TOLD: usize = 6;

/// The names to be told of a word that is none of them: the nearest first, at most six.
pub fn told_names<'a>(word: &str, names: impl IntoIterator<Item = &'a str>) -> Vec<String> {
    let names = names_nearest_first(word, names).into_iter();
    names.take(TOLD).map(str::to_owned).collect()
}

/// "; there are \"a\", \"b\" and 12 more", the nearest first; nothing where there are none.
pub fn known_names<'a>(word: &str, names: impl IntoIterator<Item = &'a str>) -> String {
    let names = names_nearest_first(word, names);
    let told: Vec<String> = names
        .iter()
        .take(TOLD)
        .map(|own| format!("\"{own}\""))
        .collect();
    match names.len() {
        0 => String::new(),
        all if all > TOLD => format!("; there are {} and {} more", told.join(", "), all - TOLD),
        1 => format!("; there is only {}", told[0]),
        _ => format!("; there are {}", told.join(", ")),
    }
}

/// Up to three names, and how many more there are: "a, b, c and 4 more".
pub fn few_names(names: &[&str]) -> String {
    const FEW: usize = 3;
    let first = names.iter().take(FEW).copied().collect::<Vec<_>>();
    match names.len() {
        all if all > FEW => format!("{} and {} more", first.join(", "), all - FEW),
        _ => first.join(", "),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn closed_form_names_nearest_first_and_few() {
        let names = ["fruit-1", "fruit-2", "apple-1", "a", "b", "c", "d", "e"];
        assert_eq!(
            known_names("aple-1", names),
            "; there are \"apple-1\", \"fruit-1\", \"fruit-2\", \"a\", \"b\", \"c\" and 2 more"
        );
        assert_eq!(known_names("x", ["force"]), "; there is only \"force\"");
        assert_eq!(known_names("x", []), "");
        assert_eq!(told_names("Forse", ["time", "force"]), ["force", "time"]);
        assert_eq!(few_names(&["a", "b", "c", "d"]), "a, b, c and 1 more");
        assert_eq!(few_names(&["a", "b"]), "a, b");
    }
}
