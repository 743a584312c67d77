//! The tests of this crate as one program, which is built and linked once.

#![allow(clippy::unwrap_used)]

mod expression;
mod law_derivatives;
mod law_values;
mod memory_law;
mod user_law;
