//! A run of a scene between two steps, as a file.
//!
//! The file begins with `MAGIC`, the version of its shape, that of windfall, the time and
//! the end of the scene, and digests of the parts of the scene; what the run remembers
//! follows as [`Binary`] values; SHA-256 of all that ends it.

use crate::file::read::ScenePlan;
use crate::file_error::access;
use crate::run_error::SceneRunError;
use sha2::{Digest, Sha256};
use std::fs::File;
use std::io::{BufReader, BufWriter, ErrorKind, Read, Result as IoResult, Write};
use std::path::{Path, PathBuf};
use windfall_files::error::Error;
use windfall_files::provenance::VERSION;
use windfall_files::write_file::replace_file;
use windfall_scene::binary::{Binary, no_value};
use windfall_scene::scene::Scene;

/// How a checkpoint begins.
const MAGIC: [u8; 8] = *b"WFSCENE\n";

/// Version of its shape.
const SHAPE: u32 = 6;

/// Name in the directory of the results.
const NAME: &str = "checkpoint.bin";

/// Where another engine runs, in the directory of the results.
pub const ENGINE_FOLDER: &str = "engine";

/// Bytes of the digest at the end.
const DIGEST: u64 = 32;

/// Digests of the parts of a scene, by their names.
pub type Parts = Vec<(String, String)>;

/// The beginning of a checkpoint.
pub struct CheckpointHead {
    /// Time of the scene; s.
    pub time: f64,
    /// When the scene ends; s.
    pub end: f64,
    /// Of the scene.
    pub parts: Parts,
}

/// Where the checkpoint of a directory lies.
pub fn checkpoint_path(directory: &Path) -> PathBuf {
    directory.join(NAME)
}

/// What a run depends on, part by part; the scene must have its time step.
///
/// Digests are of the values that were read, with cards and meshes, not of the text: comments
/// and the order of keys do not count.
pub fn parts_of(plan: &ScenePlan) -> Parts {
    // All fields are named, so that one more is not forgotten.
    let ScenePlan {
        title,
        scene,
        kinds,
        cards,
        fruit_shares,
        time_step_error: _,
        end,
        least_peak_force,
        record,
        sensors,
        bruise,
        checkpoint,
        given_step: _,
        findings: _,
        seed,
        start,
    } = plan;
    let Scene {
        materials,
        interactions,
        walls,
        fruit,
        sinks,
        gravity,
        air,
        periodic,
        time_step,
    } = scene;
    let mut parts = vec![
        part("the title", title),
        part("materials", materials),
        part("fruit", &(fruit, kinds)),
        part("sinks", sinks),
        part("gravity", gravity),
        part("[air]", air),
        part("the time step", time_step),
        part("the end", end),
        part("the times of checkpoints", checkpoint),
        part("[events]", least_peak_force),
        part("[record]", record),
        part("[[sensors]]", &sensors.all),
        part("[bruise]", bruise),
        part("the seed", seed),
        part(
            "the start",
            &start.as_ref().map(|own| (&own.name, own.time)),
        ),
    ];
    if scene.periods().repeat() {
        parts.push(part("periodic", periodic));
    }
    for (pair, interaction) in interactions {
        let name = format!(
            "contacts of {} and {}",
            materials[pair.0], materials[pair.1]
        );
        let own = (interaction, cards.get(pair), fruit_shares.get(pair));
        parts.push(part(&name, &own));
    }
    parts.push(part("the number of walls", &walls.len()));
    for wall in walls {
        parts.push(part(&format!("wall \"{}\"", wall.name), wall));
    }
    parts
}

/// Feeds what is written as text into a digest; numbers are written to their last bit.
struct Fed(Sha256);

impl std::fmt::Write for Fed {
    fn write_str(&mut self, text: &str) -> std::fmt::Result {
        self.0.update(text.as_bytes());
        Ok(())
    }
}

pub(crate) fn part(name: &str, value: &dyn std::fmt::Debug) -> (String, String) {
    let mut fed = Fed(Sha256::new());
    // A digest takes everything.
    let _ = std::fmt::Write::write_fmt(&mut fed, format_args!("{value:?}"));
    let digest = fed.0.finalize();
    let digest = digest.iter().map(|byte| format!("{byte:02x}")).collect();
    (name.to_owned(), digest)
}

/// Names of what differs between two scenes.
pub fn changed_parts(then: &Parts, now: &Parts) -> Vec<String> {
    let lacks = |own: &&(String, String), other: &Parts| !other.contains(own);
    let gone = then.iter().filter(|own| lacks(own, now));
    let come = now.iter().filter(|own| lacks(own, then));
    let mut names: Vec<String> = Vec::new();
    for (name, _) in gone.chain(come) {
        if !names.contains(name) {
            names.push(name.clone());
        }
    }
    names
}

