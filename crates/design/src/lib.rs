//! Designs of experiments.

pub mod blocks;
pub mod box_behnken;
pub mod catalogue;
pub mod composite;
pub mod error;
pub mod exchange;
pub mod factorial;
pub mod finding;
pub mod kind;
pub mod latin;
pub mod model;
pub mod optimal;
pub mod plackett_burman;
pub mod quality;
pub mod random;
pub mod sobol;
mod sobol_table;
pub mod split_plot;
pub mod word;
