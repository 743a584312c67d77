//! Heaps, which store names, links, attributes and texts.

use crate::hdf5::cursor::{Problem, bytes_for};
use crate::hdf5::file::Hdf5File;

/// Names of the members of an old-style group.
pub(crate) struct LocalHeap {
    bytes: Vec<u8>,
    address: u64,
}

impl LocalHeap {
    pub fn read(file: &Hdf5File, address: u64) -> Result<Self, Problem> {
        let size = 8 + 2 * file.widths.length + file.widths.address;
        let mut cursor = file.cursor(file.bytes(address, size as u64)?, address);
        cursor.signature(b"HEAP")?;
        cursor.skip(4)?;
        let size = cursor.length()?;
        cursor.length()?;
        let data = cursor.address()?;
        let data = data.ok_or_else(|| cursor.damaged("a name heap has an undefined address"))?;
        Ok(Self {
            bytes: file.bytes(data, size)?,
            address: data,
        })
    }

    pub fn name(&self, file: &Hdf5File, offset: u64) -> Result<String, Problem> {
        let rest = usize::try_from(offset)
            .ok()
            .and_then(|offset| self.bytes.get(offset..))
            .unwrap_or_default();
        file.cursor(rest, self.address.saturating_add(offset))
            .text()
    }
}

/// The bytes of an object in a global heap; `reference` gives its length, the
/// address of the collection, and its number.
pub(crate) fn read_text(file: &Hdf5File, reference: &[u8], at: u64) -> Result<Vec<u8>, Problem> {
    let mut cursor = file.cursor(reference, at);
    let length = u64::from(cursor.u32()?);
    let collection = cursor.address()?;
    let number = cursor.u32()?;
    let Some(address) = collection.filter(|_| length > 0) else {
        return Ok(Vec::new());
    };
    let widths = file.widths;
    let mut cursor = file.cursor(file.bytes(address, 8 + widths.length as u64)?, address);
    cursor.signature(b"GCOL")?;
    cursor.skip(4)?;
    let size = cursor.length()?;
    let mut cursor = file.cursor(file.bytes(address, size)?, address);
    cursor.skip(8 + widths.length)?;
    while cursor.left() >= 8 + widths.length {
        let found = u32::from(cursor.u16()?);
        cursor.skip(6)?;
        let size = cursor.length()?;
        if found == 0 {
            break;
        }
        let size = usize::try_from(size).unwrap_or(usize::MAX);
        let object = cursor.take(size)?;
        if found == number {
            let length = usize::try_from(length).unwrap_or(usize::MAX);
            return Ok(object[..length.min(object.len())].to_vec());
        }
        let padding = size.next_multiple_of(8) - size;
        cursor.skip(padding.min(cursor.left()))?;
    }
    Err(cursor.damaged("a text is not in its heap"))
}

/// A fractal heap, which stores links or attributes.
pub(crate) struct FractalHeap<'a> {
    file: &'a Hdf5File,
    id_length: usize,
    /// Blocks per row.
    width: u64,
    /// Sizes of the first and of the largest direct block; bytes.
    first: u64,
    largest: u64,
    offset_size: usize,
    length_size: usize,
    root: Option<u64>,
    /// Rows of the root block; 0 if it is a direct block.
    rows: u64,
}

/// Deepest nesting of blocks.
const DEEPEST: usize = 16;

