//! How well a model predicts rows that it was not fitted to.

use crate::model::model_frame::ModelFrame;
use crate::model::reduced::reduce;
use crate::model::selection::{SelectionOptions, select};
use nalgebra::DMatrix;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{RngCore, SeedableRng};

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
}

/// Divides the rows into parts by chance and predicts each part from the others.
///
/// * `terms`: terms of the model, all that may be selected from
/// * `selection`: is repeated within each division, so that the result counts what
///   choosing costs
///
/// `None` where some division leaves a column without an estimate.
pub fn cross_validate(
    frame: &ModelFrame,
    x: &DMatrix<f64>,
    y: &[f64],
    terms: &[usize],
    selection: Option<&SelectionOptions>,
    parts: Parts,
) -> Option<CrossValidation> {
    let rows = y.len();
    let count = match parts.units {
        Some(units) => units.iter().max().map_or(0, |last| last + 1),
        None => rows,
    };
    let folds = parts.folds.clamp(2, count.max(2));
    let mut order: Vec<usize> = (0..count).collect();
    shuffle(&mut order, parts.seed);
    let mut part_of_unit = vec![0; count];
    for (place, unit) in order.iter().enumerate() {
        part_of_unit[*unit] = place % folds;
    }
    let part = |row: usize| part_of_unit[parts.units.map_or(row, |units| units[row])];
    let (mut error, mut total) = (0.0, 0.0);
    for fold in 0..folds {
        let (left_out, kept): (Vec<usize>, Vec<usize>) =
            (0..rows).partition(|row| part(*row) == fold);
        let train_x = x.select_rows(&kept);
        let train_y: Vec<f64> = kept.iter().map(|row| y[*row]).collect();
        let reduced = reduce(&train_x, &train_y);
        let chosen = match selection {
            Some(options) => select(frame, &reduced, options).terms,
            None => terms.to_vec(),
        };
        let base = frame.intercept.then_some(0);
        let columns = chosen.iter().flat_map(|t| frame.terms[*t].columns.clone());
        let columns: Vec<usize> = base.into_iter().chain(columns).collect();
        let solved = reduced.solve(&columns);
        if !solved.aliased.is_empty() {
            return None;
        }
        let mean = train_y.iter().sum::<f64>() / train_y.len() as f64;
        for row in left_out {
            let pairs = solved.columns.iter().zip(&solved.estimates);
            let predicted: f64 = pairs.map(|(c, b)| x[(row, *c)] * b.value()).sum();
            error += (y[row] - predicted).powi(2);
            total += (y[row] - mean).powi(2);
        }
    }
    Some(CrossValidation {
        folds,
        rms: (error / rows as f64).sqrt(),
        r2: 1.0 - error / total,
    })
}

/// Fisher and Yates' shuffle.
fn shuffle(order: &mut [usize], seed: u64) {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    for last in (1..order.len()).rev() {
        // A product with a 32-bit number: uniform to 1 in 4e9.
        let chosen = (u64::from(random.next_u32()) * (last as u64 + 1)) >> 32;
        order.swap(last, chosen as usize);
    }
}
