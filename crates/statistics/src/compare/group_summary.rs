//! Groups of a table's rows, and what each group's values look like.

use crate::accurate_sum::{mean, squares_about};
use crate::error::Error;
use crate::sample::check_probability;
use crate::table::{Categories, Table};
use std::borrow::Cow;
use windfall_distribution::quantile::quantiles;
use windfall_distribution::tail::t_upper_quantile;
use windfall_numerics::double_double::DoubleDouble;

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
#[derive(Clone, Debug, PartialEq, serde::Serialize, utoipa::ToSchema)]
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
    #[schema(value_type = Option<f64>)]
    pub mean: f64,
    /// Standard deviation (n - 1); NaN for fewer than two values.
    #[schema(value_type = Option<f64>)]
    pub sd: f64,
    /// Standard deviation over |mean|: the coefficient of variation; a fraction.
    #[schema(value_type = Option<f64>)]
    pub cv: f64,
    /// Standard error of the mean.
    #[schema(value_type = Option<f64>)]
    pub se: f64,
    /// Lower end of the mean's interval, by Student's t.
    #[schema(value_type = Option<f64>)]
    pub low: f64,
    /// Upper end.
    #[schema(value_type = Option<f64>)]
    pub high: f64,
    /// Smallest value.
    #[schema(value_type = Option<f64>)]
    pub min: f64,
    /// First quartile, as [`quantile`](windfall_distribution::quantile::quantile).
    #[schema(value_type = Option<f64>)]
    pub q1: f64,
    /// Median.
    #[schema(value_type = Option<f64>)]
    pub median: f64,
    /// Third quartile.
    #[schema(value_type = Option<f64>)]
    pub q3: f64,
    /// Largest value.
    #[schema(value_type = Option<f64>)]
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
    let values = table.numbers(value)?;
    let columns: Vec<Cow<Categories>> = by
        .iter()
        .map(|name| Ok(table.column(name)?.cells.as_categories()))
        .collect::<Result<_, Error>>()?;
    let mut keys = vec![0; values.len()];
    let mut count = 1;
    for column in &columns {
        count = joined(&mut keys, count, column);
    }
    let mut sizes = vec![0; count];
    for key in keys.iter().filter(|key| **key != NONE) {
        sizes[*key as usize] += 1;
    }
    let group = |size: &usize| Group {
        levels: Vec::new(),
        rows: Vec::with_capacity(*size),
        values: Vec::with_capacity(*size),
        missing: 0,
    };
    let mut groups: Vec<Group> = sizes.iter().map(group).collect();
    let mut ungrouped = Vec::new();
    for ((row, key), value) in keys.iter().enumerate().zip(values.iter()) {
        if *key == NONE {
            ungrouped.push(row);
            continue;
        }
        let own = &mut groups[*key as usize];
        if own.values.is_empty() && own.missing == 0 {
            let levels = columns.iter();
            let levels = levels.filter_map(|own| own.codes[row].map(|code| &own.levels[code]));
            own.levels = levels.cloned().collect();
        }
        match value.is_nan() {
            true => own.missing += 1,
            false => {
                own.rows.push(row);
                own.values.push(value);
            }
        }
    }
    groups.retain(|own| own.missing + own.rows.len() > 0);
    Ok(Groups { groups, ungrouped })
}

/// Key of a row that belongs to no group.
const NONE: u32 = u32::MAX;

/// Puts ranks of the pairs of a key and a level of another column, in their order, in the place
/// of keys; returns how many there are.
///
/// * `count`: number of keys
fn joined(keys: &mut [u32], count: usize, column: &Categories) -> usize {
    let levels = column.levels.len();
    let pair = |(key, code): (&u32, &Option<usize>)| match (*key, code) {
        (NONE, _) | (_, None) => None,
        (key, Some(code)) => Some(key as usize * levels + code),
    };
    let pairs = || keys.iter().zip(&column.codes).map(pair);
    // Most pairs that could be are there, or they are found by sorting those that are.
    let ranks: Vec<usize> = match count * levels <= 4 * keys.len() {
        true => {
            let mut there = vec![false; count * levels];
            pairs().flatten().for_each(|pair| there[pair] = true);
            let there = there.iter().enumerate().filter(|own| *own.1);
            there.map(|own| own.0).collect()
        }
        false => {
            let mut there: Vec<usize> = pairs().flatten().collect();
            there.sort_unstable();
            there.dedup();
            there
        }
    };
    // Where all pairs are there, each is its own rank.
    let all = ranks.len() == count * levels;
    for (key, code) in keys.iter_mut().zip(&column.codes) {
        let rank = pair((key, code)).and_then(|pair| match all {
            true => Some(pair),
            false => ranks.binary_search(&pair).ok(),
        });
        *key = rank.map_or(NONE, |rank| rank as u32);
    }
    ranks.len()
}

/// What the values of one group look like.
///
/// # Errors
/// A confidence outside (0, 1).
pub fn summarize(group: &Group, confidence: f64) -> Result<GroupSummary, Error> {
    check_probability("the confidence", confidence)?;
    let values = &group.values;
    let n = values.len();
    let centre = mean(values);
    let mean = centre.value();
    let deviation = match n {
        0 | 1 => f64::NAN,
        _ => (squares_about(values, centre) / DoubleDouble::from((n - 1) as f64)).value(),
    };
    let deviation = deviation.sqrt();
    let error = deviation / (n as f64).sqrt();
    let reach = match n {
        0 | 1 => f64::NAN,
        _ => error * t_upper_quantile(0.5 * (1.0 - confidence), n as f64 - 1.0),
    };
    let [min, q1, median, q3, max] = quantiles(values, [0.0, 0.25, 0.5, 0.75, 1.0]);
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
        min,
        q1,
        median,
        q3,
        max,
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
