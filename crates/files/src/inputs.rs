//! What a command reads, and may not replace.
//!
//! A command notes each input: [`protect`] a file, [`protect_campaign`] a campaign with the
//! directory of its recordings. No output replaces an input, whatever it is called: files are
//! known by device and inode, where the system has them. Programs that run commands turn this
//! on for each of them ([`guard_inputs`]); a server confines its files in another way.
//!
//! Of commands that run at once each is kept from the inputs of all: which of them noted a
//! file is not known, because their threads are shared.

use crate::error::Error;
use std::collections::{BTreeMap, BTreeSet};
use std::fs::Metadata;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};
use windfall_source::stream::STANDARD_INPUT;

/// What a file or folder is, whatever it is called.
#[cfg(unix)]
type Identity = (u64, u64);
#[cfg(not(unix))]
type Identity = PathBuf;

/// What was noted, and the newest command that ran then: it belongs to that one or to an
/// older one.
type Noted<T> = BTreeMap<Identity, (u64, T)>;

/// Inputs of the commands that run.
struct Inputs {
    /// Numbers of the commands that run, and the next number.
    running: BTreeSet<u64>,
    next: u64,
    files: Noted<PathBuf>,
    /// What was written, and the newest command then.
    written: Vec<(u64, PathBuf)>,
    /// Folders that hold recordings alone.
    recordings: Noted<PathBuf>,
    /// Folders with the names in them that belong to a campaign.
    campaigns: Noted<&'static [&'static str]>,
}

static INPUTS: Mutex<Inputs> = Mutex::new(Inputs {
    running: BTreeSet::new(),
    next: 0,
    files: BTreeMap::new(),
    written: Vec::new(),
    recordings: BTreeMap::new(),
    campaigns: BTreeMap::new(),
});

/// Keeps the inputs of a command as long as it runs, which is as long as this lives.
pub struct Guarded {
    number: u64,
}

/// From now on this program replaces none of its inputs.
#[must_use]
pub fn guard_inputs() -> Guarded {
    let mut inputs = inputs();
    let number = inputs.next;
    inputs.next += 1;
    inputs.running.insert(number);
    Guarded { number }
}

/// Files that a command used, sorted by name.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct UsedFiles {
    /// What it read.
    pub read: Vec<PathBuf>,
    /// What it wrote, each once.
    pub written: Vec<PathBuf>,
}

impl Guarded {
    /// Files that were used since the command began, by it or by those that ran beside it.
    pub fn files(&self) -> UsedFiles {
        let inputs = inputs();
        let own = |newest: &u64| *newest >= self.number;
        let read = inputs.files.values().filter(|(newest, _)| own(newest));
        let written = inputs.written.iter().filter(|(newest, _)| own(newest));
        let written: BTreeSet<_> = written.map(|(_, path)| path.clone()).collect();
        let mut read: Vec<PathBuf> = read.map(|(_, path)| path.clone()).collect();
        read.sort();
        UsedFiles {
            read,
            written: written.into_iter().collect(),
        }
    }
}

/// Notes a file that was written.
pub fn note_written(path: &Path) {
    let mut inputs = inputs();
    if let Some(newest) = inputs.running.last().copied() {
        inputs.written.push((newest, path.to_path_buf()));
    }
}

impl Drop for Guarded {
    fn drop(&mut self) {
        let mut inputs = inputs();
        inputs.running.remove(&self.number);
        let oldest = inputs.running.first().copied().unwrap_or(u64::MAX);
        inputs.files.retain(|_, (newest, _)| *newest >= oldest);
        inputs.written.retain(|(newest, _)| *newest >= oldest);
        inputs.recordings.retain(|_, (newest, _)| *newest >= oldest);
        inputs.campaigns.retain(|_, (newest, _)| *newest >= oldest);
    }
}

fn inputs() -> MutexGuard<'static, Inputs> {
    INPUTS.lock().unwrap_or_else(PoisonError::into_inner)
}

/// The newest command that runs, if inputs are guarded.
fn newest() -> Option<u64> {
    inputs().running.last().copied()
}

/// Notes an input.
pub fn protect(path: &Path) {
    note(path, |inputs, identity, newest| {
        let noted = (newest, path.to_path_buf());
        inputs.files.insert(identity, noted);
    });
}

/// Notes a campaign: names that are its own, and the folder of its recordings, in which
/// nothing is written at all.
pub fn protect_campaign(directory: &Path, own: &'static [&'static str], recordings: &Path) {
    note(directory, |inputs, identity, newest| {
        inputs.campaigns.insert(identity, (newest, own));
    });
    // Recordings that lie beside campaign.toml share their folder with what is written.
    let apart = match (directory.canonicalize(), recordings.canonicalize()) {
        (Ok(directory), Ok(recordings)) => !directory.starts_with(&recordings),
        _ => false,
    };
    if apart && newest().is_some() {
        // Also those that no impact names, which other names may lead to.
        for entry in std::fs::read_dir(recordings)
            .into_iter()
            .flatten()
            .flatten()
        {
            protect(&entry.path());
        }
        note(recordings, |inputs, identity, newest| {
            let noted = (newest, recordings.to_path_buf());
            inputs.recordings.insert(identity, noted);
        });
    }
}

