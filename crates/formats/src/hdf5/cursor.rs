//! Reads the structures of an HDF5 file field by field.

use crate::number::integer;
use std::borrow::Cow;
use windfall_source::error::Error;

/// Why a part of an HDF5 file cannot be read.
#[derive(Debug)]
pub(crate) enum Problem {
    /// The file is damaged at this byte; how.
    Damaged(u64, String),
    /// An unsupported part of the format.
    Unsupported(String),
    /// The bytes cannot be read.
    Source(Error),
}

impl From<Error> for Problem {
    fn from(error: Error) -> Self {
        Self::Source(error)
    }
}

/// Sizes of addresses and lengths in a file; bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Widths {
    pub address: usize,
    pub length: usize,
}

/// A position in bytes from offset `start` of the file.
#[derive(Clone, Debug)]
pub(crate) struct Cursor<'a> {
    bytes: Cow<'a, [u8]>,
    place: usize,
    start: u64,
    widths: Widths,
}

impl<'a> Cursor<'a> {
    pub fn new(bytes: impl Into<Cow<'a, [u8]>>, start: u64, widths: Widths) -> Self {
        Self {
            bytes: bytes.into(),
            place: 0,
            start,
            widths,
        }
    }

    pub fn widths(&self) -> Widths {
        self.widths
    }

    /// Offset of the next byte in the file.
    pub fn at(&self) -> u64 {
        self.start + self.place as u64
    }

    /// Number of bytes read.
    pub fn place(&self) -> usize {
        self.place
    }

    pub fn left(&self) -> usize {
        self.bytes.len() - self.place
    }

    pub fn damaged(&self, what: &str) -> Problem {
        Problem::Damaged(self.at(), what.to_owned())
    }

    pub fn take(&mut self, count: usize) -> Result<&[u8], Problem> {
        if count > self.left() {
            return Err(self.damaged("a structure ends before what it declares"));
        }
        self.place += count;
        Ok(&self.bytes[self.place - count..self.place])
    }

    pub fn rest(&self) -> &[u8] {
        &self.bytes[self.place..]
    }

    pub fn skip(&mut self, count: usize) -> Result<(), Problem> {
        self.take(count).map(|_| ())
    }

    /// Skips padding to a multiple of eight bytes since `from`.
    pub fn align(&mut self, from: usize) -> Result<(), Problem> {
        let used = self.place - from;
        self.skip(used.next_multiple_of(8) - used)
    }

    /// An integer of up to eight bytes.
    pub fn uint(&mut self, size: usize) -> Result<u64, Problem> {
        let bytes = self.take(size)?;
        match size <= 8 {
            true => Ok(integer(bytes, false)),
            false => Err(self.damaged("a number is longer than eight bytes")),
        }
    }

    pub fn u8(&mut self) -> Result<u8, Problem> {
        Ok(self.take(1)?[0])
    }

    pub fn u16(&mut self) -> Result<u16, Problem> {
        Ok(self.uint(2)? as u16)
    }

    pub fn u32(&mut self) -> Result<u32, Problem> {
        Ok(self.uint(4)? as u32)
    }

    pub fn u64(&mut self) -> Result<u64, Problem> {
        self.uint(8)
    }

    /// A length or count.
    pub fn length(&mut self) -> Result<u64, Problem> {
        self.uint(self.widths.length)
    }

    /// An address; `None` if undefined.
    pub fn address(&mut self) -> Result<Option<u64>, Problem> {
        let size = self.widths.address;
        let address = self.uint(size)?;
        let undefined = u64::MAX >> (64 - 8 * size);
        Ok((address != undefined).then_some(address))
    }

    pub fn signature(&mut self, expected: &[u8; 4]) -> Result<(), Problem> {
        if self.take(4)? == expected {
            return Ok(());
        }
        let name = String::from_utf8_lossy(expected);
        Err(Problem::Damaged(
            self.at() - 4,
            format!("expected a structure \"{name}\""),
        ))
    }

    /// Reads a version and checks that it is supported.
    pub fn version(&mut self, of: &str, known: &[u8]) -> Result<u8, Problem> {
        let version = self.u8()?;
        match known.contains(&version) {
            true => Ok(version),
            false => Err(Problem::Unsupported(format!("version {version} of {of}"))),
        }
    }

    /// A zero-terminated text.
    pub fn text(&mut self) -> Result<String, Problem> {
        let end = self.bytes[self.place..].iter().position(|b| *b == 0);
        let end = end.ok_or_else(|| self.damaged("a name has no end"))?;
        let text = String::from_utf8_lossy(self.take(end)?).into_owned();
        self.skip(1)?;
        Ok(text)
    }
}

/// Bytes needed for a count of up to `most`.
pub(crate) fn bytes_for(most: u64) -> usize {
    (most.max(1).ilog2() / 8 + 1) as usize
}
