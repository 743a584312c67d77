//! What can be wrong with what is kept of a scene.

use std::path::PathBuf;
use windfall_files::error::Fault;

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

/// What can be wrong with what is kept of a scene.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SceneFileError {
    /// Nothing was recorded.
    #[error(
        "{path}: no frames were recorded; add to the scene: [record] frames = \"20 ms\", and run it \
         again", path = path.display()
    )]
    FramesAbsent {
        /// The directory.
        path: PathBuf,
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
        /// What is wrong.
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
        /// What is wrong.
        problem: String,
    },
}
