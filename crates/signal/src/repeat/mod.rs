//! Repeated impacts on one spot: alignment, change, and when it begins.

pub mod align;
pub mod criterion;
pub mod equivalence;
pub mod interval;
pub mod permutation;
pub mod threshold;
mod threshold_family;
pub mod turnbull;
