//! Whether a run was stopped in a directory, and what to do about it.

use crate::run::checkpoint::{ENGINE_FOLDER, checkpoint_head, checkpoint_path};
use crate::run::tables::is_written;
use crate::run_error::SceneRunError;
use std::path::{Path, PathBuf};
use windfall_files::error::Error;

/// How to treat a run that was stopped.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SceneStart {
    /// Refuse to overwrite it.
    #[default]
    Fresh,
    /// Resume from its checkpoint.
    Resume,
    /// Start over.
    Restart,
}

/// Who makes the checkpoints of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Keeper {
    /// The run itself, with all that it holds.
    Run,
    /// The other engine that moves the fruit, in a folder of its own.
    Engine,
}

impl Keeper {
    /// Where its checkpoint lies.
    pub fn path(self, directory: &Path) -> PathBuf {
        match self {
            Self::Run => checkpoint_path(directory),
            Self::Engine => checkpoint_path(&directory.join(ENGINE_FOLDER)),
        }
    }

    fn other(self) -> Self {
        match self {
            Self::Run => Self::Engine,
            Self::Engine => Self::Run,
        }
    }
}

/// Whether a run goes on from a checkpoint in its directory.
///
/// # Errors
/// There is a run that could go on, or none that is to; it was another engine's; another process
/// is running it.
pub fn goes_on(directory: &Path, start: SceneStart, keeper: Keeper) -> Result<bool, Error> {
    let events = directory.join("events.csv");
    let going = is_written(&events);
    if going == Some(true) {
        return Err(Error::from(SceneRunError::Busy { path: events }));
    }
    // The table gets its name as the last of all: what is without it is done.
    let stopped = |keeper: Keeper| going.is_some() && keeper.path(directory).exists();
    let directory = directory.to_path_buf();
    match start {
        SceneStart::Fresh => {
            let all = [keeper, keeper.other()];
            let Some(own) = all.into_iter().find(|own| stopped(*own)) else {
                return Ok(false);
            };
            let head = checkpoint_head(&own.path(&directory));
            let at = head.map(|head| [head.time, head.end]);
            Err(Error::from(SceneRunError::Unfinished { directory, at }))
        }
        SceneStart::Resume if going.is_none() => {
            Err(Error::from(SceneRunError::NothingToResume { directory }))
        }
        SceneStart::Resume if !stopped(keeper) && stopped(keeper.other()) => {
            Err(Error::from(SceneRunError::OtherEngine { directory }))
        }
        SceneStart::Resume => Ok(stopped(keeper)),
        SceneStart::Restart => Ok(false),
    }
}
