//! The state at the end of a run, and scenes that begin there.
//!
//! The file has the shape of a checkpoint. A scene that begins there has the fruit, walls and
//! materials of the run; walls may begin to move, more walls, sinks and materials may be behind
//! them, and gravity, air, time step and all that is recorded may be others.

use crate::file::read::{END_FILE, ScenePlan, StartPlan};
use crate::file_error::access;
use crate::run::checkpoint::{
    CheckpointHead, Parts, checkpoint_head, damaged, part, read_checkpoint, write_to,
};
use crate::run::growing::remove_earlier;
use crate::run::outcome::Tally;
use crate::run_error::stopped_scene;
use std::path::{Path, PathBuf};
use windfall_files::error::Error;
use windfall_files::write_file::write_streamed;
use windfall_scene::binary::Binary;
use windfall_scene::motion::simulation::{Leaving, Simulation};
use windfall_scene::scene::Scene;
use windfall_scene::state::State;
use windfall_scene::vector::{Vector, length, subtract};

/// Where walls may be elsewhere than they were; m.
const ELSEWHERE: f64 = 1e-6;
/// Points by which the place of a wall is told; m.
const MARKS: [Vector; 3] = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];

/// Where the state at the end of a run lies.
pub fn end_path(directory: &Path) -> PathBuf {
    directory.join(END_FILE)
}

/// What must be in both scenes, part by part.
fn parts_of_state(plan: &ScenePlan) -> Parts {
    let Scene {
        materials,
        interactions,
        walls,
        fruit,
        sinks,
        periodic,
        ..
    } = &plan.scene;
    let mut parts = vec![part(
        "[[fruit]] or the seed, of which fruit are drawn",
        fruit,
    )];
    parts.push(part("periodic of [scene]", periodic));
    for (number, own) in materials.iter().enumerate() {
        parts.push(part(&format!("material \"{own}\""), &(number, own)));
    }
    for (number, own) in walls.iter().enumerate() {
        let name = format!("wall \"{}\"", own.name);
        parts.push(part(&name, &(number, own.material, &own.shape)));
    }
    for (number, own) in sinks.iter().enumerate() {
        parts.push(part(&format!("sink {}", number + 1), &(number, own)));
    }
    for (pair, own) in interactions {
        let [a, b] = [pair.0, pair.1].map(|own| &materials[own]);
        parts.push(part(&format!("contacts of {a} and {b}"), &(pair, own)));
    }
    parts
}

/// Places of the marks of each wall; m.
fn places(scene: &Scene, time: f64) -> Vec<[Vector; 3]> {
    let walls = scene.walls.iter();
    walls
        .map(|wall| MARKS.map(|mark| wall.motion.moved(mark, time)))
        .collect()
}

/// Writes the state at the end of a run; the file.
///
/// # Errors
/// The directory cannot be written, or is full.
pub fn save_end(
    plan: &ScenePlan,
    simulation: &mut Simulation,
    tally: &Tally,
    directory: &Path,
) -> Result<PathBuf, Error> {
    let path = end_path(directory);
    let time = simulation.time();
    let head = CheckpointHead {
        time,
        end: plan.end,
        parts: parts_of_state(plan),
    };
    let places = places(&plan.scene, time);
    let left: Vec<Option<Leaving>> = tally.fruit.iter().map(|own| own.left).collect();
    let state = simulation.checkpoint();
    write_streamed(&path, |file| {
        let written = write_to(file, &head, |to| {
            places.write(to)?;
            left.write(to)?;
            state.write(to)
        });
        written.map_err(access(&path, "write"))
    })?;
    Ok(path)
}

/// Removes the state of an earlier run.
///
/// # Errors
/// It cannot be removed.
pub fn remove_end(directory: &Path) -> Result<(), Error> {
    remove_earlier(&end_path(directory))
}

