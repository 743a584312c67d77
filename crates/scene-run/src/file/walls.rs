//! `[[walls]]` of scene.toml.

use crate::file::key::Section;
use crate::file::mesh::{MeshFile, mesh_of};
use schemars::JsonSchema;
use serde::Deserialize;
use windfall_files::error::Error;
use windfall_files::found::FindingOutcome;
use windfall_files::text::file_quantity::QuantityText;
use windfall_files::text::spanned::Spanned;
use windfall_files::text::toml_source::{TomlSource, suggestion};
use windfall_scene::shape::motion::{Axis, How, Motion};
use windfall_scene::shape::surface::{Plate, Shape};
use windfall_scene::shape::wall::Wall;
use windfall_scene::vector::{Vector, cross, length, unit};

/// `[[walls]]`
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct WallFile {
    pub name: Option<Spanned<String>>,
    pub material: Option<Spanned<String>>,
    /// An endless plane.
    pub plane: Option<Spanned<PlaneFile>>,
    /// A parallelogram.
    pub plate: Option<Spanned<PlateFile>>,
    /// A box.
    #[serde(rename = "box")]
    pub bin: Option<Spanned<BoxFile>>,
    /// The side of a cylinder.
    pub cylinder: Option<Spanned<CylinderFile>>,
    /// Triangles of an STL file.
    pub mesh: Option<Spanned<MeshFile>>,
    /// Steady velocity; m/s.
    pub velocity: Option<Spanned<[f64; 3]>>,
    /// Velocity of a belt's surface; m/s.
    pub belt: Option<Spanned<[f64; 3]>>,
    pub vibration: Option<Spanned<VibrationFile>>,
    pub rotation: Option<Spanned<RotationFile>>,
}

/// `plane`
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PlaneFile {
    /// A point of it; m.
    pub point: [f64; 3],
    /// Towards the free side.
    pub normal: [f64; 3],
}

/// `plate`
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PlateFile {
    /// A corner; m.
    pub corner: [f64; 3],
    /// Edges from it; m.
    pub edges: [[f64; 3]; 2],
}

/// `box`
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BoxFile {
    /// Lowest corner; m.
    pub low: [f64; 3],
    /// Highest corner; m.
    pub high: [f64; 3],
    /// Sides that are open: "top", "bottom", "left", "right", "front", "back".
    #[serde(default)]
    pub open: Vec<String>,
}

/// `cylinder`
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CylinderFile {
    /// Centre of one end; m.
    pub start: [f64; 3],
    /// Centre of the other; m.
    pub end: [f64; 3],
    pub diameter: Spanned<QuantityText>,
}

/// `vibration`
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct VibrationFile {
    /// Amplitude and direction; m.
    pub amplitude: [f64; 3],
    pub frequency: Spanned<QuantityText>,
}

/// `rotation`
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RotationFile {
    /// A point of the axis; m.
    pub point: [f64; 3],
    /// Its direction.
    pub axis: [f64; 3],
    pub angular_velocity: Option<Spanned<QuantityText>>,
    /// How far it turns in all, in `[[moves]]`.
    pub angle: Option<Spanned<QuantityText>>,
}

/// Places in the tables of a wall or a move, which can be moved: a table and its keys.
pub const PLACES: [(&str, &[&str]); 6] = [
    ("plane", &["point"]),
    ("plate", &["corner"]),
    ("box", &["low", "high"]),
    ("cylinder", &["start", "end"]),
    ("rotation", &["point"]),
    ("path", &["point"]),
];

/// A wall; adds findings about its shape.
///
/// * `walls`: those before it
pub fn wall_of(
    source: &TomlSource,
    wall: &Spanned<WallFile>,
    (materials, walls): (&[String], &[Wall]),
    findings: &mut Vec<FindingOutcome>,
) -> Result<Wall, Error> {
    let file = wall.get_ref();
    let table = Section {
        source,
        name: "[[walls]]",
        at: wall.span(),
    };
    let name = file.name.as_ref();
    let name = name.ok_or_else(|| table.lacks("name", "its name", "name = \"chute\""))?;
    let (name, at) = (name.get_ref(), name.span());
    if walls.iter().any(|own| own.name == *name) {
        let problem =
            "another wall has this name: tables, moves and messages tell walls apart by it";
        return Err(table.refused(&at, "name", name, problem));
    }
    let own = file.material.as_ref();
    let own = own.ok_or_else(|| table.lacks("material", "its material", "material = \"steel\""))?;
    let material = table.material(&own.span(), "material", own.get_ref(), materials)?;
    let given = [
        ("plane", file.plane.as_ref().map(Spanned::span)),
        ("plate", file.plate.as_ref().map(Spanned::span)),
        ("box", file.bin.as_ref().map(Spanned::span)),
        ("cylinder", file.cylinder.as_ref().map(Spanned::span)),
        ("mesh", file.mesh.as_ref().map(Spanned::span)),
    ];
    table.alone(&given, "write a [[walls]] for each")?;
    let shapes = [
        file.plane.as_ref().map(|own| plane_of(&table, own)),
        file.plate
            .as_ref()
            .map(|own| Ok(Shape::Plates(vec![plate_of(&table, own)?]))),
        file.bin.as_ref().map(|own| box_of(&table, own)),
        file.cylinder.as_ref().map(|own| cylinder_of(&table, own)),
        file.mesh
            .as_ref()
            .map(|own| mesh_of(&table, own, name, findings)),
    ];
    let Some(shape) = shapes.into_iter().flatten().next() else {
        let key = "plane, plate, box, cylinder or mesh";
        let meaning = "one of plane, plate, box, cylinder, mesh";
        let example = "plane = { point = [0, 0, 0], normal = [0, 0, 1] }";
        return Err(table.lacks(key, meaning, example));
    };
    Ok(Wall {
        name: name.clone(),
        material,
        shape: shape?,
        motion: motion_of(&table, file)?,
    })
}

