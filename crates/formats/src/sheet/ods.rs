//! Spreadsheets of OpenDocument.
//!
//! # Source
//! OASIS, Open Document Format for Office Applications 1.3, part 3, sections 9 and 19.

use crate::sheet::cell::{Cell, Sheet, duration};
use quick_xml::Reader;
use quick_xml::events::{BytesStart, Event};
use windfall_source::error::{Error, Place};
use windfall_source::source::Source;

/// Most cells that repetitions may add.
const MOST_REPEATED: u64 = 1 << 22;

/// Longest text of a cell; bytes.
const LONGEST_TEXT: usize = 1 << 15;

/// The sheets in the contents of a document.
///
/// # Errors
/// The contents are no XML, or end too early.
pub fn sheets(source: &Source, contents: &[u8]) -> Result<Vec<Sheet>, Error> {
    let contents = String::from_utf8_lossy(contents);
    let mut reader = Reader::from_str(&contents);
    reader.config_mut().expand_empty_elements = true;
    let mut walk = Walk {
        source,
        sheets: Vec::new(),
        inside: false,
        row: 0,
        column: 0,
        row_times: 1,
        row_begin: 0,
        cell: None,
        remark: 0,
        repeated: 0,
    };
    loop {
        let event = reader
            .read_event()
            .map_err(|error| walk.broken(&error.to_string()))?;
        match event {
            Event::Start(element) => walk.start(&element)?,
            Event::End(element) => walk.end(element.name().as_ref())?,
            Event::Text(text) => walk.text(&text.xml10_content()),
            Event::GeneralRef(name) => walk.text(&entity(&name)),
            Event::Eof if walk.inside => return Err(walk.broken("it ends too early")),
            Event::Eof => break,
            _ => {}
        }
    }
    for sheet in &mut walk.sheets {
        sheet.order();
    }
    Ok(walk.sheets)
}

/// The character that a reference stands for.
fn entity(name: &str) -> String {
    let code = match name.strip_prefix('#') {
        Some(hex) if hex.starts_with('x') => u32::from_str_radix(&hex[1..], 16).ok(),
        Some(decimal) => decimal.parse().ok(),
        None => None,
    };
    match (name, code.and_then(char::from_u32)) {
        (_, Some(c)) => c.to_string(),
        ("amp", _) => "&".to_owned(),
        ("lt", _) => "<".to_owned(),
        ("gt", _) => ">".to_owned(),
        ("quot", _) => "\"".to_owned(),
        ("apos", _) => "'".to_owned(),
        _ => String::new(),
    }
}

/// A cell that is being read.
struct OpenCell {
    /// Its value, where an attribute holds it.
    value: Option<Cell>,
    text: String,
    paragraphs: u32,
    times: u64,
}

/// Where the reading is.
struct Walk<'a> {
    source: &'a Source,
    sheets: Vec<Sheet>,
    /// Whether in a sheet.
    inside: bool,
    row: u64,
    column: u64,
    /// How often this row is repeated, and its first cell.
    row_times: u64,
    row_begin: usize,
    cell: Option<OpenCell>,
    /// Remarks that are open.
    remark: u32,
    /// Cells made by repetition.
    repeated: u64,
}

