//! Random access to the bytes of a file.

use crate::error::{Error, Place};
use crate::stream::{is_stream, stream_bytes};
use std::borrow::Cow;
use std::fs::File;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Files up to this length are read at once: it costs less than looking at their parts; bytes.
const SMALL: u64 = 1 << 18;

/// The bytes of a file, which threads can read at once.
#[derive(Debug)]
pub struct Source {
    path: PathBuf,
    /// First byte of the part that this is; 0 for a whole file.
    start: u64,
    length: u64,
    bytes: Bytes,
}

#[derive(Clone, Debug)]
enum Bytes {
    File(Arc<File>),
    Memory(Arc<[u8]>),
}

impl Source {
    /// Opens a file, or reads a stream to its end.
    ///
    /// # Errors
    /// It does not exist, is a directory, or cannot be opened.
    pub fn open(path: &Path) -> Result<Self, Error> {
        let access = |source: std::io::Error| match source.kind() {
            std::io::ErrorKind::NotFound => Error::Absent {
                path: path.to_path_buf(),
            },
            _ => Error::Access {
                path: path.to_path_buf(),
                source,
            },
        };
        if is_stream(path) {
            let bytes = stream_bytes(path).map_err(access)?;
            return Ok(Self::of_bytes(path, bytes));
        }
        let file = File::open(path).map_err(access)?;
        let metadata = file.metadata().map_err(access)?;
        if metadata.is_dir() {
            return Err(Error::UnknownFormat {
                path: path.to_path_buf(),
                found: "this is a directory".to_owned(),
                advice: "name a file in it".to_owned(),
            });
        }
        let whole = Self {
            path: path.to_path_buf(),
            start: 0,
            length: metadata.len(),
            bytes: Bytes::File(Arc::new(file)),
        };
        match whole.length <= SMALL {
            true => Ok(Self::of_bytes(
                path,
                whole.bytes_at(0, whole.length)?.into(),
            )),
            false => Ok(whole),
        }
    }

    /// Wraps bytes in memory, with a name for messages.
    pub fn from_bytes(name: &str, bytes: Vec<u8>) -> Self {
        Self::of_bytes(Path::new(name), bytes.into())
    }

    /// [`Source::from_bytes`] of bytes that others hold too.
    pub fn of_bytes(path: &Path, bytes: Arc<[u8]>) -> Self {
        Self {
            path: path.to_path_buf(),
            start: 0,
            length: bytes.len() as u64,
            bytes: Bytes::Memory(bytes),
        }
    }

    /// The bytes from `start` to `end` as a source of their own; what lies beyond the end of
    /// this one is left off.
    pub fn part(&self, start: u64, end: u64) -> Self {
        let start = start.min(self.length);
        Self {
            path: self.path.clone(),
            start: self.start + start,
            length: end.min(self.length).saturating_sub(start),
            bytes: self.bytes.clone(),
        }
    }

    /// The file, for messages.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Number of bytes.
    pub fn length(&self) -> u64 {
        self.length
    }

    /// Fills `buffer` from `offset`.
    ///
    /// # Errors
    /// [`Error::Truncated`] if the file is too short; [`Error::Access`].
    pub fn read_at(&self, offset: u64, buffer: &mut [u8]) -> Result<(), Error> {
        let left = self.length.saturating_sub(offset);
        let needed = buffer.len() as u64;
        if needed > left || offset > self.length {
            return Err(self.truncated(offset, "the data here", needed));
        }
        let file = match &self.bytes {
            Bytes::Memory(bytes) => {
                let start = (self.start + offset) as usize;
                buffer.copy_from_slice(&bytes[start..start + buffer.len()]);
                return Ok(());
            }
            Bytes::File(file) => file,
        };
        read_exact_at(file, self.start + offset, buffer).map_err(|source| {
            // The file has shrunk since it was opened.
            if source.kind() == std::io::ErrorKind::UnexpectedEof {
                return self.truncated(offset, "the data here", needed);
            }
            Error::Access {
                path: self.path.clone(),
                source,
            }
        })
    }

    /// `count` bytes from `offset`, checked before allocating; errors as in [`Source::read_at`].
    pub fn bytes_at(&self, offset: u64, count: u64) -> Result<Vec<u8>, Error> {
        if offset > self.length || count > self.length - offset {
            return Err(self.truncated(offset, "the data here", count));
        }
        if let Some(bytes) = self.in_memory(offset, count) {
            return Ok(bytes.to_vec());
        }
        let mut buffer = vec![0; count as usize];
        self.read_at(offset, &mut buffer)?;
        Ok(buffer)
    }

