//! Results of `fit` as CSV: one row per impact and law.

use crate::result::outcome::{CampaignOutcome, ImpactOutcome};
use crate::result::quantity::{QUANTITIES, Quantity};
use itertools::Itertools;
use windfall_files::error::Error;
use windfall_files::table::data::LEFT_OUT_COLUMN;
use windfall_files::table::write::{csv_text, number_cell};
use windfall_files::text::table::header_of;

/// Quantities that have a column even when no impact has a value.
const ALWAYS: usize = 12;

/// The table of impacts.
///
/// Parameters carry their unit in a column beside them, because it depends on
/// the law. Simulated recordings are marked in every row.
pub fn csv_of_campaign(outcome: &CampaignOutcome) -> Result<String, Error> {
    let names = parameter_names(outcome);
    let mut header = header_of(&["id", "specimen", "group", "file", "law"]);
    for name in &names {
        header.extend(["", "_sd", "_low", "_high", "_unit"].map(|end| format!("{name}{end}")));
    }
    let (always, others) = QUANTITIES.split_at(ALWAYS);
    header.extend(always.iter().map(Quantity::column));
    header.extend(["restitution_delivered", "restitution_nominal"].map(str::to_owned));
    header.extend(["cost", "samples", "converged", "findings", "simulated"].map(str::to_owned));
    let any = |has: &dyn Fn(&ImpactOutcome) -> bool| outcome.impacts.iter().any(has);
    let others: Vec<&Quantity> = others
        .iter()
        .filter(|quantity| any(&|impact| impact.derived.get(quantity.name).is_some()))
        .collect();
    let uncertain: Vec<&Quantity> = QUANTITIES
        .iter()
        .filter(|quantity| any(&|impact| impact.derived_sd.get(quantity.name).is_some()))
        .collect();
    header.extend(others.iter().map(|quantity| quantity.column()));
    header.extend(uncertain.iter().map(|quantity| quantity.sd_column()));
    header.push(LEFT_OUT_COLUMN.to_owned());
    let rows = outcome.impacts.iter().map(|impact| {
        let mut row = row_of(impact, &names, outcome);
        row.extend(others.iter().map(|quantity| derived(impact, quantity)));
        let sd = |quantity: &&Quantity| number_cell(impact.derived_sd.get(quantity.name).copied());
        row.extend(uncertain.iter().map(sd));
        let reasons = impact.left_out.iter().map(|reason| reason.code.as_str());
        row.push(reasons.unique().join(" "));
        row
    });
    csv_text(&header, rows)
}

fn row_of(impact: &ImpactOutcome, names: &[&str], outcome: &CampaignOutcome) -> Vec<String> {
    let mut row = vec![
        impact.id.clone(),
        impact.specimen.clone(),
        impact.group.clone().unwrap_or_default(),
        impact.file.clone(),
        impact.law.clone(),
    ];
    for name in names {
        match impact.parameters.get(name) {
            None => row.extend(vec![String::new(); 5]),
            Some(estimate) => row.extend([
                estimate.value.to_string(),
                number_cell(estimate.sd),
                number_cell(estimate.low),
                number_cell(estimate.high),
                estimate.unit.clone(),
            ]),
        }
    }
    let always = &QUANTITIES[..ALWAYS];
    row.extend(always.iter().map(|quantity| derived(impact, quantity)));
    // What the fitted law gives, beside what it takes as a parameter.
    for name in ["restitution", "nominal_restitution"] {
        row.push(number_cell(impact.fitted(name)));
    }
    let codes: Vec<&str> = impact
        .findings
        .iter()
        .map(|finding| finding.code.as_str())
        .collect();
    row.extend([
        impact.cost.to_string(),
        impact.samples.to_string(),
        impact.converged.to_string(),
        codes.join(" "),
        outcome.simulated.clone().unwrap_or_default(),
    ]);
    row
}

fn derived(impact: &ImpactOutcome, quantity: &Quantity) -> String {
    number_cell(impact.derived(quantity.name))
}

fn parameter_names(outcome: &CampaignOutcome) -> Vec<&str> {
    let impacts = outcome.impacts.iter();
    let names = impacts.flat_map(|impact| impact.parameters.names());
    names.unique().collect()
}
