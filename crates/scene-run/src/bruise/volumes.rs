//! `windfall bruise`: volumes of bruises from what one measures of them.

use crate::file::columns::quantities;
use serde::Serialize;
use std::path::Path;
use windfall_files::error::Error;
use windfall_files::option_value::{positive, unusable};
use windfall_files::table::data::read_data;
use windfall_files::table::write::csv_text;
use windfall_files::text::number::plain;
use windfall_scene::bruise::damage::{cap_volume, cap_volume_with_bulge, half_ellipsoid_volume};
use windfall_statistics::table::Cells;

/// Volumes of one bruise; m³.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct BruiseVolumes {
    /// Cap of a sphere below the plane through its edge.
    pub cap: f64,
    /// That and the cap of the fruit above the plane, where its radius is known.
    pub cap_with_bulge: Option<f64>,
    /// Half an ellipsoid.
    pub half_ellipsoid: f64,
}

const WIDER: &str = "the bruise is wider than the fruit: are radius and diameter confused?";

/// Volumes of a bruise; texts with units.
///
/// # Errors
/// A text is no length, or the bruise is wider than the fruit.
pub fn bruise_volumes(
    widths: &str,
    depth: Option<&str>,
    radius: Option<&str>,
) -> Result<BruiseVolumes, Error> {
    let each: Result<Vec<f64>, Error> = widths
        .split(',')
        .map(|own| positive("--widths", own.trim(), "m"))
        .collect();
    let widths = match each?[..] {
        [one] => [one; 2],
        [a, b] => [a, b],
        _ => {
            let problem = "expected one width or two, such as \"16 mm, 15 mm\"";
            return Err(unusable(format!("--widths {widths}"), problem));
        }
    };
    let Some(depth) = depth else {
        return Err(unusable(
            "--depth",
            "give the depth of the bruise: --depth '5 mm'",
        ));
    };
    let depth = positive("--depth", depth, "m")?;
    let radius = radius
        .map(|own| positive("--radius", own, "m"))
        .transpose()?;
    volumes_of(widths, depth, radius).ok_or_else(|| unusable("--radius", WIDER))
}

fn volumes_of(widths: [f64; 2], depth: f64, radius: Option<f64>) -> Option<BruiseVolumes> {
    let bulge = match radius {
        Some(radius) => Some(cap_volume_with_bulge(widths, depth, radius)?),
        None => None,
    };
    Some(BruiseVolumes {
        cap: cap_volume(widths, depth),
        cap_with_bulge: bulge,
        half_ellipsoid: half_ellipsoid_volume(widths, depth),
    })
}

/// Columns that are added to a table.
const ADDED: [&str; 3] = [
    "bruise_volume_cap_mm3",
    "bruise_volume_with_bulge_mm3",
    "bruise_volume_half_ellipsoid_mm3",
];

/// A table of bruises with their volumes beside them, as CSV. Rows with a blank cell have
/// blank volumes.
///
/// # Errors
/// The table cannot be read, has not the columns, or a bruise that cannot be.
pub fn table_of_volumes(path: &Path) -> Result<String, Error> {
    let data = read_data(path)?;
    let table = &data.table;
    let wrong = |problem: String| unusable(path.display().to_string(), problem);
    let column = |name: &str| quantities(table, name, "m").map_err(Error::Statistics);
    let first = match column("bruise width")? {
        Some(own) => Some(own),
        None => column("bruise width 1")?,
    };
    let (Some(first), Some(depth)) = (first, column("bruise depth")?) else {
        let problem = "it needs the columns bruise_width_mm (or bruise_width_1_mm and \
                       bruise_width_2_mm) and bruise_depth_mm; other units of length will do";
        return Err(wrong(problem.to_owned()));
    };
    let second = column("bruise width 2")?.unwrap_or_else(|| first.clone());
    let radius = column("radius")?;
    if let Some(own) = table.columns.iter().find(|own| ADDED.contains(&&*own.name)) {
        return Err(wrong(format!("there is a column \"{}\" already", own.name)));
    }
    let mut rows = Vec::new();
    for row in 0..table.rows() {
        let mut cells: Vec<String> = table
            .columns
            .iter()
            .map(|own| cell(&own.cells, row))
            .collect();
        let radius = radius
            .as_ref()
            .map(|own| own[row])
            .filter(|own| !own.is_nan());
        let measured = [first[row], second[row], depth[row]];
        let line = data.line(row);
        if measured.iter().any(|own| own.is_nan()) {
            cells.extend([const { String::new() }; 3]);
            rows.push(cells);
            continue;
        }
        if measured.iter().chain(&radius).any(|own| *own <= 0.0) {
            return Err(wrong(format!("line {line}: lengths must be above zero")));
        }
        let found = volumes_of([first[row], second[row]], depth[row], radius);
        let found = found.ok_or_else(|| wrong(format!("line {line}: {WIDER}")))?;
        cells.extend(cells_of(&found));
        rows.push(cells);
    }
    let names = table.columns.iter().map(|own| own.name.clone());
    let header: Vec<String> = names.chain(ADDED.map(str::to_owned)).collect();
    csv_text(&header, rows)
}

