//! Reads lines from files that mix text and binary data.

use windfall_source::error::{Error, Place};
use windfall_source::source::Source;

/// Bytes read at a time.
const BLOCK: u64 = 1 << 16;

/// Longest line; bytes.
const LONGEST_LINE: usize = 1 << 20;

/// Reads lines from a position in a file.
#[derive(Debug)]
pub struct LineReader {
    /// Offset of the next line.
    at: u64,
    /// Number of the next line.
    number: u64,
    buffer: Vec<u8>,
    /// Offset of the buffer in the file.
    begin: u64,
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Line {
    /// Text without the line break.
    pub text: String,
    /// Number, from 1.
    pub number: u64,
}

impl LineReader {
    /// Starts at byte `at`, where line `number` begins.
    pub fn new(at: u64, number: u64) -> Self {
        Self {
            at,
            number,
            buffer: Vec::new(),
            begin: at,
        }
    }

    /// Offset of the next line.
    pub fn offset(&self) -> u64 {
        self.at
    }

    /// Number of the next line, from 1.
    pub fn number(&self) -> u64 {
        self.number
    }

    /// Continues at another offset.
    pub fn seek(&mut self, at: u64) {
        self.at = at;
        self.begin = at;
        self.buffer.clear();
    }

    /// The next line; `None` at the end of the file.
    pub fn next(&mut self, source: &Source) -> Result<Option<Line>, Error> {
        loop {
            let from = (self.at - self.begin) as usize;
            let found = memchr::memchr(b'\n', &self.buffer[from..]);
            let filled = self.begin + self.buffer.len() as u64;
            if found.is_none() && filled < source.length() {
                if self.buffer.len() - from > LONGEST_LINE {
                    return Err(source.malformed(
                        Place::Line(self.number),
                        "the line is longer than 1 MiB",
                        "is this universal file damaged?",
                    ));
                }
                self.buffer.drain(..from);
                self.begin = self.at;
                let count = BLOCK.min(source.length() - filled);
                self.buffer.extend(source.bytes_at(filled, count)?);
                continue;
            }
            let rest = &self.buffer[from..];
            if rest.is_empty() {
                return Ok(None);
            }
            let length = found.unwrap_or(rest.len());
            let text = String::from_utf8_lossy(&rest[..length]);
            let line = Line {
                text: text.trim_end_matches('\r').to_owned(),
                number: self.number,
            };
            self.at += length as u64 + u64::from(found.is_some());
            self.number += 1;
            return Ok(Some(line));
        }
    }
}
