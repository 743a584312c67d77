//! Extents and storage layout of datasets.

use crate::hdf5::cursor::{Cursor, Problem};

/// Most dimensions of a dataset; the limit of HDF5.
const MOST_EXTENTS: u8 = 32;

/// Extents of a dataset.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Space {
    pub extents: Vec<u64>,
    /// Maximum extents; `u64::MAX` if unlimited.
    pub most: Vec<u64>,
}

impl Space {
    /// Number of elements; `u64::MAX` on overflow.
    pub fn count(&self) -> u64 {
        if self.extents.contains(&0) {
            return 0;
        }
        self.extents.iter().fold(1, |n, e| n.saturating_mul(*e))
    }
}

/// Storage layout of a dataset.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Layout {
    /// In the object header.
    Compact(Vec<u8>),
    /// In one piece; no address if nothing was written.
    Contiguous {
        address: Option<u64>,
        size: u64,
    },
    Chunked(Chunked),
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Chunked {
    /// Extents of a chunk.
    pub chunk: Vec<u64>,
    pub index: Index,
    /// Address of the index; `None` if nothing was written.
    pub address: Option<u64>,
}

/// Type of the chunk index.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Index {
    Tree1,
    /// A single chunk; if filtered, its stored size and filter mask.
    Single(Option<(u64, u32)>),
    /// Consecutive chunks without an index.
    Implicit,
    FixedArray,
    ExtensibleArray,
    Tree2,
}

/// Reads extents.
pub(crate) fn read_space(cursor: &mut Cursor<'_>) -> Result<Space, Problem> {
    let version = cursor.version("extents", &[1, 2])?;
    let rank = cursor.u8()?;
    let flags = cursor.u8()?;
    let kind = cursor.u8()?;
    if rank > MOST_EXTENTS {
        return Err(cursor.damaged("a dataset has more than 32 dimensions"));
    }
    if version == 1 {
        cursor.skip(4)?;
    } else if kind == 2 {
        return Ok(Space {
            extents: vec![0],
            most: vec![0],
        });
    }
    let mut read = || -> Result<Vec<u64>, Problem> { (0..rank).map(|_| cursor.length()).collect() };
    let extents = read()?;
    let most = if flags & 1 != 0 {
        read()?
    } else {
        extents.clone()
    };
    let unlimited = u64::MAX >> (64 - 8 * cursor.widths().length);
    let most = most.into_iter().map(|m| match m == unlimited {
        true => u64::MAX,
        false => m,
    });
    Ok(Space {
        most: most.collect(),
        extents,
    })
}

pub(crate) fn read_layout(
    cursor: &mut Cursor<'_>,
    elements: u64,
    size: usize,
) -> Result<Layout, Problem> {
    let version = cursor.version("the layout of data", &[1, 2, 3, 4, 5])?;
    match version {
        1 | 2 => read_old(cursor, elements, size),
        _ => {
            let class = cursor.u8()?;
            match (class, version) {
                (0, _) => {
                    let size = usize::from(cursor.u16()?);
                    Ok(Layout::Compact(cursor.take(size)?.to_vec()))
                }
                (1, _) => Ok(Layout::Contiguous {
                    address: cursor.address()?,
                    size: cursor.length()?,
                }),
                (2, 3) => {
                    let rank = cursor.u8()?;
                    let address = cursor.address()?;
                    Ok(Layout::Chunked(Chunked {
                        chunk: read_chunk(cursor, rank, 4)?,
                        index: Index::Tree1,
                        address,
                    }))
                }
                (2, _) => read_chunked4(cursor),
                (3, _) => Err(Problem::Unsupported(
                    "virtual datasets, with data in other files".to_owned(),
                )),
                _ => Err(cursor.damaged("the layout of a dataset is of an unknown class")),
            }
        }
    }
}

/// Versions 1 and 2.
fn read_old(cursor: &mut Cursor<'_>, elements: u64, size: usize) -> Result<Layout, Problem> {
    let rank = cursor.u8()?;
    let class = cursor.u8()?;
    cursor.skip(5)?;
    let address = match class {
        0 => None,
        _ => cursor.address()?,
    };
    match class {
        0 => {
            cursor.skip(4 * usize::from(rank))?;
            let size = cursor.u32()? as usize;
            Ok(Layout::Compact(cursor.take(size)?.to_vec()))
        }
        // The extents of the dataset follow, in 32 bits.
        1 => Ok(Layout::Contiguous {
            address,
            size: elements.saturating_mul(size as u64),
        }),
        2 => Ok(Layout::Chunked(Chunked {
            chunk: read_chunk(cursor, rank, 4)?,
            index: Index::Tree1,
            address,
        })),
        _ => Err(cursor.damaged("the layout of a dataset is of an unknown class")),
    }
}

/// Reads the extents of a chunk, which are followed by the element size.
fn read_chunk(cursor: &mut Cursor<'_>, rank: u8, width: usize) -> Result<Vec<u64>, Problem> {
    if rank == 0 || rank > MOST_EXTENTS + 1 {
        return Err(cursor.damaged("a chunk has no dimensions, or more than 32"));
    }
    let mut chunk = Vec::new();
    for _ in 0..rank {
        chunk.push(cursor.uint(width)?);
    }
    chunk.pop();
    match chunk.contains(&0) {
        true => Err(cursor.damaged("an extent of a chunk is zero")),
        false => Ok(chunk),
    }
}

/// Versions 4 and 5.
fn read_chunked4(cursor: &mut Cursor<'_>) -> Result<Layout, Problem> {
    let flags = cursor.u8()?;
    let rank = cursor.u8()?;
    let width = usize::from(cursor.u8()?);
    let chunk = read_chunk(cursor, rank, width)?;
    let kind = cursor.u8()?;
    let index = match kind {
        1 if flags & 2 != 0 => Index::Single(Some((cursor.length()?, cursor.u32()?))),
        1 => Index::Single(None),
        2 => Index::Implicit,
        3 => {
            cursor.skip(1)?;
            Index::FixedArray
        }
        4 => {
            cursor.skip(5)?;
            Index::ExtensibleArray
        }
        5 => {
            cursor.skip(6)?;
            Index::Tree2
        }
        _ => {
            return Err(Problem::Unsupported(format!(
                "chunk indexes of type {kind}"
            )));
        }
    };
    Ok(Layout::Chunked(Chunked {
        chunk,
        index,
        address: cursor.address()?,
    }))
}

/// Reads the fill value; `old` selects the original message type.
pub(crate) fn read_fill(cursor: &mut Cursor<'_>, old: bool) -> Result<Vec<u8>, Problem> {
    let defined = match old {
        true => true,
        false => match cursor.version("the fill value", &[1, 2, 3])? {
            version @ (1 | 2) => {
                cursor.skip(2)?;
                let defined = cursor.u8()? != 0;
                version == 1 || defined
            }
            _ => cursor.u8()? & 0x20 != 0,
        },
    };
    if !defined {
        return Ok(Vec::new());
    }
    let size = cursor.u32()? as usize;
    Ok(cursor.take(size)?.to_vec())
}
