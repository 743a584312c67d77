//! The tests of this crate as one program, which is built and linked once.

#![allow(clippy::unwrap_used)]

mod acoustic;
mod bad_input;
mod bounce_train;
mod calibrate;
mod campaign_files;
mod compression;
mod conditioning;
mod drop;
mod foam_pads;
mod formats;
mod library;
mod population;
mod repeats;
