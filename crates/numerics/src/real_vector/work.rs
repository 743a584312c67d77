//! What is done with numbers in vector registers, and what it asks of them.

use crate::real::{Lanes, Real};

/// Numbers side by side, the same on every processor.
pub const LANES: usize = 4;

/// Twice as many.
pub const EIGHT: usize = 2 * LANES;

/// Four numbers that stand together in memory.
pub type Row = Lanes<LANES>;

/// Work on [`LANES`] numbers at a time.
pub trait FourLanes {
    /// What comes out.
    type Output;

    /// Does it with numbers like `zero`.
    ///
    /// To be `#[inline(always)]`, and all that it calls in its loops too: what is
    /// compiled by itself is not compiled for the vector instructions.
    fn run<R: Real<Plain = Lanes<LANES>>>(self, zero: R) -> Self::Output;
}

/// Work on [`EIGHT`] numbers at a time.
pub trait EightLanes {
    /// What comes out.
    type Output;

    /// As [`FourLanes::run`].
    fn run<R: EightNumbers>(self, zero: R) -> Self::Output;
}

/// Numbers of [`EIGHT`] lanes, which go over into rows and back.
pub trait EightNumbers: Real<Plain = Lanes<EIGHT>> {
    /// The columns of eight rows: number n holds the n-th of each row.
    fn columns(self, rows: [Row; EIGHT]) -> [Self; LANES];
    /// The rows of eight columns.
    fn rows(first: [Self; LANES], second: [Self; LANES]) -> [Self; EIGHT];
}

impl EightNumbers for Lanes<EIGHT> {
    #[inline(always)]
    fn columns(self, rows: [Row; EIGHT]) -> [Self; LANES] {
        let mut columns = [self; LANES];
        for (lane, row) in rows.iter().enumerate() {
            for n in 0..LANES {
                columns[n].0[lane] = row.0[n];
            }
        }
        columns
    }
    #[inline(always)]
    fn rows(first: [Self; LANES], second: [Self; LANES]) -> [Self; EIGHT] {
        let mut rows = [Self::ZERO; EIGHT];
        for (lane, row) in rows.iter_mut().enumerate() {
            for n in 0..LANES {
                row.0[n] = first[n].0[lane];
                row.0[LANES + n] = second[n].0[lane];
            }
        }
        rows
    }
}
