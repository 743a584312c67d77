//! Universal files: data sets 58 and 58b, functions at nodes.
//!
//! # Source
//! Structural Dynamics Research Corporation, "Universal file format, data set 58".

use crate::contents::{ChannelContents, Contents, Format, Note, TimeBase};
use crate::names::Names;
use crate::number::Number;
use crate::reader::{Reader, Sink};
use crate::text::number::{Cell, Marks, cell};
use crate::uff::header::{Header, TIME, malformed, parse_header};
use crate::uff::lines::LineReader;
use windfall_source::error::{Error, Place};
use windfall_source::source::Source;

const HEADER_LINES: usize = 11;

/// Numbers passed on at a time.
const BLOCK: usize = 1 << 15;

const MOST_SETS: u64 = 1_000_000;

#[derive(Debug)]
pub struct UffReader {
    source: Source,
    contents: Contents,
    records: Vec<Record>,
    /// Record of each channel, and its place within points.
    places: Vec<(usize, usize)>,
    names: Names,
}

/// The data of one function.
#[derive(Clone, Debug)]
struct Record {
    start: u64,
    end: u64,
    first_line: u64,
    points: u64,
    coding: Coding,
    /// Numbers per point: abscissa if uneven, real part, imaginary part.
    width: usize,
    /// Widths of the columns of text; characters.
    columns: Vec<usize>,
    name: String,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Coding {
    Text,
    Binary { number: Number, big_endian: bool },
}

impl UffReader {
    pub fn open(source: Source) -> Result<Self, Error> {
        let mut found = Self {
            contents: Contents {
                format: Format::Uff58,
                variant: String::new(),
                channels: Vec::new(),
                properties: Vec::new(),
                notes: Vec::new(),
            },
            records: Vec::new(),
            places: Vec::new(),
            names: Names::default(),
            source,
        };
        let mut others: Vec<(String, u64)> = Vec::new();
        let mut lines = LineReader::new(0, 1);
        let mut sets = 0_u64;
        while let Some(line) = lines.next(&found.source)? {
            if line.text.trim() != "-1" {
                continue;
            }
            let Some(title) = lines.next(&found.source)? else {
                break;
            };
            sets += 1;
            if sets > MOST_SETS {
                return Err(malformed(
                    &found.source,
                    title.number,
                    "there are more than 1,000,000 data sets",
                ));
            }
            let number = title.text.get(..6).unwrap_or(&title.text).trim().to_owned();
            let binary = title.text.trim_start().starts_with("58b");
            if number == "58" || binary {
                read_function(&mut found, &mut lines, &title.text, binary)?;
            } else {
                match others.iter_mut().find(|(known, _)| *known == number) {
                    Some((_, count)) => *count += 1,
                    None => others.push((number, 1)),
                }
                skip_set(&found.source, &mut lines)?;
            }
        }
        for (number, count) in others {
            found.contents.notes.push(Note::LeftOut {
                what: format!("{count} data set(s) of type {number}"),
                why: "only functions (58 and 58b) are read".to_owned(),
            });
        }
        if found.records.is_empty() {
            return Err(found.source.malformed(
                Place::File,
                "this universal file holds no function (data set 58 or 58b)",
                "export time histories or spectra as data set 58",
            ));
        }
        found.contents.variant = format!("{} functions", found.records.len());
        Ok(found)
    }
}

/// Skips a data set, including the "-1" at its end.
fn skip_set(source: &Source, lines: &mut LineReader) -> Result<bool, Error> {
    while let Some(line) = lines.next(source)? {
        if line.text.trim() == "-1" {
            return Ok(true);
        }
    }
    Ok(false)
}

fn read_function(
    found: &mut UffReader,
    lines: &mut LineReader,
    title: &str,
    binary: bool,
) -> Result<(), Error> {
    let title_line = lines.number();
    let mut header = Vec::new();
    for _ in 0..HEADER_LINES {
        match lines.next(&found.source)? {
            Some(line) => header.push(line.text),
            None => {
                return Err(malformed(
                    &found.source,
                    lines.number(),
                    "the header of a function is incomplete",
                ));
            }
        }
    }
    let header = parse_header(&found.source, &header, title_line)?;
    let width = 1 + usize::from(header.complex) + usize::from(!header.even);
    let start = lines.offset();
    let first_line = lines.number();
    let (coding, end) = match binary {
        true => binary_data(found, lines, title, &header, width)?,
        false => {
            let mut end = lines.offset();
            let mut closed = false;
            while let Some(line) = lines.next(&found.source)? {
                if line.text.trim() == "-1" {
                    closed = true;
                    break;
                }
                end = lines.offset();
            }
            if !closed {
                let missing = format!("the end of the function \"{}\"", header.name);
                found.contents.notes.push(Note::CutOff(missing));
            }
            (Coding::Text, end)
        }
    };
    let columns = match (header.double, header.even, header.complex) {
        (false, ..) => vec![13; 6],
        (true, true, _) => vec![20; 4],
        (true, false, false) => vec![13, 20, 13, 20],
        (true, false, true) => vec![13, 20, 20],
    };
    let record = Record {
        start,
        end,
        first_line,
        points: header.points,
        coding,
        width,
        columns,
        name: header.name.clone(),
    };
    add_channels(found, record, &header);
    Ok(())
}

fn binary_data(
    found: &mut UffReader,
    lines: &mut LineReader,
    title: &str,
    header: &Header,
    width: usize,
) -> Result<(Coding, u64), Error> {
    let field = |from: usize, to: usize| {
        let text = title.get(from..to.min(title.len())).unwrap_or_default();
        text.trim().parse::<u64>().ok()
    };
    let (order, float) = (field(7, 13), field(13, 19));
    if float.is_some_and(|float| float != 2) {
        return Err(found.source.unsupported(
            Place::Object(header.name.clone()),
            "floats of DEC or IBM machines",
            "export the functions with IEEE floats",
        ));
    }
    let number = if header.double {
        Number::F64
    } else {
        Number::F32
    };
    let needed = header.points.checked_mul(width as u64 * number.size());
    let left = found.source.length() - lines.offset();
    let bytes = match (needed, field(31, 43)) {
        (Some(needed), Some(declared)) if declared >= needed => declared,
        (Some(needed), None) => needed,
        _ => {
            return Err(malformed(
                &found.source,
                lines.number(),
                &format!(
                    "{} points do not fit into the declared bytes",
                    header.points
                ),
            ));
        }
    };
    if bytes > left {
        found.contents.notes.push(Note::CutOff(format!(
            "the function \"{}\" needs {bytes} bytes, {left} are left",
            header.name
        )));
    }
    let end = lines.offset() + needed.unwrap_or(bytes).min(left);
    lines.seek(lines.offset() + bytes.min(left));
    let coding = Coding::Binary {
        number,
        big_endian: order == Some(2),
    };
    // Skip the "-1" after the data.
    skip_set(&found.source, lines)?;
    Ok((coding, end))
}

/// Adds the channels of a function: uneven abscissa, real and imaginary parts.
fn add_channels(found: &mut UffReader, record: Record, header: &Header) {
    let index = found.records.len();
    let name = found.names.unique(&header.name);
    let mut place = 0;
    let mut time = match header.even && header.interval > 0.0 && header.abscissa.kind == TIME {
        true => TimeBase::Uniform {
            start: header.start,
            interval: header.interval,
        },
        false => TimeBase::Unknown,
    };
    let stored_as = match (record.coding, header.double) {
        (Coding::Text, _) => "text",
        (Coding::Binary { .. }, true) => "64-bit float",
        (Coding::Binary { .. }, false) => "32-bit float",
    };
    let channel = |name: String, unit: &Option<String>, time: TimeBase| ChannelContents {
        name,
        unit: unit.clone(),
        length: Some(header.points),
        time,
        stored_as: stored_as.to_owned(),
        properties: header.properties.clone(),
    };
    if !header.even {
        if header.abscissa.kind == TIME {
            time = TimeBase::Channel(found.contents.channels.len());
        }
        found.contents.channels.push(channel(
            format!("{name} (abscissa)"),
            &header.abscissa.unit,
            TimeBase::Unknown,
        ));
        found.places.push((index, place));
        place += 1;
    }
    let parts: &[&str] = if header.complex {
        &[" (real)", " (imaginary)"]
    } else {
        &[""]
    };
    for part in parts {
        let mut added = channel(format!("{name}{part}"), &header.ordinate.unit, time);
        if header.even && time == TimeBase::Unknown {
            let unit = header.abscissa.unit.as_deref().unwrap_or("");
            let axis = format!(
                "from {} in steps of {} {unit}",
                header.start, header.interval
            );
            added
                .properties
                .push(("abscissa (no time)".to_owned(), axis.trim().to_owned()));
        }
        found.contents.channels.push(added);
        found.places.push((index, place));
        place += 1;
    }
    found.records.push(Record { name, ..record });
}

/// Collects the requested numbers of the points of a record.
struct Collector<'a> {
    wanted: &'a [(usize, usize)],
    width: usize,
    at: u64,
    end: u64,
    blocks: Vec<Vec<f64>>,
    sink: &'a mut dyn Sink,
}

