//! Checks, before a run, that fruit and walls of scene.toml have room.

use crate::file::key::{short, short_place};
use crate::file::scene::SceneFile;
use std::ops::Range;
use windfall_files::error::Error;
use windfall_files::text::toml_source::{TomlSource, place_at};
use windfall_scene::population::{FruitKind, drawn};
use windfall_scene::reach::reaches_a_sink;
use windfall_scene::room::{first_doubled, first_in_wall};
use windfall_scene::scene::{Fruit, Scene};
use windfall_scene::vector::Vector;

fn refused(source: &TomlSource, at: &Range<usize>, problem: String) -> Error {
    Error::Refused {
        place: place_at(source, at),
        problem,
    }
}

/// Draws the fruit of all kinds.
///
/// # Errors
/// A kind does not fit where it is to come in; the message names its table.
pub fn drawn_fruit(
    source: &TomlSource,
    file: &SceneFile,
    kinds: &[FruitKind],
    seed: u64,
) -> Result<Vec<Fruit>, Error> {
    drawn(kinds, seed).map_err(|problem| {
        // Each kind has its own numbers: the first without which the others can be drawn.
        let place = (1..kinds.len()).find(|&count| drawn(&kinds[..count], seed).is_err());
        let place = place.unwrap_or(kinds.len()) - 1;
        let kind = &kinds[place];
        let largest = 2.0 * (kind.radius + 3.0 * kind.radius_sd);
        let problem = format!(
            "[[fruit]]: {problem}; the largest of this kind may measure {} m",
            short(largest)
        );
        refused(source, &file.fruit[place].span(), problem)
    })
}

/// Checks walls, sources and sinks.
///
/// * `kinds`: name and number of fruit of each kind
///
/// # Errors
/// Two walls lie on each other; fruit come in where a wall is; a sink holds no place; fruit
/// are too large for every way to a sink.
pub fn check_room(
    source: &TomlSource,
    file: &SceneFile,
    scene: &Scene,
    kinds: &[(String, usize)],
) -> Result<(), Error> {
    check_walls(source, file, scene)?;
    if let Some(found) = first_in_wall(scene) {
        let (fruit, wall) = (&scene.fruit[found.fruit], &scene.walls[found.wall]);
        let kind = kind_of(kinds, found.fruit);
        let problem = format!(
            "[[fruit]]: a fruit of \"{}\" of {} m comes in at {} m after {} s, where it overlaps the \
             wall \"{}\" by {} m: move the place where fruit come in, or the wall",
            kinds[kind].0,
            short(2.0 * fruit.radius),
            short_place(fruit.place),
            short(fruit.time),
            wall.name,
            short(found.overlap),
        );
        return Err(refused(source, &file.fruit[kind].span(), problem));
    }
    for (sink, own) in scene.sinks.iter().zip(&file.sinks) {
        let empty = (0..3).any(|axis| {
            let thick = sink.high[axis] - sink.low[axis];
            thick.partial_cmp(&0.0) != Some(std::cmp::Ordering::Greater)
        });
        if empty {
            let problem = format!(
                "[[sinks]]: \"{}\" holds no place: `low` must be below `high` in x, y and z",
                sink.name
            );
            return Err(refused(source, &own.span(), problem));
        }
    }
    check_ways(source, file, scene, kinds)
}

fn check_walls(source: &TomlSource, file: &SceneFile, scene: &Scene) -> Result<(), Error> {
    let Some(found) = first_doubled(scene) else {
        return Ok(());
    };
    let [a, b] = found.walls.map(|own| scene.walls[own].name.as_str());
    let problem = format!(
        "[[walls]]: \"{a}\" and \"{b}\" lie on each other at {} m: fruit would feel both, as one \
         wall of twice the stiffness. Leave one out there (`open` of a box), or move it away",
        short_place(found.place)
    );
    Err(refused(source, &file.walls[found.walls[1]].span(), problem))
}

/// Whether the largest fruit of each kind can get to a sink.
fn check_ways(
    source: &TomlSource,
    file: &SceneFile,
    scene: &Scene,
    kinds: &[(String, usize)],
) -> Result<(), Error> {
    let Some(sink) = file.sinks.first() else {
        return Ok(());
    };
    let mut first = 0;
    for (name, count) in kinds {
        let fruit = &scene.fruit[first..first + count];
        first += count;
        let largest = fruit.iter().map(|own| own.radius).fold(0.0, f64::max);
        let starts: Vec<Vector> = fruit.iter().map(|own| own.place).collect();
        if reaches_a_sink(scene, largest, &starts) == Some(false) {
            let problem = format!(
                "[[sinks]]: the largest fruit of \"{name}\", of {} m, can reach no sink: the walls \
                 leave it no way so wide. Widen the outlet, or leave the sinks out",
                short(2.0 * largest)
            );
            return Err(refused(source, &sink.span(), problem));
        }
    }
    Ok(())
}

/// The kind of a fruit, by its place among those drawn.
fn kind_of(kinds: &[(String, usize)], fruit: usize) -> usize {
    let mut last = 0;
    let found = kinds.iter().position(|(_, count)| {
        last += count;
        fruit < last
    });
    found.unwrap_or(0)
}
