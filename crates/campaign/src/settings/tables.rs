//! specimens.csv and impacts.csv.

use crate::error::CampaignError;
use crate::settings::model::{ImpactEntry, Specimen};
use std::collections::HashSet;
use std::path::Path;
use windfall_files::error::{Error, Place};
use windfall_files::inputs::check_regular;
use windfall_files::known_names::known_names;
use windfall_files::name::Name;
use windfall_files::table::csv::{Row, Table, column_index, read_table};

/// Columns of impacts.csv that bound the part of the recording to use; s.
const RANGE_COLUMNS: [&str; 2] = ["from_s", "to_s"];

/// Reads specimens.csv.
///
/// # Errors
/// The file cannot be read, has no column `id`, a blank id, or an id twice.
pub fn read_specimens(path: &Path) -> Result<Vec<Specimen>, Error> {
    check_regular(path)?;
    let table = read_table(path)?;
    let id = column_index(&table, "id")?;
    check_ids(&table, id, "specimen")?;
    let specimen = |row: &Row| Specimen {
        id: row.cells[id].clone(),
        line: row.line,
        cells: named_cells(&table, row),
    };
    Ok(table.rows.iter().map(specimen).collect())
}

/// Reads impacts.csv; `specimens` are those of specimens.csv, if there is one.
///
/// # Errors
/// The file cannot be read, lacks a column or a cell that it must have, names
/// an impact twice or a specimen that is unknown.
pub fn read_impacts(
    path: &Path,
    specimens: Option<&[Specimen]>,
) -> Result<Vec<ImpactEntry>, Error> {
    check_regular(path)?;
    let table = read_table(path)?;
    let [id, specimen, file] = ["id", "specimen", "file"].map(|name| column_index(&table, name));
    let (id, specimen, file) = (id?, specimen?, file?);
    check_ids(&table, id, "impact")?;
    if table.rows.is_empty() {
        return Err(Error::TableWithoutRows {
            path: path.to_path_buf(),
            row_is: "impact",
        });
    }
    let known = specimens.unwrap_or_default();
    let ids: HashSet<&str> = known.iter().map(|own| own.id.as_str()).collect();
    table
        .rows
        .iter()
        .map(|row| {
            if specimens.is_some() && !ids.contains(row.cells[specimen].as_str()) {
                return Err(Error::from(CampaignError::SpecimenUnknown {
                    place: place(&table, row),
                    specimen: row.cells[specimen].clone(),
                    nearest: known_names(&row.cells[specimen], known.iter().map(|s| s.id.as_str())),
                }));
            }
            Ok(ImpactEntry {
                id: row.cells[id].clone(),
                specimen: filled(&table, row, specimen)?.to_owned(),
                file: filled(&table, row, file)?.to_owned(),
                line: row.line,
                from: optional_number(&table, row, RANGE_COLUMNS[0])?,
                to: optional_number(&table, row, RANGE_COLUMNS[1])?,
                cells: named_cells(&table, row),
            })
        })
        .collect()
}

fn check_ids(table: &Table, column: usize, what: &'static str) -> Result<(), Error> {
    // Sorting keeps this fast for thousands of rows; equal ids keep their order.
    let mut rows: Vec<&Row> = table.rows.iter().collect();
    for row in &rows {
        filled(table, row, column)?;
    }
    rows.sort_by_key(|row| &row.cells[column]);
    let same = |pair: &&[&Row]| pair[0].cells[column] == pair[1].cells[column];
    match rows.windows(2).find(same) {
        None => Ok(()),
        Some(pair) => Err(Error::from(CampaignError::IdRepeated {
            place: place(table, pair[1]),
            what,
            id: pair[1].cells[column].clone(),
            first: pair[0].line,
        })),
    }
}

fn filled<'a>(table: &Table, row: &'a Row, column: usize) -> Result<&'a str, Error> {
    match row.cells[column].as_str() {
        "" => Err(Error::CellBlank {
            place: place(table, row),
            column: table.columns[column].clone(),
        }),
        cell => Ok(cell),
    }
}

fn optional_number(table: &Table, row: &Row, column: &str) -> Result<Option<f64>, Error> {
    let Some(index) = table.columns.iter().position(|name| name == column) else {
        return Ok(None);
    };
    let cell = row.cells[index].as_str();
    match cell.parse::<f64>() {
        _ if cell.is_empty() => Ok(None),
        Ok(value) if value.is_finite() => Ok(Some(value)),
        _ => Err(Error::CellNotNumber {
            place: place(table, row),
            column: column.to_owned(),
            text: cell.to_owned(),
            hint: "",
        }),
    }
}

fn named_cells(table: &Table, row: &Row) -> Vec<(Name, String)> {
    let columns = table.columns.iter().map(Name::from);
    columns.zip(row.cells.iter().cloned()).collect()
}

fn place(table: &Table, row: &Row) -> Place {
    Place::at(&table.path, row.line)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn specimens(text: &str) -> Result<Vec<Specimen>, Error> {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("specimens.csv");
        std::fs::write(&path, text).unwrap();
        read_specimens(&path)
    }

    fn impacts(text: &str, known: &[&str]) -> Result<Vec<ImpactEntry>, Error> {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("impacts.csv");
        std::fs::write(&path, text).unwrap();
        let specimens: Vec<Specimen> = known
            .iter()
            .map(|id| Specimen {
                id: (*id).to_owned(),
                line: 0,
                cells: Vec::new(),
            })
            .collect();
        read_impacts(&path, Some(&specimens))
    }

    fn message<T: std::fmt::Debug>(result: Result<T, Error>) -> String {
        let text = result.unwrap_err().to_string();
        text.split_once(".csv").unwrap().1.to_owned()
    }

    #[test]
    fn closed_form_rows_in_order_with_all_cells() {
        let rows = impacts(
            "id,specimen,file,level,from_s,to_s\na,s1,r.csv,2,0.5,\nb,s1,r.csv,3,,1\n",
            &["s1"],
        )
        .unwrap();
        assert_eq!(
            (rows[0].id.as_str(), rows[0].from, rows[0].to),
            ("a", Some(0.5), None)
        );
        assert_eq!(
            (rows[1].line, rows[1].from, rows[1].to),
            (3, None, Some(1.0))
        );
        assert!(rows[1].cells.contains(&("level".into(), "3".to_owned())));
    }

    #[test]
    fn rejects_ids_named_twice() {
        assert_eq!(
            message(specimens("id,variety\na1,Golden\na2,Golden\na1,Red\n")),
            ", line 4: the specimen \"a1\" is named twice (first in line 2); ids must be unique"
        );
        assert_eq!(
            message(impacts(
                "id,specimen,file\ni1,a,r.csv\ni1,a,s.csv\n",
                &["a"]
            )),
            ", line 3: the impact \"i1\" is named twice (first in line 2); ids must be unique"
        );
    }

    #[test]
    fn rejects_unknown_specimen_and_blank_cells() {
        assert_eq!(
            message(impacts("id,specimen,file\ni1,aple1,r.csv\n", &["apple1"])),
            ", line 2: the specimen \"aple1\" is not in specimens.csv; add it there or correct the id; there is only \"apple1\""
        );
        assert_eq!(
            message(impacts("id,specimen,file\ni1,a,\n", &["a"])),
            ", line 2: the cell in column \"file\" is blank; every row needs one"
        );
        assert_eq!(
            message(impacts("id,specimens,file\ni1,a,r.csv\n", &["a"])),
            ": there is no column \"specimen\"; the columns are \"specimens\", \"id\", \"file\""
        );
    }
}
