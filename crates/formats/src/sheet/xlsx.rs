//! Workbooks of Excel.

use crate::sheet::cell::{Cell, Sheet, duration};
use calamine::{DataRef, Reader, SheetType, Xlsx, XlsxError};
use std::io::{BufReader, Read, Seek, SeekFrom};
use windfall_source::error::{Error, Place};
use windfall_source::source::Source;

const DAY: f64 = 86_400.0;

/// Days of the last date that programs know, 9999-12-31.
const LAST_DAY: f64 = 2_958_466.0;

/// The sheets of a workbook.
///
/// # Errors
/// It is damaged or cannot be read.
pub fn sheets(source: &Source) -> Result<Vec<Sheet>, Error> {
    let bytes = BufReader::new(Stream { source, at: 0 });
    let mut book = Xlsx::new(bytes).map_err(|error| damaged(source, "the workbook", &error))?;
    let names = book.sheets_metadata().iter();
    let names = names.filter(|sheet| sheet.typ == SheetType::WorkSheet);
    let names: Vec<String> = names.map(|sheet| sheet.name.clone()).collect();
    let mut sheets = Vec::new();
    for name in names {
        let failed = |error: XlsxError| damaged(source, &name, &error);
        let mut sheet = Sheet {
            name: name.clone(),
            cells: Vec::new(),
        };
        let mut cells = book.worksheet_cells_reader(&name).map_err(failed)?;
        while let Some(found) = cells.next_cell().map_err(failed)? {
            if let Some(cell) = cell(found.get_value()) {
                let (row, column) = found.get_position();
                sheet.push(source, row.into(), column.into(), cell)?;
            }
        }
        sheet.order();
        sheets.push(sheet);
    }
    Ok(sheets)
}

fn damaged(source: &Source, place: &str, error: &XlsxError) -> Error {
    source.malformed(
        Place::Object(place.to_owned()),
        format!("this part of the workbook cannot be read ({error})"),
        "the file is damaged: save it again, or save the sheet as CSV",
    )
}

/// `None` if blank.
fn cell(value: &DataRef) -> Option<Cell> {
    let text = |text: &str| (!text.trim().is_empty()).then(|| Cell::Text(text.into()));
    match value {
        DataRef::Empty => None,
        DataRef::Int(value) => Some(Cell::Number(*value as f64)),
        DataRef::Float(value) => Some(Cell::Number(*value)),
        DataRef::Bool(value) => Some(Cell::Number(f64::from(u8::from(*value)))),
        DataRef::String(value) => text(value),
        DataRef::SharedString(value) => text(value),
        DataRef::DateTimeIso(value) => text(value),
        DataRef::DurationIso(value) => match duration(value) {
            Some(seconds) => Some(Cell::Clock(seconds)),
            None => text(value),
        },
        DataRef::Error(error) => text(&error.to_string()),
        // Which day the count begins with is of no matter: times are told since the first row.
        DataRef::DateTime(time) => Some(match time.as_f64() {
            days if !(0.0..LAST_DAY).contains(&days) => Cell::Number(days),
            days if time.is_duration() || days < 1.0 => Cell::Clock(DAY * days),
            days => Cell::Date(days),
        }),
    }
}

/// The bytes of a source, from anywhere.
struct Stream<'a> {
    source: &'a Source,
    at: u64,
}

impl Read for Stream<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
        let left = self.source.length().saturating_sub(self.at);
        let count = left.min(buffer.len() as u64) as usize;
        let read = self.source.read_at(self.at, &mut buffer[..count]);
        if count > 0 {
            read.map_err(std::io::Error::other)?;
        }
        self.at += count as u64;
        Ok(count)
    }
}

impl Seek for Stream<'_> {
    fn seek(&mut self, place: SeekFrom) -> std::io::Result<u64> {
        let at = match place {
            SeekFrom::Start(at) => Some(at),
            SeekFrom::End(by) => self.source.length().checked_add_signed(by),
            SeekFrom::Current(by) => self.at.checked_add_signed(by),
        };
        self.at = at.ok_or(std::io::ErrorKind::InvalidInput)?;
        Ok(self.at)
    }
}