/// Reads when a scene begins, and makes its time step one of which a whole number came before.
///
/// # Errors
/// The run at whose end it begins has none that can be read, ends too late, or is the one that is to
/// be written.
pub fn find_start(plan: &mut ScenePlan, out: &Path) -> Result<(), Error> {
    let Some(start) = &mut plan.start else {
        return Ok(());
    };
    let refused = |problem: String| {
        let place = start.place.clone();
        Err(Error::Refused { place, problem })
    };
    let same = |path: &Path| path.canonicalize().ok();
    if same(out).is_some_and(|own| Some(own) == same(&start.directory)) {
        return refused(format!(
            "[scene] start = \"{}\" is where the results of this scene go: write them elsewhere with \
             --out",
            start.name
        ));
    }
    let path = end_path(&start.directory);
    let Some(head) = checkpoint_head(&path) else {
        // Says what is wrong with it.
        return read_checkpoint(&path, |_, _| Ok(())).map_err(|error| of_start(start, error));
    };
    if head.time >= plan.end {
        return refused(format!(
            "[scene] start = \"{}\" ended at {:.6} s, and this scene ends at {} s: times go on from \
             that run, so give a later end",
            start.name, head.time, plan.end
        ));
    }
    start.time = head.time;
    let steps = head.time / plan.scene.time_step;
    if (steps - steps.round()).abs() > 1e-6 {
        plan.scene.time_step = head.time / steps.ceil();
    }
    Ok(())
}

/// An error of the file of a start, in place of what it says of runs that are resumed.
fn of_start(start: &StartPlan, error: Error) -> Error {
    if matches!(error, Error::Refused { .. }) {
        return error;
    }
    let text = error.to_string();
    let text = text.split("; the run cannot go on").next().unwrap_or(&text);
    let text = text
        .split(": go on with that version")
        .next()
        .unwrap_or(text);
    Error::Refused {
        place: start.place.clone(),
        problem: format!(
            "[scene] start = \"{}\" cannot be used: {text}. Run that scene again",
            start.name
        ),
    }
}

/// A scene at the end of the run where it begins, and the fruit that had left it.
///
/// # Errors
/// The file is damaged, or of a scene with other fruit, walls or materials.
pub fn begin_at(plan: &ScenePlan, start: &StartPlan) -> Result<(Simulation, Vec<Leaving>), Error> {
    let path = end_path(&start.directory);
    let now = parts_of_state(plan);
    let refused = |problem: String| Error::Refused {
        place: start.place.clone(),
        problem: format!(
            "[scene] start = \"{}\" cannot be used: {problem}",
            start.name
        ),
    };
    let read = read_checkpoint(&path, |head, from| {
        let unread = |error: std::io::Error| damaged(&path, format!("the state is {error}"));
        let lacks = head.parts.iter().filter(|own| !now.contains(own));
        let other: Vec<&str> = lacks.map(|own| own.0.as_str()).collect();
        if !other.is_empty() {
            return Err(refused(format!(
                "it is of another scene; different there: {}. What that run had must be in this scene \
                 in the same order; walls may move, and more of them may follow",
                other.join(", ")
            )));
        }
        let then: Vec<[Vector; 3]> = Binary::read(from).map_err(unread)?;
        let left: Vec<Option<Leaving>> = Binary::read(from).map_err(unread)?;
        let state = State::read(from).map_err(unread)?;
        let here = places(&plan.scene, start.time);
        if let Some(wall) = then.iter().zip(&here).position(|(a, b)| away(a, b)) {
            return Err(refused(format!(
                "wall \"{}\" is elsewhere at {:.6} s, when this scene begins, than that run left it: \
                 keep the moves that it had, and let others begin later",
                plan.scene.walls[wall].name, start.time
            )));
        }
        let simulation = Simulation::start(plan.scene.clone(), &state, start.time);
        let simulation = simulation.map_err(stopped_scene)?;
        Ok((simulation, left.into_iter().flatten().collect()))
    });
    read.map_err(|error| of_start(start, error))
}

/// Whether a wall is elsewhere.
fn away(then: &[Vector; 3], now: &[Vector; 3]) -> bool {
    let marks = then.iter().zip(now);
    let ways = marks.map(|(a, b)| length(subtract(*a, *b)));
    ways.fold(0.0, f64::max) > ELSEWHERE
}
