//! The rows of a table in text, read on all cores in bounded memory.

use crate::error::{Error, Place};
use crate::reader::Sink;
use crate::source::Source;
use crate::text_lines::{Lines, stretch, stretches};
use crate::text_rows::{Fault, RowPlan, Rows, read_rows};
use rayon::prelude::*;

/// Stretches read at once for each thread.
const AHEAD: usize = 2;

/// Longest text of a cell in a message; characters.
const SHOWN: usize = 40;

/// A table within a file.
#[derive(Debug)]
pub struct Table {
    /// How its lines are read.
    pub plan: RowPlan,
    /// Where they are.
    pub lines: Lines,
    /// Line number of the first row, from 1.
    pub first_line: u64,
    /// Names of the columns, for messages.
    pub names: Vec<String>,
}

/// The last line, which was cut off.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CutOff {
    /// Its number, from 1.
    pub line: u64,
    /// Cells in it.
    pub found: usize,
}

/// Reads columns of a table.
///
/// * `wanted`: column of the file and position for the sink
///
/// Returns the last line where that was cut off; it is left out.
///
/// # Errors
/// The file cannot be read, a line has the wrong number of cells, there is no
/// row, or the sink returned an error.
pub fn read_table(
    source: &Source,
    table: &Table,
    wanted: &[(usize, usize)],
    sink: &mut dyn Sink,
) -> Result<Option<CutOff>, Error> {
    let mut places = vec![None; table.plan.columns.len()];
    for (place, (column, _)) in wanted.iter().enumerate() {
        places[*column] = Some(place);
    }
    let count = stretches(&table.lines);
    let batch = (AHEAD * rayon::current_num_threads()) as u64;
    let mut line = table.first_line;
    let mut rows_before = 0_usize;
    let mut start = 0;
    while start < count {
        let end = (start + batch).min(count);
        let read: Vec<Result<Rows, Error>> = (start..end)
            .into_par_iter()
            .map(|index| {
                let bytes = stretch(source, &table.lines, index)?;
                Ok(read_rows(&bytes, &table.plan, &places))
            })
            .collect();
        for rows in read {
            let rows = rows?;
            for fault in &rows.faults {
                sink.fault(fault_error(source, table, fault, line))?;
            }
            for (column, (_, position)) in rows.columns.iter().zip(wanted) {
                sink.take(*position, column)?;
            }
            rows_before += rows.columns.first().map_or(0, Vec::len);
            if let Some(ragged) = rows.ragged {
                let line = line + ragged.line;
                let expected = table.plan.columns.len();
                if ragged.last && rows_before > 0 && ragged.found < expected {
                    let found = ragged.found;
                    return Ok(Some(CutOff { line, found }));
                }
                let found = ragged.found;
                let problem =
                    format!("expected {expected} cells, as in the lines before, and found {found}");
                return Err(malformed(source, line, problem));
            }
            line += rows.lines;
        }
        start = end;
    }
    if rows_before == 0 && !wanted.is_empty() {
        let problem = "there are no rows of numbers".to_owned();
        return Err(malformed(source, table.first_line, problem));
    }
    Ok(None)
}

fn malformed(source: &Source, line: u64, problem: String) -> Error {
    Error::Malformed {
        path: source.path().to_path_buf(),
        place: Place::Line(line),
        problem,
        advice: "mend the line, or say with the settings separator, decimal and header_line how \
                 to read the file"
            .to_owned(),
    }
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

/// A text for a message, not too long.
#[must_use]
pub fn shortened(text: &str) -> String {
    match text.char_indices().nth(SHOWN) {
        Some((at, _)) => format!("{}…", &text[..at]),
        None => text.to_owned(),
    }
}
