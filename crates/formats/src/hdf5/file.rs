//! HDF5 files: superblock and access by address.
//!
//! # Source
//! The HDF Group (2023), "HDF5 File Format Specification 3.0", for all files of this
//! folder.

use crate::hdf5::checksum::lookup3;
use crate::hdf5::cursor::{Cursor, Problem, Widths};
use std::borrow::Cow;
use windfall_source::error::{Error, Place};
use windfall_source::source::Source;

/// Signature of HDF5: at byte 0, or after a user block at 512, 1024, 2048 and so on.
const SIGNATURE: &[u8; 8] = b"\x89HDF\r\n\x1a\n";

/// Largest single read; bytes.
const LARGEST: u64 = 256 << 20;

#[derive(Debug)]
pub(crate) struct Hdf5File {
    pub source: Source,
    /// Offset of address 0 in the file.
    pub base: u64,
    pub widths: Widths,
    pub version: u8,
    pub root: u64,
    /// Length of the file when it was closed.
    pub end: u64,
}

/// Whether a file starts like an HDF5 file.
pub(crate) fn begins(head: &[u8]) -> bool {
    [0, 512, 1024, 2048].iter().any(|at| {
        head.get(*at..)
            .is_some_and(|rest| rest.starts_with(SIGNATURE))
    })
}

impl Hdf5File {
    /// Reads the superblock.
    pub fn open(source: Source) -> Result<Self, Error> {
        if source.length() == 0 {
            return Err(Error::Empty {
                path: source.path().to_path_buf(),
                expected: "a recording",
            });
        }
        let at = find_signature(&source)?;
        let path = source.path().to_path_buf();
        read_superblock(source, at).map_err(|problem| error_of(&path, None, problem))
    }

    pub fn bytes(&self, address: u64, count: u64) -> Result<Vec<u8>, Problem> {
        let at = self.base.saturating_add(address);
        if count > self.source.length().saturating_sub(at) {
            return Err(Problem::Damaged(
                at,
                format!("{count} bytes are declared here, beyond the end of the file"),
            ));
        }
        if count > LARGEST {
            let what = format!("pieces of {count} bytes");
            return Err(Problem::Unsupported(what));
        }
        Ok(self.source.bytes_at(at, count)?)
    }

    /// Reads a structure, verifying its signature and the checksum at its end.
    pub fn checked(
        &self,
        address: u64,
        count: u64,
        signature: &[u8; 4],
    ) -> Result<Cursor<'static>, Problem> {
        let mut cursor = self.checked_page(address, count)?;
        cursor.signature(signature)?;
        Ok(cursor)
    }

    /// Like [`Self::checked`], without a signature.
    pub fn checked_page(&self, address: u64, count: u64) -> Result<Cursor<'static>, Problem> {
        let bytes = self.bytes(address, count)?;
        self.check(&bytes, address)?;
        Ok(self.cursor(bytes, address))
    }

    /// Up to `count` bytes at an address.
    pub fn bytes_up_to(&self, address: u64, count: u64) -> Result<Vec<u8>, Problem> {
        let at = self.base.saturating_add(address);
        let left = self.source.length().saturating_sub(at);
        self.bytes(address, count.min(left).max(1))
    }

    /// A cursor over bytes read at an address.
    pub fn cursor<'a>(&self, bytes: impl Into<Cow<'a, [u8]>>, address: u64) -> Cursor<'a> {
        Cursor::new(bytes, self.base.saturating_add(address), self.widths)
    }

    /// Verifies the checksum in the last four bytes.
    pub fn check(&self, bytes: &[u8], address: u64) -> Result<(), Problem> {
        let problem =
            |what: &str| Problem::Damaged(self.base.saturating_add(address), what.to_owned());
        let split = bytes.len().checked_sub(4);
        let (body, sum) = bytes.split_at(split.ok_or_else(|| problem("a checksum is missing"))?);
        match lookup3(body).to_le_bytes() == sum {
            true => Ok(()),
            false => Err(problem(
                "the structure that begins here has a wrong checksum",
            )),
        }
    }

    /// Converts a problem while reading `object` to an error.
    pub fn error(&self, object: &str, problem: Problem) -> Error {
        error_of(self.source.path(), Some(object), problem)
    }
}

fn find_signature(source: &Source) -> Result<u64, Error> {
    let mut at = 0;
    while at + 8 <= source.length() {
        if source.bytes_at(at, 8)? == SIGNATURE {
            return Ok(at);
        }
        at = if at == 0 { 512 } else { at * 2 };
    }
    Err(source.malformed(
        Place::Byte(0),
        "expected the signature of HDF5; this is not an HDF5 file",
        "let windfall detect the format",
    ))
}

fn read_superblock(source: Source, at: u64) -> Result<Hdf5File, Problem> {
    let head = source.bytes_at(at, (source.length() - at).min(128))?;
    let narrow = Widths {
        address: 8,
        length: 8,
    };
    let mut cursor = Cursor::new(&head[..], at, narrow);
    cursor.skip(8)?;
    let version = cursor.version("the superblock", &[0, 1, 2, 3])?;
    if version < 2 {
        cursor.skip(4)?;
    }
    let widths = Widths {
        address: usize::from(cursor.u8()?),
        length: usize::from(cursor.u8()?),
    };
    if ![2, 4, 8].contains(&widths.address) || ![2, 4, 8].contains(&widths.length) {
        return Err(cursor.damaged("addresses or lengths are not 2, 4 or 8 bytes long"));
    }
    // Older versions have node sizes and flags, newer ones flags.
    cursor.skip(match version {
        0 => 1 + 4 + 4,
        1 => 1 + 4 + 4 + 4,
        _ => 1,
    })?;
    let mut cursor = Cursor::new(&head[cursor.place()..], cursor.at(), widths);
    let base = cursor.address()?.unwrap_or(0);
    cursor.address()?;
    let end = cursor.address()?.unwrap_or(0);
    if version < 2 {
        // Driver information, and the name offset of the root group.
        cursor.address()?;
        cursor.address()?;
    }
    let root = cursor.address()?;
    let root = root.ok_or_else(|| cursor.damaged("the file has no root group"))?;
    // Programs that write a user block may leave 0 here.
    let base = if base == 0 { at } else { base };
    Ok(Hdf5File {
        source,
        base,
        widths,
        version,
        root,
        end,
    })
}

/// Advice for damaged files.
const ADVICE: &str =
    "the file is damaged or was not closed: copy it again from where it was recorded";

fn error_of(path: &std::path::Path, object: Option<&str>, problem: Problem) -> Error {
    let path = path.to_path_buf();
    match problem {
        Problem::Source(error) => error,
        Problem::Damaged(at, what) => Error::Malformed {
            path,
            place: Place::Byte(at),
            problem: match object {
                Some(name) => format!("in \"{name}\": {what}"),
                None => what,
            },
            advice: ADVICE.to_owned(),
        },
        Problem::Unsupported(what) => Error::Unsupported {
            path,
            place: object.map_or(Place::File, |name| Place::Object(name.to_owned())),
            what,
            advice: "save the file without it, for example with h5repack, or as CSV".to_owned(),
        },
    }
}

/// Describes a problem as the reason for leaving something out.
pub(crate) fn reason(problem: &Problem) -> String {
    match problem {
        Problem::Damaged(at, what) => format!("it is damaged: {what} (byte {at})"),
        Problem::Unsupported(what) => format!("windfall does not read {what}"),
        Problem::Source(error) => format!("it cannot be read: {error}"),
    }
}
