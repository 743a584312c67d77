//! What is to be simulated: texts with units, read as SI.

pub mod drop;
pub mod eccentric;
pub mod event;
pub mod instrument;
pub mod recordings;
