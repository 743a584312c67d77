//! What sensors saw, for a terminal.

use crate::run::sensors::outcome::{FlowOutcome, ProbeOutcome, SensorOutcome, SpaceOutcome};
use windfall_files::text::columns::{Column, given, text_of_rows};
use windfall_files::text::statistic::number;

type Row<'a, T> = (&'a str, &'a T);

/// A table for each kind of sensor that a scene has.
pub(crate) fn text_of_sensors(sensors: &[SensorOutcome]) -> String {
    let mut text = String::new();
    let flows = rows(sensors, |own| own.flow.as_ref());
    let spaces = rows(sensors, |own| own.space.as_ref());
    let probes = rows(sensors, |own| own.probe.as_ref());
    if !flows.is_empty() {
        text += &format!("\n\n{}", text_of_flows(&flows));
    }
    if !spaces.is_empty() {
        text += &format!("\n\n{}", text_of_spaces(&spaces));
    }
    if !probes.is_empty() {
        text += &format!("\n\n{}", text_of_probes(&probes));
    }
    match text.is_empty() {
        true => text,
        false => text + "\n",
    }
}

fn rows<'a, T>(
    sensors: &'a [SensorOutcome],
    of: impl Fn(&'a SensorOutcome) -> Option<&'a T>,
) -> Vec<Row<'a, T>> {
    let row = |own: &'a SensorOutcome| of(own).map(|found| (own.name.as_str(), found));
    sensors.iter().filter_map(row).collect()
}

fn text_of_flows(rows: &[Row<FlowOutcome>]) -> String {
    let columns: [Column<Row<FlowOutcome>>; 9] = [
        ("passed", |own| own.0.to_owned()),
        ("forward", |own| own.1.forward.to_string()),
        ("backward", |own| own.1.backward.to_string()),
        ("kg forward", |own| number(own.1.mass_forward)),
        ("first (s)", |own| given(own.1.first, number)),
        ("last (s)", |own| given(own.1.last, number)),
        ("flow (1/s)", |own| given(own.1.mean_flow, number)),
        ("(kg/s)", |own| given(own.1.mean_mass_flow, number)),
        ("largest (1/s)", |own| number(own.1.largest_flow)),
    ];
    text_of_rows(rows, &columns, &[0])
}

fn text_of_spaces(rows: &[Row<SpaceOutcome>]) -> String {
    let columns: [Column<Row<SpaceOutcome>>; 9] = [
        ("box", |own| own.0.to_owned()),
        ("entered", |own| own.1.entered.to_string()),
        ("inside", |own| own.1.inside.to_string()),
        ("mass (kg)", |own| number(own.1.mass)),
        ("fruit (%)", |own| number(100.0 * own.1.fruit_share)),
        ("level (m)", |own| given(own.1.level, number)),
        ("left again", |own| {
            let residence = own.1.residence.as_ref();
            residence.map_or(0, |own| own.fruit).to_string()
        }),
        ("stay (s)", |own| {
            given(own.1.residence.as_ref().map(|own| own.median), number)
        }),
        ("longest", |own| {
            given(own.1.residence.as_ref().map(|own| own.largest), number)
        }),
    ];
    text_of_rows(rows, &columns, &[0])
}

fn text_of_probes(rows: &[Row<ProbeOutcome>]) -> String {
    let columns: [Column<Row<ProbeOutcome>>; 9] = [
        ("probe", |own| own.0.to_owned()),
        ("impacts", |own| own.1.impacts.to_string()),
        ("peak (m/s²)", |own| {
            given(own.1.peak_acceleration.map(|own| own[0]), number)
        }),
        ("95 %", |own| {
            given(own.1.peak_acceleration.map(|own| own[1]), number)
        }),
        ("largest", |own| given(own.1.largest_acceleration, number)),
        ("change (m/s)", |own| {
            given(own.1.velocity_change.map(|own| own[0]), number)
        }),
        ("95 %", |own| {
            given(own.1.velocity_change.map(|own| own[1]), number)
        }),
        ("largest", |own| {
            given(own.1.velocity_change.map(|own| own[2]), number)
        }),
        ("hardest on", |own| {
            let hardest = own.1.hardest.as_ref();
            let struck = hardest.and_then(|own| own.struck.clone());
            struck.unwrap_or_else(|| "-".to_owned())
        }),
    ];
    text_of_rows(rows, &columns, &[0])
}
