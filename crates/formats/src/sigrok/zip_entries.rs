//! Entries of a zip archive, read as streams.
//!
//! # Source
//! PKWARE, "APPNOTE.TXT, .ZIP File Format Specification", version 6.3.

use crate::error::{Error, Place};
use crate::source::Source;
use flate2::read::DeflateDecoder;
use std::io::{BufReader, Read};

/// Bytes of the record at the end of an archive, without its comment.
const END_RECORD: u64 = 22;

/// Longest comment behind it; bytes.
const LONGEST_COMMENT: u64 = 1 << 16;

/// Bytes of an entry of the directory, without its names.
const DIRECTORY_ENTRY: usize = 46;

/// Bytes of the header before the data of an entry, without its names.
const LOCAL_HEADER: u64 = 30;

/// Longest directory; bytes.
const LONGEST_DIRECTORY: u64 = 1 << 24;

/// One file in an archive.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Entry {
    /// Its name.
    pub name: String,
    /// Bytes as they are stored.
    pub stored: u64,
    /// Bytes that it claims to have.
    pub size: u64,
    /// 0: as it is, 8: deflated.
    method: u16,
    header: u64,
}

fn malformed(source: &Source, at: u64, problem: &str) -> Error {
    source.malformed(
        Place::Byte(at),
        problem,
        "the archive is damaged; copy or export the capture again",
    )
}

fn u16_at(bytes: &[u8], at: usize) -> u16 {
    u16::from_le_bytes([bytes[at], bytes[at + 1]])
}

fn u32_at(bytes: &[u8], at: usize) -> u64 {
    u64::from(u32::from_le_bytes([
        bytes[at],
        bytes[at + 1],
        bytes[at + 2],
        bytes[at + 3],
    ]))
}

/// The entries of an archive, in the order of its directory.
pub fn read_entries(source: &Source) -> Result<Vec<Entry>, Error> {
    let length = source.length();
    let tail = (END_RECORD + LONGEST_COMMENT).min(length);
    let bytes = source.bytes_at(length - tail, tail)?;
    let place = memchr::memmem::rfind(&bytes, b"PK\x05\x06");
    let end = place.filter(|place| place + END_RECORD as usize <= bytes.len());
    let Some(end) = end else {
        return Err(malformed(
            source,
            length,
            "the archive has no directory at its end",
        ));
    };
    let (size, begin) = (u32_at(&bytes, end + 12), u32_at(&bytes, end + 16));
    if size > LONGEST_DIRECTORY || begin.saturating_add(size) > length {
        return Err(malformed(
            source,
            begin,
            "the directory of the archive lies outside of the file",
        ));
    }
    let directory = source.bytes_at(begin, size)?;
    let mut entries = Vec::new();
    let mut rest = directory.as_slice();
    while rest.len() >= DIRECTORY_ENTRY && rest.starts_with(b"PK\x01\x02") {
        let names = [28, 30, 32].map(|at| usize::from(u16_at(rest, at)));
        let whole = DIRECTORY_ENTRY + names.iter().sum::<usize>();
        let Some(name) = rest.get(DIRECTORY_ENTRY..DIRECTORY_ENTRY + names[0]) else {
            break;
        };
        entries.push(Entry {
            name: String::from_utf8_lossy(name).into_owned(),
            stored: u32_at(rest, 20),
            size: u32_at(rest, 24),
            method: u16_at(rest, 10),
            header: u32_at(rest, 42),
        });
        rest = rest.get(whole..).unwrap_or_default();
    }
    Ok(entries)
}

/// The bytes of an entry as a stream.
pub fn open_entry<'a>(source: &'a Source, entry: &Entry) -> Result<Box<dyn Read + 'a>, Error> {
    let header = source.bytes_at(entry.header, LOCAL_HEADER)?;
    if !header.starts_with(b"PK\x03\x04") {
        return Err(malformed(
            source,
            entry.header,
            "expected the header of an entry",
        ));
    }
    let names = u64::from(u16_at(&header, 26)) + u64::from(u16_at(&header, 28));
    let begin = entry.header + LOCAL_HEADER + names;
    if begin.saturating_add(entry.stored) > source.length() {
        return Err(source.truncated(begin, &format!("the entry {}", entry.name), entry.stored));
    }
    let stored = Stored {
        source,
        at: begin,
        end: begin + entry.stored,
    };
    match entry.method {
        0 => Ok(Box::new(BufReader::new(stored))),
        8 => Ok(Box::new(DeflateDecoder::new(BufReader::new(stored)))),
        other => Err(source.unsupported(
            Place::Object(entry.name.clone()),
            format!("entries compressed by method {other}"),
            "save the capture again",
        )),
    }
}

struct Stored<'a> {
    source: &'a Source,
    at: u64,
    end: u64,
}

impl Read for Stored<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
        let count = (self.end - self.at).min(buffer.len() as u64) as usize;
        let read = self.source.read_at(self.at, &mut buffer[..count]);
        read.map_err(|error| std::io::Error::other(error.to_string()))?;
        self.at += count as u64;
        Ok(count)
    }
}
