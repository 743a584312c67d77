//! A file that grows with a run, and gets its name when it is whole.

use crate::file_error::access;
use crate::run::checkpoint::damaged;
use std::fs::{File, TryLockError};
use std::io::{BufWriter, ErrorKind, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use windfall_files::error::Error;
use windfall_files::write_file::check_target;
use windfall_files::written::{check_plain, check_written, is_written, list_written_as};

/// A growing file. Dropped before it is whole, it is removed unless a checkpoint needs it.
pub(crate) struct GrowingFile {
    path: PathBuf,
    file: BufWriter<File>,
    /// Whether what is not finished stays: a checkpoint resumes from it.
    pub keep: bool,
}

/// Where a file grows until it is whole.
pub(crate) fn partial_of(path: &Path) -> PathBuf {
    let mut name = path.as_os_str().to_owned();
    name.push(".partial");
    PathBuf::from(name)
}

/// Gives a file that was finished its other name again. A run that was stopped on its last
/// steps had finished some already.
///
/// # Errors
/// It is of somebody else, or cannot be renamed.
pub(crate) fn take_back(path: &Path) -> Result<(), Error> {
    let partial = partial_of(path);
    check_written(path, None)?;
    match !partial.exists() && path.is_file() {
        true => std::fs::rename(path, &partial).map_err(access(path, "write")),
        false => Ok(()),
    }
}

/// Removes a file of an earlier run, if windfall wrote it; a file of somebody else stays.
///
/// # Errors
/// It cannot be removed.
pub fn remove_earlier(path: &Path) -> Result<(), Error> {
    if !is_written(path, None).unwrap_or(false) {
        return Ok(());
    }
    match std::fs::remove_file(path) {
        Err(error) if error.kind() != ErrorKind::NotFound => Err(access(path, "replace")(error)),
        _ => Ok(()),
    }
}

impl GrowingFile {
    /// Opens the file as it is.
    pub fn open(path: &Path) -> Result<Self, Error> {
        check_target(path)?;
        check_plain(&partial_of(path))?;
        let mut options = File::options();
        let file = options
            .create(true)
            .truncate(false)
            .write(true)
            .open(partial_of(path));
        Ok(Self {
            path: path.to_path_buf(),
            file: BufWriter::new(file.map_err(access(path, "write"))?),
            keep: true,
        })
    }

    /// Whether another program holds it; otherwise this one does from now on. A system without
    /// locks does without.
    pub fn is_busy(&self) -> bool {
        let locked = self.file.get_ref().try_lock();
        matches!(locked, Err(TryLockError::WouldBlock))
    }

    /// Cuts off what is behind `length` bytes.
    pub fn cut(&mut self, length: u64) -> Result<(), Error> {
        let cut = self.file.get_ref().set_len(length);
        let cut = cut.and_then(|()| self.file.seek(SeekFrom::Start(length)));
        cut.map_err(access(&self.path, "write"))?;
        self.keep = length > 0;
        Ok(())
    }

    /// Refuses to resume a file that has fewer bytes than the checkpoint counts on.
    ///
    /// * `what`: "the table"
    pub fn check_length(path: &Path, what: &str, length: u64) -> Result<(), Error> {
        let partial = partial_of(path);
        let there = std::fs::metadata(&partial).map_or(0, |own| own.len());
        match there < length {
            true => {
                let problem = format!(
                    "{what} has {there} bytes, and the checkpoint goes on behind {length} of them"
                );
                Err(damaged(&partial, problem))
            }
            false => Ok(()),
        }
    }

    /// Adds to it.
    pub fn write(&mut self, bytes: impl AsRef<[u8]>) -> Result<(), Error> {
        let written = self.file.write_all(bytes.as_ref());
        written.map_err(access(&self.path, "write"))
    }

    /// Lets readers see all so far.
    pub fn flush(&mut self) -> Result<(), Error> {
        self.file.flush().map_err(access(&self.path, "write"))
    }

    /// Brings all so far to the disk; its length in bytes.
    pub fn sync(&mut self) -> Result<u64, Error> {
        let file = &mut self.file;
        file.flush()
            .and_then(|()| file.get_ref().sync_all())
            .and_then(|()| file.stream_position())
            .map_err(access(&self.path, "write"))
    }

    /// Gives the file its name; which it is.
    pub fn finish(&mut self) -> Result<PathBuf, Error> {
        self.sync()?;
        let partial = partial_of(&self.path);
        list_written_as(&self.path, &partial)?;
        let renamed = std::fs::rename(partial, &self.path);
        renamed.map_err(access(&self.path, "write"))?;
        // There is nothing under the other name any more.
        self.keep = true;
        Ok(self.path.clone())
    }
}

impl Drop for GrowingFile {
    fn drop(&mut self) {
        if !self.keep {
            let _ = std::fs::remove_file(partial_of(&self.path));
        }
    }
}
