//! Where the rows of a text end: before a footer, and before the zeros of a logger that
//! lost power.

use crate::contents::Note;
use crate::text::encoding::Encoding;
use windfall_source::error::Error;
use windfall_source::source::Source;

/// Bytes looked through at a time.
const BLOCK: u64 = 1 << 16;

/// End of the rows of a text.
pub struct Ending {
    /// One past their last byte.
    pub rows_end: u64,
    /// What is left out behind them.
    pub notes: Vec<Note>,
}

/// Finds the end of the rows.
///
/// * `newline`: last byte of a line
/// * `footer`: lines at the end that are no rows
///
/// # Errors
/// The file cannot be read, or has fewer lines.
pub fn ending(
    source: &Source,
    encoding: Encoding,
    newline: u8,
    footer: u64,
) -> Result<Ending, Error> {
    let unit = encoding.unit() as u64;
    // Zeros of whole characters; of UTF-16 the last character keeps its own.
    let zeros = source.length() - before_last(source, source.length(), |byte| byte != 0)?;
    let text_end = match encoding {
        Encoding::Utf16Le => source.length() - zeros.saturating_sub(1) / unit * unit,
        _ => source.length() - zeros / unit * unit,
    };
    let mut notes = Vec::new();
    if text_end < source.length() {
        notes.push(Note::LeftOut {
            what: format!("{} zero bytes at the end", source.length() - text_end),
            why: "they are no text; the recorder probably lost power while it wrote".to_owned(),
        });
    }
    let mut rows_end = text_end;
    for line in 0..footer {
        // The break of this line itself is no beginning.
        let inside = rows_end.saturating_sub(unit);
        let before = before_last(source, inside, |byte| byte == newline)?;
        if before == 0 {
            return Err(Error::Setting {
                path: source.path().to_path_buf(),
                option: format!("footer = {footer}"),
                problem: format!("the file has {} lines", line + 1),
            });
        }
        rows_end = match encoding {
            Encoding::Utf16Le => before + 1,
            _ => before,
        };
    }
    if footer > 0 {
        notes.push(Note::LeftOut {
            what: format!("{footer} line(s) at the end"),
            why: format!("the setting footer = {footer} says that they are no rows"),
        });
    }
    Ok(Ending { rows_end, notes })
}

/// One past the last byte before `end` that is wanted; 0 if there is none.
fn before_last(source: &Source, end: u64, wanted: impl Fn(u8) -> bool) -> Result<u64, Error> {
    let mut end = end;
    while end > 0 {
        let start = end.saturating_sub(BLOCK);
        let bytes = source.bytes_at(start, end - start)?;
        if let Some(at) = bytes.iter().rposition(|byte| wanted(*byte)) {
            return Ok(start + at as u64 + 1);
        }
        end = start;
    }
    Ok(0)
}
