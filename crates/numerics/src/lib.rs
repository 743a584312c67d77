//! Numerical routines of windfall: an explicit Runge-Kutta integrator with
//! dense output whose state carries first-order sensitivities, bounded
//! least squares with covariance, and physical units at the boundary.
//!
//! This crate knows no contact law, no instrument and no file.

pub mod ode_step;
pub mod ode_tableau;
pub mod real;
pub mod root;
pub mod unit;
