//! One drop: its bounces, their restitution, the ringing of the plate.

use crate::read::{Drop, DropCampaign, PlatePlan, drop_of};
use serde::{Deserialize, Deserializer, Serialize};
use std::f64::consts::TAU;
use windfall_campaign::measure::measured::{
    MeasuredItem, MeasuredItems, MeasuredValue, plain_value, value_with_sd,
};
use windfall_campaign::pipeline::evaluate::Document;
use windfall_campaign::recording::channel::channel_samples;
use windfall_campaign::recording::read::recording_path;
use windfall_campaign::settings::model::ImpactEntry;
use windfall_campaign::store::documents::StoredValue;
use windfall_files::error::Error;
use windfall_files::found::FindingOutcome;
use windfall_files::named::Named;
use windfall_signal::bounce::find::find_bounces;
use windfall_signal::bounce::train::{Bounce, BounceOptions, BounceTrain, PlateRinging};
use windfall_signal::recording::{Channel, Quantity, Recording, Times};
use windfall_signal::restitution::check::check_restitutions;
use windfall_signal::restitution::estimate::{
    DropConditions, Restitution, RestitutionMethod, impact_speed, restitution_from_impulse,
    restitution_from_time,
};
use windfall_signal::restitution::motion::{
    MotionOptions, contact_motions, restitution_from_motion,
};
use windfall_signal::ringing::peaks::{FreeRinging, logarithmic_decrement};
use windfall_signal::uncertain::Uncertain;

/// Names of the methods in tables.
pub const DROP: &str = "drop";
/// Results on single bounces.
pub const BOUNCE: &str = "bounce";

/// A value with its standard uncertainty, as it is kept; SI.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Known {
    /// Value; not a number where there is none.
    #[serde(deserialize_with = "number_or_none")]
    pub value: f64,
    /// Standard uncertainty; not a number where it is not known.
    #[serde(deserialize_with = "number_or_none")]
    pub sd: f64,
}

impl From<Uncertain> for Known {
    fn from(from: Uncertain) -> Self {
        let finite = |value: f64| if value.is_finite() { value } else { f64::NAN };
        Self {
            value: finite(from.value),
            sd: finite(from.sd),
        }
    }
}

/// JSON has no "not a number": it is written as null.
fn number_or_none<'de, D: Deserializer<'de>>(deserializer: D) -> Result<f64, D::Error> {
    Ok(Option::<f64>::deserialize(deserializer)?.unwrap_or(f64::NAN))
}

/// One bounce of a drop; SI.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct MeasuredBounce {
    /// First touch; s.
    pub onset: Known,
    /// How far all onsets of the drop may be off together; s.
    pub onset_shape: f64,
    /// End of the contact; s.
    pub end: Known,
    /// Largest support force until the next bounce; N.
    pub peak: Known,
    /// When; s.
    pub peak_time: f64,
    /// First local maximum of the support force; N.
    pub first_peak: f64,
    /// Impulse of the contact; N s.
    pub impulse: Known,
    /// Whether the force stands at the limit of the instrument.
    pub clipped: bool,
    /// Whether the contact was recorded from before its onset to after its end.
    pub complete: bool,
    /// Speed of approach, where it is known; m/s.
    pub impact_velocity: Option<Known>,
    /// Restitution by every method that applies.
    pub restitutions: Vec<MeasuredRestitution>,
}

/// Restitution of a bounce by one method.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct MeasuredRestitution {
    /// Name of the method: "drop_height", "flights", "impulse", "velocities".
    pub method: String,
    /// Speed of approach; m/s.
    pub impact_velocity: Known,
    /// Coefficient of restitution; 1.
    pub restitution: Known,
}

/// Logarithmic decrement after the first bounce.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct MeasuredDecrement {
    /// Per cycle; 1.
    pub decrement: Known,
    /// Cycles between the two peaks.
    pub cycles: usize,
    /// Damping ratio; 1.
    pub damping_ratio: Known,
    /// Damped period; s.
    pub period: Known,
}

