//! LabVIEW measurement files (LVM): text with a header for each segment.
//!
//! # Source
//! National Instruments, "Specification for the LabVIEW Measurement File (.lvm)".

use crate::contents::{ChannelContents, Contents, Format, Note, TimeBase};
use crate::names::Names;
use crate::reader::{Reader, Sink};
use crate::text::encoding::{Encoding, tell_encoding};
use crate::text::lines::Lines;
use crate::text::lvm_lines::{header_begin, split_lines};
use crate::text::measurements::{Rows, starts_of_measurements};
use crate::text::missing::MissingWords;
use crate::text::number::{Marks, number};
use crate::text::options::TextOptions;
use crate::text::rows::{ColumnKind, RowPlan, Separator};
use crate::text::table::{Table, read_table};
use windfall_source::error::{Error, Place};
use windfall_source::source::Source;

const END_OF_HEADER: &[u8] = b"***End_of_Header***";

/// Bytes searched at a time.
const BLOCK: u64 = 1 << 20;

/// Longest header of a segment; bytes.
const LONGEST_HEADER: u64 = 1 << 20;

const MOST_SEGMENTS: usize = 10_000;

/// Tolerance between printed times and the spacing in the header, in steps.
const EVEN: f64 = 0.1;

/// Rows compared with the spacing in the header.
const FIRST_ROWS: usize = 50;

/// Bytes read for the first rows.
const FIRST_BYTES: u64 = 1 << 14;

/// A LabVIEW measurement file.
#[derive(Debug)]
pub struct LvmReader {
    source: Source,
    contents: Contents,
    segments: Vec<Table>,
    /// Segment and column of each channel.
    places: Vec<(usize, usize)>,
}

