//! The files of a folder, and their names.

use std::path::{Path, PathBuf};
use windfall_files::error::Error;

/// Files of a folder in the order of their names, hidden ones left out.
pub(crate) fn files_in(folder: &Path) -> Result<Vec<PathBuf>, Error> {
    let entries = std::fs::read_dir(folder);
    let entries = entries.map_err(|source| Error::access(folder, "read", source))?;
    let mut files = Vec::new();
    for entry in entries {
        let entry = entry.map_err(|source| Error::access(folder, "read", source))?;
        if entry.path().is_file() && !name_of(&entry.path()).starts_with('.') {
            files.push(entry.path());
        }
    }
    files.sort();
    Ok(files)
}

/// The name of a file, as text.
pub(crate) fn name_of(file: &Path) -> String {
    let name = file.file_name().unwrap_or_default();
    name.to_string_lossy().into_owned()
}
