//! `mesh` of a wall in scene.toml.

use crate::file::key::{needed, short};
use crate::file::scene::{MeshFile, TurnFile};
use crate::file::stl::read_stl;
use toml::Spanned;
use windfall_files::error::Error;
use windfall_files::found::FindingOutcome;
use windfall_files::text::toml_source::{TomlSource, invalid, missing, needed_quantity};
use windfall_numerics::unit::quantity::parse_as;
use windfall_scene::shape::mesh::{Flaws, bounds, welded};
use windfall_scene::shape::wall::Shape;
use windfall_scene::vector::{Vector, add, length, scaled, subtract, turn_about, turned, unit};

const TABLE: &str = "[[walls]]";

/// Extent above which the file is probably in mm; m.
const LARGEST: f64 = 100.0;
/// Extent below which the unit is probably wrong too; m.
const SMALLEST: f64 = 2e-3;

/// Reads the surface of a wall from an STL file, and adds its flaws to the findings.
///
/// # Errors
/// The file cannot be read, is damaged, is open where it must be closed, or is of a size
/// that no machine has.
pub fn mesh_of(
    source: &TomlSource,
    mesh: &Spanned<MeshFile>,
    wall: &str,
    findings: &mut Vec<FindingOutcome>,
) -> Result<Shape, Error> {
    let file = mesh.get_ref();
    let name = file.file.get_ref();
    let refused = |key: &'static str, problem: String| {
        invalid(source, &file.file.span(), (TABLE, key), name, problem)
    };
    let unit = unit_of(source, mesh)?;
    let turn = match &file.turn {
        Some(turn) => turn_of(source, turn)?,
        None => turn_about([0.0, 0.0, 1.0], 0.0),
    };
    let read = read_stl(&source.path.with_file_name(name))?;
    let mut triangles = read.map_err(|problem| refused("mesh file", problem.to_string()))?;
    triangles
        .as_flattened_mut()
        .iter_mut()
        .for_each(|corner| *corner = scaled(*corner, unit));
    let (low, high) = bounds(triangles.iter().flatten().copied());
    let size = length(subtract(high, low));
    if !(SMALLEST..=LARGEST).contains(&size) {
        let problem = format!(
            "in this unit it is {} m across: is `unit` right?",
            short(size)
        );
        return Err(refused("mesh unit", problem));
    }
    let mut surface = welded(&triangles);
    if surface.triangles.is_empty() {
        let problem = "none of its triangles has an area".to_owned();
        return Err(refused("mesh file", problem));
    }
    let place = |corner: &mut Vector| *corner = add(turned(turn, *corner), file.shift);
    surface
        .triangles
        .as_flattened_mut()
        .iter_mut()
        .for_each(place);
    if file.closed == Some(true)
        && let Some(open) = openness(&surface.flaws)
    {
        let problem = format!("it must be closed, but {open}");
        return Err(refused("mesh closed", problem));
    }
    findings.extend(findings_of(&surface.flaws, wall, name, file.closed));
    Ok(Shape::Mesh {
        triangles: surface.triangles,
    })
}

/// Metres in the unit of an STL file.
fn unit_of(source: &TomlSource, mesh: &Spanned<MeshFile>) -> Result<f64, Error> {
    let key = "mesh unit";
    let Some(unit) = &mesh.get_ref().unit else {
        let meaning = "the unit of length of its coordinates, which STL files do not say";
        let key = needed(TABLE, key, meaning, "", "unit = \"mm\"");
        return Err(missing(source, &mesh.span(), &key, TABLE.to_owned()));
    };
    let own = unit.get_ref();
    let refused = |problem| invalid(source, &unit.span(), (TABLE, key), own, problem);
    let metres = parse_as(&format!("1 {own}"), "m");
    metres.map_err(|error| refused(error.to_string()))
}

fn turn_of(source: &TomlSource, turn: &Spanned<TurnFile>) -> Result<[f64; 4], Error> {
    let file = turn.get_ref();
    let axis = unit(file.axis).ok_or_else(|| {
        let problem = "an axis must have a length".to_owned();
        let text = format!("{:?}", file.axis);
        invalid(
            source,
            &turn.span(),
            (TABLE, "mesh turn axis"),
            &text,
            problem,
        )
    })?;
    let key = needed(
        TABLE,
        "mesh turn angle",
        "angle",
        "rad",
        "angle = \"90 deg\"",
    );
    let angle = needed_quantity(source, &turn.span(), Some(&file.angle), &key)?;
    Ok(turn_about(axis, angle))
}

/// Where a surface is open, in the file's own place.
fn openness(flaws: &Flaws) -> Option<String> {
    let longest = flaws.rims.first()?;
    let edges: usize = flaws.rims.iter().map(|own| own.edges).sum();
    let rims = match flaws.rims.len() {
        1 => "1 rim".to_owned(),
        several => format!("{several} rims"),
    };
    Some(format!(
        "{edges} edges belong to one triangle only: {rims}, the longest of {} m from {} to {} m, \
         before `turn` and `move`",
        short(longest.length),
        text_of(longest.low),
        text_of(longest.high),
    ))
}

fn text_of(place: Vector) -> String {
    format!("[{}]", place.map(short).join(", "))
}

/// What is to be known of a mesh that is used.
fn findings_of(flaws: &Flaws, wall: &str, file: &str, closed: Option<bool>) -> Vec<FindingOutcome> {
    let mut findings = Vec::new();
    let mut tell = |code: &str, message: String| {
        findings.push(FindingOutcome {
            code: code.to_owned(),
            message: format!("\"{wall}\" ({file}): {message}"),
        });
    };
    let first = |numbers: &[usize]| numbers.first().map_or(0, |own| own + 1);
    if closed.is_none()
        && let Some(open) = openness(flaws)
    {
        tell(
            "mesh-open",
            format!("{open}; a chute may be so: closed = false or true says what it must be"),
        );
    }
    if !flaws.slivers.is_empty() {
        tell(
            "mesh-sliver",
            format!(
                "{} triangles (the first is number {}) are nowhere wider than {} µm, within which \
                 corners are one: they were left out",
                flaws.slivers.len(),
                first(&flaws.slivers),
                short(1e6 * flaws.tolerance),
            ),
        );
    }
    if !flaws.doubled.is_empty() {
        tell(
            "mesh-double",
            format!(
                "{} triangles (the first is number {}) stand there twice: they count once",
                flaws.doubled.len(),
                first(&flaws.doubled),
            ),
        );
    }
    if let Some([a, _]) = flaws.branching.first() {
        tell(
            "mesh-branching",
            format!(
                "{} edges, one of them at {} m, belong to more than two triangles, as where bodies \
                 run into each other: fruit feel all of them",
                flaws.branching.len(),
                text_of(*a),
            ),
        );
    }
    if let Some([a, _]) = flaws.contrary.first() {
        tell(
            "mesh-winding",
            format!(
                "the triangles at {} edges, one of them at {} m, are wound contrary to each other; \
                 walls are felt from both sides here, other programs may mind",
                flaws.contrary.len(),
                text_of(*a),
            ),
        );
    }
    findings
}
