//! `windfall design`: designs of experiments.

pub mod coding;
pub mod document;
pub mod factor;
pub mod file;
pub mod model_row;
pub mod optimal_runs;
pub mod request;
pub mod run;
pub mod text;
