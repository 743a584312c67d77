//! What was achieved, as text and CSV.

use crate::achieved::outcome::{AchievedEstimate, AchievedOutcome};
use crate::text::percent;
use windfall_files::error::Error;
use windfall_files::text::columns::{Column, csv_of_rows, given, text_of_rows};
use windfall_files::text::statistic::number;
use windfall_files::text::table::findings_list;
use windfall_tables::regress::mixed::VarianceOutcome;

/// "V", "mean of Gala", "Gala - Fuji".
fn name(own: &AchievedEstimate) -> String {
    match own.kind {
        "mean" => format!("mean of {}", own.name),
        _ => own.name.clone(),
    }
}

const ESTIMATES: [Column<AchievedEstimate>; 7] = [
    ("of", name),
    ("estimate", |own| number(own.estimate)),
    ("df", |own| number(own.df)),
    ("half-width", |own| number(own.half_width)),
    ("detectable", |own| given(own.detectable, number)),
    ("half the fruit", |own| {
        given(own.half_width_with_half, number)
    }),
    ("twice", |own| given(own.half_width_with_twice, number)),
];

const VARIANCES: [Column<VarianceOutcome>; 6] = [
    ("between", |row| row.group.clone()),
    ("", |row| row.kind.to_owned()),
    ("of", |row| row.of.clone()),
    ("value", |row| number(row.value)),
    ("from", |row| number(row.low)),
    ("to", |row| number(row.high)),
];

const CSV: [Column<AchievedEstimate>; 9] = [
    ("kind", |own| own.kind.to_owned()),
    ("name", |own| own.name.clone()),
    ("estimate", |own| own.estimate.to_string()),
    ("se", |own| own.se.to_string()),
    ("df", |own| own.df.to_string()),
    ("half_width", |own| own.half_width.to_string()),
    ("detectable", |own| plain_cell(own.detectable)),
    ("half_width_with_half", |own| {
        plain_cell(own.half_width_with_half)
    }),
    ("half_width_with_twice", |own| {
        plain_cell(own.half_width_with_twice)
    }),
];

fn plain_cell(value: Option<f64>) -> String {
    value.map(|value| value.to_string()).unwrap_or_default()
}

/// What was achieved, as text.
pub fn text_of_achieved(outcome: &AchievedOutcome) -> String {
    format!(
        "{}\n{} impacts on {} {}; intervals of {}\n\n{}\n\n\
         detectable: the smallest true value that a study of this precision finds with a power \
         of {}\nhalf the fruit, twice: about the half-width that so many would have given\n\n\
         Standard deviations, with profile intervals:\n{}\n{}",
        outcome.formula,
        outcome.impacts,
        outcome.fruit,
        outcome.by,
        percent(outcome.confidence),
        text_of_rows(&outcome.estimates, &ESTIMATES, &[0]),
        outcome.power,
        text_of_rows(&outcome.variances, &VARIANCES, &[0, 1, 2]),
        findings_list(&outcome.findings),
    )
}

/// What was achieved, as CSV: a line for each estimate.
///
/// # Errors
/// A cell cannot be written.
pub fn csv_of_achieved(outcome: &AchievedOutcome) -> Result<String, Error> {
    csv_of_rows(&outcome.estimates, &CSV)
}
