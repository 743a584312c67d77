//! Quantities with units, as text.

mod dimension;
mod error;
pub mod nearest_name;
pub mod quantity;
pub mod range;
pub mod symbol;
mod syntax;
pub mod uncertain;