fn cell(cells: &Cells, row: usize) -> String {
    match cells {
        Cells::Numbers(numbers) if numbers.at(row).is_nan() => String::new(),
        Cells::Numbers(numbers) => numbers.at(row).to_string(),
        Cells::Categories(own) => {
            own.codes[row].map_or(String::new(), |code| own.levels[code].clone())
        }
    }
}

/// Volumes for people.
pub fn text_of_volumes(outcome: &BruiseVolumes) -> String {
    let volume = |own: f64| format!("{} mm³", plain((1e10 * own).round() / 10.0));
    let mut text = format!("cap of a sphere         {}\n", volume(outcome.cap));
    if let Some(own) = outcome.cap_with_bulge {
        text += &format!("with the cap of fruit   {}\n", volume(own));
    }
    text + &format!(
        "half an ellipsoid       {}\n",
        volume(outcome.half_ellipsoid)
    )
}

/// Volumes as CSV.
///
/// # Errors
/// None in practice: every cell can be written.
pub fn csv_of_volumes(outcome: &BruiseVolumes) -> Result<String, Error> {
    csv_text(&ADDED, [cells_of(outcome).to_vec()])
}

/// Cells of the columns of [`ADDED`]; mm³.
fn cells_of(outcome: &BruiseVolumes) -> [String; 3] {
    let bulge = outcome.cap_with_bulge;
    [
        (1e9 * outcome.cap).to_string(),
        bulge.map_or(String::new(), |own| (1e9 * own).to_string()),
        (1e9 * outcome.half_ellipsoid).to_string(),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn closed_form_volumes_of_a_table() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("bruises.csv");
        let text = "fruit,bruise_width_1_mm,bruise_width_2_cm,bruise_depth_mm,radius_mm\n\
                    a,16,1.6,5,40\nb,16,1.6,,40\nc,16,1.6,5,\n";
        std::fs::write(&path, text).unwrap();
        let found = table_of_volumes(&path).unwrap();
        let rows: Vec<Vec<&str>> = found.lines().map(|row| row.split(',').collect()).collect();
        let numbers = |row: usize| {
            rows[row][5..]
                .iter()
                .map(|own| own.parse().unwrap_or(f64::NAN))
        };
        // By hand, as in the tests of the formulas.
        for (own, wanted) in numbers(1).zip([568.1, 649.6, 670.2]) {
            assert!((own - wanted).abs() < 0.05, "{own} {wanted}");
        }
        assert_eq!(rows[2][5..], ["", "", ""]);
        assert!(rows[3][6].is_empty() && !rows[3][5].is_empty());
        std::fs::write(&path, text.replace("5,40\nb", "5,7\nb")).unwrap();
        let error = table_of_volumes(&path).unwrap_err().to_string();
        assert!(
            error.contains("line 2") && error.contains("wider"),
            "{error}"
        );
    }
}
