//! Simulated impacts and motions as text, CSV and JSON.

use crate::impact::{SimulatedImpact, SimulatedMotion};
use windfall_files::error::Error;
use windfall_files::found::FindingOutcome;
use windfall_files::named::Named;
use windfall_files::table::write::csv_text;
use windfall_files::text::table::table_text;

/// Rows of a summary: name, value, unit.
fn rows(impact: &SimulatedImpact) -> Vec<(&'static str, f64, &'static str)> {
    let mut rows = vec![
        ("effective_mass", impact.effective_mass, "kg"),
        ("impact_velocity", impact.impact_velocity, "m/s"),
        ("peak_force", impact.peak_force, "N"),
        ("time_of_peak_force", impact.time_of_peak_force, "s"),
        ("max_displacement", impact.max_displacement, "m"),
        (
            "time_of_max_displacement",
            impact.time_of_max_displacement,
            "s",
        ),
        ("contact_duration", impact.contact_duration, "s"),
        ("final_displacement", impact.final_displacement, "m"),
        ("separation_velocity", impact.separation_velocity, "m/s"),
        ("restitution", impact.restitution, "1"),
    ];
    if let Some(nominal) = impact.nominal_restitution {
        rows.push(("nominal_restitution", nominal, "1"));
    }
    rows.push(("absorbed_energy", impact.absorbed_energy, "J"));
    rows.push(("impulse", impact.impulse, "N s"));
    rows
}

/// A simulated impact as text.
#[must_use]
pub fn text_of_simulation(impact: &SimulatedImpact) -> String {
    let header = ["quantity", "value", "unit"].map(str::to_owned);
    let lines = rows(impact).into_iter().map(|(name, value, unit)| {
        let name = match (name, impact.nominal_restitution) {
            ("restitution", Some(_)) => "restitution (delivered)".to_owned(),
            ("nominal_restitution", _) => "restitution (nominal, the parameter)".to_owned(),
            (name, _) => name.replace('_', " "),
        };
        vec![name, six_digits(value), unit.to_owned()]
    });
    format!(
        "simulated: {}, contact ends at {}\n\n{}\n{}",
        impact.law,
        impact.end,
        table_text(&header, lines, &[0, 2]),
        findings_text(&impact.findings)
    )
}

/// A line for each finding, after an empty one; nothing without findings.
#[must_use]
pub fn findings_text(findings: &[FindingOutcome]) -> String {
    let lines = findings
        .iter()
        .map(|finding| format!("\n{}: {}", finding.code, finding.message));
    let text: String = lines.collect();
    match text.is_empty() {
        true => text,
        false => text + "\n",
    }
}

/// Below this a number of a table is rounding of zero; SI.
const ROUNDING: f64 = 1e-15;

/// Six significant digits.
#[must_use]
pub fn six_digits(value: f64) -> String {
    let size = value.abs();
    if size < ROUNDING {
        return "0".to_owned();
    }
    if !(1e-4..1e6).contains(&size) {
        return format!("{value:.5e}");
    }
    let decimals = (5 - size.log10().floor() as i32).clamp(0, 12) as usize;
    format!("{value:.decimals$}")
}

/// A simulated impact as CSV, one row, units in the header.
///
/// # Errors
/// None in practice: the text is written to memory.
pub fn csv_of_simulation(impact: &SimulatedImpact) -> Result<String, Error> {
    let rows = rows(impact);
    let header: Vec<String> = rows
        .iter()
        .map(|(name, _, unit)| column(name, unit))
        .collect();
    csv_text(
        &header,
        [rows.iter().map(|(_, value, _)| value.to_string()).collect()],
    )
}

/// "peak_force_N"; no unit for a pure number.
fn column(name: &str, unit: &str) -> String {
    match unit {
        "1" => name.to_owned(),
        unit => format!("{name}_{}", unit.replace(['/', ' '], "_")),
    }
}

/// A simulated motion as CSV.
///
/// # Errors
/// None in practice: the text is written to memory.
pub fn csv_of_motion(motion: &SimulatedMotion) -> Result<String, Error> {
    let header = [
        "time_s",
        "displacement_m",
        "rate_m_s",
        "force_N",
        "acceleration_m_s2",
    ];
    let t = &motion.trajectory;
    let rows = (0..t.times.len()).map(|i| {
        [
            t.times[i],
            t.displacement[i],
            t.rate[i],
            t.force[i],
            t.acceleration[i],
        ]
        .map(|value| value.to_string())
        .to_vec()
    });
    csv_text(&header.map(str::to_owned), rows)
}

/// A simulated motion with its summary as JSON.
#[must_use]
pub fn json_of_motion(motion: &SimulatedMotion) -> serde_json::Value {
    let t = &motion.trajectory;
    let columns = [
        ("time", &t.times),
        ("displacement", &t.displacement),
        ("rate", &t.rate),
        ("force", &t.force),
        ("acceleration", &t.acceleration),
    ];
    let columns = Named(
        columns
            .map(|(name, values)| (name.to_owned(), values))
            .to_vec(),
    );
    serde_json::json!({ "simulated": true, "impact": motion.impact, "motion": columns })
}
