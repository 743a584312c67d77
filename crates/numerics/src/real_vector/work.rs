//! What is done with numbers in vector registers, and what it asks of them.

use crate::real::{Lanes, Real};

/// Numbers side by side, the same on every processor.
pub const LANES: usize = 4;

/// Work on [`LANES`] numbers at a time.
pub trait FourLanes {
    /// What comes out.
    type Output;

    /// Does it with numbers like `zero`.
    ///
    /// To be `#[inline(always)]`, and all that it calls in its loops too: what is
    /// compiled by itself is not compiled for the vector instructions.
    fn run<R: FourNumbers>(self, zero: R) -> Self::Output;
}

/// Work on twice [`LANES`] numbers at a time.
pub trait EightLanes {
    /// What comes out.
    type Output;

    /// As [`FourLanes::run`].
    fn run<R: Real<Plain = Lanes<{ 2 * LANES }>>>(self, zero: R) -> Self::Output;
}

/// Numbers of [`LANES`] lanes, which go over into rows and back.
pub trait FourNumbers: Real<Plain = Lanes<LANES>> {
    /// The columns of four rows: number n holds the n-th of each row.
    fn columns(self, rows: [Lanes<LANES>; LANES]) -> [Self; LANES];
    /// The rows of four columns.
    fn rows(columns: [Self; LANES]) -> [Lanes<LANES>; LANES];
}

impl FourNumbers for Lanes<LANES> {
    #[inline(always)]
    fn columns(self, rows: [Self; LANES]) -> [Self; LANES] {
        let mut columns = [self; LANES];
        for (n, column) in columns.iter_mut().enumerate() {
            for (lane, row) in rows.iter().enumerate() {
                column.0[lane] = row.0[n];
            }
        }
        columns
    }
    #[inline(always)]
    fn rows(columns: [Self; LANES]) -> [Self; LANES] {
        columns[0].columns(columns)
    }
}
