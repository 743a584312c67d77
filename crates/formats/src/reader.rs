//! An open file: its contents, and its samples in blocks.

use crate::contents::Contents;
use windfall_source::error::Error;

/// A sample that the instrument could not give, where a file says so: a NaN of its own,
/// told from blank cells by its bits ([`is_missing`]), as R tells NA.
pub const MISSING: f64 = f64::from_bits(0x7ff8_0000_0000_07a2);

/// Whether a sample is [`MISSING`].
pub fn is_missing(sample: f64) -> bool {
    sample.to_bits() == MISSING.to_bits()
}

/// Receives samples as they are read.
pub trait Sink {
    /// The next samples of the channel `wanted[position]`: NaN where a cell is blank,
    /// [`MISSING`] where it says that there is no sample. An error stops the reading.
    fn take(&mut self, position: usize, samples: &[f64]) -> Result<(), Error>;

    /// A sample that cannot be read. By default an error, which stops the reading; `Ok` makes
    /// the sample NaN.
    fn fault(&mut self, fault: Error) -> Result<(), Error> {
        Err(fault)
    }
}

/// An open file.
pub trait Reader: Send {
    /// Its contents.
    fn contents(&self) -> &Contents;

    /// Reads channels in blocks of bounded size. Each channel arrives in order;
    /// blocks of different channels may interleave.
    ///
    /// * `wanted`: indices of channels in [`Contents`], without repetition
    ///
    /// # Errors
    /// The file cannot be read, is malformed, or `sink` returned an error.
    fn read(&mut self, wanted: &[usize], sink: &mut dyn Sink) -> Result<(), Error>;

    /// Reads all samples of some channels; errors as in [`Reader::read`].
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
