//! Chunk filters: compression, shuffling, checksums.

use crate::hdf5::checksum::fletcher32;
use crate::hdf5::cursor::{Cursor, Problem};
use crate::hdf5::lzf::unpack_lzf;
use flate2::read::ZlibDecoder;
use std::io::Read;

/// Most filters of a dataset; HDF5 has 32.
const MOST_FILTERS: u8 = 32;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Filter {
    Deflate,
    /// Byte shuffling; the size of an element.
    Shuffle(usize),
    Fletcher32,
    Lzf,
}

/// Reads the filters of a dataset, in the order of application.
pub(crate) fn read_filters(cursor: &mut Cursor<'_>) -> Result<Vec<Filter>, Problem> {
    let version = cursor.version("filters", &[1, 2])?;
    let count = cursor.u8()?;
    if count > MOST_FILTERS {
        return Err(cursor.damaged("a dataset has more than 32 filters"));
    }
    if version == 1 {
        cursor.skip(6)?;
    }
    let mut filters = Vec::new();
    for _ in 0..count {
        let number = cursor.u16()?;
        let named = version == 1 || number >= 256;
        let name_length = if named { cursor.u16()? } else { 0 };
        cursor.skip(2)?;
        let values = usize::from(cursor.u16()?);
        let name_length = usize::from(name_length);
        let padded = match version {
            1 => name_length.next_multiple_of(8),
            _ => name_length,
        };
        let name = cursor.take(padded)?.to_vec();
        let mut first = None;
        for i in 0..values {
            let value = cursor.u32()?;
            if i == 0 {
                first = Some(value as usize);
            }
        }
        if version == 1 && values % 2 == 1 {
            cursor.skip(4)?;
        }
        filters.push(match (number, first) {
            (1, _) => Filter::Deflate,
            (2, Some(size)) if size > 0 => Filter::Shuffle(size),
            (3, _) => Filter::Fletcher32,
            (32000, _) => Filter::Lzf,
            _ => return Err(unknown(number, &name)),
        });
    }
    Ok(filters)
}

fn unknown(number: u16, name: &[u8]) -> Problem {
    let known = match number {
        4 => "SZIP",
        5 => "n-bit",
        6 => "scale-offset",
        307 => "bzip2",
        32001 => "Blosc",
        32004 => "LZ4",
        32008 => "bitshuffle",
        32013 => "ZFP",
        32015 => "Zstandard",
        32026 => "Blosc2",
        _ => "",
    };
    let own = String::from_utf8_lossy(name);
    let own = own.trim_end_matches('\0');
    let name = if known.is_empty() { own } else { known };
    Problem::Unsupported(format!("data with the filter {number} ({name})"))
}

/// Undoes the filters of a chunk.
///
/// * `skipped`: mask of filters that were not applied
/// * `size`: unfiltered size; bytes
///
/// Returns `None` if the data are damaged.
pub(crate) fn undo_filters(
    mut bytes: Vec<u8>,
    filters: &[Filter],
    skipped: u32,
    size: usize,
) -> Option<Vec<u8>> {
    // Intermediate results may still contain checksums.
    let most = size.checked_add(4 * filters.len())?;
    for (i, filter) in filters.iter().enumerate().rev() {
        if skipped >> i & 1 != 0 {
            continue;
        }
        bytes = match filter {
            Filter::Deflate => inflate(&bytes, most)?,
            Filter::Shuffle(element) => unshuffle(&bytes, *element),
            Filter::Fletcher32 => checked(bytes)?,
            Filter::Lzf => unpack_lzf(&bytes, most)?,
        };
    }
    (bytes.len() == size).then_some(bytes)
}

fn inflate(bytes: &[u8], most: usize) -> Option<Vec<u8>> {
    let mut inflated = Vec::new();
    let mut decoder = ZlibDecoder::new(bytes).take(most as u64 + 1);
    decoder.read_to_end(&mut inflated).ok()?;
    (inflated.len() <= most).then_some(inflated)
}

/// Shuffled data have the first bytes of all whole elements, then the second ones, ….
fn unshuffle(bytes: &[u8], element: usize) -> Vec<u8> {
    let count = bytes.len() / element;
    if element < 2 || count < 2 {
        return bytes.to_vec();
    }
    let mut ordered = bytes.to_vec();
    for (i, plane) in bytes.chunks_exact(count).take(element).enumerate() {
        for (place, byte) in ordered[i..].iter_mut().step_by(element).zip(plane) {
            *place = *byte;
        }
    }
    ordered
}

/// Verifies and removes the checksum at the end.
fn checked(mut bytes: Vec<u8>) -> Option<Vec<u8>> {
    let body = bytes.len().checked_sub(4)?;
    let sum: [u8; 4] = bytes[body..].try_into().ok()?;
    let found = fletcher32(&bytes[..body]);
    // Before HDF5 1.6.3 the bytes within both halves were swapped.
    let turned = (found & 0x00ff_00ff) << 8 | (found >> 8) & 0x00ff_00ff;
    bytes.truncate(body);
    let sum = u32::from_le_bytes(sum);
    (sum == found || sum == turned).then_some(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn closed_form_unshuffle() {
        assert_eq!(unshuffle(b"adgbehcfix", 3), b"abcdefghix");
        assert_eq!(unshuffle(b"abc", 1), b"abc");
    }

    #[test]
    fn rejects_a_wrong_checksum() {
        let mut bytes = b"abcdef".to_vec();
        bytes.extend(fletcher32(b"abcdef").to_le_bytes());
        assert_eq!(checked(bytes.clone()).unwrap(), b"abcdef");
        bytes[0] = b'b';
        assert_eq!(checked(bytes), None);
    }
}
