//! Rigs forward and backward: simulate an impact under a force law, and
//! estimate the law's parameters from a measured impact.
//!
//! This crate opens no file and reads no clock.

pub mod bench;
pub mod compare;
pub mod error;
pub mod finding;
pub mod fit;
mod noise;
pub mod population;
pub mod rig;
pub mod sampler;
pub mod samples;
