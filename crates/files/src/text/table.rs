//! Aligned tables for a terminal, none wider than a page or than the terminal.

use crate::found::{FailureOutcome, FindingOutcome};
use crate::known_names::few_names;
use crate::named::grouped;
use comfy_table::{CellAlignment, ContentArrangement, LineStyle, Table, TableStyle};
use itertools::Itertools;
use std::cell::Cell;

/// Widest line of a table or a paragraph; characters.
pub const PAGE: usize = 100;

/// What a column takes beside its text; characters.
const GAP: usize = 3;

/// Narrowest page to which text is folded; characters.
const NARROWEST: usize = 40;

thread_local! {
    /// Width of the terminal that shows the text made on this thread; characters.
    static TERMINAL: Cell<Option<usize>> = const { Cell::new(None) };
}

/// Does work whose tables and paragraphs are for a terminal of this width.
///
/// * `width`: characters; none for text that is not for a terminal
pub fn for_terminal<T>(width: Option<usize>, work: impl FnOnce() -> T) -> T {
    let before = TERMINAL.replace(width.map(|width| width.max(NARROWEST)));
    let made = work();
    TERMINAL.set(before);
    made
}

/// A table as words, for a terminal or a page.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Cells {
    /// Heading of each column.
    pub header: Vec<String>,
    /// Rows, each with a cell for every column.
    pub rows: Vec<Vec<String>>,
}

/// An aligned table; columns not in `left` are set flush right. Where a terminal shows it and
/// is not wide enough, it comes in parts as those of [`page_tables`].
pub fn table_text(
    header: &[String],
    rows: impl IntoIterator<Item = Vec<String>>,
    left: &[usize],
) -> String {
    let rows: Vec<Vec<String>> = rows.into_iter().collect();
    tables_within(TERMINAL.get().unwrap_or(usize::MAX), header, &rows, left)
}

/// A table as [`table_text`], in as many parts as it takes to stay within a
/// page, or within the terminal that shows it. Every part begins with the first column.
pub fn page_tables(header: &[String], rows: &[Vec<String>], left: &[usize]) -> String {
    tables_within(TERMINAL.get().unwrap_or(PAGE), header, rows, left)
}

/// A table in as many parts as it takes to stay within a width; characters.
fn tables_within(most: usize, header: &[String], rows: &[Vec<String>], left: &[usize]) -> String {
    let width = |column: usize| {
        let cells = rows.iter().map(|row| row[column].chars().count());
        GAP + cells
            .chain([header[column].chars().count()])
            .max()
            .unwrap_or(0)
    };
    let mut parts: Vec<Vec<usize>> = vec![vec![0]];
    let mut used = width(0);
    for column in 1..header.len() {
        let part = parts.len() - 1;
        if used.saturating_add(width(column)) > most && parts[part].len() > 1 {
            parts.push(vec![0, column]);
            used = width(0) + width(column);
        } else {
            parts[part].push(column);
            used += width(column);
        }
    }
    let tables = parts.iter().map(|columns| {
        let pick = |row: &[String]| columns.iter().map(|&i| row[i].clone()).collect::<Vec<_>>();
        let left: Vec<usize> = (0..columns.len())
            .filter(|&i| left.contains(&columns[i]))
            .collect();
        whole_table(&pick(header), rows.iter().map(|row| pick(row)), &left)
    });
    tables.collect::<Vec<_>>().join("\n\n")
}

fn whole_table(
    header: &[String],
    rows: impl Iterator<Item = Vec<String>>,
    left: &[usize],
) -> String {
    let line = LineStyle::none().fill('─').junction('─');
    let mut table = Table::new();
    table.load_style(TableStyle::new().header_separator(line));
    table.set_content_arrangement(ContentArrangement::Disabled);
    table.set_header(header);
    for row in rows {
        table.add_row(row);
    }
    for (index, column) in table.column_iter_mut().enumerate() {
        if !left.contains(&index) {
            column.set_cell_alignment(CellAlignment::Right);
        }
    }
    table.trim_fmt()
}

