//! Aligned tables for a terminal, none wider than a page.

use crate::found::{FailureOutcome, FindingOutcome};
use comfy_table::{CellAlignment, ContentArrangement, LineStyle, Table, TableStyle};

/// Widest line of a table or a paragraph; characters.
pub const PAGE: usize = 100;

/// What a column takes beside its text; characters.
const GAP: usize = 3;

/// A table as words, for a terminal or a page.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Cells {
    /// Heading of each column.
    pub header: Vec<String>,
    /// Rows, each with a cell for every column.
    pub rows: Vec<Vec<String>>,
}

/// An aligned table; columns not in `left` are set flush right.
pub fn table_text(
    header: &[String],
    rows: impl IntoIterator<Item = Vec<String>>,
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

/// A table as [`table_text`], in as many parts as it takes to stay within a
/// page. Every part begins with the first column.
pub fn page_tables(header: &[String], rows: &[Vec<String>], left: &[usize]) -> String {
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
        if used + width(column) > PAGE && parts[part].len() > 1 {
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
        table_text(&pick(header), rows.iter().map(|row| pick(row)), &left)
    });
    tables.collect::<Vec<_>>().join("\n\n")
}

/// A paragraph broken into lines of a page, all but the first indented.
pub fn paragraph(text: &str, indent: usize) -> String {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split(' ') {
        match lines.last_mut() {
            Some(line) if line.chars().count() + 1 + word.chars().count() <= PAGE => {
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

/// First lines of results: the campaign, and that its recordings are simulated.
pub fn title_lines(campaign: &str, simulated: Option<&str>) -> String {
    let label = simulated.map(|label| format!("SIMULATED recordings: {label}"));
    let lines = [Some(campaign), label.as_deref()].into_iter().flatten();
    lines.map(|line| paragraph(line, 2) + "\n").collect()
}

/// A line for each recording that has no result, and why.
pub fn failures_list(what: &str, failures: &[FailureOutcome], indent: usize) -> String {
    let mut text = String::new();
    for failure in failures {
        let line = format!("{what}: {}: {}", failure.id, failure.message);
        text += &(paragraph(&line, indent) + "\n");
        for finding in &failure.findings {
            let line = format!("    {}: {}", finding.code, finding.message);
            text += &(paragraph(&line, indent + 4) + "\n");
        }
    }
    text
}

/// Findings as a list.
pub fn findings_list(findings: &[FindingOutcome]) -> String {
    if findings.is_empty() {
        return String::new();
    }
    let lines = findings.iter().map(|finding| {
        let line = format!("  {}: {}", finding.code, finding.message);
        paragraph(&line, 4) + "\n"
    });
    format!("\nFindings:\n{}", lines.collect::<String>())
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
    fn closed_form_paragraphs_keep_every_word() {
        let long = "word ".repeat(60);
        let text = paragraph(long.trim(), 4);
        assert!(text.lines().all(|line| line.chars().count() <= PAGE));
        assert_eq!(text.split_whitespace().count(), 60);
        assert!(text.lines().nth(1).unwrap().starts_with("    word"));
    }
}
