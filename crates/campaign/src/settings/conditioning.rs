//! Filters and the tip of `[channels.*]`, and how the rate is made.

use crate::settings::file::{ChannelFile, ChannelsFile, QuantityText};
use toml::Spanned;
use windfall_files::error::Error;
use windfall_files::text::toml_source::{Needed, TomlSource, choice, invalid, optional_quantity};
use windfall_signal::conditioning::{ChannelFilter, Conditioning, USUAL_ORDER};
use windfall_signal::filter::butterworth::{Band, MAX_ORDER};
use windfall_signal::options::RateMethod;

/// What is done to the channels of a campaign before they are used.
///
/// # Errors
/// A value cannot be used, or belongs to another channel.
pub fn conditioning_plan(
    source: &TomlSource,
    channels: Option<&Spanned<ChannelsFile>>,
) -> Result<Conditioning, Error> {
    let Some(channels) = channels.map(Spanned::get_ref) else {
        return Ok(Conditioning::default());
    };
    for (table, channel) in [
        ("[channels.count]", &channels.count),
        ("[channels.phase_a]", &channels.phase_a),
        ("[channels.phase_b]", &channels.phase_b),
    ] {
        refuse_conditioning(source, table, channel.as_ref(), "counts are never filtered")?;
    }
    let of = |table: &'static str, channel: &Option<Spanned<ChannelFile>>| match channel {
        Some(channel) => filter_of(source, table, channel.get_ref()),
        None => Ok(None),
    };
    let position = match of("[channels.position]", &channels.position)? {
        None => of("[channels.angle]", &channels.angle)?,
        filter => filter,
    };
    let tip = channels
        .force
        .as_ref()
        .and_then(|force| force.get_ref().tip_mass.as_ref());
    for (table, channel) in [
        ("[channels.position]", &channels.position),
        ("[channels.velocity]", &channels.velocity),
        ("[channels.acceleration]", &channels.acceleration),
        ("[channels.angle]", &channels.angle),
    ] {
        if let Some(tip) = channel.as_ref().and_then(|c| c.get_ref().tip_mass.as_ref()) {
            let problem = "a tip stands ahead of a force sensor: put it under [channels.force]";
            return Err(bad(source, table, "tip_mass", tip, problem.to_owned()));
        }
    }
    let needed = Needed {
        table: "[channels.force]",
        key: "tip_mass",
        meaning: "mass between force sensor and fruit",
        unit: "kg",
        example: "tip_mass = \"12 g\"",
    };
    Ok(Conditioning {
        force: of("[channels.force]", &channels.force)?,
        position,
        rate: of("[channels.velocity]", &channels.velocity)?,
        acceleration: of("[channels.acceleration]", &channels.acceleration)?,
        tip_mass: positive(source, tip, &needed)?,
    })
}

/// Refuses the keys of filters and tip on a channel that has none of them.
///
/// # Errors
/// One of them is there.
pub fn refuse_conditioning(
    source: &TomlSource,
    table: &str,
    channel: Option<&Spanned<ChannelFile>>,
    why: &str,
) -> Result<(), Error> {
    let Some(channel) = channel.map(Spanned::get_ref) else {
        return Ok(());
    };
    for (key, value) in [
        ("low_pass", &channel.low_pass),
        ("high_pass", &channel.high_pass),
        ("tip_mass", &channel.tip_mass),
    ] {
        if let Some(value) = value {
            let problem = format!("{why}; remove the line");
            return Err(bad(source, table, key, value, problem));
        }
    }
    Ok(())
}

fn bad(
    source: &TomlSource,
    table: &str,
    key: &str,
    value: &Spanned<QuantityText>,
    problem: String,
) -> Error {
    invalid(
        source,
        &value.span(),
        (table, key),
        &value.get_ref().0,
        problem,
    )
}

fn positive(
    source: &TomlSource,
    value: Option<&Spanned<QuantityText>>,
    needed: &Needed,
) -> Result<Option<f64>, Error> {
    let number = optional_quantity(source, value, needed)?;
    match (value, number) {
        (Some(value), Some(number)) if number <= 0.0 => {
            let problem = format!("must be above zero, for example: {}", needed.example);
            Err(bad(source, needed.table, needed.key, value, problem))
        }
        _ => Ok(number),
    }
}

fn filter_of(
    source: &TomlSource,
    table: &'static str,
    channel: &ChannelFile,
) -> Result<Option<ChannelFilter>, Error> {
    let cutoff = |value: Option<&Spanned<QuantityText>>, key| {
        let needed = Needed {
            table,
            key,
            meaning: "cut-off of a zero-phase Butterworth filter",
            unit: "Hz",
            example: "low_pass = \"5 kHz\"",
        };
        positive(source, value, &needed)
    };
    let low_pass = cutoff(channel.low_pass.as_ref(), "low_pass")?;
    let high_pass = cutoff(channel.high_pass.as_ref(), "high_pass")?;
    let band = match (low_pass, high_pass) {
        (None, None) => return no_order(source, table, channel),
        (Some(cutoff), None) => Band::LowPass(cutoff),
        (None, Some(cutoff)) => Band::HighPass(cutoff),
        (Some(high), Some(low)) => Band::BandPass(low, high),
    };
    let order = match &channel.filter_order {
        None => USUAL_ORDER,
        Some(order) => match usize::try_from(*order.get_ref()) {
            Ok(number) if (1..=MAX_ORDER).contains(&number) => number,
            _ => {
                let text = order.get_ref().to_string();
                let problem = format!("expected an order from 1 to {MAX_ORDER}");
                let key = (table, "filter_order");
                return Err(invalid(source, &order.span(), key, &text, problem));
            }
        },
    };
    Ok(Some(ChannelFilter { band, order }))
}

fn no_order(
    source: &TomlSource,
    table: &str,
    channel: &ChannelFile,
) -> Result<Option<ChannelFilter>, Error> {
    match &channel.filter_order {
        None => Ok(None),
        Some(order) => {
            let text = order.get_ref().to_string();
            let problem = "an order without low_pass or high_pass filters nothing".to_owned();
            let key = (table, "filter_order");
            Err(invalid(source, &order.span(), key, &text, problem))
        }
    }
}

/// Words for how the displacement rate is made.
pub const RATES: [(&str, RateMethod); 6] = [
    ("automatic", RateMethod::Automatic),
    ("measured", RateMethod::Measured),
    ("central-difference", RateMethod::CentralDifference),
    (
        "savitzky-golay",
        RateMethod::LocalPolynomial {
            order: 2,
            window: None,
        },
    ),
    ("smoothing-spline", RateMethod::SmoothingSpline),
    ("edge-times", RateMethod::EdgeTimes),
];

/// How the rate is made.
///
/// # Errors
/// Another word.
pub fn rate_plan(
    source: &TomlSource,
    value: Option<&Spanned<String>>,
) -> Result<RateMethod, Error> {
    let chosen = choice(source, value, ("[contact]", "rate"), &RATES)?;
    Ok(chosen.unwrap_or_default())
}
