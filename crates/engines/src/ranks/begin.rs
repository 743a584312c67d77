//! How ranks begin: anew, or from a checkpoint in the directory of their deck.

use crate::ranks::checkpoint::{Kept, read_kept, remove_kept, restart_path};
use crate::ranks::part::{partial_name, remove_parts};
use crate::running::make_room;
use std::path::Path;
use windfall_files::error::Error;
use windfall_scene_run::SceneRunError;
use windfall_scene_run::run::checkpoint::{Parts, checkpoint_head, checkpoint_path};
use windfall_scene_run::run::stopped::SceneStart;

/// The checkpoint from which ranks go on, where they do.
///
/// * `engine`: version of LAMMPS
///
/// # Errors
/// There is a run that could go on, or none that is to; the checkpoint cannot be used.
pub(crate) fn kept_of(
    directory: &Path,
    start: SceneStart,
    (parts, engine): (&Parts, u32),
) -> Result<Option<Kept>, Error> {
    let path = checkpoint_path(directory);
    let stopped = path.exists();
    let begun = || directory.join(partial_name(0)).exists();
    let directory = directory.to_path_buf();
    match start {
        SceneStart::Resume if stopped => read_kept(&directory, parts, Some(engine)).map(Some),
        SceneStart::Resume if !begun() => {
            Err(Error::from(SceneRunError::NothingToResume { directory }))
        }
        SceneStart::Fresh if stopped => {
            let at = checkpoint_head(&path).map(|head| [head.time, head.end]);
            Err(Error::from(SceneRunError::Unfinished { directory, at }))
        }
        _ => Ok(None),
    }
}

/// Makes room for what ranks write: of an earlier run the rest stays from which they go on.
///
/// # Errors
/// Somebody else's files are there.
pub(crate) fn make_way(directory: &Path, kept: Option<&Kept>) -> Result<(), Error> {
    if kept.is_none() {
        remove_kept(directory)?;
    }
    remove_parts(directory, kept.map_or(0, |own| own.parts.len()))?;
    let restarts = [0, 1].map(|turn| restart_path(directory, turn));
    let restarts = restarts.iter().filter_map(|own| own.file_name()?.to_str());
    make_room(directory, &restarts.collect::<Vec<_>>())
}
