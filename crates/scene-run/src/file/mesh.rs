//! `mesh` of a wall in scene.toml.

use crate::file::key::{Section, short, short_place};
use crate::file::stl::read_stl;
use schemars::JsonSchema;
use serde::Deserialize;
use windfall_files::error::Error;
use windfall_files::found::FindingOutcome;
use windfall_files::text::file_quantity::QuantityText;
use windfall_files::text::spanned::Spanned;
use windfall_numerics::unit::quantity::parse_as;
use windfall_scene::shape::mesh::{Flaws, bounds, welded};
use windfall_scene::shape::surface::Shape;
use windfall_scene::vector::{Vector, add, length, scaled, subtract, turn_about, turned, unit};

/// `mesh`
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MeshFile {
    /// An STL file, beside the scene.
    pub file: Spanned<String>,
    /// Unit of length of its coordinates: STL files do not say it.
    pub unit: Option<Spanned<String>>,
    /// Turned about an axis through its origin.
    pub turn: Option<Spanned<TurnFile>>,
    /// Then moved by; m.
    #[serde(default, rename = "move")]
    pub shift: [f64; 3],
    /// Whether it must be closed, or is open on purpose.
    pub closed: Option<Spanned<bool>>,
}

/// `turn`
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TurnFile {
    /// Direction of the axis.
    pub axis: [f64; 3],
    pub angle: Spanned<QuantityText>,
}

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
    table: &Section,
    mesh: &Spanned<MeshFile>,
    wall: &str,
    findings: &mut Vec<FindingOutcome>,
) -> Result<Shape, Error> {
    let file = mesh.get_ref();
    let name = file.file.get_ref();
    let refused =
        |key: &'static str, problem: String| table.refused(&file.file.span(), key, name, problem);
    let (unit, unit_told) = unit_of(table, mesh)?;
    let turn = match &file.turn {
        Some(turn) => turn_of(table, turn)?,
        None => turn_about([0.0, 0.0, 1.0], 0.0),
    };
    let read = read_stl(&table.named_file("mesh file", &file.file)?)?;
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
        return Err(table.refused(&unit_told.span(), "mesh unit", unit_told.get_ref(), problem));
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
    let closed = file.closed.as_ref();
    if let Some(asked) = closed.filter(|asked| *asked.get_ref())
        && let Some(open) = openness(&surface.flaws)
    {
        let problem = format!("it must be closed, but {open}");
        return Err(table.refused(&asked.span(), "mesh closed", true, problem));
    }
    let closed = closed.map(|asked| *asked.get_ref());
    findings.extend(findings_of(&surface.flaws, wall, name, closed));
    Ok(Shape::Mesh {
        triangles: surface.triangles,
    })
}

/// Metres in the unit of an STL file, and what stands there.
fn unit_of<'a>(
    table: &Section,
    mesh: &'a Spanned<MeshFile>,
) -> Result<(f64, &'a Spanned<String>), Error> {
    let Some(unit) = &mesh.get_ref().unit else {
        let meaning = "the unit of length of its coordinates, which STL files do not say";
        let at = mesh.span();
        let table = Section {
            at,
            ..table.clone()
        };
        return Err(table.lacks("mesh unit", meaning, "unit = \"mm\""));
    };
    let own = unit.get_ref();
    let metres = parse_as(&format!("1 {own}"), "m");
    let metres =
        metres.map_err(|error| table.refused(&unit.span(), "mesh unit", own, error.to_string()));
    Ok((metres?, unit))
}

fn turn_of(table: &Section, turn: &Spanned<TurnFile>) -> Result<[f64; 4], Error> {
    let file = turn.get_ref();
    let axis = unit(file.axis).ok_or_else(|| {
        let text = format!("{:?}", file.axis);
        let problem = "an axis must have a length";
        table.refused(&turn.span(), "mesh turn axis", text, problem)
    })?;
    Ok(turn_about(
        axis,
        table.given(&file.angle, "mesh turn angle", "rad")?,
    ))
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
        short_place(longest.low),
        short_place(longest.high),
    ))
}

/// Findings about a usable mesh.
fn findings_of(flaws: &Flaws, wall: &str, file: &str, closed: Option<bool>) -> Vec<FindingOutcome> {
    let mut findings = Vec::new();
    let mut tell = |code: &str, message: String| {
        findings.push(FindingOutcome::new(
            code,
            format!("\"{wall}\" ({file}): {message}"),
        ));
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
                short_place(*a),
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
                short_place(*a),
            ),
        );
    }
    findings
}
