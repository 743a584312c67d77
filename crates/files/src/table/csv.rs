//! Tables of text: specimens.csv and impacts.csv.
//!
//! The separator (comma, semicolon or tab) is found from the header; a byte
//! order mark is passed over; names may be quoted and hold commas and units. UTF-16, as
//! PowerShell writes it, is read like UTF-8. The apostrophe that keeps a cell from being a
//! formula is taken away.

use crate::error::{Error, Place};
use crate::inputs::{check_piped, protect};
use crate::known_names::told_names;
use crate::table::columns_text::{ColumnsText, column_files};
use crate::table::records::{Block, Blocks, Records};
use crate::table::write::plain_cell;
use std::borrow::Cow;
use std::fs::File;
use std::io::{BufRead, BufReader, Cursor};
use std::path::{Path, PathBuf};
use windfall_formats::text::encoding::{Encoding, tell_encoding};
use windfall_source::stream::{is_stream, stream_bytes};

/// A table of text, as specimens.csv and impacts.csv are.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Table {
    /// The file it came from.
    pub path: PathBuf,
    /// Names of the columns.
    pub columns: Vec<String>,
    /// Rows below the header.
    pub rows: Vec<Row>,
}

/// One row of a [`Table`].
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Row {
    /// Line in the file, from 1.
    pub line: usize,
    /// Cells, as [`plain_cell`] leaves them, one per column.
    pub cells: Vec<String>,
}

/// Reads a whole table as text.
///
/// # Errors
/// The file cannot be read, is empty or not UTF-8; a column is named twice; a
/// row is ragged.
pub fn read_table(path: &Path) -> Result<Table, Error> {
    let mut open = open(path)?;
    let mut rows = Vec::new();
    while let Some(block) = next_block(&mut open)? {
        each_row(&open.form, &block, |line, cells| {
            let cells = cells.iter().map(|cell| plain_cell(cell).to_owned());
            rows.push(Row {
                line,
                cells: cells.collect(),
            });
        })?;
    }
    Ok(Table {
        path: path.to_path_buf(),
        columns: open.form.columns,
        rows,
    })
}

/// Index of a column of a table.
///
/// # Errors
/// The column is missing; names the nearest ones.
pub fn column_index(table: &Table, column: &str) -> Result<usize, Error> {
    index_of(&table.path, &table.columns, column, "")
}

/// A file whose header has been read.
pub(crate) struct Open {
    /// What its header says.
    pub(crate) form: Form,
    /// Lines before the header that begin with `#`, without it.
    pub(crate) comments: Vec<String>,
    blocks: Blocks,
}

