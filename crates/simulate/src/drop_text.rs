//! Simulated drops and their motions as text, CSV and JSON.

use crate::drop::{PlateOutcome, SimulatedBounce, SimulatedDrop, SimulatedDropMotion};
use crate::text::{findings_text, six_digits};
use windfall_files::error::Error;
use windfall_files::named::Named;
use windfall_files::table::write::csv_text;
use windfall_files::text::table::table_text;

/// A value of an impact: name, value, unit.
pub(crate) type Row = (&'static str, Option<f64>, &'static str);

pub(crate) fn rows(impact: &SimulatedBounce) -> Vec<Row> {
    vec![
        ("onset_time", Some(impact.onset_time), "s"),
        ("impact_velocity", Some(impact.impact_velocity), "m/s"),
        ("peak_contact_force", Some(impact.peak_contact_force), "N"),
        (
            "time_of_peak_contact_force",
            Some(impact.time_of_peak_contact_force),
            "s",
        ),
        ("peak_support_force", Some(impact.peak_support_force), "N"),
        (
            "time_of_peak_support_force",
            Some(impact.time_of_peak_support_force),
            "s",
        ),
        ("max_displacement", Some(impact.max_displacement), "m"),
        (
            "time_of_max_displacement",
            Some(impact.time_of_max_displacement),
            "s",
        ),
        ("force_end_time", impact.force_end_time, "s"),
        ("separation_time", impact.separation_time, "s"),
        ("separation_velocity", impact.separation_velocity, "m/s"),
        ("restitution", impact.restitution, "1"),
        ("contact_restitution", impact.contact_restitution, "1"),
        ("impulse", Some(impact.impulse), "N s"),
        ("absorbed_energy", impact.absorbed_energy, "J"),
    ]
}

/// A simulated drop as text: a column for each impact.
#[must_use]
pub fn text_of_drop(drop: &SimulatedDrop) -> String {
    let plate = plate_text(drop.plate.as_ref());
    let columns: Vec<Vec<Row>> = drop.impacts.iter().map(rows).collect();
    let factor = match drop.effective_mass_factor {
        1.0 => String::new(),
        factor => format!(", of which the contact feels {factor}"),
    };
    let rest = match drop.at_rest {
        true => "\nThe fruit then stays on the plate.\n",
        false => "",
    };
    format!(
        "simulated: {}, contact ends at {}\nfruit {} kg{factor}, from {} m under {} m/s^2; {plate}\n\n{}\n{rest}{}",
        drop.law,
        drop.end,
        given(drop.mass),
        given(drop.height),
        given(drop.gravity),
        impact_table(&columns, &drop.intervals),
        findings_text(&drop.findings)
    )
}

/// "plate 0.2 kg on 645800 N/m and 52.47 N s/m".
pub(crate) fn plate_text(plate: Option<&PlateOutcome>) -> String {
    match plate {
        None => "rigid plate".to_owned(),
        Some(plate) => format!(
            "plate {} kg on {} N/m and {} N s/m",
            given(plate.mass),
            given(plate.stiffness),
            given(plate.damping)
        ),
    }
}

/// Impacts as a table with a column for each.
pub(crate) fn impact_table(columns: &[Vec<Row>], intervals: &[f64]) -> String {
    let mut header = vec!["quantity".to_owned()];
    header.extend((1..=columns.len()).map(|number| format!("impact {number}")));
    header.push("unit".to_owned());
    let shown = |value: Option<f64>| value.map_or_else(|| "-".to_owned(), six_digits);
    let line = |name: &str, values: Vec<Option<f64>>, unit: &str| {
        let mut line = vec![name.replace('_', " ")];
        line.extend(values.into_iter().map(shown));
        line.push(unit.to_owned());
        line
    };
    let mut lines: Vec<Vec<String>> = Vec::new();
    for (index, (name, _, unit)) in columns.first().into_iter().flatten().enumerate() {
        let values = columns.iter().map(|column| column[index].1).collect();
        lines.push(line(name, values, unit));
    }
    let mut intervals: Vec<Option<f64>> = intervals.iter().copied().map(Some).collect();
    intervals.resize(columns.len(), None);
    lines.push(line("interval to the next onset", intervals, "s"));
    table_text(&header, lines, &[0, header.len() - 1])
}

/// A value as it was given: six digits without zeros at the end.
pub(crate) fn given(value: f64) -> String {
    let text = six_digits(value);
    match text.contains('.') && !text.contains('e') {
        true => text.trim_end_matches('0').trim_end_matches('.').to_owned(),
        false => text,
    }
}

/// "peak_force_N"; no unit for a pure number.
pub(crate) fn column(name: &str, unit: &str) -> String {
    match unit {
        "1" => name.to_owned(),
        unit => format!("{name}_{}", unit.replace(['/', ' '], "_")),
    }
}

/// A simulated drop as CSV, one row per impact, units in the header.
///
/// # Errors
/// None in practice: the text is written to memory.
pub fn csv_of_drop(drop: &SimulatedDrop) -> Result<String, Error> {
    let columns: Vec<Vec<Row>> = drop.impacts.iter().map(rows).collect();
    impact_csv(&columns, &drop.intervals)
}

/// Impacts as CSV with a row for each.
pub(crate) fn impact_csv(columns: &[Vec<Row>], intervals: &[f64]) -> Result<String, Error> {
    let number = |value: Option<f64>| value.map_or_else(String::new, |value| value.to_string());
    let mut header = vec!["impact".to_owned()];
    let names = columns.first().into_iter().flatten();
    header.extend(names.map(|(name, _, unit)| column(name, unit)));
    header.push("interval_s".to_owned());
    let lines = columns.iter().enumerate().map(|(index, values)| {
        let mut line = vec![(index + 1).to_string()];
        line.extend(values.iter().map(|(_, value, _)| number(*value)));
        line.push(number(intervals.get(index).copied()));
        line
    });
    csv_text(&header, lines)
}

/// Columns of a motion: name, unit, values.
fn motion_columns(motion: &SimulatedDropMotion) -> [(&'static str, &'static str, &[f64]); 7] {
    let t = &motion.trajectory;
    [
        ("time", "s", &t.times),
        ("contact_force", "N", &t.contact_force),
        ("support_force", "N", &t.support_force),
        ("height", "m", &t.height),
        ("velocity", "m/s", &t.velocity),
        ("plate_displacement", "m", &t.plate_displacement),
        ("plate_velocity", "m/s", &t.plate_velocity),
    ]
}

/// The motion of a drop as CSV.
///
/// # Errors
/// None in practice: the text is written to memory.
pub fn csv_of_drop_motion(motion: &SimulatedDropMotion) -> Result<String, Error> {
    let columns = motion_columns(motion);
    let header = columns.map(|(name, unit, _)| column(name, unit));
    let samples = motion.trajectory.times.len();
    let rows = (0..samples).map(|i| columns.map(|(_, _, values)| values[i].to_string()).to_vec());
    csv_text(&header, rows)
}

/// A drop and its motion as JSON: the keys of the drop, and `motion`.
#[must_use]
pub fn json_of_drop_motion(motion: &SimulatedDropMotion) -> serde_json::Value {
    let mut value = serde_json::json!(motion.drop);
    let columns = motion_columns(motion).map(|(name, _, values)| (name.to_owned(), values));
    if let Some(keys) = value.as_object_mut() {
        let columns = serde_json::json!(Named(columns.to_vec()));
        keys.insert("motion".to_owned(), columns);
    }
    value
}
