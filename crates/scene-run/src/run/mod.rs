//! A run of a scene: checkpoints, frames, tables, results.

pub mod advance;
pub mod checkpoint;
pub mod frame_format;
pub mod frames;
pub mod histogram;
pub mod levels;
pub mod outcome;
pub mod static_load;
pub mod tables;
pub mod workflow;
