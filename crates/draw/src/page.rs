//! A report as one HTML page that needs nothing else: no file, no network.

use crate::files::NamedFigure;
use crate::theme::{DARK, LIGHT, PAGE, declarations};
use crate::width::Width;
use crate::xy::elements_of_figure;
use maud::{DOCTYPE, Markup, PreEscaped, html};
use windfall_files::found::{FailureOutcome, FindingOutcome};
use windfall_files::text::table::Cells;

/// A table with its caption.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CaptionedTable {
    /// What stands above it.
    pub caption: String,
    /// Its words.
    pub cells: Cells,
}

/// A part of the report.
#[derive(Clone, Debug, PartialEq)]
pub struct Section {
    /// Its heading.
    pub heading: String,
    /// Its paragraphs.
    pub paragraphs: Vec<String>,
    /// Words set as they are, line by line.
    pub listing: Option<String>,
    /// Its tables.
    pub tables: Vec<CaptionedTable>,
    /// Its figures.
    pub figures: Vec<NamedFigure>,
}

impl Section {
    /// A section of paragraphs only.
    pub fn of_words(heading: &str, paragraphs: Vec<String>) -> Self {
        Self {
            heading: heading.to_owned(),
            paragraphs,
            listing: None,
            tables: Vec::new(),
            figures: Vec::new(),
        }
    }
}

/// What a report says.
#[derive(Clone, Debug, PartialEq)]
pub struct Report {
    /// Its title.
    pub title: String,
    /// A line below it: when, by which version.
    pub made: String,
    /// Label of simulated recordings.
    pub simulated: Option<String>,
    /// Remark on the campaign.
    pub note: Option<String>,
    /// What a reader must know before the rest.
    pub findings: Vec<FindingOutcome>,
    /// What was left out.
    pub failed: Vec<FailureOutcome>,
    /// The rest.
    pub sections: Vec<Section>,
}

/// Everything but the colours.
const STYLE: &str = "
body { margin: 0 auto; max-width: 52rem; padding: 1.5rem; line-height: 1.5;
  font-family: Georgia, 'Times New Roman', serif; color: var(--figure-text);
  background: var(--figure-background); }
h1, h2, h3, nav, table, figcaption, .made { font-family: Helvetica, Arial, 'Liberation Sans', sans-serif; }
h1 { font-size: 1.6rem; line-height: 1.25; margin-bottom: 0.2rem; }
h2 { font-size: 1.2rem; margin-top: 2.2rem; border-bottom: 1px solid var(--figure-frame); }
.made { font-size: 0.85rem; opacity: 0.85; }
.note { white-space: pre-line; }
.simulated { border: 2px solid var(--series-2); padding: 0.4rem 0.8rem; font-weight: bold; }
nav ul { columns: 2; padding-left: 1.2rem; font-size: 0.9rem; }
a { color: var(--series-1); }
.table { overflow-x: auto; margin: 1rem 0; }
table { border-collapse: collapse; font-size: 0.8rem; font-variant-numeric: tabular-nums; }
caption { text-align: left; padding-bottom: 0.3rem; font-weight: bold; }
th, td { padding: 0.15rem 0.7rem 0.15rem 0; text-align: right; white-space: nowrap; vertical-align: top; }
th:first-child, td:first-child { text-align: left; }
thead th { border-bottom: 1px solid var(--figure-frame); }
th.words, td.words { text-align: left; }
figure { margin: 1.5rem 0; }
figure svg { display: block; max-width: 100%; height: auto; }
figcaption { font-size: 0.85rem; margin-top: 0.4rem; }
pre { overflow-x: auto; font-size: 0.75rem; border: 1px solid var(--figure-grid); padding: 0.6rem; }
code { font-size: 0.85em; overflow-wrap: anywhere; }
@page { margin: 16mm 18mm; }
@media print { body { max-width: none; padding: 0; font-size: 10pt; line-height: 1.35; }
  nav { display: none; } p, li { orphans: 3; widows: 3; } h2 { margin-top: 1.2rem; }
  h2, h2 + p, caption, thead { break-after: avoid; } thead { display: table-header-group; }
  tr { break-inside: avoid; } pre { white-space: pre-wrap; font-size: 8pt; overflow: visible; }
  .table { overflow: visible; } table { font-size: 7.5pt; }
  th, td { white-space: normal; padding-right: 0.5em; }
  figure { margin: 0.8rem 0; } figure.short { break-inside: avoid; }
  figure svg { break-inside: avoid; break-after: avoid; }
  figcaption { break-before: avoid; break-inside: avoid; font-size: 8.5pt; } }
