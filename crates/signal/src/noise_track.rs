//! Noise of a channel of one recording.

use crate::finding::Finding;
use crate::measure::Surroundings;
use crate::noise::colour::persistence;
use crate::noise::estimate::{Noise, NoiseSource, combined_noise, scatter_about_polynomial};
use crate::track::Track;
use crate::trigger::Contacts;

/// Samples of a block within which a signal is taken as a parabola plus noise.
const NOISE_BLOCK: usize = 8;

/// Blocks that a contact must hold to find the noise within it.
const NOISE_BLOCKS: usize = 10;

/// Fewest samples before contact that tell the noise of the force.
const LEAST_BASELINE: usize = 5;

/// Scatter about parabolas through blocks of samples, in the contact or before it; at
/// least the rounding of a quantum.
pub(crate) fn noise_of(track: &Track, place: &Surroundings, findings: &mut Vec<Finding>) -> f64 {
    let first = track.times.partition_point(|&t| t < place.onset);
    let last = track.times.partition_point(|&t| t <= place.end);
    let span = if last - first >= NOISE_BLOCKS * NOISE_BLOCK {
        first..last
    } else {
        let length = (2 * (last - first)).max(3 * NOISE_BLOCK);
        first.saturating_sub(length)..first
    };
    let block = (span.len() / 20).clamp(NOISE_BLOCK, 5 * NOISE_BLOCK);
    let scatter =
        scatter_about_polynomial(&track.times[span.clone()], &track.values[span], block, 2);
    stated(track, scatter, &(first..last), findings)
}

pub(crate) fn force_noise(
    track: &Track,
    contacts: &Contacts,
    place: &Surroundings,
    findings: &mut Vec<Finding>,
) -> f64 {
    if contacts.quiet.len() < LEAST_BASELINE {
        return noise_of(track, place, findings);
    }
    let first = track.times.partition_point(|&t| t < place.onset);
    let last = track.times.partition_point(|&t| t <= place.end);
    stated(track, Some(contacts.deviation), &(first..last), findings)
}

/// Correlation of a force's noise before contact; `None` where it is mostly rounding.
pub(crate) fn baseline_persistence(track: &Track, contacts: &Contacts) -> Option<f64> {
    let rounding = track.quantum.map_or(0.0, |q| q / 12f64.sqrt());
    let quiet = track.values.get(contacts.quiet.clone())?;
    (contacts.deviation > 2.0 * rounding)
        .then(|| persistence(quiet))
        .flatten()
}

fn stated(
    track: &Track,
    scatter: Option<f64>,
    within: &std::ops::Range<usize>,
    findings: &mut Vec<Finding>,
) -> f64 {
    let largest = track.values[within.clone()]
        .iter()
        .map(|v| v.abs())
        .fold(0.0, f64::max);
    let Noise { deviation, source } = combined_noise(scatter, track.quantum, largest);
    if source == NoiseSource::Floor {
        findings.push(Finding::NoiseAtFloor {
            channel: track.name.clone(),
            floor: deviation,
            reason: FLOOR_REASON,
        });
    }
    deviation
}

const FLOOR_REASON: &str = "a millionth of the largest sample: neither scatter nor steps are seen";
