//! Folders for files that do not last, and directories that are there whole or not at all.

use crate::error::Error;
use crate::write_file::{SCRATCH, create_error, folder_of, partial_of, sweep};
use std::fs::{DirBuilder, File};
use std::io::{ErrorKind, Result as IoResult, Write};
use std::path::{Path, PathBuf};

/// A folder that is removed with this. Where this program is killed, the next one removes it:
/// beside it lies a file that is locked for as long as the folder is needed.
#[derive(Debug)]
pub struct Scratch {
    folder: PathBuf,
    lock: PathBuf,
    _locked: File,
}

/// Removes what killed programs left in the system's folder for temporary files.
pub fn sweep_temporary() {
    sweep(&std::env::temp_dir().join(SCRATCH));
}

impl Scratch {
    /// A folder for temporary files, into which no other account can look.
    ///
    /// # Errors
    /// There is no room for it.
    pub fn temporary() -> Result<Self, Error> {
        let folder = std::env::temp_dir();
        let made = Self::beside(&folder.join(SCRATCH), &private());
        made.map_err(|source| Error::access(&folder, "write", source))
    }

    /// A folder beside a place.
    fn beside(path: &Path, builder: &DirBuilder) -> IoResult<Self> {
        sweep(path);
        let (lock, locked) = partial_of(path)?;
        let folder = folder_of(&lock);
        // From here on the lock is removed.
        let scratch = Self {
            folder,
            lock,
            _locked: locked,
        };
        builder.create(&scratch.folder).map(|()| scratch)
    }

    /// Where it is.
    pub fn path(&self) -> &Path {
        &self.folder
    }

    /// Writes a new file into it, with the folders above it.
    ///
    /// # Errors
    /// It is there already, or cannot be written.
    pub fn write(&self, name: &Path, contents: &[u8]) -> IoResult<()> {
        let path = self.folder.join(name);
        path.parent().map_or(Ok(()), std::fs::create_dir_all)?;
        File::create_new(path)?.write_all(contents)
    }
}

impl Drop for Scratch {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.folder);
        let _ = std::fs::remove_file(&self.lock);
    }
}

fn private() -> DirBuilder {
    #[cfg_attr(not(unix), expect(unused_mut))]
    let mut builder = DirBuilder::new();
    #[cfg(unix)]
    std::os::unix::fs::DirBuilderExt::mode(&mut builder, 0o700);
    builder
}

/// A directory that is filled beside its place, and gets its name when it is whole.
#[derive(Debug)]
pub struct NewDirectory {
    directory: PathBuf,
    scratch: Scratch,
}

impl NewDirectory {
    /// Makes room for a directory that does not exist yet, or is empty.
    ///
    /// # Errors
    /// There is something in it already, or it cannot be made.
    pub fn begin(directory: &Path) -> Result<Self, Error> {
        let failed = |source| create_error(directory, source);
        let inside = directory.join(SCRATCH);
        let place = match std::fs::read_dir(directory) {
            Err(error) if error.kind() == ErrorKind::NotFound => directory,
            // A file.
            Err(error) if error.kind() == ErrorKind::NotADirectory => {
                return Err(failed(ErrorKind::AlreadyExists.into()));
            }
            Err(source) => return Err(failed(source)),
            Ok(_) => {
                // What a killed program left does not count.
                sweep(&inside);
                let entries = std::fs::read_dir(directory).map_err(failed)?;
                if entries.count() > 0 {
                    return Err(failed(ErrorKind::AlreadyExists.into()));
                }
                &inside
            }
        };
        let above = place.parent().filter(|own| !own.as_os_str().is_empty());
        let made = above.map_or(Ok(()), std::fs::create_dir_all);
        let scratch = made.and_then(|()| Scratch::beside(place, &DirBuilder::new()));
        Ok(Self {
            directory: directory.to_path_buf(),
            scratch: scratch.map_err(failed)?,
        })
    }

    /// Writes a file of it; where that will be.
    ///
    /// # Errors
    /// It cannot be written.
    pub fn write(&self, name: &str, contents: &[u8]) -> Result<PathBuf, Error> {
        let place = self.directory.join(name);
        let written = self.scratch.write(Path::new(name), contents);
        written.map_err(|source| create_error(&place, source))?;
        Ok(place)
    }