/// Writes a checkpoint: the one of before or the whole new one is there, whatever happens.
///
/// # Errors
/// The directory cannot be written, or is full; the checkpoint of before is as it was.
pub fn write_checkpoint(
    path: &Path,
    head: &CheckpointHead,
    body: impl Fn(&mut dyn Write) -> IoResult<()>,
) -> Result<(), Error> {
    check_checkpoint(path)?;
    replace_file(path, |file| write_to(file, head, &body))
}

/// Removes a checkpoint, if there is one.
///
/// # Errors
/// It is none, or cannot be removed.
pub fn remove_checkpoint(path: &Path) -> Result<(), Error> {
    check_checkpoint(path)?;
    match std::fs::remove_file(path) {
        Err(error) if error.kind() != ErrorKind::NotFound => Err(access(path, "remove")(error)),
        _ => Ok(()),
    }
}

/// Refuses a file of that name that is no checkpoint.
///
/// # Errors
/// [`Error::NotWrittenHere`].
pub fn check_checkpoint(path: &Path) -> Result<(), Error> {
    let mut found = Vec::new();
    let file = File::open(path);
    let _ = file.and_then(|file| file.take(MAGIC.len() as u64).read_to_end(&mut found));
    match !MAGIC.starts_with(&found) {
        true => Err(Error::NotWrittenHere {
            path: path.to_path_buf(),
        }),
        false => Ok(()),
    }
}

/// Writes what a checkpoint holds: its beginning, the body and their digest.
pub(crate) fn write_to(
    file: &mut File,
    head: &CheckpointHead,
    body: impl Fn(&mut dyn Write) -> IoResult<()>,
) -> IoResult<()> {
    let mut to = Digesting {
        inner: BufWriter::new(file),
        digest: Sha256::new(),
    };
    MAGIC.write(&mut to)?;
    SHAPE.write(&mut to)?;
    VERSION.to_owned().write(&mut to)?;
    [head.time, head.end].write(&mut to)?;
    head.parts.write(&mut to)?;
    body(&mut to)?;
    let Digesting { mut inner, digest } = to;
    inner.write_all(&digest.finalize())?;
    inner.flush()
}

/// Reads a checkpoint.
///
/// * `body`: reads what is behind its beginning
///
/// # Errors
/// It is not there, not whole, of another windfall, or not what `body` can read.
pub fn read_checkpoint<T>(
    path: &Path,
    body: impl FnOnce(&CheckpointHead, &mut dyn Read) -> Result<T, Error>,
) -> Result<T, Error> {
    let damaged = |problem: String| damaged(path, problem);
    let ends_early = |source: std::io::Error| {
        damaged(format!("the checkpoint ends early or is none ({source})"))
    };
    let file = open(path)?;
    let length = file.metadata().map_err(access(path, "read"))?.len();
    let mut from = BufReader::new(file);
    version_of(path, &mut from)?;
    // First whether it is what was written, then what it says.
    let mut from = BufReader::new(open(path)?).take(length.saturating_sub(DIGEST));
    let mut digesting = Digesting {
        inner: std::io::sink(),
        digest: Sha256::new(),
    };
    std::io::copy(&mut from, &mut digesting).map_err(access(path, "read"))?;
    let mut end = Vec::new();
    let mut rest = from.into_inner();
    rest.read_to_end(&mut end).map_err(access(path, "read"))?;
    if end != digesting.digest.finalize()[..] {
        return Err(damaged(
            "the checkpoint is damaged: its digest is another one".to_owned(),
        ));
    }
    let mut from = BufReader::new(open(path)?).take(length - DIGEST);
    version_of(path, &mut from)?;
    let head = head_behind_version(&mut from).map_err(ends_early)?;
    let found = body(&head, &mut from)?;
    match from.limit() {
        0 => Ok(found),
        _ => Err(damaged(
            "the checkpoint says more than this windfall knows".to_owned(),
        )),
    }
}

/// The header of a checkpoint, if it can be read.
pub fn checkpoint_head(path: &Path) -> Option<CheckpointHead> {
    let mut from = BufReader::new(File::open(path).ok()?);
    version_of(path, &mut from).ok()?;
    head_behind_version(&mut from).ok()
}

fn head_behind_version(from: &mut dyn Read) -> IoResult<CheckpointHead> {
    let [time, end] = Binary::read(from)?;
    let parts = Parts::read(from)?;
    Ok(CheckpointHead { time, end, parts })
}

