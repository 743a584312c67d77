//! Picks the reader for a file by its first bytes.

use crate::contents::Format;
use crate::foreign::refuse_foreign;
use crate::hdf5::read::Hdf5Reader;
use crate::mat::read::MatReader;
use crate::npy::read::NpyReader;
use crate::reader::Reader;
use crate::sheet::read::{open_ods, open_xlsx};
use crate::sigrok::read::SigrokReader;
use crate::tables::stacked::open_text;
use crate::tdms::read::TdmsReader;
use crate::text::lvm::LvmReader;
use crate::text::options::TextOptions;
use crate::uff::read::UffReader;
use crate::wav::read::WavReader;
use crate::zip::entries::open_archive;
use crate::zip::texts::{is_text, open_zip};
use std::path::Path;
use windfall_source::error::Error;
use windfall_source::source::Source;

/// Bytes used to detect the format.
const HEAD: u64 = 4096;

/// How to read a file where it does not say so itself.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct OpenOptions {
    /// The format; `None` to detect it.
    pub format: Option<Format>,
    /// Dialect of text tables.
    pub text: TextOptions,
}

/// Opens a file with the reader for its format.
///
/// # Errors
/// The file cannot be read, has an unknown format, or violates its format.
pub fn open(path: &Path, options: &OpenOptions) -> Result<Box<dyn Reader>, Error> {
    open_source(Source::open(path)?, options)
}

/// Opens bytes with the reader for their format; errors as in [`open`].
pub fn open_source(source: Source, options: &OpenOptions) -> Result<Box<dyn Reader>, Error> {
    let format = match options.format {
        Some(format) => format,
        None => tell_format(&source)?,
    };
    match format {
        Format::Text => open_text(source, &options.text),
        Format::Lvm => Ok(Box::new(LvmReader::open(source, &options.text)?)),
        Format::Wav => Ok(Box::new(WavReader::open(source)?)),
        Format::Tdms => Ok(Box::new(TdmsReader::open(source)?)),
        Format::Hdf5 => Ok(Box::new(Hdf5Reader::open(source)?)),
        Format::Mat => Ok(Box::new(MatReader::open(source)?)),
        Format::Uff58 => Ok(Box::new(UffReader::open(source)?)),
        Format::Sigrok => Ok(Box::new(SigrokReader::open(source)?)),
        Format::Xlsx => Ok(Box::new(open_xlsx(source, &options.text)?)),
        Format::Ods => Ok(Box::new(open_ods(source, &options.text)?)),
        Format::Npy => Ok(Box::new(NpyReader::open(source)?)),
        Format::Zip => Ok(Box::new(open_zip(source, &options.text)?)),
    }
}

/// Detects the format of a file from its first bytes.
///
/// # Errors
/// The file cannot be read, is empty, or has a known but unsupported format.
pub fn tell_format(source: &Source) -> Result<Format, Error> {
    let head = source.head(HEAD)?;
    if head.is_empty() {
        return Err(Error::Empty {
            path: source.path().to_path_buf(),
            expected: "a recording",
        });
    }
    refuse_foreign(source, &head)?;
    if head.starts_with(b"PK\x03\x04") {
        return tell_archive(source);
    }
    if head.starts_with(b"TDSm") || head.starts_with(b"TDSh") {
        return Ok(Format::Tdms);
    }
    if let Some(tag) = head.get(..4)
        && [b"RIFF", b"RIFX", b"RF64"].iter().any(|t| *t == tag)
    {
        return Ok(Format::Wav);
    }
    // Before MATLAB, as version 7.3 files match both.
    if crate::hdf5::read::begins(&head) {
        return Ok(Format::Hdf5);
    }
    if crate::mat::read::begins(&head) {
        return Ok(Format::Mat);
    }
    if crate::npy::read::begins(&head) {
        return Ok(Format::Npy);
    }
    if is_universal(&head) {
        return Ok(Format::Uff58);
    }
    if head.starts_with(b"LabVIEW Measurement") {
        return Ok(Format::Lvm);
    }
    Ok(Format::Text)
}

/// Detects the format of a zip archive from the names of its members.
fn tell_archive(source: &Source) -> Result<Format, Error> {
    let (_, entries) = open_archive(source.part(0, source.length()))?;
    let has = |test: &dyn Fn(&str) -> bool| entries.iter().any(|entry| test(&entry.name));
    if has(&|name| name == "xl/workbook.xml") {
        return Ok(Format::Xlsx);
    }
    if has(&|name| name == "content.xml") {
        return Ok(Format::Ods);
    }
    if has(&|name| name.ends_with(".npy")) {
        return Ok(Format::Npy);
    }
    if !has(&|name| name == "metadata") && has(&is_text) {
        return Ok(Format::Zip);
    }
    Ok(Format::Sigrok)
}

/// A universal file begins with "    -1" and, on the next line, a data set number.
fn is_universal(head: &[u8]) -> bool {
    let text = String::from_utf8_lossy(head);
    let mut lines = text.lines().skip_while(|line| line.trim().is_empty());
    let first = lines
        .next()
        .is_some_and(|line| line.trim() == "-1" && line.starts_with("   "));
    let set = lines.next().map(str::trim_start).unwrap_or_default();
    first && set.starts_with(|c: char| c.is_ascii_digit())
}
