//! How well a model predicts rows that it was not fitted to.

use crate::error::Error;
use crate::model::model_frame::ModelFrame;
use crate::model::model_matrix::ModelMatrix;
use crate::model::reduced::{Reduced, Solved, is_ordinary, join, joined, reduce, triangle_of_rows};
use crate::model::selection::{SelectionOptions, select};
use nalgebra::DMatrix;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{RngCore, SeedableRng};
use windfall_mixed::weights::Weights;

/// The quality of predictions of left-out rows.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, utoipa::ToSchema)]
#[schema(as = CrossValidationOutcome)]
pub struct CrossValidation {
    /// Parts the rows were divided into.
    pub folds: usize,
    /// Root mean square error of prediction.
    pub rms: f64,
    /// Part of the variation about the mean of the fitted rows that is predicted.
    pub r2: f64,
}

/// How rows are divided into parts.
#[derive(Clone, Copy, Debug)]
pub struct Parts<'a> {
    /// Number of parts.
    pub folds: usize,
    /// Seed of the division.
    pub seed: u64,
    /// Unit (fruit) of each row, from 0 without gaps: rows of one unit stay together. Each row
    /// is one by itself if left out.
    pub units: Option<&'a [usize]>,
    /// What the rows weigh, in the fits and in the mean of squared errors; all 1 if left out.
    pub weights: Option<&'a Weights>,
}

/// Most parts whose rows are reduced once for all divisions.
const MOST_PARTS: usize = 64;

/// Divides the rows into parts by chance and predicts each part from the others.
///
/// * `terms`: terms of the model, all that may be selected from
/// * `selection`: is repeated within each division, so that the result counts what
///   choosing costs
///
/// `None` where some division leaves a column without an estimate.
///
/// # Errors
/// A value of the model matrix is undefined.
pub fn cross_validate<'a>(
    frame: &ModelFrame,
    x: impl Into<ModelMatrix<'a>>,
    y: &[f64],
    terms: &[usize],
    selection: Option<&SelectionOptions>,
    parts: Parts,
) -> Result<Option<CrossValidation>, Error> {
    let equal = Weights::default();
    let weights = parts.weights.unwrap_or(&equal);
    let (x, rows, weighted) = (x.into(), y.len(), weights.weigh(y));
    let (x, y) = (x.weighted(weights), (&*weighted, weights));
    let count = match parts.units {
        Some(units) => units.iter().max().map_or(0, |last| last + 1),
        None => rows,
    };
    let folds = parts.folds.clamp(2, count.max(2));
    let part_of_unit = parts_of(count, folds, parts.seed);
    let part = |row: usize| part_of_unit[parts.units.map_or(row, |units| units[row])] as usize;
    let solved = |reduced: &Reduced| {
        let chosen = match selection {
            Some(options) => select(frame, reduced, options).terms,
            None => terms.to_vec(),
        };
        let base = frame.intercept.then_some(0);
        let columns = chosen.iter().flat_map(|t| frame.terms[*t].columns.clone());
        let columns: Vec<usize> = base.into_iter().chain(columns).collect();
        let solved = reduced.solve(&columns);
        solved.aliased.is_empty().then_some(solved)
    };
    let at_once = !is_ordinary(rows, x.columns()) && folds <= MOST_PARTS;
    let found = match at_once {
        true => from_parts(&x, y, folds, &part, &solved)?,
        false => from_rows(&*x.whole()?, y, folds, &part, &solved),
    };
    let sum: f64 = (0..rows).map(|row| weights.weight(row)).sum();
    Ok(found.map(|(error, total)| CrossValidation {
        folds,
        rms: (error / sum).sqrt(),
        r2: 1.0 - error / total,
    }))
}

/// Part of each unit.
pub(crate) fn parts_of(count: usize, folds: usize, seed: u64) -> Vec<u32> {
    let mut order: Vec<u32> = (0..count as u32).collect();
    shuffle(&mut order, seed);
    let mut part_of_unit = vec![0; count];
    for (place, unit) in order.iter().enumerate() {
        part_of_unit[*unit as usize] = (place % folds) as u32;
    }
    part_of_unit
}

/// Squared errors of predictions, and squared distances from the mean of the fitted rows.
type Squares = (f64, f64);

