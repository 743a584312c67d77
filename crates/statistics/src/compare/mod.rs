//! Comparison of groups.

pub mod compact_letters;
pub mod equal_variance;
pub mod goodness_index;
pub mod group_summary;
pub mod means;
pub mod multiple_comparison;
pub mod one_way_anova;
pub mod tukey;
