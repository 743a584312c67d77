//! Results of `fit` as CSV: one row per impact and law.

use crate::result::outcome::{CampaignOutcome, ImpactOutcome};
use windfall_files::error::Error;
use windfall_files::table::write::csv_text;

/// Columns of derived quantities: name, column.
const DERIVED: [(&str, &str); 12] = [
    ("impact_velocity", "impact_velocity_m_s"),
    ("rebound_velocity", "rebound_velocity_m_s"),
    ("restitution", "restitution"),
    ("contact_duration", "contact_duration_s"),
    ("peak_force", "peak_force_N"),
    ("max_displacement", "max_displacement_m"),
    ("impact_energy", "impact_energy_J"),
    ("elastic_energy", "elastic_energy_J"),
    ("absorbed_energy", "absorbed_energy_J"),
    ("impulse", "impulse_N_s"),
    ("loading_energy", "loading_energy_J"),
    ("hysteresis_energy", "hysteresis_energy_J"),
];

/// The table of impacts.
///
/// Parameters carry their unit in a column beside them, because it depends on
/// the law. Simulated recordings are marked in every row.
///
/// # Errors
/// None in practice: the text is written to memory.
pub fn csv_of_campaign(outcome: &CampaignOutcome) -> Result<String, Error> {
    let names = parameter_names(outcome);
    let mut header: Vec<String> = ["id", "specimen", "group", "file", "law"]
        .map(str::to_owned)
        .to_vec();
    for name in &names {
        header.extend(["", "_sd", "_low", "_high", "_unit"].map(|end| format!("{name}{end}")));
    }
    header.extend(DERIVED.map(|(_, column)| column.to_owned()));
    header.extend(["restitution_delivered", "restitution_nominal"].map(str::to_owned));
    header.extend(["cost", "samples", "converged", "findings", "simulated"].map(str::to_owned));
    let rows = outcome
        .impacts
        .iter()
        .map(|impact| row_of(impact, &names, outcome));
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
                number(estimate.sd),
                number(estimate.low),
                number(estimate.high),
                estimate.unit.clone(),
            ]),
        }
    }
    for (name, _) in DERIVED {
        row.push(number(impact.derived.get(name).copied().flatten()));
    }
    // What the fitted law gives, beside what it takes as a parameter.
    for name in ["restitution", "nominal_restitution"] {
        row.push(number(impact.fitted.get(name).copied().flatten()));
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

fn number(value: Option<f64>) -> String {
    value.map_or_else(String::new, |value| value.to_string())
}

fn parameter_names(outcome: &CampaignOutcome) -> Vec<&str> {
    let mut names: Vec<&str> = Vec::new();
    for (name, _) in outcome
        .impacts
        .iter()
        .flat_map(|impact| &impact.parameters.0)
    {
        if !names.contains(&name.as_str()) {
            names.push(name);
        }
    }
    names
}
