//! Where tests find their data.
//!
//! Small reference data lie in this crate. Recordings of other people are read in place,
//! from `$WINDFALL_DATA` (default `../shared/data` beside the repository). A test that
//! does not find its data is noted in the file that `$WINDFALL_NOT_MADE` names, so that
//! `scripts/test` can count it.

use std::io::Write;
use std::path::{Path, PathBuf};

/// A file or folder of data, such as `nist/Norris.dat`; `None`, and a note, where it is
/// not there.
pub fn find(name: &str) -> Option<PathBuf> {
    let here = Path::new(env!("CARGO_MANIFEST_DIR")).join("data");
    let found = [here, recordings()].map(|folder| folder.join(name));
    let found = found.into_iter().find(|path| path.exists());
    if found.is_none() {
        note(name);
    }
    found
}

/// Folder of the recordings of other people, whether it is there or not.
pub fn recordings() -> PathBuf {
    let default = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data");
    std::env::var_os("WINDFALL_DATA").map_or(default, PathBuf::from)
}

/// Notes that the running test is not made for want of `what`.
pub fn note(what: &str) {
    let thread = std::thread::current();
    let line = format!("{}: no {what}\n", thread.name().unwrap_or("a test"));
    let Some(path) = std::env::var_os("WINDFALL_NOT_MADE") else {
        return;
    };
    let file = std::fs::OpenOptions::new()
        .create(true)
        .append(true)
        .open(path);
    if let Ok(mut file) = file {
        // One write, so that lines of several tests do not mix.
        let _ = file.write_all(line.as_bytes());
    }
}

#[cfg(test)]
mod tests {
    #[test]
    fn closed_form_small_data_lie_in_the_repository() {
        for name in ["nist/Norris.dat", "fit/data_ref.txt"] {
            assert!(
                super::find(name).is_some_and(|path| path.is_file()),
                "{name}"
            );
        }
    }
}