impl Collector<'_> {
    fn push(&mut self, value: f64) -> Result<(), Error> {
        if self.at >= self.end {
            return Ok(());
        }
        let place = (self.at % self.width as u64) as usize;
        self.at += 1;
        for (block, (position, wanted)) in self.blocks.iter_mut().zip(self.wanted) {
            if *wanted == place {
                block.push(value);
                if block.len() == BLOCK {
                    self.sink.take(*position, block)?;
                    block.clear();
                }
            }
        }
        Ok(())
    }

    fn finish(&mut self) -> Result<(), Error> {
        for (block, (position, _)) in self.blocks.iter().zip(self.wanted) {
            self.sink.take(*position, block)?;
        }
        Ok(())
    }
}

impl Reader for UffReader {
    fn contents(&self) -> &Contents {
        &self.contents
    }

    fn read(&mut self, wanted: &[usize], sink: &mut dyn Sink) -> Result<(), Error> {
        for (index, record) in self.records.iter().enumerate() {
            let places = wanted.iter().enumerate().filter_map(|(position, channel)| {
                let (from, place) = self.places[*channel];
                (from == index).then_some((position, place))
            });
            let places: Vec<(usize, usize)> = places.collect();
            if places.is_empty() {
                continue;
            }
            let mut collector = Collector {
                wanted: &places,
                width: record.width,
                at: 0,
                end: record.points.saturating_mul(record.width as u64),
                blocks: vec![Vec::new(); places.len()],
                sink,
            };
            match record.coding {
                Coding::Binary { number, big_endian } => {
                    read_binary(&self.source, record, number, big_endian, &mut collector)?;
                }
                Coding::Text => read_text(&self.source, record, &mut collector)?,
            }
            let missing = collector.end - collector.at;
            collector.finish()?;
            if missing > 0 {
                let missing = format!("{missing} numbers of the function \"{}\"", record.name);
                let note = Note::CutOff(missing);
                if !self.contents.notes.contains(&note) {
                    self.contents.notes.push(note);
                }
            }
        }
        Ok(())
    }
}

