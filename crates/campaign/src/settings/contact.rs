//! `[contact]` of campaign.toml.

use crate::settings::channels::encoder_plan;
use crate::settings::conditioning::{conditioning_plan, rate_plan};
use crate::settings::file::{CampaignFile, ContactFile, QuantityText};
use crate::settings::model::RigPlan;
use windfall_files::error::Error;
use windfall_files::text::spanned::Spanned;
use windfall_files::text::toml_source::{
    Needed, TomlSource, choice, invalid, number_that, optional_quantity, positive_quantity, refused,
};
use windfall_signal::ExtractOptions;
use windfall_signal::encoder::edge_rate::CountTimes;
use windfall_signal::kinematics::Encoder;
use windfall_signal::options::RateMethod;
use windfall_signal::trigger::{Baseline, ContactChoice, Threshold};

/// Words of `[contact] baseline`.
pub const BASELINES: [(&str, Baseline); 3] = [
    ("remove", Baseline::Remove),
    ("drift", Baseline::Drift),
    ("keep", Baseline::Keep),
];

/// Words of `[contact] contact`.
pub const CONTACTS: [(&str, ContactChoice); 2] = [
    ("first", ContactChoice::First),
    ("strongest", ContactChoice::Strongest),
];

/// Words of `[encoder] times`.
pub const COUNT_TIMES: [(&str, CountTimes); 2] = [
    ("sampled", CountTimes::Sampled),
    ("events", CountTimes::Events),
];

const TABLE: &str = "[contact]";

/// Text that asks for a threshold from the noise.
const AUTO: &str = "auto";

/// How impacts are cut out of the recordings of a campaign.
///
/// # Errors
/// A value cannot be used, or an encoder does not fit the rig.
pub fn contact_plan(
    source: &TomlSource,
    file: &CampaignFile,
    rig: &RigPlan,
) -> Result<ExtractOptions, Error> {
    let contact = &file.contact;
    let mut options = ExtractOptions::default();
    options.trigger.threshold = threshold(source, contact.threshold.as_ref())?;
    let (word, key) = (contact.baseline.as_ref(), (TABLE, "baseline"));
    let baseline = choice(source, word, key, &BASELINES)?;
    options.trigger.baseline = baseline.unwrap_or(options.trigger.baseline);
    let (word, key) = (contact.contact.as_ref(), (TABLE, "contact"));
    let chosen = choice(source, word, key, &CONTACTS)?;
    options.trigger.choice = chosen.unwrap_or(options.trigger.choice);
    let expected = "a part of the contact's duration from 0 to 100, such as 0.2";
    let margin = |value: &Option<Spanned<f64>>, key, default| {
        let fits = |part| (0.0..=100.0).contains(&part);
        let margin = number_that(source, value.as_ref(), (TABLE, key), fits, expected)?;
        Ok::<f64, Error>(margin.unwrap_or(default))
    };
    let (before, after) = (options.margin_before, options.margin_after);
    options.margin_before = margin(&contact.margin_before, "margin_before", before)?;
    options.margin_after = margin(&contact.margin_after, "margin_after", after)?;
    let usual = if contact.margin_before.is_some() || contact.margin_after.is_some() {
        0.0
    } else {
        options.free_flight
    };
    options.free_flight = margin(&contact.free_flight, "free_flight", usual)?;
    let (key, fits) = ((TABLE, "release"), |part| part > 0.0 && part <= 1.0);
    let expected = "a part of the threshold above 0, at most 1, such as 0.5";
    let release = number_that(source, contact.release.as_ref(), key, fits, expected)?;
    options.trigger.release = release.unwrap_or(options.trigger.release);
    let time = |value: &Option<Spanned<QuantityText>>, key, about| {
        span_of_time(source, value.as_ref(), key, about)
    };
    let gap = (
        "contacts closer than this are one",
        "minimum_gap = \"1 ms\"",
    );
    options.trigger.minimum_gap = time(&contact.minimum_gap, "minimum_gap", gap)?;
    let before = ("what is kept before contact", "pre_trigger = \"2 ms\"");
    options.pre_trigger = time(&contact.pre_trigger, "pre_trigger", before)?.unwrap_or(0.0);
    let after = ("what is kept after contact", "post_trigger = \"2 ms\"");
    options.post_trigger = time(&contact.post_trigger, "post_trigger", after)?.unwrap_or(0.0);
    options.rate = rate_plan(source, contact.rate.as_ref())?;
    options.edge_window = edge_window(source, contact, options.rate)?;
    options.count_times = count_times(source, file)?;
    options.conditioning = conditioning_plan(source, file.channels.as_ref())?;
    options.encoder = encoder_plan(source, file)?;
    match rig {
        RigPlan::Pendulum(pendulum) => options.arm = Some(pendulum.arm),
        RigPlan::Carriage {
            driving_acceleration,
            ..
        } => {
            options.driving_acceleration = *driving_acceleration;
            check_encoder(source, file, options.encoder)?;
        }
    }
    Ok(options)
}

