//! Values beside a campaign that can be calculated again at any time: kept in a folder of
//! windfall's own, of bounded size.
//!
//! Nothing depends on an entry. One that is damaged, or that somebody else made, is none; a
//! folder that cannot be written keeps nothing; files of other names are never touched.

use crate::error::Error;
use crate::provenance::digest_bytes;
use crate::write_file::replace_file;
use std::fs::{Metadata, create_dir, read_dir, remove_file, symlink_metadata};
use std::io::{Read, Result as IoResult, Write};
use std::path::{Path, PathBuf};
use std::time::SystemTime;

/// Name of the folder in a campaign's directory.
pub const CACHE_FOLDER: &str = ".windfall-cache";
/// Ending of its entries.
const ENTRY: &str = ".windfall-kept";
/// First line of an entry; another form of the file has another number.
const HEAD: &[u8] = b"windfall cache 1\n";
/// Hexadecimal digits of a digest.
const DIGEST: usize = 64;

/// Most bytes of one entry.
const MOST_ENTRY: u64 = 64 << 20;
/// Most bytes of all entries of a folder; the newest stays in any case.
const MOST_ALL: u64 = 256 << 20;

/// What is kept under a key beside a campaign; `None` where there is nothing, or it is damaged.
pub fn kept(directory: &Path, key: &str) -> Option<Vec<u8>> {
    let path = folder_in(directory)?.join(name_of(key));
    let found = symlink_metadata(&path).ok()?;
    if !found.is_file() || found.len() > MOST_ENTRY {
        return None;
    }
    let mut entry = Vec::new();
    let file = std::fs::File::open(&path).ok()?;
    file.take(MOST_ENTRY).read_to_end(&mut entry).ok()?;
    let rest = entry.strip_prefix(HEAD)?;
    let (digest, value) = rest.split_at_checked(DIGEST)?;
    let sound = digest == digest_bytes(value).as_bytes();
    sound.then(|| value.to_vec())
}

/// Keeps a value under a key, and makes room for it: entries that were written longest ago go
/// first. Where it cannot be written, nothing is kept.
pub fn keep(directory: &Path, key: &str, value: &[u8]) {
    if (HEAD.len() + DIGEST + value.len()) as u64 > MOST_ENTRY {
        return;
    }
    // A folder that is there already is looked at in any case.
    let _ = create_dir(directory.join(CACHE_FOLDER));
    if let Some(folder) = folder_in(directory)
        && write_entry(&folder.join(name_of(key)), value).is_ok()
    {
        make_room(&folder, MOST_ALL);
    }
}

/// Size and times of a file: if they are the same later, so is the file. The time at which its
/// entry in the folder changed cannot be set by a program, unlike that of its contents.
pub fn stamp(path: &Path) -> IoResult<String> {
    let found = std::fs::metadata(path)?;
    let since = |time: SystemTime| time.duration_since(SystemTime::UNIX_EPOCH).ok();
    let modified = found.modified().ok().and_then(since);
    Ok(format!(
        "{} {modified:?} {:?}",
        found.len(),
        changed(&found)
    ))
}

#[cfg(unix)]
fn changed(found: &Metadata) -> (i64, i64, u64) {
    use std::os::unix::fs::MetadataExt;
    (found.ctime(), found.ctime_nsec(), found.ino())
}

#[cfg(not(unix))]
fn changed(found: &Metadata) -> Option<SystemTime> {
    found.created().ok()
}

/// The folder, where it is one: what a link leads to belongs to somebody else.
fn folder_in(directory: &Path) -> Option<PathBuf> {
    let folder = directory.join(CACHE_FOLDER);
    let own = symlink_metadata(&folder).is_ok_and(|found| found.is_dir());
    own.then_some(folder)
}

fn name_of(key: &str) -> String {
    digest_bytes(key.as_bytes()) + ENTRY
}

fn write_entry(path: &Path, value: &[u8]) -> Result<(), Error> {
    if symlink_metadata(path).is_ok_and(|found| !found.is_file()) {
        let taken = std::io::ErrorKind::AlreadyExists.into();
        return Err(Error::access(path, "write", taken));
    }
    replace_file(path, |file| {
        file.write_all(HEAD)?;
        file.write_all(digest_bytes(value).as_bytes())?;
        file.write_all(value)
    })
}

