//! Parses lines of cells into columns of numbers.

use crate::reader::MISSING;
use crate::text::date::{Moment, moment};
use crate::text::encoding::Encoding;
use crate::text::missing::{MissingCells, MissingWords, add_missing};
use crate::text::number::{Cell, Marks, bare, cell, leading_number};

/// Separator between cells.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Separator {
    /// One character.
    Mark(u8),
    /// Any number of spaces and tabs.
    Blanks,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum ColumnKind {
    Numbers,
    /// Dates or times, converted to seconds since this one.
    Moments(Moment),
    /// Text, which is skipped.
    Text,
}

/// How to parse lines.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct RowPlan {
    pub separator: Separator,
    pub marks: Marks,
    pub encoding: Encoding,
    pub newline: u8,
    /// Prefixes of comment lines.
    pub comments: Vec<String>,
    pub columns: Vec<ColumnKind>,
    pub missing: MissingWords,
    /// Whether the last cells of a line may be missing.
    pub short_rows: bool,
}

impl RowPlan {
    /// Whether a number at the beginning of a cell is its sample: no number stands for a
    /// missing one, and no separator can be taken for a decimal mark.
    fn is_plain(&self) -> bool {
        self.missing.keeps_numbers() && self.separator != Separator::Mark(self.marks.decimal)
    }
}

/// Preallocated space for the samples of a column.
#[derive(Debug)]
pub(crate) struct Column<'a> {
    room: &'a mut [f64],
    length: usize,
}

impl<'a> Column<'a> {
    pub(crate) fn new(room: &'a mut [f64]) -> Self {
        Self { room, length: 0 }
    }

    #[inline]
    fn push(&mut self, value: f64) {
        if let Some(place) = self.room.get_mut(self.length) {
            *place = value;
            self.length += 1;
        }
    }
}

/// Result of parsing a stretch, besides the samples.
#[derive(Debug, Default)]
pub(crate) struct Rows {
    /// Number of rows, and so of samples per column; blank cells are NaN.
    pub rows: usize,
    /// Number of lines, including those that are not rows.
    pub lines: u64,
    /// Cells that are not numbers, in order.
    pub faults: Vec<Fault>,
    /// Cells taken as missing samples; lines within the stretch, from 0.
    pub missing: Vec<MissingCells>,
    /// A line with the wrong number of cells; nothing after it is read.
    pub ragged: Option<Ragged>,
}

/// A cell that is not a number.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Fault {
    /// Line within the stretch, from 0.
    pub line: u64,
    pub column: usize,
    pub text: String,
}

/// A line with the wrong number of cells.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Ragged {
    /// Line within the stretch, from 0.
    pub line: u64,
    /// Number of cells.
    pub found: usize,
    /// Whether it is the last line and has no line break.
    pub last: bool,
}

/// Upper bound on the rows of a stretch, from its lines and bytes.
pub(crate) fn most_rows(bytes: &[u8], plan: &RowPlan) -> usize {
    let ends = memchr::memchr_iter(plan.newline, bytes).count();
    let lines = ends + usize::from(bytes.last().is_some_and(|last| *last != plan.newline));
    let shortest = match (plan.separator, plan.short_rows) {
        // The separators and the line break.
        (Separator::Mark(_), false) => plan.columns.len(),
        (Separator::Blanks, false) => 2 * plan.columns.len(),
        (_, true) => 1,
    };
    lines.min(bytes.len() / shortest.max(1) + 1)
}

