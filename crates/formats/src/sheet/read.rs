//! Reads spreadsheets as tables of text.

use crate::contents::{Format, Note};
use crate::sheet::cell::Sheet;
use crate::sheet::render::{text_marks, text_of};
use crate::sheet::trust::check_part;
use crate::sheet::{ods, xlsx};
use crate::tables::bundle::{Bundle, Part};
use crate::tables::stacked::beginnings;
use crate::text::encoding::Encoding;
use crate::text::options::TextOptions;
use crate::text::read::TextReader;
use crate::text::rows::Separator;
use crate::zip::entries::{Entry, check_sizes, open_archive, read_entry};
use windfall_source::error::Error;
use windfall_source::source::Source;

/// A character that begins no line: a sheet has no comments.
const NO_COMMENT: &str = "\u{1}";

/// Rows in any sheet.
const ALL_ROWS: u32 = 1 << 20;

/// Opens a workbook of Excel.
///
/// # Errors
/// It is damaged, too large, or has no table of numbers.
pub fn open_xlsx(source: Source, options: &TextOptions) -> Result<Bundle, Error> {
    let (archive, entries) = open_archive(source)?;
    let parts = entries.iter().filter(|entry| {
        let name = entry.name.to_lowercase();
        name.ends_with(".xml") || name.ends_with(".rels")
    });
    let parts: Vec<&Entry> = parts.collect();
    check_sizes(&archive, &parts)?;
    parts
        .iter()
        .try_for_each(|part| check_part(&archive, part))?;
    let source = archive.get_ref();
    bundle(source, Format::Xlsx, xlsx::sheets(source)?, options)
}

/// Opens a spreadsheet of OpenDocument; errors as in [`open_xlsx`].
pub fn open_ods(source: Source, options: &TextOptions) -> Result<Bundle, Error> {
    let (archive, entries) = open_archive(source)?;
    let source = archive.get_ref();
    let Some(contents) = entries.iter().find(|entry| entry.name == "content.xml") else {
        let found = "this document has no contents (content.xml)";
        return Err(source.unknown(found, "save it again, or save the sheet as CSV"));
    };
    let contents = read_entry(&archive, contents)?;
    bundle(
        source,
        Format::Ods,
        ods::sheets(source, &contents)?,
        options,
    )
}

fn bundle(
    source: &Source,
    format: Format,
    sheets: Vec<Sheet>,
    options: &TextOptions,
) -> Result<Bundle, Error> {
    let (mut parts, mut notes) = (Vec::new(), Vec::new());
    let mut failure = None;
    let mut with_table = 0;
    let several = sheets
        .iter()
        .filter(|sheet| !sheet.cells.is_empty())
        .count()
        > 1;
    for sheet in sheets.iter().filter(|sheet| !sheet.cells.is_empty()) {
        match tables(source, sheet, options) {
            Ok((tables, note)) => {
                with_table += 1;
                parts.extend(tables);
                notes.extend(note);
            }
            Err(error @ Error::UnknownFormat { .. }) if several => {
                notes.push(Note::LeftOut {
                    what: format!("sheet \"{}\"", sheet.name),
                    why: "it has no table of numbers".to_owned(),
                });
                failure.get_or_insert(error);
            }
            Err(error) => return Err(error),
        }
    }
    if parts.is_empty() {
        return Err(failure.unwrap_or(Error::Empty {
            path: source.path().to_path_buf(),
            expected: "a sheet with column names, then one row per sample",
        }));
    }
    if with_table == 1 {
        for part in &mut parts {
            part.before.clear();
        }
    }
    let variant = match (with_table, parts.len()) {
        (1, 1) => "one sheet".to_owned(),
        (sheets, tables) if sheets == tables => format!("{sheets} sheets"),
        (sheets, tables) => format!("{sheets} sheet(s), {tables} tables"),
    };
    Ok(Bundle::new(format, variant, parts, notes))
}

/// The tables of a sheet, and a note on its numbers.
fn tables(
    source: &Source,
    sheet: &Sheet,
    options: &TextOptions,
) -> Result<(Vec<Part>, Option<Note>), Error> {
    let (marks, note) = text_marks(sheet, options);
    let options = TextOptions {
        separator: Some(Separator::Mark(b'\t')),
        decimal: Some('.'),
        thousands: None,
        encoding: Some(Encoding::Utf8),
        comment: Some(NO_COMMENT.to_owned()),
        ..options.clone()
    };
    let name = format!("{}/{}", source.path().display(), sheet.name);
    let text = text_of(source, sheet, 0, ALL_ROWS, marks)?;
    let text = Source::from_bytes(&name, text.into_bytes());
    let starts = beginnings(&text, &options)?;
    let mut parts = Vec::new();
    for (index, first) in starts.iter().enumerate() {
        let last = index + 1 == starts.len();
        let end = starts.get(index + 1).map_or(ALL_ROWS, |end| *end as u32);
        let text = text_of(source, sheet, *first as u32, end, marks)?;
        let own = TextOptions {
            lines_above: *first,
            footer: if last { options.footer } else { 0 },
            ..options.clone()
        };
        parts.push(Part {
            before: format!("{}/", sheet.name),
            behind: match starts.len() {
                1 => String::new(),
                _ => format!(" (segment {})", index + 1),
            },
            reader: TextReader::open(Source::from_bytes(&name, text.into_bytes()), &own)?,
        });
    }
    Ok((parts, note))
}
