//! The tests of this crate as one program, which is built and linked once.

#![allow(clippy::unwrap_used)]

mod annuli;
mod benchmark_impacts;
mod clumps;
mod common;
mod convergence;
mod entering;
mod follow;
mod friction;
mod loads;
mod many_fruit;
mod mesh;
mod oblique_impacts;
mod periodic;
mod resume;
mod share;
mod single_impacts;
