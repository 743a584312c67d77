#![cfg_attr(not(test), warn(clippy::disallowed_methods, clippy::disallowed_types))]
//! Recording → Impact: decoding, contact windows, displacement rate, energies.
//!
//! This crate opens no file and knows no force law.

pub mod impact;
pub mod recording;
