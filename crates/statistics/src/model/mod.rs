//! Formulas, model frames, linear models and their analysis of variance.

pub mod anova;
pub mod contrast;
pub mod encoding;
pub mod expression;
pub mod formula;
pub mod formula_syntax;
pub mod linear_model;
pub mod lost_digits;
pub mod marginal_means;
pub mod mean_contrasts;
pub mod model_frame;
pub mod model_matrix;
pub mod model_rows;
pub mod original_scale;
pub mod prediction;
pub mod random_terms;
pub mod reduced;
pub mod selection;
pub mod straight_line;
pub mod term_order;
pub mod variance_groups;