struct FileHeader {
    separator: char,
    marks: Marks,
    x_columns: XColumns,
    encoding: Encoding,
    properties: Vec<(String, String)>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum XColumns {
    No,
    One,
    Multi,
}

/// A segment: its header and the range of its rows.
#[derive(Clone)]
struct Segment {
    header: Vec<Vec<String>>,
    names: Vec<String>,
    start: u64,
    end: u64,
    first_line: u64,
}

impl LvmReader {
    /// Reads the headers of a file.
    pub fn open(source: Source, options: &TextOptions) -> Result<Self, Error> {
        let (encoding, _) = tell_encoding(&source.head(1 << 16)?);
        let marks = header_ends(&source)?;
        let [first, rest @ ..] = marks.as_slice() else {
            return Err(malformed(
                &source,
                1,
                "no header ends with ***End_of_Header***",
            ));
        };
        if rest.is_empty() {
            return Err(malformed(
                &source,
                1,
                "no segment with channels follows the header",
            ));
        }
        let file = file_header(&source, *first, encoding)?;
        let segments = find_segments(&source, &file, &marks)?;
        let mut contents = Contents {
            format: Format::Lvm,
            variant: String::new(),
            channels: Vec::new(),
            properties: file.properties.clone(),
            notes: Vec::new(),
        };
        let segments = split_measurements(&source, &file, segments, &mut contents)?;
        contents.variant = match segments.len() {
            1 => "one segment".to_owned(),
            count => format!("{count} segments"),
        };
        let missing = MissingWords::new(&options.missing);
        let mut places = Vec::new();
        let mut tables = Vec::new();
        let mut names = Names::default();
        for (index, segment) in segments.iter().enumerate() {
            let suffix = match segments.len() {
                1 => String::new(),
                _ => format!(" (segment {})", index + 1),
            };
            let columns =
                add_channels(&source, &file, segment, &suffix, &mut names, &mut contents)?;
            places.extend(columns.into_iter().map(|column| (index, column)));
            tables.push(table(&file, segment, &missing));
        }
        Ok(Self {
            source,
            contents,
            segments: tables,
            places,
        })
    }
}

fn malformed(source: &Source, line: u64, problem: &str) -> Error {
    source.malformed(
        Place::Line(line),
        format!("this is not a complete LabVIEW measurement file: {problem}"),
        "write the file again, or read it as text (format \"text\")",
    )
}

/// Offsets of the lines that end headers.
fn header_ends(source: &Source) -> Result<Vec<u64>, Error> {
    let finder = memchr::memmem::Finder::new(END_OF_HEADER);
    let mut found = Vec::new();
    let mut at = 0;
    while at < source.length() {
        // Blocks overlap in case a marker is split.
        let count = (BLOCK + END_OF_HEADER.len() as u64 - 1).min(source.length() - at);
        let bytes = source.bytes_at(at, count)?;
        found.extend(finder.find_iter(&bytes).map(|place| at + place as u64));
        if found.len() > MOST_SEGMENTS {
            return Err(malformed(source, 1, "it has more than 10,000 segments"));
        }
        at += BLOCK;
    }
    Ok(found)
}

/// End of the line that contains byte `at`.
fn line_end(source: &Source, at: u64) -> Result<u64, Error> {
    let mut from = at;
    while from < source.length() {
        let bytes = source.bytes_at(from, FIRST_BYTES.min(source.length() - from))?;
        if let Some(newline) = memchr::memchr(b'\n', &bytes) {
            return Ok(from + newline as u64 + 1);
        }
        from += bytes.len() as u64;
        if from - at > LONGEST_HEADER {
            break;
        }
    }
    Ok(from.min(source.length()))
}

fn file_header(source: &Source, end: u64, encoding: Encoding) -> Result<FileHeader, Error> {
    if end > LONGEST_HEADER {
        return Err(malformed(source, 1, "its header is longer than 1 MiB"));
    }
    let bytes = source.bytes_at(0, end)?;
    let text = encoding.decode(&bytes);
    // The character after the word "Separator" is the separator.
    let mark = text.lines().find_map(|line| {
        let rest = line.strip_prefix("Separator")?;
        rest.chars().next().filter(|c| !c.is_alphanumeric())
    });
    let separator = mark.filter(char::is_ascii).unwrap_or('\t');
    let lines: Vec<Vec<&str>> = text
        .lines()
        .map(|line| line.split(separator).collect())
        .collect();
    let value = |key: &str| {
        let line = lines.iter().find(|cells| cells[0].trim() == key)?;
        line.get(1).map(|value| value.trim())
    };
    let properties = lines.iter().skip(1).filter_map(|cells| {
        let (name, value) = (cells[0].trim(), cells.get(1)?.trim());
        (!name.is_empty() && !value.is_empty()).then(|| (name.to_owned(), value.to_owned()))
    });
    Ok(FileHeader {
        separator,
        marks: Marks::decimal(match value("Decimal_Separator") {
            Some(",") => b',',
            _ => b'.',
        }),
        x_columns: match value("X_Columns") {
            Some("No") => XColumns::No,
            Some("Multi") => XColumns::Multi,
            _ => XColumns::One,
        },
        encoding,
        properties: properties.collect(),
    })
}

fn find_segments(source: &Source, file: &FileHeader, marks: &[u64]) -> Result<Vec<Segment>, Error> {
    let mut segments: Vec<Segment> = Vec::new();
    let mut before = line_end(source, marks[0])?;
    let mut lines = count_lines(source, 0, before)?;
    for &mark in &marks[1..] {
        if mark < before {
            return Err(malformed(source, lines, "two headers overlap"));
        }
        let from = before.max(mark.saturating_sub(LONGEST_HEADER));
        let bytes = source.bytes_at(from, mark.saturating_sub(from))?;
        // The header begins after the last blank line.
        let (blank, begin) = header_begin(&bytes, file.separator);
        let begin = from + begin as u64;
        if let Some(last) = segments.last_mut() {
            last.end = from + blank as u64;
        }
        let text = source.bytes_at(begin, mark - begin)?;
        let header = split_lines(&file.encoding.decode(&text), file.separator);
        let names_at = line_end(source, mark)?;
        let start = line_end(source, names_at)?;
        let names = source.bytes_at(names_at, start - names_at)?;
        let names = split_lines(&file.encoding.decode(&names), file.separator);
        lines += count_lines(source, before, start)?;
        segments.push(Segment {
            header,
            names: names.into_iter().next().unwrap_or_default(),
            start,
            end: source.length(),
            first_line: lines + 1,
        });
        before = start;
    }
    Ok(segments)
}

/// Splits segments that hold more rows than their header says: LabVIEW appends later
/// measurements without a header of their own ("One header only").
fn split_measurements(
    source: &Source,
    file: &FileHeader,
    segments: Vec<Segment>,
    contents: &mut Contents,
) -> Result<Vec<Segment>, Error> {
    let mut split = Vec::new();
    for segment in segments {
        let samples = segment.header.iter().find(|cells| cells[0] == "Samples");
        let counts = samples.iter().flat_map(|cells| &cells[1..]);
        let counts = counts.filter_map(|cell| cell.parse::<u64>().ok());
        let Some(rows) = counts.max().filter(|rows| *rows > 1) else {
            split.push(segment);
            continue;
        };
        let place = Rows {
            start: segment.start,
            end: segment.end,
            first_line: segment.first_line,
        };
        let mut starts = starts_of_measurements(source, &place, file.separator as u8, rows)?;
        if file.x_columns != XColumns::No {
            // Where times go on, so does the measurement.
            let time = |at: u64| {
                let text = source.bytes_at(at, line_end(source, at)? - at)?;
                let cells = split_lines(&file.encoding.decode(&text), file.separator);
                let first = cells.first().and_then(|cells| cells.first());
                Ok(first.and_then(|cell| number(cell, file.marks)))
            };
            let begin = time(segment.start)?;
            let mut again = Vec::new();
            for start in starts {
                if start.0 == segment.start || time(start.0)? <= begin {
                    again.push(start);
                }
            }
            starts = again;
        }
        if starts.len() > 1 {
            contents.notes.push(Note::Assumed(format!(
                "line {}: the header speaks of {rows} samples and {} times as many follow; they are \
                 taken as measurements one after the other, segment by segment. If they are one \
                 measurement, read the file as text (format \"text\")",
                segment.first_line,
                starts.len()
            )));
        }
        for (part, &(start, line)) in starts.iter().enumerate() {
            if split.len() >= MOST_SEGMENTS {
                return Err(malformed(source, line, "it has more than 10,000 segments"));
            }
            split.push(Segment {
                start,
                first_line: line,
                end: starts.get(part + 1).map_or(segment.end, |next| next.0),
                ..segment.clone()
            });
        }
    }
    Ok(split)
}

fn count_lines(source: &Source, from: u64, to: u64) -> Result<u64, Error> {
    let mut count = 0;
    let mut at = from;
    while at < to {
        let bytes = source.bytes_at(at, BLOCK.min(to - at))?;
        count += memchr::memchr_iter(b'\n', &bytes).count() as u64;
        at += bytes.len() as u64;
    }
    Ok(count)
}

fn is_comment_column(segment: &Segment, column: usize) -> bool {
    column + 1 == segment.names.len() && segment.names[column] == "Comment"
}

fn table(file: &FileHeader, segment: &Segment, missing: &MissingWords) -> Table {
    let kind = |column| match is_comment_column(segment, column) {
        true => ColumnKind::Text,
        false => ColumnKind::Numbers,
    };
    Table {
        plan: RowPlan {
            separator: Separator::Mark(file.separator as u8),
            marks: file.marks,
            encoding: file.encoding,
            newline: b'\n',
            comments: Vec::new(),
            columns: (0..segment.names.len()).map(kind).collect(),
            missing: missing.clone(),
            short_rows: true,
        },
        lines: Lines {
            start: segment.start,
            end: segment.end,
            encoding: file.encoding,
            newline: b'\n',
        },
        first_line: segment.first_line,
        names: segment.names.clone(),
    }
}

/// Adds the channels of a segment; returns the column of each.
fn add_channels(
    source: &Source,
    file: &FileHeader,
    segment: &Segment,
    suffix: &str,
    names: &mut Names,
    contents: &mut Contents,
) -> Result<Vec<usize>, Error> {
    let value = |key: &str, column: usize| {
        let line = segment.header.iter().find(|cells| cells[0] == key)?;
        line.get(column).filter(|value| !value.is_empty()).cloned()
    };
    let number = |key: &str, column: usize| number(&value(key, column)?, file.marks);
    let is_x = |column: usize| match file.x_columns {
        XColumns::No | XColumns::One => column == 0,
        XColumns::Multi => column.is_multiple_of(2),
    };
    let last = match segment.names.last().map(String::as_str) {
        Some("Comment") => segment.names.len() - 1,
        _ => segment.names.len(),
    };
    if last < 2 {
        let line = segment.first_line.saturating_sub(1);
        return Err(malformed(
            source,
            line,
            "the line with the channel names is missing",
        ));
    }
    let first_rows = first_rows(source, file, segment)?;
    let first_interval = number("Delta_X", 1);
    let mut columns = Vec::new();
    let mut x_channel = None;
    for column in 0..last {
        let place = contents.channels.len();
        if is_x(column) && file.x_columns == XColumns::No {
            continue;
        }
        let name = names.unique(&match segment.names[column].as_str() {
            "" => format!("column_{}{suffix}", column + 1),
            name => format!("{name}{suffix}"),
        });
        if is_x(column) {
            x_channel = Some((place, column));
            contents
                .channels
                .push(channel(name, Some("s".to_owned()), TimeBase::Unknown));
            columns.push(column);
            continue;
        }
        let grid = number("X0", column)
            .zip(number("Delta_X", column))
            .filter(|g| g.1 > 0.0);
        let in_time = value("X_Dimension", column).is_none_or(|dimension| dimension == "Time");
        let time = match (grid, x_channel) {
            _ if !in_time => TimeBase::Unknown,
            (Some((start, interval)), None) => TimeBase::Uniform { start, interval },
            (Some((start, interval)), Some((x, x_column))) => {
                let own =
                    file.x_columns == XColumns::One && number("Delta_X", column) != first_interval;
                match own || agrees(&first_rows, x_column, start, interval) {
                    true => TimeBase::Uniform { start, interval },
                    false => TimeBase::Channel(x),
                }
            }
            (None, Some((x, _))) => TimeBase::Channel(x),
            (None, None) => TimeBase::Unknown,
        };
        let mut added = channel(name, value("Y_Unit_Label", column), time);
        for key in ["Samples", "Date", "Time", "X_Dimension"] {
            added
                .properties
                .extend(value(key, column).map(|value| (key.to_owned(), value)));
        }
        contents.channels.push(added);
        columns.push(column);
    }
    for cells in &segment.header {
        if cells[0] == "Notes" && cells.len() > 1 && !cells[1].is_empty() {
            contents
                .notes
                .push(Note::Odd(format!("the file says: {}", cells[1])));
        }
    }
    Ok(columns)
}

fn channel(name: String, unit: Option<String>, time: TimeBase) -> ChannelContents {
    ChannelContents {
        name,
        unit,
        length: None,
        time,
        stored_as: "text".to_owned(),
        properties: Vec::new(),
    }
}

/// The cells of the first rows of a segment.
fn first_rows(
    source: &Source,
    file: &FileHeader,
    segment: &Segment,
) -> Result<Vec<Vec<String>>, Error> {
    let count = FIRST_BYTES.min(segment.end.saturating_sub(segment.start));
    let bytes = source.bytes_at(segment.start, count)?;
    let mut rows = split_lines(&file.encoding.decode(&bytes), file.separator);
    // The last row may be incomplete.
    rows.pop();
    rows.truncate(FIRST_ROWS);
    Ok(rows)
}

/// Whether printed times match an even spacing to within rounding.
fn agrees(rows: &[Vec<String>], column: usize, start: f64, interval: f64) -> bool {
    let marks = Marks::decimal(b'.');
    let printed = |row: &Vec<String>| number(&row.get(column)?.replace(',', "."), marks);
    let times: Vec<f64> = rows.iter().filter_map(printed).collect();
    let even =
        |(row, time): (usize, &f64)| (time - start - row as f64 * interval).abs() < EVEN * interval;
    times.len() > 1 && times.iter().enumerate().all(even)
}

impl Reader for LvmReader {
    fn contents(&self) -> &Contents {
        &self.contents
    }

    fn read(&mut self, wanted: &[usize], sink: &mut dyn Sink) -> Result<(), Error> {
        for (index, table) in self.segments.iter().enumerate() {
            let columns = wanted.iter().enumerate().filter_map(|(position, channel)| {
                let (segment, column) = self.places[*channel];
                (segment == index).then_some((column, position))
            });
            let columns: Vec<(usize, usize)> = columns.collect();
            if !columns.is_empty() {
                // Short rows are normal here, so nothing was truncated.
                let found = read_table(&self.source, table, &columns, sink)?;
                let mut notes = found.notes(&table.names);
                notes.retain(|note| !self.contents.notes.contains(note));
                self.contents.notes.extend(notes);
            }
        }
        Ok(())
    }
}
