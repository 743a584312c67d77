//! Finds the tables of a text: each a header, then rows.

use crate::text::encoding::{Encoding, tell_encoding};
use crate::text::lines::{Lines, stretch, stretches};
use crate::text::missing::MissingWords;
use crate::text::options::TextOptions;
use crate::text::read::TextReader;
use windfall_source::error::Error;
use windfall_source::source::Source;

/// Longest text in which several tables are looked for; bytes.
const LONGEST: u64 = 1 << 26;

/// Rows that make a table.
const FEWEST_ROWS: u64 = 3;

const MOST_TABLES: usize = 1000;

/// A table of a text, with the lines above it that describe it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Stretch {
    /// First byte.
    pub start: u64,
    /// One past the last byte.
    pub end: u64,
    /// Lines of the text above it.
    pub lines_above: u64,
}

/// Settings for one table of a text.
pub fn part_options(
    options: &TextOptions,
    part: Stretch,
    whole: u64,
    encoding: Encoding,
) -> TextOptions {
    TextOptions {
        encoding: Some(encoding),
        lines_above: options.lines_above + part.lines_above,
        footer: if part.end == whole { options.footer } else { 0 },
        ..options.clone()
    }
}

/// The tables of a text, with its encoding; none where it has one table, or where the user has
/// said in which line its header stands.
///
/// # Errors
/// The file cannot be read.
pub fn split(source: &Source, options: &TextOptions) -> Result<(Vec<Stretch>, Encoding), Error> {
    let (told, mark) = tell_encoding(&source.head(1 << 16)?);
    let encoding = options.encoding.unwrap_or(told);
    if source.length() > LONGEST || options.header_line.is_some() {
        return Ok((Vec::new(), encoding));
    }
    let found = stacked(source, encoding, mark as u64, options)?;
    if !(2..=MOST_TABLES).contains(&found.len()) {
        return Ok((Vec::new(), encoding));
    }
    // What has no names above its columns belongs to the table before.
    let mut tables: Vec<Stretch> = Vec::new();
    for part in found {
        let own = part_options(options, part, source.length(), encoding);
        let opened = TextReader::open(source.part(part.start, part.end), &own);
        let headed = opened.is_ok_and(|reader| reader.headed && reader.columns() > 1);
        match tables.last_mut() {
            Some(before) if !headed => before.end = part.end,
            None if !headed => return Ok((Vec::new(), encoding)),
            _ => tables.push(part),
        }
    }
    match tables.len() {
        1 => Ok((Vec::new(), encoding)),
        _ => Ok((tables, encoding)),
    }
}

/// Kinds of lines, by their beginnings.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Line {
    /// Begins with a number, or a word for a missing one.
    Row,
    /// Blank, or a comment.
    Blank,
    Other,
}

/// Stretches that end in rows, each from the end of the one before.
fn stacked(
    source: &Source,
    encoding: Encoding,
    mark: u64,
    options: &TextOptions,
) -> Result<Vec<Stretch>, Error> {
    let head = source.head(1 << 16)?;
    let lines = Lines {
        start: mark,
        end: source.length(),
        encoding,
        newline: if head.contains(&b'\n') { b'\n' } else { b'\r' },
    };
    let missing = MissingWords::new(&options.missing);
    let mut found: Vec<Stretch> = Vec::new();
    // Where the next table begins, and its rows so far.
    let mut next: Option<(u64, u64)> = Some((0, 0));
    let (mut at, mut line, mut rows) = (mark, 0, 0);
    let mut buffer = Vec::new();
    for index in 0..stretches(&lines) {
        let mut rest = stretch(source, &lines, index, &mut buffer)?;
        while !rest.is_empty() {
            let end = memchr::memchr(lines.newline, rest).map_or(rest.len(), |end| end + 1);
            let text;
            (text, rest) = rest.split_at(end);
            match kind(text, &missing, options.comment.as_deref()) {
                Line::Blank => {}
                Line::Row => {
                    rows += 1;
                    if rows == FEWEST_ROWS
                        && let Some((start, lines_above)) = next.take()
                    {
                        found.push(Stretch {
                            start,
                            end: lines.end,
                            lines_above,
                        });
                        if found.len() > MOST_TABLES {
                            return Ok(found);
                        }
                    }
                }
                Line::Other => {
                    next.get_or_insert((at, line));
                    rows = 0;
                }
            }
            line += 1;
            at += match encoding.unit() {
                1 => text.len() as u64,
                _ => 2 * String::from_utf8_lossy(text).encode_utf16().count() as u64,
            };
        }
    }
    for index in 1..found.len() {
        found[index - 1].end = found[index].start;
    }
    Ok(found)
}

