//! Results of campaigns that fit no impacts, as text and as CSV.

use crate::measured::{
    MeasuredItem, MeasuredOutcome, MeasuredValue, ShownValue, laws_of, spread_of, value_of,
};
use itertools::Itertools;
use std::fmt::Write;
use windfall_campaign::settings::kind::CampaignKind;
use windfall_files::error::Error;
use windfall_files::finding_kind::{FindingKind, FoundOn, finding_kinds};
use windfall_files::found::FindingOutcome;
use windfall_files::table::write::{csv_text, number_cell};
use windfall_files::text::number::{spread_percent, value_and_sd};
use windfall_files::text::table::{
    Cells, failures_list, findings_list, header_of, page_tables, title_lines,
};

/// More results than this are shown as groups only.
const LISTED: usize = 40;

/// Tables for people: recordings, specimens, the whole, findings.
pub fn text_of_measured(outcome: &MeasuredOutcome) -> String {
    let mut text = title_lines(
        &outcome.campaign,
        outcome.simulated.as_deref(),
        outcome.note.as_deref(),
    );
    let of_specimens = outcome.shown.specimens;
    for law in laws_of(&outcome.impacts) {
        let items = of_law(&outcome.impacts, law);
        let (each, over) = match of_taps(outcome) {
            true => ("tap", "fruit"),
            false => ("recording", "recordings"),
        };
        text += &match items.len() {
            n if n > LISTED => format!("\n{law}: {n} results; each: --format csv or json.\n"),
            _ => format!(
                "\n{law}: each {each} (± standard deviation of the estimate)\n{}\n",
                items_table(each, &items, outcome.shown.items)
            ),
        };
        let (shown, spread) = spread_items(outcome);
        if of_law(spread, law).len() > 1 {
            let Cells { header, rows } = groups_cells(outcome, law, (shown, spread));
            let table = page_tables(&header, &rows, &[0]);
            let title = format!("Mean ± SD over the {over} (SD in % of the mean)");
            let _ = writeln!(text, "\n{title}:\n{table}");
        }
    }
    for (what, items, shown) in [
        ("part", &outcome.parts, outcome.shown.parts),
        ("specimen", &outcome.specimens, of_specimens),
        ("campaign", &outcome.whole, of_specimens),
    ] {
        for law in laws_of(items) {
            let items = of_law(items, law);
            text += &match items.len() {
                n if n > LISTED && what == "part" => {
                    format!("\n{law}: {n} results; each: --format json.\n")
                }
                _ => {
                    let table = items_table(what, &items, shown);
                    format!("\n{law}, for each {what}:\n{table}\n")
                }
            };
        }
    }
    text + &findings_text(outcome)
}

/// Items of a law or method.
pub fn of_law<'a>(items: &'a [MeasuredItem], law: &str) -> Vec<&'a MeasuredItem> {
    items.iter().filter(|item| item.law == law).collect()
}

/// A value with as many digits as its uncertainty lets it have, scaled.
fn shown_value(value: &MeasuredValue, factor: f64) -> String {
    value_and_sd(value.value * factor, value.sd.map(|sd| sd * factor))
}

fn items_table(what: &str, items: &[&MeasuredItem], shown: &[ShownValue]) -> String {
    let cells = items_cells(what, items, shown);
    // Words stand last: they have no place among the headings of values.
    let words = words_of(items.iter().copied()).len();
    let mut left = vec![0];
    left.extend(is_named(what, items).then_some(1));
    left.extend(cells.header.len() - words..cells.header.len());
    page_tables(&cells.header, &cells.rows, &left)
}

/// Names of the words that items have.
fn words_of<'a>(items: impl IntoIterator<Item = &'a MeasuredItem>) -> Vec<&'a str> {
    let words = items.into_iter().flat_map(|item| item.words.names());
    words.unique().collect()
}

/// Whether items have a name beside that of their specimen.
fn is_named(what: &str, items: &[&MeasuredItem]) -> bool {
    ["recording", "tap"].contains(&what) && items.iter().any(|item| item.id != item.specimen)
}

