//! A run of a scene: checkpoints, frames, tables, results.

pub mod advance;
pub mod checkpoint;
pub mod columns;
mod fallen;
pub mod frame_format;
pub(crate) mod frames;
pub mod growing;
pub(crate) mod histogram;
pub(crate) mod levels;
pub mod outcome;
pub mod sensors;
pub(crate) mod start;
mod static_load;
pub mod stopped;
pub mod tables;
pub mod workflow;
