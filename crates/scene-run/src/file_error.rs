//! Errors in the stored results of a scene.

use serde::Serialize;
use std::path::{Path, PathBuf};
use windfall_files::error::{Error, Fault};
use windfall_files::inputs::check_output;
use windfall_files::write_file::write_whole;

/// What a system's error becomes: the file, and what was done with it.
pub fn access(path: &Path, action: &'static str) -> impl Fn(std::io::Error) -> Error {
    let path = path.to_path_buf();
    move |source| Error::FileAccess {
        path: path.clone(),
        action,
        source,
    }
}

/// Writes a result as indented JSON.
///
/// * `title`: of the result, for messages
///
/// # Errors
/// The file cannot be written, or the result is no JSON.
pub(crate) fn write_json(path: &Path, title: &str, result: &impl Serialize) -> Result<(), Error> {
    let json = serde_json::to_string_pretty(result).map_err(|error| Error::ResultUnwritable {
        item: title.to_owned(),
        detail: error.to_string(),
    })?;
    write_whole(path, (json + "\n").as_bytes())
}

/// Makes a directory, with those above it.
pub fn make_directory(path: &Path) -> Result<(), Error> {
    check_output(path)?;
    std::fs::create_dir_all(path).map_err(access(path, "create"))
}

impl Fault for SceneFileError {
    fn is_request(&self) -> bool {
        true
    }

    fn is_absence(&self) -> bool {
        matches!(
            self,
            Self::FramesAbsent { .. } | Self::RunUnknown { .. } | Self::FruitUnknown { .. }
        )
    }
}

/// Errors in the stored results of a scene.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SceneFileError {
    /// Nothing was recorded.
    #[error("{path}: {problem}", path = path.display())]
    FramesAbsent {
        /// The directory.
        path: PathBuf,
        /// Why, and what to do.
        problem: &'static str,
    },
    /// A file that is no file of frames, or a damaged one.
    #[error(
        "{path}: {problem} (at byte {byte}); run the scene again to make it anew",
        path = path.display()
    )]
    FramesDamaged {
        /// The file.
        path: PathBuf,
        /// Where.
        byte: u64,
        /// The problem.
        problem: &'static str,
    },
    /// A file of frames of a newer windfall.
    #[error(
        "{path}: these frames were written by a newer windfall (version {found}, this one reads {known}); \
         install the newer windfall, or run the scene again", path = path.display()
    )]
    FramesNewer {
        /// The file.
        path: PathBuf,
        /// Version found.
        found: u32,
        /// Version that this windfall reads.
        known: u32,
    },
    /// No scene of that name.
    #[error("there are no results of a scene \"{id}\" here")]
    RunUnknown {
        /// The name.
        id: String,
    },
    /// No fruit of that number.
    #[error("the scene has no fruit {fruit}; they are numbered from 1 to {count}")]
    FruitUnknown {
        /// The number.
        fruit: u64,
        /// Fruit in all.
        count: usize,
    },
    /// A table that lacks a column, or holds something else than a number.
    #[error("{path}, line {line}: {problem}; run the scene again to make it anew", path = path.display())]
    TableDamaged {
        /// The file.
        path: PathBuf,
        /// Its line.
        line: u64,
        /// The problem.
        problem: String,
    },
}
