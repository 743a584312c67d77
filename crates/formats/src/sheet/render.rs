//! A sheet as text: a line for each row, tabs between cells.

use crate::contents::Note;
use crate::sheet::cell::{Cell, Placed, Sheet};
use crate::text::decimal::doubtful_mark;
use crate::text::number::{Marks, bare, number};
use crate::text::options::TextOptions;
use crate::text::rows::ColumnKind;
use std::collections::BTreeMap;
use std::fmt::Write;
use windfall_source::error::{Error, Place};
use windfall_source::source::Source;

const NANOSECONDS: f64 = 1e9;
const DAY: u64 = 86_400;

/// Most blank rows between two others.
const MOST_BLANK: u32 = 10_000;

/// Most cells, blank ones included, of a sheet that is nearly empty.
const MOST_SPARSE: u64 = 1 << 22;

/// Blank cells that each other may stand for, in larger sheets.
const MOST_PER_CELL: u64 = 64;

/// Text of the rows from `first` to before `end`, with the columns that have any cell.
///
/// # Errors
/// The rows are nearly empty.
pub fn text_of(
    source: &Source,
    sheet: &Sheet,
    first: u32,
    end: u32,
    marks: Marks,
) -> Result<String, Error> {
    let from = sheet.cells.partition_point(|placed| placed.row < first);
    let to = sheet.cells.partition_point(|placed| placed.row < end);
    let cells = &sheet.cells[from..to];
    // Columns in use: their places, and whether they hold a time of day besides dates.
    let mut columns: BTreeMap<u32, (usize, bool)> = BTreeMap::new();
    for placed in cells {
        let timed = matches!(placed.cell, Cell::Date(days) if days.fract() != 0.0);
        columns.entry(placed.column).or_default().1 |= timed;
    }
    for (place, column) in columns.values_mut().enumerate() {
        column.0 = place;
    }
    check_room(source, sheet, cells, columns.len() as u64)?;
    let mut text = String::new();
    let mut row = first;
    let mut filled = 0;
    let blank_rest = |text: &mut String, filled: usize| {
        text.extend(std::iter::repeat_n(
            '\t',
            columns.len().saturating_sub(filled + 1),
        ));
    };
    for placed in cells {
        while row < placed.row {
            blank_rest(&mut text, filled);
            text.push('\n');
            (row, filled) = (row + 1, 0);
        }
        let (place, timed) = columns[&placed.column];
        text.extend(std::iter::repeat_n('\t', place - filled));
        filled = place;
        write_cell(&mut text, &placed.cell, timed, marks);
    }
    blank_rest(&mut text, filled);
    text.push('\n');
    Ok(text)
}

fn check_room(source: &Source, sheet: &Sheet, cells: &[Placed], columns: u64) -> Result<(), Error> {
    let place = Place::Object(sheet.name.clone());
    let gap = cells
        .windows(2)
        .find(|pair| pair[1].row - pair[0].row > MOST_BLANK);
    if let Some([above, below]) = gap {
        return Err(source.malformed(
            place,
            format!(
                "{} blank rows stand above row {}",
                below.row - above.row - 1,
                below.row + 1
            ),
            "delete the cells below the table, or save the table as CSV",
        ));
    }
    let rows = cells.last().map_or(0, |last| last.row - cells[0].row + 1);
    let all = u64::from(rows) * columns;
    if all > MOST_SPARSE && all / MOST_PER_CELL > cells.len() as u64 {
        return Err(source.malformed(
            place,
            format!(
                "{rows} rows and {columns} columns hold only {} cells",
                cells.len()
            ),
            "save the table as CSV",
        ));
    }
    Ok(())
}

fn write_cell(text: &mut String, cell: &Cell, timed: bool, marks: Marks) {
    match cell {
        Cell::Number(value) => write_number(text, *value),
        // Numbers as text, in the notation of the country.
        Cell::Text(found) => match number(found, marks) {
            Some(value) => write_number(text, value),
            // Marks of the text that this becomes.
            None => text.extend(found.chars().map(|c| match c {
                '"' => '\u{2033}',
                c if c.is_control() => ' ',
                c => c,
            })),
        },
        Cell::Date(days) => write_date(text, *days, timed),
        Cell::Clock(seconds) => {
            write_clock(text, (seconds * NANOSECONDS).round() as u64, 9);
        }
    }
}

/// The shortest text that stands for exactly this number.
fn write_number(text: &mut String, value: f64) {
    // Writing to a string cannot fail.
    let _ = write!(text, "{value:?}");
}

/// Parts of a day to which a date with a time is rounded: 10 µs. Programs write 15 or 16 digits,
/// which say it to within 4.4 µs.
const PARTS: u64 = DAY * 100_000;

/// A date, with its time.
fn write_date(text: &mut String, days: f64, timed: bool) {
    // The fraction by itself keeps all of its digits.
    let parts = (days.fract() * PARTS as f64).round() as u64;
    let day = days.floor() as i64 + (parts / PARTS) as i64;
    let (year, month, day) = civil(day);
    let _ = write!(text, "{year:04}-{month:02}-{day:02}");
    if timed {
        text.push(' ');
        write_clock(text, 10_000 * (parts % PARTS), 5);
    }
}

/// A time of day; times of more than a day go on from midnight, as readers of text expect.
fn write_clock(text: &mut String, nanoseconds: u64, decimals: usize) {
    let seconds = nanoseconds / 1_000_000_000 % DAY;
    let fraction = format!("{:09}", nanoseconds % 1_000_000_000);
    let (hours, minutes) = (seconds / 3600, seconds / 60 % 60);
    let _ = write!(
        text,
        "{hours:02}:{minutes:02}:{:02}.{}",
        seconds % 60,
        &fraction[..decimals]
    );
}