    /// Copies a file into it; where it will be.
    ///
    /// # Errors
    /// The file cannot be read, or the copy not written.
    pub fn copy(&self, name: &str, from: &Path) -> Result<PathBuf, Error> {
        let place = self.directory.join(name);
        let path = self.scratch.path().join(name);
        let mut source = File::open(from).map_err(|source| Error::access(from, "read", source))?;
        let made = path.parent().map_or(Ok(()), std::fs::create_dir_all);
        let copied = made.and_then(|()| std::io::copy(&mut source, &mut File::create_new(path)?));
        copied.map_err(|source| create_error(&place, source))?;
        Ok(place)
    }

    /// Makes an empty folder in it; where that will be.
    ///
    /// # Errors
    /// It cannot be made.
    pub fn make_folder(&self, name: &str) -> Result<PathBuf, Error> {
        let place = self.directory.join(name);
        let made = std::fs::create_dir(self.scratch.path().join(name));
        made.map_err(|source| create_error(&place, source))?;
        Ok(place)
    }

    /// Gives it its name, or its files theirs where it was there, empty.
    ///
    /// * `last`: the file by which it is known
    ///
    /// # Errors
    /// Something has come into its place meanwhile.
    pub fn end(self, last: &str) -> Result<(), Error> {
        let failed = |source| create_error(&self.directory, source);
        let filled = self.scratch.path();
        if !filled.starts_with(&self.directory) {
            return std::fs::rename(filled, &self.directory).map_err(failed);
        }
        // It may be the one in which the user stands, which keeps its place.
        let entries = std::fs::read_dir(filled).and_then(Iterator::collect);
        let entries: Vec<std::fs::DirEntry> = entries.map_err(failed)?;
        let mut names: Vec<_> = entries.iter().map(std::fs::DirEntry::file_name).collect();
        names.sort_by_key(|name| (name == last, name.clone()));
        let mut moved = names.iter().map(|name| {
            let place = self.directory.join(name);
            match place.exists() {
                true => Err(ErrorKind::AlreadyExists.into()),
                false => std::fs::rename(filled.join(name), place),
            }
        });
        moved.try_for_each(|own| own).map_err(failed)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(folder: &Path) -> Vec<String> {
        let entries = std::fs::read_dir(folder).unwrap();
        let mut names: Vec<String> = entries
            .map(|own| own.unwrap().file_name().into_string().unwrap())
            .collect();
        names.sort();
        names
    }

    #[test]
    fn folders_of_killed_programs_are_removed_and_those_in_use_stay() {
        let place = tempfile::tempdir().unwrap();
        // As a killed program leaves it: nobody holds the lock.
        let lock = place.path().join(".1-1.windfall-partial");
        std::fs::write(&lock, "").unwrap();
        std::fs::create_dir_all(folder_of(&lock).join("deep")).unwrap();
        // Somebody's own, and one that is in use.
        std::fs::create_dir(place.path().join("mine.windfall-scratch")).unwrap();
        let (used, _locked) = partial_of(&place.path().join("x")).unwrap();
        std::fs::create_dir(folder_of(&used)).unwrap();
        let scratch = Scratch::beside(&place.path().join("y"), &private()).unwrap();
        scratch.write(Path::new("b/a"), b"a").unwrap();
        assert!(!lock.exists() && !folder_of(&lock).exists());
        assert!(folder_of(&used).exists() && place.path().join("mine.windfall-scratch").exists());
        #[cfg(unix)]
        {
            let found = std::fs::metadata(scratch.path()).unwrap().permissions();
            let mode = std::os::unix::fs::PermissionsExt::mode(&found);
            assert_eq!(mode & 0o777, 0o700);
        }
        drop(scratch);
        assert_eq!(names(place.path()).len(), 3);
    }

    #[test]
    fn a_directory_is_there_whole_or_not_at_all() {
        let place = tempfile::tempdir().unwrap();
        for there in [false, true] {
            let directory = place.path().join(format!("above/new-{there}"));
            if there {
                std::fs::create_dir_all(&directory).unwrap();
            }
            let new = NewDirectory::begin(&directory).unwrap();
            assert_eq!(new.write("a", b"a").unwrap(), directory.join("a"));
            new.make_folder("raw").unwrap();
            assert!(!directory.join("a").exists());
            new.end("a").unwrap();
            assert_eq!(names(&directory), ["a", "raw"]);
            let error = NewDirectory::begin(&directory).unwrap_err().to_string();
            assert!(error.contains("exists already"), "{error}");
        }
        // Given up.
        let directory = place.path().join("other");
        drop(NewDirectory::begin(&directory).unwrap());
        assert_eq!(names(place.path()), ["above"]);
        assert_eq!(
            names(&place.path().join("above")),
            ["new-false", "new-true"]
        );
    }
}
