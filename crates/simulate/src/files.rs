//! Files of a simulated campaign: recordings as CSV, campaign.toml.

use std::fmt::Write;
use windfall_campaign::settings::channels::{KINDS, Kind};
use windfall_campaign::settings::rig::FROM_IMPULSE;
use windfall_cards::law_use::end_name;
use windfall_cards::user_laws::text::law_table;
use windfall_contact::law::EndRule;
use windfall_contact::laws::kind::LawKind;
use windfall_files::text::quote::string_text;
use windfall_identify::rig::kind::Rig;
use windfall_signal::instrument::{EncoderOutput, Instrument, RawChannel, Sensor};
use windfall_signal::kinematics::Encoder;
use windfall_signal::recording::Quantity;

/// Digits of a voltage in the file; V.
const VOLT_DECIMALS: usize = 6;

/// Digits of a time in the file; s.
const TIME_DECIMALS: usize = 9;

/// Whether campaign.toml gives the mass of a carriage.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Weighed {
    /// It does.
    #[default]
    Given,
    /// It says "from impulse".
    FromImpulse,
}

/// What is common to all recordings.
#[derive(Clone, Debug, PartialEq)]
pub struct SimulatedCampaign {
    /// Title of the campaign.
    pub title: String,
    /// Label that marks all results as simulated.
    pub label: String,
    /// The rig.
    pub rig: Rig,
    /// Whether the campaign knows the mass.
    pub weighed: Weighed,
    /// Impact velocity; m/s.
    pub velocity: f64,
    /// End of contact.
    pub end: EndRule,
    /// What records.
    pub instrument: Instrument,
    /// Seed of specimens, noise and encoder positions.
    pub seed: u64,
}

/// A recording as CSV: volts, logic levels, counts. Channels of one rate share
/// their rows and no time is written; else each has a column of times.
pub fn recording_text(channels: &[RawChannel]) -> String {
    let timed = intervals_differ(channels.iter().map(|channel| channel.interval));
    let mut names = Vec::new();
    for channel in channels {
        if timed {
            names.push(time_column(channel.quantity));
        }
        names.push(column(channel.quantity));
    }
    let lengths = channels.iter().map(|channel| channel.samples.len());
    let rows = match timed {
        true => lengths.max(),
        false => lengths.min(),
    };
    let mut text = names.join(",") + "\n";
    for row in 0..rows.unwrap_or(0) {
        for (index, channel) in channels.iter().enumerate() {
            if index > 0 {
                text.push(',');
            }
            write_cells(&mut text, channel, row, timed);
        }
        text.push('\n');
    }
    text
}

fn intervals_differ(mut intervals: impl Iterator<Item = f64>) -> bool {
    let first = intervals.next();
    intervals.any(|interval| Some(interval) != first)
}

/// A channel that is over leaves its cells blank.
fn write_cells(text: &mut String, channel: &RawChannel, row: usize, timed: bool) {
    let Some(value) = channel.samples.get(row) else {
        text.push_str(if timed { "," } else { "" });
        return;
    };
    if timed {
        let time = row as f64 * channel.interval;
        let _ = write!(text, "{time:.TIME_DECIMALS$},");
    }
    let logic = [Quantity::EncoderCount, Quantity::PhaseA, Quantity::PhaseB];
    let _ = match logic.contains(&channel.quantity) {
        true => write!(text, "{value}"),
        false => write!(text, "{value:.VOLT_DECIMALS$}"),
    };
}

fn kind_of(quantity: Quantity) -> Option<&'static Kind> {
    KINDS.iter().find(|kind| kind.quantity == quantity)
}

/// Name of a channel in campaign.toml.
fn name(quantity: Quantity) -> &'static str {
    kind_of(quantity).map_or("", Kind::name)
}

fn column(quantity: Quantity) -> String {
    match quantity {
        Quantity::EncoderCount => name(quantity).to_owned(),
        _ => format!("{}_V", name(quantity)),
    }
}

fn time_column(quantity: Quantity) -> String {
    format!("{}_time_s", name(quantity))
}

