//! Reads the rows of a text table on all cores, in bounded memory.

use crate::contents::Note;
use crate::reader::Sink;
use crate::text::lines::{Lines, stretch, stretches};
use crate::text::midnight::Clock;
use crate::text::missing::{MissingCells, add_missing};
use crate::text::rows::{Column, Fault, RowPlan, Rows, most_rows, read_rows};
use rayon::prelude::*;
use windfall_source::error::{Error, Place};
use windfall_source::room::zeros;
use windfall_source::source::Source;

/// Stretches read ahead per thread.
const AHEAD: usize = 2;

/// Longest cell text quoted in a message; characters.
const SHOWN: usize = 40;

/// A table in a file.
#[derive(Debug)]
pub struct Table {
    pub plan: RowPlan,
    pub lines: Lines,
    /// Line number of the first row, from 1.
    pub first_line: u64,
    /// Column names, for messages.
    pub names: Vec<String>,
}

/// A truncated last line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CutOff {
    /// Line number, from 1.
    pub line: u64,
    /// Number of cells.
    pub found: usize,
}

/// What reading a table has found besides its samples.
#[derive(Debug, Default)]
pub struct Found {
    /// The last line, if it was truncated; it is left out.
    pub cut_off: Option<CutOff>,
    /// Cells taken as missing samples; lines of the file, from 1.
    pub missing: Vec<MissingCells>,
    /// Columns of times of day that pass midnight, and rows before that.
    pub midnights: Vec<(usize, usize)>,
}

impl Found {
    /// What the user should know, the end of the table aside.
    pub fn notes(&self, names: &[String]) -> Vec<Note> {
        let missing = self.missing.iter().map(|cells| Note::Missing {
            column: names[cells.column].clone(),
            count: cells.count,
            line: cells.line,
            word: shortened(&cells.word),
        });
        let midnights = self.midnights.iter().map(|(column, rows)| {
            Note::Assumed(format!(
                "the times of day in \"{}\" pass midnight after {rows} rows and go on from there",
                names[*column]
            ))
        });
        missing.chain(midnights).collect()
    }
}

/// Samples of a stretch by column, and what else was found.
type Read = (Vec<Vec<f64>>, Rows);

/// Reads columns of a table in blocks.
///
/// * `wanted`: file column and sink position
pub fn read_table(
    source: &Source,
    table: &Table,
    wanted: &[(usize, usize)],
    sink: &mut dyn Sink,
) -> Result<Found, Error> {
    let places = places(table, wanted.iter().map(|(column, _)| *column));
    let count = stretches(&table.lines);
    let batch = (AHEAD * rayon::current_num_threads()) as u64;
    let mut clocks: Vec<Option<Clock>> = wanted
        .iter()
        .map(|(column, _)| Clock::of(table.plan.columns[*column]))
        .collect();
    let midnights = |clocks: &[Option<Clock>]| {
        let passed = wanted.iter().zip(clocks);
        let passed = passed.filter_map(|((column, _), c)| Some((*column, c.as_ref()?.midnight?)));
        passed.collect()
    };
    let mut course = Course::new(table);
    let mut start = 0;
    while start < count {
        let end = (start + batch).min(count);
        let read: Vec<Result<Read, Error>> = (start..end)
            .into_par_iter()
            .map_init(Vec::new, |buffer, index| {
                let bytes = stretch(source, &table.lines, index, buffer)?;
                let mut room = vec![vec![0.0; most_rows(bytes, &table.plan)]; wanted.len()];
                let mut columns: Vec<Column> =
                    room.iter_mut().map(|room| Column::new(room)).collect();
                let rows = read_rows(bytes, &table.plan, &places, &mut columns);
                Ok((room, rows))
            })
            .collect();
        for read in read {
            let (mut columns, rows) = read?;
            course.faults(source, table, &rows, sink)?;
            let wanted = wanted.iter().zip(&mut clocks);
            for (column, ((_, position), clock)) in columns.iter_mut().zip(wanted) {
                if let Some(clock) = clock {
                    clock.pass(&mut column[..rows.rows]);
                }
                sink.take(*position, &column[..rows.rows])?;
            }
            course.advance(source, table, rows)?;
            if course.found.cut_off.is_some() {
                course.found.midnights = midnights(&clocks);
                return Ok(course.found);
            }
        }
        start = end;
    }
    course.found.midnights = midnights(&clocks);
    course.end(source, table, wanted.is_empty())
}

