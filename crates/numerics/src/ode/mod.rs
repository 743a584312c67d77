//! Explicit Runge-Kutta pair of order 8 with dense output.

pub mod dense;
pub mod lockstep;
pub mod step;
pub mod tableau;
