//! Locates the chunks of a dataset.

use crate::hdf5::btree1::{Keys, read_leaves};
use crate::hdf5::btree2::read_records;
use crate::hdf5::chunk_entry::{Chunk, read_entry};
use crate::hdf5::cursor::Problem;
use crate::hdf5::extensible::read_extensible;
use crate::hdf5::file::Hdf5File;
use crate::hdf5::layout::{Chunked, Index, Space};
use std::collections::BTreeMap;

/// The chunks of a dataset by number; the last dimension varies fastest.
pub(crate) type Chunks = BTreeMap<u64, Chunk>;

/// Number of chunks along each dimension.
pub(crate) fn grid(extents: &[u64], chunk: &[u64]) -> Vec<u64> {
    extents
        .iter()
        .zip(chunk)
        .map(|(e, c)| e.div_ceil(*c))
        .collect()
}

/// Reads the chunk index of a dataset.
pub(crate) fn read_chunks(
    file: &Hdf5File,
    chunked: &Chunked,
    space: &Space,
    filtered: bool,
    chunk_bytes: u64,
) -> Result<Chunks, Problem> {
    let Some(address) = chunked.address else {
        return Ok(Chunks::new());
    };
    let place = Places::new(chunked, space);
    match chunked.index {
        Index::Tree1 => read_tree1(file, address, chunked, &place),
        Index::Tree2 => read_tree2(file, address, chunked, &place),
        Index::Single(filter) => {
            let chunk = Chunk {
                address,
                size: filter.map(|(size, _)| size),
                skipped: filter.map_or(0, |(_, skipped)| skipped),
            };
            Ok(Chunks::from([(0, chunk)]))
        }
        Index::Implicit => {
            let count = place.most.iter().fold(1_u64, |n, m| n.saturating_mul(*m));
            let room = file.source.length() / chunk_bytes.max(1);
            let all = (0..count.min(room)).map(|i| {
                let chunk = Chunk {
                    address: address.saturating_add(i.saturating_mul(chunk_bytes)),
                    size: None,
                    skipped: 0,
                };
                (i, Some(chunk))
            });
            Ok(place.numbered(all))
        }
        Index::FixedArray => {
            let entries = read_fixed(file, address, filtered)?;
            Ok(place.numbered(entries.into_iter()))
        }
        Index::ExtensibleArray => {
            let entries = read_extensible(file, address, filtered)?;
            Ok(place.numbered(entries.into_iter()))
        }
    }
}

/// Converts numbers of chunks in an index to numbers in the dataset.
struct Places {
    /// Chunks along each dimension, now and at most.
    now: Vec<u64>,
    most: Vec<u64>,
    /// The unlimited dimension, if any; it varies slowest.
    unlimited: Option<usize>,
}

impl Places {
    fn new(chunked: &Chunked, space: &Space) -> Self {
        Self {
            now: grid(&space.extents, &chunked.chunk),
            most: grid(&space.most, &chunked.chunk),
            unlimited: match chunked.index {
                Index::ExtensibleArray => space.most.iter().position(|m| *m == u64::MAX),
                _ => None,
            },
        }
    }

    /// Chunks by number, without those outside of the dataset.
    fn numbered(&self, entries: impl Iterator<Item = (u64, Option<Chunk>)>) -> Chunks {
        entries
            .filter_map(|(number, chunk)| Some((self.number(&self.coordinates(number)?)?, chunk?)))
            .collect()
    }

    /// Coordinates of a chunk from its number in the index.
    fn coordinates(&self, mut number: u64) -> Option<Vec<u64>> {
        let mut coordinates = vec![0; self.most.len()];
        for d in (0..self.most.len()).rev() {
            if self.unlimited == Some(d) {
                continue;
            }
            coordinates[d] = number.checked_rem(self.most[d])?;
            number /= self.most[d];
        }
        match self.unlimited {
            Some(d) => coordinates[d] = number,
            None if number > 0 => return None,
            None => {}
        }
        Some(coordinates)
    }

