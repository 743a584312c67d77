//! `windfall compare` and `windfall summary`: groups of a table.

pub mod agreement;
pub mod group_outcome;
pub mod outcome;
pub mod pairs;
pub mod run;
pub mod summary;
pub mod text;
