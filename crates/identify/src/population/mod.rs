//! Fruit as a population: law parameters as random effects.

mod design;
pub mod finding;
pub mod fit;
mod level;
pub mod likelihood;
mod linear;
pub mod model;
mod newton;
mod optimum;
pub mod posterior;
mod profile;
mod report;
mod state;
pub mod two_stage;
mod variance;
