//! A checkpoint of the ranks of LAMMPS, in the directory of their deck.
//!
//! `checkpoint.bin` says what belongs to it: the restart file of LAMMPS, what each rank
//! remembers, and how much of each part of the pulses counts. The others have two names, in
//! turn: those of the checkpoint before stay whole until `checkpoint.bin` names the new ones.

use crate::lammps::deck::restart_name;
use crate::program::wrong;
use crate::ranks::part::{part_name, partial_name};
use std::fs::File;
use std::io::{Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};
use windfall_files::error::Error;
use windfall_files::provenance::{digest_of_file, digest_text};
use windfall_scene::binary;
use windfall_scene::binary::Binary;
use windfall_scene::share_state::ShareState;
use windfall_scene_run::SceneRunError;
use windfall_scene_run::file::engine_kind::Engine;
use windfall_scene_run::file_error::access;
use windfall_scene_run::run::checkpoint::{
    CheckpointHead, Parts, changed_parts, checkpoint_path, damaged, read_checkpoint,
    remove_checkpoint, write_checkpoint,
};
use windfall_scene_run::run::growing::remove_earlier;

/// What a checkpoint consists of.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Kept {
    /// Version of LAMMPS as year, month and day.
    pub engine: u32,
    /// Ranks that wrote it.
    pub ranks: usize,
    /// Frames so far.
    pub frames: u64,
    /// Which of the two names its files have: 0 or 1.
    pub turn: u64,
    /// SHA-256 of the restart file.
    pub restart: String,
    /// Bytes of each part of the pulses that count.
    pub parts: Vec<u64>,
    /// The fruit that comes next, from 1, and the step at which it is tried next.
    pub coming: u64,
    pub next: u64,
}

binary!(Kept {
    engine,
    ranks,
    frames,
    turn,
    restart,
    parts,
    coming,
    next
});

/// How a restart file of LAMMPS ends.
const RESTART_END: &[u8; 16] = b"LammpS RestartT\0";
/// Name of the part of a scene that stands for its deck.
const DECK: &str = "the deck (--classes, --frame-steps)";

/// What a checkpoint depends on: the scene, and the deck without its comments.
pub(crate) fn parts_with_deck(scene: &Parts, deck: &str) -> Parts {
    let lines: Vec<&str> = deck.lines().filter(|own| !own.starts_with('#')).collect();
    let mut parts = scene.clone();
    parts.push((DECK.to_owned(), digest_text(&lines.join("\n"))));
    parts
}

/// The restart file of LAMMPS.
pub(crate) fn restart_path(directory: &Path, turn: u64) -> PathBuf {
    directory.join(restart_name(turn))
}

/// What a rank remembers.
fn state_path(directory: &Path, turn: u64, rank: usize) -> PathBuf {
    directory.join(format!("checkpoint.{turn}.{rank}.bin"))
}

/// Writes what a rank remembers.
///
/// # Errors
/// It cannot be written.
pub(crate) fn write_state(
    directory: &Path,
    (turn, rank): (u64, usize),
    head: &CheckpointHead,
    state: &ShareState,
) -> Result<(), Error> {
    let path = state_path(directory, turn, rank);
    write_checkpoint(&path, head, |to| state.write(to))
}

/// What some of the ranks remembered that one has now to go on with: each so many-th.
///
/// # Errors
/// A file is absent, damaged, or of another checkpoint.
pub(crate) fn read_states(
    directory: &Path,
    kept: &Kept,
    (rank, ranks): (usize, usize),
) -> Result<Vec<ShareState>, Error> {
    let numbers = (0..kept.ranks).skip(rank).step_by(ranks);
    let read = numbers.map(|number| {
        let path = state_path(directory, kept.turn, number);
        read_whole(&path, |from| {
            let unread = |error| damaged(&path, format!("the checkpoint is {error}"));
            ShareState::read(from).map_err(unread)
        })
    });
    read.collect()
}

/// Makes a checkpoint of what all ranks have written.
///
/// # Errors
/// LAMMPS has not written its part whole; the directory cannot be written.
pub(crate) fn write_kept(
    directory: &Path,
    head: &CheckpointHead,
    mut kept: Kept,
) -> Result<(), Error> {
    let restart = restart_path(directory, kept.turn);
    let failed = access(&restart, "write");
    let mut file = File::open(&restart).map_err(&failed)?;
    let mut end = [0; RESTART_END.len()];
    let behind = file.seek(SeekFrom::End(-(RESTART_END.len() as i64)));
    let read = behind.and_then(|_| file.read_exact(&mut end));
    if read.is_err() || end != *RESTART_END {
        let problem = format!(
            "{}: LAMMPS has not written its restart file whole: is the disk full?",
            restart.display()
        );
        return Err(wrong(Engine::Lammps, problem));
    }
    file.sync_all().map_err(&failed)?;
    kept.restart = digest_of_file(&restart)?;
    write_checkpoint(&checkpoint_path(directory), head, |to| kept.write(to))
}

