//! Detects the dialect of a text table from its first lines.

use crate::contents::Note;
use crate::text::cells::{cells, row};
use crate::text::decimal::{doubtful_mark, likelier_decimal};
use crate::text::header::name_columns;
use crate::text::look::{Look, Notation, THOUSANDS};
use crate::text::missing::MissingWords;
use crate::text::number::{Marks, bare, leading_number, number, rises_evenly, without_groups};
use crate::text::options::{Dialect, TextOptions};
use crate::text::rows::{ColumnKind, Separator};
use std::collections::{BTreeMap, BTreeSet};

/// Usual comment prefixes.
const COMMENTS: [&str; 3] = ["#", "%", "//"];

/// Candidate separators, the likeliest first.
const SEPARATORS: [Separator; 5] = [
    Separator::Mark(b'\t'),
    Separator::Mark(b';'),
    Separator::Mark(b','),
    Separator::Mark(b'|'),
    Separator::Blanks,
];

/// Detects the dialect from the first lines of a file.
///
/// On failure, the index of a line that is not a row of numbers.
pub fn find_dialect(lines: &[&str], options: &TextOptions) -> Result<Dialect, usize> {
    let comments = comment_marks(lines, options);
    let missing = MissingWords::new(&options.missing);
    let data: Vec<usize> = (0..lines.len())
        .filter(|&at| !lines[at].trim().is_empty() && !is_comment(lines[at], &comments))
        .collect();
    let nothing = || data.first().copied().unwrap_or(0);
    let candidate = best_candidate(lines, &data, &missing, options).ok_or_else(nothing)?;
    let Candidate {
        separator,
        mut marks,
        count,
        ..
    } = candidate;
    marks.thousands = options
        .thousands
        .or_else(|| thousands(lines, &data, &candidate, &missing));
    let notation = Notation {
        marks,
        missing: &missing,
    };

    let rows: Vec<usize> = data
        .iter()
        .copied()
        .filter(|&at| row(lines[at], separator, count).is_some())
        .collect();
    let below: Vec<usize> = rows
        .iter()
        .copied()
        .filter(|&at| at >= candidate.first)
        .collect();
    let kinds = column_kinds(lines, &below, separator, count, notation);
    let numeric = |at: usize| {
        row(lines[at], separator, count).is_some_and(|cells| is_row(&cells, &kinds, notation))
    };
    let first_row = match options.header_line {
        // Below the header line named by the user and any row of units.
        Some(line) => rows
            .iter()
            .copied()
            .find(|&at| at as u64 >= line && numeric(at)),
        None => rows.iter().copied().find(|&at| numeric(at)),
    };
    let first_row = first_row.ok_or_else(nothing)?;
    // Prose has numbers too, but its lines are not rows.
    let below: Vec<usize> = data.iter().copied().filter(|&at| at >= first_row).collect();
    let fitting = below.iter().filter(|&&at| numeric(at)).count();
    if 2 * fitting < below.len() {
        return Err(nothing());
    }
    let mut dialect = Dialect {
        separator,
        marks,
        comments,
        names: vec![String::new(); count],
        units: vec![None; count],
        kinds: first_moments(lines, first_row, separator, count, notation, kinds),
        first_row,
        rising_first: false,
        preamble: Vec::new(),
        notes: Vec::new(),
    };
    name_columns(&mut dialect, lines, &data, options);
    let unnamed = dialect.names.iter().all(String::is_empty);
    dialect.rising_first = unnamed && count > 1 && first_rises(lines, &rows, &dialect);
    if options.decimal.is_none() && options.thousands.is_none() {
        let below = rows.iter().filter(|&&at| at >= first_row);
        let below = below.filter_map(|&at| {
            Some((
                at + 1 + options.lines_above as usize,
                row(lines[at], separator, count)?,
            ))
        });
        let other = if marks.decimal == b'.' { b',' } else { b'.' };
        if may_be_decimal(lines, &data, separator, other) {
            let doubt = doubtful_mark(below, marks.decimal, &dialect.kinds);
            dialect.notes.extend(doubt.map(Note::DecimalOrThousands));
        }
    }
    Ok(dialect)
}

/// Whether the first column rises like a column of times.
fn first_rises(lines: &[&str], rows: &[usize], dialect: &Dialect) -> bool {
    let first = |at: usize| {
        let cells = row(lines[at], dialect.separator, dialect.names.len())?;
        number(cells[0], dialect.marks)
    };
    let values: Option<Vec<f64>> = rows.iter().map(|&at| first(at)).collect();
    values.is_some_and(|values| rises_evenly(&values))
}

