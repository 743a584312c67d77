//! Numerical routines of windfall: an explicit Runge-Kutta integrator with
//! dense output whose state carries first-order sensitivities, bounded
//! least squares with covariance, and physical units at the boundary.
//!
//! This crate knows no contact law, no instrument and no file.

pub mod as_written;
mod box_quadratic;
pub mod cholesky;
pub mod double_double;
pub mod fast;
pub mod least_squares;
pub mod logarithmic;
pub mod monotone_cubic;
pub mod normal_equations;
pub mod numbers;
pub mod ode;
pub mod prefetch;
pub mod quadrature;
pub mod real;
pub mod real_vector;
pub mod root;
pub mod runs;
pub mod unit;
pub mod written;
