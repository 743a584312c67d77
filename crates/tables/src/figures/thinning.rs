//! Which rows of a large table are drawn, and where points that would cover each other stand.

use std::collections::BTreeSet;

/// More rows than this are thinned.
pub const MOST_ROWS: usize = 5000;

/// Of each measure so many of the largest are drawn always.
const EXTREMES: usize = 50;

/// Rows that are drawn, and how they were chosen where not all are.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct DrawnRows {
    /// Their places, rising.
    pub rows: Vec<usize>,
    /// What a reader must know.
    pub note: Option<String>,
}

/// Chooses rows: all up to [`MOST_ROWS`], else every so many, and of each measure those with the
/// 50 largest.
///
/// * `measures`: values of all rows and what they are called; those that are no numbers are
///   passed over
pub fn drawn_rows(count: usize, measures: &[(&str, &dyn Fn(usize) -> f64)]) -> DrawnRows {
    if count <= MOST_ROWS {
        return DrawnRows {
            rows: (0..count).collect(),
            note: None,
        };
    }
    let step = count.div_ceil(MOST_ROWS);
    let mut rows: BTreeSet<usize> = (0..count).step_by(step).collect();
    for (_, measure) in measures {
        rows.extend(largest(count, EXTREMES, measure));
    }
    let named: Vec<&str> = measures.iter().map(|(name, _)| *name).collect();
    let note = format!(
        "{} of {count} rows are drawn: one in {step}, and those with the {EXTREMES} largest {}.",
        rows.len(),
        named.join(", ")
    );
    DrawnRows {
        rows: rows.into_iter().collect(),
        note: Some(note),
    }
}

/// Places of the largest values, the largest first; none that is no number.
pub fn largest(count: usize, most: usize, measure: &dyn Fn(usize) -> f64) -> Vec<usize> {
    let values = (0..count).map(|row| (measure(row), row));
    let mut values: Vec<(f64, usize)> = values.filter(|(value, _)| value.is_finite()).collect();
    let order = |a: &(f64, usize), b: &(f64, usize)| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1));
    if values.len() > most {
        values.select_nth_unstable_by(most, order);
        values.truncate(most);
    }
    values.sort_by(order);
    values.into_iter().map(|(_, row)| row).collect()
}

/// Where the n-th of several points stands beside the middle of its group, from -1 to 1:
/// multiples of the golden section, which fill the width evenly, follow no period of the rows,
/// and are the same every time.
pub fn aside(n: usize) -> f64 {
    const GOLDEN: f64 = 0.618_033_988_749_894_9;
    2.0 * ((n as f64 + 0.5) * GOLDEN).fract() - 1.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn closed_form_extremes_are_kept() {
        let value = |row: usize| if row == 12_345 { 9.0 } else { 0.5 };
        let found = drawn_rows(100_000, &[("value", &value)]);
        assert!(found.rows.contains(&12_345) && found.rows.len() <= MOST_ROWS + EXTREMES);
        assert!(found.note.unwrap().contains("one in 20,"));
        assert!(drawn_rows(MOST_ROWS, &[]).note.is_none());
        let values = [1.0, f64::NAN, 3.0, 3.0];
        assert_eq!(largest(4, 2, &|row| values[row]), [2, 3]);
    }

    #[test]
    fn closed_form_places_aside() {
        // (√5 - 1)/2 - 1, and three times its half less 1.
        assert!((aside(0) + 0.381_966_011).abs() < 1e-9);
        assert!((aside(1) - 0.854_101_966).abs() < 1e-9);
        let mut places: Vec<f64> = (0..100).map(aside).collect();
        places.sort_by(f64::total_cmp);
        assert!(places.windows(2).all(|pair| pair[1] - pair[0] < 0.04));
    }
}
