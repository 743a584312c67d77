//! Which level of a category decides on the residual variance of a row.

use crate::error::MixedError;
use crate::term::check_length;

/// Which level decides on the residual variance of each row.
#[derive(Clone, Debug, PartialEq)]
pub struct ResidualLevels {
    /// The category.
    pub column: String,
    /// Names of its levels, each of which has rows.
    pub names: Vec<String>,
    /// Level of each row, from 0.
    pub level: Vec<usize>,
}

impl ResidualLevels {
    /// Rows of each level.
    pub fn sizes(&self) -> Vec<usize> {
        let mut sizes = vec![0; self.names.len()];
        self.level.iter().for_each(|own| sizes[*own] += 1);
        sizes
    }

    /// Why the variance of a level cannot be estimated.
    pub fn refused(&self, level: usize, what: &str) -> MixedError {
        MixedError::LevelVariance {
            column: self.column.clone(),
            level: self.names[level].clone(),
            what: what.to_owned(),
        }
    }

    /// Refuses levels with one row.
    ///
    /// # Errors
    /// [`MixedError::LevelVariance`] for the first of them.
    pub fn check(&self, rows: usize) -> Result<(), MixedError> {
        check_length("levels of the residual variance", self.level.len(), rows)?;
        match self.sizes().iter().position(|own| *own < 2) {
            Some(level) => Err(self.refused(level, "has one row")),
            None => Ok(()),
        }
    }
}

/// Residual variances of the levels of a fit.
#[derive(Clone, Debug, PartialEq)]
pub struct LevelVariances {
    /// Standard deviation of each level.
    pub sds: Vec<f64>,
    /// Rows of each.
    pub rows: Vec<usize>,
    /// Log of the (restricted) likelihood with one variance for all.
    pub equal_log_likelihood: f64,
}
