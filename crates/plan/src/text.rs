//! Plans as text and CSV.

use crate::outcome::{PlanOutcome, PlanRow, ShareOutcome};
use windfall_files::error::Error;
use windfall_files::table::write::csv_text;
use windfall_files::text::number::plain;
use windfall_files::text::statistic::number;
use windfall_files::text::table::{findings_list, page_tables, paragraph};

/// "0.8012", simulated "0.801 (0.775 to 0.825)".
fn share_text(share: &ShareOutcome) -> String {
    match share.low.zip(share.high) {
        None => format!("{:.4}", share.value),
        Some((low, high)) => format!("{:.3} ({low:.3} to {high:.3})", share.value),
    }
}

/// "95 %".
pub(crate) fn percent(part: f64) -> String {
    // 0.29 × 100 is 28.999999999999996
    format!("{} %", (1e6 * part).round() / 1e4)
}

/// "1 impact", "4 impacts".
pub(crate) fn impacts_text(impacts: usize) -> String {
    match impacts {
        1 => "1 impact".to_owned(),
        several => format!("{several} impacts"),
    }
}

/// A column: its title and the cell of a row.
type Cell<'a> = (String, Box<dyn Fn(&PlanRow) -> String + 'a>);

fn columns(outcome: &PlanOutcome) -> Vec<Cell<'_>> {
    let any = |has: &dyn Fn(&PlanRow) -> bool| outcome.rows.iter().any(has);
    let mut columns: Vec<Cell> = vec![
        (
            "impacts each".into(),
            Box::new(|row| row.impacts.to_string()),
        ),
        (
            counted(outcome).into(),
            Box::new(|row| row.fruit.to_string()),
        ),
    ];
    if any(&|row| row.fruit_in_all != row.fruit) {
        columns.push(("fruit".into(), Box::new(|row| row.fruit_in_all.to_string())));
    }
    if any(&|row| row.impacts_in_all != row.fruit_in_all) {
        columns.push((
            "impacts".into(),
            Box::new(|row| row.impacts_in_all.to_string()),
        ));
    }
    if any(&|row| row.power.is_some()) {
        let cell = |row: &PlanRow| row.power.as_ref().map(share_text).unwrap_or_default();
        columns.push(("power".into(), Box::new(cell)));
    }
    if any(&|row| row.half_width.is_some()) {
        let title = match outcome.assurance {
            Some(assurance) => format!("half-width ({})", percent(assurance)),
            None => "half-width".to_owned(),
        };
        columns.push((
            title,
            Box::new(|row| row.half_width.map(number).unwrap_or_default()),
        ));
    }
    if any(&|row| row.detectable.is_some()) {
        let cell = |row: &PlanRow| row.detectable.map(number).unwrap_or_default();
        columns.push(("detectable".into(), Box::new(cell)));
    }
    for of in precisions(outcome) {
        let cell = move |row: &PlanRow| {
            let own = row.also.iter().find(|own| own.of == of);
            own.map(|own| number(own.value)).unwrap_or_default()
        };
        columns.push((of.to_owned(), Box::new(cell)));
    }
    let share = |of: fn(&PlanRow) -> usize| {
        move |row: &PlanRow| {
            let all = row.simulations.unwrap_or_default().max(1);
            percent((1000.0 * of(row) as f64 / all as f64).round() / 1000.0)
        }
    };
    if any(&|row| row.failed > 0) {
        columns.push(("failed".into(), Box::new(share(|row| row.failed))));
    }
    if any(&|row| row.singular > 0) {
        columns.push(("singular".into(), Box::new(share(|row| row.singular))));
    }
    if any(&|row| row.cost.is_some()) {
        columns.push((
            "cost".into(),
            Box::new(|row| row.cost.map(plain).unwrap_or_default()),
        ));
    }
    if any(&|row| row.best || row.reached == Some(false) || row.within_budget == Some(false)) {
        columns.push((String::new(), Box::new(mark)));
    }
    columns
}