/// What the header of a table says.
pub(crate) struct Form {
    /// The file.
    pub(crate) path: PathBuf,
    /// Names of the columns.
    pub(crate) columns: Vec<String>,
    /// What separates cells.
    pub(crate) separator: (u8, &'static str),
}

/// Opens a table and reads its header.
///
/// # Errors
/// As [`read_table`].
pub(crate) fn open(path: &Path) -> Result<Open, Error> {
    check_piped(path)?;
    protect(path);
    let mut reader = utf8(path)?;
    // The header is read to its end, however long, before anything is decided.
    let (mut header, mut comments, mut before) = (Vec::new(), Vec::new(), 0);
    while header.iter().all(u8::is_ascii_whitespace) || header.starts_with(b"#") {
        if let Some(comment) = header.strip_prefix(b"#") {
            comments.push(String::from_utf8_lossy(comment).trim().to_owned());
        }
        before += usize::from(!header.is_empty());
        header.clear();
        let read = reader
            .read_until(b'\n', &mut header)
            .map_err(|source| access(path, source))?;
        if read == 0 {
            return Err(Error::TableEmpty {
                path: path.to_path_buf(),
            });
        }
    }
    let mut below = Vec::new();
    while below.iter().all(u8::is_ascii_whitespace) {
        let read = reader.read_until(b'\n', &mut below);
        if read.map_err(|source| access(path, source))? == 0 {
            break;
        }
    }
    let separator = separator_of(&header, &below);
    header.append(&mut below);
    let mut blocks = Blocks::new(header, before + 1, separator.0, reader);
    let failed = |source| access(path, source);
    let columns = match blocks.next_record().map_err(failed)? {
        Some(header) => names_of(path, &header, separator.0)?,
        None => Vec::new(),
    };
    Ok(Open {
        form: Form {
            path: path.to_path_buf(),
            columns,
            separator,
        },
        comments,
        blocks,
    })
}

/// Names of the columns in a header.
fn names_of(path: &Path, header: &Block, separator: u8) -> Result<Vec<String>, Error> {
    let text = text_of(path, header)?;
    let mut cells = Vec::new();
    Records::new(text, header.line, separator).next(&mut cells);
    let columns = cells.iter().map(|name| plain_cell(name).to_owned());
    let columns: Vec<String> = columns.collect();
    for (index, column) in columns.iter().enumerate() {
        if !column.is_empty() && columns[..index].contains(column) {
            let column = column.clone();
            return Err(Error::ColumnRepeated {
                path: path.to_path_buf(),
                column,
            });
        }
    }
    Ok(columns)
}

/// The text of a file, without byte order mark; of files of columns that which they would be as
/// CSV.
fn utf8(path: &Path) -> Result<Box<dyn BufRead>, Error> {
    let failed = |source| access(path, source);
    if !is_stream(path) {
        let columns = column_files(path).and_then(ColumnsText::open);
        if let Some(text) = columns.map_err(failed)? {
            return Ok(Box::new(BufReader::with_capacity(1 << 16, text)));
        }
    }
    let mut reader: Box<dyn BufRead> = match is_stream(path) {
        true => Box::new(Cursor::new(stream_bytes(path).map_err(failed)?)),
        false => {
            let file = File::open(path).map_err(failed)?;
            Box::new(BufReader::with_capacity(1 << 16, file))
        }
    };
    let start = reader.fill_buf().map_err(|source| access(path, source))?;
    let (encoding, mark) = tell_encoding(start);
    reader.consume(mark);
    if !matches!(encoding, Encoding::Utf16Le | Encoding::Utf16Be) {
        return Ok(reader);
    }
    let mut bytes = Vec::new();
    let read = reader.read_to_end(&mut bytes);
    read.map_err(|source| access(path, source))?;
    let text = encoding.decode(&bytes).into_owned();
    Ok(Box::new(Cursor::new(text.into_bytes())))
}

/// The separator of a table, and its name, from its header and the row below it.
///
/// A comma may stand in names and be the decimal mark: "Time, s;Force, N" over "0,5;1,5". Of the
/// marks that both lines have equally often outside quotes, the one that leaves fewest cells
/// of the row without a number; where there is none, the one that is most frequent in the header.
pub fn separator_of(header: &[u8], row: &[u8]) -> (u8, &'static str) {
    let found = [(b'\t', "tabs"), (b';', "semicolons"), (b',', "commas")];
    let counted = found.map(|own| (own, outside_quotes(header, own.0)));
    let fits = |&&((byte, _), count): &&((u8, &'static str), usize)| {
        count > 0 && outside_quotes(row, byte) == count
    };
    let best = counted.iter().filter(fits).min_by(|(a, m), (b, n)| {
        let words = words_of(row, a.0).total_cmp(&words_of(row, b.0));
        words.then(n.cmp(m))
    });
    let most = || counted.iter().max_by_key(|(_, count)| *count);
    best.or_else(most).map_or((b',', "commas"), |(own, _)| *own)
}

fn outside_quotes(line: &[u8], byte: u8) -> usize {
    let mut quoted = false;
    let counts = line.iter().filter(|&&b| {
        quoted ^= b == b'"';
        b == byte && !quoted
    });
    counts.count()
}

/// Part of the cells of a row that hold no number.
fn words_of(row: &[u8], separator: u8) -> f64 {
    let row = String::from_utf8_lossy(row);
    let cells = row.split(char::from(separator));
    let (mut words, mut all) = (0, 0);
    for cell in cells {
        let cell = plain_cell(cell.trim()).trim_matches('"').replace(',', ".");
        all += 1;
        words += usize::from(!cell.is_empty() && cell.parse::<f64>().is_err());
    }
    f64::from(words as u32) / f64::from(all)
}

/// The next rows of a table; `None` at its end.
pub(crate) fn next_block(open: &mut Open) -> Result<Option<Block>, Error> {
    let read = open.blocks.next();
    read.map_err(|source| access(&open.form.path, source))
}

/// Hands over the rows that are not blank, with their lines in the file, from 1.
///
/// # Errors
/// A ragged row, or text that is not UTF-8: the first of them, after the rows before it.
pub(crate) fn each_row<'a>(
    form: &Form,
    block: &'a Block,
    mut each: impl FnMut(usize, &[Cow<'a, str>]),
) -> Result<(), Error> {
    let (whole, told) = match text_of(&form.path, block) {
        Ok(text) => (text, Ok(())),
        Err(error) => (valid_lines(&block.bytes), Err(error)),
    };
    let (byte, separator) = form.separator;
    let mut records = Records::new(whole, block.line, byte);
    let mut cells = Vec::with_capacity(form.columns.len());
    while let Some(line) = records.next(&mut cells) {
        if cells.len() == form.columns.len() {
            each(line, &cells);
            continue;
        }
        // A line of nothing but blanks is no row.
        if cells.iter().all(|cell| cell.trim().is_empty()) {
            continue;
        }
        return Err(Error::RowRagged {
            place: Place::at(&form.path, line),
            expected: form.columns.len(),
            found: cells.len(),
            separator,
        });
    }
    told
}

/// A block as text.
fn text_of<'a>(path: &Path, block: &'a Block) -> Result<&'a str, Error> {
    std::str::from_utf8(&block.bytes).map_err(|error| {
        let before = &block.bytes[..error.valid_up_to()];
        Error::NotUtf8 {
            place: Place::at(
                path,
                block.line + memchr::memchr_iter(b'\n', before).count(),
            ),
        }
    })
}

/// The lines before the first one that is not UTF-8.
fn valid_lines(bytes: &[u8]) -> &str {
    let valid = match std::str::from_utf8(bytes) {
        Ok(text) => text,
        Err(error) => std::str::from_utf8(&bytes[..error.valid_up_to()]).unwrap_or_default(),
    };
    valid.rfind('\n').map_or("", |end| &valid[..=end])
}

fn index_of(path: &Path, columns: &[String], column: &str, by: &str) -> Result<usize, Error> {
    columns
        .iter()
        .position(|name| name == column)
        .ok_or_else(|| Error::ColumnMissing {
            path: path.to_path_buf(),
            column: column.to_owned(),
            asked_by: by.to_owned(),
            nearest: told_names(column, columns.iter().map(String::as_str)),
            columns: columns.len(),
        })
}

fn access(path: &Path, source: std::io::Error) -> Error {
    let path = path.to_path_buf();
    if source.kind() == std::io::ErrorKind::NotFound {
        return Error::absent(path, "check the name and the directory");
    }
    Error::access(&path, "read", source)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn message(text: &[u8]) -> String {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("r.csv");
        std::fs::write(&path, text).unwrap();
        let text = read_table(&path).unwrap_err().to_string();
        text.split_once("r.csv").unwrap().1.to_owned()
    }

    #[test]
    fn closed_form_cells_of_three_separators() {
        for s in [',', ';', '\t'] {
            let dir = tempfile::tempdir().unwrap();
            let path = dir.path().join("r.csv");
            std::fs::write(&path, format!("\u{feff}id{s}\"mass, wet\"\n a {s}1\n")).unwrap();
            let table = read_table(&path).unwrap();
            assert_eq!(table.columns, ["id", "mass, wet"]);
            assert_eq!((table.rows[0].line, &table.rows[0].cells[0][..]), (2, "a"));
        }
    }

    #[test]
    fn closed_form_separators_where_names_and_numbers_have_commas() {
        for (header, row, expected) in [
            ("Time;Force, N", "0;1,5", b';'),
            ("Time, s;Force, N", "0,5;1,5", b';'),
            ("Time, s\tForce, N", "0\t1,5", b'\t'),
            ("Time\tForce, N\n", "\t1,5\n", b'\t'),
            ("fruit;mass, g", "a;1,5", b';'),
            ("width (mm; mean),depth", "1.5,2", b','),
            ("id,note;more", "1,ripe;soft", b','),
            ("\"Force; N\",\"Time; s\"", "1,2", b','),
            ("fruit;variety, from", "a;b, c", b';'),
            ("a,b;c", "", b','),
            ("a,b;c;d", "", b';'),
            ("a", "1", b','),
        ] {
            let (found, _) = separator_of(header.as_bytes(), row.as_bytes());
            assert_eq!(char::from(found), char::from(expected), "{header}");
        }
    }

    #[test]
    fn closed_form_cells_of_utf_16() {
        let text = "\u{feff}id;Sorte\r\n1;Jonagold rosé\r\n2;Ŝ\r\n";
        for unit in [u16::to_le_bytes as fn(u16) -> [u8; 2], u16::to_be_bytes] {
            let dir = tempfile::tempdir().unwrap();
            let path = dir.path().join("r.csv");
            let bytes: Vec<u8> = text.encode_utf16().flat_map(unit).collect();
            std::fs::write(&path, bytes).unwrap();
            let table = read_table(&path).unwrap();
            assert_eq!(table.columns, ["id", "Sorte"]);
            assert_eq!(table.rows[0].cells, ["1", "Jonagold rosé"]);
            assert_eq!((table.rows[1].line, &table.rows[1].cells[1][..]), (3, "Ŝ"));
        }
    }

    #[test]
    fn rejects_what_is_no_table() {
        let empty = ": the file is empty; expected a header line with the names of the columns, \
                     then one line per sample";
        for (text, expected) in [
            (&b""[..], empty),
            (b"\n\n", empty),
            (
                b"t,F,F\n0,1,2\n",
                ", line 1: the column \"F\" appears twice in the header; rename one of them, or map the channel to another column",
            ),
            (
                b"t,F\n0,1\n1\n",
                ", line 3: the row has 1 cells where the header has 2; the file may be cut short, or use another separator in this line (it is read with commas)",
            ),
            (
                b"t,F\n0,1\n1,\xb5\n",
                ", line 3: the text is not UTF-8; save the file as UTF-8 (in a spreadsheet: \"CSV UTF-8\")",
            ),
        ] {
            assert_eq!(message(text), expected);
        }
    }
}
