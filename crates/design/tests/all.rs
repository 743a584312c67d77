//! The tests of this crate as one program, which is built and linked once.

#![allow(clippy::unwrap_used)]

mod design_box_behnken;
mod design_composite;
mod design_factorial;
mod design_optimal;
mod design_split_plot;
