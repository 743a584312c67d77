#![cfg_attr(not(test), warn(clippy::disallowed_methods, clippy::disallowed_types))]
//! Designs of experiments, linear models, response surfaces and mixed models.
//!
//! A [`table::Table`] holds what was measured, columns of numbers or of
//! categories. This crate opens no file and knows no fruit.

pub mod anova;
pub mod contrast;
pub mod cross_validation;
pub mod design;
pub mod design_blocks;
pub mod design_box_behnken;
pub mod design_catalogue;
pub mod design_composite;
pub mod design_error;
pub mod design_exchange;
pub mod design_factorial;
pub mod design_finding;
pub mod design_latin;
pub mod design_model;
pub mod design_optimal;
pub mod design_plackett_burman;
pub mod design_quality;
pub mod design_random;
pub mod design_sobol;
mod design_sobol_table;
pub mod design_word;
pub mod desirability;
pub mod diagnostics;
pub mod error;
pub mod expression;
pub mod formula;
pub mod formula_syntax;
pub mod linear_model;
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
pub mod model_frame;
pub mod reduced;
pub mod selection;
pub mod surface;
pub mod surface_coding;
pub mod surface_terms;
pub mod table;
pub mod term_order;
