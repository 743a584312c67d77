//! The known names nearest to a misspelt one, for error messages.

/// The candidates that differ least from `word`, best first, at most three.
///
/// Case, `-` and `_` do not count. A candidate qualifies when a third of its
/// letters at most would have to change. Ties keep the order
/// of `candidates`.
///
/// # Example
/// ```
/// use windfall_numerics::unit::nearest_name::nearest_names;
/// assert_eq!(nearest_names("herz", ["hertz", "flores"]), ["hertz"]);
/// assert!(nearest_names("spring", ["hertz", "flores"]).is_empty());
/// ```
pub fn nearest_names<'a>(
    word: &str,
    candidates: impl IntoIterator<Item = &'a str>,
) -> Vec<&'a str> {
    let word = folded(word);
    let mut found: Vec<(usize, &str)> = candidates
        .into_iter()
        .filter_map(|name| {
            let folded_name = folded(name);
            let allowed = folded_name.len() / 3;
            let distance = edit_distance(&word, &folded_name);
            (distance <= allowed).then_some((distance, name))
        })
        .collect();
    found.sort_by_key(|&(distance, _)| distance);
    found.into_iter().take(3).map(|(_, name)| name).collect()
}

/// All candidates, those that differ least from `word` first, the others in their order.
///
/// # Example
/// ```
/// use windfall_numerics::unit::nearest_name::names_nearest_first;
/// assert_eq!(names_nearest_first("Forse", ["time", "force"]), ["force", "time"]);
/// ```
pub fn names_nearest_first<'a>(
    word: &str,
    candidates: impl IntoIterator<Item = &'a str>,
) -> Vec<&'a str> {
    let all: Vec<&str> = candidates.into_iter().collect();
    let mut names = nearest_names(word, all.iter().copied());
    let others: Vec<&str> = all.into_iter().filter(|own| !names.contains(own)).collect();
    names.extend(others);
    names
}

/// Letters that are compared.
fn folded(word: &str) -> Vec<char> {
    word.chars()
        .filter(|c| !matches!(c, '-' | '_' | ' '))
        .flat_map(char::to_lowercase)
        .collect()
}

/// Least number of insertions, deletions, replacements and exchanges of
/// neighbours that turn `a` into `b` (Damerau 1964, restricted form).
fn edit_distance(a: &[char], b: &[char]) -> usize {
    let mut before_last: Vec<usize> = vec![0; b.len() + 1];
    let mut last: Vec<usize> = (0..=b.len()).collect();
    for i in 1..=a.len() {
        let mut row = vec![i; b.len() + 1];
        for j in 1..=b.len() {
            let replaced = last[j - 1] + usize::from(a[i - 1] != b[j - 1]);
            row[j] = replaced.min(last[j] + 1).min(row[j - 1] + 1);
            if i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1] {
                row[j] = row[j].min(before_last[j - 2] + 1);
            }
        }
        before_last = std::mem::replace(&mut last, row);
    }
    last[b.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Distances counted by hand.
    #[test]
    fn closed_form_edit_distances() {
        let cases = [
            ("", "abc", 3),
            ("kitten", "sitting", 3),
            ("flores", "flores", 0),
            ("florse", "flores", 1),
            ("thorton", "thornton", 1),
        ];
        for (a, b, expected) in cases {
            assert_eq!(edit_distance(&folded(a), &folded(b)), expected, "{a} {b}");
            assert_eq!(edit_distance(&folded(b), &folded(a)), expected, "{b} {a}");
        }
    }
}
