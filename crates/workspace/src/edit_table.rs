//! Changes of a CSV of a campaign: separator, comments and untouched lines stay.

use std::collections::BTreeMap;
use std::path::Path;
use windfall_campaign::settings::template::is_template_file;
use windfall_files::error::Error;
use windfall_files::table::csv::{column_index, read_table};

/// The text of a table with cells of one row set; columns that it lacks are added.
///
/// * `id`: cell of the column "id"
///
/// # Errors
/// The table cannot be read, or has no such row.
pub fn set_cells(path: &Path, id: &str, cells: &[(&str, String)]) -> Result<String, Error> {
    let mut text = Text::read(path)?;
    let table = read_table(path)?;
    let ids = column_index(&table, "id")?;
    let Some(row) = table.rows.iter().position(|row| row.cells[ids] == id) else {
        return Err(Error::ImpactUnknown { id: id.to_owned() });
    };
    // A column that would be blank in every row is not added.
    let present = |name: &str| text.columns.iter().any(|column| column == name);
    let new = cells
        .iter()
        .filter(|(name, cell)| present(name) || !cell.is_empty());
    let new: Vec<&(&str, String)> = new.collect();
    for (name, cell) in new {
        let column = text.column(name);
        text.rows[row].resize(text.columns.len(), String::new());
        text.rows[row][column].clone_from(cell);
    }
    text.write()
}

/// The text of a table with further rows; columns that it lacks are added. The examples
/// of a template that nobody has touched give way to them.
///
/// # Errors
/// The table cannot be read.
pub fn add_rows(path: &Path, rows: &[BTreeMap<String, String>]) -> Result<String, Error> {
    let mut text = Text::read(path)?;
    if is_template_file(path) {
        text.rows.clear();
    }
    for row in rows {
        let places: Vec<(usize, &String)> = row
            .iter()
            .map(|(name, cell)| (text.column(name), cell))
            .collect();
        let mut cells = vec![String::new(); text.columns.len()];
        for (place, cell) in places {
            cells[place].clone_from(cell);
        }
        text.rows.push(cells);
    }
    text.write()
}

/// A table with what stands before its header.
struct Text {
    separator: u8,
    comments: String,
    columns: Vec<String>,
    rows: Vec<Vec<String>>,
}

impl Text {
    fn read(path: &Path) -> Result<Self, Error> {
        let table = read_table(path)?;
        let text =
            std::fs::read_to_string(path).map_err(|source| Error::access(path, "read", source))?;
        let text = text.trim_start_matches('\u{feff}');
        let comments: String = text
            .split_inclusive('\n')
            .take_while(|line| line.starts_with('#') || line.trim().is_empty())
            .collect();
        let header = text[comments.len()..].lines().next().unwrap_or_default();
        let count = |mark: char| header.matches(mark).count();
        let separator = [';', '\t', ','].into_iter().max_by_key(|mark| count(*mark));
        Ok(Self {
            separator: separator.map_or(b',', |mark| mark as u8),
            comments,
            columns: table.columns,
            rows: table.rows.into_iter().map(|row| row.cells).collect(),
        })
    }

    /// Position of a column, which is added where it is not there.
    fn column(&mut self, name: &str) -> usize {
        let found = self.columns.iter().position(|column| column == name);
        found.unwrap_or_else(|| {
            self.columns.push(name.to_owned());
            self.columns.len() - 1
        })
    }

    fn write(mut self) -> Result<String, Error> {
        let mut writer = csv::WriterBuilder::new()
            .delimiter(self.separator)
            .from_writer(self.comments.into_bytes());
        let width = self.columns.len();
        for row in &mut self.rows {
            row.resize(width, String::new());
        }
        let unwritable = |error: csv::Error| Error::unwritable("table", error);
        writer.write_record(&self.columns).map_err(unwritable)?;
        for row in &self.rows {
            writer.write_record(row).map_err(unwritable)?;
        }
        let bytes = writer.into_inner();
        let bytes = bytes.map_err(|error| Error::unwritable("table", error))?;
        Ok(String::from_utf8_lossy(&bytes).into_owned())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn file(text: &str) -> (tempfile::TempDir, std::path::PathBuf) {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("impacts.csv");
        std::fs::write(&path, text).unwrap();
        (directory, path)
    }

    #[test]
    fn closed_form_cells_of_one_row_change_and_columns_are_added() {
        let (_kept, path) = file("# drops of May\nid;specimen;file\na;s;\"r;1.csv\"\nb;s;r2.csv\n");
        let set = set_cells(
            &path,
            "b",
            &[("from_s", "0.25".to_owned()), ("to_s", String::new())],
        );
        assert_eq!(
            set.unwrap(),
            "# drops of May\nid;specimen;file;from_s\na;s;\"r;1.csv\";\nb;s;r2.csv;0.25\n"
        );
        assert!(set_cells(&path, "c", &[]).is_err());
    }

    #[test]
    fn closed_form_rows_are_added() {
        let (_kept, path) = file("id,specimen,file\na,s,r.csv\n");
        let row = [
            ("id", "b"),
            ("specimen", "s"),
            ("file", "q.csv"),
            ("level", "2"),
        ];
        let row = row.map(|(name, cell)| (name.to_owned(), cell.to_owned()));
        let added = add_rows(&path, &[BTreeMap::from(row)]).unwrap();
        assert_eq!(added, "id,specimen,file,level\na,s,r.csv,\nb,s,q.csv,2\n");
    }
}
