//! `[contact]` of campaign.toml.

use crate::campaign::RigPlan;
use crate::error::Error;
use crate::file_campaign::{CampaignFile, QuantityText};
use crate::read_channels::encoder_plan;
use crate::toml_source::{Needed, TomlSource, choice, invalid, optional_quantity};
use toml::Spanned;
use windfall_signal::ExtractOptions;
use windfall_signal::kinematics::Encoder;
use windfall_signal::trigger::{Baseline, ContactChoice, Threshold};

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
    let baselines = [("remove", Baseline::Remove), ("keep", Baseline::Keep)];
    if let Some(baseline) = choice(
        source,
        contact.baseline.as_ref(),
        (TABLE, "baseline"),
        &baselines,
    )? {
        options.trigger.baseline = baseline;
    }
    let contacts = [
        ("first", ContactChoice::First),
        ("strongest", ContactChoice::Strongest),
    ];
    if let Some(chosen) = choice(
        source,
        contact.contact.as_ref(),
        (TABLE, "contact"),
        &contacts,
    )? {
        options.trigger.choice = chosen;
    }
    if let Some(margin) = &contact.margin_before {
        options.margin_before = checked_margin(source, margin, "margin_before")?;
    }
    if let Some(margin) = &contact.margin_after {
        options.margin_after = checked_margin(source, margin, "margin_after")?;
    }
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
    let needed = Needed {
        table: TABLE,
        key: "threshold",
        meaning: "force above which there is contact",
        unit: "N",
        example: "threshold = \"1 N\"   or   threshold = \"auto\"",
    };
    let Some(text) = value.filter(|text| text.get_ref().0 != AUTO) else {
        return Ok(Threshold::default());
    };
    match optional_quantity(source, value, &needed)? {
        Some(force) if force > 0.0 => Ok(Threshold::Fixed(force)),
        _ => {
            let problem = format!("must be above zero, for example: {}", needed.example);
            let at = (TABLE, "threshold");
            Err(invalid(
                source,
                &text.span(),
                at,
                &text.get_ref().0,
                problem,
            ))
        }
    }
}

fn checked_margin(
    source: &TomlSource,
    margin: &Spanned<f64>,
    key: &'static str,
) -> Result<f64, Error> {
    let value = *margin.get_ref();
    if (0.0..=100.0).contains(&value) {
        return Ok(value);
    }
    let problem = "expected a part of the contact's duration from 0 to 100, such as 0.2".to_owned();
    Err(invalid(
        source,
        &margin.span(),
        (TABLE, key),
        &value.to_string(),
        problem,
    ))
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
    let problem = "a carriage has no arm; give the length of one count: \
                   count_length = \"0.17 mm\""
        .to_owned();
    let at = ("[encoder]", "counts_per_revolution");
    Err(invalid(
        source,
        &table.span(),
        at,
        &counts_per_revolution.to_string(),
        problem,
    ))
}
