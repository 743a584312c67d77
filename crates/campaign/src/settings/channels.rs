//! `[channels.*]` and `[encoder]` of campaign.toml.

use crate::settings::file::{CampaignFile, ChannelFile, ChannelsFile, QuantityText};
use crate::settings::model::ChannelPlan;
use windfall_files::error::Error;
use windfall_files::text::spanned::Spanned;
use windfall_files::text::toml_source::{
    Needed, TomlSource, missing, number_that, optional_quantity, place_at, positive_quantity,
    refused, uncertain_quantity,
};
use windfall_numerics::unit::quantity::{UnitError, parse_as, parse_unit};
use windfall_numerics::unit::uncertain::parse_uncertain;
use windfall_signal::kinematics::Encoder;
use windfall_signal::recording::Quantity;

/// What a channel of a campaign may hold.
#[derive(Clone, Copy, Debug)]
pub struct Kind {
    /// Its table in campaign.toml, with brackets.
    pub table: &'static str,
    /// What it holds.
    pub quantity: Quantity,
    /// SI unit; empty where samples are taken as they are.
    pub unit: &'static str,
}

impl Kind {
    /// A channel by its table, what it holds and its SI unit.
    pub const fn new(table: &'static str, quantity: Quantity, unit: &'static str) -> Self {
        Self {
            table,
            quantity,
            unit,
        }
    }

    /// Name of the channel: that of its table without "channels".
    pub fn name(&self) -> &'static str {
        let (_, name) = self.table.rsplit_once('.').unwrap_or_default();
        name.trim_end_matches(']')
    }

    /// SI unit of the sensitivity of a sensor of this quantity.
    pub fn sensitivity_unit(&self) -> String {
        match self.unit {
            "m/s" => "V s/m".to_owned(),
            "m/s^2" => "V s^2/m".to_owned(),
            unit => format!("V/{unit}"),
        }
    }
}

/// The channels that a campaign may have.
pub const KINDS: [Kind; 8] = [
    Kind::new("[channels.force]", Quantity::Force, "N"),
    Kind::new("[channels.position]", Quantity::Displacement, "m"),
    Kind::new("[channels.velocity]", Quantity::Rate, "m/s"),
    Kind::new("[channels.acceleration]", Quantity::Acceleration, "m/s^2"),
    Kind::new("[channels.angle]", Quantity::Angle, "rad"),
    Kind::new("[channels.count]", Quantity::EncoderCount, ""),
    Kind::new("[channels.phase_a]", Quantity::PhaseA, ""),
    Kind::new("[channels.phase_b]", Quantity::PhaseB, ""),
];

/// The channels that a file has.
pub(crate) fn channels_of(
    file: &ChannelsFile,
) -> impl Iterator<Item = (&'static Kind, &Spanned<ChannelFile>)> {
    const ALL: &[Kind] = &KINDS;
    let all = [
        &file.force,
        &file.position,
        &file.velocity,
        &file.acceleration,
        &file.angle,
        &file.count,
        &file.phase_a,
        &file.phase_b,
    ];
    let all = ALL.iter().zip(all);
    all.filter_map(|(kind, channel)| Some((kind, channel.as_ref()?)))
}

/// The channels of a campaign.
///
/// # Errors
/// There is none, or one cannot be scaled to SI.
pub fn channel_plans(
    source: &TomlSource,
    channels: Option<&Spanned<ChannelsFile>>,
) -> Result<Vec<ChannelPlan>, Error> {
    let all = channels
        .into_iter()
        .flat_map(|file| channels_of(file.get_ref()));
    let plans = all.map(|(kind, channel)| channel_plan(source, kind, channel));
    let plans = plans.collect::<Result<Vec<_>, _>>()?;
    if plans.is_empty() {
        let needed = Needed {
            table: "[channels]",
            key: "force",
            meaning: "at least one channel: force, position, velocity, acceleration, angle, \
                      count, or phase_a and phase_b",
            unit: "",
            example: "[channels.force] column = \"force_N\", unit = \"N\"",
        };
        let at = channels.map_or(0..0, Spanned::span);
        return Err(missing(source, &at, &needed, needed.table.to_owned()));
    }
    Ok(plans)
}

/// The plan of one channel.
///
/// # Errors
/// It names no column, or cannot be scaled to SI.
pub fn channel_plan(
    source: &TomlSource,
    kind: &Kind,
    channel: &Spanned<ChannelFile>,
) -> Result<ChannelPlan, Error> {
    let (at, file) = (channel.span(), channel.get_ref());
    let Some(column) = &file.column else {
        let needed = Needed {
            table: kind.table,
            key: "column",
            meaning: "name of the column in the recordings",
            unit: "",
            example: "column = \"force_N\"",
        };
        return Err(missing(source, &at, &needed, kind.table.to_owned()));
    };
    let ((scale, scale_sd), offset) = calibration(source, kind, channel)?;
    let (delay, delay_sd) = delay(source, kind, file)?;
    let noise_sd = noise_sd(source, kind, file)?;
    Ok(ChannelPlan {
        table: kind.table,
        line: place_at(source, &column.span()).line,
        quantity: kind.quantity,
        column: column.get_ref().clone(),
        time: file.time.as_ref().map(|time| time.get_ref().clone()),
        scale: scale * sign(source, kind, file)?,
        offset,
        delay,
        scale_sd,
        delay_sd,
        noise_sd,
    })
}

