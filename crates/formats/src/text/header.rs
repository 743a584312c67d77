//! Column names and units of a text table.

use crate::contents::Note;
use crate::text::cells::{cells, row};
use crate::text::number::bare;
use crate::text::options::{Dialect, TextOptions};
use crate::text::rows::Separator;
use crate::text::spreadsheet::unguarded;

/// Most header rows below a header line named by the user.
const MOST_HEADER_ROWS: usize = 2;

/// Takes names and units from the lines above the first row.
pub fn name_columns(dialect: &mut Dialect, lines: &[&str], data: &[usize], options: &TextOptions) {
    let count = dialect.names.len();
    let clean = |cells: Vec<&str>| cells.iter().map(|c| name(c)).collect::<Vec<_>>();
    let fitting = |at: usize| row(lines[at], dialect.separator, count).map(clean);
    let above: Vec<usize> = data
        .iter()
        .copied()
        .filter(|&at| at < dialect.first_row)
        .collect();
    let mut header = match options.header_line {
        Some(0) => Vec::new(),
        Some(line) => above
            .iter()
            .copied()
            .filter(|&at| at as u64 + 1 >= line)
            .collect(),
        None => above.clone(),
    };
    if options.header_line.is_some() {
        header.truncate(MOST_HEADER_ROWS);
    }
    let mut used = above.len();
    // The last line above the rows is the header or its row of units.
    match header.last().and_then(|&at| fitting(at)) {
        Some(last) => {
            used -= 1;
            let before = header
                .len()
                .checked_sub(2)
                .and_then(|at| fitting(header[at]));
            match before {
                Some(names) if is_unit_row(&last) && filled(&names) => {
                    dialect.units = last
                        .into_iter()
                        .map(|u| Some(bare_unit(&u)).filter(|u| !u.is_empty()))
                        .collect();
                    dialect.names = names;
                    used -= 1;
                }
                // Two full rows and nothing above: names and remarks.
                Some(names) if header.len() == 2 && filled(&names) && filled(&last) => {
                    dialect.notes.push(Note::Odd(format!(
                        "there are two rows above the numbers; the names are taken from the first, \
                             the second says: {}",
                        last.join(", ")
                    )));
                    dialect.names = names;
                    used -= 1;
                }
                _ => dialect.names = last,
            }
        }
        None => {
            let more = header.iter().find_map(|&at| more_names(lines[at], dialect));
            if let Some(names) = commented_header(lines, dialect, count) {
                dialect.names = names;
            } else if let Some(names) = more {
                dialect.notes.push(Note::Odd(format!(
                    "there are {} names above {count} columns; they are taken in order, and \
                         \"{}\" has no column",
                    names.len(),
                    names[count..].join("\", \"")
                )));
                dialect.names = names[..count].to_vec();
            }
        }
    }
    let preamble = above[..used].iter().filter_map(|&at| {
        let cells = clean(cells(lines[at], dialect.separator));
        let (name, values) = cells.split_first()?;
        let value = values
            .iter()
            .filter(|v| !v.is_empty())
            .cloned()
            .collect::<Vec<_>>()
            .join(" ");
        (!name.is_empty()).then(|| (name.clone(), value))
    });
    dialect.preamble = preamble.collect();
}

/// A name as it was before windfall, or another program, kept it from being a formula.
fn name(cell: &str) -> String {
    unguarded(bare(cell)).to_owned()
}

/// Names from a line with more cells than columns, all filled.
fn more_names(line: &str, dialect: &Dialect) -> Option<Vec<String>> {
    let names: Vec<String> = cells(line, dialect.separator)
        .iter()
        .map(|c| name(c))
        .collect();
    let count = dialect.names.len();
    let names_only = names.iter().all(|name| !name.is_empty());
    (count > 1
        && names.len() > count
        && names.len() <= count + 2
        && names_only
        && dialect.separator != Separator::Blanks)
        .then_some(names)
}

fn filled(cells: &[String]) -> bool {
    2 * cells.iter().filter(|cell| !cell.is_empty()).count() > cells.len()
}

/// Names from a comment just above the first row: "# time(s), force(N)".
fn commented_header(lines: &[&str], dialect: &Dialect, count: usize) -> Option<Vec<String>> {
    let above = lines[..dialect.first_row]
        .iter()
        .rev()
        .find(|line| !line.trim().is_empty())?;
    let mark = dialect
        .comments
        .iter()
        .find(|mark| above.trim_start().starts_with(mark.as_str()))?;
    let text = above.trim_start()[mark.len()..].trim_start_matches(['#', '%', '/', ' ']);
    let by_marks = |marks: &[char]| {
        let names = text.split(marks).map(|name| bare(name).to_owned());
        names.filter(|name| !name.is_empty()).collect::<Vec<_>>()
    };
    [&[',', ';', '\t'][..], &[' ', ',', ';', '\t'][..]]
        .into_iter()
        .map(by_marks)
        .find(|names| names.len() == count)
}

/// Whether a row contains units: "(s)", "[mm]", "N".
fn is_unit_row(cells: &[String]) -> bool {
    let known = |cell: &String| {
        let unit = bare_unit(cell);
        unit.len() < cell.len() || UNITS.contains(&unit.as_str())
    };
    let filled: Vec<&String> = cells.iter().filter(|cell| !cell.is_empty()).collect();
    !filled.is_empty() && 2 * filled.iter().filter(|cell| known(cell)).count() > filled.len()
}

/// Units recognised without brackets.
const UNITS: [&str; 51] = [
    "s", "ms", "us", "µs", "min", "h", "sec", "N", "mN", "kN", "g", "kg", "m", "mm", "cm", "um",
    "µm", "m/s", "mm/s", "mm/min", "m/s^2", "m/s²", "m/s2", "V", "mV", "A", "mA", "Pa", "kPa",
    "MPa", "bar", "gf", "kgf", "kp", "lbf", "ozf", "in", "inch", "mil", "ft", "in/min", "sec.",
    "rad", "deg", "°", "°C", "C", "K", "%", "Hz", "-",
];

fn bare_unit(cell: &str) -> String {
    let inner = [('(', ')'), ('[', ']'), ('<', '>')]
        .into_iter()
        .find_map(|(open, close)| cell.strip_prefix(open)?.strip_suffix(close));
    inner.unwrap_or(cell).trim().to_owned()
}
