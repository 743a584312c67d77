//! Response surfaces, their optima and desirability.

pub mod analysis;
pub mod coding;
pub mod desirability;
pub mod terms;