fn read_binary(
    source: &Source,
    record: &Record,
    number: Number,
    big_endian: bool,
    collector: &mut Collector,
) -> Result<(), Error> {
    let size = number.size();
    let mut samples = Vec::new();
    let mut at = record.start;
    while at + size <= record.end {
        let count = ((record.end - at) / size).min(BLOCK as u64);
        let bytes = source.bytes_at(at, count * size)?;
        samples.resize(count as usize, 0.0);
        number.decode(&bytes, number.packed(big_endian), &mut samples);
        samples
            .iter()
            .try_for_each(|sample| collector.push(*sample))?;
        at += count * size;
    }
    Ok(())
}

fn read_text(source: &Source, record: &Record, collector: &mut Collector) -> Result<(), Error> {
    let marks = Marks::decimal(b'.');
    let mut lines = LineReader::new(record.start, record.first_line);
    while lines.offset() < record.end {
        let Some(line) = lines.next(source)? else {
            break;
        };
        for text in cells(&line.text, &record.columns) {
            match cell(text, marks) {
                Cell::Number(value) => collector.push(value)?,
                Cell::Blank => {}
                Cell::Other => {
                    let fault = Error::NotNumber {
                        path: source.path().to_path_buf(),
                        place: Place::Cell {
                            line: line.number,
                            column: record.name.clone(),
                        },
                        text: crate::text::table::shortened(text.trim()),
                        hint: String::new(),
                    };
                    collector.sink.fault(fault)?;
                    collector.push(f64::NAN)?;
                }
            }
        }
    }
    Ok(())
}

/// Splits a line into its fixed columns, or at blanks if it does not fit them.
fn cells<'a>(line: &'a str, columns: &[usize]) -> Vec<&'a str> {
    let line = line.trim_end();
    let mut ends = columns.iter().scan(0, |at, width| {
        *at += width;
        Some(*at)
    });
    let fits = line.is_ascii() && ends.any(|end| end == line.len());
    if !fits {
        return line.split_whitespace().collect();
    }
    let mut cells = Vec::new();
    let mut at = 0;
    for width in columns {
        match line.get(at..at + width) {
            Some(text) => cells.push(text),
            None => break,
        }
        at += width;
    }
    cells
}