/// Reads whole columns, parsing stretches directly into their final place.
///
/// * `wanted`: file columns
pub fn read_whole_table(
    source: &Source,
    table: &Table,
    wanted: &[usize],
) -> Result<(Vec<Vec<f64>>, Found), Error> {
    struct Strict;
    impl Sink for Strict {
        fn take(&mut self, _: usize, _: &[f64]) -> Result<(), Error> {
            Ok(())
        }
    }
    let places = places(table, wanted.iter().copied());
    let count = stretches(&table.lines);
    let lengths: Vec<usize> = (0..count)
        .into_par_iter()
        .map_init(Vec::new, |buffer, index| {
            let bytes = stretch(source, &table.lines, index, buffer)?;
            Ok(most_rows(bytes, &table.plan))
        })
        .collect::<Result<_, Error>>()?;
    let most = lengths.iter().sum();
    let mut columns: Vec<Vec<f64>> = wanted.iter().map(|_| zeros(most)).collect();

    // The space of each stretch in every column.
    let mut rest: Vec<&mut [f64]> = columns.iter_mut().map(Vec::as_mut_slice).collect();
    let mut rooms: Vec<Vec<Column>> = Vec::new();
    for length in &lengths {
        let mut parts = Vec::new();
        for whole in &mut rest {
            let (part, after) = std::mem::take(whole).split_at_mut(*length);
            *whole = after;
            parts.push(Column::new(part));
        }
        rooms.push(parts);
    }
    let read: Vec<Rows> = rooms
        .into_par_iter()
        .enumerate()
        .map_init(Vec::new, |buffer, (index, mut rooms)| {
            let bytes = stretch(source, &table.lines, index as u64, buffer)?;
            Ok(read_rows(bytes, &table.plan, &places, &mut rooms))
        })
        .collect::<Result<_, Error>>()?;

    // Close the gaps left by blank lines and comments.
    let (mut from, mut to) = (0, 0);
    let mut course = Course::new(table);
    for (rows, length) in read.into_iter().zip(&lengths) {
        course.faults(source, table, &rows, &mut Strict)?;
        if from != to {
            columns
                .iter_mut()
                .for_each(|column| column.copy_within(from..from + rows.rows, to));
        }
        from += length;
        to += rows.rows;
        course.advance(source, table, rows)?;
        if course.found.cut_off.is_some() {
            break;
        }
    }
    columns.iter_mut().for_each(|column| column.truncate(to));
    for (column, index) in columns.iter_mut().zip(wanted) {
        if let Some(mut clock) = Clock::of(table.plan.columns[*index]) {
            clock.pass(column);
            let midnight = clock.midnight.map(|rows| (*index, rows));
            course.found.midnights.extend(midnight);
        }
    }
    Ok((columns, course.end(source, table, wanted.is_empty())?))
}

fn places(table: &Table, wanted: impl Iterator<Item = usize>) -> Vec<Option<usize>> {
    let mut places = vec![None; table.plan.columns.len()];
    for (place, column) in wanted.enumerate() {
        places[column] = Some(place);
    }
    places
}

/// Progress through a table.
struct Course {
    line: u64,
    rows: usize,
    found: Found,
}

impl Course {
    fn new(table: &Table) -> Self {
        Self {
            line: table.first_line,
            rows: 0,
            found: Found::default(),
        }
    }

    fn faults(
        &self,
        source: &Source,
        table: &Table,
        rows: &Rows,
        sink: &mut dyn Sink,
    ) -> Result<(), Error> {
        let faults = rows.faults.iter();
        faults
            .map(|fault| fault_error(source, table, fault, self.line))
            .try_for_each(|f| sink.fault(f))
    }

    /// Moves past a stretch; notes a truncated last line.
    fn advance(&mut self, source: &Source, table: &Table, rows: Rows) -> Result<(), Error> {
        self.rows += rows.rows;
        for cells in rows.missing {
            let line = self.line + cells.line;
            add_missing(&mut self.found.missing, MissingCells { line, ..cells });
        }
        let Some(ragged) = rows.ragged else {
            self.line += rows.lines;
            return Ok(());
        };
        let (line, found) = (self.line + ragged.line, ragged.found);
        let expected = table.plan.columns.len();
        if ragged.last && self.rows > 0 && found < expected {
            self.found.cut_off = Some(CutOff { line, found });
            return Ok(());
        }
        let problem =
            format!("expected {expected} cells, as in the lines before, but found {found}");
        Err(malformed(source, line, problem))
    }

    fn end(self, source: &Source, table: &Table, nothing_wanted: bool) -> Result<Found, Error> {
        match self.rows == 0 && !nothing_wanted {
            true => Err(malformed(
                source,
                table.first_line,
                "there are no rows of numbers".to_owned(),
            )),
            false => Ok(self.found),
        }
    }
}

fn malformed(source: &Source, line: u64, problem: String) -> Error {
    source.malformed(
        Place::Line(line),
        problem,
        "mend the line, or say with the settings separator, decimal, header_line and footer \
         how to read the file",
    )
}

fn fault_error(source: &Source, table: &Table, fault: &Fault, first_line: u64) -> Error {
    Error::NotNumber {
        path: source.path().to_path_buf(),
        place: Place::Cell {
            line: first_line + fault.line,
            column: table.names[fault.column].clone(),
        },
        text: shortened(&fault.text),
        hint: hint(table, &fault.text),
    }
}

fn hint(table: &Table, text: &str) -> String {
    let decimal = char::from(table.plan.marks.decimal);
    let other = if decimal == ',' { '.' } else { ',' };
    let swapped = text.replacen(other, &decimal.to_string(), 1);
    if text.contains(other) && swapped.replace(decimal, ".").parse::<f64>().is_ok() {
        return format!(" (the other cells have \"{decimal}\" before the decimals)");
    }
    let advice = "; if it stands for a missing sample, name it: missing = ";
    format!("{advice}[\"{}\"]", shortened(text))
}

/// Shortens a text for a message.
pub fn shortened(text: &str) -> String {
    match text.char_indices().nth(SHOWN) {
        Some((at, _)) => format!("{}…", &text[..at]),
        None => text.to_owned(),
    }
}
