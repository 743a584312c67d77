//! `periodic` of `[scene]`: axes along which a scene repeats.

use crate::file::key::{Section, short};
use crate::file::scene::{PeriodicFile, SceneFile};
use std::ops::Range;
use windfall_files::error::Error;
use windfall_files::text::spanned::Spanned;
use windfall_files::text::toml_source::place_at;
use windfall_scene::scene::{AXES, Scene};
use windfall_scene::shape::beyond::Unrepeatable;

/// Names of the keys.
const KEYS: [&str; 3] = ["periodic x", "periodic y", "periodic z"];

fn axes(file: &PeriodicFile) -> [Option<&Spanned<[f64; 2]>>; 3] {
    [&file.x, &file.y, &file.z].map(Option::as_ref)
}

/// Both ends of each periodic axis.
///
/// # Errors
/// No axis is named; ends are no numbers, or the wrong way round.
pub(crate) fn periodic_of(
    table: &Section,
    file: &SceneFile,
) -> Result<[Option<[f64; 2]>; 3], Error> {
    let Some(own) = &file.scene.periodic else {
        return Ok([None; 3]);
    };
    let all = axes(own.get_ref());
    if all.iter().all(Option::is_none) {
        let problem = "it names no axis: write both ends along x, y or z, such as { x = [0, 1.2] }";
        let text = table.written(&own.span());
        return Err(table.refused(&own.span(), "periodic", text, problem));
    }
    for (key, ends) in KEYS.into_iter().zip(all) {
        let Some(ends) = ends else {
            continue;
        };
        let [low, high] = *ends.get_ref();
        if !(low < high && (high - low).is_finite()) {
            let problem = "both ends must be numbers, the lower one first";
            return Err(table.refused(&ends.span(), key, table.written(&ends.span()), problem));
        }
    }
    Ok(all.map(|own| own.map(|own| *own.get_ref())))
}

/// Checks that a scene can repeat.
///
/// # Errors
/// A period is too short for the fruit, a wall is not the same one period on, or a lattice or the
/// box of a sensor is longer than a period.
pub(crate) fn check_periodic(
    table: &Section,
    file: &SceneFile,
    scene: &Scene,
) -> Result<(), Error> {
    let Some(own) = &file.scene.periodic else {
        return Ok(());
    };
    scene.check_periods().map_err(|problem| {
        let text = table.written(&own.span());
        table.refused(&own.span(), "periodic", text, problem.to_string())
    })?;
    if let Some((wall, Unrepeatable { axis, problem })) = scene.first_unrepeatable() {
        let problem = format!(
            "[[walls]]: \"{}\" cannot be repeated along {}: {problem}",
            scene.walls[wall].name, AXES[axis]
        );
        let place = place_at(table.source, &file.walls[wall].span());
        return Err(Error::Refused { place, problem });
    }
    for fruit in &file.fruit {
        if let Some(own) = &fruit.get_ref().lattice {
            let (low, high) = (own.get_ref().low, own.get_ref().high);
            let at = ("[[fruit]]", own.span(), "lattice");
            check_box(table, scene, at, [low, high])?;
        }
    }
    for sensor in &file.sensors {
        if let Some(own) = &sensor.get_ref().space {
            let (low, high) = (own.get_ref().low, own.get_ref().high);
            let at = ("[[sensors]]", own.span(), "box");
            check_box(table, scene, at, [low, high])?;
        }
    }
    Ok(())
}

/// Part of a period by which a box may be longer, for what is rounded; 1.
const ROUNDED: f64 = 1e-9;

/// Refuses a box that would overlap its own image.
///
/// * `at`: table, place and key
fn check_box(
    table: &Section,
    scene: &Scene,
    (name, at, key): (&'static str, Range<usize>, &str),
    [low, high]: [[f64; 3]; 2],
) -> Result<(), Error> {
    for (axis, ends) in scene.periodic.iter().enumerate() {
        let Some([from, to]) = ends else {
            continue;
        };
        if high[axis] - low[axis] > (to - from) * (1.0 + ROUNDED) {
            let problem = format!(
                "along {} it is longer than the scene, which repeats after {} m: it would overlap \
                 itself",
                AXES[axis],
                short(to - from)
            );
            let table = Section {
                name,
                ..table.clone()
            };
            return Err(table.refused(&at, key, table.written(&at), problem));
        }
    }
    Ok(())
}
