//! The model matrix: held, or evaluated a block of rows at a time where it would be as large as
//! the table that it is made from.

use crate::error::Error;
use crate::model::model_frame::{ModelFrame, prediction_rows};
use crate::numbers::Numbers;
use crate::runs::Runs;
use crate::table::{Categories, Cells, Column, Table};
use crate::weights::Weights;
use nalgebra::DMatrix;
use rayon::prelude::*;
use std::borrow::Cow;
use std::ops::Range;

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
    Weighed {
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
    pub fn weighed(&'a self, weights: &'a Weights) -> Self {
        match weights.is_empty() {
            true => *self,
            false => Self::Weighed { of: self, weights },
        }
    }
}

impl ModelMatrix<'_> {
    /// Number of rows.
    pub fn rows(&self) -> usize {
        match self {
            Self::Held(x) => x.nrows(),
            Self::Evaluated { kept, .. } => kept.len(),
            Self::Weighed { of, .. } => of.rows(),
        }
    }

    /// Number of columns.
    pub fn columns(&self) -> usize {
        match self {
            Self::Held(x) => x.ncols(),
            Self::Evaluated { frame, .. } => frame.names.len(),
            Self::Weighed { of, .. } => of.columns(),
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
            Self::Weighed { of, weights } => {
                let first = rows.start;
                let mut x = of.block(rows)?;
                let height = x.nrows().max(1);
                let columns = x.as_mut_slice().chunks_exact_mut(height);
                columns.for_each(|own| weights.weigh_from(first, own));
                Ok(x)
            }
            Self::Evaluated { frame, table, kept } => {
                let columns = frame.columns();
                let own = table
                    .columns
                    .iter()
                    .filter(|own| columns.contains(&own.name));
                let own = own.map(|own| Column {
                    name: own.name.clone(),
                    cells: within(&own.cells, kept, rows.clone()),
                });
                let table = Table {
                    columns: own.collect(),
                };
                let x = match columns.is_empty() {
                    true => Ok(DMatrix::from_element(rows.len(), frame.names.len(), 1.0)),
                    false => prediction_rows(frame, &table),
                };
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
    let runs = kept.within(rows);
    match cells {
        Cells::Numbers(numbers) => {
            let mut values = Vec::new();
            for run in runs {
                values.extend_from_slice(&numbers.within(run));
            }
            Cells::Numbers(Numbers::from(values))
        }
        Cells::Categories(own) => Cells::Categories(Categories {
            levels: own.levels.clone(),
            codes: runs
                .flat_map(|run| own.codes[run].iter().copied())
                .collect(),
            ordered: own.ordered,
        }),
    }
}