/// Ringing of the plate after the bounces of one drop.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct MeasuredRinging {
    /// Damped period; s.
    pub period: Known,
    /// Damping ratio; 1.
    pub damping_ratio: Known,
    /// Bounces that it comes from.
    pub bounces: usize,
}

/// What one recording gives.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct MeasuredDrop {
    /// Values of the drop, for tables.
    pub item: MeasuredItem,
    /// Values of each bounce, for tables.
    pub parts: Vec<MeasuredItem>,
    /// Mass of the fruit; kg.
    pub mass: Known,
    /// Drop height; m.
    pub height: Known,
    /// Its bounces.
    pub bounces: Vec<MeasuredBounce>,
    /// From onset to onset; s.
    pub intervals: Vec<Known>,
    /// Ringing of the plate, where it was heard.
    pub ringing: Option<MeasuredRinging>,
    /// Its logarithmic decrement after the first bounce.
    pub decrement: Option<MeasuredDecrement>,
    /// Static level before the first contact; N.
    pub static_level: Known,
    /// Standard deviation of the noise of a sample; N.
    pub noise: f64,
}

impl Document for MeasuredDrop {
    fn values(&self) -> Vec<StoredValue> {
        let items = vec![self.item.clone()];
        MeasuredItems { items }.values()
    }
}

/// The bounces of a recording of a campaign.
///
/// # Errors
/// There is no force, or it cannot be used.
pub fn bounce_train(
    campaign: &DropCampaign,
    entry: &ImpactEntry,
    recording: &Recording,
) -> Result<BounceTrain, Error> {
    let force = force_channel(entry, recording)?;
    find_bounces(&force, &bounce_options(campaign, entry)?).map_err(|source| Error::Signal {
        path: recording_path(&campaign.shared.files, entry),
        source: Box::new(source),
    })
}

/// The force channel within the range of an entry.
fn force_channel(entry: &ImpactEntry, recording: &Recording) -> Result<Channel, Error> {
    let samples = channel_samples(recording, Quantity::Force, entry)?;
    let channels = recording.channels.iter();
    let mut whole = channels.filter(|channel| channel.quantity == Quantity::Force);
    match whole.next() {
        // Even spacing is known exactly only to the channel itself.
        Some(channel) if channel.samples.len() == samples.values.len() => Ok(channel.clone()),
        channel => Ok(Channel {
            name: channel.map_or_else(String::new, |channel| channel.name.clone()),
            quantity: Quantity::Force,
            times: Times::Listed(samples.times),
            samples: samples.values,
        }),
    }
}

/// Options for an entry, with what is known of the plate and of the drop.
///
/// # Errors
/// The drop has no mass or no height.
pub fn bounce_options(
    campaign: &DropCampaign,
    entry: &ImpactEntry,
) -> Result<BounceOptions, Error> {
    let drop = drop_of(campaign, entry)?;
    let momentum = drop.mass.value * (2.0 * campaign.rig.gravity * drop.height.value).sqrt();
    Ok(BounceOptions {
        plate: match campaign.rig.plate {
            PlatePlan::Rigid => PlateRinging::Rigid,
            PlatePlan::Sprung {
                mass,
                stiffness: Some(stiffness),
                damping: Some(damping),
            } => known_ringing(mass.value, stiffness.value, damping.value),
            PlatePlan::Sprung { .. } => PlateRinging::Find,
        },
        smallest_impulse: campaign.bounces.least_impulse.map(|part| part * momentum),
        ..campaign.bounces.options
    })
}

/// Damped period and damping ratio of a plate, ζ = c/(2 √(k m)); one that creeps
/// back does not ring.
fn known_ringing(mass: f64, stiffness: f64, damping: f64) -> PlateRinging {
    let damping_ratio = damping / (2.0 * (stiffness * mass).sqrt());
    if damping_ratio >= 1.0 {
        return PlateRinging::Rigid;
    }
    let natural = (stiffness / mass).sqrt();
    PlateRinging::Known {
        period: TAU / (natural * (1.0 - damping_ratio * damping_ratio).sqrt()),
        damping_ratio,
    }
}

