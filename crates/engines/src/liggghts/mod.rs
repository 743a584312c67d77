//! LIGGGHTS.

pub mod deck;
mod model;
pub mod walls;