/// campaign.toml that reads the recordings back.
pub fn campaign_text(campaign: &SimulatedCampaign, law: LawKind) -> String {
    let instrument = &campaign.instrument;
    let rates = rates(instrument);
    let timed = intervals_differ(rates.iter().map(|rate| 1.0 / rate));
    let times = match (timed, rates.first()) {
        (false, Some(rate)) => format!("rate = \"{rate} Hz\""),
        _ => "# every channel has times of its own".to_owned(),
    };
    let quantities: Vec<String> = fitted(instrument)
        .iter()
        .map(|name| format!("\"{name}\""))
        .collect();
    let threshold = match campaign.rig {
        Rig::Pendulum(_) => r#""1 N"                     # that of the 2003 pendulum study"#,
        Rig::Carriage(_) => r#""auto""#,
    };
    format!(
        r#"# Simulated by windfall: no fruit was hurt. The parameters that were drawn are in truth.csv.
format = 1

[campaign]
title = {title}
simulated = {label}

{rig}
[files]
directory = "raw"
{times}

{channels}
[contact]
threshold = {threshold}

[fit]
laws = [{law}]
quantities = [{quantities}]
end = "{end}"

[summary]
group = "variety"
{own}"#,
        title = string_text(&campaign.title),
        label = string_text(&campaign.label),
        rig = rig_text(&campaign.rig, campaign.weighed),
        channels = channels_text(instrument, timed),
        law = string_text(law.name()),
        own = match law_table(law) {
            table if table.is_empty() => table,
            table => format!("\n{table}"),
        },
        quantities = quantities.join(", "),
        end = end_name(campaign.end),
    )
}

fn rig_text(rig: &Rig, weighed: Weighed) -> String {
    match rig {
        Rig::Pendulum(rig) => format!(
            r#"[rig]
kind = "pendulum"
inertia = "{} kg m^2"
arm = "{} m"
mass = "{} kg"
centre_of_mass = "{} m"
gravity = "{} m/s^2"
"#,
            rig.inertia, rig.arm, rig.mass, rig.centre_of_mass, rig.gravity
        ),
        Rig::Carriage(rig) => format!(
            r#"[rig]
kind = "carriage"
mass = "{}"
driving_acceleration = "{} m/s^2"
"#,
            match weighed {
                Weighed::Given => format!("{} kg", rig.mass),
                Weighed::FromImpulse => FROM_IMPULSE.to_owned(),
            },
            rig.driving_acceleration
        ),
    }
}

/// Sensors with a voltage.
fn sensors(instrument: &Instrument) -> Vec<(Quantity, Sensor)> {
    let all = [
        (Quantity::Force, instrument.force),
        (Quantity::Displacement, instrument.displacement),
        (Quantity::Rate, instrument.rate),
        (Quantity::Acceleration, instrument.acceleration),
    ];
    all.into_iter()
        .filter_map(|(quantity, sensor)| Some((quantity, sensor?)))
        .collect()
}

/// Sampling rates of all channels; Hz.
pub(crate) fn rates(instrument: &Instrument) -> Vec<f64> {
    let encoder = instrument.encoder.map(|encoder| encoder.sampling_rate);
    let sensors = sensors(instrument).into_iter();
    let sensors = sensors.map(|(_, sensor)| sensor.sampling_rate);
    encoder.into_iter().chain(sensors).collect()
}

/// Quantities of the cost function: all that are recorded.
fn fitted(instrument: &Instrument) -> Vec<&'static str> {
    let displacement = instrument.encoder.is_some() || instrument.displacement.is_some();
    let recorded = [
        (displacement, "displacement"),
        (instrument.rate.is_some(), "rate"),
        (instrument.force.is_some(), "force"),
        (instrument.acceleration.is_some(), "acceleration"),
    ];
    let recorded = recorded.into_iter().filter(|(there, _)| *there);
    recorded.map(|(_, name)| name).collect()
}

fn channels_text(instrument: &Instrument, timed: bool) -> String {
    let mut text = String::new();
    let begin = |quantity: Quantity| {
        let mut part = format!(
            "[channels.{}]\ncolumn = \"{}\"\n",
            name(quantity),
            column(quantity)
        );
        if timed {
            let _ = writeln!(part, "time = \"{}\"", time_column(quantity));
        }
        part
    };
    for (quantity, sensor) in sensors(instrument) {
        text += &begin(quantity);
        let unit = kind_of(quantity).map_or_else(String::new, Kind::sensitivity_unit);
        let _ = writeln!(text, "sensitivity = \"{} {unit}\"", sensor.sensitivity);
        if sensor.offset != 0.0 {
            let _ = writeln!(text, "offset = \"{} V\"", sensor.offset);
        }
        text.push('\n');
    }
    let Some(encoder) = instrument.encoder else {
        return text;
    };
    let channels: &[Quantity] = match encoder.output {
        EncoderOutput::Phases => &[Quantity::PhaseA, Quantity::PhaseB],
        EncoderOutput::Counts => &[Quantity::EncoderCount],
    };
    for quantity in channels {
        text += &begin(*quantity);
    }
    let resolution = match encoder.encoder {
        Encoder::Rotary {
            counts_per_revolution,
        } => format!("counts_per_revolution = {counts_per_revolution:.1}"),
        Encoder::Linear { count_length } => format!("count_length = \"{count_length} m\""),
    };
    let _ = writeln!(text, "\n[encoder]\n{resolution}");
    text
}
