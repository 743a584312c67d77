//! Detects the dialect of a text table from its first lines.

use crate::contents::Note;
use crate::text::cells::{cells, row};
use crate::text::date::{Moment, moment};
use crate::text::header::name_columns;
use crate::text::number::{
    Cell, Marks, bare, cell, leading_number, number, rises_evenly, without_groups,
};
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

/// Candidate thousands separators.
const THOUSANDS: [char; 5] = ['.', ',', '\'', ' ', '\u{a0}'];

/// What a cell looks like with given marks.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Look {
    Blank,
    Number,
    Moment(Moment),
    Text,
}

fn look(text: &str, marks: Marks) -> Look {
    // Most text is recognised by its first character.
    let start = |c: char| c.is_ascii_digit() || matches!(c, '+' | '-' | '.' | ',' | '\u{2212}');
    let text = bare(text);
    if text.is_empty() {
        return Look::Blank;
    }
    if !text.starts_with(start) {
        return Look::Text;
    }
    match cell(text, marks) {
        Cell::Blank => Look::Blank,
        Cell::Number(_) => Look::Number,
        Cell::Other => moment(bare(text)).map_or(Look::Text, Look::Moment),
    }
}

/// Detects the dialect from the first lines of a file.
///
/// On failure, the index of a line that is not a row of numbers.
pub fn find_dialect(lines: &[&str], options: &TextOptions) -> Result<Dialect, usize> {
    let comments = comment_marks(lines, options);
    let data: Vec<usize> = (0..lines.len())
        .filter(|&at| !lines[at].trim().is_empty() && !is_comment(lines[at], &comments))
        .collect();
    let nothing = || data.first().copied().unwrap_or(0);
    let candidate = best_candidate(lines, &data, options).ok_or_else(nothing)?;
    let Candidate {
        separator,
        mut marks,
        count,
        ..
    } = candidate;
    marks.thousands = options
        .thousands
        .or_else(|| thousands(lines, &data, &candidate));

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
    let kinds = column_kinds(lines, &below, separator, count, marks);
    let numeric = |at: usize| {
        row(lines[at], separator, count).is_some_and(|cells| is_row(&cells, &kinds, marks))
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
        kinds: first_moments(lines, first_row, separator, count, marks, kinds),
        first_row,
        rising_first: false,
        preamble: Vec::new(),
        notes: Vec::new(),
    };
    name_columns(&mut dialect, lines, &data, options);
    let unnamed = dialect.names.iter().all(String::is_empty);
    dialect.rising_first = unnamed && count > 1 && first_rises(lines, &rows, &dialect);
    if candidate.ambiguous && options.decimal.is_none() {
        let (mark, other) = match marks.decimal {
            b',' => ("comma", "\",\" as thousands separator"),
            _ => ("point", "\".\" as thousands separator"),
        };
        dialect.notes.push(Note::Assumed(format!(
            "the decimal mark is taken to be a {mark}; if the file has {other}, say so with \
                 the settings decimal and thousands"
        )));
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

fn is_row(cells: &[&str], kinds: &[ColumnKind], marks: Marks) -> bool {
    let mut numbers = 0;
    for (cell, kind) in cells.iter().zip(kinds) {
        match (kind, look(cell, marks)) {
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
    /// Whether the other decimal mark fits equally well.
    ambiguous: bool,
}

fn best_candidate(lines: &[&str], data: &[usize], options: &TextOptions) -> Option<Candidate> {
    let separators = SEPARATORS
        .into_iter()
        .filter(|separator| options.separator.is_none_or(|wanted| wanted == *separator))
        .chain(options.separator.filter(|s| !SEPARATORS.contains(s)));
    let mut best: Option<Candidate> = None;
    for separator in separators {
        for decimal in [b'.', b','] {
            let other = options.decimal.is_some_and(|d| d != char::from(decimal));
            if other || separator == Separator::Mark(decimal) {
                continue;
            }
            let Some(found) = candidate(lines, data, separator, decimal) else {
                continue;
            };
            match &mut best {
                // Three digits after a mark are ambiguous; with semicolons between
                // cells, commas are decimal marks.
                Some(best) if found.score == best.score && found.separator == best.separator => {
                    let grouped = data.iter().any(|&at| lines[at].contains([',', '.']));
                    best.ambiguous = grouped && has_marks(lines, data, separator);
                }
                Some(best) if found.score <= best.score => {}
                best => *best = Some(found),
            }
        }
    }
    let mut best = best?;
    if best.ambiguous && best.separator == Separator::Mark(b';') {
        best.marks.decimal = b',';
    }
    (best.score > 0.0).then_some(best)
}

/// Whether any cell is a number with either decimal mark.
fn has_marks(lines: &[&str], data: &[usize], separator: Separator) -> bool {
    let either = |text: &str| {
        let number =
            |decimal| grouped_look(text, Marks::decimal(decimal), separator) == Look::Number;
        text.contains([',', '.']) && number(b'.') && number(b',')
    };
    data.iter()
        .any(|&at| cells(lines[at], separator).iter().any(|c| either(c)))
}

fn candidate(
    lines: &[&str],
    data: &[usize],
    separator: Separator,
    decimal: u8,
) -> Option<Candidate> {
    let count = usual_count(lines, data, separator, decimal)?;
    let marks = Marks::decimal(decimal);
    let tallies: Vec<(usize, f64, f64)> = data
        .iter()
        .filter_map(|&at| {
            let cells = row(lines[at], separator, count)?;
            let (numbers, texts) = tally(&cells, marks, separator);
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
        marks,
        count,
        first,
        score: numbers * share.powi(3) * if fits { 1.0 } else { 0.3 },
        ambiguous: false,
    })
}

/// Counts cells that are numbers or times, and cells that are text.
fn tally(cells: &[&str], marks: Marks, separator: Separator) -> (f64, f64) {
    let (mut numbers, mut texts) = (0.0, 0.0);
    for cell in cells {
        match grouped_look(cell, marks, separator) {
            Look::Blank => {}
            Look::Text => texts += 1.0,
            Look::Number | Look::Moment(_) => numbers += 1.0,
        }
    }
    (numbers, texts)
}

/// Like [`look`], but numbers with any thousands separator count as numbers.
fn grouped_look(text: &str, marks: Marks, separator: Separator) -> Look {
    let plain = look(text, marks);
    if plain != Look::Text
        || !bare(text).starts_with(|c: char| c.is_ascii_digit() || "+-".contains(c))
    {
        return plain;
    }
    let decimal = char::from(marks.decimal);
    let usable = |mark: char| mark != decimal && !(mark == ' ' && separator == Separator::Blanks);
    let grouped = THOUSANDS
        .into_iter()
        .filter(|mark| usable(*mark))
        .any(|mark| {
            let marks = Marks {
                thousands: Some(mark),
                ..marks
            };
            matches!(cell(text, marks), Cell::Number(_))
        });
    if grouped { Look::Number } else { Look::Text }
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
fn thousands(lines: &[&str], data: &[usize], candidate: &Candidate) -> Option<char> {
    let decimal = char::from(candidate.marks.decimal);
    // The cell separator itself may group digits within quotes.
    let usable = |mark: &char| *mark != decimal;
    THOUSANDS.into_iter().filter(usable).find(|&mark| {
        data.iter().any(|&at| {
            let row = row(lines[at], candidate.separator, candidate.count);
            row.is_some_and(|cells| {
                cells.iter().any(|cell| {
                    matches!(look(cell, candidate.marks), Look::Text)
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
    marks: Marks,
) -> Vec<ColumnKind> {
    let mut tallies = vec![[0_usize; 3]; count];
    let mut starts = vec![None; count];
    for &at in rows {
        for (column, cell) in row(lines[at], separator, count)
            .unwrap_or_default()
            .iter()
            .enumerate()
        {
            match look(cell, marks) {
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
    marks: Marks,
    kinds: Vec<ColumnKind>,
) -> Vec<ColumnKind> {
    let cells = row(lines[first_row], separator, count).unwrap_or_default();
    let start = |column: usize| match look(cells.get(column)?, marks) {
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
