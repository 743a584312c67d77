//! Options of simulations: texts with units, read as SI.

pub mod drop;
pub mod eccentric;
pub mod event;
pub mod impact;
pub mod instrument;
pub mod recordings;
