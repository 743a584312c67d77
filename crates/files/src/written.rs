//! What windfall wrote into a folder, so that it replaces its own files and no others.
//!
//! Each folder with results has a list ([`LIST`]): SHA-256 and name of every file, in the
//! lines of `sha256sum`. Lines are only added. A file that no line describes was made, or
//! changed, by somebody else.

use crate::error::Error;
use crate::provenance::{digest_bytes, digest_of_file};
use std::collections::{BTreeMap, BTreeSet};
use std::fs::File;
use std::io::{Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// Name of the list in a folder.
pub const LIST: &str = ".windfall-wrote";
/// Ending of files that have not got their name yet.
pub(crate) const PARTIAL: &str = ".windfall-partial";
/// Stands for the digest of a file that another program fills.
const ANY: &str = "any";

/// Lists that this program has read, by folder: length of the file, digests and names.
static LISTS: Mutex<BTreeMap<PathBuf, (u64, Lines)>> = Mutex::new(BTreeMap::new());
type Lines = BTreeSet<(String, String)>;

static FORCE: AtomicBool = AtomicBool::new(false);

/// Whether files of others may be replaced too from now on: the user said `--force`.
pub(crate) fn replace_files_of_others(force: bool) {
    FORCE.store(force, Ordering::Relaxed);
}

/// Forgets the lists; they are read again where they are needed.
pub(crate) fn forget_lists() {
    lists().clear();
}

fn lists() -> MutexGuard<'static, BTreeMap<PathBuf, (u64, Lines)>> {
    LISTS.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Refuses a file that is there and that windfall did not write, or that was changed since.
/// An empty file passes, and one that already holds what is to be written.
///
/// * `contents`: what is to be written, where that is known already
///
/// # Errors
/// [`Error::NotWrittenHere`]; the file cannot be read.
pub fn check_written(path: &Path, contents: Option<&[u8]>) -> Result<(), Error> {
    let replaced = std::fs::metadata(path).is_ok_and(|own| own.is_file() && own.len() > 0);
    if !replaced || FORCE.load(Ordering::Relaxed) || is_written(path, contents)? {
        return Ok(());
    }
    Err(Error::NotWrittenHere {
        path: path.to_path_buf(),
    })
}

/// Whether a file is one that windfall wrote and nobody has changed since, or has these contents;
/// what `--force` allows makes no difference.
///
/// # Errors
/// It, or the list of its folder, cannot be read.
pub fn is_written(path: &Path, contents: Option<&[u8]>) -> Result<bool, Error> {
    check_plain(&list_of(path))?;
    let name = name_of(path);
    let listed = |digest: String| with_lines(path, |lines| lines.contains(&(digest, name.clone())));
    let digest = digest_of_file(path)?;
    // Another program would fill what the link leads to.
    let filled = || check_plain(path).is_ok() && listed(ANY.to_owned());
    let same = contents.is_some_and(|own| digest_bytes(own) == digest);
    Ok(same || listed(digest) || filled())
}

/// Whether a file only serves the writing: a list, or one that has not got its name yet.
pub fn is_own_file(path: &Path) -> bool {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    name == LIST || name.ends_with(PARTIAL)
}

/// Adds a file to the list of its folder, before it gets its name there.
///
/// # Errors
/// The list cannot be written.
pub fn list_written(path: &Path, contents: &[u8]) -> Result<(), Error> {
    add_line(path, digest_bytes(contents))
}

/// [`list_written`] of a file that still has another name.
///
/// # Errors
/// The file cannot be read, or the list cannot be written.
pub fn list_written_as(path: &Path, present: &Path) -> Result<(), Error> {
    add_line(path, digest_of_file(present)?)
}

/// [`list_written`] of a file that another program will fill.
///
/// # Errors
/// The list cannot be written.
pub fn list_filled_by_others(path: &Path) -> Result<(), Error> {
    add_line(path, ANY.to_owned())
}

/// Refuses a link, a pipe or a device where windfall keeps a file of its own: what is
/// written there would go elsewhere. What is not there passes.
///
/// # Errors
/// [`Error::NotRegular`].
pub fn check_plain(path: &Path) -> Result<(), Error> {
    match std::fs::symlink_metadata(path) {
        Ok(found) if !found.is_file() => Err(Error::NotRegular {
            path: path.to_path_buf(),
        }),
        _ => Ok(()),
    }
}

fn add_line(path: &Path, digest: String) -> Result<(), Error> {
    check_plain(&list_of(path))?;
    let line = (digest, name_of(path));
    with_lines(path, |lines| {
        if lines.contains(&line) {
            return Ok(());
        }
        let list = list_of(path);
        let mut options = File::options();
        let written = options.append(true).create(true).open(&list);
        // A program that was killed within its line.
        let end = if ends_line(&list) { "" } else { "\n" };
        let text = format!("{end}{}  {}\n", line.0, line.1);
        let written = written.and_then(|mut file| file.write_all(text.as_bytes()));
        lines.insert(line);
        written.map_err(|source| Error::access(&list, "write", source))
    })
}

/// Whether a list is empty or ends with a whole line.
fn ends_line(list: &Path) -> bool {
    let mut last = [b'\n'];
    let read = File::open(list).and_then(|mut file| {
        file.seek(SeekFrom::End(-1))?;
        file.read_exact(&mut last)
    });
    // What cannot be read, or is empty, begins with a line of its own anyway.
    read.is_err() || last == [b'\n']
}

/// Calls with the lines of the list of a file's folder, as they are now.
fn with_lines<T>(path: &Path, work: impl FnOnce(&mut Lines) -> T) -> T {
    let list = list_of(path);
    let length = || std::fs::metadata(&list).map_or(0, |own| own.len());
    // The program may go to another directory meanwhile.
    let whole = std::path::absolute(&list).unwrap_or_else(|_| list.clone());
    let mut lists = lists();
    let (known, lines) = lists.entry(whole).or_default();
    if *known != length() {
        // First use, or another program wrote or removed it.
        let text = std::fs::read(&list).unwrap_or_default();
        let text = String::from_utf8_lossy(&text);
        let read = text.lines().filter_map(|line| line.split_once("  "));
        *lines = read
            .map(|(digest, name)| (digest.to_owned(), name.to_owned()))
            .collect();
    }
    let out = work(lines);
    *known = length();
    out
}

fn list_of(path: &Path) -> PathBuf {
    path.with_file_name(LIST)
}

/// The name as the list has it: on one line.
fn name_of(path: &Path) -> String {
    let name = path.file_name().unwrap_or_default();
    name.to_string_lossy().replace(['\n', '\r'], "_")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::write_file::write_whole;

    #[test]
    fn rejects_to_replace_what_windfall_did_not_write() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("card.toml");
        std::fs::write(&path, "mine").unwrap();
        let told = write_whole(&path, b"card").unwrap_err().to_string();
        assert!(
            told.contains("not written by windfall") && told.contains("--force"),
            "{told}"
        );
        assert_eq!(std::fs::read(&path).unwrap(), b"mine");
        // The same contents lose nothing; an empty file neither.
        write_whole(&path, b"mine").unwrap();
        write_whole(&path, b"one").unwrap();
        write_whole(&path, b"two").unwrap();
        std::fs::write(&path, "").unwrap();
        write_whole(&path, b"one").unwrap();
        // Changed since.
        std::fs::write(&path, "one, with a remark").unwrap();
        assert!(write_whole(&path, b"two").is_err());
        // A list that ends within a line.
        let mut text = std::fs::read(folder.path().join(LIST)).unwrap();
        text.extend(b"0123  cut");
        std::fs::write(folder.path().join(LIST), text).unwrap();
        std::fs::remove_file(&path).unwrap();
        write_whole(&path, b"three").unwrap();
        write_whole(&path, b"four").unwrap();
        std::fs::write(&path, "one, with a remark").unwrap();
        // What another program fills is windfall's all the same.
        list_filled_by_others(&path).unwrap();
        write_whole(&path, b"two").unwrap();
        // A list that leads elsewhere is neither read nor added to.
        #[cfg(unix)]
        {
            let (list, other) = (folder.path().join(LIST), folder.path().join("other"));
            std::fs::rename(&list, &other).unwrap();
            std::os::unix::fs::symlink(&other, &list).unwrap();
            let before = std::fs::read(&other).unwrap();
            for path in [&path, &folder.path().join("new.toml")] {
                let told = write_whole(path, b"three").unwrap_err().to_string();
                assert!(told.contains("not a regular file"), "{told}");
            }
            assert_eq!(std::fs::read(&other).unwrap(), before);
            std::fs::rename(&other, &list).unwrap();
        }
        // Without the list nothing is known.
        std::fs::remove_file(folder.path().join(LIST)).unwrap();
        assert!(write_whole(&path, b"three").is_err());
    }
}
