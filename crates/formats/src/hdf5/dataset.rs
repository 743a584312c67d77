//! Datasets: type, extents and raw bytes.

use crate::hdf5::attribute::read_shared_type;
use crate::hdf5::chunk_entry::Chunk;
use crate::hdf5::chunks::{Chunks, grid, read_chunks};
use crate::hdf5::cursor::Problem;
use crate::hdf5::file::Hdf5File;
use crate::hdf5::filter::{Filter, read_filters, undo_filters};
use crate::hdf5::layout::{Chunked, Layout, Space, read_fill, read_layout, read_space};
use crate::hdf5::object::{
    DATASPACE, DATATYPE, EXTERNAL_FILES, FILL, FILTERS, Header, LAYOUT, Message, OLD_FILL, resolve,
};
use crate::hdf5::value_type::{Datatype, read_type};

/// Largest chunk; bytes. Programs write a few MB.
const LARGEST_CHUNK: u64 = 256 << 20;

/// Cache of unpacked chunks; bytes.
const KEPT: usize = 64 << 20;

#[derive(Debug)]
pub(crate) struct Dataset {
    pub space: Space,
    pub datatype: Datatype,
    pub layout: Layout,
    pub filters: Vec<Filter>,
    fill: Vec<u8>,
    chunks: Option<Chunks>,
    /// Cache of unpacked chunks: number and bytes.
    kept: Vec<(u64, Vec<u8>)>,
}

impl Dataset {
    /// Reads a dataset from its header; `None` if it is not a dataset.
    pub fn read(file: &Hdf5File, header: &Header) -> Result<Option<Self>, Problem> {
        let (Some(space), Some(datatype), Some(layout)) = (
            header.message(DATASPACE),
            header.message(DATATYPE),
            header.message(LAYOUT),
        ) else {
            return Ok(None);
        };
        if header.message(EXTERNAL_FILES).is_some() {
            return Err(Problem::Unsupported(
                "data stored in other files".to_owned(),
            ));
        }
        let cursor = |message: &Message| (message.bytes.clone(), message.address);
        let (bytes, at) = cursor(&resolve(file, space)?);
        let space = read_space(&mut file.cursor(&bytes, at))?;
        let mut inner = file.cursor(&datatype.bytes, datatype.address);
        let datatype = match datatype.shared {
            true => read_shared_type(file, &mut inner)?,
            false => read_type(&mut inner)?,
        };
        if datatype.size == 0 {
            return Err(inner.damaged("the elements of a dataset have zero size"));
        }
        let mut inner = file.cursor(&layout.bytes, layout.address);
        let layout = read_layout(&mut inner, space.count(), datatype.size)?;
        let filters = match header.message(FILTERS) {
            Some(message) => {
                let (bytes, at) = cursor(&resolve(file, message)?);
                read_filters(&mut file.cursor(&bytes, at))?
            }
            None => Vec::new(),
        };
        let dataset = Self {
            fill: read_fill_value(file, header)?,
            space,
            datatype,
            layout,
            filters,
            chunks: None,
            kept: Vec::new(),
        };
        match dataset.fits() {
            true => Ok(Some(dataset)),
            false => {
                Err(inner.damaged("the extents of a dataset do not match those of its chunks"))
            }
        }
    }

    fn fits(&self) -> bool {
        match &self.layout {
            Layout::Chunked(chunked) => {
                !chunked.chunk.is_empty()
                    && chunked.chunk.len() == self.space.extents.len()
                    && self.space.most.len() == self.space.extents.len()
            }
            _ => true,
        }
    }

    /// Bytes of all elements.
    pub fn size(&self) -> u64 {
        let element = self.datatype.size as u64;
        self.space.count().saturating_mul(element)
    }

    /// Extents of a chunk; empty if not chunked.
    pub fn chunk(&self) -> &[u64] {
        match &self.layout {
            Layout::Chunked(chunked) => &chunked.chunk,
            _ => &[],
        }
    }

    /// The bytes of the elements in the box from `low` to `high` (exclusive), which
    /// must be contiguous: single indices, then one range, then full dimensions.
    pub fn bytes(
        &mut self,
        file: &Hdf5File,
        low: &[u64],
        high: &[u64],
    ) -> Result<Vec<u8>, Problem> {
        let element = self.datatype.size as u64;
        let count: u64 = low.iter().zip(high).map(|(l, h)| h - l).product();
        let first = low
            .iter()
            .zip(&self.space.extents)
            .fold(0, |n, (l, e)| n * e + l);
        let (from, size) = (first * element, count * element);
        match &self.layout {
            Layout::Compact(bytes) => {
                let part = bytes.get(from as usize..(from + size) as usize);
                Ok(part.ok_or_else(too_short)?.to_vec())
            }
            Layout::Contiguous { address: None, .. } => Ok(self.filled(size)),
            Layout::Contiguous {
                address: Some(address),
                size: whole,
            } => {
                if from + size > *whole {
                    return Err(too_short());
                }
                file.bytes(address.saturating_add(from), size)
            }
            Layout::Chunked(chunked) => {
                let chunked = chunked.clone();
                self.chunked_bytes(file, &chunked, low, high, size)
            }
        }
    }