/// Parses the lines of a stretch.
///
/// * `places`: for each file column, its index in `columns`
/// * `columns`: output, with space for [`most_rows`] samples each
pub(crate) fn read_rows(
    bytes: &[u8],
    plan: &RowPlan,
    places: &[Option<usize>],
    columns: &mut [Column],
) -> Rows {
    let mut rows = Rows::default();
    let (mut at, mut read) = (0, 0);
    while at < bytes.len() {
        if let Separator::Mark(mark) = plan.separator
            && plan.is_plain()
            && let Some(end) = bare_row(bytes, at, mark, plan, places, columns)
        {
            read += 1;
            rows.lines += 1;
            at = end;
            continue;
        }
        columns.iter_mut().for_each(|column| column.length = read);
        let end = memchr::memchr(plan.newline, &bytes[at..]).map_or(bytes.len(), |n| at + n);
        let mut line = &bytes[at..end];
        if line.last() == Some(&b'\r') {
            line = &line[..line.len() - 1];
        }
        if !passed_over(line, plan) {
            let found = match plan.separator {
                Separator::Mark(mark) => marked_row(line, mark, plan, places, columns, &mut rows),
                Separator::Blanks => blank_row(line, plan, places, columns, &mut rows),
            };
            if found != plan.columns.len() {
                rows.ragged = Some(Ragged {
                    line: rows.lines,
                    found,
                    last: end == bytes.len(),
                });
                break;
            }
            read += 1;
        }
        rows.lines += 1;
        at = end + 1;
    }
    rows.rows = read;
    if let Some(ragged) = rows.ragged {
        rows.faults.retain(|fault| fault.line < ragged.line);
        rows.missing.retain(|cells| cells.line < ragged.line);
    }
    rows
}

/// Parses a line of plain numbers and blank cells and returns the start of the next;
/// `None` for any other line (columns may then have surplus samples).
#[inline]
fn bare_row(
    bytes: &[u8],
    mut at: usize,
    mark: u8,
    plan: &RowPlan,
    places: &[Option<usize>],
    columns: &mut [Column],
) -> Option<usize> {
    let last = places.len() - 1;
    if is_comment(&bytes[at..], plan) {
        return None;
    }
    for (column, place) in places.iter().enumerate() {
        let Some(place) = *place else {
            // A column that was not requested.
            let cell = &bytes[at..];
            let end = cell.iter().position(|b| *b == mark || *b == plan.newline)?;
            if cell[..end].contains(&b'"') {
                return None;
            }
            at += end;
            at = match (bytes[at] == mark, column == last) {
                (true, false) => at + 1,
                (false, true) => return Some(at + 1),
                _ => return None,
            };
            continue;
        };
        if plan.columns[column] != ColumnKind::Numbers {
            return None;
        }
        let value = match leading_number(&bytes[at..], plan.marks.decimal) {
            Some((value, used)) => {
                at += used;
                value
            }
            // A blank cell, but not a blank line.
            None if last > 0 && (column > 0 || bytes.get(at) == Some(&mark)) => f64::NAN,
            None => return None,
        };
        let next = *bytes.get(at)?;
        columns[place].push(value);
        if column < last {
            if next != mark {
                return None;
            }
            at += 1;
        } else if next == plan.newline {
            return Some(at + 1);
        } else if next == b'\r' && bytes.get(at + 1) == Some(&plan.newline) {
            return Some(at + 2);
        }
    }
    None
}

/// Whether a line is blank or a comment.
fn passed_over(line: &[u8], plan: &RowPlan) -> bool {
    let Some(first) = line.iter().position(|byte| !byte.is_ascii_whitespace()) else {
        // A line of nothing but tabs is a row of blank cells.
        return !(plan.separator == Separator::Mark(b'\t') && line.contains(&b'\t'));
    };
    is_comment(&line[first..], plan)
}

/// Whether a comment begins here, possibly after blanks.
#[inline]
fn is_comment(bytes: &[u8], plan: &RowPlan) -> bool {
    let begins = |mark: &String| {
        let first = bytes.iter().position(|byte| !matches!(byte, b' ' | b'\t'));
        first.is_some_and(|first| bytes[first..].starts_with(mark.as_bytes()))
    };
    // Most files have none.
    !plan.comments.is_empty() && plan.comments.iter().any(begins)
}

