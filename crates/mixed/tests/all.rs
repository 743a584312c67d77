//! The tests of this crate as one program, which is built and linked once.

#![allow(clippy::unwrap_used)]

mod cases;
mod closed_form;
mod levels;
mod odd_input;
mod recovers;
mod reference;
