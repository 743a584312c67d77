//! Trees of named arrays (HDF5, MAT) read as channels.

pub(crate) mod channels;
mod clock;
pub(crate) mod pass;
pub(crate) mod tree;
