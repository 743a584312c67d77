//! The tests of this crate as one program, which is built and linked once.

#![allow(clippy::unwrap_used)]

mod periodic;
