//! Analysis of variance of linear models.

use crate::error::Error;
use crate::model::model_frame::ModelFrame;
use crate::model::model_matrix::{BLOCK, ModelMatrix};
use crate::model::reduced::Reduced;
use foldhash::quality::FixedState;
use nalgebra::DMatrix;
use rayon::prelude::*;
use serde::Serialize;
use std::hash::{BuildHasher, Hasher};
use windfall_distribution::tail::f_upper;
use windfall_mixed::weights::Weights;

/// Which models a term is tested between.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AnovaType {
    /// Each term after those before it.
    Sequential,
    /// Each term after all that do not contain it.
    Hierarchical,
    /// Each term after all others; needs sum contrasts and centred numbers.
    Partial,
}

impl AnovaType {
    /// "I", "II" or "III".
    pub fn roman(self) -> &'static str {
        match self {
            Self::Sequential => "I",
            Self::Hierarchical => "II",
            Self::Partial => "III",
        }
    }
}

/// A row of an analysis of variance.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
#[schema(as = AnovaOutcome)]
pub struct AnovaRow {
    /// The term.
    pub term: String,
    /// Its sum of squares; NaN in a mixed model.
    #[schema(value_type = Option<f64>)]
    pub ss: f64,
    /// Its degrees of freedom; zero for an aliased term.
    pub df: f64,
    /// Its mean square over that of the residuals.
    #[schema(value_type = Option<f64>)]
    pub f: f64,
    /// Probability of F or more without the term.
    #[schema(value_type = Option<f64>)]
    pub p: f64,
}

/// An analysis of variance.
#[derive(Clone, Debug, PartialEq)]
pub struct Anova {
    /// What was tested.
    pub kind: AnovaType,
    /// The terms.
    pub rows: Vec<AnovaRow>,
    /// Sum of squares of the residuals.
    pub residual_ss: f64,
    /// Their degrees of freedom.
    pub residual_df: usize,
}

/// Analyses the variance of a model.
///
/// * `terms`: positions of the terms of the frame that are in the model
pub fn anova(frame: &ModelFrame, reduced: &Reduced, terms: &[usize], kind: AnovaType) -> Anova {
    let contains = |outer: usize, inner: usize| contains(frame, outer, inner);
    anova_within((frame, reduced), &[], terms, kind, &contains)
}

/// Whether a term, the first, contains another.
fn contains(frame: &ModelFrame, outer: usize, inner: usize) -> bool {
    let outer: Vec<usize> = frame.terms[outer].atoms.iter().map(|a| a.0).collect();
    let mut inner = frame.terms[inner].atoms.iter().map(|a| a.0);
    inner.all(|atom| outer.contains(&atom))
}

/// Sums of coefficients that are zero where a term explains nothing, a row of weights of all
/// columns for each: what [`anova`] tests where the variance is known.
///
/// * `place`: the term's among `terms`
pub fn hypothesis(
    (frame, reduced): (&ModelFrame, &Reduced),
    terms: &[usize],
    place: usize,
    kind: AnovaType,
) -> DMatrix<f64> {
    let own = terms[place];
    let first = |term: usize| match kind {
        AnovaType::Sequential => terms[..place].contains(&term),
        AnovaType::Hierarchical => term != own && !contains(frame, term, own),
        AnovaType::Partial => term != own,
    };
    let columns = |chosen: &dyn Fn(usize) -> bool| -> Vec<usize> {
        let chosen = terms.iter().filter(|term| chosen(**term));
        let columns = chosen.flat_map(|term| frame.terms[*term].columns.clone());
        columns.collect()
    };
    let base: Vec<usize> = frame.intercept.then_some(0).into_iter().collect();
    let estimated = reduced.solve(&[base.clone(), columns(&|_| true)].concat());
    // Those before the term, the term, and those after it.
    let order = [
        base,
        columns(&first),
        columns(&|term| term == own),
        columns(&|term| term != own && !first(term)),
    ];
    let mut order = order.concat();
    order.retain(|column| estimated.columns.contains(column));
    let solved = reduced.solve(&order);
    // The triangle's rows of the term.
    let count = solved.columns.len();
    let triangle = solved
        .inverse
        .solve_upper_triangular(&DMatrix::identity(count, count));
    let triangle = triangle.unwrap_or_else(|| DMatrix::identity(count, count));
    let places = (0..count).filter(|own_place| {
        let column = solved.columns[*own_place];
        frame.terms[own].columns.contains(&column)
    });
    let places: Vec<usize> = places.collect();
    let mut sums = DMatrix::zeros(places.len(), frame.names.len());
    for (row, place) in places.into_iter().enumerate() {
        for (inner, column) in solved.columns.iter().enumerate() {
            sums[(row, *column)] = triangle[(place, inner)];
        }
    }
    sums
}