/// Everything about one drop.
///
/// # Errors
/// There is no force, mass or height, or the force cannot be used.
pub fn evaluate_drop(
    campaign: &DropCampaign,
    entry: &ImpactEntry,
    recording: &Recording,
) -> Result<MeasuredDrop, Error> {
    let drop = drop_of(campaign, entry)?;
    let train = bounce_train(campaign, entry, recording)?;
    let conditions = DropConditions {
        height: Some(drop.height),
        mass: Some(drop.mass),
        gravity: Uncertain {
            value: campaign.rig.gravity,
            sd: 0.0,
        },
    };
    let mut restitutions = restitution_from_time(&train.bounces, &conditions);
    restitutions.extend(restitution_from_impulse(&train.bounces, &conditions));
    restitutions.extend(from_motion(entry, recording, &train));
    let checked = check_restitutions(&train.bounces, &conditions, &restitutions);
    let bounces: Vec<MeasuredBounce> = (0..train.bounces.len())
        .map(|number| measured_bounce(&train.bounces, number, &conditions, &restitutions))
        .collect();
    let ringing = train.ringing.filter(|ringing| ringing.bounces > 0);
    let mut measured = MeasuredDrop {
        parts: Vec::new(),
        item: blank_item(campaign, entry, &drop),
        mass: drop.mass.into(),
        height: drop.height.into(),
        intervals: train.intervals.iter().map(|i| (*i).into()).collect(),
        bounces,
        ringing: ringing.map(|ringing| MeasuredRinging {
            period: ringing.period.into(),
            damping_ratio: ringing.damping_ratio.into(),
            bounces: ringing.bounces,
        }),
        decrement: decrement(campaign, &train),
        static_level: train.static_level.into(),
        noise: train.noise,
    };
    let mut findings: Vec<FindingOutcome> = train
        .findings
        .iter()
        .map(|finding| outcome(finding.code(), finding))
        .collect();
    findings.extend(
        checked
            .iter()
            .map(|finding| outcome(finding.code(), finding)),
    );
    measured.item.derived = Named(drop_values(&measured));
    let bounces = measured.bounces.len().to_string();
    measured.item.words = Named(vec![("bounces".to_owned(), bounces)]);
    measured.parts = bounce_items(&measured);
    measured.item.findings = findings;
    Ok(measured)
}

fn outcome(code: &str, finding: &dyn std::fmt::Display) -> FindingOutcome {
    FindingOutcome {
        code: code.to_owned(),
        message: finding.to_string(),
    }
}

fn blank_item(campaign: &DropCampaign, entry: &ImpactEntry, drop: &Drop) -> MeasuredItem {
    let height = height_text(drop.height.value);
    MeasuredItem {
        id: entry.id.clone(),
        specimen: entry.specimen.clone(),
        // A mean over heights would mean nothing.
        group: campaign.shared.group_of(entry).or(Some(height)),
        file: entry.file.clone(),
        law: DROP.to_owned(),
        words: Named(Vec::new()),
        parameters: Named(Vec::new()),
        derived: Named(Vec::new()),
        findings: Vec::new(),
    }
}

/// Restitution by measured positions, where there is such a channel: a cart's.
fn from_motion(
    entry: &ImpactEntry,
    recording: &Recording,
    train: &BounceTrain,
) -> Vec<Restitution> {
    let Ok(position) = channel_samples(recording, Quantity::Displacement, entry) else {
        return Vec::new();
    };
    let contacts = train.bounces.iter();
    let contacts: Vec<(f64, f64)> = contacts.map(|b| (b.onset.value, b.end.value)).collect();
    let options = MotionOptions::default();
    restitution_from_motion(&contact_motions(
        &position.times,
        &position.values,
        &contacts,
        &options,
    ))
}

