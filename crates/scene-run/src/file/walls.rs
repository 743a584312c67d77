//! `[[walls]]` of scene.toml.

use crate::file::key::{material, needed};
use crate::file::mesh::mesh_of;
use crate::file::scene::{BoxFile, WallFile};
use std::ops::Range;
use toml::Spanned;
use windfall_files::error::Error;
use windfall_files::found::FindingOutcome;
use windfall_files::text::toml_source::{
    TomlSource, invalid, missing, needed_quantity, suggestion,
};
use windfall_scene::shape::wall::{Motion, Plate, Shape, Turning, Vibration, Wall};
use windfall_scene::vector::{Vector, cross, length, unit};

/// A wall; what is to be known of it is added to the findings.
///
/// # Errors
/// Something is missing or cannot be.
pub fn wall_of(
    source: &TomlSource,
    wall: &Spanned<WallFile>,
    materials: &[String],
    findings: &mut Vec<FindingOutcome>,
) -> Result<Wall, Error> {
    const TABLE: &str = "[[walls]]";
    let (file, at) = (wall.get_ref(), wall.span());
    let lacks = |key, meaning, example| {
        let key = needed(TABLE, key, meaning, "", example);
        missing(source, &at, &key, TABLE.to_owned())
    };
    let name = file.name.as_ref();
    let name = name.ok_or_else(|| lacks("name", "its name", "name = \"chute\""))?;
    let of = file.material.as_ref();
    let of = of.ok_or_else(|| lacks("material", "its material", "material = \"steel\""))?;
    let own = material(
        source,
        &of.span(),
        (TABLE, "material"),
        of.get_ref(),
        materials,
    )?;
    let flat = |key: &str, at: &Range<usize>| {
        let problem = "it must have a length, and edges must not be parallel".to_owned();
        invalid(source, at, (TABLE, key), name.get_ref(), problem)
    };
    let shape = match (
        &file.plane,
        &file.plate,
        &file.bin,
        &file.cylinder,
        &file.mesh,
    ) {
        (Some(plane), None, None, None, None) => Shape::Plane {
            point: plane.get_ref().point,
            normal: unit(plane.get_ref().normal)
                .ok_or_else(|| flat("plane normal", &plane.span()))?,
        },
        (None, Some(plate), None, None, None) => {
            let edges = plate.get_ref().edges;
            let area = length(cross(edges[0], edges[1]));
            let spans = area > FLAT * length(edges[0]) * length(edges[1]);
            if !spans {
                return Err(flat("plate edges", &plate.span()));
            }
            Shape::Plates(vec![Plate {
                corner: plate.get_ref().corner,
                edges,
            }])
        }
        (None, None, Some(bin), None, None) => {
            let sides = sides_of(bin.get_ref());
            let sides = sides.map_err(|problem| {
                let text = bin.get_ref().open.join(", ");
                invalid(source, &bin.span(), (TABLE, "box"), &text, problem)
            })?;
            Shape::Plates(sides)
        }
        (None, None, None, Some(tube), None) => {
            let (file, at) = (tube.get_ref(), tube.span());
            let key = needed(
                TABLE,
                "cylinder diameter",
                "diameter",
                "m",
                "diameter = \"0.5 m\"",
            );
            let diameter = needed_quantity(source, &at, Some(&file.diameter), &key)?;
            if diameter <= 0.0 || file.start == file.end {
                return Err(flat("cylinder", &at));
            }
            Shape::Cylinder {
                start: file.start,
                end: file.end,
                radius: 0.5 * diameter,
            }
        }
        (None, None, None, None, Some(mesh)) => mesh_of(source, mesh, name.get_ref(), findings)?,
        _ => {
            let meaning = "one of plane, plate, box, cylinder, mesh";
            let example = "plane = { point = [0, 0, 0], normal = [0, 0, 1] }";
            return Err(lacks(
                "plane, plate, box, cylinder or mesh",
                meaning,
                example,
            ));
        }
    };
    Ok(Wall {
        name: name.get_ref().clone(),
        material: own,
        shape,
        motion: motion_of(source, file)?,
    })
}

/// Sine of the angle of edges below which they are parallel; 1.
const FLAT: f64 = 1e-9;

fn motion_of(source: &TomlSource, file: &WallFile) -> Result<Motion, Error> {
    const TABLE: &str = "[[walls]]";
    let vibration = match &file.vibration {
        Some(own) => {
            let key = needed(
                TABLE,
                "vibration frequency",
                "frequency",
                "Hz",
                "frequency = \"20 Hz\"",
            );
            let frequency = Some(&own.get_ref().frequency);
            Some(Vibration {
                amplitude: own.get_ref().amplitude,
                frequency: needed_quantity(source, &own.span(), frequency, &key)?,
            })
        }
        None => None,
    };
    let rotation = match &file.rotation {
        Some(own) => {
            let key = needed(
                TABLE,
                "rotation angular_velocity",
                "angular velocity",
                "rad/s",
                "angular_velocity = \"1 rad/s\"",
            );
            let spin = Some(&own.get_ref().angular_velocity);
            let axis = unit(own.get_ref().axis).ok_or_else(|| {
                let problem = "an axis must have a length".to_owned();
                invalid(
                    source,
                    &own.span(),
                    (TABLE, "rotation axis"),
                    "[0, 0, 0]",
                    problem,
                )
            })?;
            Some(Turning {
                point: own.get_ref().point,
                axis,
                angular_velocity: needed_quantity(source, &own.span(), spin, &key)?,
            })
        }
        None => None,
    };
    let vector =
        |own: &Option<Spanned<Vector>>| own.as_ref().map_or([0.0; 3], |own| *own.get_ref());
    Ok(Motion {
        velocity: vector(&file.velocity),
        vibration,
        rotation,
        surface_velocity: vector(&file.belt),
    })
}

/// Names of the sides of a box: of each axis the low one and the high one.
const SIDES: [[&str; 2]; 3] = [["left", "right"], ["front", "back"], ["bottom", "top"]];

fn sides_of(file: &BoxFile) -> Result<Vec<Plate>, String> {
    let known = SIDES.as_flattened();
    if let Some(name) = file
        .open
        .iter()
        .find(|name| !known.contains(&name.as_str()))
    {
        let near = suggestion(name, known.iter().copied());
        return Err(format!(
            "a box has no side \"{name}\"{near}; its sides are {}",
            known.join(", ")
        ));
    }
    if (0..3).any(|axis| file.low[axis] >= file.high[axis]) {
        return Err("`low` must be below `high` in x, y and z".to_owned());
    }
    let edge = |axis: usize| {
        let mut edge = [0.0; 3];
        edge[axis] = file.high[axis] - file.low[axis];
        edge
    };
    let mut plates = Vec::new();
    for (axis, names) in SIDES.iter().enumerate() {
        for (end, name) in names.iter().enumerate() {
            if file.open.iter().any(|open| open == name) {
                continue;
            }
            let mut corner = file.low;
            if end == 1 {
                corner[axis] = file.high[axis];
            }
            let edges = [edge((axis + 1) % 3), edge((axis + 2) % 3)];
            plates.push(Plate { corner, edges });
        }
    }
    Ok(plates)
}