/// Removes the oldest entries of a folder until the others have at most that many bytes.
fn make_room(folder: &Path, most: u64) {
    let entries = read_dir(folder).into_iter().flatten().flatten();
    let mut own: Vec<(SystemTime, u64, PathBuf)> = entries
        .filter(|entry| is_entry(&entry.file_name().to_string_lossy()))
        .filter_map(|entry| {
            let found = entry.metadata().ok().filter(Metadata::is_file)?;
            Some((found.modified().ok()?, found.len(), entry.path()))
        })
        .collect();
    own.sort();
    let mut all: u64 = own.iter().map(|(_, bytes, _)| bytes).sum();
    let older = own.len().saturating_sub(1);
    for (_, bytes, path) in &own[..older] {
        if all <= most {
            return;
        }
        if remove_file(path).is_ok() {
            all -= bytes;
        }
    }
}

/// Whether a file of the folder has a name that only windfall gives.
fn is_entry(name: &str) -> bool {
    let digest = name.strip_suffix(ENTRY);
    digest.is_some_and(|own| own.len() == DIGEST && own.bytes().all(|b| b.is_ascii_hexdigit()))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn entry(directory: &Path, key: &str) -> PathBuf {
        directory.join(CACHE_FOLDER).join(name_of(key))
    }

    #[test]
    fn what_is_kept_comes_back_and_damage_is_nothing() {
        let place = tempfile::tempdir().unwrap();
        let own = place.path();
        assert_eq!(kept(own, "a"), None);
        keep(own, "a", b"one");
        keep(own, "b", b"");
        assert_eq!(kept(own, "a").unwrap(), b"one");
        assert_eq!(kept(own, "b").unwrap(), b"");
        keep(own, "a", b"two");
        assert_eq!(kept(own, "a").unwrap(), b"two");
        let sound = std::fs::read(entry(own, "a")).unwrap();
        for at in [0, HEAD.len(), sound.len() - 1] {
            let mut damaged = sound.clone();
            damaged[at] ^= 1;
            std::fs::write(entry(own, "a"), damaged).unwrap();
            assert_eq!(kept(own, "a"), None);
        }
        for length in 0..sound.len() {
            std::fs::write(entry(own, "a"), &sound[..length]).unwrap();
            assert_eq!(kept(own, "a"), None, "{length}");
        }
        // It is made again.
        keep(own, "a", b"two");
        assert_eq!(kept(own, "a").unwrap(), b"two");
    }

    #[test]
    fn the_oldest_entries_make_room_and_files_of_others_stay() {
        let place = tempfile::tempdir().unwrap();
        let own = place.path();
        keep(own, "0", b"0123456789");
        let folder = own.join(CACHE_FOLDER);
        let foreign = ["notes.txt", "notes.windfall-kept"].map(|name| folder.join(name));
        for path in &foreign {
            std::fs::write(path, vec![0; 1000]).unwrap();
        }
        for key in ["1", "2", "3"] {
            std::thread::sleep(std::time::Duration::from_millis(20));
            keep(own, key, b"0123456789");
        }
        let size = std::fs::metadata(entry(own, "3")).unwrap().len();
        make_room(&folder, 2 * size);
        let left = ["0", "1", "2", "3"].map(|key| kept(own, key).is_some());
        assert_eq!(left, [false, false, true, true]);
        // The newest stays in any case.
        make_room(&folder, 0);
        assert!(kept(own, "3").is_some() && kept(own, "2").is_none());
        assert!(foreign.iter().all(|path| path.exists()));
    }

    #[test]
    fn a_place_of_somebody_else_is_left_alone() {
        let place = tempfile::tempdir().unwrap();
        let own = place.path();
        std::fs::write(own.join(CACHE_FOLDER), "mine").unwrap();
        keep(own, "a", b"one");
        assert_eq!(kept(own, "a"), None);
        assert_eq!(std::fs::read(own.join(CACHE_FOLDER)).unwrap(), b"mine");
        #[cfg(unix)]
        {
            let other = own.join("other");
            std::fs::create_dir(&other).unwrap();
            std::fs::remove_file(own.join(CACHE_FOLDER)).unwrap();
            std::os::unix::fs::symlink(&other, own.join(CACHE_FOLDER)).unwrap();
            keep(own, "a", b"one");
            assert_eq!(std::fs::read_dir(&other).unwrap().count(), 0);
        }
    }

    #[test]
    fn another_content_has_another_stamp() {
        let place = tempfile::tempdir().unwrap();
        let path = place.path().join("a");
        std::fs::write(&path, "one").unwrap();
        let first = stamp(&path).unwrap();
        assert_eq!(stamp(&path).unwrap(), first);
        let time = std::fs::metadata(&path).unwrap().modified().unwrap();
        std::thread::sleep(std::time::Duration::from_millis(20));
        // The same size, and the time set back.
        std::fs::write(&path, "two").unwrap();
        let file = std::fs::File::options().write(true).open(&path).unwrap();
        file.set_modified(time).unwrap();
        assert_eq!(cfg!(unix), stamp(&path).unwrap() != first);
    }
}
