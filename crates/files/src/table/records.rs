//! Text with separated cells → records, in blocks of whole records.
//!
//! Cells may be quoted, and hold separators and line ends then; a quote within is doubled. A
//! quote that is not the first character of a cell is one like others. Lines end with a line
//! feed, a carriage return or both; empty ones are passed over (RFC 4180, and what spreadsheets
//! make of it).

use memchr::{memchr, memchr_iter, memchr3, memrchr};
use std::borrow::Cow;
use std::io::{Read, Result};

/// Size of a block, unless a record is longer; bytes.
const BLOCK: usize = 1 << 18;

/// The blocks of a text.
pub(crate) struct Blocks {
    reader: Box<dyn Read>,
    /// What stands between cells.
    pub(crate) separator: u8,
    /// What was read and not yet given away.
    left: Vec<u8>,
    /// Line at which that begins, from 1.
    line: usize,
    ended: bool,
}

/// Whole records.
pub(crate) struct Block {
    /// Their text.
    pub(crate) bytes: Vec<u8>,
    /// Line at which it begins, from 1.
    pub(crate) line: usize,
}

impl Blocks {
    /// Blocks of what was read already, and of the rest of a reader.
    ///
    /// * `line`: line at which `begun` begins, from 1
    pub(crate) fn new(begun: Vec<u8>, line: usize, separator: u8, reader: Box<dyn Read>) -> Self {
        Self {
            reader,
            separator,
            left: begun,
            line,
            ended: false,
        }
    }

    /// The next records; `None` at the end.
    pub(crate) fn next(&mut self) -> Result<Option<Block>> {
        self.cut(BLOCK, last_end)
    }

    /// One record.
    pub(crate) fn next_record(&mut self) -> Result<Option<Block>> {
        self.cut(0, |bytes, separator| {
            ends(bytes, separator).next().unwrap_or(0)
        })
    }

    /// What stands before an end that is found in at least `size` bytes, or in more.
    fn cut(&mut self, mut size: usize, end: fn(&[u8], u8) -> usize) -> Result<Option<Block>> {
        let mut bytes = std::mem::take(&mut self.left);
        loop {
            if let Some(wanted) = size.checked_sub(bytes.len())
                && !self.ended
            {
                bytes.reserve(wanted);
                let read = (&mut self.reader).take(wanted as u64);
                self.ended = { read }.read_to_end(&mut bytes)? < wanted;
            }
            let found = end(&bytes, self.separator);
            if found > 0 || self.ended {
                let end = if found > 0 { found } else { bytes.len() };
                self.left = bytes.split_off(end);
                let line = self.line;
                self.line += memchr_iter(b'\n', &bytes).count();
                return Ok((!bytes.is_empty()).then_some(Block { bytes, line }));
            }
            size = BLOCK.max(2 * bytes.len());
        }
    }
}

/// Where the last whole record ends; 0 where none does.
fn last_end(bytes: &[u8], separator: u8) -> usize {
    match memchr(b'"', bytes) {
        None => memrchr(b'\n', bytes).map_or(0, |place| place + 1),
        Some(_) => ends(bytes, separator).last().unwrap_or(0),
    }
}

/// Where lines end outside of quoted cells.
fn ends(bytes: &[u8], separator: u8) -> impl Iterator<Item = usize> {
    let mut at = 0;
    std::iter::from_fn(move || {
        loop {
            if bytes.get(at) == Some(&b'"') {
                at = after_quotes(bytes, at)?;
                // The next byte would tell whether this quote is the last one.
                bytes.get(at)?;
            }
            at += memchr3(separator, b'\n', b'\r', &bytes[at..])? + 1;
            if bytes[at - 1] != separator {
                return Some(at);
            }
        }
    })
}

/// Place behind the quote that ends a quoted cell; `None` where it does not end.
///
/// * `at`: place of its first quote
fn after_quotes(bytes: &[u8], mut at: usize) -> Option<usize> {
    loop {
        at += 1;
        at += memchr(b'"', bytes.get(at..)?)? + 1;
        if bytes.get(at) != Some(&b'"') {
            return Some(at);
        }
    }
}

/// The records of a text.
pub(crate) struct Records<'a> {
    text: &'a str,
    at: usize,
    line: usize,
    separator: u8,
}

impl<'a> Records<'a> {
    /// Of a text that begins at a line of its file, from 1.
    pub(crate) fn new(text: &'a str, line: usize, separator: u8) -> Self {
        Self {
            text,
            at: 0,
            line,
            separator,
        }
    }

    /// Reads the next record, and says in which line it begins.
    pub(crate) fn next(&mut self, cells: &mut Vec<Cow<'a, str>>) -> Option<usize> {
        let bytes = self.text.as_bytes();
        while let Some(end @ (b'\n' | b'\r')) = bytes.get(self.at) {
            self.line += usize::from(*end == b'\n');
            self.at += 1;
        }
        bytes.get(self.at)?;
        let begins = self.line;
        cells.clear();
        loop {
            let end = self.cell(cells);
            self.at = end + 1;
            match bytes.get(end) {
                Some(byte) if *byte == self.separator => (),
                Some(byte) => {
                    self.line += usize::from(*byte == b'\n');
                    return Some(begins);
                }
                None => return Some(begins),
            }
        }
    }

