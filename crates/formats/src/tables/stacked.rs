//! Opens a text of one or several tables.

use crate::contents::Format;
use crate::reader::Reader;
use crate::tables::bundle::{Bundle, Part};
use crate::tables::split::{Stretch, part_options, split};
use crate::text::options::TextOptions;
use crate::text::read::TextReader;
use windfall_source::error::Error;
use windfall_source::source::Source;

/// Opens a text: a table, or tables below each other, which are segments.
///
/// # Errors
/// As [`TextReader::open`].
pub fn open_text(source: Source, options: &TextOptions) -> Result<Box<dyn Reader>, Error> {
    let mut parts = open_parts(source, options)?;
    if parts.len() == 1 {
        return Ok(Box::new(parts.remove(0).reader));
    }
    let first = &parts[0].reader.contents().variant;
    let variant = format!("{} segments, {first}", parts.len());
    Ok(Box::new(Bundle::new(
        Format::Text,
        variant,
        parts,
        Vec::new(),
    )))
}

/// The tables of a text, as segments if there are several; errors as in [`open_text`].
pub fn open_parts(source: Source, options: &TextOptions) -> Result<Vec<Part>, Error> {
    let (tables, encoding) = split(&source, options)?;
    if tables.is_empty() {
        let whole = Part {
            before: String::new(),
            behind: String::new(),
            reader: TextReader::open(source, options)?,
        };
        return Ok(vec![whole]);
    }
    let open = |(index, table): (usize, &Stretch)| {
        let own = part_options(options, *table, source.length(), encoding);
        Ok(Part {
            before: String::new(),
            behind: format!(" (segment {})", index + 1),
            reader: TextReader::open(source.part(table.start, table.end), &own)?,
        })
    };
    tables.iter().enumerate().map(open).collect()
}

/// Where the tables of a text begin: lines above each; `[0]` for a single one.
///
/// # Errors
/// The file cannot be read.
pub fn beginnings(source: &Source, options: &TextOptions) -> Result<Vec<u64>, Error> {
    let (tables, _) = split(source, options)?;
    Ok(match tables.is_empty() {
        true => vec![0],
        false => tables.iter().map(|table| table.lines_above).collect(),
    })
}
