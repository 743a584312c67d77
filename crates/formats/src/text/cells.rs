//! Splits lines into cells, to detect the dialect of a table.

use crate::text::rows::Separator;
use std::ops::Range;

/// The cells of lines under one separator.
pub struct Cells<'a> {
    pub separator: Separator,
    /// Those of all lines, one after the other.
    pub all: Vec<&'a str>,
    /// Index of the first one of each line, and their number.
    starts: Vec<usize>,
}

impl<'a> Cells<'a> {
    pub fn new(lines: &[&'a str], separator: Separator) -> Self {
        let (mut all, mut starts) = (Vec::with_capacity(lines.len()), vec![0]);
        for line in lines {
            push_cells(line, separator, &mut all);
            starts.push(all.len());
        }
        Self {
            separator,
            all,
            starts,
        }
    }

    /// Cells of a line.
    pub fn line(&self, at: usize) -> &[&'a str] {
        &self.all[self.starts[at]..self.starts[at + 1]]
    }

    /// Where the cells of a line are in `all`, if there is one per column, or one blank cell
    /// more.
    pub fn place(&self, at: usize, count: usize) -> Option<Range<usize>> {
        let length = row_length(self.line(at), count)?;
        Some(self.starts[at]..self.starts[at] + length)
    }

    /// The cells of a line with one per column, or one blank cell more.
    pub fn row(&self, at: usize, count: usize) -> Option<&[&'a str]> {
        Some(&self.all[self.place(at, count)?])
    }
}

/// Cells of a line.
pub fn cells(line: &str, separator: Separator) -> Vec<&str> {
    let mut cells = Vec::new();
    push_cells(line, separator, &mut cells);
    cells
}

/// The cells of a line with one per column, or one blank cell more.
pub fn row(line: &str, separator: Separator, count: usize) -> Option<Vec<&str>> {
    let mut cells = cells(line, separator);
    let length = row_length(&cells, count)?;
    cells.truncate(length);
    Some(cells)
}

fn row_length(cells: &[&str], count: usize) -> Option<usize> {
    let one_more = cells.len() == count + 1 && cells[count].trim().is_empty();
    (one_more || cells.len() == count).then_some(count)
}

fn push_cells<'a>(line: &'a str, separator: Separator, cells: &mut Vec<&'a str>) {
    let mark = match separator {
        Separator::Blanks => return cells.extend(line.split_whitespace()),
        Separator::Mark(mark) => mark,
    };
    if !mark.is_ascii() || line.as_bytes().contains(&b'"') {
        let mut quoted = false;
        return cells.extend(line.split(|c| {
            quoted ^= c == '"';
            c == char::from(mark) && !quoted
        }));
    }
    let mut start = 0;
    for at in memchr::memchr_iter(mark, line.as_bytes()) {
        cells.push(&line[start..at]);
        start = at + 1;
    }
    cells.push(&line[start..]);
}
