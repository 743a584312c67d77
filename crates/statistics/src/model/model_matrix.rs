//! The model matrix: held, or evaluated a block of rows at a time where it would be as large as
//! the table that it is made from.

use crate::error::Error;
use crate::model::model_frame::{ModelFrame, matrix};
use crate::numbers::Numbers;
use crate::runs::Runs;
use crate::table::{Categories, Cells, Column, Table};
use nalgebra::DMatrix;
use rayon::prelude::*;
use std::borrow::Cow;
use std::ops::Range;
use windfall_mixed::weights::Weights;

/// Rows of a block.
pub(crate) const BLOCK: usize = 4096;

/// A model matrix.
#[derive(Clone, Copy, Debug)]
pub enum ModelMatrix<'a> {
    /// In memory.
    Held(&'a DMatrix<f64>),
    /// Evaluated where it is needed.
    Evaluated {
        /// How columns come about.
        frame: &'a ModelFrame,
        /// Where they come from.
        table: &'a Table,
        /// Rows of the table that are here, from 0.
        kept: &'a Runs,
    },
    /// Rows of another times the roots of their weights.
    Weighted {
        /// The other.
        of: &'a ModelMatrix<'a>,
        /// The weights.
        weights: &'a Weights,
    },
}

impl<'a> From<&'a DMatrix<f64>> for ModelMatrix<'a> {
    fn from(x: &'a DMatrix<f64>) -> Self {
        Self::Held(x)
    }
}

impl<'a> ModelMatrix<'a> {
    /// Its rows times the roots of their weights.
    pub fn weighted(&'a self, weights: &'a Weights) -> Self {
        match weights.is_empty() {
            true => *self,
            false => Self::Weighted { of: self, weights },
        }
    }
}

impl ModelMatrix<'_> {
    /// Number of rows.
    pub fn rows(&self) -> usize {
        match self {
            Self::Held(x) => x.nrows(),
            Self::Evaluated { kept, .. } => kept.len(),
            Self::Weighted { of, .. } => of.rows(),
        }
    }

    /// Number of columns.
    pub fn columns(&self) -> usize {
        match self {
            Self::Held(x) => x.ncols(),
            Self::Evaluated { frame, .. } => frame.names.len(),
            Self::Weighted { of, .. } => of.columns(),
        }
    }

    /// All rows.
    ///
    /// # Errors
    /// As [`ModelMatrix::block`].
    pub fn whole(&self) -> Result<Cow<'_, DMatrix<f64>>, Error> {
        match self {
            Self::Held(x) => Ok(Cow::Borrowed(x)),
            _ => self.block(0..self.rows()).map(Cow::Owned),
        }
    }

    /// Some rows.
    ///
    /// # Errors
    /// A value is undefined, a level unknown; named by its row among all.
    pub fn block(&self, rows: Range<usize>) -> Result<DMatrix<f64>, Error> {
        match self {
            Self::Held(x) => Ok(x.rows_range(rows).into_owned()),
            Self::Weighted { of, weights } => {
                let first = rows.start;
                let mut x = of.block(rows)?;
                let height = x.nrows().max(1);
                let columns = x.as_mut_slice().chunks_exact_mut(height);
                columns.for_each(|own| weights.weigh_from(first, own));
                Ok(x)
            }
            Self::Evaluated { frame, table, kept } => {
                let columns = frame.evaluated_columns();
                let own = table
                    .columns
                    .iter()
                    .filter(|own| columns.contains(&own.name));
                let own = own.map(|own| Column {
                    name: own.name.clone(),
                    cells: within(&own.cells, kept, rows.clone()),
                });
                // Where none is, a nameless one says how many rows there are.
                let none = columns.is_empty().then(|| Column {
                    name: String::new(),
                    cells: Cells::Numbers(vec![0.0; rows.len()].into()),
                });
                let own = Table {
                    columns: own.chain(none).collect(),
                };
                let x = matrix(frame, &own, |name, column| {
                    fill(table.numbers(name)?, kept, rows.clone(), column);
                    Ok(())
                });
                x.map_err(|error| error.of_rows(|row| Some(rows.start + row)))
            }
        }
    }

    /// Work on each block of rows on all cores; what was found, in their order.
    ///
    /// # Errors
    /// As [`ModelMatrix::block`], of the first block with one.
    pub(crate) fn each_block<T: Send>(
        &self,
        work: impl Fn(Range<usize>, &DMatrix<f64>) -> T + Sync,
    ) -> Result<Vec<T>, Error> {
        let rows = self.rows();
        let starts: Vec<usize> = (0..rows).step_by(BLOCK).collect();
        let found = starts.into_par_iter().map(|start| {
            let own = start..(start + BLOCK).min(rows);
            Ok(work(own.clone(), &self.block(own)?))
        });
        let found: Vec<Result<T, Error>> = found.collect();
        found.into_iter().collect()
    }
}

/// Cells of some of the rows that are kept.
fn within(cells: &Cells, kept: &Runs, rows: Range<usize>) -> Cells {
    match cells {
        Cells::Numbers(numbers) => {
            let mut values = vec![0.0; rows.len()];
            fill(numbers, kept, rows, &mut values);
            Cells::Numbers(values.into())
        }
        Cells::Categories(own) => Cells::Categories(Categories {
            levels: own.levels.clone(),
            codes: kept
                .within(rows)
                .flat_map(|run| own.codes[run].iter().copied())
                .collect(),
            ordered: own.ordered,
        }),
    }
}

