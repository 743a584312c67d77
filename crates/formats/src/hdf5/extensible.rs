//! Extensible arrays: chunk index of datasets with one unlimited dimension.

use crate::hdf5::chunk_entry::{Chunk, read_entry};
use crate::hdf5::cursor::{Cursor, Problem};
use crate::hdf5::file::Hdf5File;

struct Array<'a> {
    file: &'a Hdf5File,
    filtered: bool,
    /// Bytes per entry.
    entry: usize,
    /// Width of a block offset; bytes.
    offset: usize,
    /// Entries in the smallest block.
    smallest: u64,
    /// Entries per page.
    page: u64,
    /// Number of entries ever written.
    most: u64,
    entries: Vec<(u64, Option<Chunk>)>,
    next: u64,
}

/// The entries of an extensible array, by number.
pub(crate) fn read_extensible(
    file: &Hdf5File,
    address: u64,
    filtered: bool,
) -> Result<Vec<(u64, Option<Chunk>)>, Problem> {
    let widths = file.widths;
    let size = 16 + 6 * widths.length + widths.address;
    let mut cursor = file.checked(address, size as u64, b"EAHD")?;
    cursor.version("an array of chunks", &[0])?;
    let client = cursor.u8()?;
    let entry = usize::from(cursor.u8()?);
    let bits = u32::from(cursor.u8()?);
    let in_index = u64::from(cursor.u8()?);
    let smallest = u64::from(cursor.u8()?);
    let pointers = u64::from(cursor.u8()?);
    let page_bits = cursor.u8()?;
    cursor.skip(4 * widths.length)?;
    let most = cursor.length()?;
    cursor.length()?;
    let index = cursor.address()?;
    let usual = client == u8::from(filtered)
        && entry >= widths.address
        && smallest.is_power_of_two()
        && pointers.is_power_of_two()
        && bits <= 64
        && bits >= smallest.ilog2()
        && page_bits < 32
        && most <= file.source.length();
    if !usual {
        return Err(cursor.damaged("the sizes in a chunk index are inconsistent"));
    }
    let Some(index) = index else {
        return Ok(Vec::new());
    };
    let mut array = Array {
        file,
        filtered,
        entry,
        offset: bits.div_ceil(8) as usize,
        smallest,
        page: 1 << page_bits,
        most,
        entries: Vec::new(),
        next: 0,
    };
    let supers = u64::from(1 + bits - smallest.ilog2());
    array.read_index(index, in_index, pointers, supers)?;
    Ok(array.entries)
}

impl Array<'_> {
    fn read_entries(&mut self, cursor: &mut Cursor<'_>, count: u64) -> Result<(), Problem> {
        for _ in 0..count {
            let entry = read_entry(cursor, self.entry, self.filtered)?;
            if self.next < self.most {
                self.entries.push((self.next, entry));
            }
            self.next += 1;
        }
        Ok(())
    }

    fn read_index(
        &mut self,
        address: u64,
        in_index: u64,
        pointers: u64,
        supers: u64,
    ) -> Result<(), Problem> {
        let width = self.file.widths.address as u64;
        let direct = 2 * (pointers - 1);
        // The index itself points to the blocks of the first steps of growth.
        let steps = 2 * u64::from(pointers.ilog2());
        let above = supers.saturating_sub(steps);
        let size = 6 + width + in_index * self.entry as u64 + (direct + above) * width + 4;
        let mut cursor = self.file.checked(address, size, b"EAIB")?;
        cursor.skip(2 + width as usize)?;
        self.read_entries(&mut cursor, in_index)?;
        for step in 0..steps.min(supers) {
            for _ in 0..1_u64 << (step / 2) {
                let block = cursor.address()?;
                self.read_block(block, self.block_entries(step), None)?;
            }
        }
        for step in steps..supers {
            let block = cursor.address()?;
            if self.next >= self.most {
                break;
            }
            self.read_super(block, step)?;
        }
        Ok(())
    }

    /// Entries per block in a step of growth.
    fn block_entries(&self, step: u64) -> u64 {
        self.smallest << step.div_ceil(2)
    }

    fn read_super(&mut self, address: Option<u64>, step: u64) -> Result<(), Problem> {
        let width = self.file.widths.address as u64;
        let (blocks, entries) = (1_u64 << (step / 2), self.block_entries(step));
        let Some(address) = address else {
            self.next = self.next.saturating_add(blocks.saturating_mul(entries));
            return Ok(());
        };
        let pages = if entries > self.page {
            entries / self.page
        } else {
            0
        };
        let bitmap = pages.div_ceil(8);
        let size = blocks.saturating_mul(bitmap + width);
        let size = size.saturating_add(10 + width + self.offset as u64);
        let mut cursor = self.file.checked(address, size, b"EASB")?;
        cursor.skip(2 + width as usize + self.offset)?;
        let bitmaps = cursor.take((blocks * bitmap) as usize)?.to_vec();
        for block in 0..blocks {
            let at = cursor.address()?;
            let from = (block * bitmap) as usize;
            let written = &bitmaps[from..from + bitmap as usize];
            self.read_block(at, entries, Some(written))?;
        }
        Ok(())
    }

    /// Reads a block of entries; `written` has a bit for each page that exists.
    fn read_block(
        &mut self,
        address: Option<u64>,
        entries: u64,
        written: Option<&[u8]>,
    ) -> Result<(), Problem> {
        let Some(address) = address.filter(|_| self.next < self.most) else {
            self.next = self.next.saturating_add(entries);
            return Ok(());
        };
        let head = 6 + self.file.widths.address + self.offset;
        let paged = entries > self.page;
        let within = if paged {
            0
        } else {
            entries * self.entry as u64
        };
        let size = head as u64 + within + 4;
        let mut cursor = self.file.checked(address, size, b"EADB")?;
        cursor.skip(head - 4)?;
        if !paged {
            return self.read_entries(&mut cursor, entries);
        }
        let page_bytes = self.page * self.entry as u64 + 4;
        for p in 0..entries / self.page {
            let bits = written.and_then(|w| w.get(p as usize / 8)).copied();
            if self.next >= self.most || bits.is_some_and(|b| b & (0x80 >> (p % 8)) == 0) {
                self.next = self.next.saturating_add(self.page);
                continue;
            }
            let at = address + size + p * page_bytes;
            let mut page = self.file.checked_page(at, page_bytes)?;
            self.read_entries(&mut page, self.page)?;
        }
        Ok(())
    }
}