/// [`anova`] with the columns of blocks, which stand before all terms.
///
/// * `contains`: whether a term, the first, contains another
pub fn anova_within(
    (frame, reduced): (&ModelFrame, &Reduced),
    blocks: &[usize],
    terms: &[usize],
    kind: AnovaType,
    contains: &dyn Fn(usize, usize) -> bool,
) -> Anova {
    let base = frame.intercept.then_some(0).into_iter();
    let base: Vec<usize> = base.chain(blocks.iter().copied()).collect();
    // What is aliased in the whole model is in none: else every column that it
    // depends on would explain nothing after it.
    let every = terms
        .iter()
        .flat_map(|term| frame.terms[*term].columns.clone());
    let every: Vec<usize> = base.iter().copied().chain(every).collect();
    let estimated_columns = reduced.solve(&every).columns;
    let columns_of = |chosen: &dyn Fn(usize) -> bool| {
        let chosen = terms.iter().filter(|term| chosen(**term));
        let columns = chosen.flat_map(|term| frame.terms[*term].columns.clone());
        let columns = columns.filter(|column| estimated_columns.contains(column));
        let columns: Vec<usize> = base.iter().copied().chain(columns).collect();
        let solved = reduced.solve(&columns);
        (solved.residual.value().max(0.0), solved.columns.len())
    };
    let (residual_ss, estimated) = columns_of(&|_| true);
    let residual_df = reduced.rows.saturating_sub(estimated);
    let rows = terms.iter().enumerate().map(|(place, term)| {
        let ((without, few), (with, many)) = match kind {
            AnovaType::Sequential => {
                let before = |t: usize| terms[..place].contains(&t);
                let up_to = |t: usize| terms[..=place].contains(&t);
                (columns_of(&before), columns_of(&up_to))
            }
            AnovaType::Hierarchical => {
                let others = |t: usize| !contains(t, *term);
                let also = |t: usize| t == *term || !contains(t, *term);
                (columns_of(&others), columns_of(&also))
            }
            AnovaType::Partial => (columns_of(&|t| t != *term), (residual_ss, estimated)),
        };
        row(
            &frame.terms[*term].name,
            (without - with).max(0.0),
            many - few,
            (residual_ss, residual_df),
        )
    });
    Anova {
        kind,
        rows: rows.collect(),
        residual_ss,
        residual_df,
    }
}

fn row(term: &str, ss: f64, df: usize, (residual_ss, residual_df): (f64, usize)) -> AnovaRow {
    let f = match (df, residual_df) {
        (0, _) | (_, 0) => f64::NAN,
        _ => (ss / df as f64) / (residual_ss / residual_df as f64),
    };
    AnovaRow {
        term: term.to_owned(),
        ss,
        df: df as f64,
        f,
        p: f_upper(f, df as f64, residual_df as f64),
    }
}

/// A sum of squares with its degrees of freedom.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct SumOfSquares {
    /// Sum of squares.
    #[schema(value_type = Option<f64>)]
    pub ss: f64,
    /// Degrees of freedom.
    #[schema(value_type = Option<f64>)]
    pub df: f64,
}

/// Lack of fit against pure error.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
#[schema(as = LackOfFitOutcome)]
pub struct LackOfFit {
    /// What the model misses.
    pub lack: AnovaRow,
    /// Scatter of rows with equal settings.
    pub pure_error: SumOfSquares,
}

