//! Points and commas that may stand before decimals or between groups of three digits.

use crate::text::number::{Marks, bare, number, without_groups};
use crate::text::rows::{ColumnKind, Separator};
use std::collections::BTreeSet;

/// The decimal mark of rows that can be read with either: the mark that they have,
/// unless what follows it looks like groups of digits.
pub fn likelier_decimal<'a>(rows: impl Iterator<Item = &'a [&'a str]>, separator: Separator) -> u8 {
    let mut seen = [false; 2];
    let (mut whole, mut marked) = (BTreeSet::new(), BTreeSet::new());
    for cells in rows {
        for (column, cell) in cells.iter().map(|cell| bare(cell)).enumerate() {
            let digits = cell.trim_start_matches(['+', '-']);
            if !digits.starts_with(|c: char| c.is_ascii_digit()) {
                continue;
            }
            let integer = digits.bytes().all(|b| b.is_ascii_digit());
            if integer && digits.len() <= 3 && !digits.starts_with('0') {
                whole.insert(column);
            }
            for (seen, mark) in seen.iter_mut().zip(['.', ',']) {
                if digits.contains(mark) {
                    *seen = true;
                    marked.insert(column);
                }
            }
        }
    }
    // "999" beside "1,234" in one column: decimals would stand behind both.
    let grouped = marked.intersection(&whole).next().is_some();
    match (seen, separator) {
        ([true, true], Separator::Mark(b';')) => b',',
        ([false, true], _) if !grouped => b',',
        ([true, false], _) if grouped => b',',
        _ => b'.',
    }
}

/// A mark of which no cell shows whether decimals follow it: what was assumed, and how to
/// settle it.
///
/// * `rows`: lines, counted from 1, with their cells
pub fn doubtful_mark<'a>(
    rows: impl Iterator<Item = (usize, &'a [&'a str])>,
    decimal: u8,
    kinds: &[ColumnKind],
) -> Option<String> {
    let other = if decimal == b'.' { b',' } else { b'.' };
    let groups = |cell: &str, mark: u8, decimal: u8| {
        without_groups(cell, char::from(mark), char::from(decimal)).is_some()
    };
    let (mut decimals_shown, mut groups_shown) = (false, false);
    let (mut as_decimals, mut as_groups) = (None, None);
    for (line, cells) in rows {
        let numbers = cells.iter().zip(kinds);
        let numbers = numbers.filter(|(_, kind)| **kind == ColumnKind::Numbers);
        for cell in numbers.map(|(cell, _)| bare(cell)) {
            let marks = cell.bytes().filter(|b| matches!(b, b'.' | b','));
            match marks.count() {
                0 => {}
                // Decimals once more, or no number.
                1 if decimals_shown && cell.contains(char::from(decimal)) => {}
                1 if number(cell, Marks::decimal(decimal)).is_some() => {
                    match groups(cell, decimal, other) {
                        true => as_decimals = as_decimals.or(Some((line, cell.to_owned()))),
                        false => decimals_shown = true,
                    }
                }
                1 if groups(cell, other, decimal) => {
                    as_groups = as_groups.or(Some((line, cell.to_owned())));
                }
                1 => {}
                _ => groups_shown = true,
            }
        }
    }
    if groups_shown {
        return None;
    }
    let name = |byte| if byte == b',' { "comma" } else { "point" };
    let as_decimals = as_decimals.filter(|_| !decimals_shown);
    let ((line, cell), mark, rest, taken) = match (as_groups, as_decimals) {
        (Some(found), _) => (
            found,
            name(other),
            name(decimal),
            "between groups of digits",
        ),
        (None, Some(found)) => (found, name(decimal), name(other), "before decimals"),
        (None, None) => return None,
    };
    Some(format!(
        "\"{cell}\" in line {line}: the {mark} may stand before decimals or between groups of \
         three digits; it is taken to stand {taken}. Say which: decimal = \"{mark}\"; or decimal = \
         \"{rest}\" and thousands = \"{mark}\" (in [files] of campaign.toml, or as flags of inspect)"
    ))
}
