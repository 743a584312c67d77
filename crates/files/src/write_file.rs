//! The one way out: files that are there whole or not at all, and replace nothing of the user's.

use crate::error::Error;
use crate::inputs::{check_output, note_written};
use crate::option_value::unusable;
use crate::written::{PARTIAL, check_written, is_own_file, list_written, list_written_as};
use std::collections::BTreeSet;
use std::fs::File;
use std::io::{ErrorKind, Result as IoResult, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};

/// Refuses, before the work, a file or directory that may not be written or replaced.
///
/// # Errors
/// It would replace an input or a file that windfall did not write, or lie among recordings.
pub fn check_target(path: &Path) -> Result<(), Error> {
    check_name(path)?;
    check_output(path)?;
    check_written(&behind_links(path), None)
}

/// Refuses names that no result may have.
fn check_name(path: &Path) -> Result<(), Error> {
    let problem = match () {
        () if path == Path::new("-") => {
            "no file is written under this name, which stands for a pipe; name a file, or ./-"
        }
        () if is_own_file(path) => {
            "windfall keeps files of this name for itself; choose another name"
        }
        () => return Ok(()),
    };
    Err(unusable(path.display().to_string(), problem))
}

/// [`check_target`] of those files and directories that a command was given.
///
/// # Errors
/// Those of [`check_target`].
pub fn check_outputs<'a>(paths: impl IntoIterator<Item = Option<&'a Path>>) -> Result<(), Error> {
    paths.into_iter().flatten().try_for_each(check_target)
}

/// Writes a result: the file of before or the whole new one is there, whatever stops the
/// writing. A device or a pipe takes the contents as they are.
///
/// # Errors
/// It would replace an input, or a file that windfall did not write; the directory cannot
/// be written, or is full. The file of before is as it was.
pub fn write_whole(path: &Path, contents: &[u8]) -> Result<(), Error> {
    check_name(path)?;
    check_output(path)?;
    if is_stream(path) {
        let stream = File::options().append(true).open(path);
        let written = stream.and_then(|mut stream| stream.write_all(contents));
        return written.map_err(|source| Error::access(path, "write", source));
    }
    let path = &behind_links(path);
    check_written(path, Some(contents))?;
    let written = |_: &Path| list_written(path, contents);
    replace(path, system(path, |file| file.write_all(contents)), written)
}

/// [`write_whole`] of a file that is too long for memory.
///
/// * `write`: writes all of it
///
/// # Errors
/// Those of [`write_whole`], and those of `write`.
pub fn write_streamed(
    path: &Path,
    write: impl FnOnce(&mut File) -> Result<(), Error>,
) -> Result<(), Error> {
    check_target(path)?;
    let path = &behind_links(path);
    replace(path, write, |partial| list_written_as(path, partial))
}

/// Replaces a file that the user has edited, or one that tells itself whose it is; it lasts
/// from then on.
///
/// # Errors
/// It would replace an input; it cannot be written. The file of before is as it was.
pub fn replace_file(
    path: &Path,
    write: impl FnOnce(&mut File) -> IoResult<()>,
) -> Result<(), Error> {
    check_output(path)?;
    lasting(&behind_links(path), write)
}

/// Writes back a table that the user asked to extend: the one output that may be an input.
///
/// # Errors
/// It cannot be written. The file of before is as it was.
pub fn edit_file(path: &Path, text: &str) -> Result<(), Error> {
    lasting(&behind_links(path), |file| file.write_all(text.as_bytes()))
}

/// Replaces a file; the new one lasts from then on.
fn lasting(path: &Path, write: impl FnOnce(&mut File) -> IoResult<()>) -> Result<(), Error> {
    replace(path, system(path, write), |_| Ok(()))?;
    // That the name stands for the new file is to last as well, where the system can say so.
    let folder = path.parent().and_then(|own| File::open(own).ok());
    let _ = folder.map(|own| own.sync_all());
    Ok(())
}

/// Says what a system's error belongs to.
fn system(
    path: &Path,
    write: impl FnOnce(&mut File) -> IoResult<()>,
) -> impl FnOnce(&mut File) -> Result<(), Error> {
    move |file| write(file).map_err(|source| Error::access(path, "write", source))
}

fn replace(
    path: &Path,
    write: impl FnOnce(&mut File) -> Result<(), Error>,
    written: impl FnOnce(&Path) -> Result<(), Error>,
) -> Result<(), Error> {
    let failed = |source| Error::access(path, "write", source);
    let before = std::fs::metadata(path).ok();
    if before
        .as_ref()
        .is_some_and(|own| own.permissions().readonly())
    {
        let told = "the file is read-only";
        return Err(failed(std::io::Error::new(
            ErrorKind::PermissionDenied,
            told,
        )));
    }
    sweep(path);
    let (partial, mut file) = partial_of(path).map_err(failed)?;
    let moved = write(&mut file).and_then(|()| {
        let permissions = before.as_ref().map(|own| own.permissions());
        let kept = permissions.map_or(Ok(()), |own| file.set_permissions(own));
        kept.and_then(|()| file.sync_all()).map_err(failed)?;
        written(&partial)?;
        std::fs::rename(&partial, path).map_err(failed)
    });
    match &moved {
        Ok(()) => note_written(path),
        Err(_) => drop(std::fs::remove_file(&partial)),
    }
    moved
}

