//! Captures of logic analysers by sigrok.

pub mod read;
pub mod zip_entries;