/// Year, month and day, from days since 1899-12-30.
///
/// # Source
/// H. Hinnant, "chrono-compatible low-level date algorithms" (2013), `civil_from_days`.
fn civil(days: i64) -> (i64, i64, i64) {
    let shifted = days - 25_569 + 719_468;
    let era = shifted.div_euclid(146_097);
    let day_of_era = shifted.rem_euclid(146_097);
    let year_of_era =
        (day_of_era - day_of_era / 1460 + day_of_era / 36_524 - day_of_era / 146_096) / 365;
    let day_of_year = day_of_era - (365 * year_of_era + year_of_era / 4 - year_of_era / 100);
    let month = (5 * day_of_year + 2) / 153;
    let day = day_of_year - (153 * month + 2) / 5 + 1;
    let month = if month < 10 { month + 3 } else { month - 9 };
    (year_of_era + 400 * era + i64::from(month <= 2), month, day)
}

/// The marks in numbers that stand as text, and a note where nothing shows what a mark means.
pub fn text_marks(sheet: &Sheet, options: &TextOptions) -> (Marks, Option<Note>) {
    let texts = sheet.cells.iter().filter_map(|placed| match &placed.cell {
        Cell::Text(text) => Some((placed.row as usize + 1, bare(text))),
        _ => None,
    });
    let numbers: Vec<(usize, &str)> = texts
        .filter(|(_, text)| {
            text.starts_with(|c: char| c.is_ascii_digit() || "+-.,\u{2212}".contains(c))
        })
        .collect();
    let fits = |decimal: u8| {
        let marks = Marks::decimal(decimal);
        let marked = numbers
            .iter()
            .filter(|(_, text)| text.contains(char::from(decimal)));
        marked
            .filter(|(_, text)| number(text, marks).is_some())
            .count()
    };
    let decimal = match options.decimal {
        Some(decimal) => decimal as u8,
        None if fits(b',') > fits(b'.') => b',',
        None => b'.',
    };
    let marks = Marks {
        thousands: options.thousands,
        ..Marks::decimal(decimal)
    };
    let note = match (options.decimal, options.thousands) {
        (None, None) => {
            let rows = numbers
                .iter()
                .map(|(row, text)| (*row, std::slice::from_ref(text)));
            doubtful_mark(rows, decimal, &[ColumnKind::Numbers])
        }
        _ => None,
    };
    (marks, note.map(Note::DecimalOrThousands))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sheet(cells: &[(u32, u32, Cell)]) -> Sheet {
        let placed = cells.iter().map(|(row, column, cell)| Placed {
            row: *row,
            column: *column,
            cell: cell.clone(),
        });
        Sheet {
            name: "s".to_owned(),
            cells: placed.collect(),
        }
    }

    fn text(cells: &[(u32, u32, Cell)], decimal: u8) -> Result<String, Error> {
        let source = Source::from_bytes("b", Vec::new());
        text_of(&source, &sheet(cells), 0, 1 << 20, Marks::decimal(decimal))
    }

    #[test]
    fn closed_form_text_of_cells() {
        let word = |text: &str| Cell::Text(text.into());
        let cells = [
            (1, 2, word("Force\n(\")")),
            (2, 2, Cell::Number(0.1)),
            (2, 5, Cell::Number(-1e300)),
            (4, 5, word("1,5")),
        ];
        let expected = "\nForce (\u{2033})\t\n0.1\t-1e300\n\t\n\t1.5\n";
        assert_eq!(
            text(&cells, b',').unwrap(),
            expected.replacen('\n', "\t\n", 1)
        );
    }

    /// Dates by `date -u -d "1899-12-30 +N days"` of GNU coreutils.
    #[test]
    fn reference_dates_and_times() {
        for (cell, expected) in [
            (Cell::Date(45_615.25), "2024-11-19 06:00:00.00000"),
            (Cell::Date(36_585.5), "2000-02-29 12:00:00.00000"),
            (Cell::Date(45_615.0), "2024-11-19"),
            // 20:39:53.1 as a sheet stores it.
            (
                Cell::Date(45_615.0 + 74_393.1 / 86_400.0),
                "2024-11-19 20:39:53.10000",
            ),
            (Cell::Clock(74_393.1), "20:39:53.100000000"),
            (Cell::Clock(90_000.5), "01:00:00.500000000"),
            (Cell::Clock(59.999_999_999_9), "00:01:00.000000000"),
        ] {
            assert_eq!(text(&[(0, 0, cell)], b'.').unwrap().trim_end(), expected);
        }
    }

    #[test]
    fn rejects_sheets_that_are_nearly_empty() {
        let one = Cell::Number(1.0);
        let far = text(&[(0, 0, one.clone()), (1_000_000, 0, one.clone())], b'.').unwrap_err();
        let told = "b, \"s\": 999999 blank rows stand above row 1000001";
        assert!(far.to_string().starts_with(told), "{far}");
        let diagonal: Vec<(u32, u32, Cell)> = (0..10_000).map(|i| (i, i, one.clone())).collect();
        let wide = text(&diagonal, b'.').unwrap_err().to_string();
        assert!(
            wide.contains("10000 rows and 10000 columns hold only 10000 cells"),
            "{wide}"
        );
    }
}
