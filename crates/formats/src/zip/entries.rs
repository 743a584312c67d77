//! Reads entries of a zip archive as streams.

use flate2::read::DeflateDecoder;
use rawzip::{CompressionMethod, ReaderAt, ZipArchive, ZipArchiveEntryWayfinder, ZipLocator};
use std::io::{BufReader, Read};
use windfall_source::error::{Error, Place};
use windfall_source::source::Source;

const MOST_ENTRIES: usize = 1 << 18;

/// Most bytes that are unpacked into memory, of all entries together.
pub const MOST_UNPACKED: u64 = 1 << 29;

/// Bytes that one packed byte can stand for, at most: deflate's longest match, in two bits.
const MOST_PER_BYTE: u64 = 1032;

#[derive(Clone, Debug)]
pub struct Entry {
    pub name: String,
    /// Declared size; bytes.
    pub size: u64,
    /// Declared size in the archive; bytes.
    packed: u64,
    crc: u32,
    method: CompressionMethod,
    /// Offset of the local header.
    header: u64,
    place: ZipArchiveEntryWayfinder,
}

/// The bytes of an archive, read by `rawzip`.
#[derive(Debug)]
pub struct Packed(Source);

/// An opened archive.
pub type Archive = ZipArchive<Packed>;

impl std::ops::Deref for Packed {
    type Target = Source;

    fn deref(&self) -> &Source {
        &self.0
    }
}

impl ReaderAt for Packed {
    fn read_at(&self, buffer: &mut [u8], offset: u64) -> std::io::Result<usize> {
        let left = self.length().saturating_sub(offset);
        let count = left.min(buffer.len() as u64) as usize;
        if count > 0 {
            let buffer = &mut buffer[..count];
            self.0
                .read_at(offset, buffer)
                .map_err(std::io::Error::other)?;
        }
        Ok(count)
    }
}

fn malformed(source: &Source, at: u64, problem: &str) -> Error {
    let advice = "the archive is damaged; copy or export it again";
    source.malformed(Place::Byte(at), problem, advice)
}

/// Opens an archive and lists its entries in the order of its directory.
pub fn open_archive(source: Source) -> Result<(Archive, Vec<Entry>), Error> {
    let mut buffer = vec![0; rawzip::MAX_CENTRAL_DIRECTORY_RECORD_SIZE];
    let length = source.length();
    let archive = ZipLocator::new().locate_in_reader(Packed(source), &mut buffer, length);
    let archive = archive.map_err(|(Packed(source), _)| {
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
            packed: entry.compressed_size_hint(),
            crc: entry.crc32(),
            method: entry.compression_method(),
            header: entry.local_header_offset(),
            place: entry.wayfinder(),
        });
    }
    Ok((archive, entries))
}

/// Opens an entry as a stream.
pub fn open_entry<'a>(archive: &'a Archive, entry: &Entry) -> Result<Box<dyn Read + 'a>, Error> {
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
            "unpack it and pack it again as an ordinary zip archive",
        )),
    }
}

/// Refuses entries that would need more memory than [`MOST_UNPACKED`], also those that hold
/// more than they declare.
///
/// # Errors
/// They would, one is damaged, or the file cannot be read.
pub fn check_sizes(archive: &Archive, entries: &[&Entry]) -> Result<(), Error> {
    let source = archive.get_ref();
    let declared = entries
        .iter()
        .fold(0_u64, |sum, e| sum.saturating_add(e.size));
    if declared > MOST_UNPACKED {
        return Err(source.unsupported(
            Place::File,
            format!(
                "archives of more than {} MiB of tables (this one unpacks to {} MiB)",
                MOST_UNPACKED >> 20,
                declared >> 20
            ),
            "export the recording as CSV, or as several files",
        ));
    }
    let packed = entries
        .iter()
        .fold(0_u64, |sum, e| sum.saturating_add(e.packed));
    if packed.saturating_mul(MOST_PER_BYTE) <= MOST_UNPACKED {
        return Ok(());
    }
    for entry in entries {
        let mut stream = open_entry(archive, entry)?.take(entry.size + 1);
        let unpacked = std::io::copy(&mut stream, &mut std::io::sink());
        if !unpacked.is_ok_and(|bytes| bytes == entry.size) {
            return Err(damaged(source, entry));
        }
    }
    Ok(())
}

/// An entry in memory, checked against its size and checksum; see [`check_sizes`].
///
/// # Errors
/// It is damaged, too large, or packed in an unusual way; or the file cannot be read.
pub fn read_entry(archive: &Archive, entry: &Entry) -> Result<Vec<u8>, Error> {
    check_sizes(archive, &[entry])?;
    let source = archive.get_ref();
    let mut bytes = Vec::new();
    let mut stream = open_entry(archive, entry)?.take(entry.size + 1);
    let read = stream.read_to_end(&mut bytes);
    let mut crc = flate2::Crc::new();
    crc.update(&bytes);
    match read {
        Ok(_) if bytes.len() as u64 == entry.size && crc.sum() == entry.crc => Ok(bytes),
        _ => Err(damaged(source, entry)),
    }
}

fn damaged(source: &Source, entry: &Entry) -> Error {
    source.malformed(
        Place::Object(entry.name.clone()),
        "the contents do not fit the size or checksum that the archive gives",
        "the archive is damaged; copy or export it again",
    )
}
