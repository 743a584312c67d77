//! Lines of a file that holds text and binary data, one after the other.

use crate::error::{Error, Place};
use crate::source::Source;

/// Bytes read at once.
const BLOCK: u64 = 1 << 16;

/// Longest line; bytes.
const LONGEST_LINE: usize = 1 << 20;

/// Reads lines from a place in a file on.
#[derive(Debug)]
pub struct LineReader {
    /// Where the next line begins.
    at: u64,
    /// Number of the next line.
    number: u64,
    buffer: Vec<u8>,
    /// Where the buffer begins in the file.
    begin: u64,
}

/// A line and its number, from 1.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Line {
    /// Its text, without its end.
    pub text: String,
    /// Its number.
    pub number: u64,
}

impl LineReader {
    /// From byte `at` on, where line `number` begins.
    pub fn new(at: u64, number: u64) -> Self {
        Self {
            at,
            number,
            buffer: Vec::new(),
            begin: at,
        }
    }

    /// Where the next line begins.
    pub fn offset(&self) -> u64 {
        self.at
    }

    /// Number of the next line, from 1.
    pub fn number(&self) -> u64 {
        self.number
    }

    /// Goes on at another place.
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
                        "this is no universal file of text; was it damaged?",
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
