//! Results joined with what the tables of the campaign say of impact and specimen: the
//! table that regressions are made on.

use crate::campaign_view::{
    CampaignView, RESULTS_TABLE, TABLES_DIRECTORY, TableView, view_campaign,
};
use crate::table_origin::note;
use std::collections::BTreeMap;
use std::path::Path;
use windfall_files::confined::path_inside;
use windfall_files::error::Error;
use windfall_files::table::write::{csv_text, unguarded};
use windfall_files::write_file::write_whole;
use windfall_measure::any_outcome::AnyOutcome;
use windfall_report::any_text::csv_of_any;

/// Writes results, one line each, joined with impacts.csv and specimens.csv.
///
/// # Errors
/// The campaign cannot be read, or the table cannot be written.
pub fn write_results_table(directory: &Path, outcome: &AnyOutcome) -> Result<(), Error> {
    let view = view_campaign(directory)?;
    let text = joined_table(&view, &csv_of_any(outcome)?)?;
    let path = path_inside(directory, RESULTS_TABLE)?;
    let folder = directory.join(TABLES_DIRECTORY);
    std::fs::create_dir_all(&folder).map_err(|source| Error::access(&folder, "create", source))?;
    write_whole(&path, text.as_bytes())?;
    // Without a note, as where the store is read-only, the table is taken for an old one.
    let _ = note(directory);
    Ok(())
}

/// Results in CSV with further columns, where they have no column of the same name.
fn joined_table(view: &CampaignView, results: &str) -> Result<String, Error> {
    let mut reader = csv::Reader::from_reader(results.as_bytes());
    let damaged = |error: csv::Error| Error::unwritable("table", error);
    let header = reader.headers().map_err(damaged)?.clone();
    let read = |cell: &str| unguarded(cell).to_owned();
    let mut columns: Vec<String> = header.iter().map(read).collect();
    let id = columns.iter().position(|name| name == "id");
    let specimen = columns.iter().position(|name| name == "specimen");
    let joins = [(&view.impacts, id), (&view.specimens, specimen)].map(|(table, key)| {
        let further = further(table, &mut columns);
        (by_id(table), key, further)
    });
    let mut rows = Vec::new();
    for record in reader.records() {
        let record = record.map_err(damaged)?;
        let record: csv::StringRecord = record.iter().map(unguarded).collect();
        let mut row: Vec<String> = record.iter().map(str::to_owned).collect();
        for (table, key, further) in &joins {
            let found = key.and_then(|key| table.get(record.get(key)?));
            row.extend(further.iter().map(|place| {
                let cell = found.and_then(|cells| cells.get(*place));
                cell.cloned().unwrap_or_default()
            }));
        }
        rows.push(row);
    }
    csv_text(&columns, rows)
}

/// Places of the columns of a table that are new, whose names are added.
fn further(table: &TableView, columns: &mut Vec<String>) -> Vec<usize> {
    let mut places = Vec::new();
    for (place, name) in table.columns.iter().enumerate() {
        if !columns.contains(name) {
            columns.push(name.clone());
            places.push(place);
        }
    }
    places
}

fn by_id(table: &TableView) -> BTreeMap<&str, &Vec<String>> {
    let place = table.columns.iter().position(|name| name == "id");
    let rows = table.rows.iter();
    rows.filter_map(|row| Some((row.get(place?)?.as_str(), row)))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    #[test]
    fn closed_form_columns_of_impact_and_specimen_join_the_results() {
        let directory = tempfile::tempdir().unwrap();
        let write = |name: &str, text: &str| fs::write(directory.path().join(name), text).unwrap();
        write(
            "campaign.toml",
            windfall_campaign::settings::template::template(
                windfall_campaign::settings::template::TemplateKind::Pendulum,
            ),
        );
        write(
            "specimens.csv",
            "id,variety,mass_g\ns1,Golden,180\ns2,Jonagold,190\n",
        );
        write(
            "impacts.csv",
            "id,specimen,file,level\na,s1,a.csv,1\nb,s2,b.csv,3\n",
        );
        let view = view_campaign(directory.path()).unwrap();
        let joined = joined_table(&view, "id,specimen,k\nb,s2,5\na,s1,4\nz,s9,3\n").unwrap();
        assert_eq!(
            joined,
            "id,specimen,k,file,level,variety,mass_g\n\
             b,s2,5,b.csv,3,Jonagold,190\na,s1,4,a.csv,1,Golden,180\nz,s9,3,,,,\n"
        );
    }
}