fn kind(line: &[u8], missing: &MissingWords, comment: Option<&str>) -> Line {
    // Most lines begin with a digit, which begins no comment of ours.
    if comment.is_none() && line.first().is_some_and(u8::is_ascii_digit) {
        return Line::Row;
    }
    let separator = |byte: &u8| b" \t,;|\"\r\n".contains(byte);
    let Some(first) = line.iter().position(|byte| !separator(byte)) else {
        return Line::Blank;
    };
    let text = &line[first..];
    let begins = |mark: &str| text.starts_with(mark.as_bytes());
    if comment.map_or_else(|| ["#", "%", "//"].into_iter().any(begins), begins) {
        return Line::Blank;
    }
    let unsigned = text.trim_ascii_start();
    let unsigned = unsigned
        .strip_prefix("\u{2212}".as_bytes())
        .unwrap_or(unsigned);
    let unsigned = unsigned
        .strip_prefix(b"-")
        .or(unsigned.strip_prefix(b"+"))
        .unwrap_or(unsigned);
    let digits = unsigned.strip_prefix(b".").unwrap_or(unsigned);
    if digits.first().is_some_and(u8::is_ascii_digit) {
        return Line::Row;
    }
    let end = text.iter().position(|byte| b"\t,;|\"\r\n".contains(byte));
    let cell = String::from_utf8_lossy(&text[..end.unwrap_or(text.len())]);
    match missing.has(cell.trim()) {
        true => Line::Row,
        false => Line::Other,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tables(text: &str) -> Vec<Stretch> {
        let source = Source::from_bytes("t", text.as_bytes().to_vec());
        split(&source, &TextOptions::default()).unwrap().0
    }

    #[test]
    fn closed_form_tables_of_a_text() {
        let first = "Test 1\nt,F\ns,N\n0,1\n1,2\n2,3\n\n";
        let second = "Test 2\nx;y;z\n1;2;3\nNaN;2;3\n3;4;5\n";
        let whole = format!("{first}{second}");
        let at = |start: usize, end: usize, lines_above| Stretch {
            start: start as u64,
            end: end as u64,
            lines_above,
        };
        let expected = [at(0, first.len(), 0), at(first.len(), whole.len(), 7)];
        assert_eq!(tables(&whole), expected);
    }

    #[test]
    fn closed_form_one_table_stays_one() {
        for text in [
            "t,F\n0,1\n1,2\n2,3\n",
            // A remark among the rows, a word in them, a comment.
            "t,F\n0,1\n1,2\n2,3\nlamp switched on\n3,4\n4,5\n5,6\n",
            "t,F\n0,1\n1,2\n2,3\nabc,3\n3,4\n4,5\n5,6\n",
            "t,F\n0,1\n1,2\n2,3\n# lamp on\n3,4\n4,5\n5,6\n",
            // A list of numbers above the table.
            "Calibration\n1.5\n2.5\n3.5\nt,F\n0,1\n1,2\n2,3\n",
            // Text in the first column; a footer.
            "a,1\nb,2\nc,3\nd,4\n",
            "t,F\n0,1\n1,2\n2,3\nMean,2\nSD,1\n",
        ] {
            assert_eq!(tables(text), [], "{text}");
        }
    }
}
