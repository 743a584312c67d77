//! Splits a text file of any length into stretches of whole lines.

use crate::text::encoding::Encoding;
use windfall_source::error::{Error, Place};
use windfall_source::source::Source;

/// Nominal size of a stretch; bytes.
const STRETCH: u64 = 1 << 20;

/// Bytes read at a time to find the end of a line.
const FURTHER: u64 = 1 << 14;

/// Longest line; bytes.
const LONGEST_LINE: u64 = 1 << 22;

/// A range of lines within a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Lines {
    /// First byte, at the start of a line.
    pub start: u64,
    /// One past the last byte.
    pub end: u64,
    pub encoding: Encoding,
    /// Line terminator: line feed, or a lone carriage return.
    pub newline: u8,
}

/// Number of stretches.
pub fn stretches(lines: &Lines) -> u64 {
    lines.end.saturating_sub(lines.start).div_ceil(STRETCH)
}

/// The lines that begin in stretch `index`, with room for them where the source is not in
/// memory; each line belongs to one stretch.
pub fn stretch<'a>(
    source: &'a Source,
    lines: &Lines,
    index: u64,
    buffer: &'a mut Vec<u8>,
) -> Result<&'a [u8], Error> {
    let unit = lines.encoding.unit() as u64;
    let from = lines.start + index * STRETCH;
    let to = (from + STRETCH).min(lines.end);
    if let (0, 1, true) = (index, unit, to == lines.end)
        && let Some(bytes) = source.in_memory(from, to - from)
    {
        return Ok(bytes);
    }
    // One extra unit in front shows whether a line begins right there.
    let lead = if index == 0 { 0 } else { unit };
    let first = (to - from + lead) as usize;
    grow(buffer, first);
    source.read_at(from - lead, &mut buffer[..first])?;
    let begin = match index {
        0 => Some(0),
        _ => behind_newline(&buffer[..first], lines, 0),
    };
    let Some(begin) = begin else {
        // The stretch lies within a line that began earlier.
        return Ok(&[]);
    };
    if begin == first && to < lines.end {
        return Ok(&[]);
    }
    // Extend to the end of the last line that begins before `to`.
    let last_unit = first.saturating_sub(unit as usize);
    let mut searched = last_unit.max(begin.saturating_sub(unit as usize));
    let (mut at, mut filled) = (to, first);
    let end = loop {
        if let Some(end) = behind_newline(&buffer[..filled], lines, searched) {
            break end;
        }
        if at == lines.end {
            break filled;
        }
        if at - to > LONGEST_LINE {
            return Err(source.malformed(
                Place::Byte(to),
                "a line is longer than 4 MiB",
                "a table of numbers has one line for each sample; is this another format?",
            ));
        }
        searched = filled;
        let next = (at + FURTHER).min(lines.end);
        let more = filled + (next - at) as usize;
        grow(buffer, more);
        source.read_at(at, &mut buffer[filled..more])?;
        (at, filled) = (next, more);
    };
    if unit == 1 {
        return Ok(&buffer[begin..end]);
    }
    *buffer = lines
        .encoding
        .decode(&buffer[begin..end])
        .into_owned()
        .into_bytes();
    Ok(buffer)
}

fn grow(buffer: &mut Vec<u8>, length: usize) {
    if buffer.len() < length {
        buffer.resize(length, 0);
    }
}

/// Start of the line after the first newline at or after `from`.
fn behind_newline(bytes: &[u8], lines: &Lines, from: usize) -> Option<usize> {
    let newline = lines.newline;
    match lines.encoding {
        Encoding::Utf8 | Encoding::Windows1252 => {
            memchr::memchr(newline, &bytes[from..]).map(|at| from + at + 1)
        }
        Encoding::Utf16Le | Encoding::Utf16Be => {
            let wanted = match lines.encoding {
                Encoding::Utf16Le => [newline, 0],
                _ => [0, newline],
            };
            let mut pairs = bytes[from..].chunks_exact(2);
            pairs
                .position(|pair| pair == wanted)
                .map(|at| from + 2 * at + 2)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn conserves_every_line_whatever_its_place() {
        // Lines of many lengths, some longer than one further read.
        let mut text = String::new();
        for i in 0..60_000_u32 {
            text += &format!("{i};{}\n", "x".repeat((i % 97) as usize));
        }
        text += &"long ".repeat(300_000);
        text += "\nlast without an end";
        for encoding in [Encoding::Utf8, Encoding::Utf16Le] {
            let bytes: Vec<u8> = match encoding {
                Encoding::Utf8 => text.clone().into_bytes(),
                _ => text.encode_utf16().flat_map(u16::to_le_bytes).collect(),
            };
            let lines = Lines {
                start: 0,
                end: bytes.len() as u64,
                encoding,
                newline: b'\n',
            };
            let source = Source::from_bytes("t", bytes);
            let mut whole = Vec::new();
            for index in 0..stretches(&lines) {
                whole.extend_from_slice(stretch(&source, &lines, index, &mut Vec::new()).unwrap());
            }
            assert!(whole == text.as_bytes(), "{encoding:?}");
        }
    }

    #[test]
    fn rejects_a_line_without_an_end() {
        let source = Source::from_bytes("t", vec![b'x'; 7 << 20]);
        let lines = Lines {
            start: 0,
            end: 7 << 20,
            encoding: Encoding::Utf8,
            newline: b'\n',
        };
        let error = stretch(&source, &lines, 0, &mut Vec::new()).unwrap_err();
        let error = error.to_string();
        assert!(error.contains("a line is longer than 4 MiB"), "{error}");
    }
}
