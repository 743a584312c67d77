//! The comparison of laws as text and CSV.

use crate::ranking::outcome::LawsOutcome;
use std::fmt::Write;
use windfall_files::error::Error;
use windfall_files::table::write::csv_text;
use windfall_files::text::number::plain;
use windfall_files::text::table::{finding_lines, page_tables, paragraph, title_lines};

/// Columns of the CSV.
const HEADER: &str = "law,delta_aicc,delta_bic,first_share,specimens_first,prediction_error,\
                      prediction_error_sd,residual_ratio,runs_z,parameters_per_impact,failed";

/// The comparison as text for a terminal.
pub fn text_of_laws(outcome: &LawsOutcome) -> String {
    let mut text = title_lines(&outcome.campaign, outcome.simulated.as_deref(), None);
    let _ = writeln!(
        text,
        "{} laws on {} impacts of {} velocity level{}, each impact with parameters of its own:\n",
        outcome.laws.len(),
        outcome.impacts,
        outcome.levels,
        if outcome.levels == 1 { "" } else { "s" }
    );
    let header = [
        "law",
        "ΔAICc",
        "ΔBIC",
        "first in (%)",
        "specimens",
        "unseen velocity (% of peak)",
        "residual/noise",
        "runs z",
    ];
    let rows: Vec<Vec<String>> = outcome
        .laws
        .iter()
        .zip(&outcome.specimens_first)
        .map(|(law, first)| {
            let predicted = match (law.prediction, law.prediction_sd) {
                (Some(value), Some(sd)) => format!("{:.2} ± {:.2}", 100.0 * value, 100.0 * sd),
                _ => "-".to_owned(),
            };
            vec![
                law.law.clone(),
                format!("{:.1}", law.aicc),
                format!("{:.1}", law.bic),
                format!("{:.1}", 100.0 * law.first_share),
                first.to_string(),
                predicted,
                plain(law.residual_ratio),
                format!("{:.1}", law.runs_z),
            ]
        })
        .collect();
    let header = header.map(str::to_owned);
    let _ = writeln!(text, "{}\n", page_tables(&header, &rows, &[0]));
    let _ = writeln!(text, "{}", paragraph(&outcome.meaning, 0));
    text += "first in: share of bootstrap resamples in which the law ranks first; specimens: how many\n\
             it ranks first for; unseen velocity: prediction error of the force at a held-out level;\n\
             runs z: structure of the residuals along the loop, none above -2.\n";
    for law in outcome.laws.iter().filter(|law| law.failed > 0) {
        let _ = writeln!(
            text,
            "{} could not be fitted to {} impacts.",
            law.law, law.failed
        );
    }
    for failure in &outcome.failed {
        let line = format!("not used: {}: {}", failure.id, failure.message);
        let _ = writeln!(text, "{}", paragraph(&line, 2));
    }
    for line in finding_lines(&outcome.findings) {
        let _ = writeln!(text, "{}", paragraph(&line, 2));
    }
    text
}

/// The comparison as CSV, one line per law.
///
/// # Errors
/// A cell cannot be written.
pub fn csv_of_laws(outcome: &LawsOutcome) -> Result<String, Error> {
    let optional = |value: Option<f64>| value.map_or_else(String::new, |v| v.to_string());
    let rows = outcome
        .laws
        .iter()
        .zip(&outcome.specimens_first)
        .map(|(law, first)| {
            vec![
                law.law.clone(),
                law.aicc.to_string(),
                law.bic.to_string(),
                law.first_share.to_string(),
                first.to_string(),
                optional(law.prediction),
                optional(law.prediction_sd),
                law.residual_ratio.to_string(),
                law.runs_z.to_string(),
                law.parameters_per_impact.to_string(),
                law.failed.to_string(),
            ]
        });
    let header: Vec<String> = HEADER.split(',').map(str::to_owned).collect();
    csv_text(&header, rows)
}