    /// Number of a chunk in the dataset.
    fn number(&self, coordinates: &[u64]) -> Option<u64> {
        self.now
            .iter()
            .zip(coordinates)
            .try_fold(0_u64, |number, (extent, coordinate)| {
                let inside = coordinate < extent;
                number
                    .checked_mul(*extent)?
                    .checked_add(*coordinate)
                    .filter(|_| inside)
            })
    }
}

fn read_tree1(
    file: &Hdf5File,
    address: u64,
    chunked: &Chunked,
    place: &Places,
) -> Result<Chunks, Problem> {
    let rank = chunked.chunk.len();
    let mut chunks = Chunks::new();
    for leaf in read_leaves(file, address, Keys::Chunks(rank))? {
        let mut key = file.cursor(leaf.key, address);
        let chunk = Chunk {
            address: leaf.address,
            size: Some(u64::from(key.u32()?)),
            skipped: key.u32()?,
        };
        let coordinates: Vec<u64> = chunked
            .chunk
            .iter()
            .map(|extent| Ok(key.u64()? / extent))
            .collect::<Result<_, Problem>>()?;
        chunks.extend(place.number(&coordinates).map(|number| (number, chunk)));
    }
    Ok(chunks)
}

fn read_tree2(
    file: &Hdf5File,
    address: u64,
    chunked: &Chunked,
    place: &Places,
) -> Result<Chunks, Problem> {
    let rank = chunked.chunk.len();
    let (kind, records) = read_records(file, address, &[10, 11])?;
    let mut chunks = Chunks::new();
    for record in records {
        let mut cursor = file.cursor(record, address);
        let entry = cursor.left().saturating_sub(8 * rank);
        let chunk = read_entry(&mut cursor, entry, kind == 11)?;
        let coordinates: Vec<u64> = (0..rank)
            .map(|_| cursor.u64())
            .collect::<Result<_, Problem>>()?;
        chunks.extend(place.number(&coordinates).zip(chunk));
    }
    Ok(chunks)
}

/// The entries of a fixed array, by number.
fn read_fixed(
    file: &Hdf5File,
    address: u64,
    filtered: bool,
) -> Result<Vec<(u64, Option<Chunk>)>, Problem> {
    let widths = file.widths;
    let size = 12 + widths.length + widths.address;
    let mut cursor = file.checked(address, size as u64, b"FAHD")?;
    cursor.version("an array of chunks", &[0])?;
    let client = cursor.u8()?;
    let entry = usize::from(cursor.u8()?);
    let page_bits = cursor.u8()?;
    let count = cursor.length()?;
    let block = cursor.address()?;
    let fits = entry >= widths.address && client == u8::from(filtered) && page_bits < 32;
    if !fits || count > file.source.length() {
        return Err(cursor.damaged("the sizes in a chunk index are inconsistent"));
    }
    let Some(block) = block else {
        return Ok(Vec::new());
    };
    let head = (6 + widths.address) as u64;
    let page = 1_u64 << page_bits;
    let mut entries = Vec::new();
    let mut read = |at: u64, first: u64, count: u64, before: u64| -> Result<(), Problem> {
        let mut cursor = file.checked_page(at, before + count * entry as u64 + 4)?;
        cursor.skip(before as usize)?;
        for i in 0..count {
            entries.push((first + i, read_entry(&mut cursor, entry, filtered)?));
        }
        Ok(())
    };
    if count <= page {
        read(block, 0, count, head)?;
        return Ok(entries);
    }
    let pages = count.div_ceil(page);
    let mut cursor = file.checked_page(block, head + pages.div_ceil(8) + 4)?;
    let first = block + cursor.left() as u64;
    cursor.skip(head as usize)?;
    for p in 0..pages {
        let bits = cursor.rest()[(p / 8) as usize];
        if bits & (0x80 >> (p % 8)) != 0 {
            let at = first + p * (page * entry as u64 + 4);
            read(at, p * page, page.min(count - p * page), 0)?;
        }
    }
    Ok(entries)
}
