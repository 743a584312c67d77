//! Splits lines into cells, to detect the dialect of a table.

use crate::text::rows::Separator;

/// Cells of a line.
pub fn cells(line: &str, separator: Separator) -> Vec<&str> {
    match separator {
        Separator::Blanks => line.split_whitespace().collect(),
        Separator::Mark(mark) => {
            let mark = char::from(mark);
            let mut cells = Vec::new();
            let (mut start, mut quoted) = (0, false);
            for (at, c) in line.char_indices() {
                quoted ^= c == '"';
                if c == mark && !quoted {
                    cells.push(&line[start..at]);
                    start = at + c.len_utf8();
                }
            }
            cells.push(&line[start..]);
            cells
        }
    }
}

/// The cells of a line with one per column, or one blank cell more.
pub fn row(line: &str, separator: Separator, count: usize) -> Option<Vec<&str>> {
    let mut cells = cells(line, separator);
    if cells.len() == count + 1 && cells[count].trim().is_empty() {
        cells.pop();
    }
    (cells.len() == count).then_some(cells)
}
