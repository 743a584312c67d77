//! Data elements of version 5 MAT files: a tag and its data.

use crate::mat::flow::{ADVICE, Flow, Region};
use crate::number::integer;
use windfall_source::error::{Error, Place};
use windfall_source::source::Source;

pub(crate) const MATRIX: u32 = 14;

pub(crate) const COMPRESSED: u32 = 15;

/// A data element.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Element {
    /// Type of the data.
    pub kind: u32,
    /// Offset of the data.
    pub at: u64,
    /// Length of the data; bytes.
    pub length: u64,
    /// Offset after the data and padding.
    pub next: u64,
    /// The data, if stored in the tag itself.
    small: Option<[u8; 4]>,
}

/// A variable from which elements are read.
pub(crate) struct Elements<'a> {
    pub source: &'a Source,
    /// The bytes of the variable, and their place in the file.
    pub flow: Flow<'a>,
    pub region: Region,
    pub big_endian: bool,
    /// Offset of the variable in the file, for messages.
    pub start: u64,
}

impl Elements<'_> {
    /// The element at `at` within a structure that ends at `end`.
    pub fn element(&mut self, at: u64, end: u64) -> Result<Element, Error> {
        if end.saturating_sub(at) < 8 {
            return Err(self.malformed("expected a data element, found the end of the variable"));
        }
        let mut tag = [0; 8];
        self.flow.read_at(at, &mut tag)?;
        let [first, second] = [self.u32(&tag[..4]), self.u32(&tag[4..])];
        let small = first >> 16 != 0;
        let element = match small {
            true => Element {
                kind: first & 0xffff,
                at: at + 4,
                length: u64::from(first >> 16),
                next: at + 8,
                small: Some([tag[4], tag[5], tag[6], tag[7]]),
            },
            false => Element {
                kind: first,
                at: at + 8,
                length: u64::from(second),
                next: at + 8 + u64::from(second).next_multiple_of(8),
                small: None,
            },
        };
        if small && element.length > 4 {
            return Err(self.malformed("a small data element declares more than 4 bytes"));
        }
        let possible = end - element.at;
        if element.length > possible {
            return Err(Error::TooLarge {
                path: self.source.path().to_path_buf(),
                place: Place::Byte(self.start),
                what: "a data element of the variable that begins here".to_owned(),
                declared: element.length,
                possible,
            });
        }
        // The last element of a variable may lack its padding.
        let next = element.next.min(end);
        Ok(Element { next, ..element })
    }

    /// The data of an element, at most `most` bytes.
    pub fn data(&mut self, element: Element, most: u64) -> Result<Vec<u8>, Error> {
        let length = element.length.min(most) as usize;
        if let Some(small) = element.small {
            return Ok(small[..length.min(4)].to_vec());
        }
        let mut bytes = vec![0; length];
        if !bytes.is_empty() {
            self.flow.read_at(element.at, &mut bytes)?;
        }
        Ok(bytes)
    }

    /// The integers of an element, at most `most`.
    pub fn integers(&mut self, element: Element, most: u64) -> Result<Vec<u32>, Error> {
        let bytes = self.data(element, most * 4)?;
        let words = bytes.as_chunks::<4>().0.iter();
        Ok(words.map(|b| self.u32(b)).collect())
    }

    fn u32(&self, bytes: &[u8]) -> u32 {
        integer(bytes, self.big_endian) as u32
    }

    pub fn malformed(&self, problem: &str) -> Error {
        self.source.malformed(
            Place::Byte(self.start),
            format!("in the variable that begins here: {problem}"),
            ADVICE,
        )
    }
}
