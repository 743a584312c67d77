//! The tests of this crate as one program, which is built and linked once.

#![allow(clippy::unwrap_used)]

mod allocation;
mod batch;
mod bench;
mod intervals;
mod known;
mod laws;
mod memory_law;
mod population;
mod population_impacts;
mod population_posterior;
mod recovers;
mod reference_fit;
mod rubber;
mod simulate;
mod user_law;