/// A paragraph broken into lines of a page, all but the first indented.
pub fn paragraph(text: &str, indent: usize) -> String {
    let page = TERMINAL.get().map_or(PAGE, |width| width.min(PAGE));
    let mut lines: Vec<String> = Vec::new();
    for word in text.split(' ') {
        match lines.last_mut() {
            Some(line) if line.chars().count() + 1 + word.chars().count() <= page => {
                line.push(' ');
                line.push_str(word);
            }
            Some(_) => lines.push(" ".repeat(indent) + word),
            None => lines.push(word.to_owned()),
        }
    }
    lines.join("\n")
}

/// Words as the header of a table.
pub fn header_of(words: &[&str]) -> Vec<String> {
    words.iter().map(|word| (*word).to_owned()).collect()
}

/// First lines of results: the campaign, that its recordings are simulated, a remark on it.
pub fn title_lines(campaign: &str, simulated: Option<&str>, note: Option<&str>) -> String {
    let label = simulated.map(|label| format!("SIMULATED recordings: {label}"));
    let note = note.map(|note| format!("Note: {note}"));
    let lines = [Some(campaign), label.as_deref(), note.as_deref()];
    let lines = lines.into_iter().flatten();
    lines
        .map(|line| paragraph(&one_line(line), 2) + "\n")
        .collect()
}

/// What somebody wrote as one line, without what would steer a terminal.
fn one_line(text: &str) -> String {
    let words = text.split(|c: char| c.is_whitespace() || c.is_control());
    words.filter(|word| !word.is_empty()).join(" ")
}

/// The message of the first of several impacts that say the same, with how many do and who
/// they are.
///
/// * `all`: impacts that there are, where they are all of one sort
pub fn of_impacts(message: &str, ids: &[&str], all: Option<usize>) -> String {
    let (Some(first), others) = (ids.first(), ids.get(1..).unwrap_or_default()) else {
        return message.to_owned();
    };
    let so = match others {
        [] => return format!("{first}: {message}"),
        _ if all == Some(ids.len()) => {
            return format!(
                "{first}: {message} (all {} have one of this kind)",
                ids.len()
            );
        }
        [second] => format!("so has {second}"),
        [second, third] => format!("so have {second} and {third}"),
        [second, third, more @ ..] => format!("so have {second}, {third} and {} more", more.len()),
    };
    let count = all.map_or_else(String::new, |all| format!("; {} of {all}", ids.len()));
    format!("{first}: {message} ({so}{count})")
}

/// A line for each cause why recordings have no result, with how many share it, and what was
/// found out before.
pub fn failures_list(what: &str, failures: &[FailureOutcome], indent: usize) -> String {
    let causes = grouped(failures.iter().map(|failure| (cause(failure), failure)));
    let mut text = String::new();
    for (_, all) in causes {
        let ids: Vec<&str> = all.iter().map(|failure| failure.id.as_str()).collect();
        let many = match ids.len() {
            1 => String::new(),
            several => format!("{several} recordings, "),
        };
        let line = format!("{what}: {many}{}: {}", few_names(&ids), all[0].message);
        text += &(paragraph(&line, indent) + "\n");
        // Those of the first stand for all.
        for line in finding_lines(&all[0].findings) {
            text += &(paragraph(&format!("    {line}"), indent + 4) + "\n");
        }
    }
    text
}

/// A message without what differs between recordings: their names and numbers.
fn cause(failure: &FailureOutcome) -> String {
    let named = failure.message.replace(&failure.file, "");
    let named = named.replace(&failure.id, "");
    named
        .chars()
        .filter(|c| !c.is_ascii_digit() && !"+-.".contains(*c))
        .collect()
}

/// Findings as a list.
pub fn findings_list(findings: &[FindingOutcome]) -> String {
    if findings.is_empty() {
        return String::new();
    }
    let lines = finding_lines(findings).map(|line| paragraph(&format!("  {line}"), 4) + "\n");
    format!("\nFindings:\n{}", lines.collect::<String>())
}