/// The error of a shape that has no extent.
fn flat(table: &Section, shape: &Spanned<impl Sized>, key: &str) -> Error {
    let problem = "it must have a length, and edges must not be parallel";
    table.refused(&shape.span(), key, table.written(&shape.span()), problem)
}

fn plane_of(table: &Section, plane: &Spanned<PlaneFile>) -> Result<Shape, Error> {
    let normal = normal_of(table, plane)?;
    let PlaneFile { point, .. } = *plane.get_ref();
    Ok(Shape::Plane { point, normal })
}

/// The normal of a plane, of length 1.
pub fn normal_of(table: &Section, plane: &Spanned<PlaneFile>) -> Result<Vector, Error> {
    unit(plane.get_ref().normal).ok_or_else(|| flat(table, plane, "plane normal"))
}

/// Sine of the angle of edges below which they are parallel; 1.
const FLAT: f64 = 1e-9;

/// A parallelogram.
pub fn plate_of(table: &Section, plate: &Spanned<PlateFile>) -> Result<Plate, Error> {
    let PlateFile { corner, edges } = *plate.get_ref();
    let [a, b] = edges;
    match length(cross(a, b)) > FLAT * length(a) * length(b) {
        true => Ok(Plate { corner, edges }),
        false => Err(flat(table, plate, "plate edges")),
    }
}

fn box_of(table: &Section, bin: &Spanned<BoxFile>) -> Result<Shape, Error> {
    let sides = sides_of(bin.get_ref());
    sides.map(Shape::Plates).map_err(|problem| {
        let open = bin.get_ref().open.join(", ");
        table.refused(&bin.span(), "box", open, problem)
    })
}

fn cylinder_of(table: &Section, tube: &Spanned<CylinderFile>) -> Result<Shape, Error> {
    let file = tube.get_ref();
    let (start, end) = (file.start, file.end);
    let diameter = table.given(&file.diameter, "cylinder diameter", "m")?;
    if diameter <= 0.0 {
        let at = &file.diameter;
        let problem = "it must be above zero";
        return Err(table.refused(&at.span(), "cylinder diameter", at.get_ref(), problem));
    }
    if start == end {
        return Err(flat(table, tube, "cylinder"));
    }
    Ok(Shape::Cylinder {
        start,
        end,
        radius: 0.5 * diameter,
    })
}

/// What a wall does from the beginning to the end.
fn motion_of(table: &Section, file: &WallFile) -> Result<Motion, Error> {
    let given = |own: &Option<Spanned<Vector>>| {
        let velocity = own.as_ref().map(|own| *own.get_ref());
        velocity.filter(|own| *own != [0.0; 3])
    };
    let mut all: Vec<How> = given(&file.velocity)
        .map(How::Velocity)
        .into_iter()
        .collect();
    if let Some(own) = &file.vibration {
        all.push(vibration_of(table, own)?);
    }
    if let Some(turn) = &file.rotation {
        let about = axis_of(table, turn)?;
        let own = turn.get_ref();
        if let Some(angle) = &own.angle {
            let problem = "a wall that always turns has an angular_velocity; an angle belongs to a \
                           rotation in [[moves]]";
            return Err(table.refused(&angle.span(), "rotation angle", angle.get_ref(), problem));
        }
        let Some(spin) = &own.angular_velocity else {
            let problem = "it needs an angular_velocity, such as \"1 rad/s\"";
            let text = table.written(&turn.span());
            return Err(table.refused(&turn.span(), "rotation", text, problem));
        };
        all.push(How::Rotation {
            about,
            angular_velocity: table.given(spin, "rotation angular_velocity", "rad/s")?,
        });
    }
    all.extend(given(&file.belt).map(How::Belt));
    Ok(Motion::always(all))
}

/// `vibration`
pub(crate) fn vibration_of(table: &Section, own: &Spanned<VibrationFile>) -> Result<How, Error> {
    let own = own.get_ref();
    Ok(How::Vibration {
        amplitude: own.amplitude,
        frequency: table.given(&own.frequency, "vibration frequency", "Hz")?,
    })
}

/// The axis of `rotation`
pub(crate) fn axis_of(table: &Section, turn: &Spanned<RotationFile>) -> Result<Axis, Error> {
    let RotationFile { point, axis, .. } = turn.get_ref();
    let direction = unit(*axis).ok_or_else(|| {
        let problem = "an axis must have a length";
        table.refused(&turn.span(), "rotation axis", "[0, 0, 0]", problem)
    })?;
    let point = *point;
    Ok(Axis { point, direction })
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
