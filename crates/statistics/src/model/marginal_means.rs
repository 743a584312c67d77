//! Means of the response, and its slopes, for levels of categories, everything else being equal.

use crate::error::Error;
use crate::model::encoding::Encoding;
use crate::model::expression::columns_of;
use crate::model::model_frame::{ModelFrame, prediction_rows};
use crate::table::{Categories, Cells, Column, Table};
use nalgebra::DMatrix;

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
    /// Columns of numbers with the value at which they are held.
    pub held: Vec<(String, f64)>,
}

/// Which means are asked for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Asked<'a> {
    /// The option as it was written, for messages.
    pub option: &'a str,
    /// Columns of categories.
    pub by: &'a [String],
    /// Columns of numbers that are held at a value instead of their mean.
    pub at: &'a [(String, f64)],
}

impl Asked<'_> {
    fn refused(&self, problem: String) -> Error {
        Error::Request {
            what: self.option.to_owned(),
            problem,
        }
    }
}

/// A category with its levels.
type Factor<'a> = (&'a String, &'a [String]);

/// Means for the levels of some categories: over all levels of the other categories, each with
/// equal weight, and at the mean of every column of numbers that is not held elsewhere.
///
/// * `table`: rows that the model was fitted to
///
/// # Errors
/// A column is no category of the model, or is used as a number too; a held column is no number
/// of the model; more than 100 means, or 100,000 combinations of levels.
///
/// # Source
/// Searle, S. R., Speed, F. M. and Milliken, G. A. (1980), Population marginal means in the
/// linear model: an alternative to least squares means, Am. Stat. 34, 216.
pub fn marginal_rows(
    frame: &ModelFrame,
    table: &Table,
    asked: Asked,
) -> Result<MarginalRows, Error> {
    let (mut factors, numbers) = factors_and_numbers(frame);
    check_names(&factors, &numbers, asked)?;
    // Those that were asked for vary slowest, in the order in which they were named.
    let count = asked.by.len();
    let place = |name: &String| asked.by.iter().position(|own| own == name);
    factors.sort_by_key(|(name, _)| place(name).unwrap_or(count));
    let product = |of: &[Factor]| of.iter().map(|(_, own)| own.len()).product::<usize>();
    let (points, groups) = (product(&factors), product(&factors[..count]));
    if points > MOST_POINTS {
        return Err(asked.refused(format!("{points} combinations of levels are too many")));
    }
    if groups > MOST_MEANS {
        return Err(asked.refused(format!(
            "there are {groups} means, and at most {MOST_MEANS} are compared with each other; ask \
             for fewer categories"
        )));
    }
    let held: Vec<(String, f64)> = numbers
        .into_iter()
        .map(|name| {
            let fixed = asked.at.iter().find(|(own, _)| *own == name);
            let values = table.numbers(&name)?;
            let mean = values.iter().sum::<f64>() / values.len() as f64;
            Ok((name, fixed.map_or(mean, |(_, value)| *value)))
        })
        .collect::<Result<_, Error>>()?;
    let each = points / groups;
    let x = prediction_rows(frame, &grid(&factors, &held, points))?;
    let levels = (0..groups).map(|group| levels_at(&factors, group * each, points));
    Ok(MarginalRows {
        groups: levels.map(|own| own[..count].to_vec()).collect(),
        rows: DMatrix::from_fn(groups, x.ncols(), |group, column| {
            let rows = x.view((group * each, column), (each, 1));
            rows.sum() / each as f64
        }),
        held,
    })
}

/// Slopes of the means on a column of numbers, at its mean or where it is held.
///
/// # Errors
/// As [`marginal_rows`]; the column is no number of the model.
pub fn slope_rows(
    frame: &ModelFrame,
    table: &Table,
    number: &str,
    asked: Asked,
) -> Result<MarginalRows, Error> {
    let middle = marginal_rows(frame, table, asked)?;
    let held = middle.held.iter().find(|(name, _)| name == number);
    let Some((_, value)) = held else {
        let (_, known) = factors_and_numbers(frame);
        return Err(asked.refused(format!(
            "{number} is no column of numbers of the model: {}",
            listed(&known)
        )));
    };
    let values = table.numbers(number)?;
    let extent = values
        .iter()
        .fold((f64::MAX, f64::MIN), |(low, high), own| {
            (low.min(own), high.max(own))
        });
    let step = match extent.1 > extent.0 {
        true => 1e-3 * (extent.1 - extent.0),
        false => 1e-3 * value.abs().max(1.0),
    };
    let rows_at = |at: f64| -> Result<DMatrix<f64>, Error> {
        let others = asked.at.iter().filter(|(name, _)| name != number);
        let at: Vec<_> = others.cloned().chain([(number.to_owned(), at)]).collect();
        Ok(marginal_rows(frame, table, Asked { at: &at, ..asked })?.rows)
    };
    // Differences of fourth order: exact for polynomials up to the fourth degree.
    let near = rows_at(value + step)? - rows_at(value - step)?;
    let far = rows_at(value + 2.0 * step)? - rows_at(value - 2.0 * step)?;
    Ok(MarginalRows {
        rows: (near * 8.0 - far) / (12.0 * step),
        ..middle
    })
}

/// Categories with their levels, and columns of numbers, of a model.
fn factors_and_numbers(frame: &ModelFrame) -> (Vec<Factor<'_>>, Vec<String>) {
    let mut factors: Vec<Factor> = Vec::new();
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
    (factors, numbers)
}

/// "there are a, b", or that there is none.
fn listed(names: &[String]) -> String {
    match names.is_empty() {
        true => "there is none".to_owned(),
        false => format!("there are {}", names.join(", ")),
    }
}

fn check_names(factors: &[Factor], numbers: &[String], asked: Asked) -> Result<(), Error> {
    let known: Vec<String> = factors.iter().map(|(name, _)| (*name).clone()).collect();
    if let Some(other) = asked.by.iter().find(|name| !known.contains(name)) {
        let known = listed(&known);
        return Err(asked.refused(format!("{other} is no category of the model: {known}")));
    }
    if let Some(both) = numbers.iter().find(|name| known.contains(name)) {
        return Err(asked.refused(format!(
            "{both} stands in the model as a category and as a number, and cannot be held at its \
             mean"
        )));
    }
    if let Some((other, _)) = asked.at.iter().find(|(name, _)| !numbers.contains(name)) {
        return Err(Error::Request {
            what: format!("--at {other}"),
            problem: format!(
                "{other} is no column of numbers of the model: {}",
                listed(numbers)
            ),
        });
    }
    Ok(())
}

/// Level of every factor at a point of the grid; the last varies fastest.
fn places_at(factors: &[Factor], point: usize, points: usize) -> Vec<usize> {
    let (mut left, mut block) = (point, points);
    let place = |(_, levels): &Factor| {
        block /= levels.len();
        let place = left / block;
        left %= block;
        place
    };
    factors.iter().map(place).collect()
}

fn levels_at(factors: &[Factor], point: usize, points: usize) -> Vec<String> {
    let places = places_at(factors, point, points);
    let levels = factors.iter().zip(places);
    levels
        .map(|((_, levels), place)| levels[place].clone())
        .collect()
}

/// All combinations of levels, with the numbers held.
fn grid(factors: &[Factor], held: &[(String, f64)], points: usize) -> Table {
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
        cells: Cells::Numbers(vec![*mean; points].into()),
    });
    Table {
        columns: categories.chain(numbers).collect(),
    }
}