/// SI units per unit of the column with the uncertainty as a part of them, and the zero in
/// units of the column.
///
/// With a sensitivity the column is a voltage (or whatever the sensitivity says
/// above the line); without one the column is the quantity itself.
fn calibration(
    source: &TomlSource,
    kind: &Kind,
    channel: &Spanned<ChannelFile>,
) -> Result<(Scale, f64), Error> {
    let file = channel.get_ref();
    if kind.unit.is_empty() {
        return as_it_is(source, kind, file);
    }
    let Some(sensitivity) = &file.sensitivity else {
        return direct_calibration(source, kind, channel);
    };
    let (per_unit, sd) = sensitivity_value(source, kind, sensitivity)?;
    let (key, expected) = ((kind.table, "gain"), "a number other than zero");
    let fits = |gain: f64| gain != 0.0 && gain.is_finite();
    let gain = number_that(source, file.gain.as_ref(), key, fits, expected)?;
    let gain = gain.unwrap_or(1.0);
    let (cell, cell_sd) = column_unit(source, kind, file, "V")?;
    let offset = offset_value(source, kind, file, "V")?;
    let scale = (cell / (per_unit * gain), sd.hypot(cell_sd));
    Ok((scale, offset / cell))
}

/// Counts and levels are taken as they are.
fn as_it_is(source: &TomlSource, kind: &Kind, file: &ChannelFile) -> Result<(Scale, f64), Error> {
    let problem = "its samples are taken as they are; remove the line";
    let refuse = |value: &Spanned<QuantityText>, key| {
        Err(refused(source, value, (kind.table, key), problem))
    };
    match (&file.sensitivity, &file.offset, &file.gain, &file.unit) {
        (Some(sensitivity), ..) => refuse(sensitivity, "sensitivity"),
        (_, Some(offset), ..) => refuse(offset, "offset"),
        (_, _, Some(gain), _) => Err(refused(source, gain, (kind.table, "gain"), problem)),
        (.., Some(unit)) => Err(refused(source, unit, (kind.table, "unit"), problem)),
        _ => Ok(((1.0, 0.0), 0.0)),
    }
}

fn sensitivity_value(
    source: &TomlSource,
    kind: &Kind,
    text: &Spanned<QuantityText>,
) -> Result<Scale, Error> {
    let wrong = |problem: String| refused(source, text, (kind.table, "sensitivity"), problem);
    match parse_known(&text.get_ref().0, &kind.sensitivity_unit(), kind) {
        Ok((0.0, _)) => Err(wrong("a sensitivity cannot be zero".to_owned())),
        Ok((value, sd)) => Ok((value, sd / value.abs())),
        Err(error) => Err(wrong(error.to_string())),
    }
}

/// A value and its standard uncertainty as a part of it.
type Scale = (f64, f64);

/// A value with the uncertainty behind it, which only a force, a position or an angle may have; SI.
fn parse_known(text: &str, unit: &str, kind: &Kind) -> Result<(f64, f64), UnitError> {
    match kind.quantity {
        Quantity::Force | Quantity::Displacement | Quantity::Angle => {
            parse_uncertain(text, unit).map(|(value, sd)| (value, sd.unwrap_or(0.0)))
        }
        _ => Ok((parse_as(text, unit)?, 0.0)),
    }
}

/// A column in units of the quantity itself.
fn direct_calibration(
    source: &TomlSource,
    kind: &Kind,
    channel: &Spanned<ChannelFile>,
) -> Result<(Scale, f64), Error> {
    let file = channel.get_ref();
    if file.unit.is_none() {
        let needed = Needed {
            table: kind.table,
            key: "unit",
            meaning: "unit of the column; or `sensitivity` where it holds volts",
            unit: "",
            example: "unit = \"mm\"   or   sensitivity = \"11 mV/N\"",
        };
        let (at, table) = (channel.span(), kind.table.to_owned());
        return Err(missing(source, &at, &needed, table));
    }
    let cell = column_unit(source, kind, file, kind.unit)?;
    let offset = offset_value(source, kind, file, kind.unit)?;
    if let Some(gain) = &file.gain {
        let problem = "a gain belongs to a `sensitivity`; this channel has only a `unit`";
        return Err(refused(source, gain, (kind.table, "gain"), problem));
    }
    Ok((cell, offset / cell.0))
}

/// SI value of one unit of the column.
fn column_unit(
    source: &TomlSource,
    kind: &Kind,
    file: &ChannelFile,
    expected: &str,
) -> Result<Scale, Error> {
    let Some(unit) = &file.unit else {
        return Ok((1.0, 0.0));
    };
    let wrong = |problem: String| refused(source, unit, (kind.table, "unit"), problem);
    let text = unit.get_ref();
    let scale = match text.contains('±') {
        true => parse_known(text, expected, kind),
        false => parse_scale(text, expected).map(|scale| (scale, 0.0)),
    };
    let (scale, sd) = scale.map_err(|error| wrong(error.to_string()))?;
    match scale.is_normal() {
        true => Ok((scale, sd / scale.abs())),
        false => Err(wrong("it scales the column to nothing".to_owned())),
    }
}

