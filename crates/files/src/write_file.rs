//! Files that are there whole or not at all.

use crate::error::Error;
use std::fs::File;
use std::io::Write;
use std::path::Path;

/// Writes a file beside its place and moves it there: whoever reads it, and whatever
/// stops the writing, the file of before or the whole new one is there.
///
/// # Errors
/// The directory cannot be written, or is full; the file of before is as it was.
pub fn write_whole(path: &Path, contents: &[u8]) -> Result<(), Error> {
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
