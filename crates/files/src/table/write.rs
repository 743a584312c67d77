//! Tables as CSV text: the one place where cells are quoted.
//!
//! What a spreadsheet would run as a formula gets an apostrophe
//! ([`windfall_formats::text::spreadsheet`]), which [`crate::table::csv`] and
//! [`crate::table::data`] take away again.

use crate::error::Error;
use csv::{QuoteStyle, WriterBuilder};
use std::path::Path;
pub use windfall_formats::text::spreadsheet::{guarded, unguarded};

/// A number as a cell of CSV, with all digits; blank where there is none.
pub fn number_cell(value: Option<f64>) -> String {
    value.map_or_else(String::new, |value| value.to_string())
}

/// CSV text from a header and rows.
///
/// # Errors
/// A row has not as many cells as the header.
pub fn csv_text<T: AsRef<str>>(
    header: &[T],
    rows: impl IntoIterator<Item = Vec<String>>,
) -> Result<String, Error> {
    let mut text = csv_header(header)?;
    let mut writer = writer(b',', QuoteStyle::Necessary);
    for row in rows {
        if row.len() != header.len() {
            let told = format!("{} cells in {} columns", row.len(), header.len());
            return Err(failed(std::io::Error::other(told)));
        }
        write(&mut writer, row.iter().map(|cell| guarded(cell)))?;
    }
    text += &whole(writer)?;
    Ok(text)
}

/// The header of a table, as a line.
///
/// # Errors
/// None in practice: every name can be written.
pub fn csv_header<T: AsRef<str>>(names: &[T]) -> Result<String, Error> {
    // The reader tells comments, the separator and a byte order mark from this line.
    let misread = |name: &T| name.as_ref().contains([';', '\t', '#', '\u{feff}']);
    let style = match names.iter().any(misread) {
        true => QuoteStyle::Always,
        false => QuoteStyle::Necessary,
    };
    let mut writer = writer(b',', style);
    write(&mut writer, names.iter().map(|name| guarded(name.as_ref())))?;
    whole(writer)
}

/// Cells as a line of a table with any separator. They are written as they are: of new ones
/// the caller passes [`guarded`].
///
/// # Errors
/// None in practice: every cell can be written.
pub fn csv_line<T: AsRef<str>>(cells: &[T], separator: u8) -> Result<String, Error> {
    let mut writer = writer(separator, QuoteStyle::Necessary);
    write(&mut writer, cells)?;
    whole(writer)
}

/// One cell, as it stands between commas.
///
/// # Errors
/// None in practice: every cell can be written.
pub fn csv_cell(cell: &str) -> Result<String, Error> {
    let line = csv_line(&[&guarded(cell), ""], b',')?;
    Ok(line.trim_end_matches('\n').trim_end_matches(',').to_owned())
}

/// A cell of a table as what it says: without blanks around it, and without the apostrophe
/// that keeps it from being a formula.
pub fn plain_cell(cell: &str) -> &str {
    unguarded(cell.trim()).trim()
}

type Writer = csv::Writer<Vec<u8>>;

fn writer(separator: u8, style: QuoteStyle) -> Writer {
    let mut builder = WriterBuilder::new();
    let builder = builder.delimiter(separator).quote_style(style);
    builder.flexible(true).from_writer(Vec::new())
}

fn write(
    writer: &mut Writer,
    cells: impl IntoIterator<Item = impl AsRef<str>>,
) -> Result<(), Error> {
    for cell in cells {
        writer
            .write_field(cell.as_ref())
            .map_err(|error| failed(error.into()))?;
    }
    writer
        .write_record(None::<&[u8]>)
        .map_err(|error| failed(error.into()))
}

fn whole(writer: Writer) -> Result<String, Error> {
    let bytes = writer.into_inner();
    let bytes = bytes.map_err(|error| failed(error.into_error()))?;
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}

fn failed(source: std::io::Error) -> Error {
    Error::FileAccess {
        path: Path::new("the table in memory").to_path_buf(),
        action: "write",
        source,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::table::csv::read_table;
    use crate::table::data::read_data;
    use proptest::prelude::*;
    use windfall_statistics::table::Cells;

    /// Texts of what spreadsheets, separators and readers give a meaning, or of anything.
    fn cell() -> impl Strategy<Value = String> {
        let pieces = [
            "=",
            "+",
            "-",
            "@",
            "＝",
            "'",
            "''",
            "\"",
            "\t",
            "\r",
            "\n",
            "\r\n",
            " ",
            ",",
            ";",
            "#",
            "\u{feff}",
            "\u{2028}",
            "\u{0}",
            "1",
            "1.5",
            "1e-3",
            "-1,5",
            "inf",
            "NaN",
            "NA",
            "x",
            "=1+1",
            "cmd|' /C calc'!A0",
            "é",
            "🍏",
        ];
        let piece = prop_oneof![
            9 => proptest::sample::select(pieces.to_vec()).prop_map(str::to_owned),
            1 => any::<String>(),
        ];
        proptest::collection::vec(piece, 0..5).prop_map(|pieces| pieces.concat())
    }

    fn table() -> impl Strategy<Value = Vec<Vec<String>>> {
        (1..4_usize).prop_flat_map(|width| {
            proptest::collection::vec(proptest::collection::vec(cell(), width), 2..5)
        })
    }

    fn trimmed(row: &[String]) -> Vec<&str> {
        row.iter().map(|cell| cell.trim()).collect()
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(1000))]

        /// What is written is read as it was, and no cell is a formula for a spreadsheet.
        #[test]
        fn repeats_every_cell(rows in table()) {
            let header: Vec<String> = rows[0]
                .iter()
                .enumerate()
                .map(|(place, name)| format!("{name}{place}"))
                .collect();
            let text = csv_text(&header, rows[1..].to_vec()).unwrap();
            let folder = tempfile::tempdir().unwrap();
            let path = folder.path().join("table.csv");
            std::fs::write(&path, &text).unwrap();

            let read = read_table(&path).unwrap();
            prop_assert_eq!(&read.columns, &trimmed(&header));
            prop_assert_eq!(read.rows.len(), rows.len() - 1);
            for (row, own) in read.rows.iter().zip(&rows[1..]) {
                prop_assert_eq!(&row.cells, &trimmed(own));
            }

            // As a spreadsheet reads it.
            let mut reader = csv::ReaderBuilder::new();
            let reader = reader.has_headers(false).from_reader(text.as_bytes());
            for record in reader.into_records() {
                for cell in &record.unwrap() {
                    let formula = cell.trim().starts_with(['=', '+', '-', '@', '＝']);
                    let number = cell.trim().replacen(',', ".", 1).parse::<f64>();
                    prop_assert!(!formula || number.is_ok(), "{cell:?}");
                }
            }

            match read_data(&path) {
                Ok(data) => for (place, column) in data.table.columns.iter().enumerate() {
                    let Cells::Categories(found) = &column.cells else { continue };
                    for (row, code) in rows[1..].iter().zip(&found.codes) {
                        let level = code.map(|own| found.levels[own].as_str());
                        if let Some(level) = level {
                            prop_assert_eq!(level, row[place].trim());
                        }
                    }
                },
                Err(error) => {
                    let endless = matches!(error, Error::CellNotFinite { .. });
                    prop_assert!(endless, "{error}");
                }
            }
        }
    }
}
