//! Groups of a table's rows, and what each group's values look like.

use crate::accurate_sum::{mean, standard_deviation};
use crate::distribution::quantile::quantile;
use crate::distribution::tail::t_upper_quantile;
use crate::error::Error;
use crate::sample::check_probability;
use crate::table::{Categories, Table};

/// The values of one group of rows.
#[derive(Clone, Debug, PartialEq)]
pub struct Group {
    /// Level of each grouping column, in the order they were named.
    pub levels: Vec<String>,
    /// Rows of the table, from 0, whose value is there.
    pub rows: Vec<usize>,
    /// Their values.
    pub values: Vec<f64>,
    /// Rows of the group whose value is missing.
    pub missing: usize,
}

/// The rows of a table by the levels of grouping columns.
#[derive(Clone, Debug, PartialEq)]
pub struct Groups {
    /// Groups that occur, in the order of their levels.
    pub groups: Vec<Group>,
    /// Rows, from 0, that belong to no group: a grouping cell is missing.
    pub ungrouped: Vec<usize>,
}

/// What the values of a group look like.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct GroupSummary {
    /// The levels in one text; "all" without grouping columns.
    pub group: String,
    /// Level of each grouping column.
    pub levels: Vec<String>,
    /// Number of values.
    pub n: usize,
    /// Number of rows whose value is missing.
    pub missing: usize,
    /// Mean; NaN without values, as all below.
    pub mean: f64,
    /// Standard deviation (n - 1); NaN for fewer than two values.
    pub sd: f64,
    /// Standard deviation over |mean|: the coefficient of variation; a fraction.
    pub cv: f64,
    /// Standard error of the mean.
    pub se: f64,
    /// Lower end of the mean's interval, by Student's t.
    pub low: f64,
    /// Upper end.
    pub high: f64,
    /// Smallest value.
    pub min: f64,
    /// First quartile, as [`quantile`].
    pub q1: f64,
    /// Median.
    pub median: f64,
    /// Third quartile.
    pub q3: f64,
    /// Largest value.
    pub max: f64,
}

/// The values of a column, by the levels of others.
///
/// A grouping column of numbers groups by equal numbers. Without grouping
/// columns all rows are one group.
///
/// # Errors
/// [`Error::UnknownColumn`]; [`Error::NotNumbers`] for the column of values.
pub fn split_groups(table: &Table, by: &[&str], value: &str) -> Result<Groups, Error> {
    let values = &*table.numbers(value)?.values();
    let columns: Vec<Categories> = by
        .iter()
        .map(|name| Ok(table.column(name)?.cells.categories()))
        .collect::<Result<_, Error>>()?;
    let mut ungrouped = Vec::new();
    let mut keyed: Vec<(usize, usize)> = Vec::new();
    let mut keys = vec![Some(0); values.len()];
    for column in &columns {
        joined(&mut keys, column);
    }
    for (row, key) in keys.into_iter().enumerate() {
        match key {
            Some(key) => keyed.push((key, row)),
            None => ungrouped.push(row),
        }
    }
    // Rows keep their order within a group.
    keyed.sort_unstable();
    let groups = keyed
        .chunk_by(|a, b| a.0 == b.0)
        .map(|rows| group_of(rows, &columns, values))
        .collect();
    Ok(Groups { groups, ungrouped })
}

/// Ranks of the pairs of a key and a level of another column, in their order.
fn joined(keys: &mut [Option<usize>], column: &Categories) {
    let pair = |(key, code): (&Option<usize>, &Option<usize>)| Some(((*key)?, (*code)?));
    let pairs: Vec<Option<(usize, usize)>> = keys.iter().zip(&column.codes).map(pair).collect();
    let mut known: Vec<(usize, usize)> = pairs.iter().flatten().copied().collect();
    known.sort_unstable();
    known.dedup();
    for (key, pair) in keys.iter_mut().zip(pairs) {
        *key = pair.and_then(|pair| known.binary_search(&pair).ok());
    }
}