/// Names of further precisions, which a study may lack.
fn precisions(outcome: &PlanOutcome) -> Vec<&str> {
    let mut names: Vec<&str> = Vec::new();
    for own in outcome.rows.iter().flat_map(|row| &row.also) {
        if !names.contains(&own.of.as_str()) {
            names.push(&own.of);
        }
    }
    names
}

/// Title of the column of fruit.
fn counted(outcome: &PlanOutcome) -> &'static str {
    match outcome.counted {
        "fruit in each group" => "per group",
        "fruit in the first group" => "first group",
        other => other,
    }
}

/// What is said of a row in its last column.
fn mark(row: &PlanRow) -> String {
    match (row.best, row.reached, row.within_budget) {
        (true, Some(true), _) => "cheapest",
        (true, _, _) => "best",
        (_, Some(false), _) => "too few",
        (_, _, Some(false)) => "too dear",
        _ => "",
    }
    .to_owned()
}

/// A plan as text.
pub fn text_of_plan(outcome: &PlanOutcome) -> String {
    let mut text = String::new();
    for line in &outcome.about {
        text += &(paragraph(line, 2) + "\n");
    }
    let wanted = match (outcome.wanted_power, outcome.wanted_half_width) {
        (Some(power), _) => Some(format!("a power of {power}")),
        (_, Some(width)) => Some(format!("{} of {}", outcome.half_width_of, plain(width))),
        _ => None,
    };
    let budget = outcome
        .budget
        .map(|budget| format!("a cost of at most {}", plain(budget)));
    let wanted: Vec<String> = wanted.into_iter().chain(budget).collect();
    if !wanted.is_empty() {
        text += &format!("wanted: {}\n", wanted.join(", "));
    }
    if outcome.rows.iter().any(|row| row.detectable.is_some()) {
        text += &format!(
            "detectable: the smallest effect that is found with a power of {}\n",
            outcome.detectable_power
        );
    }
    let columns = columns(outcome);
    let header: Vec<String> = columns.iter().map(|column| column.0.clone()).collect();
    let rows = outcome.rows.iter();
    let rows: Vec<Vec<String>> = rows
        .map(|row| columns.iter().map(|column| (column.1)(row)).collect())
        .collect();
    let left: Vec<usize> = match header.last() {
        Some(last) if last.is_empty() => vec![header.len() - 1],
        _ => Vec::new(),
    };
    text += &format!("\n{}\n", page_tables(&header, &rows, &left));
    text + &findings_list(&outcome.findings)
}

/// A plan as CSV: a line for each study.
///
/// # Errors
/// A cell cannot be written.
pub fn csv_of_plan(outcome: &PlanOutcome) -> Result<String, Error> {
    const HEADER: [&str; 20] = [
        "impacts",
        "fruit",
        "fruit_in_all",
        "impacts_in_all",
        "power",
        "power_se",
        "power_low",
        "power_high",
        "half_width",
        "half_width_se",
        "df",
        "detectable",
        "cost",
        "reached",
        "within_budget",
        "best",
        "simulations",
        "failed",
        "singular",
        "also",
    ];
    let given = |value: Option<f64>| value.map(|value| value.to_string()).unwrap_or_default();
    let known = |value: Option<bool>| value.map(|value| value.to_string()).unwrap_or_default();
    let rows = outcome.rows.iter().map(|row| {
        let also = row.also.iter();
        let also: Vec<String> = also
            .map(|own| format!("{}={}", own.of, own.value))
            .collect();
        vec![
            row.impacts.to_string(),
            row.fruit.to_string(),
            row.fruit_in_all.to_string(),
            row.impacts_in_all.to_string(),
            given(row.power.map(|power| power.value)),
            given(row.power.and_then(|power| power.se)),
            given(row.power.and_then(|power| power.low)),
            given(row.power.and_then(|power| power.high)),
            given(row.half_width),
            given(row.half_width_se),
            given(row.df),
            given(row.detectable),
            given(row.cost),
            known(row.reached),
            known(row.within_budget),
            row.best.to_string(),
            row.simulations.map(|n| n.to_string()).unwrap_or_default(),
            row.failed.to_string(),
            row.singular.to_string(),
            also.join("; "),
        ]
    });
    csv_text(&HEADER.map(str::to_owned), rows)
}
