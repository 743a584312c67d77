//! Detects the dialect of a text table from its first lines.

use crate::contents::Note;
use crate::text::cells::Cells;
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

/// Candidate decimal marks.
const DECIMALS: [u8; 2] = [b'.', b','];

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
    let (cells, candidate) = best_candidate(lines, &data, &missing, options).ok_or_else(nothing)?;
    let Candidate {
        mut marks,
        count,
        mut looks,
        first,
        ..
    } = candidate;
    marks.thousands = options
        .thousands
        .or_else(|| thousands(&cells, &data, count, marks, &looks));
    if marks.thousands.is_some() {
        let notation = Notation {
            marks,
            missing: &missing,
        };
        looks = cells.all.iter().map(|cell| notation.look(cell)).collect();
    }

    let rows: Vec<usize> = data
        .iter()
        .copied()
        .filter(|&at| cells.place(at, count).is_some())
        .collect();
    let looks_of = |at: usize| cells.place(at, count).map(|place| &looks[place]);
    let below = rows.iter().filter(|&&at| at >= first);
    let kinds = column_kinds(below.filter_map(|&at| looks_of(at)), count);
    let numeric = |at: usize| looks_of(at).is_some_and(|looks| is_row(looks, &kinds));
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
        separator: cells.separator,
        marks,
        comments,
        names: vec![String::new(); count],
        units: vec![None; count],
        kinds: first_moments(looks_of(first_row).unwrap_or_default(), kinds),
        first_row,
        rising_first: false,
        preamble: Vec::new(),
        notes: Vec::new(),
    };
    name_columns(&mut dialect, lines, &data, options);
    let unnamed = dialect.names.iter().all(String::is_empty);
    dialect.rising_first = unnamed && count > 1 && first_rises(&cells, &rows, &dialect);
    if options.decimal.is_none() && options.thousands.is_none() {
        let below = rows.iter().filter(|&&at| at >= first_row);
        let below = below
            .filter_map(|&at| Some((at + 1 + options.lines_above as usize, cells.row(at, count)?)));
        let other = if marks.decimal == b'.' { b',' } else { b'.' };
        if may_be_decimal(&cells, &data, other) {
            let doubt = doubtful_mark(below, marks.decimal, &dialect.kinds);
            dialect.notes.extend(doubt.map(Note::DecimalOrThousands));
        }
    }
    Ok(dialect)
}