/// Numbers of some of the rows that are kept.
fn fill(numbers: &Numbers, kept: &Runs, rows: Range<usize>, mut into: &mut [f64]) {
    for run in kept.within(rows) {
        let (own, rest) = into.split_at_mut(run.len());
        numbers.fill(run, own);
        into = rest;
    }
}

#[cfg(test)]
mod tests {
    use crate::model::contrast::Contrast;
    use crate::model::formula::formula;
    use crate::model::linear_model::fit_reduced;
    use crate::model::model_rows::{formula_rows, model_rows};
    use crate::model::reduced::reduce;
    use crate::residuals::cross_validation::{Parts, cross_validate};
    use crate::residuals::diagnostics::robust_covariance;
    use crate::table::{Cells, Column, LevelCodes, Table};

    /// A table of many rows, of which one in a hundred lacks a cell.
    fn table(rows: usize) -> Table {
        let wave = |row: usize, step: f64| ((row as f64 * step).sin() * 1e3).round() / 1e3;
        let missing = |row: usize| if row % 100 == 7 { f64::NAN } else { 0.0 };
        let numbers = |name: &str, value: &dyn Fn(usize) -> f64| Column {
            name: name.to_owned(),
            cells: Cells::Numbers((0..rows).map(value).collect()),
        };
        let mut levels = LevelCodes::default();
        (0..rows).for_each(|row| levels.push(Some(["a", "b", "c"][row * row % 3])));
        Table {
            columns: vec![
                numbers("y", &|row| 2.0 + wave(row, 1.7) + missing(row)),
                numbers("x", &|row| wave(row, 0.31)),
                numbers("z", &|row| 3.0 + wave(row, 0.077)),
                Column {
                    name: "f".to_owned(),
                    cells: Cells::Categories(levels.sorted()),
                },
            ],
        }
    }

    /// A matrix that is evaluated in blocks gives the bits of one in memory.
    #[test]
    fn repeats_the_matrix_in_memory() {
        let table = table(60_000);
        for text in [
            "y ~ log(z) + f * x + poly(x, 2)",
            "y ~ 1 + I(2 * 3) + x + z + f + x:z",
        ] {
            let formula = formula(text, &[]).unwrap();
            let held = model_rows(&formula, &table, Contrast::Treatment, &[]).unwrap();
            let rows = formula_rows(&formula, &table, Contrast::Treatment, &[]).unwrap();
            let x = rows.x();
            assert!(matches!(x, super::ModelMatrix::Evaluated { .. }));
            assert_eq!(*x.whole().unwrap(), held.x);
            let reduced = rows.reduced().unwrap();
            assert_eq!(reduced, reduce(&held.x, &held.y));
            let wanted: Vec<usize> = (0..x.columns()).collect();
            let fit = fit_reduced(&rows.frame, x, &rows.y, &reduced, &wanted, 0.95).unwrap();
            let own = fit_reduced(&held.frame, &held.x, &held.y, &reduced, &wanted, 0.95);
            assert_eq!(fit, own.unwrap());
            let robust = robust_covariance(&fit, &x).unwrap();
            assert_eq!(robust, robust_covariance(&fit, &(&held.x).into()).unwrap());
        }
    }

    /// Parts that are reduced once predict what divisions by themselves do.
    #[test]
    fn conserves_the_error_of_prediction() {
        let table = table(60_000);
        let formula = formula("y ~ x + z + f + x:z", &[]).unwrap();
        let rows = formula_rows(&formula, &table, Contrast::Treatment, &[]).unwrap();
        let terms: Vec<usize> = (0..rows.frame.terms.len()).collect();
        let found = |folds: usize| {
            let parts = Parts {
                folds,
                seed: 3,
                units: None,
                weights: None,
            };
            let found = cross_validate(&rows.frame, rows.x(), &rows.y, &terms, None, parts);
            found.unwrap().unwrap()
        };
        let x = rows.x();
        let whole = x.whole().unwrap();
        let (few, many) = (found(2), found(64));
        // By hand: each half predicted from the other.
        let mut halves = [Vec::new(), Vec::new()];
        let part = crate::residuals::cross_validation::parts_of(rows.y.len(), 2, 3);
        (0..rows.y.len()).for_each(|row| halves[part[row] as usize].push(row));
        let wanted: Vec<usize> = (0..x.columns()).collect();
        let mut square = 0.0;
        for (own, other) in [(0, 1), (1, 0)] {
            let y: Vec<f64> = halves[other].iter().map(|row| rows.y[*row]).collect();
            let solved = reduce(&whole.select_rows(&halves[other]), &y).solve(&wanted);
            for row in &halves[own] {
                let pairs = solved.columns.iter().zip(&solved.estimates);
                let predicted: f64 = pairs.map(|(c, b)| whole[(*row, *c)] * b.value()).sum();
                square += (rows.y[*row] - predicted).powi(2);
            }
        }
        let rms = (square / rows.y.len() as f64).sqrt();
        assert!((few.rms / rms - 1.0).abs() < 1e-12, "{} {rms}", few.rms);
        assert!((many.rms / rms - 1.0).abs() < 1e-3);
    }
}
