//! Comparison of groups.

pub mod equal_variance;
pub mod group_summary;
pub mod means;
pub mod multiple_comparison;
pub mod one_way_anova;
pub mod tukey;
