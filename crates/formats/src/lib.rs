//! Reads instrument files: channels of numbers as the instrument wrote them.
//!
//! [`open::open`] detects the format of a file and returns a [`reader::Reader`].
//! Its [`contents::Contents`] lists the channels with unit, length and time base
//! without reading their samples; [`reader::Reader::read`] passes on the samples in
//! blocks, so that files of any size can be read in bounded memory.
//!
//! There is one folder per format. Values are scaled as the file itself
//! prescribes; what they mean on a rig, and in which unit, is set in a campaign and
//! unknown here. Sizes and offsets declared in a file are checked against its
//! length before anything is allocated.

mod arrays;
pub mod contents;
mod foreign;
mod hdf5;
mod mat;
mod names;
mod npy;
mod number;
pub mod open;
pub mod reader;
mod sheet;
mod sigrok;
mod tables;
mod tdms;
pub mod text;
mod uff;
mod wav;
mod zip;

pub use windfall_source::Error;
