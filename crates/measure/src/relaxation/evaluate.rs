//! One recording of stress relaxation: its hold, Maxwell's elements, Peleg's constants.

use crate::measured::{MeasuredItem, MeasuredItems, MeasuredValue, plain_value};
use crate::relaxation::read::RelaxationCampaign;
use windfall_campaign::recording::channel::channel_samples;
use windfall_campaign::recording::read::recording_path;
use windfall_campaign::settings::model::ImpactEntry;
use windfall_compression::fit::CompressionEstimate;
use windfall_compression::relaxation::hold::{Hold, HoldEnd, find_hold};
use windfall_compression::relaxation::maxwell::{HeldForce, MaxwellFit, fit_maxwell};
use windfall_compression::relaxation::peleg::{PelegFit, fit_peleg};
use windfall_files::error::Error;
use windfall_files::found::FindingOutcome;
use windfall_files::named::Named;
use windfall_files::text::number::plain;
use windfall_signal::kinematics::value_at;
use windfall_signal::recording::{Quantity, Recording};

/// Samples of a hold at most that are fitted; more are averaged.
const MOST_SAMPLES: usize = 4000;

/// A model misses a hold when the residuals are this many times the noise.
const MISSES: f64 = 5.0;

/// Less than this part of an element's force left after the ramp is a guess; 1.
const LITTLE_LEFT: f64 = 0.3;

/// A hold of fewer relaxation times does not tell where the force ends.
const SHORT: f64 = 2.0;

/// Peleg's constants as a method.
pub const PELEG: &str = "peleg";

/// What is found in one recording.
pub struct Relaxed {
    /// Where the fruit is held.
    pub hold: Hold,
    /// Times of all samples; s.
    pub times: Vec<f64>,
    /// Force at these times; N.
    pub force: Vec<f64>,
    /// The hold, averaged to a few thousand samples.
    pub held: HeldForce,
    /// Maxwell's model.
    pub maxwell: MaxwellFit,
    /// Peleg's constants.
    pub peleg: PelegFit,
}

/// Finds and fits the hold of an entry.
///
/// # Errors
/// The force is not recorded, or the recording shows no relaxation.
pub fn relaxed(
    campaign: &RelaxationCampaign,
    entry: &ImpactEntry,
    recording: &Recording,
) -> Result<Relaxed, Error> {
    let force = channel_samples(recording, Quantity::Force, entry)?;
    let mut channels = recording.channels.iter();
    let recorded = channels.any(|own| own.quantity == Quantity::Displacement);
    let position = match recorded {
        true => {
            let own = channel_samples(recording, Quantity::Displacement, entry)?;
            let at = |time: &f64| value_at(&own.times, &own.values, *time);
            Some(force.times.iter().map(at).collect::<Vec<f64>>())
        }
        false => None,
    };
    let hold = find_hold(
        &force.times,
        &force.values,
        position.as_deref(),
        campaign.touch_force,
    )
    .map_err(|source| failed(campaign, entry, source))?;
    let range = hold.start..=hold.end;
    let ramp = hold.ramp.or(campaign.ramp);
    let held = HeldForce {
        ramp,
        exponent: campaign.exponent,
        ..averaged(&force.times[range.clone()], &force.values[range])
    };
    let maxwell = fit_maxwell(&held, campaign.elements);
    Ok(Relaxed {
        maxwell: maxwell.map_err(|source| failed(campaign, entry, source))?,
        peleg: fit_peleg(&held.times, &held.force),
        hold,
        held,
        times: force.times,
        force: force.values,
    })
}

fn failed(
    campaign: &RelaxationCampaign,
    entry: &ImpactEntry,
    source: impl std::error::Error + Send + Sync + 'static,
) -> Error {
    Error::Evaluation {
        path: recording_path(&campaign.shared.files, entry),
        source: Box::new(source),
    }
}

/// Times since the first, and means over blocks of equal length.
fn averaged(times: &[f64], force: &[f64]) -> HeldForce {
    let block = times.len().div_ceil(MOST_SAMPLES);
    let mean = |values: &[f64], zero: f64| -> Vec<f64> {
        let blocks = values.chunks(block);
        blocks
            .map(|own| own.iter().map(|value| value - zero).sum::<f64>() / own.len() as f64)
            .collect()
    };
    HeldForce {
        times: mean(times, times[0]),
        force: mean(force, 0.0),
        ramp: None,
        exponent: 1.0,
    }
}

/// Everything about one entry: Maxwell's elements, then Peleg's constants.
///
/// # Errors
/// See [`relaxed`].
pub fn evaluate_relaxation(
    campaign: &RelaxationCampaign,
    entry: &ImpactEntry,
    recording: &Recording,
) -> Result<MeasuredItems, Error> {
    let found = relaxed(campaign, entry, recording)?;
    let elements = found.maxwell.elements.len();
    let maxwell = MeasuredItem {
        words: Named::of([("hold_ended_by", ended_by(&found.hold).to_owned())]),
        parameters: parameters_of_maxwell(&found.maxwell),
        derived: hold_values(&found),
        findings: findings(campaign, &found),
        ..MeasuredItem::of(&campaign.shared, entry, &format!("maxwell-{elements}"))
    };
    let peleg = &found.peleg;
    let parameters = [
        ("peleg_k1", measured(&peleg.k1, "s")),
        ("peleg_k2", measured(&peleg.k2, "1")),
        ("residual_fraction", measured(&peleg.residual, "1")),
    ];
    let mut told = Vec::new();
    if !peleg.converged {
        told.push(FindingOutcome::new(
            "fit_not_converged",
            "the fit of Peleg's constants did not converge; they are not to be used",
        ));
    }
    let peleg = MeasuredItem {
        parameters: Named::of(parameters),
        derived: Named::of([
            ("initial_force", measured(&peleg.initial_force, "N")),
            ("residual_rms", plain_value(peleg.rms, "N")),
        ]),
        findings: told,
        ..MeasuredItem::of(&campaign.shared, entry, PELEG)
    };
    Ok(MeasuredItems {
        items: vec![maxwell, peleg],
    })
}

