//! `windfall scene study`: variants of a scene side by side.

pub(crate) mod figure;
pub(crate) mod file;
pub(crate) mod interval;
pub(crate) mod laws;
pub mod outcome;
pub(crate) mod read;
pub mod run;
pub mod text;