    fn filled(&self, size: u64) -> Vec<u8> {
        let size = size as usize;
        match self.fill.len() == self.datatype.size {
            true => self.fill.iter().copied().cycle().take(size).collect(),
            false => vec![0; size],
        }
    }

    fn chunked_bytes(
        &mut self,
        file: &Hdf5File,
        chunked: &Chunked,
        low: &[u64],
        high: &[u64],
        size: u64,
    ) -> Result<Vec<u8>, Problem> {
        let element = self.datatype.size as u64;
        let chunk_bytes = chunked
            .chunk
            .iter()
            .fold(element, |n, c| n.saturating_mul(*c));
        if chunk_bytes > LARGEST_CHUNK {
            let what = format!("chunks of {chunk_bytes} bytes");
            return Err(Problem::Unsupported(what));
        }
        if self.chunks.is_none() {
            let filtered = !self.filters.is_empty();
            let chunks = read_chunks(file, chunked, &self.space, filtered, chunk_bytes)?;
            self.chunks = Some(chunks);
        }
        let mut bytes = self.filled(size);
        let chunk = &chunked.chunk;
        let grid = grid(&self.space.extents, chunk);
        // Coordinates of the overlapping chunks; the last varies fastest.
        let first: Vec<u64> = low.iter().zip(chunk).map(|(l, c)| l / c).collect();
        let last: Vec<u64> = high.iter().zip(chunk).map(|(h, c)| (h - 1) / c).collect();
        let mut at = first.clone();
        loop {
            let number = at.iter().zip(&grid).fold(0, |n, (a, g)| n * g + a);
            let there = self.chunks.as_ref().and_then(|c| c.get(&number)).copied();
            if let Some(there) = there {
                let unpacked = self.unpack(file, number, there, chunk_bytes)?;
                copy_overlap(unpacked, &mut bytes, (chunk, &at), (low, high), element);
            }
            let Some(d) = (0..at.len()).rev().find(|&d| at[d] < last[d]) else {
                return Ok(bytes);
            };
            at[d] += 1;
            at[d + 1..].copy_from_slice(&first[d + 1..]);
        }
    }

    fn unpack(
        &mut self,
        file: &Hdf5File,
        number: u64,
        chunk: Chunk,
        size: u64,
    ) -> Result<&[u8], Problem> {
        if let Some(place) = self.kept.iter().position(|(n, _)| *n == number) {
            return Ok(&self.kept[place].1);
        }
        let packed = file.bytes(chunk.address, chunk.size.unwrap_or(size))?;
        let unpacked = undo_filters(packed, &self.filters, chunk.skipped, size as usize);
        let unpacked = unpacked.ok_or_else(|| {
            Problem::Damaged(
                file.base.saturating_add(chunk.address),
                "the chunk that begins here cannot be unpacked, or its checksum is wrong"
                    .to_owned(),
            )
        })?;
        let kept: usize = self.kept.iter().map(|(_, bytes)| bytes.len()).sum();
        if kept + unpacked.len() > KEPT {
            self.kept.clear();
        }
        self.kept.push((number, unpacked));
        Ok(self.kept.last().map_or(&[], |(_, bytes)| bytes))
    }

    /// Clears the cache of chunks.
    pub fn forget(&mut self) {
        self.kept.clear();
        self.kept.shrink_to_fit();
    }
}

fn read_fill_value(file: &Hdf5File, header: &Header) -> Result<Vec<u8>, Problem> {
    for (kind, old) in [(FILL, false), (OLD_FILL, true)] {
        if let Some(message) = header.message(kind).filter(|m| !m.shared) {
            return read_fill(&mut file.cursor(&message.bytes, message.address), old);
        }
    }
    Ok(Vec::new())
}

fn too_short() -> Problem {
    Problem::Damaged(0, "its data are shorter than its extents".to_owned())
}

/// Copies the overlap of a chunk and a box of elements.
fn copy_overlap(
    chunk_bytes: &[u8],
    bytes: &mut [u8],
    (chunk, at): (&[u64], &[u64]),
    (low, high): (&[u64], &[u64]),
    element: u64,
) {
    let rank = chunk.len();
    let begin: Vec<u64> = (0..rank).map(|d| low[d].max(at[d] * chunk[d])).collect();
    let end: Vec<u64> = (0..rank)
        .map(|d| high[d].min((at[d] + 1) * chunk[d]))
        .collect();
    // Copy runs along the last dimension at once.
    let run = ((end[rank - 1] - begin[rank - 1]) * element) as usize;
    let mut index = begin.clone();
    loop {
        let (mut from, mut to) = (0, 0);
        for d in 0..rank {
            from = from * chunk[d] + (index[d] - at[d] * chunk[d]);
            to = to * (high[d] - low[d]) + (index[d] - low[d]);
        }
        let (from, to) = ((from * element) as usize, (to * element) as usize);
        bytes[to..to + run].copy_from_slice(&chunk_bytes[from..from + run]);
        let next = (0..rank.saturating_sub(1))
            .rev()
            .find(|&d| index[d] + 1 < end[d]);
        let Some(d) = next else { return };
        index[d] += 1;
        index[d + 1..].copy_from_slice(&begin[d + 1..]);
    }
}
