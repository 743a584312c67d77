//! `windfall surface`: response surfaces and their optima.

pub mod blocks;
pub mod factors;
pub mod figure_contour;
pub mod figure_effects;
pub mod figure_heights;
pub mod figure_lines;
pub mod figure_pairs;
pub mod figure_view;
pub mod fitted;
pub mod goal;
mod model_outcome;
pub mod outcome;
pub mod random;
pub mod request;
pub mod run;
mod settings;
pub mod text;
