//! Tables, linear models, response surfaces and comparisons of groups.
//!
//! A [`table::Table`] holds what was measured, columns of numbers or of
//! categories. This crate opens no file and knows no fruit.

pub mod accurate_sum;
pub mod compare;
pub mod error;
pub mod model;
mod orthonormal;
pub mod residuals;
pub mod sample;
pub mod sample_error;
pub mod surface;
pub mod table;

// What columns and rows of tables are made of.
pub use windfall_numerics::{numbers, runs};
