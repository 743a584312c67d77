//! What the report of a campaign that fits no impacts says.

use crate::listed::{LISTED, left_out};
use windfall_draw::page::{CaptionedTable, Section};
use windfall_measure::measured::{MeasuredItem, MeasuredOutcome, ShownValue, laws_of};
use windfall_measure::run::ReportedItems;
use windfall_measure::text::{groups_cells, items_cells, of_law, spread_items};

/// Sections on such a campaign.
pub fn sections_of_items(reported: &ReportedItems) -> Vec<Section> {
    let outcome = &reported.outcome;
    let mut sections = vec![
        Section::of_words("Methods", reported.methods.clone()),
        Section {
            tables: tables_of_whole(outcome),
            ..Section::of_words("Results", Vec::new())
        },
    ];
    if !reported.figures.is_empty() {
        sections.push(Section {
            figures: reported.figures.clone(),
            ..Section::of_words("Figures", vec![reported.shown.clone()])
        });
    }
    sections.push(every_item(outcome));
    sections
}

/// Tables of the groups, of the whole campaign and of its specimens.
pub fn tables_of_whole(outcome: &MeasuredOutcome) -> Vec<CaptionedTable> {
    let mut tables = Vec::new();
    let (shown, items) = spread_items(outcome);
    for law in laws_of(&outcome.impacts) {
        if of_law(items, law).len() > 1 {
            let cells = groups_cells(outcome, law, (shown, items));
            tables.extend((cells.header.len() > 2).then(|| CaptionedTable {
                caption: format!("{law}: mean ± SD (SD in % of the mean)"),
                cells,
            }));
        }
    }
    let shown = outcome.shown.specimens;
    let (whole, specimens) = (&outcome.whole, &outcome.specimens);
    tables.extend(tables_of("campaign", "Over the campaign", whole, shown));
    tables.extend(tables_of("specimen", "Each fruit", specimens, shown));
    tables
}

/// Tables of every recording and every part of one.
///
/// * `title`: "Each recording", or what else they are
pub fn tables_of_each(outcome: &MeasuredOutcome, title: &str) -> Vec<CaptionedTable> {
    let shown = outcome.shown;
    let mut tables = tables_of("recording", title, &outcome.impacts, shown.items);
    let parts = tables_of("part", "Each bounce", &outcome.parts, shown.parts);
    tables.extend(parts);
    tables
}

fn every_item(outcome: &MeasuredOutcome) -> Section {
    let rows = outcome.impacts.len().max(outcome.parts.len());
    let words = left_out(rows, "impacts.csv and results.json");
    Section {
        tables: tables_of_each(outcome, "Each recording"),
        ..Section::of_words("Each recording", words.into_iter().collect())
    }
}

fn tables_of(
    what: &str,
    title: &str,
    items: &[MeasuredItem],
    shown: &[ShownValue],
) -> Vec<CaptionedTable> {
    let laws = laws_of(items).into_iter();
    let tables = laws.filter_map(|law| {
        let own = of_law(items, law);
        (own.len() <= LISTED).then(|| CaptionedTable {
            caption: format!("{title}, {law} (± standard uncertainty)"),
            cells: items_cells(what, &own, shown),
        })
    });
    tables.collect()
}