impl Walk<'_> {
    fn broken(&self, problem: &str) -> Error {
        self.source.malformed(
            Place::Object("content.xml".to_owned()),
            format!("the contents of the document cannot be read ({problem})"),
            "the file is damaged: save it again, or save the sheet as CSV",
        )
    }

    fn start(&mut self, element: &BytesStart) -> Result<(), Error> {
        match element.name().as_ref() {
            "table:table" => {
                let name = attribute(element, "table:name").unwrap_or_default();
                self.sheets.push(Sheet {
                    name,
                    cells: Vec::new(),
                });
                (self.inside, self.row, self.column) = (true, 0, 0);
            }
            "table:table-row" => {
                self.row_times = times(element, "table:number-rows-repeated");
                self.row_begin = self.sheets.last().map_or(0, |sheet| sheet.cells.len());
                self.column = 0;
            }
            "table:table-cell" | "table:covered-table-cell" => {
                self.cell = Some(OpenCell {
                    value: value(element),
                    text: String::new(),
                    paragraphs: 0,
                    times: times(element, "table:number-columns-repeated"),
                });
            }
            "office:annotation" => self.remark += 1,
            "text:p" => {
                let cell = self.cell.as_mut();
                if let Some(cell) = cell.filter(|_| self.remark == 0) {
                    cell.paragraphs += 1;
                    if cell.paragraphs > 1 {
                        cell.text.push(' ');
                    }
                }
            }
            "text:s" | "text:tab" | "text:line-break" => self.text(" "),
            _ => {}
        }
        Ok(())
    }

    fn text(&mut self, text: &str) {
        if let Some(cell) = &mut self.cell
            && self.remark == 0
            && cell.paragraphs > 0
            && cell.text.len() + text.len() <= LONGEST_TEXT
        {
            cell.text.push_str(text);
        }
    }

    fn end(&mut self, name: &str) -> Result<(), Error> {
        match name {
            "table:table" => self.inside = false,
            "office:annotation" => self.remark = self.remark.saturating_sub(1),
            "table:table-cell" | "table:covered-table-cell" => {
                if let Some(cell) = self.cell.take() {
                    self.end_cell(cell)?;
                }
            }
            "table:table-row" => self.end_row()?,
            _ => {}
        }
        Ok(())
    }

    fn end_cell(&mut self, cell: OpenCell) -> Result<(), Error> {
        let text = (!cell.text.trim().is_empty()).then(|| Cell::Text(cell.text.into()));
        if let Some(value) = cell.value.or(text) {
            self.repeat(cell.times)?;
            let (source, row, column) = (self.source, self.row, self.column);
            if let Some(sheet) = self.sheets.last_mut() {
                for time in 0..cell.times {
                    sheet.push(source, row, column.saturating_add(time), value.clone())?;
                }
            }
        }
        self.column = self.column.saturating_add(cell.times);
        Ok(())
    }

    fn end_row(&mut self) -> Result<(), Error> {
        let times = self.row_times;
        let cells = self
            .sheets
            .last()
            .and_then(|sheet| sheet.cells.get(self.row_begin..));
        let row = cells.unwrap_or_default().to_vec();
        if !row.is_empty() && times > 1 {
            self.repeat(times.saturating_mul(row.len() as u64))?;
            if let Some(sheet) = self.sheets.last_mut() {
                for time in 1..times {
                    for placed in &row {
                        let (at, column) = (self.row.saturating_add(time), placed.column.into());
                        sheet.push(self.source, at, column, placed.cell.clone())?;
                    }
                }
            }
        }
        self.row = self.row.saturating_add(times);
        Ok(())
    }

    /// Counts cells that repetition makes.
    fn repeat(&mut self, times: u64) -> Result<(), Error> {
        self.repeated = self.repeated.saturating_add(times - 1);
        match self.repeated > MOST_REPEATED {
            true => Err(self.broken("equal cells are repeated more than four million times")),
            false => Ok(()),
        }
    }
}

fn attribute(element: &BytesStart, name: &str) -> Option<String> {
    let found = element
        .attributes()
        .flatten()
        .find(|a| a.key.as_ref() == name)?;
    let text = quick_xml::escape::unescape(&found.value).map(|text| text.into_owned());
    Some(text.unwrap_or_else(|_| found.value.into_owned()))
}

/// How often a row or cell stands there; at least once.
fn times(element: &BytesStart, name: &str) -> u64 {
    let times = attribute(element, name).and_then(|text| text.parse().ok());
    times.unwrap_or(1).max(1)
}

/// The value that the attributes of a cell give.
fn value(element: &BytesStart) -> Option<Cell> {
    let text = |name| attribute(element, name);
    // Errors of a formula are a text beside a number of no meaning.
    if text("calcext:value-type").as_deref() == Some("error") {
        return None;
    }
    let number = || {
        let value: f64 = text("office:value")?.parse().ok()?;
        value.is_finite().then_some(Cell::Number(value))
    };
    match text("office:value-type")?.as_str() {
        "float" | "currency" | "percentage" => number(),
        "boolean" => {
            let holds = text("office:boolean-value")? == "true";
            Some(Cell::Number(f64::from(u8::from(holds))))
        }
        "date" => Some(Cell::Text(text("office:date-value")?.into())),
        "time" => duration(&text("office:time-value")?).map(Cell::Clock),
        "string" => text("office:string-value").map(|text| Cell::Text(text.into())),
        _ => None,
    }
}
