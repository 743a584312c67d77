//! Columns of quantities in tables.

use windfall_numerics::unit::quantity::parse_as;
use windfall_statistics::error::Error;
use windfall_statistics::table::Table;

/// A column by its name without the unit, which stands behind its last underscore; in SI. `None`
/// where there is none of a unit of that kind; NaN where a cell is blank.
///
/// * `unit`: an SI unit of the kind
///
/// # Errors
/// A cell is no number.
pub fn quantities(table: &Table, name: &str, unit: &str) -> Result<Option<Vec<f64>>, Error> {
    for column in &table.columns {
        // Other underscores, as of numbered columns, belong to the name.
        let Some((title, own)) = column.name.rsplit_once('_') else {
            continue;
        };
        if title.replace('_', " ") == name
            && let Ok(size) = parse_as(&format!("1 {own}"), unit)
        {
            let numbers = table.numbers(&column.name)?;
            return Ok(Some(numbers.iter().map(|own| size * own).collect()));
        }
    }
    Ok(None)
}