/// Logarithmic decrement of the free ringing after the first bounce.
fn decrement(campaign: &DropCampaign, train: &BounceTrain) -> Option<MeasuredDecrement> {
    let ringing = train.bounces.first()?.ringing?;
    let from = train.times.partition_point(|time| *time < ringing.from);
    let to = train.times.partition_point(|time| *time <= ringing.to);
    let stretch = FreeRinging {
        times: &train.times[from..to],
        force: &train.force[from..to],
        noise: train.noise,
        level_sd: train.static_level.sd,
        period: ringing.period.value,
    };
    let found = logarithmic_decrement(&stretch, campaign.bounces.ringing_cycles)?;
    Some(MeasuredDecrement {
        decrement: found.decrement.into(),
        cycles: found.cycles,
        damping_ratio: found.damping_ratio.into(),
        period: found.period.into(),
    })
}

/// Values of a drop, those of later bounces with their number.
fn drop_values(drop: &MeasuredDrop) -> Vec<(String, MeasuredValue)> {
    let mut values = vec![
        ("drop_height".to_owned(), kept(drop.height, "m")),
        ("mass".to_owned(), kept(drop.mass, "kg")),
        (
            "bounces".to_owned(),
            plain_value(drop.bounces.len() as f64, "1"),
        ),
    ];
    for (number, bounce) in drop.bounces.iter().enumerate() {
        let of_bounce = bounce_values(bounce, drop.mass);
        let interval = drop.intervals.get(number);
        let interval = interval.map(|interval| ("interval".to_owned(), kept(*interval, "s")));
        let named = of_bounce.into_iter().chain(interval);
        values.extend(named.map(|(name, value)| (numbered(&name, number), value)));
    }
    if let Some(ringing) = &drop.ringing {
        values.push(("damped_period".to_owned(), kept(ringing.period, "s")));
        let ratio = kept(ringing.damping_ratio, "1");
        values.push(("damping_ratio".to_owned(), ratio));
    }
    if let Some(decrement) = &drop.decrement {
        let mut push = |name: &str, value| values.push((name.to_owned(), value));
        push("logarithmic_decrement", kept(decrement.decrement, "1"));
        push(
            "decrement_cycles",
            plain_value(decrement.cycles as f64, "1"),
        );
        push(
            "damping_ratio_by_decrement",
            kept(decrement.damping_ratio, "1"),
        );
        push("damped_period_by_peaks", kept(decrement.period, "s"));
    }
    values.push(("static_level".to_owned(), kept(drop.static_level, "N")));
    values.push(("force_noise".to_owned(), plain_value(drop.noise, "N")));
    values.retain(|(_, value)| value.value.is_finite());
    values
}

/// Speed after an impact, v₁ = e v₀. It is e that contains the uncertainty of
/// v₀, not v₁, which was measured.
fn rebound(e: Known, speed: Known) -> Known {
    let of_speed = e.value * speed.sd / speed.value;
    Known {
        value: e.value * speed.value,
        sd: speed.value * (e.sd * e.sd - of_speed * of_speed).max(0.0).sqrt(),
    }
}

/// Energy that an impact takes, m (v₀² − v₁²)/2.
fn absorbed(mass: Known, before: Known, after: Known) -> Known {
    let per_mass = 0.5 * (before.value.powi(2) - after.value.powi(2));
    let of_speeds = (before.value * before.sd).hypot(after.value * after.sd);
    Known {
        value: mass.value * per_mass,
        sd: (mass.value * of_speeds).hypot(per_mass * mass.sd),
    }
}