fn ended_by(hold: &Hold) -> &'static str {
    match hold.ended_by {
        HoldEnd::RecordingEnd => "end of recording",
        HoldEnd::Moved => "movement",
        HoldEnd::ForceFell => "fall of the force",
    }
}

fn parameters_of_maxwell(fit: &MaxwellFit) -> Named<MeasuredValue> {
    let mut values = Named::of([("residual_fraction", measured(&fit.equilibrium, "1"))]);
    for (place, element) in fit.elements.iter().enumerate() {
        let number = place + 1;
        values.push(
            format!("fraction_{number}"),
            measured(&element.fraction, "1"),
        );
        let time = measured(&element.time, "s");
        values.push(format!("relaxation_time_{number}"), time);
    }
    values
}

fn measured(estimate: &CompressionEstimate, unit: &str) -> MeasuredValue {
    let finite = |value: f64| value.is_finite().then_some(value);
    MeasuredValue {
        value: estimate.value,
        sd: finite(estimate.sd),
        low: finite(estimate.low),
        high: finite(estimate.high),
        unit: unit.to_owned(),
    }
}

fn hold_values(found: &Relaxed) -> Named<MeasuredValue> {
    let (fit, hold, held) = (&found.maxwell, &found.hold, &found.held);
    let last = held.times.len() - 1;
    let tail = &held.force[last - last / 50..];
    let end = tail.iter().sum::<f64>() / tail.len() as f64;
    let start = fit.force_at_start();
    let mut values = Named::of([
        ("initial_force", measured(&fit.initial_force, "N")),
        ("residual_force", measured(&fit.equilibrium_force, "N")),
        ("hold_force", plain_value(start, "N")),
        ("end_force", plain_value(end, "N")),
        ("relaxed_fraction", plain_value(1.0 - end / start, "1")),
        ("hold_duration", plain_value(held.times[last], "s")),
    ]);
    if let Some(ramp) = held.ramp {
        values.push("ramp_duration", plain_value(ramp, "s"));
    }
    values.push("residual_rms", plain_value(fit.rms, "N"));
    values.push("force_noise", plain_value(hold.force_noise, "N"));
    values
}

fn findings(campaign: &RelaxationCampaign, found: &Relaxed) -> Vec<FindingOutcome> {
    let mut findings = Vec::new();
    let mut tell = |code: &str, message: String| findings.push(FindingOutcome::new(code, message));
    let (fit, hold, held) = (&found.maxwell, &found.hold, &found.held);
    if hold.ramp.is_none() {
        let told = match campaign.ramp {
            Some(ramp) => format!("the ramp of {} s is that of campaign.toml", plain(ramp)),
            None => "fractions are those at the start of the hold, not of a sudden step; give its \
                     duration as `ramp` in [relaxation]"
                .to_owned(),
        };
        tell(
            "ramp_not_recorded",
            format!("there is force from the first sample on, so the ramp is not recorded: {told}"),
        );
    }
    if hold.ended_by == HoldEnd::ForceFell {
        let after = held.times[held.times.len() - 1];
        tell(
            "hold_ended",
            format!(
                "the force falls faster again {} s after the hold began, as when the machine moves \
                 back: what follows is not used; a channel of the position would tell",
                plain(after)
            ),
        );
    }
    for (place, element) in fit.elements.iter().enumerate() {
        if element.left < LITTLE_LEFT {
            tell(
                "ramp_long",
                format!(
                    "only {} % of the force of element {} was left when the ramp ended: its fraction \
                     is mostly a correction; compress faster",
                    plain(100.0 * element.left),
                    place + 1
                ),
            );
        }
    }
    let slowest = fit.elements.last().map_or(0.0, |own| own.time.value);
    let duration = held.times[held.times.len() - 1];
    if duration < SHORT * slowest {
        tell(
            "hold_short",
            format!(
                "the hold of {} s is shorter than {} relaxation times of {} s: where the force ends is \
                 extrapolated; hold longer",
                plain(duration),
                plain(SHORT),
                plain(slowest)
            ),
        );
    }
    let noise = hold.force_noise.max(f64::MIN_POSITIVE);
    let part = fit.rms / fit.force_at_start();
    if fit.rms > MISSES * noise && part > 0.002 {
        tell(
            "model_misses_hold",
            format!(
                "maxwell-{} describes the hold to {} % of its force, {} times the noise: its \
                 parameters are a compromise",
                fit.elements.len(),
                plain(100.0 * part),
                plain(fit.rms / noise)
            ),
        );
    }
    if !fit.converged {
        tell(
            "fit_not_converged",
            "the fit did not converge; its parameters are not to be used".to_owned(),
        );
    }
    if fit.at_bound {
        tell(
            "element_not_told",
            "an element has no force, or a relaxation time at its bound: the hold does not tell so \
             many elements; set fewer in `elements`, or hold longer"
                .to_owned(),
        );
    }
    findings
}