/// Items with the values that are shown and their words, row by row.
///
/// * `what`: "recording", "tap", "part", "specimen" or "campaign"
pub fn items_cells(what: &str, items: &[&MeasuredItem], shown: &[ShownValue]) -> Cells {
    let present: Vec<&ShownValue> = shown
        .iter()
        .filter(|column| {
            items
                .iter()
                .any(|item| value_of(item, column.name).is_some())
        })
        .collect();
    let (words, named) = (words_of(items.iter().copied()), is_named(what, items));
    let mut header = vec![what.to_owned()];
    header.extend(named.then(|| "specimen".to_owned()));
    header.extend(present.iter().map(|column| column.heading.to_owned()));
    header.extend(words.iter().map(|name| (*name).to_owned()));
    let rows: Vec<Vec<String>> = items
        .iter()
        .map(|item| {
            let mut row = vec![item.id.clone()];
            row.extend(named.then(|| item.specimen.clone()));
            row.extend(present.iter().map(|column| {
                let value = value_of(item, column.name);
                value.map_or_else(|| "-".to_owned(), |v| shown_value(v, column.factor))
            }));
            let word = |name: &&str| item.words.get(name).cloned().unwrap_or_default();
            row.extend(words.iter().map(word));
            row
        })
        .collect();
    Cells { header, rows }
}

fn of_taps(outcome: &MeasuredOutcome) -> bool {
    outcome.kind == CampaignKind::Acoustic.name()
}

/// The items whose groups have a spread (of taps: the fruit), with the values shown.
pub fn spread_items(outcome: &MeasuredOutcome) -> (&'static [ShownValue], &[MeasuredItem]) {
    match of_taps(outcome) {
        true => (outcome.shown.specimens, &outcome.specimens),
        false => (outcome.shown.items, &outcome.impacts),
    }
}

/// Mean and spread of the values that are shown, for each group and for all.
pub fn groups_cells(
    outcome: &MeasuredOutcome,
    law: &str,
    (shown, items): (&[ShownValue], &[MeasuredItem]),
) -> Cells {
    let mut groups: Vec<_> = outcome
        .groups
        .iter()
        .filter(|g| g.law == law)
        .cloned()
        .collect();
    if groups.len() > 1 {
        groups.push(spread_of(items, law, None));
    }
    let present: Vec<&ShownValue> = shown
        .iter()
        .filter(|column| groups.iter().any(|g| g.values.get(column.name).is_some()))
        .collect();
    let mut header = vec!["group".to_owned(), "n".to_owned()];
    header.extend(present.iter().map(|column| column.heading.to_owned()));
    let rows: Vec<Vec<String>> = groups
        .iter()
        .map(|group| {
            let name = group.group.clone().unwrap_or_else(|| "all".to_owned());
            let mut row = vec![name, group.recordings.to_string()];
            row.extend(present.iter().map(|column| {
                group.values.get(column.name).map_or_else(
                    || "-".to_owned(),
                    |s| spread_percent(s.mean * column.factor, s.cv),
                )
            }));
            row
        })
        .collect();
    Cells { header, rows }
}

/// Each kind of finding once, with how many share it, and what failed.
fn findings_text(outcome: &MeasuredOutcome) -> String {
    let findings = findings_list(&findings_of_measured(outcome));
    findings + &failures_list("not evaluated", &outcome.failed, 4)
}

/// [`finding_kinds_of_measured`] in words.
pub fn findings_of_measured(outcome: &MeasuredOutcome) -> Vec<FindingOutcome> {
    let kinds = finding_kinds_of_measured(outcome);
    kinds.iter().map(FindingKind::told).collect()
}