impl<'a> FractalHeap<'a> {
    pub fn read(file: &'a Hdf5File, address: u64) -> Result<Self, Problem> {
        let widths = file.widths;
        let size = 26 + 12 * widths.length + 3 * widths.address;
        let mut cursor = file.checked(address, size as u64, b"FRHP")?;
        cursor.version("a heap", &[0])?;
        let id_length = usize::from(cursor.u16()?);
        if cursor.u16()? != 0 {
            return Err(Problem::Unsupported(
                "compressed attributes or links".to_owned(),
            ));
        }
        cursor.skip(1)?;
        let largest_object = u64::from(cursor.u32()?);
        cursor.skip(2 * widths.length + 2 * widths.address + 8 * widths.length)?;
        let width = u64::from(cursor.u16()?);
        let first = cursor.length()?;
        let largest = cursor.length()?;
        let bits = cursor.u16()?;
        cursor.skip(2)?;
        let root = cursor.address()?;
        let rows = u64::from(cursor.u16()?);
        let usual = width.is_power_of_two()
            && first.is_power_of_two()
            && largest.is_power_of_two()
            && largest >= first
            && largest <= 1 << 32
            && bits <= 64
            && width <= 1 << 16;
        if !usual {
            return Err(cursor.damaged("the sizes in a heap are inconsistent"));
        }
        Ok(Self {
            file,
            id_length,
            width,
            first,
            largest,
            offset_size: usize::from(bits).div_ceil(8),
            length_size: (largest.ilog2().div_ceil(8) as usize).min(bytes_for(largest_object)),
            root,
            rows,
        })
    }

    /// Length of an object identifier; bytes.
    pub fn id_length(&self) -> usize {
        self.id_length
    }

    /// An object and its address.
    pub fn object(&self, id: &[u8]) -> Result<(Vec<u8>, u64), Problem> {
        let mut cursor = self.file.cursor(id, 0);
        let flags = cursor.u8()?;
        match flags >> 4 & 3 {
            0 => {
                let offset = cursor.uint(self.offset_size)?;
                let length = cursor.uint(self.length_size)?;
                let address = self.locate(offset)?;
                Ok((self.file.bytes(address, length)?, address))
            }
            2 => {
                let length = usize::from(flags & 0xf) + 1;
                Ok((cursor.take(length)?.to_vec(), 0))
            }
            _ => Err(Problem::Unsupported(
                "attributes and links larger than 64 kB".to_owned(),
            )),
        }
    }

    /// Converts a heap offset to an address.
    fn locate(&self, mut offset: u64) -> Result<u64, Problem> {
        let nowhere = || Problem::Damaged(0, "an attribute or link is not in its heap".to_owned());
        let mut block = self.root.ok_or_else(nowhere)?;
        let mut rows = self.rows;
        for _ in 0..DEEPEST {
            if rows == 0 {
                return block.checked_add(offset).ok_or_else(nowhere);
            }
            let (row, column, within) = self.cell(offset);
            if row >= rows {
                return Err(nowhere());
            }
            let head = 5 + self.file.widths.address + self.offset_size;
            let direct = self.direct_rows().min(rows);
            let width = self.file.widths.address as u64;
            let place = head as u64 + (row * self.width + column) * width;
            let place = block.checked_add(place).ok_or_else(nowhere)?;
            let pointer = self.file.bytes(place, width)?;
            let signature = self.file.bytes(block, 4)?;
            self.file.cursor(signature, block).signature(b"FHIB")?;
            block = self
                .file
                .cursor(pointer, block)
                .address()?
                .ok_or_else(nowhere)?;
            // The rows of an indirect block follow from its size.
            rows = match row < direct {
                true => 0,
                false => row - self.first_bits(),
            };
            offset = within;
        }
        Err(nowhere())
    }

    fn direct_rows(&self) -> u64 {
        u64::from(self.largest.ilog2() - self.first.ilog2()) + 2
    }

    /// Rows by which an indirect block falls short of its row number.
    fn first_bits(&self) -> u64 {
        u64::from(self.width.ilog2())
    }

    /// Row and column of the block at an offset, and the offset within it.
    fn cell(&self, offset: u64) -> (u64, u64, u64) {
        let row_bytes = self.first * self.width;
        let (row, begin, size) = match offset < row_bytes {
            true => (0, 0, self.first),
            false => {
                let power = (offset / row_bytes).ilog2();
                (
                    u64::from(power) + 1,
                    row_bytes << power,
                    self.first << power,
                )
            }
        };
        let within = offset - begin;
        (row, within / size, within % size)
    }
}
