//! Coefficient of restitution from the times of bounces.

pub mod check;
pub mod estimate;
pub mod finding;
pub mod motion;
