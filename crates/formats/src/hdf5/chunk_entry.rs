//! Location of a chunk, as stored in an index.

use crate::hdf5::cursor::{Cursor, Problem};

/// Location of a chunk.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Chunk {
    pub address: u64,
    /// Stored size in bytes; `None` if unfiltered.
    pub size: Option<u64>,
    /// Mask of filters that were not applied.
    pub skipped: u32,
}

/// Reads an index entry; `None` if its address is undefined.
pub(crate) fn read_entry(
    cursor: &mut Cursor<'_>,
    size: usize,
    filtered: bool,
) -> Result<Option<Chunk>, Problem> {
    let address = cursor.address()?;
    let (mut bytes, mut skipped) = (None, 0);
    if filtered {
        let width = size.checked_sub(cursor.widths().address + 4);
        let width = width.ok_or_else(|| cursor.damaged("a chunk index entry is too short"))?;
        bytes = Some(cursor.uint(width)?);
        skipped = cursor.u32()?;
    }
    Ok(address.map(|address| Chunk {
        address,
        size: bytes,
        skipped,
    }))
}