/// A line for each finding, the gravest first: `[wrong] clipped: …`.
pub fn finding_lines(findings: &[FindingOutcome]) -> impl Iterator<Item = String> {
    let sorted = findings.iter().sorted_by_key(|finding| finding.severity);
    sorted.map(|finding| {
        let (code, word) = (&finding.code, finding.severity.word());
        format!("[{word}] {code}: {}", finding.message)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn texts(cells: &[&str]) -> Vec<String> {
        cells.iter().map(|cell| (*cell).to_owned()).collect()
    }

    #[test]
    fn closed_form_wide_tables_break_into_pages() {
        let wide = "w".repeat(40);
        let header = texts(&["id", "a", "b", "c"]);
        let rows = [texts(&["first", &wide, &wide, &wide])];
        let text = page_tables(&header, &rows, &[0]);
        assert!(text.lines().all(|line| line.chars().count() <= PAGE));
        assert_eq!(text.matches("first").count(), 2);
        assert_eq!(text.matches(&wide).count(), 3);
    }

    #[test]
    fn rejects_what_would_steer_a_terminal_in_titles_and_notes() {
        let lines = title_lines("apples \u{1b}[31mof 2003", None, Some("wet\nat\u{7} night"));
        assert_eq!(lines, "apples [31mof 2003\nNote: wet at night\n");
    }

    #[test]
    fn closed_form_tables_fold_to_the_terminal() {
        let header = texts(&["id", "peak force (N)", "duration (ms)", "energy (mJ)"]);
        let rows = [texts(&["a-1", "12.3 ± 0.4", "4.16", "118"])];
        let whole = table_text(&header, rows.clone(), &[0]);
        assert_eq!(whole.lines().count(), 3);
        let folded = for_terminal(Some(44), || table_text(&header, rows.clone(), &[0]));
        assert!(
            folded.lines().all(|line| line.chars().count() <= 44),
            "{folded}"
        );
        assert_eq!(folded.matches("a-1").count(), 2);
        for cell in header.iter().chain(&rows[0]) {
            assert!(folded.contains(cell), "{cell}");
        }
        let long = "word ".repeat(60);
        let text = for_terminal(Some(60), || paragraph(long.trim(), 2));
        assert!(text.lines().all(|line| line.chars().count() <= 60));
        // What is written later is whole again, and a wider terminal takes more columns.
        assert_eq!(table_text(&header, rows.clone(), &[0]), whole);
        let wide = texts(&["w".repeat(40).as_str(); 4]);
        let parts = |width| for_terminal(width, || page_tables(&wide, &[], &[0]));
        assert_eq!(parts(None).lines().count(), 8);
        assert_eq!(parts(Some(200)).lines().count(), 2);
    }

    #[test]
    fn closed_form_one_line_for_a_cause() {
        let failure = |id: &str, message: &str| FailureOutcome {
            id: id.to_owned(),
            specimen: "s".to_owned(),
            file: format!("{id}.csv"),
            law: None,
            message: message.to_owned(),
            findings: Vec::new(),
        };
        let failures = [
            failure("a1", "raw/a1.csv: the largest value is 0.31 N"),
            failure("a2", "raw/a2.csv: no column \"force\""),
            failure("a3", "raw/a3.csv: the largest value is -2 N"),
            failure("b", "raw/b.csv: the largest value is 12 N"),
            failure("c", "raw/c.csv: the largest value is 1 N"),
        ];
        assert_eq!(
            failures_list("not fitted", &failures, 4),
            "not fitted: 4 recordings, a1, a3, b and 1 more: raw/a1.csv: the largest value is 0.31 N\n\
             not fitted: a2: raw/a2.csv: no column \"force\"\n"
        );
        let said = |ids: &[&str]| of_impacts("odd", ids, Some(9));
        assert_eq!(said(&[]), "odd");
        assert_eq!(said(&["a"]), "a: odd");
        assert_eq!(said(&["a", "b", "c"]), "a: odd (so have b and c; 3 of 9)");
        assert_eq!(
            said(&["a", "b", "c", "d", "e"]),
            "a: odd (so have b, c and 2 more; 5 of 9)"
        );
        assert_eq!(
            of_impacts("odd", &["a", "b"], Some(2)),
            "a: odd (all 2 have one of this kind)"
        );
        assert_eq!(of_impacts("odd", &["a", "b"], None), "a: odd (so has b)");
    }

    #[test]
    fn closed_form_paragraphs_keep_every_word() {
        let long = "word ".repeat(60);
        let text = paragraph(long.trim(), 4);
        assert!(text.lines().all(|line| line.chars().count() <= PAGE));
        assert_eq!(text.split_whitespace().count(), 60);
        assert!(text.lines().nth(1).unwrap().starts_with("    word"));
    }
}