fn threshold(
    source: &TomlSource,
    value: Option<&Spanned<QuantityText>>,
) -> Result<Threshold, Error> {
    let needed = Needed::of(
        TABLE,
        "threshold",
        "force above which there is contact",
        "N",
        "threshold = \"1 N\"   or   threshold = \"auto\"",
    );
    let given = value.filter(|text| text.get_ref().0 != AUTO);
    let force = positive_quantity(source, given, &needed)?;
    Ok(force.map_or(Threshold::default(), Threshold::Fixed))
}

/// A time of `[contact]` that may be left out, not below zero; s.
fn span_of_time(
    source: &TomlSource,
    value: Option<&Spanned<QuantityText>>,
    key: &'static str,
    (meaning, example): (&'static str, &'static str),
) -> Result<Option<f64>, Error> {
    let needed = Needed::of(TABLE, key, meaning, "s", example);
    match (value, optional_quantity(source, value, &needed)?) {
        (Some(value), Some(time)) if time < 0.0 => {
            let problem = "must not be below zero";
            Err(refused(source, value, (TABLE, key), problem))
        }
        (_, time) => Ok(time),
    }
}

/// How far the edges of a rate from edge times lie apart at least; s.
fn edge_window(
    source: &TomlSource,
    contact: &ContactFile,
    method: RateMethod,
) -> Result<f64, Error> {
    let about = (
        "least time between the two edges of a rate",
        "rate_window = \"0.3 ms\"",
    );
    let value = contact.rate_window.as_ref();
    let window = span_of_time(source, value, "rate_window", about)?;
    match (value, window) {
        (Some(value), Some(_)) if method != RateMethod::EdgeTimes => {
            let problem = "belongs to rate = \"edge-times\"; remove the line or set that";
            Err(refused(source, value, (TABLE, "rate_window"), problem))
        }
        (_, window) => Ok(window.unwrap_or(0.0)),
    }
}

/// What the times beside counts mean.
fn count_times(source: &TomlSource, file: &CampaignFile) -> Result<CountTimes, Error> {
    let times = file
        .encoder
        .as_ref()
        .and_then(|encoder| encoder.get_ref().times.as_ref());
    let chosen = choice(source, times, ("[encoder]", "times"), &COUNT_TIMES)?;
    Ok(chosen.unwrap_or_default())
}

fn check_encoder(
    source: &TomlSource,
    file: &CampaignFile,
    encoder: Option<Encoder>,
) -> Result<(), Error> {
    let (
        Some(Encoder::Rotary {
            counts_per_revolution,
        }),
        Some(table),
    ) = (encoder, &file.encoder)
    else {
        return Ok(());
    };
    let problem = "a carriage has no arm; give the length of one count: count_length = \"0.17 mm\"";
    let key = ("[encoder]", "counts_per_revolution");
    let counts = counts_per_revolution.to_string();
    Err(invalid(
        source,
        &table.span(),
        key,
        &counts,
        problem.to_owned(),
    ))
}
