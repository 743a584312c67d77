//! Bytes of a MAT file in sequence, as they stand or inflated.

use crate::error::Error;
use crate::source::Source;
use flate2::read::ZlibDecoder;
use std::io::{BufReader, Read};

/// Bytes skipped at once where they must be inflated.
const SKIP: usize = 1 << 14;

/// Where elements of a MAT file stand.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Room {
    /// In the file as they are, from this byte to that.
    Plain(u64, u64),
    /// Inflated from this byte of the file to that.
    Deflated(u64, u64),
}

/// Bytes in sequence. Errors of the format are told by the caller.
pub struct Stream<'a> {
    inner: Inner<'a>,
    position: u64,
}

enum Inner<'a> {
    Plain(BufReader<SourceRead<'a>>),
    Deflated(Box<BufReader<ZlibDecoder<SourceRead<'a>>>>),
}

/// Why a stream stops.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Ended;

struct SourceRead<'a> {
    source: &'a Source,
    at: u64,
    end: u64,
}

impl Read for SourceRead<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
        let count = (self.end.saturating_sub(self.at)).min(buffer.len() as u64) as usize;
        let read = self.source.read_at(self.at, &mut buffer[..count]);
        read.map_err(|error| match error {
            Error::Access { source, .. } => source,
            _ => std::io::ErrorKind::UnexpectedEof.into(),
        })?;
        self.at += count as u64;
        Ok(count)
    }
}

impl<'a> Stream<'a> {
    /// The bytes of a room.
    #[must_use]
    pub fn new(source: &'a Source, room: Room) -> Self {
        let read = |at, end| SourceRead { source, at, end };
        let inner = match room {
            Room::Plain(at, end) => Inner::Plain(BufReader::new(read(at, end))),
            Room::Deflated(at, end) => {
                Inner::Deflated(Box::new(BufReader::new(ZlibDecoder::new(read(at, end)))))
            }
        };
        Self { inner, position: 0 }
    }

    /// Bytes taken so far.
    #[must_use]
    pub fn position(&self) -> u64 {
        self.position
    }

    /// Fills `buffer`.
    ///
    /// # Errors
    /// The bytes end before, or cannot be inflated.
    pub fn fill(&mut self, buffer: &mut [u8]) -> Result<(), Ended> {
        let read = match &mut self.inner {
            Inner::Plain(inner) => inner.read_exact(buffer),
            Inner::Deflated(inner) => inner.read_exact(buffer),
        };
        read.map_err(|_| Ended)?;
        self.position += buffer.len() as u64;
        Ok(())
    }

    /// Passes over `count` bytes.
    ///
    /// # Errors
    /// The bytes end before, or cannot be inflated.
    pub fn skip(&mut self, count: u64) -> Result<(), Ended> {
        match &mut self.inner {
            Inner::Plain(inner) => {
                let room = inner.get_ref();
                let left = room.end - room.at + inner.buffer().len() as u64;
                if count > left {
                    return Err(Ended);
                }
                let buffered = count.min(inner.buffer().len() as u64);
                std::io::BufRead::consume(inner, buffered as usize);
                inner.get_mut().at += count - buffered;
                self.position += count;
                Ok(())
            }
            Inner::Deflated(_) => {
                let mut left = count;
                let mut bytes = [0; SKIP];
                while left > 0 {
                    let part = left.min(SKIP as u64) as usize;
                    self.fill(&mut bytes[..part])?;
                    left -= part as u64;
                }
                Ok(())
            }
        }
    }
}