    /// The first `count` bytes, or fewer if the file is shorter; errors as in
    /// [`Source::read_at`].
    pub fn head(&self, count: u64) -> Result<Cow<'_, [u8]>, Error> {
        let count = count.min(self.length);
        match self.in_memory(0, count) {
            Some(bytes) => Ok(bytes.into()),
            None => Ok(self.bytes_at(0, count)?.into()),
        }
    }

    /// Bytes that were read when the source was opened; `None` where they were not, or lie
    /// beyond its end.
    pub fn in_memory(&self, offset: u64, count: u64) -> Option<&[u8]> {
        let Bytes::Memory(bytes) = &self.bytes else {
            return None;
        };
        if count > self.length.checked_sub(offset)? {
            return None;
        }
        let start = (self.start + offset) as usize;
        Some(&bytes[start..start + count as usize])
    }

    /// Error: `what`, at `offset`, extends beyond the end of the file.
    pub fn truncated(&self, offset: u64, what: &str, needed: u64) -> Error {
        Error::Truncated {
            path: self.path.clone(),
            place: Place::Byte(self.start.saturating_add(offset)),
            what: what.to_owned(),
            needed,
            left: self.length.saturating_sub(offset),
        }
    }

    /// Error: the bytes at a place break the rules of their format.
    pub fn malformed(&self, place: Place, problem: impl Into<String>, advice: &str) -> Error {
        Error::Malformed {
            path: self.path.clone(),
            place,
            problem: problem.into(),
            advice: advice.to_owned(),
        }
    }

    /// Error: the file uses an unsupported part of its format.
    pub fn unsupported(&self, place: Place, what: impl Into<String>, advice: &str) -> Error {
        Error::Unsupported {
            path: self.path.clone(),
            place,
            what: what.into(),
            advice: advice.to_owned(),
        }
    }

    /// Error: the format is unknown or unsupported.
    pub fn unknown(&self, found: impl Into<String>, advice: &str) -> Error {
        Error::UnknownFormat {
            path: self.path.clone(),
            found: found.into(),
            advice: advice.to_owned(),
        }
    }
}

#[cfg(unix)]
fn read_exact_at(file: &File, offset: u64, buffer: &mut [u8]) -> std::io::Result<()> {
    std::os::unix::fs::FileExt::read_exact_at(file, buffer, offset)
}

#[cfg(windows)]
fn read_exact_at(file: &File, offset: u64, buffer: &mut [u8]) -> std::io::Result<()> {
    use std::os::windows::fs::FileExt;
    let mut done = 0;
    while done < buffer.len() {
        match file.seek_read(&mut buffer[done..], offset + done as u64)? {
            0 => return Err(std::io::ErrorKind::UnexpectedEof.into()),
            n => done += n,
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn closed_form_bytes_of_a_file_and_of_memory() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("a.bin");
        std::fs::write(&path, b"0123456789").unwrap();
        for source in [
            Source::open(&path).unwrap(),
            Source::from_bytes("a.bin", b"0123456789".to_vec()),
        ] {
            assert_eq!(source.length(), 10);
            assert_eq!(source.bytes_at(3, 4).unwrap(), b"3456");
            assert_eq!(*source.head(99).unwrap(), *b"0123456789");
            let part = source.part(2, 99).part(1, 4);
            assert_eq!(part.length(), 3);
            assert_eq!(*part.head(99).unwrap(), *b"345");
            let beyond = part.bytes_at(2, 2).unwrap_err().to_string();
            assert!(beyond.contains("at byte 5"), "{beyond}");
            assert_eq!(source.part(11, 5).length(), 0);
        }
    }

    #[test]
    fn rejects_bytes_beyond_the_end_before_allocating() {
        let source = Source::from_bytes("a.bin", vec![0; 10]);
        let error = source.bytes_at(4, u64::MAX).unwrap_err();
        assert_eq!(
            error.to_string(),
            "a.bin, at byte 4: the file ends too early: the data here needs \
             18446744073709551615 bytes, 6 are left; it was cut off while it was written or copied"
        );
        assert!(source.bytes_at(u64::MAX, 1).is_err());
        // Zero bytes beyond the end: a crash found by fuzzing.
        assert!(source.bytes_at(11, 0).is_err());
        assert_eq!(source.bytes_at(10, 0).unwrap(), b"");
    }
}
