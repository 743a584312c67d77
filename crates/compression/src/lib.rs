//! Slow compressions: laws fitted to their loading ([`fit`]), and the relaxation of a force
//! that is held ([`relaxation`]).
//!
//! This crate opens no file and reads no clock.

pub mod fit;
mod problem;
pub mod relaxation;
