//! Reads entries of a zip archive as streams.

use crate::error::{Error, Place};
use crate::source::Source;
use flate2::read::DeflateDecoder;
use rawzip::{CompressionMethod, ReaderAt, ZipArchive, ZipArchiveEntryWayfinder, ZipLocator};
use std::io::{BufReader, Read};

const MOST_ENTRIES: usize = 1 << 18;

#[derive(Clone, Debug)]
pub struct Entry {
    pub name: String,
    /// Declared size; bytes.
    pub size: u64,
    method: CompressionMethod,
    /// Offset of the local header.
    header: u64,
    place: ZipArchiveEntryWayfinder,
}

impl ReaderAt for Source {
    fn read_at(&self, buffer: &mut [u8], offset: u64) -> std::io::Result<usize> {
        let left = self.length().saturating_sub(offset);
        let count = left.min(buffer.len() as u64) as usize;
        if count > 0 {
            Source::read_at(self, offset, &mut buffer[..count]).map_err(std::io::Error::other)?;
        }
        Ok(count)
    }
}

fn malformed(source: &Source, at: u64, problem: &str) -> Error {
    let advice = "the archive is damaged; copy or export the capture again";
    source.malformed(Place::Byte(at), problem, advice)
}

/// Opens an archive and lists its entries in the order of its directory.
pub fn open_archive(source: Source) -> Result<(ZipArchive<Source>, Vec<Entry>), Error> {
    let mut buffer = vec![0; rawzip::MAX_CENTRAL_DIRECTORY_RECORD_SIZE];
    let length = source.length();
    let archive = ZipLocator::new().locate_in_reader(source, &mut buffer, length);
    let archive = archive.map_err(|(source, _)| {
        let problem = "the archive has no directory at its end, or a damaged one";
        malformed(&source, length, problem)
    })?;
    let mut entries = Vec::new();
    let mut directory = archive.entries(&mut buffer);
    let damaged = |_| {
        let problem = "the directory of the archive that begins here is damaged";
        malformed(archive.get_ref(), archive.directory_offset(), problem)
    };
    while let Some(entry) = directory.next_entry().map_err(damaged)?
        && entries.len() < MOST_ENTRIES
    {
        entries.push(Entry {
            name: String::from_utf8_lossy(entry.file_path().as_bytes()).into_owned(),
            size: entry.uncompressed_size_hint(),
            method: entry.compression_method(),
            header: entry.local_header_offset(),
            place: entry.wayfinder(),
        });
    }
    Ok((archive, entries))
}

/// Opens an entry as a stream.
pub fn open_entry<'a>(
    archive: &'a ZipArchive<Source>,
    entry: &Entry,
) -> Result<Box<dyn Read + 'a>, Error> {
    let source = archive.get_ref();
    let found = archive
        .get_entry(entry.place)
        .map_err(|_| malformed(source, entry.header, "expected the header of an entry"))?;
    let (begin, end) = found.compressed_data_range();
    if end > source.length() {
        let what = format!("the entry {}", entry.name);
        return Err(source.truncated(begin, &what, end - begin));
    }
    let stored = BufReader::new(found.reader());
    match entry.method {
        CompressionMethod::STORE => Ok(Box::new(stored)),
        CompressionMethod::DEFLATE => Ok(Box::new(DeflateDecoder::new(stored))),
        other => Err(source.unsupported(
            Place::Object(entry.name.clone()),
            format!("entries compressed by method {}", other.as_u16()),
            "save the capture again",
        )),
    }
}
