//! Signs and zeros of the convention, and samples that do not belong.

use crate::finding::Finding;
use crate::kinematics::{Motion, displacement_from_angles, value_at};
use crate::measure::{Side, Surroundings, glitch};
use crate::noise::colour::mean_inflation;
use crate::noise_track::baseline_persistence;
use crate::options::ExtractOptions;
use crate::track::{Position, Track};
use crate::trigger::{Contacts, Orientation};

/// Fewer samples before contact than this are reported.
const SHORT_BASELINE: usize = 5;

/// An offset is reported if it exceeds this part of the peak force; 1.
const OFFSET_SHARE: f64 = 0.01;

pub(crate) fn oriented_force(
    mut track: Track,
    contacts: &Contacts,
    options: &ExtractOptions,
    findings: &mut Vec<Finding>,
) -> Track {
    for value in &mut track.values {
        *value -= contacts.offset;
    }
    if contacts.quiet.len() < SHORT_BASELINE {
        findings.push(Finding::ShortBaseline {
            channel: track.name.clone(),
            samples: contacts.quiet.len(),
            before: contacts.before,
        });
    } else if contacts.quiet.start > 0 {
        findings.push(Finding::LocalBaseline {
            channel: track.name.clone(),
            samples: contacts.quiet.len(),
            before: contacts.before,
            from: track.times[contacts.quiet.start],
            sd: contacts.trend_sd,
        });
    }
    let peak = contacts.windows.iter().map(|w| w.peak).fold(0.0, f64::max);
    if contacts.offset.abs() > OFFSET_SHARE * peak {
        findings.push(Finding::OffsetRemoved {
            channel: track.name.clone(),
            offset: contacts.offset,
            offset_sd: offset_sd(contacts, baseline_persistence(&track, contacts)),
        });
    }
    orient(&mut track, contacts.reversed, options, findings);
    track
}

/// Standard uncertainty of the mean before contact, with correlated samples.
pub(crate) fn offset_sd(contacts: &Contacts, persistence: Option<f64>) -> f64 {
    let inflation = mean_inflation(persistence.unwrap_or(0.0)).max(1.0);
    let mean = contacts.deviation * (inflation / contacts.quiet.len().max(1) as f64).sqrt();
    mean.hypot(contacts.trend_sd)
}

pub(crate) fn orient(
    track: &mut Track,
    wrong: bool,
    options: &ExtractOptions,
    findings: &mut Vec<Finding>,
) {
    if !wrong {
        return;
    }
    let corrected = options.orientation == Orientation::Correct;
    if corrected {
        for value in &mut track.values {
            *value = -*value;
        }
    }
    findings.push(Finding::Reversed {
        channel: track.name.clone(),
        corrected,
    });
}

pub(crate) fn oriented_displacement(
    position: Position,
    place: &Surroundings,
    options: &ExtractOptions,
    findings: &mut Vec<Finding>,
) -> Track {
    let Position { mut track, arm } = position;
    // During contact the impactor is, on average, where it loads the fruit.
    let zero = value_at(&track.times, &track.values, place.onset);
    for value in &mut track.values {
        *value -= zero;
    }
    let within = mean_between(&track, place.onset, place.end);
    orient(&mut track, within < 0.0, options, findings);
    if let Some(arm) = arm {
        track.values = displacement_from_angles(&track.values, 0.0, arm);
        track.quantum = track.quantum.map(|q| q * arm);
    }
    track
}

/// Mean of the samples in a span of time; interpolated if there is none.
pub(crate) fn mean_between(track: &Track, from: f64, to: f64) -> f64 {
    let first = track.times.partition_point(|&t| t < from);
    let last = track.times.partition_point(|&t| t <= to);
    if last <= first {
        return value_at(&track.times, &track.values, 0.5 * (from + to));
    }
    track.values[first..last].iter().sum::<f64>() / (last - first) as f64
}

/// Removes at most one misfitting sample on either side of the contact.
pub(crate) fn leave_out_glitches(
    track: &mut Track,
    motion: Motion,
    place: &Surroundings,
    options: &ExtractOptions,
    findings: &mut Vec<Finding>,
) {
    let rounding = track.quantum.unwrap_or(0.0) / 12f64.sqrt();
    for side in [Side::After, Side::Before] {
        let samples = (&track.times[..], &track.values[..], motion);
        let driving = options.driving_acceleration;
        if let Some(index) = glitch(samples, rounding, place, side, driving) {
            let time = track.times.remove(index);
            let value = track.values.remove(index);
            findings.push(Finding::Glitch {
                channel: track.name.clone(),
                time,
                value,
            });
        }
    }
}
