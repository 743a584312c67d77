//! The one way out: files that are there whole or not at all, and replace no input.

use crate::error::Error;
use crate::inputs::check_output;
use std::fs::File;
use std::io::Write;
use std::path::Path;

/// Writes a file beside its place and moves it there: whoever reads it, and whatever
/// stops the writing, the file of before or the whole new one is there.
///
/// # Errors
/// It would replace an input; the directory cannot be written, or is full. The file of
/// before is as it was.
pub fn write_whole(path: &Path, contents: &[u8]) -> Result<(), Error> {
    check_output(path)?;
    let mut name = path.file_name().unwrap_or_default().to_owned();
    name.push(format!(".{}.partial", std::process::id()));
    let partial = path.with_file_name(name);
    let written = File::create(&partial)
        .and_then(|mut file| file.write_all(contents).and_then(|()| file.sync_all()))
        .and_then(|()| std::fs::rename(&partial, path));
    written.map_err(|source| {
        let _ = std::fs::remove_file(&partial);
        Error::access(path, "write", source)
    })
}

/// [`write_whole`] of contents that are too large for the memory: `write` writes them into
/// the file beside the place.
///
/// # Errors
/// As [`write_whole`], and those of `write`.
pub fn write_streamed(
    path: &Path,
    write: impl FnOnce(&mut File) -> Result<(), Error>,
) -> Result<(), Error> {
    check_output(path)?;
    let mut name = path.file_name().unwrap_or_default().to_owned();
    name.push(format!(".{}.partial", std::process::id()));
    let partial = path.with_file_name(name);
    let failed = |source| Error::access(path, "write", source);
    let written = File::create(&partial).map_err(failed).and_then(|mut file| {
        write(&mut file)?;
        file.sync_all().map_err(failed)?;
        std::fs::rename(&partial, path).map_err(failed)
    });
    written.inspect_err(|_| {
        let _ = std::fs::remove_file(&partial);
    })
}

/// Makes a directory for results, with those above it.
///
/// # Errors
/// It would lie among recordings, or cannot be made.
pub fn make_directory(path: &Path) -> Result<(), Error> {
    check_output(path)?;
    std::fs::create_dir_all(path).map_err(|source| Error::access(path, "write", source))
}

/// Writes a file that does not exist yet.
///
/// # Errors
/// It exists already, or cannot be written.
pub fn write_new(path: &Path, contents: &[u8]) -> Result<(), Error> {
    let mut file = File::create_new(path).map_err(|source| create_error(path, source))?;
    file.write_all(contents)
        .map_err(|source| Error::access(path, "write", source))
}

/// Why a file or directory could not be made.
pub fn create_error(path: &Path, source: std::io::Error) -> Error {
    match source.kind() {
        std::io::ErrorKind::AlreadyExists => Error::AlreadyThere {
            path: path.to_path_buf(),
        },
        _ => Error::access(path, "create", source),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keeps_the_file_of_before_where_the_new_one_cannot_be_moved() {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("report.html");
        write_whole(&path, b"one").unwrap();
        write_whole(&path, b"two").unwrap();
        assert_eq!(std::fs::read(&path).unwrap(), b"two");
        // A directory stands where the file should go.
        let taken = directory.path().join("taken");
        std::fs::create_dir(&taken).unwrap();
        std::fs::write(taken.join("kept"), "kept").unwrap();
        let error = write_whole(&taken, b"three").unwrap_err().to_string();
        assert!(error.contains("taken: cannot write"), "{error}");
        assert!(taken.join("kept").exists());
        assert_eq!(std::fs::read_dir(directory.path()).unwrap().count(), 2);
    }
}
