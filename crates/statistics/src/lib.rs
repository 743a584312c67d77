#![cfg_attr(not(test), warn(clippy::disallowed_methods, clippy::disallowed_types))]
//! Designs of experiments, linear models, response surfaces and mixed models.
//!
//! A [`table::Table`] holds what was measured, columns of numbers or of
//! categories. This crate opens no file and knows no fruit.

pub mod accurate_sum;
pub mod box_cox;
pub mod compact_letters;
pub mod compare_means;
pub mod distribution_tail;
pub mod double_double;
pub mod equal_variance;
pub mod error;
pub mod goodness_index;
pub mod group_summary;
pub mod heteroscedasticity;
mod incomplete_beta;
mod incomplete_gamma;
mod log_gamma_rest;
pub mod multiple_comparison;
pub mod normality;
pub mod one_way_anova;
mod orthonormal;
pub mod quantile;
pub mod residual_order;
pub mod sample;
pub mod studentized_range;
pub mod table;
pub mod tukey;
