//! Errors of a scene's run.

use std::path::PathBuf;
use windfall_files::error::Fault;

/// Version of windfall.
const VERSION: &str = env!("CARGO_PKG_VERSION");

/// Why a run does not start or stops.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SceneRunError {
    /// A stopped run could be resumed.
    #[error(
        "{directory} holds a run that was stopped{}: with --resume it goes on from there; with \
         --restart the scene begins anew, and what that run did is lost",
        at_of(*.at), directory = directory.display()
    )]
    Unfinished {
        /// Of its results.
        directory: PathBuf,
        /// Time of its checkpoint, and when the scene ends; s.
        at: Option<[f64; 2]>,
    },
    /// Another process is running it.
    #[error(
        "{path}: another windfall is running this scene; wait until it is done, or write into \
         another directory with --out", path = path.display()
    )]
    Busy {
        /// The table that it writes.
        path: PathBuf,
    },
    /// There is no stopped run.
    #[error(
        "{directory} holds no run that was stopped; without --resume the scene begins anew",
        directory = directory.display()
    )]
    NothingToResume {
        /// Of the results.
        directory: PathBuf,
    },
    /// The stopped run is one of another engine.
    #[error(
        "{directory} holds a run that was stopped on another engine: go on with the --engine that it \
         had, or begin anew with --restart", directory = directory.display()
    )]
    OtherEngine {
        /// Of its results.
        directory: PathBuf,
    },
    /// The scene has changed.
    #[error(
        "{path}: the scene has changed since the run was stopped, and a run cannot go on with \
         another scene; changed: {changed}. Put the scene back as it was, or begin anew with \
         --restart", path = path.display(), changed = changed.join(", ")
    )]
    Changed {
        /// The checkpoint.
        path: PathBuf,
        /// What differs.
        changed: Vec<String>,
    },
    /// The file is damaged.
    #[error(
        "{path}: {problem}; the run cannot go on from there, and nothing was changed: put the file \
         back from a copy, or begin anew with --restart", path = path.display()
    )]
    Damaged {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        problem: String,
    },
    /// Written by another windfall.
    #[error(
        "{path}: the checkpoint was written by windfall {version}, this is {VERSION}: go on with \
         that version, or begin anew with --restart", path = path.display()
    )]
    Version {
        /// The checkpoint.
        path: PathBuf,
        /// Of that windfall.
        version: String,
    },
    /// The scene's results would mean nothing from there on.
    #[error("the scene was stopped: {0}")]
    Failed(windfall_scene::error::Error),
    /// It was cancelled.
    #[error(
        "stopped at {now:.6} s of {end} s; what was done up to {kept:.6} s is kept: the same command \
         with --resume goes on from there"
    )]
    Stopped {
        /// When, in the scene; s.
        now: f64,
        /// When it would have ended; s.
        end: f64,
        /// Time of the last checkpoint; s.
        kept: f64,
    },
    /// A full disk, or a read-only directory.
    #[error("{path}: cannot write: {source}. {}", kept_of(*.kept), path = path.display())]
    Unwritable {
        /// What cannot be written.
        path: PathBuf,
        /// What the system says.
        source: std::io::Error,
        /// Time of the last checkpoint, where there is one; s.
        kept: Option<f64>,
    },
}

fn at_of(at: Option<[f64; 2]>) -> String {
    at.map_or(String::new(), |[at, end]| {
        format!(" after {at:.6} s of {end} s")
    })
}

fn kept_of(kept: Option<f64>) -> String {
    match kept {
        Some(kept) => format!(
            "What was done up to {kept:.6} s is kept: make room, and the same command with \
             --resume goes on from there"
        ),
        None => "Make room and run the scene again; the results of before are as they were".into(),
    }
}

impl Fault for SceneRunError {
    fn is_request(&self) -> bool {
        matches!(
            self,
            Self::Unfinished { .. }
                | Self::NothingToResume { .. }
                | Self::OtherEngine { .. }
                | Self::Changed { .. }
        )
    }
}

/// A scene whose result would mean nothing.
pub fn stopped_scene(problem: windfall_scene::error::Error) -> windfall_files::error::Error {
    SceneRunError::Failed(problem).into()
}
