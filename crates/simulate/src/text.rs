//! Simulated impacts and motions as text, CSV and JSON.

use crate::impact::{SimulatedImpact, SimulatedMotion};
use crate::motion::{MotionOutcome, MovingImpact, Samples};
use windfall_files::error::Error;
use windfall_files::found::FindingOutcome;
use windfall_files::table::write::csv_text;
use windfall_files::text::number::plain;
use windfall_files::text::table::{finding_lines, table_text};

/// A value of an impact: name, value (NaN where there is none), unit.
pub(crate) type Row = (&'static str, f64, &'static str);

/// Rows under the names of fields: `rows![of impact: peak_force "N", impulse "N s"]`.
macro_rules! rows {
    [of $impact:ident: $($field:ident $unit:literal),+ $(,)?] => {
        vec![$((stringify!($field), $impact.$field, $unit)),+]
    };
}
pub(crate) use rows;

fn rows_of(impact: &SimulatedImpact) -> Vec<Row> {
    let mut rows = rows![of impact:
        effective_mass "kg",
        impact_velocity "m/s",
        peak_force "N",
        time_of_peak_force "s",
        max_displacement "m",
        time_of_max_displacement "s",
        contact_duration "s",
        final_displacement "m",
        separation_velocity "m/s",
        restitution "1",
    ];
    if let Some(nominal) = impact.nominal_restitution {
        rows.push(("nominal_restitution", nominal, "1"));
    }
    rows.extend(rows![of impact: absorbed_energy "J"]);
    if impact.driving_work != 0.0 {
        rows.push(("driving_work", impact.driving_work, "J"));
    }
    rows.extend(rows![of impact: impulse "N s"]);
    rows
}

/// A simulated impact as text.
pub fn text_of_simulation(impact: &SimulatedImpact) -> String {
    let header = ["quantity", "value", "unit"].map(str::to_owned);
    let lines = rows_of(impact).into_iter().map(|(name, value, unit)| {
        let name = match (name, impact.nominal_restitution) {
            ("restitution", Some(_)) => "restitution (delivered)".to_owned(),
            ("nominal_restitution", _) => "restitution (nominal, the parameter)".to_owned(),
            (name, _) => name.replace('_', " "),
        };
        vec![name, shown(value), unit.to_owned()]
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
pub fn findings_text(findings: &[FindingOutcome]) -> String {
    let lines = finding_lines(findings).map(|line| format!("\n{line}"));
    let text: String = lines.collect();
    match text.is_empty() {
        true => text,
        false => text + "\n",
    }
}

/// Below this a number of a table is rounding of zero; SI.
const ROUNDING: f64 = 1e-15;

/// A number by the rule of the terminal.
pub(crate) fn shown(value: f64) -> String {
    match value.abs() < ROUNDING {
        true => "0".to_owned(),
        false => plain(value),
    }
}

/// A simulated impact as CSV, one row, units in the header.
pub fn csv_of_simulation(impact: &SimulatedImpact) -> Result<String, Error> {
    let rows = rows_of(impact);
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
pub(crate) fn column(name: &str, unit: &str) -> String {
    match unit {
        "1" => name.to_owned(),
        unit => format!("{name}_{}", unit.replace(['/', ' '], "_")),
    }
}

/// A column of a motion: name, unit, values.
pub(crate) type Column<'a> = (&'static str, &'static str, &'a [f64]);

fn motion_columns(motion: &SimulatedMotion) -> [Column<'_>; 5] {
    let t = &motion.trajectory;
    [
        ("time", "s", &t.times),
        ("displacement", "m", &t.displacement),
        ("rate", "m/s", &t.rate),
        ("force", "N", &t.force),
        ("acceleration", "m/s2", &t.acceleration),
    ]
}

/// A simulated motion as CSV.
pub fn csv_of_motion(motion: &SimulatedMotion) -> Result<String, Error> {
    motion_csv(&motion_columns(motion))
}

/// A simulated motion with its summary, as JSON shows it.
pub fn outcome_of_motion(motion: &SimulatedMotion) -> MotionOutcome {
    MotionOutcome::Impact(MovingImpact {
        simulated: true,
        impact: motion.impact.clone(),
        motion: samples(&motion_columns(motion)),
    })
}

/// A cell of a table; blank where there is no value.
pub(crate) fn number_or_blank(value: f64) -> String {
    match value.is_finite() {
        true => value.to_string(),
        false => String::new(),
    }
}

/// A motion as CSV, with blank cells where there is no value.
pub(crate) fn motion_csv(columns: &[Column]) -> Result<String, Error> {
    let header: Vec<String> = columns
        .iter()
        .map(|(name, unit, _)| column(name, unit))
        .collect();
    let samples = columns.first().map_or(0, |(_, _, times)| times.len());
    let row = |i: usize| {
        columns
            .iter()
            .map(move |(_, _, values)| number_or_blank(values[i]))
    };
    csv_text(&header, (0..samples).map(|i| row(i).collect()))
}

/// Columns under their names.
pub(crate) fn samples(columns: &[Column]) -> Samples {
    let columns = columns.iter();
    Samples(
        columns
            .map(|(name, _, values)| (*name, values.to_vec()))
            .collect(),
    )
}
