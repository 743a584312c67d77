//! Trees of named arrays, as HDF5 and MAT hold them, read as channels.

pub(crate) mod channels;
mod clock;
pub(crate) mod pass;
pub(crate) mod tree;
