//! A chunk in the file, as an index tells it.

use crate::hdf5::cursor::{Cursor, Problem};

/// A chunk in the file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Chunk {
    pub address: u64,
    /// Its bytes there; `None`: as many as it has without filters.
    pub size: Option<u64>,
    /// A bit for each filter that was not applied.
    pub skipped: u32,
}

/// An entry of an array: a chunk, or none at an undefined address.
pub(crate) fn read_entry(
    cursor: &mut Cursor<'_>,
    size: usize,
    filtered: bool,
) -> Result<Option<Chunk>, Problem> {
    let address = cursor.address()?;
    let (mut bytes, mut skipped) = (None, 0);
    if filtered {
        let width = size.checked_sub(cursor.widths().address + 4);
        let width = width.ok_or_else(|| cursor.damaged("an entry of a chunk is too short"))?;
        bytes = Some(cursor.uint(width)?);
        skipped = cursor.u32()?;
    }
    Ok(address.map(|address| Chunk {
        address,
        size: bytes,
        skipped,
    }))
}
