//! Filters and the tip of `[channels.*]`, and how the rate is made.

use crate::settings::channels::channels_of;
use crate::settings::file::{ChannelFile, ChannelsFile, QuantityText};
use windfall_files::error::Error;
use windfall_files::text::spanned::Spanned;
use windfall_files::text::toml_source::{
    Needed, TomlSource, choice, number_that, positive_quantity, refused,
};
use windfall_signal::conditioning::{ChannelFilter, Conditioning, USUAL_ORDER};
use windfall_signal::filter::butterworth::{Band, MAX_ORDER};
use windfall_signal::options::RateMethod;
use windfall_signal::recording::Quantity;

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
    for (kind, channel) in channels_of(channels).filter(|(kind, _)| kind.unit.is_empty()) {
        let why = "counts are never filtered";
        refuse_conditioning(source, kind.table, channel.get_ref(), why)?;
    }
    let of = |table: &'static str, channel: &Option<Spanned<ChannelFile>>| match channel {
        Some(channel) => filter_of(source, table, channel.get_ref()),
        None => Ok(None),
    };
    let position = match of("[channels.position]", &channels.position)? {
        None => of("[channels.angle]", &channels.angle)?,
        filter => filter,
    };
    let mut force_tip = None;
    for (kind, channel) in channels_of(channels) {
        match &channel.get_ref().tip_mass {
            Some(tip) if kind.quantity != Quantity::Force => {
                let problem = "a tip stands ahead of a force sensor: put it under [channels.force]";
                return Err(refused(source, tip, (kind.table, "tip_mass"), problem));
            }
            tip => force_tip = force_tip.or(tip.as_ref()),
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
        tip_mass: positive_quantity(source, force_tip, &needed)?,
    })
}

/// Refuses the keys of filters and tip on a channel that has none of them.
///
/// # Errors
/// One of them is there.
pub fn refuse_conditioning(
    source: &TomlSource,
    table: &str,
    channel: &ChannelFile,
    why: &str,
) -> Result<(), Error> {
    let problem = format!("{why}; remove the line");
    for (key, value) in [
        ("low_pass", &channel.low_pass),
        ("high_pass", &channel.high_pass),
        ("tip_mass", &channel.tip_mass),
    ] {
        if let Some(value) = value {
            return Err(refused(source, value, (table, key), problem));
        }
    }
    match &channel.filter_order {
        Some(order) => Err(refused(source, order, (table, "filter_order"), problem)),
        None => Ok(()),
    }
}

/// [`refuse_conditioning`] of all channels.
///
/// # Errors
/// One of the keys is there.
pub fn refuse_all_conditioning(
    source: &TomlSource,
    channels: Option<&Spanned<ChannelsFile>>,
    why: &str,
) -> Result<(), Error> {
    let all = channels.map(|file| channels_of(file.get_ref()));
    let mut all = all.into_iter().flatten();
    all.try_for_each(|(kind, channel)| {
        refuse_conditioning(source, kind.table, channel.get_ref(), why)
    })
}

fn filter_of(
    source: &TomlSource,
    table: &'static str,
    channel: &ChannelFile,
) -> Result<Option<ChannelFilter>, Error> {
    let cutoff = |value: Option<&Spanned<QuantityText>>, key| {
        let meaning = "cut-off of a zero-phase Butterworth filter";
        let needed = Needed::of(table, key, meaning, "Hz", "low_pass = \"5 kHz\"");
        positive_quantity(source, value, &needed)
    };
    let low_pass = cutoff(channel.low_pass.as_ref(), "low_pass")?;
    let high_pass = cutoff(channel.high_pass.as_ref(), "high_pass")?;
    let band = match (low_pass, high_pass) {
        (None, None) => return no_order(source, table, channel),
        (Some(cutoff), None) => Band::LowPass(cutoff),
        (None, Some(cutoff)) => Band::HighPass(cutoff),
        (Some(high), Some(low)) => Band::BandPass(low, high),
    };
    let orders = 1..=MAX_ORDER as i64;
    let expected = format!("an order from 1 to {MAX_ORDER}");
    let (key, fits) = ((table, "filter_order"), |order| orders.contains(&order));
    let order = number_that(source, channel.filter_order.as_ref(), key, fits, &expected)?;
    let order = order.map_or(USUAL_ORDER, |order| order as usize);
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
            let problem = "an order without low_pass or high_pass filters nothing";
            Err(refused(source, order, (table, "filter_order"), problem))
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