/// Parses a line of cells with separators; returns the number of cells.
fn marked_row(
    line: &[u8],
    mark: u8,
    plan: &RowPlan,
    places: &[Option<usize>],
    columns: &mut [Column],
    rows: &mut Rows,
) -> usize {
    let mut at = 0;
    let mut column = 0;
    loop {
        // A trailing separator is not a cell.
        if at == line.len() && column > 0 && column == plan.columns.len() {
            return column;
        }
        let place = places.get(column).copied().flatten();
        // The usual cell: a plain number up to the separator or the end of the line.
        if let Some(place) = place
            && plan.columns[column] == ColumnKind::Numbers
            && plan.is_plain()
        {
            let start = at + blanks(&line[at..]);
            if let Some((value, used)) = leading_number(&line[start..], plan.marks.decimal) {
                let end = start + used;
                if end == line.len() {
                    columns[place].push(value);
                    return finish(column + 1, plan, places, columns);
                }
                if line[end] == mark {
                    columns[place].push(value);
                    at = end + 1;
                    column += 1;
                    continue;
                }
            }
        }
        let end = cell_end(line, at, mark);
        if let Some(place) = place {
            slow_cell(&line[at..end], column, &mut columns[place], plan, rows);
        }
        column += 1;
        if end == line.len() {
            return finish(column, plan, places, columns);
        }
        at = end + 1;
    }
}

fn blanks(bytes: &[u8]) -> usize {
    bytes.iter().take_while(|byte| **byte == b' ').count()
}

/// End of the cell that begins at `at`, ignoring separators in quotes.
fn cell_end(line: &[u8], at: usize, mark: u8) -> usize {
    let mut quoted = false;
    for (offset, &byte) in line[at..].iter().enumerate() {
        quoted ^= byte == b'"';
        if byte == mark && !quoted {
            return at + offset;
        }
    }
    line.len()
}

/// Fills in the cells missing from a short line.
fn finish(found: usize, plan: &RowPlan, places: &[Option<usize>], columns: &mut [Column]) -> usize {
    if found >= plan.columns.len() || !plan.short_rows {
        return found;
    }
    for place in places[found..].iter().flatten() {
        columns[*place].push(f64::NAN);
    }
    plan.columns.len()
}

/// Parses a line of cells separated by blanks; returns the number of cells.
fn blank_row(
    line: &[u8],
    plan: &RowPlan,
    places: &[Option<usize>],
    columns: &mut [Column],
    rows: &mut Rows,
) -> usize {
    let cells = line
        .split(u8::is_ascii_whitespace)
        .filter(|cell| !cell.is_empty());
    let mut column = 0;
    for cell in cells {
        if let Some(place) = places.get(column).copied().flatten() {
            let number = leading_number(cell, plan.marks.decimal);
            match (plan.columns[column], number) {
                (ColumnKind::Numbers, Some((value, used)))
                    if used == cell.len() && plan.is_plain() =>
                {
                    columns[place].push(value);
                }
                _ => slow_cell(cell, column, &mut columns[place], plan, rows),
            }
        }
        column += 1;
    }
    finish(column, plan, places, columns)
}

