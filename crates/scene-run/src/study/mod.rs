//! `windfall scene study`: variants of a scene side by side.

pub mod change;
pub mod figure;
pub mod file;
pub mod interval;
pub mod laws;
pub mod outcome;
pub mod read;
pub mod run;
pub mod text;
