//! Simulated drops and their motions as text, CSV and JSON.

use crate::drop::{SimulatedDrop, SimulatedDropMotion};
use crate::motion::{MotionOutcome, MovingDrop};
use crate::text::{
    Column, Row, column, findings_text, motion_csv, number_or_blank, rows, samples, shown,
};
use windfall_drop_rig::rig::Plate;
use windfall_drop_rig::simulate::DropImpact;
use windfall_files::error::Error;
use windfall_files::table::write::csv_text;
use windfall_files::text::number::with_digits;
use windfall_files::text::table::table_text;

pub(crate) fn rows_of(own: &DropImpact) -> Vec<Row> {
    rows![of own:
        onset_time "s",
        impact_velocity "m/s",
        peak_contact_force "N",
        time_of_peak_contact_force "s",
        peak_support_force "N",
        time_of_peak_support_force "s",
        max_displacement "m",
        time_of_max_displacement "s",
        force_end_time "s",
        separation_time "s",
        separation_velocity "m/s",
        restitution "1",
        contact_restitution "1",
        impulse "N s",
        absorbed_energy "J",
    ]
}

/// A simulated drop as text: a column for each impact.
pub fn text_of_drop(drop: &SimulatedDrop) -> String {
    let plate = plate_text(drop.plate.as_ref());
    let columns: Vec<Vec<Row>> = drop.impacts.iter().map(rows_of).collect();
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
pub(crate) fn plate_text(plate: Option<&Plate>) -> String {
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
    let line = |name: &str, values: Vec<f64>, unit: &str| {
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
    let mut intervals = intervals.to_vec();
    intervals.resize(columns.len(), f64::NAN);
    lines.push(line("interval to the next onset", intervals, "s"));
    table_text(&header, lines, &[0, header.len() - 1])
}

/// A value as it was given: six digits without zeros at the end.
pub(crate) fn given(value: f64) -> String {
    let text = with_digits(value, 6);
    match text.contains('.') && !text.contains('·') {
        true => text.trim_end_matches('0').trim_end_matches('.').to_owned(),
        false => text,
    }
}

/// A simulated drop as CSV, one row per impact, units in the header.
pub fn csv_of_drop(drop: &SimulatedDrop) -> Result<String, Error> {
    let columns: Vec<Vec<Row>> = drop.impacts.iter().map(rows_of).collect();
    impact_csv(&columns, &drop.intervals)
}

/// Impacts as CSV with a row for each.
pub(crate) fn impact_csv(columns: &[Vec<Row>], intervals: &[f64]) -> Result<String, Error> {
    let mut header = vec!["impact".to_owned()];
    let names = columns.first().into_iter().flatten();
    header.extend(names.map(|(name, _, unit)| column(name, unit)));
    header.push("interval_s".to_owned());
    let lines = columns.iter().enumerate().map(|(index, values)| {
        let mut line = vec![(index + 1).to_string()];
        line.extend(values.iter().map(|(_, value, _)| number_or_blank(*value)));
        let interval = intervals.get(index).copied();
        line.push(number_or_blank(interval.unwrap_or(f64::NAN)));
        line
    });
    csv_text(&header, lines)
}

fn motion_columns(motion: &SimulatedDropMotion) -> [Column<'_>; 7] {
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
pub fn csv_of_drop_motion(motion: &SimulatedDropMotion) -> Result<String, Error> {
    motion_csv(&motion_columns(motion))
}

/// A drop and its motion as JSON shows them: the keys of the drop, and `motion`.
pub fn outcome_of_drop_motion(motion: &SimulatedDropMotion) -> MotionOutcome {
    MotionOutcome::Drop(MovingDrop {
        drop: motion.drop.clone(),
        motion: samples(&motion_columns(motion)),
    })
}
