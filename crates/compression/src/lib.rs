//! Slow compressions: laws fitted to their loading ([`fit`]), and the relaxation of a force
//! that is held ([`relaxation`]).
//!
//! This crate opens no file and reads no clock.

mod correlated_scores;
pub mod fit;
mod problem;
pub mod relaxation;