fn note(path: &Path, add: impl FnOnce(&mut Inputs, Identity, u64)) {
    if newest().is_none() {
        return;
    }
    let Some(identity) = identity_of(path) else {
        return;
    };
    let mut inputs = inputs();
    if let Some(newest) = inputs.running.last().copied() {
        add(&mut inputs, identity, newest);
    }
}

#[cfg(unix)]
fn identity(_: &Path, found: &Metadata) -> Option<Identity> {
    use std::os::unix::fs::MetadataExt;
    Some((found.dev(), found.ino()))
}

#[cfg(not(unix))]
fn identity(path: &Path, _: &Metadata) -> Option<Identity> {
    path.canonicalize().ok()
}

/// What is there, behind any symbolic links.
fn identity_of(path: &Path) -> Option<Identity> {
    identity(path, &std::fs::metadata(path).ok()?)
}

/// Refuses a file that would replace an input, or lie among recordings.
///
/// # Errors
/// It would.
pub fn check_output(path: &Path) -> Result<(), Error> {
    let inputs = inputs();
    if inputs.running.is_empty() {
        return Ok(());
    }
    let replaced = identity_of(path).and_then(|own| inputs.files.get(&own));
    if let Some((_, input)) = replaced {
        return Err(Error::WouldReplaceInput {
            path: path.to_path_buf(),
            input: input.clone(),
        });
    }
    let named = |folder: &Path| match folder.as_os_str().is_empty() {
        true => PathBuf::from("."),
        false => folder.to_path_buf(),
    };
    let name = path.file_name().unwrap_or_default();
    let folder = path.parent().map(named).unwrap_or_default();
    let own = identity_of(&folder).and_then(|folder| inputs.campaigns.get(&folder));
    if own.is_some_and(|(_, own)| own.iter().any(|known| name.eq_ignore_ascii_case(known))) {
        return Err(Error::WouldReplaceInput {
            path: path.to_path_buf(),
            input: folder.join(name),
        });
    }
    // Folders that are not there yet will lie in one that is.
    let above = path.ancestors().skip(usize::from(!path.is_dir()));
    let above = above.map(named);
    let there = above.filter_map(|folder| folder.canonicalize().ok()).next();
    let there = there.unwrap_or_default();
    let among = there
        .ancestors()
        .find_map(|above| inputs.recordings.get(&identity_of(above)?));
    match among {
        Some((_, folder)) => Err(Error::AmongRecordings {
            path: path.to_path_buf(),
            folder: folder.clone(),
        }),
        None => Ok(()),
    }
}

/// Refuses what has no end or no content of its own: pipes, sockets and devices. What is
/// not there, or is a directory, is left to the reader, which says so.
///
/// # Errors
/// It is none of a file, a directory, or nothing.
pub fn check_regular(path: &Path) -> Result<(), Error> {
    match std::fs::metadata(path) {
        Ok(found) if !found.is_file() && !found.is_dir() => Err(Error::NotRegular {
            path: path.to_path_buf(),
        }),
        _ => Ok(()),
    }
}

/// [`check_regular`] of a file that a person may pipe in: `-`, `/dev/stdin`, `<(…)` and pipes
/// pass.
///
/// # Errors
/// It is a device or a socket.
pub fn check_piped(path: &Path) -> Result<(), Error> {
    let standard = [STANDARD_INPUT, "/dev/stdin", "/dev/fd", "/proc/self/fd"];
    let standard = standard.iter().any(|own| path.starts_with(own));
    if standard || std::fs::metadata(path).is_ok_and(|found| is_pipe(&found)) {
        return Ok(());
    }
    check_regular(path)
}

#[cfg(unix)]
fn is_pipe(found: &Metadata) -> bool {
    use std::os::unix::fs::FileTypeExt;
    found.file_type().is_fifo()
}

#[cfg(not(unix))]
fn is_pipe(_: &Metadata) -> bool {
    false
}

#[cfg(test)]
mod tests {
    use super::*;

    #[cfg(unix)]
    #[test]
    fn rejects_devices_and_pipes_where_nobody_pipes() {
        let folder = tempfile::tempdir().unwrap();
        let zero = folder.path().join("zero");
        std::os::unix::fs::symlink("/dev/zero", &zero).unwrap();
        let pipe = folder.path().join("pipe");
        let made = std::process::Command::new("mkfifo").arg(&pipe).status();
        assert!(made.unwrap().success());
        let told = check_regular(&zero).unwrap_err().to_string();
        assert!(told.contains("not a regular file"), "{told}");
        assert!(check_regular(&pipe).is_err() && check_piped(&zero).is_err());
        assert!(check_piped(&pipe).is_ok() && check_piped(Path::new("/dev/stdin")).is_ok());
        for path in [folder.path(), &folder.path().join("absent")] {
            assert!(check_regular(path).is_ok());
        }
    }
}
