//! Residual variances that differ by the level of a category.

pub mod outcome;
pub(crate) mod run;
pub(crate) mod text;
