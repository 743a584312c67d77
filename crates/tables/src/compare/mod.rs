//! `windfall compare` and `windfall summary`: groups of a table.

pub mod agreement;
pub mod agreement_figure;
mod compact_letters;
mod figures;
pub mod group_outcome;
pub mod outcome;
pub mod pairs;
pub mod run;
mod specimens;
pub mod summary;
pub mod text;
