//! Reads the rows of a text table on all cores, in bounded memory.

use crate::error::{Error, Place};
use crate::reader::Sink;
use crate::room::zeros;
use crate::source::Source;
use crate::text::lines::{Lines, stretch, stretch_in, stretches};
use crate::text::rows::{Column, Fault, RowPlan, Rows, most_rows, read_rows};
use rayon::prelude::*;

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

/// Samples of a stretch by column, and what else was found.
type Read = (Vec<Vec<f64>>, Rows);

/// Reads columns of a table in blocks.
///
/// * `wanted`: file column and sink position
///
/// Returns the last line if it was truncated; it is left out.
pub fn read_table(
    source: &Source,
    table: &Table,
    wanted: &[(usize, usize)],
    sink: &mut dyn Sink,
) -> Result<Option<CutOff>, Error> {
    let places = places(table, wanted.iter().map(|(column, _)| *column));
    let count = stretches(&table.lines);
    let batch = (AHEAD * rayon::current_num_threads()) as u64;
    let mut course = Course::new(table);
    let mut start = 0;
    while start < count {
        let end = (start + batch).min(count);
        let read: Vec<Result<Read, Error>> = (start..end)
            .into_par_iter()
            .map(|index| {
                let bytes = stretch(source, &table.lines, index)?;
                let mut room = vec![vec![0.0; most_rows(&bytes, &table.plan)]; wanted.len()];
                let mut columns: Vec<Column> =
                    room.iter_mut().map(|room| Column::new(room)).collect();
                let rows = read_rows(&bytes, &table.plan, &places, &mut columns);
                Ok((room, rows))
            })
            .collect();
        for read in read {
            let (columns, rows) = read?;
            course.faults(source, table, &rows, sink)?;
            for (column, (_, position)) in columns.iter().zip(wanted) {
                sink.take(*position, &column[..rows.rows])?;
            }
            if let Some(cut) = course.advance(source, table, &rows)? {
                return Ok(Some(cut));
            }
        }
        start = end;
    }
    course.end(source, table, wanted.is_empty())
}

/// Reads whole columns, parsing stretches directly into their final place.
///
/// * `wanted`: file columns
pub fn read_whole_table(
    source: &Source,
    table: &Table,
    wanted: &[usize],
) -> Result<(Vec<Vec<f64>>, Option<CutOff>), Error> {
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
            let bytes = stretch_in(source, &table.lines, index, buffer)?;
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
            let bytes = stretch_in(source, &table.lines, index as u64, buffer)?;
            Ok(read_rows(bytes, &table.plan, &places, &mut rooms))
        })
        .collect::<Result<_, Error>>()?;

    // Close the gaps left by blank lines and comments.
    let (mut from, mut to) = (0, 0);
    let mut course = Course::new(table);
    let mut cut = None;
    for (rows, length) in read.iter().zip(&lengths) {
        course.faults(source, table, rows, &mut Strict)?;
        if from != to {
            columns
                .iter_mut()
                .for_each(|column| column.copy_within(from..from + rows.rows, to));
        }
        from += length;
        to += rows.rows;
        cut = course.advance(source, table, rows)?;
        if cut.is_some() {
            break;
        }
    }
    columns.iter_mut().for_each(|column| column.truncate(to));
    if cut.is_none() {
        course.end(source, table, wanted.is_empty())?;
    }
    Ok((columns, cut))
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
}

impl Course {
    fn new(table: &Table) -> Self {
        Self {
            line: table.first_line,
            rows: 0,
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

    /// Moves past a stretch; returns a truncated last line.
    fn advance(
        &mut self,
        source: &Source,
        table: &Table,
        rows: &Rows,
    ) -> Result<Option<CutOff>, Error> {
        self.rows += rows.rows;
        let Some(ragged) = rows.ragged else {
            self.line += rows.lines;
            return Ok(None);
        };
        let (line, found) = (self.line + ragged.line, ragged.found);
        let expected = table.plan.columns.len();
        if ragged.last && self.rows > 0 && found < expected {
            return Ok(Some(CutOff { line, found }));
        }
        let problem =
            format!("expected {expected} cells, as in the lines before, but found {found}");
        Err(malformed(source, line, problem))
    }

    fn end(
        &self,
        source: &Source,
        table: &Table,
        nothing_wanted: bool,
    ) -> Result<Option<CutOff>, Error> {
        match self.rows == 0 && !nothing_wanted {
            true => Err(malformed(
                source,
                table.first_line,
                "there are no rows of numbers".to_owned(),
            )),
            false => Ok(None),
        }
    }
}

fn malformed(source: &Source, line: u64, problem: String) -> Error {
    source.malformed(
        Place::Line(line),
        problem,
        "mend the line, or say with the settings separator, decimal and header_line how \
                 to read the file",
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
    "; leave the cell blank where there is no sample".to_owned()
}

/// Shortens a text for a message.
pub fn shortened(text: &str) -> String {
    match text.char_indices().nth(SHOWN) {
        Some((at, _)) => format!("{}…", &text[..at]),
        None => text.to_owned(),
    }
}
