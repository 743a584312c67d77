//! Reads a dataset in blocks, in storage order.

use crate::hdf5::cursor::Problem;
use crate::hdf5::dataset::Dataset;
use crate::hdf5::file::Hdf5File;
use windfall_source::error::Error;

/// Elements per block.
const BLOCK: u64 = 1 << 16;

/// Largest block, where chunks are large; bytes.
const LARGEST_BLOCK: u64 = 16 << 20;

/// Receives the index of the first element of a block, and its bytes.
pub(crate) type Take<'a> = dyn FnMut(u64, &[u8]) -> Result<(), Error> + 'a;

/// Calls `take` with blocks that cover the elements `from..to`.
pub(crate) fn each_block(
    file: &Hdf5File,
    dataset: &mut Dataset,
    (from, to): (u64, u64),
    take: &mut Take<'_>,
) -> Result<(), Problem> {
    let to = to.min(dataset.space.count());
    if from >= to {
        return Ok(());
    }
    if dataset.space.extents.is_empty() {
        let bytes = dataset.bytes(file, &[], &[])?;
        return Ok(take(0, &bytes)?);
    }
    let mut plan = Plan {
        file,
        dataset,
        from,
        to,
        take,
    };
    plan.read(&mut Vec::new(), 0)
}

struct Plan<'a, 'b> {
    file: &'a Hdf5File,
    dataset: &'a mut Dataset,
    from: u64,
    to: u64,
    take: &'a mut Take<'b>,
}

impl Plan<'_, '_> {
    /// Reads the elements below the indices `above`, starting with `first`.
    fn read(&mut self, above: &mut Vec<u64>, first: u64) -> Result<(), Problem> {
        let depth = above.len();
        let extents = self.dataset.space.extents.clone();
        let below: u64 = extents[depth + 1..].iter().product();
        // The rows that contain requested elements.
        let begin = self.from.saturating_sub(first) / below;
        let end = extents[depth].min(self.to.saturating_sub(first).div_ceil(below));
        let rows = self.rows(depth, below);
        let mut row = begin;
        while row < end {
            if below > self.largest() {
                above.push(row);
                self.read(above, first + row * below)?;
                above.pop();
                row += 1;
                continue;
            }
            // Align blocks with chunks, so that each is unpacked once.
            let next = ((row / rows + 1) * rows).min(end);
            let mut low = above.clone();
            let mut high: Vec<u64> = above.iter().map(|i| i + 1).collect();
            low.push(row);
            high.push(next);
            low.resize(extents.len(), 0);
            high.extend(&extents[depth + 1..]);
            let bytes = self.dataset.bytes(self.file, &low, &high)?;
            (self.take)(first + row * below, &bytes)?;
            row = next;
        }
        Ok(())
    }

    /// Elements in the largest block.
    fn largest(&self) -> u64 {
        (LARGEST_BLOCK / self.dataset.datatype.size as u64).max(1)
    }

    /// Rows per block.
    fn rows(&self, depth: usize, below: u64) -> u64 {
        let most = BLOCK.min(self.largest());
        let few = (most / below).max(1);
        let chunk = self.dataset.chunk().get(depth).copied().unwrap_or(1);
        let whole = few.checked_next_multiple_of(chunk).unwrap_or(few);
        match whole.checked_mul(below) {
            Some(elements) if elements <= self.largest() => whole,
            _ => few,
        }
    }
}
