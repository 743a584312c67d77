//! Changes of a CSV of a campaign: separator, comments and untouched lines stay.

use crate::settings::template::is_template_file;
use std::collections::BTreeMap;
use std::path::Path;
use windfall_files::error::Error;
use windfall_files::known_names::known_names;
use windfall_files::place::Place;
use windfall_files::table::csv::{column_index, read_table, separator_of};
use windfall_files::table::write::{csv_line, guarded};

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
        let names = table.rows.iter().map(|row| row.cells[ids].as_str());
        return Err(Error::ImpactUnknown {
            id: id.to_owned(),
            known: known_names(id, names),
        });
    };
    // A column that would be blank in every row is not added.
    let present = |name: &str| text.columns.iter().any(|column| column == name);
    let new = cells
        .iter()
        .filter(|(name, cell)| present(name) || !cell.is_empty());
    let new: Vec<&(&str, String)> = new.collect();
    for (name, cell) in new {
        let column = text.column(name);
        text.rows[row].set.insert(column, cell.clone());
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
        let places = row.iter();
        let set = places.map(|(name, cell)| (text.column(name), cell.clone()));
        let set = set.collect();
        text.rows.push(Row {
            text: String::new(),
            set,
        });
    }
    text.write()
}

/// A table as it stands in its file.
struct Text {
    separator: u8,
    /// Lines above the header.
    comments: String,
    header: String,
    columns: Vec<String>,
    /// Columns that the file has.
    width: usize,
    rows: Vec<Row>,
    end: &'static str,
}

/// A row: as it stands in the file, and the cells that are set in it.
#[derive(Default)]
struct Row {
    text: String,
    set: BTreeMap<usize, String>,
}

impl Text {
    fn read(path: &Path) -> Result<Self, Error> {
        let columns = read_table(path)?.columns;
        let bytes = std::fs::read(path).map_err(|source| Error::access(path, "read", source))?;
        let text = String::from_utf8(bytes).map_err(|_| Error::NotUtf8 {
            place: Place {
                file: path.to_path_buf(),
                line: 1,
            },
        })?;
        let above = text.split_inclusive('\n').take_while(|line| {
            let line = line.trim_start_matches('\u{feff}');
            line.starts_with('#') || line.trim().is_empty()
        });
        let (comments, body) = text.split_at(above.map(str::len).sum());
        let mut lines = body.lines().filter(|line| !line.trim().is_empty());
        let mut next = || lines.next().unwrap_or_default().as_bytes();
        let (separator, _) = separator_of(next(), next());
        let mut reader = csv::ReaderBuilder::new();
        let reader = reader.delimiter(separator).flexible(true);
        let mut header = body.to_owned();
        let mut rows: Vec<Row> = Vec::new();
        let mut last = body.len();
        let records = reader.from_reader(body.as_bytes()).into_records();
        let records: Result<Vec<_>, _> = records.collect();
        let records = records.map_err(|error| Error::unwritable("table", error))?;
        for record in records.iter().rev() {
            // Blank lines belong to what is above them.
            let Some(start) = record.position().filter(|_| record.len() == columns.len()) else {
                continue;
            };
            let start = start.byte() as usize;
            let text = body[start..last].to_owned();
            rows.push(Row {
                text,
                ..Row::default()
            });
            last = start;
        }
        header.truncate(last);
        rows.reverse();
        Ok(Self {
            separator,
            comments: comments.to_owned(),
            header,
            width: columns.len(),
            columns,
            rows,
            end: match line_ends_with_return(body) {
                true => "\r\n",
                false => "\n",
            },
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

    fn write(self) -> Result<String, Error> {
        let names = self.columns.iter().enumerate().skip(self.width);
        let names: BTreeMap<usize, String> = names.map(|(at, own)| (at, own.clone())).collect();
        let header = Row {
            text: self.header.clone(),
            set: names,
        };
        let mut text = self.comments.clone();
        for row in std::iter::once(&header).chain(&self.rows) {
            if !text.is_empty() && !text.ends_with(['\n', '\r']) {
                text += self.end;
            }
            text += &self.line(row)?;
        }
        if !text.ends_with('\n') {
            text += self.end;
        }
        Ok(text)
    }

    /// A row with what was set in it; without that, as it was.
    fn line(&self, row: &Row) -> Result<String, Error> {
        let added = self.columns.len() - self.width;
        if row.set.is_empty() && added == 0 {
            return Ok(row.text.clone());
        }
        let ends = ['\r', '\n'];
        let line = row.text.trim_start_matches(ends);
        let before = &row.text[..row.text.len() - line.len()];
        let cells = line.trim_end_matches(ends);
        let behind = &line[cells.len()..];
        let new = |at: usize| {
            row.set
                .get(&at)
                .map_or(String::new(), |own| guarded(own).into())
        };
        let changed = row.set.keys().any(|at| *at < self.width) || cells.is_empty();
        let written = |cells: &[String]| {
            let line = csv_line(cells, self.separator)?;
            Ok::<_, Error>(line.trim_end_matches('\n').to_owned())
        };
        let line = match changed {
            true => {
                let mut reader = csv::ReaderBuilder::new();
                let reader = reader.delimiter(self.separator).has_headers(false);
                let record = reader.from_reader(cells.as_bytes()).into_records().next();
                let record = record.transpose();
                let record = record.map_err(|error| Error::unwritable("table", error))?;
                let old = |at: usize| record.as_ref().and_then(|own| own.get(at));
                let cell = |at: usize| match (row.set.contains_key(&at), old(at)) {
                    (false, Some(old)) => old.to_owned(),
                    _ => new(at),
                };
                written(&(0..self.columns.len()).map(cell).collect::<Vec<_>>())?
            }
            false => {
                // Behind a blank cell, which stands for those that are there.
                let further = (self.width..self.columns.len()).map(new);
                let further: Vec<String> = std::iter::once(String::new()).chain(further).collect();
                format!("{cells}{}", written(&further)?)
            }
        };
        Ok(format!("{before}{line}{behind}"))
    }
}

/// Whether lines end as on Windows.
fn line_ends_with_return(text: &str) -> bool {
    let first = text.split_inclusive('\n').next();
    first.is_some_and(|line| line.ends_with("\r\n"))
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

    #[test]
    fn repeats_what_nobody_touched() {
        // Formulas, apostrophes, blanks, quotes, line ends: as the user has them.
        let rows = "\u{feff}# May\r\n\r\nid;\"a;b\";file\r\n a ;=1+1;'=x\r\n\r\n\"b\";'y;-z\r\nc;;\"1\r\n2\"";
        let (_kept, path) = file(rows);
        let same = add_rows(&path, &[]).unwrap();
        assert_eq!(same, format!("{rows}\r\n"));
        let set = set_cells(&path, "b", &[("file", "@q".to_owned())]).unwrap();
        assert_eq!(set, same.replace("\"b\";'y;-z", "b;'y;'@q"));
        let set = set_cells(&path, "b", &[("new", "n".to_owned())]).unwrap();
        let expected = same
            .replace(";file", ";file;new")
            .replace("'=x", "'=x;")
            .replace("-z", "-z;n")
            .replace("2\"", "2\";");
        assert_eq!(set, expected);
        let row =
            BTreeMap::from([("id", "=d"), ("file", "'=e")].map(|(a, b)| (a.into(), b.into())));
        let added = add_rows(&path, &[row]).unwrap();
        assert_eq!(added, format!("{same}'=d;;''=e\r\n"));
        std::fs::write(&path, added).unwrap();
        assert_eq!(read_table(&path).unwrap().rows[3].cells, ["=d", "", "'=e"]);
    }
}
