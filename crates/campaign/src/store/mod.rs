//! results.sqlite: every result with its provenance.

pub mod documents;
pub mod file;
pub mod runs;
