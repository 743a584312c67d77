//! Response surfaces, their optima and desirability.

pub mod analysis;
pub mod canonical;
pub mod coding;
pub mod desirability;
pub mod random_groups;
pub mod terms;
