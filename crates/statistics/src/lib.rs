#![cfg_attr(not(test), warn(clippy::disallowed_methods, clippy::disallowed_types))]
//! Designs of experiments, linear models, response surfaces and mixed models.
//!
//! A [`table::Table`] holds what was measured, columns of numbers or of
//! categories. This crate opens no file and knows no fruit.

pub mod accurate_sum;
pub mod compare_means;
pub mod distribution_tail;
pub mod double_double;
pub mod equal_variance;
pub mod error;
mod incomplete_beta;
mod incomplete_gamma;
mod log_gamma_rest;
pub mod one_way_anova;
pub mod quantile;
pub mod sample;
pub mod table;
