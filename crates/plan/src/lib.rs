//! `windfall plan`: how many fruit, and how many impacts on each.
//!
//! A `Question` says what a study of a size would tell; `run` looks for the smallest study that
//! tells enough. Questions with an exact formula are in [`closed`],
//! those that are simulated in [`model`] and [`critical`]; [`achieved`] looks back on a finished
//! campaign.

pub mod achieved;
mod asked;
pub mod closed;
pub mod critical;
mod figure;
pub mod model;
pub mod options;
pub mod outcome;
mod parse;
pub mod population;
pub mod power;
mod question;
mod replicates;
mod run;
pub mod scatter;
mod search;
mod simulated;
mod sizes;
mod study;
pub mod surface;

pub mod text;
