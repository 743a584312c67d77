//! One impact of a campaign of repeated impacts.

use crate::measured::{MeasuredItem, MeasuredItems, plain_value, value_with_sd};
use crate::repeats::read::{RepeatsCampaign, cell_of, energy_of};
use serde::{Deserialize, Serialize};
use windfall_campaign::error::CampaignError;
use windfall_campaign::pipeline::evaluate::Document;
use windfall_campaign::recording::read::recording_path;
use windfall_campaign::settings::model::ImpactEntry;
use windfall_campaign::store::documents::StoredValue;
use windfall_files::error::Error;
use windfall_files::found::FindingOutcome;
use windfall_files::named::Named;
use windfall_repeat::align::features;
use windfall_signal::impact::Series;
use windfall_signal::recording::Recording;
use windfall_signal::trigger::ContactChoice;
use windfall_signal::{ExtractOptions, extract_impact};

/// Name of the method in tables.
pub const IMPACT: &str = "impact";

/// What one recording gives: values, and the force for the comparisons.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RepeatImpact {
    /// Values of this impact alone.
    pub item: MeasuredItem,
    /// Impact energy; J.
    pub energy: f64,
    /// Spot on the specimen.
    pub spot: String,
    /// Number of the impact on this spot at this energy, where it is given.
    pub repeat: Option<f64>,
    /// Whether the specimen cannot be damaged.
    pub reference: bool,
    /// Sampling times of the force; s.
    pub times: Vec<f64>,
    /// Force; N.
    pub force: Vec<f64>,
    /// Standard deviation of its noise; N.
    pub noise: f64,
}

impl Document for RepeatImpact {
    fn values(&self) -> Vec<StoredValue> {
        let items = vec![self.item.clone()];
        MeasuredItems { items }.values()
    }
}

/// The force of an impact as the comparisons take it.
pub fn series_of(impact: &RepeatImpact) -> Series {
    Series {
        times: impact.times.clone(),
        values: impact.force.clone(),
        noise: impact.noise,
        ..Series::default()
    }
}

/// Cuts the impact out of a recording and reads it.
///
/// # Errors
/// There is no force or no contact, or it is cut off.
pub fn evaluate_impact(
    campaign: &RepeatsCampaign,
    entry: &ImpactEntry,
    recording: &Recording,
) -> Result<RepeatImpact, Error> {
    let mut options = ExtractOptions {
        conditioning: campaign.conditioning,
        ..ExtractOptions::default()
    };
    if entry.from.is_some() || entry.to.is_some() {
        options.trigger.choice = ContactChoice::Within {
            from: entry.from.unwrap_or(f64::NEG_INFINITY),
            to: entry.to.unwrap_or(f64::INFINITY),
        };
    }
    let signal = |source| Error::signal(recording_path(&campaign.shared.files, entry), source);
    let (impact, findings) = extract_impact(recording, &options).map_err(signal)?;
    let force = impact.force.ok_or_else(|| {
        Error::from(CampaignError::ChannelNotMapped {
            item: entry.id.clone(),
            quantity: "force".to_owned(),
        })
    })?;
    let read = features(&force, &campaign.align).map_err(signal)?;
    let energy = energy_of(campaign, entry)?;
    let (column, value) = &campaign.reference;
    let reference = cell_of(campaign, entry, column) == value;
    let spot = cell_of(campaign, entry, "spot").to_owned();
    let repeat = cell_of(campaign, entry, "repeat").parse().ok();
    let mut derived = Named::of([
        ("energy", plain_value(energy, "J")),
        ("peak_force", plain_value(read.peak, "N")),
        ("contact_duration", plain_value(read.duration, "s")),
        ("rise_slope", plain_value(read.rise_slope, "N/s")),
        ("force_noise", plain_value(force.noise, "N")),
    ]);
    if let Some(value) = impact.measured.impulse {
        let sd = impact.measured.impulse_sd.unwrap_or(f64::NAN);
        derived.push("impulse", value_with_sd(value, sd, "N s"));
    }
    let number = cell_of(campaign, entry, "repeat");
    let role = if reference { "reference, " } else { "" };
    let mut words = Named::of([("repeat", number.to_owned())]);
    if !spot.is_empty() {
        words.push("spot", spot.clone());
    }
    let item = MeasuredItem {
        group: Some(format!("{role}{energy:.4} J, impact {number}")),
        words,
        derived,
        findings: findings
            .iter()
            .map(|finding| FindingOutcome::new(finding.code(), finding.to_string()))
            .collect(),
        ..MeasuredItem::of(&campaign.shared, entry, IMPACT)
    };
    Ok(RepeatImpact {
        item,
        energy,
        spot,
        repeat,
        reference,
        times: force.times,
        force: force.values,
        noise: force.noise,
    })
}
