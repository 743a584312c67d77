//! LIGGGHTS.

pub(crate) mod deck;
mod model;
pub(crate) mod walls;