fn comment_marks(lines: &[&str], options: &TextOptions) -> Vec<String> {
    if let Some(mark) = &options.comment {
        return vec![mark.clone()];
    }
    let used = |mark: &&str| {
        lines
            .iter()
            .any(|line| line.trim_start().starts_with(*mark))
    };
    COMMENTS
        .iter()
        .copied()
        .filter(|mark| used(mark))
        .map(str::to_owned)
        .collect()
}

fn is_comment(line: &str, comments: &[String]) -> bool {
    comments
        .iter()
        .any(|mark| line.trim_start().starts_with(mark.as_str()))
}

fn is_row(cells: &[&str], kinds: &[ColumnKind], notation: Notation) -> bool {
    let mut numbers = 0;
    for (cell, kind) in cells.iter().zip(kinds) {
        match (kind, notation.look(cell)) {
            (ColumnKind::Text, _) | (_, Look::Blank) => {}
            (_, Look::Text) => return false,
            _ => numbers += 1,
        }
    }
    numbers > 0
}

/// A separator and decimal mark, and how well they fit the lines.
#[derive(Clone, Copy, Debug)]
struct Candidate {
    separator: Separator,
    marks: Marks,
    count: usize,
    /// First line that looks like a row of numbers.
    first: usize,
    score: f64,
}

fn best_candidate(
    lines: &[&str],
    data: &[usize],
    missing: &MissingWords,
    options: &TextOptions,
) -> Option<Candidate> {
    let separators = SEPARATORS
        .into_iter()
        .filter(|separator| options.separator.is_none_or(|wanted| wanted == *separator))
        .chain(options.separator.filter(|s| !SEPARATORS.contains(s)));
    let mut best: Option<Candidate> = None;
    let mut equal = false;
    for separator in separators {
        for decimal in [b'.', b','] {
            let other = options.decimal.is_some_and(|d| d != char::from(decimal));
            if other || !may_be_decimal(lines, data, separator, decimal) {
                continue;
            }
            let notation = Notation {
                marks: Marks::decimal(decimal),
                missing,
            };
            let Some(found) = candidate(lines, data, separator, notation) else {
                continue;
            };
            match &best {
                Some(best) if found.score == best.score && found.separator == best.separator => {
                    equal = true;
                }
                Some(best) if found.score <= best.score => {}
                _ => (best, equal) = (Some(found), false),
            }
        }
    }
    let mut best = best.filter(|best| best.score > 0.0)?;
    if equal {
        let data = data.iter().filter(|&&at| at >= best.first);
        let rows = data.filter_map(|&at| row(lines[at], best.separator, best.count));
        best.marks.decimal = likelier_decimal(rows, best.separator);
    }
    Some(best)
}

/// Whether a mark can stand before decimals: where it separates cells, only in quoted ones.
fn may_be_decimal(lines: &[&str], data: &[usize], separator: Separator, mark: u8) -> bool {
    let quoted = |&at: &usize| {
        let cells = cells(lines[at], separator);
        cells.iter().any(|cell| cell.contains(char::from(mark)))
    };
    separator != Separator::Mark(mark) || data.iter().any(quoted)
}

fn candidate(
    lines: &[&str],
    data: &[usize],
    separator: Separator,
    notation: Notation,
) -> Option<Candidate> {
    let count = usual_count(lines, data, separator, notation.marks.decimal)?;
    let tallies: Vec<(usize, f64, f64)> = data
        .iter()
        .filter_map(|&at| {
            let cells = row(lines[at], separator, count)?;
            let (numbers, texts) = tally(&cells, notation, separator);
            Some((at, numbers, texts))
        })
        .collect();
    // Rows begin where numbers prevail, though a table may be mostly text.
    let first = tallies
        .iter()
        .find(|(_, numbers, texts)| numbers > texts)
        .or_else(|| tallies.iter().find(|(_, numbers, _)| *numbers > 0.0))?
        .0;
    let below = tallies.iter().filter(|(at, ..)| *at >= first);
    let (numbers, texts) = below.fold((0.0, 0.0), |sum, t| (sum.0 + t.1, sum.1 + t.2));
    // A header with a different number of names counts against the separator.
    let above = data.iter().rev().find(|&&at| at < first);
    let fits = above.is_none_or(|&at| row(lines[at], separator, count).is_some());
    let share = numbers / (numbers + texts);
    Some(Candidate {
        separator,
        marks: notation.marks,
        count,
        first,
        score: numbers * share.powi(3) * if fits { 1.0 } else { 0.3 },
    })
}

