//! Files named from outside, confined to one directory.

use crate::error::Error;
use crate::inputs::check_regular;
use crate::write_file::{give_new_name, partial_of, sweep};
use std::fs::File;
use std::io::Write;
use std::path::{Component, Path, PathBuf};
use std::sync::{PoisonError, RwLock};

/// Longest name of a file that is taken; bytes. Half of what file systems take, so
/// that it can be written beside its place first.
const LONGEST: usize = 120;

/// Characters that some file system, shell or table gives a meaning.
const REFUSED: [char; 11] = ['/', '\\', ':', '*', '?', '"', '<', '>', '|', ',', '\0'];

/// A path below a directory, of parts that are plain names.
///
/// * `name`: parts joined by "/"; no part may be empty, ".", "..", begin with a dot,
///   or hold a character that some system gives a meaning
///
/// The path need not exist; what exists of it may be no symbolic link, so that
/// nothing outside of the directory is reached.
///
/// # Errors
/// The name is refused, or the path goes through a symbolic link.
pub fn path_inside(directory: &Path, name: &str) -> Result<PathBuf, Error> {
    let mut path = directory.to_path_buf();
    for part in name.split('/') {
        path.push(plain_name(part, name)?);
        let linked = std::fs::symlink_metadata(&path).is_ok_and(|found| found.is_symlink());
        if linked {
            let problem = "goes through a symbolic link; put the file itself there";
            return Err(refused(name, problem));
        }
    }
    Ok(path)
}

/// A part of a path that is a name and nothing else.
fn plain_name<'a>(part: &'a str, whole: &str) -> Result<&'a str, Error> {
    let problem = match part {
        "" => "has an empty part",
        _ if part.starts_with('.') => "has a part that begins with a dot",
        _ if part.len() > LONGEST => "has a part of more than 120 bytes",
        _ if part.contains(REFUSED) || part.chars().any(char::is_control) => {
            "holds a character that names cannot have here (\\ : * ? \" < > | , or a control \
             character)"
        }
        _ if part.ends_with([' ', '.']) => "has a part that ends with a blank or a dot",
        _ => return Ok(part),
    };
    Err(refused(whole, problem))
}

fn refused(name: &str, problem: &str) -> Error {
    Error::NameRefused {
        name: name.to_owned(),
        problem: problem.to_owned(),
    }
}

/// Checks that what a file names lies below a directory, behind any symbolic links, and is a
/// regular file. What is not there is left to its reader, which says so.
///
/// # Errors
/// It lies elsewhere, or is a pipe, a socket or a device.
pub fn check_inside(directory: &Path, path: &Path) -> Result<(), Error> {
    check_regular(path)?;
    match (directory.canonicalize(), path.canonicalize()) {
        (Ok(directory), Ok(found)) if !found.starts_with(&directory) => {
            let name = path.strip_prefix(directory).unwrap_or(path);
            let problem = "lies outside of the directory that it belongs to; put the file there";
            Err(refused(&name.display().to_string(), problem))
        }
        _ => Ok(()),
    }
}

/// Directories that the user named, besides those where files that name others lie.
static ALSO_READ: RwLock<Vec<PathBuf>> = RwLock::new(Vec::new());

/// From now on files below these directories, and no others, may be named by a campaign, scene,
/// study or law.
pub fn also_read(directories: Vec<PathBuf>) {
    *ALSO_READ.write().unwrap_or_else(PoisonError::into_inner) = directories;
}

/// The file that another file names.
///
/// * `directory`: relative names start there
/// * `within`: where the file must lie, behind any symbolic links
///
/// A file that is not there is left to its reader, which says so.
///
/// # Errors
/// What is wrong with the name, for a message that says where it stands: the file lies neither
/// in `within` nor in a directory that the user named ([`also_read`]), or is a pipe, a socket
/// or a device.
pub fn named_file(directory: &Path, name: &str, within: &Path) -> Result<PathBuf, String> {
    let path = directory.join(name);
    check_regular(&path).map_err(|error| error.to_string())?;
    if plainly_inside(within, &path) {
        return Ok(path);
    }
    let Ok(found) = path.canonicalize() else {
        return Ok(path);
    };
    let also = ALSO_READ.read().unwrap_or_else(PoisonError::into_inner);
    let mut within = std::iter::once(within).chain(also.iter().map(PathBuf::as_path));
    let inside = |folder: &Path| {
        let folder = match folder.as_os_str().is_empty() {
            true => Path::new("."),
            false => folder,
        };
        folder
            .canonicalize()
            .is_ok_and(|folder| found.starts_with(folder))
    };
    if within.any(inside) {
        return Ok(path);
    }
    let folder = found.parent().unwrap_or(&found).display();
    Err(format!(
        "it lies elsewhere, in {folder}, and files from other people may name files that are not \
         meant to be read; put it beside the file that names it, or allow that directory: \
         --also-read {folder}"
    ))
}

/// Whether a file lies below a folder by its name, with no link on the way.
fn plainly_inside(folder: &Path, path: &Path) -> bool {
    let Ok(rest) = path.strip_prefix(folder) else {
        return false;
    };
    let mut at = folder.to_path_buf();
    rest.components().all(|part| {
        at.push(part);
        let plain = |found: std::fs::Metadata| !found.is_symlink();
        matches!(part, Component::Normal(_)) && at.symlink_metadata().is_ok_and(plain)
    })
}

/// [`named_file`] by a file whose own folder is where it must lie.
///
/// * `naming`: the file in which the name stands
///
/// # Errors
/// Those of [`named_file`].
pub fn named_beside(naming: &Path, name: &str) -> Result<PathBuf, String> {
    let folder = naming.parent().unwrap_or(Path::new(""));
    named_file(folder, name, folder)
}

