//! Displacement from the phases of an incremental encoder.

pub mod edge_rate;
pub mod phase_bits;
pub mod quadrature;
