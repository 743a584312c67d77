//! Means of the response for levels of categories, everything else being equal, and their
//! differences.

use crate::coefficient::Estimated;
use crate::compare::multiple_comparison::holm;
use crate::distribution::studentized_range::{
    studentized_range_upper, studentized_range_upper_quantile,
};
use crate::distribution::tail::{t_two_sided, t_upper_quantile};
use crate::error::Error;
use crate::model::encoding::Encoding;
use crate::model::expression::columns_of;
use crate::model::model_frame::{ModelFrame, prediction_rows};
use crate::table::{Categories, Cells, Column, Table};
use nalgebra::DMatrix;
use std::f64::consts::SQRT_2;

/// Most points of the grid that means are taken over.
const MOST_POINTS: usize = 100_000;

/// Most means: of these there are 4,950 pairs.
const MOST_MEANS: usize = 100;

/// Means that were asked for, as sums of coefficients.
#[derive(Clone, Debug, PartialEq)]
pub struct MarginalRows {
    /// Levels of the columns that were asked for, of each mean.
    pub groups: Vec<Vec<String>>,
    /// What the columns of the model are multiplied by, a row for each mean.
    pub rows: DMatrix<f64>,
    /// Columns of numbers with the mean at which they are held.
    pub held: Vec<(String, f64)>,
}

/// How p and intervals of differences allow for their number.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Adjustment {
    /// Studentised range of all means (Tukey 1953; Kramer 1956).
    #[default]
    Tukey,
    /// Holm's p, Bonferroni's intervals.
    Holm,
    /// None.
    Single,
}

/// The difference of two means.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeanDifference {
    /// Place of the first mean.
    pub first: usize,
    /// Place of the second, which comes later.
    pub second: usize,
    /// Second less first.
    pub difference: Estimated,
    /// Difference over its standard error.
    pub t: f64,
    /// Its probability, adjusted.
    pub p: f64,
    /// Lower end of its interval, adjusted.
    pub low: f64,
    /// Upper end.
    pub high: f64,
}

/// Means for the levels of some categories: over all levels of the other categories, each with
/// equal weight, and at the mean of every column of numbers.
///
/// * `table`: rows that the model was fitted to
/// * `by`: columns of categories
///
/// # Errors
/// A column is no category of the model, or is used as a number too; more than 100 means, or
/// 100,000 combinations of levels.
///
/// # Source
/// Searle, S. R., Speed, F. M. and Milliken, G. A. (1980), Population marginal means in the
/// linear model: an alternative to least squares means, Am. Stat. 34, 216.
pub fn marginal_rows(
    frame: &ModelFrame,
    table: &Table,
    by: &[String],
) -> Result<MarginalRows, Error> {
    let mut factors: Vec<(&String, &[String])> = Vec::new();
    let mut numbers: Vec<String> = Vec::new();
    for atom in &frame.atoms {
        match atom {
            Encoding::Category { column, levels, .. } => {
                if factors.iter().all(|(known, _)| *known != column) {
                    factors.push((column, levels));
                }
            }
            Encoding::Numbers { node, .. }
            | Encoding::Polynomial { node, .. }
            | Encoding::Scaled { node, .. } => numbers.extend(columns_of(node)),
        }
    }
    numbers.sort_unstable();
    numbers.dedup();
    let known: Vec<&str> = factors.iter().map(|(name, _)| name.as_str()).collect();
    if let Some(other) = by.iter().find(|name| !known.contains(&name.as_str())) {
        let known = match known.is_empty() {
            true => "there is none".to_owned(),
            false => format!("there are {}", known.join(", ")),
        };
        return Err(Error::Request {
            what: format!("--means {}", by.join(",")),
            problem: format!("{other} is no category of the model: {known}"),
        });
    }
    if let Some(both) = numbers.iter().find(|name| known.contains(&name.as_str())) {
        return Err(Error::Request {
            what: format!("--means {}", by.join(",")),
            problem: format!(
                "{both} stands in the model as a category and as a number, and cannot be held at \
                 its mean"
            ),
        });
    }
    // Those that were asked for vary slowest, in the order in which they were named.
    let asked = |name: &String| by.iter().position(|own| own == name).unwrap_or(by.len());
    factors.sort_by_key(|(name, _)| asked(name));
    let points: usize = factors.iter().map(|(_, levels)| levels.len()).product();
    if points > MOST_POINTS {
        return Err(Error::Request {
            what: format!("--means {}", by.join(",")),
            problem: format!("{points} combinations of levels are too many"),
        });
    }
    let held: Vec<(String, f64)> = numbers
        .into_iter()
        .map(|name| {
            let values = table.numbers(&name)?;
            let mean = values.iter().sum::<f64>() / values.len() as f64;
            Ok((name, mean))
        })
        .collect::<Result<_, Error>>()?;
    let group_count: usize = factors[..by.len()]
        .iter()
        .map(|(_, own)| own.len())
        .product();
    if group_count > MOST_MEANS {
        return Err(Error::Request {
            what: format!("--means {}", by.join(",")),
            problem: format!(
                "there are {group_count} means, and at most {MOST_MEANS} are compared with each \
                 other; ask for fewer categories"
            ),
        });
    }
    let each = points / group_count;
    let x = prediction_rows(frame, &grid(&factors, &held, points))?;
    let groups = (0..group_count).map(|group| levels_at(&factors, group * each, points));
    Ok(MarginalRows {
        groups: groups.map(|own| own[..by.len()].to_vec()).collect(),
        rows: DMatrix::from_fn(group_count, x.ncols(), |group, column| {
            let rows = x.view((group * each, column), (each, 1));
            rows.sum() / each as f64
        }),
        held,
    })
}

