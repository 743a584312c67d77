//! Checks what the library that reads workbooks trusts: places of cells, of which a row beyond
//! its numbers would become another one, and the number of texts, for which it asks memory.

use crate::zip::entries::{Archive, Entry, open_entry};
use quick_xml::Reader;
use quick_xml::events::Event;
use std::io::BufReader;
use windfall_source::error::{Error, Place};

/// Most letters of a column and digits of a row.
const MOST_LETTERS: usize = 3;
const MOST_DIGITS: usize = 7;

/// Checks a part of a workbook.
///
/// # Errors
/// A place is none, or a number of texts is more than the part can hold; the part is no XML, or
/// cannot be unpacked.
pub fn check_part(archive: &Archive, part: &Entry) -> Result<(), Error> {
    let broken = |problem: String| {
        archive.get_ref().malformed(
            Place::Object(part.name.clone()),
            problem,
            "the file is damaged: save it again, or save the sheet as CSV",
        )
    };
    let mut reader = Reader::from_reader(BufReader::new(open_entry(archive, part)?));
    reader.config_mut().check_end_names = false;
    let mut buffer = Vec::new();
    loop {
        buffer.clear();
        let event = reader.read_event_into(&mut buffer);
        let element = match event.map_err(|error| {
            broken(format!(
                "this part of the workbook cannot be read ({error})"
            ))
        })? {
            Event::Start(element) | Event::Empty(element) => element,
            Event::Eof => return Ok(()),
            _ => continue,
        };
        let possible = |text: &str| text.parse::<u64>().is_ok_and(|count| count <= part.size);
        let kind = element.local_name();
        for attribute in element.attributes().flatten() {
            let text: &str = &attribute.value;
            let fits = match (kind.as_ref(), attribute.key.as_ref()) {
                ("c", "r") => place(text).is_some(),
                ("row", "r") => is_row(text),
                ("dimension", "ref") => is_range(text),
                ("sst", "count" | "uniqueCount") => possible(text),
                _ => true,
            };
            if !fits {
                let name = kind.as_ref();
                return Err(broken(format!(
                    "\"{text}\" of an element \"{name}\" cannot be"
                )));
            }
        }
    }
}

fn is_row(text: &str) -> bool {
    let digits = text.bytes().all(|byte| byte.is_ascii_digit());
    digits && (1..=MOST_DIGITS).contains(&text.len()) && !text.starts_with('0')
}

/// Column and row of "AB12", as numbers that can be compared.
fn place(text: &str) -> Option<(u32, u32)> {
    let letters = text.bytes().take_while(u8::is_ascii_alphabetic).count();
    let (letters, digits) = text.split_at(letters);
    if !(1..=MOST_LETTERS).contains(&letters.len()) || !is_row(digits) {
        return None;
    }
    let value = |byte: u8| u32::from(byte.to_ascii_uppercase() - b'A') + 1;
    let column = letters
        .bytes()
        .fold(0, |column, byte| 26 * column + value(byte));
    Some((column, digits.parse().ok()?))
}

fn is_range(text: &str) -> bool {
    match text.split_once(':') {
        None => place(text).is_some(),
        Some((first, last)) => match (place(first), place(last)) {
            (Some(first), Some(last)) => first.0 <= last.0 && first.1 <= last.1,
            _ => false,
        },
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn closed_form_places() {
        assert_eq!(place("A1"), Some((1, 1)));
        assert_eq!(place("XFD1048576"), Some((16_384, 1_048_576)));
        assert!(is_range("A1") && is_range("B2:C2") && is_row("7"));
        for text in [
            "",
            "A",
            "1",
            "A0",
            "A01",
            "AAAA1",
            "A12345678",
            "A1 ",
            "Ä1",
            "$A$1",
        ] {
            assert_eq!(place(text), None, "{text}");
        }
        assert!(!is_range("C1:B2") && !is_range("A3:B2") && !is_range("A1:"));
    }
}
