//! Results of scenes below a directory, for the page.

use crate::campaign_view::name_of;
use crate::workspace::Workspace;
use itertools::Itertools;
use serde::Serialize;
use serde_json::Value;
use std::path::{Path, PathBuf};
use windfall_draw::colour_map::{colour_of, css};
use windfall_files::confined::{check_inside, path_inside, read_inside};
use windfall_files::error::Error;
use windfall_scene_run::file_error::SceneFileError;
use windfall_scene_run::frames::read::{SceneFrames, frames_file};
use windfall_scene_run::frames::view::largest_values;
use windfall_scene_run::run::frame_format::FramesAbout;

/// Ending of directories with results of scenes.
const RUN: &str = "run";

/// What a scene came to, in its directory.
const RESULT: &str = "scene.json";

/// Bytes of frames that are answered at once, where one frame is not longer.
const PIECE: u64 = 4 << 20;

/// Colours of the scale.
const COLOURS: usize = 64;

/// Results of a scene in a list.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct SceneEntry {
    /// Its directory below the one that is served.
    pub id: String,
    /// Title.
    pub title: String,
    /// Fruit in all.
    pub fruit: Option<u64>,
    /// Contacts in all.
    pub contacts: Option<u64>,
    /// When it ended; s.
    pub end: Option<f64>,
    /// Whether it can be played.
    pub frames: bool,
    /// Why it cannot be read.
    pub problem: Option<String>,
}

/// A scene that can be played.
#[derive(Clone, Debug, Serialize, utoipa::ToSchema)]
pub struct SceneView {
    /// Its directory below the one that is served.
    pub id: String,
    /// What its frames are about.
    pub about: FramesAbout,
    /// Radius of each fruit; m.
    pub radii: Vec<f32>,
    /// Vertices of each wall at rest, three numbers each; m.
    pub vertices: Vec<Vec<f32>>,
    /// Numbers of the vertices of each face of each wall.
    pub faces: Vec<Vec<u32>>,
    /// Time of each frame; s.
    pub times: Vec<f64>,
    /// Fruit in each frame.
    pub counts: Vec<u32>,
    /// Force of the last colour; N.
    pub most: f64,
    /// Speed of the last colour, where fruit are coloured by their speed; m/s.
    pub fastest: f64,
    /// Colours from no force to the largest.
    pub colours: Vec<String>,
    /// What the scene came to; nothing while it runs.
    #[schema(value_type = Option<windfall_scene_run::run::outcome::SceneOutcome>)]
    pub outcome: Option<Value>,
}

/// Scene results in the served directory, in those in it, and one level below.
///
/// # Errors
/// The directory cannot be read.
pub fn scene_runs(workspace: &Workspace) -> Result<Vec<SceneEntry>, Error> {
    let root = workspace.root();
    if holds_run(root) {
        return Ok(vec![entry_of(root, name_of(root))]);
    }
    let mut found = Vec::new();
    for name in folders(root)? {
        let path = root.join(&name);
        if is_run(&path) {
            found.push(entry_of(&path, name));
            continue;
        }
        for inner in folders(&path).unwrap_or_default() {
            let path = path.join(&inner);
            if is_run(&path) {
                found.push(entry_of(&path, format!("{name}/{inner}")));
            }
        }
    }
    Ok(found)
}

/// The directory of the results of a scene.
///
/// # Errors
/// There is none of that name.
pub fn scene_run(workspace: &Workspace, id: &str) -> Result<PathBuf, Error> {
    let root = workspace.root();
    let unknown = || Error::from(SceneFileError::RunUnknown { id: id.to_owned() });
    if holds_run(root) && id == name_of(root) {
        return Ok(root.to_path_buf());
    }
    if id.split('/').count() > 2 {
        return Err(unknown());
    }
    // A name that is refused is that of no scene.
    let path = path_inside(root, id).map_err(|_| unknown())?;
    if !is_run(&path) {
        return Err(unknown());
    }
    for file in ["events.csv", "fruit.csv"] {
        path_inside(&path, file)?;
    }
    Ok(path)
}