";

/// The report as an HTML file.
pub fn html_of_report(report: &Report) -> String {
    let colours = format!(
        ":root {{ color-scheme: light dark; {} }}\n\
         @media screen and (prefers-color-scheme: dark) {{ :root {{ {} }} }}\n",
        declarations(&LIGHT),
        declarations(&DARK)
    );
    let page = html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                meta http-equiv="Content-Security-Policy"
                    content="default-src 'none'; style-src 'unsafe-inline'; img-src data:";
                title { (report.title) }
                style { (PreEscaped(colours + STYLE)) }
            }
            body {
                header {
                    h1 { (report.title) }
                    p class="made" { (report.made) }
                    @if let Some(label) = &report.simulated {
                        p class="simulated" { "Simulated recordings: " (label) }
                    }
                    @if let Some(note) = &report.note {
                        p class="note" { b { "Note: " } (note) }
                    }
                }
                nav aria-label="Contents" {
                    ul {
                        li { a href="#findings" { "Findings" } }
                        @for (index, section) in report.sections.iter().enumerate() {
                            li { a href={ "#part-" (index + 1) } { (section.heading) } }
                        }
                    }
                }
                main {
                    (findings(report))
                    @for (index, part) in report.sections.iter().enumerate() {
                        section id={ "part-" (index + 1) } {
                            (section(part, numbers_before(&report.sections[..index])))
                        }
                    }
                }
            }
        }
    };
    page.into_string()
}

fn gravest_first(findings: &[FindingOutcome]) -> Vec<&FindingOutcome> {
    let mut sorted: Vec<&FindingOutcome> = findings.iter().collect();
    sorted.sort_by_key(|finding| finding.severity);
    sorted
}

fn words(finding: &FindingOutcome) -> Markup {
    html! {
        em { (finding.severity.word()) } " " strong { (finding.code) } ": " (finding.message)
    }
}

fn findings(report: &Report) -> Markup {
    html! {
        section id="findings" {
            h2 { "Findings" }
            @if report.findings.is_empty() && report.failed.is_empty() {
                p { "Nothing was found that a reader would have to know." }
            } @else {
                ul {
                    @for finding in gravest_first(&report.findings) {
                        li { (words(finding)) }
                    }
                    @for failure in &report.failed {
                        li {
                            strong { "not fitted" } ": " (failure.id) ": " (failure.message)
                            @if !failure.findings.is_empty() {
                                ul {
                                    @for finding in gravest_first(&failure.findings) {
                                        li { (words(finding)) }
                                    }
                                }
                            }
                        }
                    }
                }
            }
        }
    }
}

/// Tables and figures of sections: what comes next is numbered after them.
fn numbers_before(sections: &[Section]) -> (usize, usize) {
    let tables = sections.iter().map(|own| own.tables.len()).sum();
    (tables, sections.iter().map(|own| own.figures.len()).sum())
}

