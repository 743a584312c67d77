//! Filters and smoothing.

pub mod butterworth;
pub mod smoothing_spline;
pub mod zero_phase;
