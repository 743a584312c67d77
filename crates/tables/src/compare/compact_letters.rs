//! Letters that say which groups differ: groups that share a letter do not.

/// Letters for groups, "a" for those of the largest mean.
///
/// * `means`: the groups' means, which order the letters
/// * `differ`: places of groups that differ
///
/// # Source
/// Piepho (2004), An algorithm for a letter-based representation of all-pairwise
/// comparisons, J. Comput. Graph. Stat. 13: insert and absorb.
pub fn compact_letters(means: &[f64], differ: &[(usize, usize)]) -> Vec<String> {
    // from large to small, so that the letters run along with the means
    let mut order: Vec<usize> = (0..means.len()).collect();
    order.sort_by(|a, b| means[*b].total_cmp(&means[*a]));
    let mut rank = vec![0; means.len()];
    for (place, group) in order.iter().enumerate() {
        rank[*group] = place;
    }
    let mut columns = vec![vec![true; means.len()]];
    for (a, b) in differ {
        columns = split(columns, rank[*a], rank[*b]);
    }
    columns.sort_by(|a, b| b.cmp(a));
    let letters = |group: usize| {
        let held = columns.iter().enumerate();
        held.filter(|(_, column)| column[rank[group]])
            .map(|(place, _)| letter(place))
            .collect()
    };
    (0..means.len()).map(letters).collect()
}

/// Columns in which two groups that differ no longer meet.
fn split(columns: Vec<Vec<bool>>, a: usize, b: usize) -> Vec<Vec<bool>> {
    let mut split = Vec::with_capacity(columns.len() + 1);
    for column in columns {
        if column[a] && column[b] {
            for left_out in [b, a] {
                let mut part = column.clone();
                part[left_out] = false;
                split.push(part);
            }
        } else {
            split.push(column);
        }
    }
    absorb(split)
}

/// Columns without those that another holds in full.
fn absorb(columns: Vec<Vec<bool>>) -> Vec<Vec<bool>> {
    let within = |a: &[bool], b: &[bool]| a.iter().zip(b).all(|(a, b)| !a || *b);
    let mut kept: Vec<Vec<bool>> = Vec::with_capacity(columns.len());
    for column in columns {
        if kept.iter().any(|other| within(&column, other)) {
            continue;
        }
        kept.retain(|other| !within(other, &column));
        kept.push(column);
    }
    kept
}

/// a … z, then A … Z, then numbers in brackets.
fn letter(place: usize) -> String {
    let letters = (b'a'..=b'z').chain(b'A'..=b'Z');
    letters
        .map(char::from)
        .nth(place)
        .map_or_else(|| format!("[{}]", place + 1), String::from)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn closed_form_no_and_all_differences() {
        assert_eq!(compact_letters(&[2.0, 1.0], &[]), ["a", "a"]);
        let all = [(0, 1), (0, 2), (1, 2)];
        assert_eq!(compact_letters(&[1.0, 3.0, 2.0], &all), ["c", "a", "b"]);
        // Only the largest and the smallest differ.
        let ends = compact_letters(&[1.0, 3.0, 2.0], &[(0, 1)]);
        assert_eq!(ends, ["b", "a", "ab"]);
    }

    /// A group that differs from none of two that differ carries both letters;
    /// in every case groups share a letter exactly where they do not differ.
    #[test]
    fn closed_form_letters_say_what_differs_for_every_pattern_of_five() {
        let means = [0.3, 0.1, 0.5, 0.2, 0.4];
        let pairs: Vec<(usize, usize)> = (0..5)
            .flat_map(|a| (a + 1..5).map(move |b| (a, b)))
            .collect();
        for pattern in 0_u32..1 << pairs.len() {
            let chosen = |place: &usize| pattern >> place & 1 == 1;
            let differ: Vec<(usize, usize)> =
                (0..pairs.len()).filter(chosen).map(|p| pairs[p]).collect();
            let letters = compact_letters(&means, &differ);
            for (place, (a, b)) in pairs.iter().enumerate() {
                let shared = letters[*a].chars().any(|c| letters[*b].contains(c));
                assert_eq!(shared, !chosen(&place), "{pattern:b}: {letters:?}");
            }
        }
    }
}