/// The content of a file below a directory.
///
/// # Errors
/// The name is refused, is that of no regular file, or the file cannot be read.
pub fn read_inside(directory: &Path, name: &str) -> Result<Vec<u8>, Error> {
    let path = path_inside(directory, name)?;
    check_regular(&path)?;
    if !path.is_file() {
        return Err(Error::absent(path, "it may have been removed meanwhile"));
    }
    std::fs::read(&path).map_err(|source| failed(&path, "read", source))
}

/// Removes a file that has just arrived and cannot be used.
pub fn discard(path: &Path) {
    // What cannot be removed stays as a file that nothing names.
    let _ = std::fs::remove_file(path);
}

/// A file that comes in pieces: it gets its name when complete, or leaves nothing behind.
pub struct Arriving {
    path: PathBuf,
    partial: PathBuf,
    file: Option<File>,
}

impl Arriving {
    /// Makes room for a new file.
    ///
    /// # Errors
    /// The name is refused or taken, or the directory cannot be written.
    pub fn begin(directory: &Path, name: &str) -> Result<Self, Error> {
        let path = path_inside(directory, name)?;
        // Also where the file is there: what is left may be its other name.
        sweep(&path);
        if path.exists() {
            return Err(Error::AlreadyThere { path });
        }
        let folder = path.parent().unwrap_or(directory);
        std::fs::create_dir_all(folder).map_err(|source| failed(folder, "create", source))?;
        let (partial, file) = partial_of(&path).map_err(|source| failed(&path, "write", source))?;
        Ok(Self {
            path,
            partial,
            file: Some(file),
        })
    }

    /// Takes the next piece.
    ///
    /// # Errors
    /// It cannot be written: a full disk, above all.
    pub fn take(&mut self, piece: &[u8]) -> Result<(), Error> {
        let Some(file) = &mut self.file else {
            return Ok(());
        };
        file.write_all(piece)
            .map_err(|source| failed(&self.path, "write", source))
    }

    /// Gives the file its name; where it is.
    ///
    /// # Errors
    /// Another file has got the name meanwhile, or it cannot be written.
    pub fn end(mut self) -> Result<PathBuf, Error> {
        let Some(file) = self.file.take() else {
            return Ok(self.path.clone());
        };
        let error = |source| failed(&self.path, "write", source);
        file.sync_all().map_err(error)?;
        drop(file);
        match give_new_name(&self.partial, &self.path) {
            Ok(()) => Ok(self.path.clone()),
            Err(source) if source.kind() == std::io::ErrorKind::AlreadyExists => {
                Err(Error::AlreadyThere {
                    path: self.path.clone(),
                })
            }
            Err(source) => Err(error(source)),
        }
    }
}

impl Drop for Arriving {
    fn drop(&mut self) {
        self.file = None;
        let _ = std::fs::remove_file(&self.partial);
    }
}

fn failed(path: &Path, action: &'static str, source: std::io::Error) -> Error {
    Error::access(path, action, source)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rejects_every_way_out_of_the_directory() {
        let directory = tempfile::tempdir().unwrap();
        let inside = directory.path().join("inside");
        std::fs::create_dir(&inside).unwrap();
        std::fs::write(directory.path().join("secret"), "s").unwrap();
        for name in [
            "../secret",
            "..",
            ".",
            "",
            "/etc/passwd",
            "a/../../secret",
            "a//b",
            "a\\..\\b",
            "C:x",
            ".hidden",
            "a/",
            "a\0b",
            "a\nb",
            "dot.",
            "blank ",
            "*",
        ] {
            let error = path_inside(&inside, name).unwrap_err();
            assert!(
                matches!(error, Error::NameRefused { .. }),
                "{name}: {error}"
            );
        }
        let long = "x".repeat(LONGEST + 1);
        assert!(path_inside(&inside, &long).is_err());
        assert_eq!(
            path_inside(&inside, "räw/a b (1).csv").unwrap(),
            inside.join("räw/a b (1).csv")
        );
    }

    #[cfg(unix)]
    #[test]
    fn rejects_symbolic_links() {
        let directory = tempfile::tempdir().unwrap();
        std::os::unix::fs::symlink("/etc", directory.path().join("link")).unwrap();
        let error = path_inside(directory.path(), "link/passwd").unwrap_err();
        assert!(error.to_string().contains("symbolic link"), "{error}");
        let inside = |name: &str| check_inside(directory.path(), &directory.path().join(name));
        for name in ["link/passwd", "/etc/passwd", "/dev/zero", ".."] {
            assert!(inside(name).is_err(), "{name}");
        }
        std::fs::write(directory.path().join("12:30.csv"), "").unwrap();
        assert!(inside("12:30.csv").is_ok() && inside("absent").is_ok());
    }

    #[test]
    fn a_file_is_there_whole_or_not_at_all_and_replaces_none() {
        let directory = tempfile::tempdir().unwrap();
        let mut half = Arriving::begin(directory.path(), "raw/a.csv").unwrap();
        half.take(b"half").unwrap();
        drop(half);
        let raw = directory.path().join("raw");
        assert_eq!(std::fs::read_dir(&raw).unwrap().count(), 0);

        let mut first = Arriving::begin(directory.path(), "raw/a.csv").unwrap();
        let mut second = Arriving::begin(directory.path(), "raw/a.csv").unwrap();
        first.take(b"first").unwrap();
        second.take(b"second").unwrap();
        first.end().unwrap();
        assert!(matches!(second.end(), Err(Error::AlreadyThere { .. })));
        assert_eq!(std::fs::read(raw.join("a.csv")).unwrap(), b"first");
        assert_eq!(std::fs::read_dir(&raw).unwrap().count(), 1);
        assert!(Arriving::begin(directory.path(), "raw/a.csv").is_err());
    }
}
