//! An opened file: what it holds, and its samples in blocks.

use crate::contents::Contents;
use crate::error::Error;

/// Takes samples as they are read.
pub trait Sink {
    /// The next samples of the channel `wanted[position]`, in the order of the
    /// file. NaN stands where the channel has no sample (a blank cell).
    ///
    /// # Errors
    /// Reading stops with the error returned.
    fn take(&mut self, position: usize, samples: &[f64]) -> Result<(), Error>;

    /// A sample that cannot be read; its place is kept by a NaN if reading goes on.
    ///
    /// # Errors
    /// Reading stops with the error returned: here with the fault itself.
    fn fault(&mut self, fault: Error) -> Result<(), Error> {
        Err(fault)
    }
}

/// An opened file.
pub trait Reader: Send {
    /// What it holds.
    fn contents(&self) -> &Contents;

    /// Reads channels in blocks of bounded size, each channel in order; blocks
    /// of different channels may alternate in any way.
    ///
    /// * `wanted`: positions in the channels of [`Contents`], each once
    ///
    /// # Errors
    /// The file cannot be read or breaks the rules of its format, or `sink`
    /// returned an error.
    fn read(&mut self, wanted: &[usize], sink: &mut dyn Sink) -> Result<(), Error>;

    /// All samples of some channels.
    ///
    /// # Errors
    /// As [`Reader::read`].
    fn read_whole(&mut self, wanted: &[usize]) -> Result<Vec<Vec<f64>>, Error> {
        let mut collected = Collected(vec![Vec::new(); wanted.len()]);
        self.read(wanted, &mut collected)?;
        Ok(collected.0)
    }
}

struct Collected(Vec<Vec<f64>>);

impl Sink for Collected {
    fn take(&mut self, position: usize, samples: &[f64]) -> Result<(), Error> {
        self.0[position].extend_from_slice(samples);
        Ok(())
    }
}