/// SI units per unit of a column: from "mm", or from what one unit stands for, "0.17 mm".
///
/// # Errors
/// What is wrong with the text, or that its dimension is not that of `expected`.
pub fn parse_scale(text: &str, expected: &str) -> Result<f64, UnitError> {
    if text.starts_with(|c: char| c.is_ascii_digit() || "+-.−".contains(c)) {
        return parse_as(text, expected);
    }
    parse_unit(text)?;
    parse_as(&format!("1 {text}"), expected)
}

/// The column's zero in SI.
fn offset_value(
    source: &TomlSource,
    kind: &Kind,
    file: &ChannelFile,
    unit: &'static str,
) -> Result<f64, Error> {
    let needed = Needed {
        table: kind.table,
        key: "offset",
        meaning: "what the column shows at zero",
        unit,
        example: "offset = \"0.02 V\"",
    };
    Ok(optional_quantity(source, file.offset.as_ref(), &needed)?.unwrap_or(0.0))
}

/// By how much the channel is late, and how uncertain that is; s.
fn delay(source: &TomlSource, kind: &Kind, file: &ChannelFile) -> Result<(f64, f64), Error> {
    let needed = Needed {
        table: kind.table,
        key: "delay",
        meaning: "by how much this channel shows an event later than the others",
        unit: "s",
        example: "delay = \"10 ms\"",
    };
    let value = file.delay.as_ref();
    let known = match kind.quantity {
        Quantity::Force => uncertain_quantity(source, value, &needed)?,
        _ => optional_quantity(source, value, &needed)?.map(|delay| (delay, 0.0)),
    };
    Ok(known.unwrap_or_default())
}

/// Standard deviation of the noise of a sample; SI.
fn noise_sd(source: &TomlSource, kind: &Kind, file: &ChannelFile) -> Result<Option<f64>, Error> {
    let needed = Needed {
        table: kind.table,
        key: "noise_sd",
        meaning: "standard deviation of the noise of a sample",
        unit: kind.unit,
        example: "noise_sd = \"0.2 N\"",
    };
    match &file.noise_sd {
        Some(value) if kind.unit.is_empty() => {
            let problem = "counts have the noise of a count, which is known; remove the line";
            Err(refused(source, value, (kind.table, needed.key), problem))
        }
        value => positive_quantity(source, value.as_ref(), &needed),
    }
}

fn sign(source: &TomlSource, kind: &Kind, file: &ChannelFile) -> Result<f64, Error> {
    let (key, fits) = ((kind.table, "sign"), |sign| sign == 1 || sign == -1);
    let expected = "1, or -1 where the column counts the other way";
    let sign = number_that(source, file.sign.as_ref(), key, fits, expected)?;
    Ok(sign.map_or(1.0, |sign| sign as f64))
}

/// The encoder of a campaign.
///
/// # Errors
/// Phases or counts are recorded and the encoder does not say what they mean.
pub fn encoder_plan(source: &TomlSource, file: &CampaignFile) -> Result<Option<Encoder>, Error> {
    let counts = file.channels.as_ref().is_some_and(|channels| {
        let channels = channels.get_ref();
        channels.count.is_some() || channels.phase_a.is_some() || channels.phase_b.is_some()
    });
    let needed = Needed {
        table: "[encoder]",
        key: "counts_per_revolution",
        meaning: "counts per revolution after x4 decoding, for an encoder on a pendulum's pivot; \
                  or `count_length` for a wheel or a linear scale",
        unit: "m",
        example: "counts_per_revolution = 360000   or   count_length = \"0.17 mm\"",
    };
    let Some(encoder) = &file.encoder else {
        return match counts {
            true => Err(missing(source, &(0..0), &needed, needed.table.to_owned())),
            false => Ok(None),
        };
    };
    let (at, encoder) = (encoder.span(), encoder.get_ref());
    let length_key = Needed {
        key: "count_length",
        ..needed
    };
    let length = positive_quantity(source, encoder.count_length.as_ref(), &length_key)?;
    let key = (needed.table, needed.key);
    let given = encoder.counts_per_revolution.as_ref();
    let expected = "a number above zero";
    let per_revolution = number_that(source, given, key, |own| own > 0.0, expected)?;
    match (per_revolution, length, given) {
        (Some(_), Some(_), Some(given)) => {
            let problem = "`count_length` is given too; keep one of them";
            Err(refused(source, given, key, problem))
        }
        (Some(counts_per_revolution), ..) => Ok(Some(Encoder::Rotary {
            counts_per_revolution,
        })),
        (None, Some(count_length), _) => Ok(Some(Encoder::Linear { count_length })),
        (None, None, _) => Err(missing(source, &at, &needed, needed.table.to_owned())),
    }
}
