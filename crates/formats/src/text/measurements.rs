//! Measurements of known length that follow one another without a header.

use windfall_source::error::Error;
use windfall_source::source::Source;

/// Bytes read at a time.
const BLOCK: u64 = 1 << 20;

/// Where rows are.
pub struct Rows {
    /// First byte.
    pub start: u64,
    /// One past the last byte.
    pub end: u64,
    /// Line number of the first row, from 1.
    pub first_line: u64,
}

/// First byte and line of every measurement of `length` rows; of the first alone if the
/// last has another length. Blank lines are not rows.
///
/// # Errors
/// The file cannot be read.
pub fn starts_of_measurements(
    source: &Source,
    rows: &Rows,
    separator: u8,
    length: u64,
) -> Result<Vec<(u64, u64)>, Error> {
    let first = (rows.start, rows.first_line);
    let mut starts = vec![first];
    let (mut count, mut line) = (0, rows.first_line);
    let (mut at, mut line_start, mut filled) = (rows.start, rows.start, false);
    while at < rows.end {
        let bytes = source.bytes_at(at, BLOCK.min(rows.end - at))?;
        for (byte, place) in bytes.iter().zip(at..) {
            if *byte == b'\n' {
                count += u64::from(filled);
                line += 1;
                (line_start, filled) = (place + 1, false);
            } else if !filled && !byte.is_ascii_whitespace() && *byte != separator {
                filled = true;
                if count > 0 && count.is_multiple_of(length) {
                    starts.push((line_start, line));
                }
            }
        }
        at += bytes.len() as u64;
    }
    count += u64::from(filled);
    starts.truncate(if count.is_multiple_of(length) {
        starts.len()
    } else {
        1
    });
    Ok(starts)
}