/// Findings of the whole, then one of each kind on items, the gravest first.
pub fn finding_kinds_of_measured(outcome: &MeasuredOutcome) -> Vec<FindingKind> {
    let items = outcome
        .impacts
        .iter()
        .chain(&outcome.parts)
        .chain(&outcome.specimens)
        .chain(&outcome.whole);
    let found = items.flat_map(|item| {
        let findings = item.findings.iter();
        findings.map(|finding| FoundOn {
            finding,
            id: &item.id,
            law: "",
        })
    });
    // Items of the whole and of specimens stand beside those of recordings.
    finding_kinds(&outcome.findings, found, &[], None)
}

/// One row per recording and law.
pub fn csv_of_measured(outcome: &MeasuredOutcome) -> Result<String, Error> {
    csv_of_items(&outcome.impacts, outcome.simulated.as_deref())
}

/// One row per item; units stand in the headings where all items share them.
pub fn csv_of_items(items: &[MeasuredItem], simulated: Option<&str>) -> Result<String, Error> {
    let columns = columns_of(items);
    let mut header = header_of(&["id", "specimen", "group", "file", "law"]);
    for column in &columns {
        header.push(column.heading.clone());
        header.extend(column.sd.then(|| format!("{}_sd", column.name)));
        if column.interval {
            header.extend(["_low", "_high"].map(|end| format!("{}{end}", column.name)));
        }
        header.extend(column.unit.then(|| format!("{}_unit", column.name)));
    }
    let words = words_of(items);
    // A word may have the name of a number: the column of the number keeps it.
    header.extend(words.iter().map(
        |word| match columns.iter().any(|column| column.heading == *word) {
            true => format!("{word}_text"),
            false => (*word).to_owned(),
        },
    ));
    header.extend(["findings", "simulated"].map(str::to_owned));
    let rows = items.iter().map(|item| {
        let mut row = vec![
            item.id.clone(),
            item.specimen.clone(),
            item.group.clone().unwrap_or_default(),
            item.file.clone(),
            item.law.clone(),
        ];
        for column in &columns {
            let value = value_of(item, column.name);
            row.push(number_cell(value.map(|v| v.value)));
            row.extend(column.sd.then(|| number_cell(value.and_then(|v| v.sd))));
            if column.interval {
                row.push(number_cell(value.and_then(|v| v.low)));
                row.push(number_cell(value.and_then(|v| v.high)));
            }
            let unit = || value.map_or_else(String::new, |v| v.unit.clone());
            row.extend(column.unit.then(unit));
        }
        row.extend(
            words
                .iter()
                .map(|word| item.words.get(word).cloned().unwrap_or_default()),
        );
        let codes: Vec<&str> = item.findings.iter().map(|f| f.code.as_str()).collect();
        row.push(codes.join(" "));
        row.push(simulated.unwrap_or_default().to_owned());
        row
    });
    csv_text(&header, rows)
}

struct Column<'a> {
    name: &'a str,
    heading: String,
    sd: bool,
    interval: bool,
    /// Whether the unit stands in a column of its own.
    unit: bool,
}

fn columns_of(items: &[MeasuredItem]) -> Vec<Column<'_>> {
    let values = items
        .iter()
        .flat_map(|item| item.parameters.0.iter().chain(&item.derived.0));
    let names = values.map(|(name, _)| name.as_str()).unique();
    names
        .map(|name| {
            let values: Vec<&MeasuredValue> = items
                .iter()
                .filter_map(|item| value_of(item, name))
                .collect();
            // Parameters of laws have units that depend on the law.
            let parameter = items.iter().any(|item| item.parameters.get(name).is_some());
            let heading = match parameter {
                true => name.to_owned(),
                false => heading(name, &values[0].unit),
            };
            Column {
                name,
                heading,
                sd: values.iter().any(|value| value.sd.is_some()),
                interval: values.iter().any(|value| value.low.is_some()),
                unit: parameter,
            }
        })
        .collect()
}

/// "bioyield_force_N": the unit as it can stand in the name of a column.
pub fn heading(name: &str, unit: &str) -> String {
    match unit {
        "1" | "" => name.to_owned(),
        unit => format!(
            "{name}_{}",
            unit.replace(['/', ' '], "_").replace(['^', '(', ')'], "")
        ),
    }
}
