//! Several tables of text in one file, as segments of one recording.

pub mod bundle;
mod split;
pub mod stacked;
