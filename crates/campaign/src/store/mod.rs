//! results.sqlite: every result with its provenance.

pub mod documents;
pub mod error;
pub mod file;
pub mod runs;