/// Values of one bounce. `restitution` is that by time: by flight and drop
/// height of the first, by flights of later ones; by velocities where there is
/// none by time.
fn bounce_values(bounce: &MeasuredBounce, mass: Known) -> Vec<(String, MeasuredValue)> {
    let mut values = Vec::new();
    let mut push = |name: &str, value| values.push((name.to_owned(), value));
    if let Some(speed) = bounce.impact_velocity {
        push("impact_velocity", kept(speed, "m/s"));
        let energy = 0.5 * mass.value * speed.value * speed.value;
        let relative = (mass.sd / mass.value).hypot(2.0 * speed.sd / speed.value);
        push(
            "impact_energy",
            value_with_sd(energy, energy * relative, "J"),
        );
    }
    let by = |methods: &[RestitutionMethod]| {
        let code = |method: &RestitutionMethod| method.code();
        let mut found = methods.iter().map(code).filter_map(|code| {
            let mut all = bounce.restitutions.iter();
            all.find(|restitution| restitution.method == code)
        });
        found.next()
    };
    let best = by(&[
        RestitutionMethod::DropHeight,
        RestitutionMethod::Flights,
        RestitutionMethod::Velocities,
    ]);
    if let Some(best) = best {
        let (e, speed) = (best.restitution, best.impact_velocity);
        push("restitution", kept(e, "1"));
        let rebound = rebound(e, speed);
        push("rebound_velocity", kept(rebound, "m/s"));
        push("absorbed_energy", kept(absorbed(mass, speed, rebound), "J"));
    }
    for one in &bounce.restitutions {
        let name = format!("restitution_by_{}", one.method);
        push(&name, kept(one.restitution, "1"));
    }
    push("peak_force", kept(bounce.peak, "N"));
    push("first_peak_force", plain_value(bounce.first_peak, "N"));
    push("contact_duration", contact_duration(bounce));
    push("impulse", kept(bounce.impulse, "N s"));
    values.retain(|(_, value): &(String, MeasuredValue)| value.value.is_finite());
    values
}

/// A drop height for people: "500 mm".
#[must_use]
pub fn height_text(height: f64) -> String {
    let text = format!("{:.3}", 1e3 * height);
    format!("{} mm", text.trim_end_matches('0').trim_end_matches('.'))
}

/// "peak_force", "peak_force_2", "peak_force_3".
fn numbered(name: &str, number: usize) -> String {
    match number {
        0 => name.to_owned(),
        number => format!("{name}_{}", number + 1),
    }
}

fn kept(value: Known, unit: &str) -> MeasuredValue {
    value_with_sd(value.value, value.sd, unit)
}

fn contact_duration(bounce: &MeasuredBounce) -> MeasuredValue {
    let sd = bounce
        .onset
        .sd
        .hypot(bounce.end.sd)
        .hypot(bounce.onset_shape);
    value_with_sd(bounce.end.value - bounce.onset.value, sd, "s")
}

fn measured_bounce(
    bounces: &[Bounce],
    number: usize,
    conditions: &DropConditions,
    restitutions: &[Restitution],
) -> MeasuredBounce {
    let bounce = &bounces[number];
    let of_bounce = restitutions.iter().filter(|one| one.bounce == number);
    let restitutions: Vec<MeasuredRestitution> = of_bounce
        .map(|one| MeasuredRestitution {
            method: one.method.code().to_owned(),
            impact_velocity: one.impact_speed.into(),
            restitution: one.restitution.into(),
        })
        .collect();
    let speed = impact_speed(bounces, number, conditions).map(Known::from);
    MeasuredBounce {
        onset: bounce.onset.into(),
        onset_shape: bounce.onset_shape,
        end: bounce.end.into(),
        peak: Known {
            value: bounce.peak,
            sd: bounce.peak_sd,
        },
        peak_time: bounce.peak_time,
        first_peak: bounce.first_peak,
        impulse: bounce.impulse.into(),
        clipped: bounce.clipped,
        complete: bounce.complete,
        impact_velocity: speed.or(restitutions.first().map(|one| one.impact_velocity)),
        restitutions,
    }
}

/// An item for each bounce of a drop.
fn bounce_items(drop: &MeasuredDrop) -> Vec<MeasuredItem> {
    let item = |(number, bounce): (usize, &MeasuredBounce)| {
        let onset = ("onset".to_owned(), kept(bounce.onset, "s"));
        let values = [onset].into_iter().chain(bounce_values(bounce, drop.mass));
        MeasuredItem {
            id: format!("{}, bounce {}", drop.item.id, number + 1),
            law: BOUNCE.to_owned(),
            words: Named(Vec::new()),
            derived: Named(values.collect()),
            ..drop.item.clone()
        }
    };
    drop.bounces.iter().enumerate().map(item).collect()
}
