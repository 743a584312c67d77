//! Sensors of a scene: planes that count fruit, boxes that hold them, probes that feel impacts.

pub(crate) mod figure;
mod flow;
pub mod outcome;
mod probe;
mod space;
mod tables;
pub(crate) mod text;
mod trace;
pub(crate) mod watch;
