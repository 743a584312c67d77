//! The bytes of one variable of a MAT file, compressed or not.

use flate2::read::ZlibDecoder;
use std::io::Read;
use windfall_source::error::{Error, Place};
use windfall_source::source::Source;

/// Bytes decompressed at a time while skipping.
const SKIP: usize = 1 << 15;

/// Location of a variable in the file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Region {
    /// Offset in the file.
    pub start: u64,
    /// Length in the file; bytes.
    pub length: u64,
    /// Whether compressed with zlib.
    pub compressed: bool,
}

/// The bytes of a variable, read at ascending offsets.
pub(crate) struct Flow<'a> {
    source: &'a Source,
    region: Region,
    inflater: Option<Inflater<'a>>,
}

struct Inflater<'a> {
    decoder: ZlibDecoder<Part<'a>>,
    at: u64,
}

/// A part of a file for [`Read`].
struct Part<'a> {
    source: &'a Source,
    at: u64,
    end: u64,
}

impl Read for Part<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
        let count = (self.end - self.at).min(buffer.len() as u64) as usize;
        let part = &mut buffer[..count];
        self.source
            .read_at(self.at, part)
            .map_err(std::io::Error::other)?;
        self.at += count as u64;
        Ok(count)
    }
}

impl<'a> Flow<'a> {
    /// Reads a region, which must lie within the file.
    pub fn new(source: &'a Source, region: Region) -> Self {
        let inflater = region.compressed.then(|| Inflater {
            decoder: ZlibDecoder::new(Part {
                source,
                at: region.start,
                end: region.start + region.length,
            }),
            at: 0,
        });
        Self {
            source,
            region,
            inflater,
        }
    }

    /// Fills `buffer` with bytes from `at`; compressed data can only be read forwards.
    pub fn read_at(&mut self, at: u64, buffer: &mut [u8]) -> Result<(), Error> {
        let (source, region) = (self.source, self.region);
        let Some(inflater) = &mut self.inflater else {
            let needed = at.saturating_add(buffer.len() as u64);
            if needed > region.length {
                return Err(source.malformed(
                    Place::Byte(region.start.saturating_add(at)),
                    format!(
                        "{} bytes are declared beyond the end of the variable",
                        needed - region.length
                    ),
                    ADVICE,
                ));
            }
            return source.read_at(region.start + at, buffer);
        };
        let mut passed = [0; SKIP];
        while inflater.at < at {
            let count = (at - inflater.at).min(SKIP as u64) as usize;
            inflater
                .decoder
                .read_exact(&mut passed[..count])
                .map_err(|error| damaged(source, region.start, &error))?;
            inflater.at += count as u64;
        }
        inflater
            .decoder
            .read_exact(buffer)
            .map_err(|error| damaged(source, region.start, &error))?;
        inflater.at += buffer.len() as u64;
        Ok(())
    }

    /// Reads the last bytes, which verifies the checksum of compressed data.
    pub fn finish(&mut self) -> Result<(), Error> {
        let mut rest = [0; 8];
        let (source, start) = (self.source, self.region.start);
        let Some(inflater) = &mut self.inflater else {
            return Ok(());
        };
        for _ in 0..8 {
            let count = inflater
                .decoder
                .read(&mut rest)
                .map_err(|error| damaged(source, start, &error))?;
            inflater.at += count as u64;
            if count == 0 {
                break;
            }
        }
        Ok(())
    }
}

fn damaged(source: &Source, start: u64, error: &std::io::Error) -> Error {
    source.malformed(
        Place::Byte(start),
        match error.kind() {
            std::io::ErrorKind::UnexpectedEof => {
                "the compressed data that begin here end too early".to_owned()
            }
            _ => format!("the compressed data that begin here are damaged ({error})"),
        },
        ADVICE,
    )
}

/// Advice for damaged data.
pub(crate) const ADVICE: &str =
    "the file is damaged: copy it again from where it was recorded, or save it again in MATLAB";
