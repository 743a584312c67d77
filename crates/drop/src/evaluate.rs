//! One drop: its bounces, their restitution, the ringing of the plate.

use crate::measured::{
    Known, MeasuredBounce, MeasuredDecrement, MeasuredDrop, MeasuredRestitution, MeasuredRinging,
};
use crate::read::{DropCampaign, PlatePlan, drop_of};
use std::f64::consts::TAU;
use windfall_campaign::recording::channel::channel_samples;
use windfall_campaign::recording::read::recording_path;
use windfall_campaign::settings::model::ImpactEntry;
use windfall_files::error::Error;
use windfall_files::found::FindingOutcome;
use windfall_files::named::Named;
use windfall_measure::measured::{MeasuredItem, MeasuredValue, plain_value, value_with_sd};
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
    let bounces = find_bounces(&force, &bounce_options(campaign, entry)?);
    bounces.map_err(|source| Error::signal(recording_path(&campaign.shared.files, entry), source))
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

/// Damped period and damping ratio ζ = c/(2 √(k m)) of a plate; none if overdamped.
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
        gravity: Uncertain::exact(campaign.rig.gravity),
    };
    let mut restitutions = restitution_from_time(&train.bounces, &conditions);
    restitutions.extend(restitution_from_impulse(&train.bounces, &conditions));
    restitutions.extend(from_motion(entry, recording, &train));
    let checked = check_restitutions(&train.bounces, &conditions, &restitutions);
    let bounces: Vec<MeasuredBounce> = (0..train.bounces.len())
        .map(|number| measured_bounce(&train.bounces, number, &conditions, &restitutions))
        .collect();
    let ringing = train.ringing.filter(|ringing| ringing.bounces > 0);
    let mut item = MeasuredItem::of(&campaign.shared, entry, DROP);
    // A mean over heights would mean nothing.
    item.group = item.group.or(Some(height_text(drop.height.value)));
    let mut measured = MeasuredDrop {
        parts: Vec::new(),
        item,
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
    measured.item.derived = drop_values(&measured);
    let bounces = measured.bounces.len().to_string();
    measured.item.words = Named::of([("bounces", bounces)]);
    measured.parts = bounce_items(&measured);
    let of_signal = train.findings.iter();
    let of_signal = of_signal.map(|f| FindingOutcome::new(f.code(), f.to_string()));
    let of_restitution = checked
        .iter()
        .map(|f| FindingOutcome::new(f.code(), f.to_string()));
    measured.item.findings = of_signal.chain(of_restitution).collect();
    Ok(measured)
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
    let (times, values) = (&position.times, &position.values);
    restitution_from_motion(&contact_motions(times, values, &contacts, &options))
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
fn drop_values(drop: &MeasuredDrop) -> Named<MeasuredValue> {
    let mut values = Named::of([
        ("drop_height", drop.height.shown("m")),
        ("mass", drop.mass.shown("kg")),
        ("bounces", plain_value(drop.bounces.len() as f64, "1")),
    ]);
    for (number, bounce) in drop.bounces.iter().enumerate() {
        for (name, value) in bounce_values(bounce, drop.mass).0 {
            values.push(numbered(&name, number), value);
        }
        if let Some(interval) = drop.intervals.get(number) {
            values.push(numbered("interval", number), interval.shown("s"));
        }
    }
    if let Some(ringing) = &drop.ringing {
        values.push("damped_period", ringing.period.shown("s"));
        values.push("damping_ratio", ringing.damping_ratio.shown("1"));
    }
    if let Some(found) = &drop.decrement {
        values.push("logarithmic_decrement", found.decrement.shown("1"));
        values.push("decrement_cycles", plain_value(found.cycles as f64, "1"));
        values.push("damping_ratio_by_decrement", found.damping_ratio.shown("1"));
        values.push("damped_period_by_peaks", found.period.shown("s"));
    }
    values.push("static_level", drop.static_level.shown("N"));
    values.push("force_noise", plain_value(drop.noise, "N"));
    values.0.retain(|(_, value)| value.value.is_finite());
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
fn bounce_values(bounce: &MeasuredBounce, mass: Known) -> Named<MeasuredValue> {
    let mut values = Named::default();
    if let Some(speed) = bounce.impact_velocity {
        values.push("impact_velocity", speed.shown("m/s"));
        let energy = 0.5 * mass.value * speed.value * speed.value;
        let relative = (mass.sd / mass.value).hypot(2.0 * speed.sd / speed.value);
        values.push(
            "impact_energy",
            value_with_sd(energy, energy * relative, "J"),
        );
    }
    let methods = [
        RestitutionMethod::DropHeight,
        RestitutionMethod::Flights,
        RestitutionMethod::Velocities,
    ];
    let best = methods.iter().find_map(|method| {
        let mut all = bounce.restitutions.iter();
        all.find(|restitution| restitution.method == method.code())
    });
    if let Some(best) = best {
        let (e, speed) = (best.restitution, best.impact_velocity);
        values.push("restitution", e.shown("1"));
        let rebound = rebound(e, speed);
        values.push("rebound_velocity", rebound.shown("m/s"));
        values.push("absorbed_energy", absorbed(mass, speed, rebound).shown("J"));
    }
    for one in &bounce.restitutions {
        values.push(
            format!("restitution_by_{}", one.method),
            one.restitution.shown("1"),
        );
    }
    values.push("peak_force", bounce.peak.shown("N"));
    values.push("first_peak_force", plain_value(bounce.first_peak, "N"));
    values.push("contact_duration", contact_duration(bounce));
    values.push("impulse", bounce.impulse.shown("N s"));
    values.0.retain(|(_, value)| value.value.is_finite());
    values
}

/// A drop height for people: "500 mm".
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

fn contact_duration(bounce: &MeasuredBounce) -> MeasuredValue {
    let (onset, end) = (bounce.onset, bounce.end);
    let sd = onset.sd.hypot(end.sd).hypot(bounce.onset_shape);
    value_with_sd(end.value - onset.value, sd, "s")
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
        let mut derived = Named::of([("onset", bounce.onset.shown("s"))]);
        derived.0.extend(bounce_values(bounce, drop.mass).0);
        MeasuredItem {
            id: format!("{}, bounce {}", drop.item.id, number + 1),
            law: BOUNCE.to_owned(),
            words: Named::default(),
            derived,
            ..drop.item.clone()
        }
    };
    drop.bounces.iter().enumerate().map(item).collect()
}
