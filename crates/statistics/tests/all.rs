//! The tests of this crate as one program, which is built and linked once.

#![allow(clippy::unwrap_used)]

mod compare_groups;
mod drop_study;
mod nist_anova;
mod nist_linear;
mod residuals;
mod studentized_range;
mod surface_analysis;