/// Counts cells that are numbers or times, and cells that are text.
fn tally(cells: &[&str], notation: Notation, separator: Separator) -> (f64, f64) {
    let (mut numbers, mut texts) = (0.0, 0.0);
    for cell in cells {
        match notation.grouped_look(cell, separator) {
            Look::Blank => {}
            Look::Text => texts += 1.0,
            Look::Number | Look::Moment(_) => numbers += 1.0,
        }
    }
    (numbers, texts)
}

/// The most common number of cells in lines that contain a number.
fn usual_count(lines: &[&str], data: &[usize], separator: Separator, decimal: u8) -> Option<usize> {
    let rows: Vec<Vec<&str>> = data.iter().map(|&at| cells(lines[at], separator)).collect();
    let ends_blank = |row: &[&str]| row.last().is_some_and(|cell| cell.trim().is_empty());
    // A blank last cell counts only if some line of that width has text in it;
    // otherwise it is just a trailing separator.
    let filled: BTreeSet<usize> = rows
        .iter()
        .filter(|row| !ends_blank(row))
        .map(Vec::len)
        .collect();
    let mut counts = BTreeMap::new();
    for row in &rows {
        let number = |cell: &&str| leading_number(bare(cell).as_bytes(), decimal).is_some();
        if !row.iter().any(number) {
            continue;
        }
        let one_blank = row.len() > 1 && ends_blank(row) && !ends_blank(&row[..row.len() - 1]);
        let count = match one_blank && !filled.contains(&row.len()) {
            true => row.len() - 1,
            false => row.len(),
        };
        *counts.entry(count).or_insert(0_usize) += 1;
    }
    let (count, _) = counts
        .into_iter()
        .max_by_key(|(count, lines)| (*lines, *count))?;
    Some(count)
}

/// The thousands separator, if cells use one.
fn thousands(
    lines: &[&str],
    data: &[usize],
    candidate: &Candidate,
    missing: &MissingWords,
) -> Option<char> {
    let notation = Notation {
        marks: candidate.marks,
        missing,
    };
    let decimal = char::from(candidate.marks.decimal);
    // The cell separator itself may group digits within quotes.
    let usable = |mark: &char| *mark != decimal;
    THOUSANDS.into_iter().filter(usable).find(|&mark| {
        data.iter().any(|&at| {
            let row = row(lines[at], candidate.separator, candidate.count);
            row.is_some_and(|cells| {
                cells.iter().any(|cell| {
                    matches!(notation.look(cell), Look::Text)
                        && without_groups(bare(cell), mark, decimal).is_some()
                })
            })
        })
    })
}

/// Kind of each column, by majority of its cells.
fn column_kinds(
    lines: &[&str],
    rows: &[usize],
    separator: Separator,
    count: usize,
    notation: Notation,
) -> Vec<ColumnKind> {
    let mut tallies = vec![[0_usize; 3]; count];
    let mut starts = vec![None; count];
    for &at in rows {
        for (column, cell) in row(lines[at], separator, count)
            .unwrap_or_default()
            .iter()
            .enumerate()
        {
            match notation.look(cell) {
                Look::Blank => {}
                Look::Number => tallies[column][0] += 1,
                Look::Moment(moment) => {
                    starts[column].get_or_insert(moment);
                    tallies[column][1] += 1;
                }
                Look::Text => tallies[column][2] += 1,
            }
        }
    }
    tallies
        .iter()
        .zip(starts)
        .map(|([numbers, moments, texts], start)| match start {
            Some(start) if moments > numbers && moments >= texts => ColumnKind::Moments(start),
            _ if texts > numbers => ColumnKind::Text,
            _ => ColumnKind::Numbers,
        })
        .collect()
}

/// Times are relative to the first row.
fn first_moments(
    lines: &[&str],
    first_row: usize,
    separator: Separator,
    count: usize,
    notation: Notation,
    kinds: Vec<ColumnKind>,
) -> Vec<ColumnKind> {
    let cells = row(lines[first_row], separator, count).unwrap_or_default();
    let start = |column: usize| match notation.look(cells.get(column)?) {
        Look::Moment(moment) => Some(ColumnKind::Moments(moment)),
        _ => None,
    };
    kinds
        .into_iter()
        .enumerate()
        .map(|(column, kind)| match kind {
            ColumnKind::Moments(_) => start(column).unwrap_or(kind),
            kind => kind,
        })
        .collect()
}