/// The checkpoint of a directory, from which a run of this scene goes on.
///
/// * `parts`: see [`parts_with_deck`]
/// * `engine`: version of LAMMPS, where it is known
///
/// # Errors
/// It is damaged, incomplete, or of another scene, LAMMPS or windfall.
pub(crate) fn read_kept(
    directory: &Path,
    parts: &Parts,
    engine: Option<u32>,
) -> Result<Kept, Error> {
    let path = checkpoint_path(directory);
    let kept = read_checkpoint(&path, |head, from| {
        let mut changed = changed_parts(&head.parts, parts);
        if changed.len() > 1 {
            // It follows from the others.
            changed.retain(|own| own != DECK);
        }
        if !changed.is_empty() {
            let path = path.clone();
            return Err(Error::from(SceneRunError::Changed { path, changed }));
        }
        let unread = |error| damaged(&path, format!("the checkpoint is {error}"));
        Kept::read(from).map_err(unread)
    })?;
    if let Some(engine) = engine.filter(|own| *own != kept.engine) {
        let problem = format!(
            "{}: the checkpoint was written by LAMMPS {}, this is {engine}: go on with that version, \
             or begin anew with --restart",
            path.display(),
            kept.engine
        );
        return Err(wrong(Engine::Lammps, problem));
    }
    let restart = restart_path(directory, kept.turn);
    if !digest_of_file(&restart).is_ok_and(|own| own == kept.restart) {
        let problem = "LAMMPS's part of the checkpoint is damaged: its digest is another one";
        return Err(damaged(&restart, problem.to_owned()));
    }
    for (number, length) in kept.parts.iter().enumerate() {
        let part = present_part(directory, number);
        let there = std::fs::metadata(&part).map_or(0, |own| own.len());
        if there < *length {
            let problem = format!(
                "the pulses have {there} bytes, and the checkpoint goes on behind {length} of them"
            );
            return Err(damaged(&part, problem));
        }
    }
    Ok(kept)
}

/// Whether all that ranks remembered is whole.
///
/// # Errors
/// Which is not.
pub(crate) fn check_states(directory: &Path, kept: &Kept) -> Result<(), Error> {
    (0..kept.ranks).try_for_each(|rank| {
        let path = state_path(directory, kept.turn, rank);
        read_whole(&path, |from| {
            let read = std::io::copy(from, &mut std::io::sink());
            read.map(|_| ()).map_err(access(&path, "read"))
        })
    })
}

fn read_whole<T>(
    path: &Path,
    body: impl FnOnce(&mut dyn Read) -> Result<T, Error>,
) -> Result<T, Error> {
    match path.exists() {
        true => read_checkpoint(path, |_, from| body(from)),
        false => Err(damaged(
            path,
            "the checkpoint needs it, and it is not there".to_owned(),
        )),
    }
}

/// A part under the name that it has: one whose run was stopped in its last moment is whole.
pub(crate) fn present_part(directory: &Path, number: usize) -> PathBuf {
    let partial = directory.join(partial_name(number));
    match partial.exists() {
        true => partial,
        false => directory.join(part_name(number)),
    }
}

/// Removes a checkpoint, and what belongs to it.
///
/// # Errors
/// A file of such a name is of somebody else, or cannot be removed.
pub(crate) fn remove_kept(directory: &Path) -> Result<(), Error> {
    remove_checkpoint(&checkpoint_path(directory))?;
    for turn in 0..2 {
        remove_earlier(&restart_path(directory, turn))?;
    }
    for entry in std::fs::read_dir(directory).into_iter().flatten().flatten() {
        let name = entry.file_name();
        let own = name.to_str().and_then(|own| {
            let own = own.strip_prefix("checkpoint.")?.strip_suffix(".bin")?;
            let (turn, rank) = own.split_once('.')?;
            rank.parse::<usize>()
                .ok()
                .filter(|_| ["0", "1"].contains(&turn))
        });
        if own.is_some() {
            remove_checkpoint(&entry.path())?;
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use windfall_files::scratch::Scratch;

    #[test]
    fn rejects_checkpoints_of_another_lammps_and_of_another_scene() {
        let folder = Scratch::temporary().unwrap();
        let folder = folder.path();
        let parts = |deck: &str| parts_with_deck(&vec![("fruit".into(), "ab".into())], deck);
        let head = CheckpointHead {
            time: 0.5,
            end: 2.0,
            parts: parts("# A title\nrun 3\n"),
        };
        std::fs::write(restart_path(folder, 1), RESTART_END).unwrap();
        let kept = Kept {
            engine: 20_210_929,
            ranks: 2,
            frames: 7,
            turn: 1,
            restart: String::new(),
            parts: Vec::new(),
            coming: 4,
            next: 9,
        };
        write_kept(folder, &head, kept).unwrap();
        let read = |deck: &str, engine: u32| {
            let read = read_kept(folder, &parts(deck), Some(engine));
            read.map(|own| own.next).map_err(|error| error.to_string())
        };
        // Comments do not count.
        assert_eq!(read("# Another title\nrun 3\n", 20_210_929), Ok(9));
        let problem = read("run 3\n", 20_220_623).unwrap_err();
        assert!(
            problem.contains("written by LAMMPS 20210929, this is 20220623"),
            "{problem}"
        );
        let problem = read("run 4\n", 20_210_929).unwrap_err();
        assert!(
            problem.contains("changed: the deck (--classes"),
            "{problem}"
        );
        // What LAMMPS wrote on a full disk.
        std::fs::write(restart_path(folder, 0), "LammpS Re").unwrap();
        let mut kept = read_kept(folder, &parts("run 3\n"), None).unwrap();
        kept.turn = 0;
        let problem = write_kept(folder, &head, kept).unwrap_err().to_string();
        assert!(problem.contains("is the disk full"), "{problem}");
        // LAMMPS's part is there but of the checkpoint before.
        std::fs::write(restart_path(folder, 1), "other").unwrap();
        let problem = read("run 3\n", 20_210_929).unwrap_err();
        assert!(
            problem.contains("checkpoint.1.lammps: LAMMPS's part"),
            "{problem}"
        );
    }
}
