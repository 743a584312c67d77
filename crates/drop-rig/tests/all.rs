//! The tests of this crate as one program, which is built and linked once.

#![allow(clippy::unwrap_used)]

mod drop;
mod drop_features;
mod drop_waveform;
mod eccentric;
mod eccentric_study;
