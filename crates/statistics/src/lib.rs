#![cfg_attr(not(test), warn(clippy::disallowed_methods, clippy::disallowed_types))]
//! Designs of experiments, linear models, response surfaces and mixed models.
//!
//! A [`table::Table`] holds what was measured, columns of numbers or of
//! categories. This crate opens no file and knows no fruit.

pub mod error;
mod mixed_basis;
mod mixed_blocks;
mod mixed_boundary;
pub mod mixed_constraint;
pub mod mixed_effects;
mod mixed_envelope;
pub mod mixed_error;
mod mixed_evaluate;
pub mod mixed_finding;
pub mod mixed_fit;
pub mod mixed_inference;
pub mod mixed_kenward_roger;
mod mixed_minimise;
pub mod mixed_model;
pub mod mixed_predict;
pub mod mixed_profile;
mod mixed_slope;
pub mod mixed_summary;
pub mod mixed_term;
mod mixed_theta;
pub mod table;