/// A new file beside a place, locked for as long as it is open.
pub(crate) fn partial_of(path: &Path) -> IoResult<(PathBuf, File)> {
    static NEXT: AtomicUsize = AtomicUsize::new(0);
    loop {
        let (process, number) = (std::process::id(), NEXT.fetch_add(1, Ordering::Relaxed));
        let partial = path.with_file_name(format!(".{process}-{number}{PARTIAL}"));
        let file = match File::create_new(&partial) {
            // That of a program with the same number, on another machine or in a container.
            Err(error) if error.kind() == ErrorKind::AlreadyExists => continue,
            other => other?,
        };
        // A system without locks does without.
        let _ = file.lock();
        // Before it was locked, another program may have taken it for what a killed one left.
        if partial.exists() {
            return Ok((partial, file));
        }
    }
}

/// Ending of folders that do not last.
pub(crate) const SCRATCH: &str = "windfall-scratch";

/// The folder that belongs to a lock.
pub(crate) fn folder_of(lock: &Path) -> PathBuf {
    lock.with_extension(SCRATCH)
}

/// Removes, once for each folder, what killed programs left beside a place.
pub fn sweep(path: &Path) {
    static SWEPT: Mutex<BTreeSet<PathBuf>> = Mutex::new(BTreeSet::new());
    let Some(folder) = path.with_file_name(".").canonicalize().ok() else {
        return;
    };
    let mut swept = SWEPT.lock().unwrap_or_else(PoisonError::into_inner);
    if !swept.insert(folder.clone()) {
        return;
    }
    for entry in std::fs::read_dir(folder).into_iter().flatten().flatten() {
        let plain = entry.file_type().is_ok_and(|own| own.is_file());
        let left = plain && entry.file_name().to_string_lossy().ends_with(PARTIAL);
        let free = |file: File| file.try_lock().is_ok();
        if left && File::open(entry.path()).is_ok_and(free) {
            // First the folder, which nothing would point to otherwise.
            let _ = std::fs::remove_dir_all(folder_of(&entry.path()));
            let _ = std::fs::remove_file(entry.path());
        }
    }
}

/// Where a file that is written lies: a link stays a link.
fn behind_links(path: &Path) -> PathBuf {
    let linked = std::fs::symlink_metadata(path).is_ok_and(|own| own.is_symlink());
    let real = linked.then(|| path.canonicalize().ok()).flatten();
    real.unwrap_or_else(|| path.to_path_buf())
}

/// Whether what is written there flows on, as into /dev/stdout.
fn is_stream(path: &Path) -> bool {
    let standard = path.starts_with("/dev") || path.starts_with("/proc");
    std::fs::metadata(path).is_ok_and(|own| !own.is_dir() && (standard || !own.is_file()))
}

/// Makes a directory for results, with those above it.
///
/// # Errors
/// It would lie among recordings, or cannot be made.
pub fn make_directory(path: &Path) -> Result<(), Error> {
    check_output(path)?;
    std::fs::create_dir_all(path).map_err(|source| Error::access(path, "write", source))
}

/// Writes a file that does not exist yet; it is there whole or not at all.
///
/// # Errors
/// It exists already, or cannot be written.
pub fn write_new(path: &Path, contents: &[u8]) -> Result<(), Error> {
    check_name(path)?;
    let failed = |source| create_error(path, source);
    sweep(path);
    let (partial, mut file) = partial_of(path).map_err(failed)?;
    let written = file.write_all(contents).and_then(|()| file.sync_all());
    let named = written.and_then(|()| give_new_name(&partial, path));
    let _ = std::fs::remove_file(&partial);
    named.map_err(failed)?;
    note_written(path);
    Ok(())
}

/// Gives a file a name that no other file has; it keeps its own.
pub(crate) fn give_new_name(file: &Path, name: &Path) -> IoResult<()> {
    // A hard link does not replace, where renaming would.
    match std::fs::hard_link(file, name) {
        // Some file systems have no hard links.
        Err(error) if error.kind() != ErrorKind::AlreadyExists => match name.exists() {
            true => Err(ErrorKind::AlreadyExists.into()),
            false => std::fs::rename(file, name),
        },
        other => other,
    }
}

/// Why a file or directory could not be made.
pub fn create_error(path: &Path, source: std::io::Error) -> Error {
    match source.kind() {
        ErrorKind::AlreadyExists => Error::AlreadyThere {
            path: path.to_path_buf(),
        },
        _ => Error::access(path, "create", source),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rejects_names_that_are_no_results() {
        let folder = tempfile::tempdir().unwrap();
        let list = folder.path().join(".windfall-wrote");
        for path in [Path::new("-"), &list] {
            assert!(write_whole(path, b"x").is_err() && write_new(path, b"x").is_err());
            assert!(check_target(path).is_err() && !path.exists());
        }
    }

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
        // The report, the list of what was written, and the directory.
        assert_eq!(std::fs::read_dir(directory.path()).unwrap().count(), 3);
    }
}
