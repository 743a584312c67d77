//! Scenes of many fruit: their files, runs, frames, bruises and studies.

pub mod bruise;
pub mod file;
pub mod file_error;
pub mod frames;
mod geometry;
pub mod run;
mod run_error;
pub mod schema;
pub mod study;

pub use run_error::{SceneRunError, stopped_scene};