/// Level of every factor at a point of the grid; the last varies fastest.
fn places_at(factors: &[(&String, &[String])], point: usize, points: usize) -> Vec<usize> {
    let (mut left, mut block) = (point, points);
    let place = |(_, levels): &(&String, &[String])| {
        block /= levels.len();
        let place = left / block;
        left %= block;
        place
    };
    factors.iter().map(place).collect()
}

fn levels_at(factors: &[(&String, &[String])], point: usize, points: usize) -> Vec<String> {
    let places = places_at(factors, point, points);
    let levels = factors.iter().zip(places);
    levels
        .map(|((_, levels), place)| levels[place].clone())
        .collect()
}

/// All combinations of levels, with the numbers held.
fn grid(factors: &[(&String, &[String])], held: &[(String, f64)], points: usize) -> Table {
    let places: Vec<Vec<usize>> = (0..points)
        .map(|point| places_at(factors, point, points))
        .collect();
    let categories = factors
        .iter()
        .enumerate()
        .map(|(factor, (name, levels))| Column {
            name: (*name).clone(),
            cells: Cells::Categories(Categories {
                levels: levels.to_vec(),
                codes: places.iter().map(|own| Some(own[factor])).collect(),
                ordered: true,
            }),
        });
    let numbers = held.iter().map(|(name, mean)| Column {
        name: name.clone(),
        cells: Cells::Numbers(vec![*mean; points]),
    });
    Table {
        columns: categories.chain(numbers).collect(),
    }
}

/// Interval of an estimate at a level of confidence.
pub fn interval(own: &Estimated, confidence: f64) -> (f64, f64) {
    let reach = own.se * t_upper_quantile(0.5 * (1.0 - confidence), own.df);
    (own.value - reach, own.value + reach)
}

/// Differences of all pairs of means.
///
/// * `estimate`: of a sum of the model's columns
pub fn differences(
    means: &MarginalRows,
    adjustment: Adjustment,
    confidence: f64,
    estimate: &dyn Fn(&[f64]) -> Estimated,
) -> Vec<MeanDifference> {
    let count = means.groups.len();
    let pairs = count * count.saturating_sub(1) / 2;
    let mut found = Vec::with_capacity(pairs);
    for first in 0..count {
        for second in first + 1..count {
            let weights = means.rows.row(second) - means.rows.row(first);
            let own = estimate(weights.as_slice());
            let t = own.value / own.se;
            let single = t_two_sided(t, own.df);
            let (p, critical) = match adjustment {
                Adjustment::Tukey if count > 2 => (
                    studentized_range_upper(SQRT_2 * t.abs(), count, own.df),
                    studentized_range_upper_quantile(1.0 - confidence, count, own.df) / SQRT_2,
                ),
                Adjustment::Holm => {
                    let level = (1.0 - confidence) / pairs as f64;
                    (single, t_upper_quantile(0.5 * level, own.df))
                }
                _ => (single, t_upper_quantile(0.5 * (1.0 - confidence), own.df)),
            };
            found.push(MeanDifference {
                first,
                second,
                difference: own,
                t,
                p,
                low: own.value - critical * own.se,
                high: own.value + critical * own.se,
            });
        }
    }
    if adjustment == Adjustment::Holm {
        let single: Vec<f64> = found.iter().map(|own| own.p).collect();
        for (own, p) in found.iter_mut().zip(holm(&single)) {
            own.p = p;
        }
    }
    found
}