/// Reads up to the version, and refuses another one.
fn version_of(path: &Path, mut from: &mut dyn Read) -> Result<(), Error> {
    let read = |from: &mut dyn Read| -> IoResult<(u32, String)> {
        if <[u8; 8]>::read(from)? != MAGIC {
            return Err(no_value("checkpoint of a scene"));
        }
        let shape = u32::read(from)?;
        // A version is short, whatever a damaged length says.
        let length = usize::read(from)?.min(64);
        let mut text = vec![0; length];
        from.read_exact(&mut text)?;
        Ok((shape, String::from_utf8_lossy(&text).into_owned()))
    };
    let (shape, version) = read(&mut from).map_err(|error| {
        damaged(
            path,
            format!("the checkpoint ends early or is none ({error})"),
        )
    })?;
    if shape == SHAPE && version == VERSION {
        return Ok(());
    }
    let path = path.to_path_buf();
    Err(Error::from(SceneRunError::Version { path, version }))
}

/// The error of a file that a run cannot resume from.
pub fn damaged(path: &Path, problem: String) -> Error {
    let path = path.to_path_buf();
    Error::from(SceneRunError::Damaged { path, problem })
}

fn open(path: &Path) -> Result<File, Error> {
    File::open(path).map_err(access(path, "read"))
}

/// A writer that digests what goes through it.
struct Digesting<W> {
    inner: W,
    digest: Sha256,
}

impl<W: Write> Write for Digesting<W> {
    fn write(&mut self, bytes: &[u8]) -> IoResult<usize> {
        let written = self.inner.write(bytes)?;
        self.digest.update(&bytes[..written]);
        Ok(written)
    }

    fn flush(&mut self) -> IoResult<()> {
        self.inner.flush()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn head() -> CheckpointHead {
        CheckpointHead {
            time: 0.5,
            end: 2.0,
            parts: vec![("gravity".to_owned(), "ab".to_owned())],
        }
    }

    fn read(path: &Path) -> Result<Vec<f64>, String> {
        let body = |head: &CheckpointHead, from: &mut dyn Read| {
            assert_eq!(head.time, 0.5);
            Vec::read(from).map_err(access(path, "read"))
        };
        read_checkpoint(path, body).map_err(|error| error.to_string())
    }

    #[test]
    fn rejects_every_cut_and_every_flipped_bit() {
        let folder = tempfile::tempdir().unwrap();
        let path = checkpoint_path(folder.path());
        let values = vec![0.1, -0.0, 3e300];
        write_checkpoint(&path, &head(), |to| values.write(to)).unwrap();
        assert_eq!(read(&path).unwrap(), values);
        assert_eq!(checkpoint_head(&path).unwrap().end, 2.0);
        let whole = std::fs::read(&path).unwrap();
        for length in 0..whole.len() {
            std::fs::write(&path, &whole[..length]).unwrap();
            let problem = read(&path).unwrap_err();
            assert!(
                problem.contains("checkpoint.bin: the checkpoint"),
                "{length}: {problem}"
            );
        }
        for place in 0..whole.len() {
            let mut other = whole.clone();
            other[place] ^= 1 << (place % 8);
            std::fs::write(&path, other).unwrap();
            let problem = read(&path).unwrap_err();
            assert!(problem.contains("--restart"), "{place}: {problem}");
        }
    }

    #[test]
    fn rejects_another_version() {
        let folder = tempfile::tempdir().unwrap();
        let path = checkpoint_path(folder.path());
        write_checkpoint(&path, &head(), |to| 1.0_f64.write(to)).unwrap();
        let mut bytes = std::fs::read(&path).unwrap();
        // Behind the magic, the shape and the length of the version.
        bytes[20] = b'7';
        std::fs::write(&path, bytes).unwrap();
        let problem = read(&path).unwrap_err();
        assert!(problem.contains("written by windfall 7"), "{problem}");
    }

    #[test]
    fn names_what_changed() {
        let parts = |all: &[(&str, &str)]| -> Parts {
            let own = |&(name, digest): &(&str, &str)| (name.to_owned(), digest.to_owned());
            all.iter().map(own).collect()
        };
        let then = parts(&[("gravity", "1"), ("wall \"bin\"", "2"), ("fruit", "3")]);
        let now = parts(&[("gravity", "1"), ("wall \"lid\"", "2"), ("fruit", "4")]);
        let changed = changed_parts(&then, &now);
        assert_eq!(changed, ["wall \"bin\"", "fruit", "wall \"lid\""]);
        assert!(changed_parts(&now, &now).is_empty());
    }
}
