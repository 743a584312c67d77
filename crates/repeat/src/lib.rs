//! Repeated impacts on one spot: alignment, change, and when it begins.
//!
//! Impacts are aligned ([`align`]), compared over fruit ([`permutation`],
//! [`equivalence`]) or fruit by fruit ([`criterion`]), and give the critical impact
//! energy ([`threshold`], [`turnbull`]).
//!
//! This crate opens no file and knows no force law.

pub mod align;
pub mod criterion;
pub mod equivalence;
pub mod interval;
pub mod permutation;
pub mod threshold;
mod threshold_family;
pub mod turnbull;
