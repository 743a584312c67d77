//! Specimens that were measured several times.

use windfall_files::error::Error;
use windfall_files::table::data::Data;
use windfall_statistics::accurate_sum::mean;
use windfall_statistics::compare::group_summary::{Group, Groups};
use windfall_statistics::table::Cells;

/// Columns whose names say that rows may repeat a specimen.
const SPECIMEN_COLUMNS: [&str; 5] = ["specimen", "fruit", "sample", "specimen_id", "fruit_id"];

/// The column whose name says that rows may repeat a specimen, if there is one.
pub(crate) fn specimen_column(names: &[String]) -> Option<&str> {
    let known = |name: &str| SPECIMEN_COLUMNS.contains(&name.to_lowercase().as_str());
    let mut names = names.iter().map(String::as_str);
    names.find(|name| known(name))
}

/// Mean of each specimen in each group, in the order of their names.
pub(crate) fn specimen_means(
    data: &Data,
    groups: &Groups,
    column: &str,
) -> Result<Vec<Vec<(String, f64)>>, Error> {
    let names = specimen_names(data, column)?;
    let of_group = |group: &Group| {
        let rows = group.rows.iter().zip(&group.values);
        let mut named: Vec<(String, f64)> = rows
            .filter_map(|(row, value)| names[*row].clone().map(|name| (name, *value)))
            .collect();
        named.sort_by(|a, b| a.0.cmp(&b.0));
        named
            .chunk_by(|a, b| a.0 == b.0)
            .map(|chunk| {
                let values: Vec<f64> = chunk.iter().map(|(_, value)| *value).collect();
                (chunk[0].0.clone(), mean(&values).value())
            })
            .collect()
    };
    Ok(groups.groups.iter().map(of_group).collect())
}

/// Specimen of each row; `None` where the cell is missing.
pub(crate) fn specimen_names(data: &Data, column: &str) -> Result<Vec<Option<String>>, Error> {
    let column = data
        .table
        .column(column)
        .map_err(|error| data.told(error))?;
    Ok(match &column.cells {
        Cells::Numbers(numbers) => numbers
            .iter()
            .map(|number: f64| (!number.is_nan()).then(|| number.to_string()))
            .collect(),
        Cells::Categories(categories) => categories
            .codes
            .iter()
            .map(|code| code.map(|code| categories.levels[code].clone()))
            .collect(),
    })
}
