//! sigrok logic-analyser captures.

pub mod read;
pub mod zip_entries;
