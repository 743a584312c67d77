//! The bytes of a file or pipe, and what is wrong with them.
//!
//! [`source::Source`] reads any part of a file without loading the rest. Sizes that a file
//! declares are checked against its length before memory is allocated, and every
//! [`error::Error`] names the file and the place in it.

pub mod error;
pub mod room;
pub mod source;
pub mod stream;

pub use error::Error;