fn group_of(keyed: &[(usize, usize)], columns: &[Categories], values: &[f64]) -> Group {
    let first = keyed[0].1;
    let levels = columns
        .iter()
        .filter_map(|own| own.codes[first].map(|code| &own.levels[code]));
    let rows = keyed.iter().map(|(_, row)| *row);
    let rows: Vec<usize> = rows.filter(|row| !values[*row].is_nan()).collect();
    Group {
        levels: levels.cloned().collect(),
        values: rows.iter().map(|row| values[*row]).collect(),
        missing: keyed.len() - rows.len(),
        rows,
    }
}

/// What the values of one group look like.
///
/// # Errors
/// A confidence outside (0, 1).
pub fn summarize(group: &Group, confidence: f64) -> Result<GroupSummary, Error> {
    check_probability("the confidence", confidence)?;
    let values = &group.values;
    let n = values.len();
    let mean = mean(values).value();
    let deviation = standard_deviation(values);
    let error = deviation / (n as f64).sqrt();
    let reach = match n {
        0 | 1 => f64::NAN,
        _ => error * t_upper_quantile(0.5 * (1.0 - confidence), n as f64 - 1.0),
    };
    Ok(GroupSummary {
        group: match &group.levels[..] {
            [] => "all".to_owned(),
            levels => levels.join(", "),
        },
        levels: group.levels.clone(),
        n,
        missing: group.missing,
        mean,
        sd: deviation,
        cv: deviation / mean.abs(),
        se: error,
        low: mean - reach,
        high: mean + reach,
        min: quantile(values, 0.0),
        q1: quantile(values, 0.25),
        median: quantile(values, 0.5),
        q3: quantile(values, 0.75),
        max: quantile(values, 1.0),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::table::{Cells, Column};

    fn table() -> Table {
        let text = |cells: &[&str]| {
            let cells: Vec<String> = cells.iter().map(|cell| (*cell).to_owned()).collect();
            Cells::Categories(Categories::of_cells(&cells))
        };
        let column = |name: &str, cells: Cells| Column {
            name: name.to_owned(),
            cells,
        };
        Table {
            columns: vec![
                column(
                    "variety",
                    text(&["red", "golden", "red", "", "red", "golden"]),
                ),
                column(
                    "V",
                    Cells::Numbers(vec![0.3, 0.1, 0.3, 0.1, 0.1, 0.1].into()),
                ),
                column(
                    "k",
                    Cells::Numbers(vec![2.0, 5.0, 4.0, 7.0, f64::NAN, 5.5].into()),
                ),
            ],
        }
    }

    #[test]
    fn closed_form_groups_of_two_columns_with_missing_cells() {
        let found = split_groups(&table(), &["variety", "V"], "k").unwrap();
        let levels: Vec<String> = found.groups.iter().map(|g| g.levels.join(" ")).collect();
        assert_eq!(levels, ["golden 0.1", "red 0.1", "red 0.3"]);
        assert_eq!(found.groups[2].values, [2.0, 4.0]);
        assert_eq!(found.groups[2].rows, [0, 2]);
        assert_eq!(found.groups[1].missing, 1);
        assert_eq!(found.ungrouped, [3]);
    }

    fn summaries(by: &[&str], confidence: f64) -> Vec<GroupSummary> {
        let groups = split_groups(&table(), by, "k").unwrap().groups;
        let described = groups.iter().map(|group| summarize(group, confidence));
        described.collect::<Result<_, _>>().unwrap()
    }

    #[test]
    fn closed_form_summary() {
        let found = summaries(&["variety"], 0.5);
        let red = &found[1];
        assert_eq!((red.n, red.missing), (2, 1));
        assert_eq!(red.mean, 3.0);
        assert_eq!(red.sd, 2f64.sqrt());
        assert!((red.se - 1.0).abs() < 1e-15);
        // Student's t of one degree at 1/4 is 1
        assert!((red.low - 2.0).abs() < 1e-14 && (red.high - 4.0).abs() < 1e-14);
        assert_eq!([red.q1, red.median], [2.5, 3.0]);
        let all = summaries(&[], 0.95);
        assert_eq!((all.len(), all[0].n, all[0].missing), (1, 5, 1));
    }

    #[test]
    fn rejects_text_where_numbers_are_needed() {
        let message = split_groups(&table(), &["V"], "variety").unwrap_err();
        assert!(message.to_string().contains("holds text"), "{message}");
    }
}