    /// Reads a cell, and says where it ends.
    #[inline]
    fn cell(&mut self, cells: &mut Vec<Cow<'a, str>>) -> usize {
        let (bytes, start) = (self.text.as_bytes(), self.at);
        if bytes.get(start) == Some(&b'"') {
            return self.quoted(cells);
        }
        let end = end_of_cell(bytes, start, self.separator);
        cells.push(Cow::Borrowed(&self.text[start..end]));
        end
    }

    fn quoted(&mut self, cells: &mut Vec<Cow<'a, str>>) -> usize {
        let (bytes, start) = (self.text.as_bytes(), self.at);
        let after = after_quotes(bytes, start);
        // A quote that nothing closes reaches to the end.
        let (inner, end) = match after {
            Some(after) => (
                &self.text[start + 1..after - 1],
                end_of_cell(bytes, after, self.separator),
            ),
            None => (&self.text[start + 1..], bytes.len()),
        };
        self.line += memchr_iter(b'\n', inner.as_bytes()).count();
        let behind = &self.text[after.unwrap_or(end)..end];
        cells.push(match inner.contains('"') || !behind.is_empty() {
            true => Cow::Owned(inner.replace("\"\"", "\"") + behind),
            false => Cow::Borrowed(inner),
        });
        end
    }
}

#[inline]
fn end_of_cell(bytes: &[u8], start: usize, separator: u8) -> usize {
    let (mut rest, mut at) = (&bytes[start..], start);
    // Eight bytes at a time: most cells are no longer.
    while let Some((eight, more)) = rest.split_first_chunk() {
        let word = u64::from_le_bytes(*eight);
        let found = marks(word, separator) | marks(word, b'\n') | marks(word, b'\r');
        if found != 0 {
            return at + found.trailing_zeros() as usize / 8;
        }
        (rest, at) = (more, at + 8);
    }
    let ends = |byte: &u8| *byte == separator || *byte == b'\n' || *byte == b'\r';
    at + rest.iter().position(ends).unwrap_or(rest.len())
}

/// A word whose lowest bit, if any, lies in the first byte that equals another: zero bytes of
/// their difference borrow from the bits above them.
#[inline]
fn marks(word: u64, byte: u8) -> u64 {
    const LOW: u64 = u64::from_ne_bytes([1; 8]);
    let apart = word ^ (LOW * u64::from(byte));
    apart.wrapping_sub(LOW) & !apart & (LOW << 7)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Cursor;

    /// Records with their lines, from blocks that are cut where `size` bytes are read.
    fn records(text: &str, size: usize) -> Vec<(usize, Vec<String>)> {
        let reader = Box::new(Cursor::new(text.as_bytes().to_vec()));
        let mut blocks = Blocks::new(Vec::new(), 1, b',', reader);
        let mut found = Vec::new();
        while let Some(block) = blocks.cut(size, last_end).unwrap() {
            let text = String::from_utf8(block.bytes).unwrap();
            let mut records = Records::new(&text, block.line, b',');
            let mut cells = Vec::new();
            while let Some(line) = records.next(&mut cells) {
                let cells = cells.iter().map(|cell| cell.clone().into_owned());
                found.push((line, cells.collect()));
            }
        }
        found
    }

    const TEXT: &str = "a,b\r\n\n1,\"x,\"\"y\"\"\nz\"\n\"q\"w,\"\"\n d ,5\"\r\n,\n\"\",\"open\n,";

    #[test]
    fn closed_form_cells_and_lines() {
        let expected = [
            (1, ["a", "b"]),
            (3, ["1", "x,\"y\"\nz"]),
            (5, ["qw", ""]),
            (6, [" d ", "5\""]),
            (7, ["", ""]),
            (8, ["", "open\n,"]),
        ];
        let expected = expected.map(|(line, cells)| (line, cells.map(str::to_owned).to_vec()));
        assert_eq!(records(TEXT, BLOCK), expected);
    }

    /// Blocks end where records do, wherever reading stops.
    #[test]
    fn repeats_the_records_in_blocks_of_any_size() {
        for text in [TEXT, "a,b\r1,2\r", "a\n1\n\n\n2", "\n", "a,"] {
            let whole = records(text, BLOCK);
            for size in 1..text.len() + 2 {
                assert_eq!(records(text, size), whole, "{size}");
            }
        }
    }

    /// What the crate csv reads, which writes our tables.
    #[test]
    fn reference_records_of_the_crate_csv() {
        let mut state = 1_u32;
        let mut text = String::new();
        for _ in 0..20_000 {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            text.push(['a', ',', '"', '\n', '\r', ' ', 'é', '1'][(state >> 24) as usize % 8]);
        }
        let mut builder = csv::ReaderBuilder::new();
        let builder = builder.flexible(true).has_headers(false);
        let mut reader = builder.from_reader(text.as_bytes());
        let expected = reader.records().map(|record| {
            let record = record.unwrap();
            record.iter().map(str::to_owned).collect::<Vec<_>>()
        });
        let found = records(&text, 1000).into_iter().map(|(_, cells)| cells);
        assert!(found.eq(expected));
    }
}