/// Each division reduced by itself.
fn from_rows(
    x: &DMatrix<f64>,
    (y, weights): (&[f64], &Weights),
    folds: usize,
    part: &dyn Fn(usize) -> usize,
    solved: &dyn Fn(&Reduced) -> Option<Solved>,
) -> Option<Squares> {
    let (mut error, mut total) = (0.0, 0.0);
    for fold in 0..folds {
        let (left_out, kept): (Vec<usize>, Vec<usize>) =
            (0..y.len()).partition(|row| part(*row) == fold);
        let train_x = x.select_rows(&kept);
        let train_y: Vec<f64> = kept.iter().map(|row| y[*row]).collect();
        let solved = solved(&reduce(&train_x, &train_y))?;
        let sum: f64 = kept.iter().map(|row| weights.root(*row) * y[*row]).sum();
        let mean = sum / kept.iter().map(|row| weights.weight(*row)).sum::<f64>();
        for row in left_out {
            error += (y[row] - predicted(x, row, &solved)).powi(2);
            total += (y[row] - weights.root(row) * mean).powi(2);
        }
    }
    Some((error, total))
}

fn predicted(x: &DMatrix<f64>, row: usize, solved: &Solved) -> f64 {
    let pairs = solved.columns.iter().zip(&solved.estimates);
    pairs.map(|(c, b)| x[(row, *c)] * b.value()).sum()
}

/// Rows of each part reduced once: the triangle of all but one follows from those of the parts.
fn from_parts(
    x: &ModelMatrix,
    (y, weights): (&[f64], &Weights),
    folds: usize,
    part: &(dyn Fn(usize) -> usize + Sync),
    solved: &dyn Fn(&Reduced) -> Option<Solved>,
) -> Result<Option<Squares>, Error> {
    let width = x.columns() + 1;
    let blocks = x.each_block(|own, x| {
        let mut rows = vec![Vec::new(); folds];
        for row in own.clone() {
            rows[part(row)].push(row - own.start);
        }
        let y = &y[own];
        let triangles = rows.iter().map(|rows| triangle_of_rows(x, y, rows));
        triangles.collect::<Vec<_>>()
    })?;
    let mut by_part = vec![Vec::new(); folds];
    for block in blocks {
        for (all, own) in by_part.iter_mut().zip(block) {
            all.push(own);
        }
    }
    let by_part: Vec<Vec<f64>> = by_part.into_iter().map(|own| join(own, width)).collect();
    let mut counts = vec![0; folds];
    let (mut sums, mut totals) = (vec![0.0; folds], vec![0.0; folds]);
    for (row, y) in y.iter().enumerate() {
        counts[part(row)] += 1;
        sums[part(row)] += weights.root(row) * y;
        totals[part(row)] += weights.weight(row);
    }
    let (mut error, mut means) = (0.0, Vec::with_capacity(folds));
    for fold in 0..folds {
        let others = (0..folds).filter(|other| *other != fold);
        let triangles = others.clone().map(|other| by_part[other].clone());
        let rows = y.len() - counts[fold];
        let Some(solved) = solved(&joined(triangles.collect(), rows, width)) else {
            return Ok(None);
        };
        error += squared_errors(&by_part[fold], width, &solved);
        let sum: f64 = others.clone().map(|other| sums[other]).sum();
        let total: f64 = others.map(|other| totals[other]).sum();
        means.push(sum / total);
    }
    let squares = y.iter().enumerate();
    let squares = squares.map(|(row, y)| (y - weights.root(row) * means[part(row)]).powi(2));
    Ok(Some((error, squares.sum())))
}

/// Sum of the squared errors of predictions for the rows of a triangle: it keeps the lengths of
/// their combinations.
fn squared_errors(triangle: &[f64], width: usize, solved: &Solved) -> f64 {
    let mut left = triangle[(width - 1) * width..].to_vec();
    for (column, estimate) in solved.columns.iter().zip(&solved.estimates) {
        let own = &triangle[column * width..(column + 1) * width];
        for (left, own) in left.iter_mut().zip(own) {
            *left -= own * estimate.value();
        }
    }
    left.iter().map(|own| own * own).sum()
}

/// Fisher and Yates' shuffle.
fn shuffle(order: &mut [u32], seed: u64) {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    for last in (1..order.len()).rev() {
        // A product with a 32-bit number: uniform to 1 in 4e9.
        let chosen = (u64::from(random.next_u32()) * (last as u64 + 1)) >> 32;
        order.swap(last, chosen as usize);
    }
}