/// Splits the residuals into lack of fit and pure error of rows with equal settings; `None`
/// without repeated rows. A model with a coefficient for every setting leaves no degrees of
/// freedom for the lack of fit.
///
/// * `x`: the settings; `columns`: those of its columns that count
///
/// # Errors
/// A setting is undefined.
///
/// # Numerics
/// Settings are told apart by two hashes of 64 bits: with a million of them, two are taken for
/// equal with a probability of 1e-27.
pub fn lack_of_fit<'a>(
    x: impl Into<ModelMatrix<'a>>,
    columns: &[usize],
    (y, weights): (&[f64], &Weights),
    (residual_ss, residual_df): (f64, usize),
) -> Result<Option<LackOfFit>, Error> {
    let order = repeated(&x.into(), columns)?;
    let (mut pure_ss, mut pure_df) = (0.0, 0);
    for group in order.chunk_by(|a, b| a.0 == b.0) {
        let group: Vec<usize> = group.iter().map(|(_, row)| *row).collect();
        let weight = |row: &usize| weights.weight(*row);
        let sum: f64 = group.iter().map(|row| weight(row) * y[*row]).sum();
        let mean = sum / group.iter().map(weight).sum::<f64>();
        let squares = group.iter();
        let squares = squares.map(|row| weight(row) * (y[*row] - mean).powi(2));
        pure_ss += squares.sum::<f64>();
        pure_df += group.len() - 1;
    }
    if pure_df == 0 || residual_df < pure_df {
        return Ok(None);
    }
    let df = residual_df - pure_df;
    let ss = if df == 0 {
        0.0
    } else {
        (residual_ss - pure_ss).max(0.0)
    };
    Ok(Some(LackOfFit {
        lack: row("lack of fit", ss, df, (pure_ss, pure_df)),
        pure_error: SumOfSquares {
            ss: pure_ss,
            df: pure_df as f64,
        },
    }))
}

/// A hash of the settings of a row.
///
/// * `which`: seed, 0 or 1, of one of two hashes
fn key_of(x: &DMatrix<f64>, row: usize, columns: &[usize], which: u64) -> u64 {
    let mut hasher = FixedState::with_seed(which).build_hasher();
    for column in columns {
        // Zeros of both signs are one setting.
        hasher.write_u64((x[(row, *column)] + 0.0).to_bits());
    }
    hasher.finish()
}

/// Rows in the order of their hashes, without most of those that are alone with theirs.
fn repeated(x: &ModelMatrix, columns: &[usize]) -> Result<Vec<([u64; 2], usize)>, Error> {
    // A part of each hash takes little memory and shows nearly all that are alone.
    let parts = x.each_block(|_, x| {
        let rows = 0..x.nrows();
        rows.map(|row| key_of(x, row, columns, 0) as u32)
            .collect::<Vec<u32>>()
    })?;
    let rows = twice(&parts.concat());
    let blocks: Vec<&[usize]> = rows.chunk_by(|a, b| a / BLOCK == b / BLOCK).collect();
    let keyed = blocks.into_par_iter().map(|rows| {
        let start = rows[0] / BLOCK * BLOCK;
        let x = x.block(start..(start + BLOCK).min(x.rows()))?;
        let keyed = rows.iter().map(|row| {
            (
                [0, 1].map(|own| key_of(&x, row - start, columns, own)),
                *row,
            )
        });
        Ok(keyed.collect::<Vec<_>>())
    });
    let keyed: Vec<Result<Vec<_>, Error>> = keyed.collect();
    let keyed: Vec<Vec<_>> = keyed.into_iter().collect::<Result<_, _>>()?;
    let mut order = keyed.concat();
    order.sort_unstable();
    Ok(order)
}

/// Places of numbers that occur more than once, in their order.
fn twice(numbers: &[u32]) -> Vec<usize> {
    let mask = (16 * numbers.len()).clamp(64, 1 << 31).next_power_of_two() - 1;
    let mut seen = vec![0_u64; (mask + 1) / 64];
    let mut again = Vec::new();
    for number in numbers {
        let place = *number as usize & mask;
        let (word, bit) = (&mut seen[place / 64], 1 << (place % 64));
        if *word & bit != 0 {
            again.push(place);
        }
        *word |= bit;
    }
    again.sort_unstable();
    again.dedup();
    let among = |number: &u32| again.binary_search(&(*number as usize & mask)).is_ok();
    let found = numbers.iter().copied().zip(0..);
    let mut found: Vec<(u32, usize)> = found.filter(|(number, _)| among(number)).collect();
    found.sort_unstable();
    let groups = found
        .chunk_by(|a, b| a.0 == b.0)
        .filter(|own| own.len() > 1);
    let mut places: Vec<usize> = groups.flatten().map(|own| own.1).collect();
    places.sort_unstable();
    places
}