/// Slow path: quotes, blanks, thousands separators, times, or an empty cell.
fn slow_cell(bytes: &[u8], column: usize, out: &mut Column, plan: &RowPlan, rows: &mut Rows) {
    let text = match plan.encoding {
        Encoding::Windows1252 => plan.encoding.decode(bytes),
        // UTF-16 has been converted to UTF-8.
        _ => Encoding::Utf8.decode(bytes),
    };
    let text = bare(&text);
    let found = match plan.columns[column] {
        ColumnKind::Numbers => cell(text, plan.marks),
        ColumnKind::Moments(start) => match moment(text) {
            Some(moment) => Cell::Number(moment.since(start)),
            None if text.is_empty() => Cell::Blank,
            None => Cell::Other,
        },
        ColumnKind::Text => Cell::Blank,
    };
    let missing = match found {
        Cell::Blank => false,
        Cell::Number(value) => plan.missing.has_number(value),
        Cell::Other => plan.missing.has(text),
    };
    out.push(match found {
        _ if missing => MISSING,
        Cell::Number(value) => value,
        Cell::Blank | Cell::Other => f64::NAN,
    });
    if missing {
        let cells = MissingCells {
            column,
            count: 1,
            line: rows.lines,
            word: text.to_owned(),
        };
        add_missing(&mut rows.missing, cells);
    } else if found == Cell::Other {
        rows.faults.push(Fault {
            line: rows.lines,
            column,
            text: text.to_owned(),
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plan(separator: Separator, columns: usize) -> RowPlan {
        RowPlan {
            separator,
            marks: Marks::decimal(b'.'),
            encoding: Encoding::Utf8,
            newline: b'\n',
            comments: vec!["#".to_owned()],
            columns: vec![ColumnKind::Numbers; columns],
            missing: MissingWords::default(),
            short_rows: false,
        }
    }

    fn read(text: &[u8], plan: &RowPlan, places: &[Option<usize>]) -> (Vec<Vec<f64>>, Rows) {
        let most = most_rows(text, plan);
        let mut room = vec![vec![0.0; most]; places.iter().flatten().count()];
        let mut columns: Vec<Column> = room.iter_mut().map(|room| Column::new(room)).collect();
        let rows = read_rows(text, plan, places, &mut columns);
        room.iter_mut()
            .for_each(|column| column.truncate(rows.rows));
        (room, rows)
    }

    #[test]
    fn closed_form_cells() {
        let plan = plan(Separator::Mark(b','), 3);
        let text = "1, 2.5 ,x\r\n# no\n\n,\"4\",5,\n7,8,9";
        let (columns, rows) = read(text.as_bytes(), &plan, &[Some(1), None, Some(0)]);
        assert!(columns[0][0].is_nan() && columns[1][1].is_nan());
        assert_eq!(columns[0][1..], [5.0, 9.0]);
        assert_eq!((columns[1][0], columns[1][2]), (1.0, 7.0));
        let fault = Fault {
            line: 0,
            column: 2,
            text: "x".to_owned(),
        };
        assert_eq!(
            (rows.faults, rows.lines, rows.ragged),
            (vec![fault], 5, None)
        );
    }

    #[test]
    fn closed_form_comments_are_no_rows_whatever_is_read() {
        let plan = plan(Separator::Mark(b','), 2);
        let text = b"1,2\n# 3,4\n #,5\n6,7\n";
        for places in [[Some(0), Some(1)], [None, Some(0)], [Some(0), None]] {
            assert_eq!(read(text, &plan, &places).1.rows, 2, "{places:?}");
        }
    }

    #[test]
    fn conserves_memory_whatever_the_lines() {
        let plan = plan(Separator::Mark(b','), 1000);
        // Blank lines are not rows; space for as many would take 8 GB.
        assert!(most_rows(&vec![b'\n'; 1 << 20], &plan) <= 1050);
        assert_eq!(most_rows(&vec![b','; 2000], &plan), 1);
    }

    #[test]
    fn rejects_ragged_lines_and_keeps_what_was_before() {
        let plan = plan(Separator::Mark(b','), 3);
        for (text, found, last) in [
            ("1,2,3\n4,5\n6,7,8\n", 2, false),
            ("1,2,3\n4,5,6,7\n", 4, false),
            ("1,2,3\n4", 1, true),
        ] {
            let (columns, rows) = read(text.as_bytes(), &plan, &[Some(0), Some(1), Some(2)]);
            let ragged = Ragged {
                line: 1,
                found,
                last,
            };
            assert_eq!(rows.ragged, Some(ragged), "{text}");
            assert_eq!(columns, [[1.0], [2.0], [3.0]], "{text}");
        }
    }

    #[test]
    fn closed_form_blanks_and_short_rows() {
        let mut plan = plan(Separator::Blanks, 2);
        let (columns, _) = read(b" 1   2\n\t3\t4 \n", &plan, &[Some(0), Some(1)]);
        assert_eq!(columns, [[1.0, 3.0], [2.0, 4.0]]);
        plan.separator = Separator::Mark(b'\t');
        plan.short_rows = true;
        let (columns, rows) = read(b"1\t2\n3\n", &plan, &[Some(0), Some(1)]);
        assert_eq!(columns[0], [1.0, 3.0]);
        assert!(columns[1][1].is_nan() && rows.ragged.is_none());
    }
}
