//! Files of instruments → channels of numbers, as the instrument wrote them.
//!
//! [`open::open`] finds out the format of a file and returns a
//! [`reader::Reader`]; its [`contents::Contents`] names the channels with unit,
//! length and time base without reading their samples, and
//! [`reader::Reader::read`] hands over the samples in blocks, so that a file of
//! any size is looked through in bounded memory.
//!
//! One folder for each format. Values are those of the file after the
//! scaling that the file itself prescribes; what they mean on a rig, in which
//! unit, is said in a campaign and is not known here. Sizes and offsets that a
//! file declares are checked against its length before anything is allocated.

mod arrays;
pub mod contents;
pub mod error;
mod hdf5;
mod mat;
mod names;
mod number;
pub mod open;
pub mod reader;
mod room;
mod sigrok;
pub mod source;
mod tdms;
pub mod text;
mod uff;
mod wav;

pub use error::Error;
