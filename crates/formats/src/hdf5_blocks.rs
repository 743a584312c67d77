//! The elements of a dataset in the order of storage, in blocks.

use hdf5_reader::error::Error as Fault;
use hdf5_reader::{Dataset, H5Type, SliceInfo, SliceInfoElem};

/// Elements that are read at once.
const BLOCK: u64 = 1 << 16;

/// Elements that are read at once where chunks are larger than a block.
const LARGEST_BLOCK: u64 = 1 << 21;

/// What stops the reading.
#[derive(Debug)]
pub(crate) enum Stop<E> {
    /// The dataset cannot be decoded.
    Fault(Fault),
    /// What was called with a block says so.
    Asked(E),
}

/// Calls `take` with blocks of a dataset that hold its elements from number
/// `from` to before `to`, and the number of the first in each.
///
/// # Errors
/// The dataset cannot be decoded, or `take` failed.
pub(crate) fn each_block<T: H5Type, E>(
    dataset: &Dataset,
    (from, to): (u64, u64),
    take: &mut dyn FnMut(u64, Vec<T>) -> Result<(), E>,
) -> Result<(), Stop<E>> {
    let shape = dataset.shape().to_vec();
    if from >= to || shape.contains(&0) {
        return Ok(());
    }
    if shape.is_empty() {
        let elements = dataset.read_array::<T>().map_err(Stop::Fault)?;
        return take(0, elements.into_iter().collect()).map_err(Stop::Asked);
    }
    let chunks = dataset.chunks().unwrap_or_default();
    let mut plan = Plan {
        dataset,
        shape,
        chunks,
        from,
        to,
        take,
    };
    plan.read(&mut Vec::new(), 0)
}

struct Plan<'a, T, E> {
    dataset: &'a Dataset,
    shape: Vec<u64>,
    chunks: Vec<u32>,
    from: u64,
    to: u64,
    take: &'a mut dyn FnMut(u64, Vec<T>) -> Result<(), E>,
}

impl<T: H5Type, E> Plan<'_, T, E> {
    /// Reads what lies below the indices `above`; its first element is `first`.
    fn read(&mut self, above: &mut Vec<u64>, first: u64) -> Result<(), Stop<E>> {
        let depth = above.len();
        let length = self.shape[depth];
        let below: u64 = self.shape[depth + 1..].iter().product();
        // Those rows that hold what is wanted.
        let begin = self.from.saturating_sub(first) / below;
        let end = length.min(self.to.saturating_sub(first).div_ceil(below));
        let rows = self.rows(depth, below);
        let mut row = begin;
        while row < end {
            if below > LARGEST_BLOCK {
                above.push(row);
                self.read(above, first + row * below)?;
                above.pop();
                row += 1;
                continue;
            }
            // Blocks begin where chunks do, so that each is unpacked once.
            let next = (row / rows + 1) * rows;
            let next = next.min(end);
            let elements = self.slice(above, row, next).map_err(Stop::Fault)?;
            (self.take)(first + row * below, elements).map_err(Stop::Asked)?;
            row = next;
        }
        Ok(())
    }

    /// Rows that are read at once.
    fn rows(&self, depth: usize, below: u64) -> u64 {
        let few = (BLOCK / below).max(1);
        let chunk = self.chunks.get(depth).map_or(1, |c| u64::from(*c).max(1));
        let whole = few.next_multiple_of(chunk);
        match whole.checked_mul(below) {
            Some(elements) if elements <= LARGEST_BLOCK => whole,
            _ => few,
        }
    }

    fn slice(&self, above: &[u64], start: u64, end: u64) -> Result<Vec<T>, Fault> {
        let mut selections: Vec<SliceInfoElem> =
            above.iter().map(|i| SliceInfoElem::Index(*i)).collect();
        selections.push(SliceInfoElem::Slice {
            start,
            end,
            step: 1,
        });
        for &length in &self.shape[above.len() + 1..] {
            selections.push(SliceInfoElem::Slice {
                start: 0,
                end: length,
                step: 1,
            });
        }
        let array = self.dataset.read_slice::<T>(&SliceInfo { selections })?;
        Ok(array.into_iter().collect())
    }
}