/// The frames of a run, where they are in its directory.
fn frames_of(directory: &Path) -> Result<PathBuf, Error> {
    let file = frames_file(directory)?;
    check_inside(directory, &file)?;
    Ok(file)
}

fn is_run(path: &Path) -> bool {
    path.extension().is_some_and(|ending| ending == RUN) && holds_run(path)
}

fn holds_run(path: &Path) -> bool {
    path.join(RESULT).is_file() || frames_file(path).is_ok()
}

/// Directories in a directory that are named plainly, by name.
fn folders(directory: &Path) -> Result<Vec<String>, Error> {
    let failed = |source| Error::access(directory, "read", source);
    let entries = std::fs::read_dir(directory).map_err(failed)?.flatten();
    let own = entries.filter(|entry| entry.file_type().is_ok_and(|kind| kind.is_dir()));
    let names = own.filter_map(|entry| entry.file_name().into_string().ok());
    let plain = names.filter(|name| path_inside(directory, name).is_ok());
    Ok(plain.sorted().collect())
}

fn entry_of(path: &Path, id: String) -> SceneEntry {
    let frames = frames_of(path).and_then(|file| SceneFrames::open(&file));
    let result = result_of(path);
    let number = |key: &str| result.as_ref().and_then(|own| own[key].as_u64());
    let title = result.as_ref().and_then(|own| own["title"].as_str());
    let absent =
        |problem: &Error| matches!(problem.of_room(), Some(SceneFileError::FramesAbsent { .. }));
    let problem = frames.as_ref().err().filter(|own| !absent(own));
    SceneEntry {
        title: title.map_or_else(|| id.clone(), str::to_owned),
        fruit: number("fruit"),
        contacts: number("contacts"),
        end: result.as_ref().and_then(|own| own["end"].as_f64()),
        frames: frames.is_ok(),
        problem: problem.map(ToString::to_string),
        id,
    }
}

fn result_of(path: &Path) -> Option<Value> {
    serde_json::from_slice(&read_inside(path, RESULT).ok()?).ok()
}

/// A scene with its walls and the times of its frames.
///
/// # Errors
/// There are no frames, or they cannot be read.
pub fn scene_view(directory: &Path, id: String) -> Result<SceneView, Error> {
    let mut frames = SceneFrames::open(&frames_of(directory)?)?;
    let largest = largest_values(&mut frames)?;
    let step = |k: usize| css(colour_of(k as f64 / (COLOURS - 1) as f64));
    let walls = frames.walls.iter();
    let vertices = walls.map(|wall| wall.vertices.as_flattened().to_vec());
    Ok(SceneView {
        id,
        vertices: vertices.collect(),
        faces: frames.walls.iter().map(|wall| wall.faces.clone()).collect(),
        times: frames.frames.iter().map(|own| own.time).collect(),
        counts: frames.frames.iter().map(|own| own.fruit).collect(),
        most: largest.force,
        fastest: largest.speed,
        colours: (0..COLOURS).map(step).collect(),
        outcome: result_of(directory),
        radii: std::mem::take(&mut frames.radii),
        about: frames.about,
    })
}

/// Bytes of whole frames from a number on: at least one, unless behind the last.
///
/// # Errors
/// They cannot be read.
pub fn scene_frames_from(directory: &Path, from: usize) -> Result<Vec<u8>, Error> {
    SceneFrames::open(&frames_of(directory)?)?.bytes(from, PIECE)
}

/// Fruit of a scene in all.
///
/// # Errors
/// Its frames cannot be read.
pub fn scene_fruit_count(directory: &Path) -> Result<usize, Error> {
    let known = result_of(directory).and_then(|own| own["fruit"].as_u64());
    match known {
        Some(count) => Ok(count as usize),
        None => Ok(SceneFrames::open(&frames_of(directory)?)?.about.fruit),
    }
}