/// * `tables`, `figures`: how many come before it
fn section(section: &Section, (tables, figures): (usize, usize)) -> Markup {
    html! {
        h2 { (section.heading) }
        @for paragraph in &section.paragraphs { p { (paragraph) } }
        @if let Some(listing) = &section.listing { pre { (listing) } }
        @for (place, table) in section.tables.iter().enumerate() {
            (table_markup(table, tables + place + 1))
        }
        @for (place, figure) in section.figures.iter().enumerate() {
            @let parts = elements_of_figure(&figure.figure, &PAGE, Width::PAGE);
            figure id=(figure.name) class=[(parts.len() == 1).then_some("short")] {
                @for part in parts { (PreEscaped(part)) }
                figcaption {
                    strong { "Figure " (figures + place + 1) ". " }
                    (figure.caption) " Data: " code { "figures/" (figure.name) ".csv" } "."
                }
            }
        }
    }
}

fn table_markup(table: &CaptionedTable, number: usize) -> Markup {
    let cells = &table.cells;
    let class = |column: usize| (column > 0 && !is_of_numbers(cells, column)).then_some("words");
    html! {
        // Reached by the keyboard, so that a wide table can be scrolled without a mouse.
        div class="table" tabindex="0" role="region" aria-label=(table.caption) {
            table {
                caption { "Table " (number) ". " (table.caption) }
                thead { tr { @for (index, heading) in cells.header.iter().enumerate() {
                    th scope="col" class=[class(index)] { (heading) }
                } } }
                tbody {
                    @for row in &cells.rows {
                        tr {
                            @for (index, cell) in row.iter().enumerate() {
                                @if index == 0 {
                                    th scope="row" { (cell) }
                                } @else {
                                    td class=[class(index)] { (cell) }
                                }
                            }
                        }
                    }
                }
            }
        }
    }
}

/// Whether every cell of a column is a number, with what belongs to it, or a dash.
fn is_of_numbers(cells: &Cells, column: usize) -> bool {
    let filled = |cell: &&String| !matches!(cell.as_str(), "" | "-");
    let column = cells.rows.iter().filter_map(|row| row.get(column));
    column.filter(filled).all(|cell| {
        let digits = cell.trim_start_matches(['-', '\u{2212}', '+', '(', '<', '>', ' ']);
        digits.starts_with(|c: char| c.is_ascii_digit())
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn closed_form_a_column_is_flush_on_one_side() {
        let row = |cells: [&str; 4]| cells.map(str::to_owned).to_vec();
        let table = CaptionedTable {
            caption: "Options".to_owned(),
            cells: Cells {
                header: row(["option", "value", "k (N/m¹˙⁵)", "p"]),
                rows: vec![
                    row(["laws", "hertz", "746000 ± 1300", "< 0.001"]),
                    row(["seed", "12", "-", "0.034"]),
                ],
            },
        };
        let page = table_markup(&table, 1).into_string();
        // The column of words and numbers is one of words, heading and all.
        assert_eq!(page.matches(r#"class="words""#).count(), 3, "{page}");
        assert!(page.contains(r#"<td class="words">12</td>"#), "{page}");
        assert!(page.contains("<td>&lt; 0.001</td>"), "{page}");
    }

    /// What comes from files is words on the page, and nothing is fetched.
    #[test]
    fn closed_form_words_of_files_are_no_markup_and_nothing_is_fetched() {
        let hostile = "<script>alert('x')</script> & \"q\"";
        let report = Report {
            title: hostile.to_owned(),
            made: String::new(),
            simulated: None,
            note: None,
            findings: vec![FindingOutcome::new("clipped", hostile)],
            failed: Vec::new(),
            sections: vec![Section {
                tables: vec![CaptionedTable {
                    caption: hostile.to_owned(),
                    cells: Cells {
                        header: vec![hostile.to_owned()],
                        rows: vec![vec![hostile.to_owned()]],
                    },
                }],
                ..Section::of_words(hostile, vec![hostile.to_owned()])
            }],
        };
        let page = html_of_report(&report);
        assert!(!page.contains("<script"), "{page}");
        assert_eq!(page.matches("&lt;script&gt;").count(), 10, "{page}");
        for fetched in ["http://", "https://", "src=", "@import", "url("] {
            assert!(!page.contains(fetched), "{fetched}");
        }
    }
}