/// Whether the first column rises like a column of times.
fn first_rises(cells: &Cells, rows: &[usize], dialect: &Dialect) -> bool {
    let first = |at: usize| {
        let cells = cells.row(at, dialect.names.len())?;
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

fn is_row(looks: &[Look], kinds: &[ColumnKind]) -> bool {
    let mut numbers = 0;
    for (look, kind) in looks.iter().zip(kinds) {
        match (kind, look) {
            (ColumnKind::Text, _) | (_, Look::Blank) => {}
            (_, Look::Text) => return false,
            _ => numbers += 1,
        }
    }
    numbers > 0
}

/// A separator and decimal mark, and how well they fit the lines.
#[derive(Clone, Debug)]
struct Candidate {
    marks: Marks,
    count: usize,
    /// First line that looks like a row of numbers.
    first: usize,
    score: f64,
    /// What all cells look like.
    looks: Vec<Look>,
}

/// The best separator and decimal mark, with the cells; of equals the first.
fn best_candidate<'a>(
    lines: &[&'a str],
    data: &[usize],
    missing: &MissingWords,
    options: &TextOptions,
) -> Option<(Cells<'a>, Candidate)> {
    let separators = SEPARATORS
        .into_iter()
        .filter(|separator| options.separator.is_none_or(|wanted| wanted == *separator))
        .chain(options.separator.filter(|s| !SEPARATORS.contains(s)));
    let occurs = |own: Separator| match own {
        Separator::Mark(mark) => lines.iter().any(|line| line.as_bytes().contains(&mark)),
        Separator::Blanks => true,
    };
    // Marks that divide no line all leave the same cells.
    let mut undivided = false;
    let divided = separators.filter_map(|own| {
        if undivided && !occurs(own) {
            return None;
        }
        let cells = Cells::new(lines, own);
        let same = cells.all.len() == lines.len() && own != Separator::Blanks;
        let also = same && undivided;
        undivided |= same && !DECIMALS.map(Separator::Mark).contains(&own);
        (!also).then_some(cells)
    });
    let mut divided: Vec<Cells> = divided.collect();

    // A score is at most the number of cells: where there are most of them, the others need
    // no closer look.
    let mut order: Vec<usize> = (0..divided.len()).collect();
    order.sort_by_key(|&at| std::cmp::Reverse(divided[at].all.len()));
    let mut found: Vec<[Option<Candidate>; 2]> = divided.iter().map(|_| [None, None]).collect();
    let mut highest = 0.0;
    for at in order {
        let cells = &divided[at];
        if (cells.all.len() as f64) < highest {
            break;
        }
        for (decimal, found) in DECIMALS.into_iter().zip(&mut found[at]) {
            let other = options.decimal.is_some_and(|d| d != char::from(decimal));
            if other || !may_be_decimal(cells, data, decimal) {
                continue;
            }
            let notation = Notation {
                marks: Marks::decimal(decimal),
                missing,
            };
            *found = candidate(cells, data, notation);
            highest = found.as_ref().map_or(highest, |own| own.score.max(highest));
        }
    }
    let best = found.iter().position(|both| {
        let mut scores = both.iter().flatten().map(|own| own.score);
        highest > 0.0 && scores.any(|score| score == highest)
    })?;
    let cells = divided.swap_remove(best);
    let [point, comma] = found.swap_remove(best);
    let reaches = |own: &Option<Candidate>| own.as_ref().is_some_and(|own| own.score == highest);
    let equal = reaches(&point) && reaches(&comma);
    let mut best = point.filter(|own| own.score == highest).or(comma)?;
    if equal {
        let data = data.iter().filter(|&&at| at >= best.first);
        let rows = data.filter_map(|&at| cells.row(at, best.count));
        best.marks.decimal = likelier_decimal(rows, cells.separator);
        let notation = Notation {
            marks: best.marks,
            missing,
        };
        best.looks = cells.all.iter().map(|cell| notation.look(cell)).collect();
    }
    Some((cells, best))
}

/// Whether a mark can stand before decimals: where it separates cells, only in quoted ones.
fn may_be_decimal(cells: &Cells, data: &[usize], mark: u8) -> bool {
    let quoted = |&at: &usize| {
        let cells = cells.line(at);
        cells.iter().any(|cell| cell.as_bytes().contains(&mark))
    };
    cells.separator != Separator::Mark(mark) || data.iter().any(quoted)
}

fn candidate(cells: &Cells, data: &[usize], notation: Notation) -> Option<Candidate> {
    let count = usual_count(cells, data, notation.marks.decimal)?;
    let looks: Vec<Look> = cells.all.iter().map(|cell| notation.look(cell)).collect();
    let tallies: Vec<(usize, f64, f64)> = data
        .iter()
        .filter_map(|&at| {
            let place = cells.place(at, count)?;
            let own = cells.all[place.clone()].iter().zip(&looks[place]);
            let (numbers, texts) = tally(own, notation, cells.separator);
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
    let fits = above.is_none_or(|&at| cells.place(at, count).is_some());
    let share = numbers / (numbers + texts);
    Some(Candidate {
        marks: notation.marks,
        count,
        first,
        score: numbers * share.powi(3) * if fits { 1.0 } else { 0.3 },
        looks,
    })
}

/// Counts cells that are numbers or times, and cells that are text.
fn tally<'a>(
    cells: impl Iterator<Item = (&'a &'a str, &'a Look)>,
    notation: Notation,
    separator: Separator,
) -> (f64, f64) {
    let (mut numbers, mut texts) = (0.0, 0.0);
    for (cell, look) in cells {
        match notation.grouped(cell, *look, separator) {
            Look::Blank => {}
            Look::Text => texts += 1.0,
            Look::Number | Look::Moment(_) => numbers += 1.0,
        }
    }
    (numbers, texts)
}

/// The most common number of cells in lines that contain a number.
fn usual_count(cells: &Cells, data: &[usize], decimal: u8) -> Option<usize> {
    let rows = || data.iter().map(|&at| cells.line(at));
    let ends_blank = |row: &[&str]| row.last().is_some_and(|cell| cell.trim().is_empty());
    // A blank last cell counts only if some line of that width has text in it;
    // otherwise it is just a trailing separator.
    let filled: BTreeSet<usize> = rows()
        .filter(|row| !ends_blank(row))
        .map(<[&str]>::len)
        .collect();
    let mut counts = BTreeMap::new();
    for row in rows() {
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
///
/// * `looks`: what the cells look like without one
fn thousands(
    cells: &Cells,
    data: &[usize],
    count: usize,
    marks: Marks,
    looks: &[Look],
) -> Option<char> {
    let decimal = char::from(marks.decimal);
    let places = || {
        data.iter()
            .filter_map(|&at| cells.place(at, count))
            .flatten()
    };
    let texts: Vec<&str> = places()
        .filter(|&place| looks[place] == Look::Text)
        .map(|place| bare(cells.all[place]))
        .collect();
    // The cell separator itself may group digits within quotes.
    let usable = |mark: &char| *mark != decimal;
    THOUSANDS.into_iter().filter(usable).find(|&mark| {
        let mut texts = texts.iter();
        texts.any(|text| without_groups(text, mark, decimal).is_some())
    })
}

/// Kind of each column, by majority of its cells.
fn column_kinds<'a>(rows: impl Iterator<Item = &'a [Look]>, count: usize) -> Vec<ColumnKind> {
    let mut tallies = vec![[0_usize; 3]; count];
    let mut starts = vec![None; count];
    for looks in rows {
        for (column, look) in looks.iter().enumerate() {
            match *look {
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
fn first_moments(first_row: &[Look], kinds: Vec<ColumnKind>) -> Vec<ColumnKind> {
    let start = |column: usize| match first_row.get(column)? {
        Look::Moment(moment) => Some(ColumnKind::Moments(*moment)),
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
