//! Filters, drift and the tip ahead of a force sensor, before anything is measured.

use crate::accelerometer::free_acceleration;
use crate::error::Error;
use crate::filter::butterworth::{Band, FilterError, butterworth};
use crate::filter::zero_phase::filter_zero_phase;
use crate::finding::Finding;
use crate::kinematics::value_at;
use crate::measure::Surroundings;
use crate::polynomial::evenly_spaced;
use crate::track::{Track, Tracks, mean_interval};
use serde::Serialize;

/// A zero-phase Butterworth filter of a channel.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ChannelFilter {
    /// What it lets through.
    pub band: Band,
    /// Its order; the gain applies twice.
    pub order: usize,
}

/// Order of a filter where none is asked for.
pub const USUAL_ORDER: usize = 4;

/// What is done to the channels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Conditioning {
    /// Filter of the force.
    pub force: Option<ChannelFilter>,
    /// Filter of a displacement or angle; not of counts.
    pub position: Option<ChannelFilter>,
    /// Filter of the displacement rate.
    pub rate: Option<ChannelFilter>,
    /// Filter of the acceleration.
    pub acceleration: Option<ChannelFilter>,
    /// Mass between force sensor and fruit; kg.
    pub tip_mass: Option<f64>,
}

/// Filters the channels that are to be filtered.
pub(crate) fn filter_tracks(
    tracks: &mut Tracks,
    conditioning: &Conditioning,
    findings: &mut Vec<Finding>,
) -> Result<(), Error> {
    let position = tracks.position.as_mut().map(|position| &mut position.track);
    for (track, filter) in [
        (tracks.force.as_mut(), conditioning.force),
        (position, conditioning.position),
        (tracks.rate.as_mut(), conditioning.rate),
        (tracks.acceleration.as_mut(), conditioning.acceleration),
    ] {
        if let (Some(track), Some(filter)) = (track, filter) {
            filter_track(track, filter, findings)?;
        }
    }
    Ok(())
}

fn filter_track(
    track: &mut Track,
    filter: ChannelFilter,
    findings: &mut Vec<Finding>,
) -> Result<(), Error> {
    let failed = |source| Error::Filter {
        channel: track.name.clone(),
        source,
    };
    if !evenly_spaced(&track.times) {
        return Err(failed(FilterError::UnevenTimes));
    }
    let rate = 1.0 / mean_interval(&track.times);
    let sections = butterworth(filter.band, filter.order, rate).map_err(failed)?;
    let filtered = filter_zero_phase(&sections, &track.values).map_err(failed)?;
    let range = |values: &[f64]| {
        let ends = values
            .iter()
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| {
                (low.min(*v), high.max(*v))
            });
        ends.1 - ends.0
    };
    findings.push(Finding::Filtered {
        channel: track.name.clone(),
        band: filter.band,
        order: filter.order,
        kept: range(&filtered) / range(&track.values),
    });
    track.values = filtered;
    track.quantum = None;
    Ok(())
}

/// Adds what accelerates the tip to the force of the sensor behind it:
///
/// ```text
/// F = F_s − m_tip (x'' − x₀'')  with a measured acceleration
/// F = F_s m_eff/(m_eff − m_tip) from the rig's own motion, m_eff x'' = −F
/// ```
///
/// x₀'' is the accelerometer's reading in free motion.
pub(crate) fn add_tip_force(
    force: &mut Track,
    acceleration: Option<&Track>,
    place: &Surroundings,
    (tip, effective_mass): (f64, Option<f64>),
    findings: &mut Vec<Finding>,
) -> Result<(), Error> {
    let largest = |force: &Track| force.values.iter().copied().fold(0.0, f64::max);
    let before = largest(force);
    let measured = acceleration.filter(|track| {
        track.times.first().is_some_and(|t| *t <= place.onset)
            && track.times.last().is_some_and(|t| *t >= place.end)
    });
    match (measured, effective_mass) {
        (Some(acceleration), _) => {
            let (times, values) = (&acceleration.times, &acceleration.values);
            let free = free_acceleration(times, values, place).map_or(0.0, |free| free.value);
            for (time, value) in force.times.iter().zip(&mut force.values) {
                *value -= tip * (value_at(times, values, *time) - free);
            }
            force.noise = force.noise.hypot(tip * acceleration.noise);
        }
        (None, Some(mass)) if mass > tip => {
            let factor = mass / (mass - tip);
            force.values.iter_mut().for_each(|value| *value *= factor);
            force.noise *= factor;
        }
        (None, _) => {
            return Err(Error::bad_option(
                "tip mass",
                tip,
                "a mass below the effective mass of the rig, which must be given (not \
                           found from impulse) where no acceleration was measured",
            ));
        }
    }
    findings.push(Finding::TipMass {
        channel: force.name.clone(),
        mass: tip,
        measured: measured.is_some(),
        raised: largest(force) / before,
    });
    Ok(())
}
