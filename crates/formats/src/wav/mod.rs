//! WAV and RF64.

pub mod read;
