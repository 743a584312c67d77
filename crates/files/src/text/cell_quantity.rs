//! Quantities in specimens.csv and impacts.csv, with the unit in the name of
//! the column: "mass_g", "radius_mm", "density_kg_m3".

use crate::error::{Error, Place};
use crate::name::Name;
use windfall_numerics::unit::quantity::{LARGEST, parse_as};

/// The quantity `name` of a row; SI. `None` where column or cell is blank.
///
/// * `unit`: SI unit; a column counts when what follows its name is a unit of
///   the same kind
/// * `place`: of the row, for messages
///
/// # Errors
/// The cell is no positive number.
pub fn cell_quantity(
    cells: &[(Name, String)],
    name: &str,
    unit: &str,
    place: &Place,
) -> Result<Option<f64>, Error> {
    for (column, cell) in cells {
        let Some(rest) = column.strip_prefix(name) else {
            continue;
        };
        let scale = match rest.strip_prefix('_') {
            None if rest.is_empty() && unit == "1" => Some(1.0),
            None => None,
            Some(written) => unit_scale(written, unit),
        };
        let Some(scale) = scale else { continue };
        if cell.is_empty() {
            return Ok(None);
        }
        return match cell.parse::<f64>() {
            Ok(value) if value > 0.0 && value <= LARGEST => Ok(Some(value * scale)),
            _ => Err(Error::CellNotPositive {
                place: place.clone(),
                column: column.to_string(),
                text: cell.clone(),
            }),
        };
    }
    Ok(None)
}

/// SI value of a unit as it stands in the name of a column.
fn unit_scale(written: &str, unit: &str) -> Option<f64> {
    let plain = parse_as(&format!("1 {written}"), unit).ok();
    plain.or_else(|| {
        let fraction: String = written.replacen('_', "/", 1);
        let powers: String = fraction
            .chars()
            .flat_map(|c| match c.is_ascii_digit() {
                true => vec!['^', c],
                false => vec![c],
            })
            .collect();
        parse_as(&format!("1 {powers}"), unit).ok()
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    fn find(column: &str, cell: &str, name: &str, unit: &str) -> Result<Option<f64>, String> {
        let cells = [(column.into(), cell.to_owned())];
        let place = Place::at(Path::new("specimens.csv"), 0);
        cell_quantity(&cells, name, unit, &place).map_err(|error| error.to_string())
    }

    #[test]
    fn closed_form_units_in_names_of_columns() {
        assert_eq!(find("mass_g", "182", "mass", "kg"), Ok(Some(0.182)));
        assert_eq!(find("radius_mm", "41.5", "radius", "m"), Ok(Some(0.0415)));
        assert_eq!(
            find("density_kg_m3", "850", "density", "kg/m^3"),
            Ok(Some(850.0))
        );
        assert_eq!(find("repeat", "2", "repeat", "1"), Ok(Some(2.0)));
        // Another quantity, another unit, a blank cell.
        assert_eq!(find("radius_2_mm", "41.5", "radius", "m"), Ok(None));
        assert_eq!(find("mass_mm", "41.5", "mass", "kg"), Ok(None));
        assert_eq!(find("mass_g", "", "mass", "kg"), Ok(None));
    }

    #[test]
    fn rejects_cells_that_are_no_positive_numbers() {
        for cell in ["-3", "0", "heavy", "NaN", "1e999"] {
            let message = find("mass_g", cell, "mass", "kg").unwrap_err();
            assert!(
                message.contains("mass_g") && message.contains(cell),
                "{message}"
            );
        }
    }
}
