//! Universal files (UFF), data set 58.

pub mod header;
pub mod lines;
pub mod read;
