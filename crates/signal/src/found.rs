//! The contacts of a recording.

use crate::choose::{candidates, surroundings};
use crate::conditioning::filter_tracks;
use crate::deceleration::deceleration;
use crate::error::Error;
use crate::finding::Finding;
use crate::kinematics::Motion;
use crate::measure::Surroundings;
use crate::options::{ExtractOptions, check_options};
use crate::recording::Recording;
use crate::spike::remove_spikes;
use crate::track::{Geometry, Track, Tracks, mean_interval, missing, tracks};
use crate::trigger::{Baseline, Contacts, Signal, Threshold, TriggerOptions, find_contacts};
use crate::zero::{Levelled, level_zero};

/// The contacts of a recording that [`crate::extract_impact`] chooses between, in order of time.
///
/// The choice in `options` does not matter, and scales of channels matter to a fixed threshold
/// alone.
///
/// # Errors
/// As [`crate::extract_impact`].
pub fn impacts_in(
    recording: &Recording,
    options: &ExtractOptions,
) -> Result<Vec<Surroundings>, Error> {
    let found = found(recording, options, &mut Vec::new())?;
    let place = |&turn: &usize| surroundings(&found.contacts.windows, turn);
    Ok(found.turns.iter().map(place).collect())
}

/// The contacts of a recording, and the channels that they were found in.
pub(crate) struct Found {
    pub tracks: Tracks,
    pub contacts: Contacts,
    /// Indices of those that are impacts.
    pub turns: Vec<usize>,
    pub from_motion: Option<Finding>,
}

/// Reads the channels of a recording and finds its contacts in them.
pub(crate) fn found(
    recording: &Recording,
    options: &ExtractOptions,
    findings: &mut Vec<Finding>,
) -> Result<Found, Error> {
    check_options(options)?;
    let geometry = Geometry {
        encoder: options.encoder,
        arm: options.arm,
        illegal: options.illegal,
    };
    let mut tracks = tracks(recording, &geometry, findings)?;
    for track in tracks.all_mut() {
        remove_spikes(track, findings);
    }
    filter_tracks(&mut tracks, &options.conditioning, findings)?;
    let mut levelled = Levelled::default();
    if let Some(force) = &mut tracks.force {
        let find = |force: &Track| {
            find_contacts(
                &signal(force, "N", &force.times, &force.values),
                &options.trigger,
            )
        };
        levelled = level_zero(force, &options.trigger, find, findings)?;
    }

    let (contacts, from_motion) = match levelled.contacts {
        Some(contacts) => (contacts, None),
        None => contacts(recording, &tracks, options)?,
    };
    let contacts = Contacts {
        trend_sd: contacts.trend_sd.hypot(levelled.sd),
        ..contacts
    };
    let turns = candidates(&contacts, &tracks, findings)?;
    Ok(Found {
        tracks,
        contacts,
        turns,
        from_motion,
    })
}

/// Contacts from the force, else from the deceleration, with its resolution.
fn contacts(
    recording: &Recording,
    tracks: &Tracks,
    options: &ExtractOptions,
) -> Result<(Contacts, Option<Finding>), Error> {
    if let Some(force) = &tracks.force {
        let signal = signal(force, "N", &force.times, &force.values);
        return Ok((find_contacts(&signal, &options.trigger)?, None));
    }
    // A threshold in newtons means nothing to a deceleration; a tenth of the
    // largest stays above what the differences smear before the onset.
    let trigger = TriggerOptions {
        threshold: Threshold::Automatic {
            deviations: 5.0,
            least: 0.0,
            share: 0.1,
        },
        baseline: Baseline::Remove,
        ..options.trigger
    };
    if let Some(track) = &tracks.acceleration {
        let values: Vec<f64> = track.values.iter().map(|a| -a).collect();
        let found = find_contacts(&signal(track, "m/s²", &track.times, &values), &trigger)?;
        let interval = mean_interval(&track.times);
        return Ok((found, Some(window_finding(track, interval))));
    }
    let (track, motion) = match (&tracks.position, &tracks.rate) {
        (Some(position), _) => (&position.track, Motion::Displacement),
        (None, Some(rate)) => (rate, Motion::Rate),
        (None, None) => {
            return Err(missing(
                recording,
                "force, acceleration, displacement or displacement rate",
            ));
        }
    };
    let scale = tracks.position.as_ref().and_then(|p| p.arm).unwrap_or(1.0);
    let values: Vec<f64> = track.values.iter().map(|v| v * scale).collect();
    let found = deceleration(&track.times, &values, motion)
        .ok_or_else(|| Error::too_few_samples(track.name.clone(), track.values.len(), 3))?;
    let derived = Signal {
        name: &format!("{}, differentiated to accelerations", track.name),
        ..signal(track, "m/s²", &found.times, &found.values)
    };
    let contacts = find_contacts(&derived, &trigger)?;
    Ok((contacts, Some(window_finding(track, found.resolution))))
}

fn signal<'a>(
    track: &'a Track,
    unit: &'static str,
    times: &'a [f64],
    values: &'a [f64],
) -> Signal<'a> {
    Signal {
        name: &track.name,
        unit,
        times,
        values,
    }
}

fn window_finding(track: &Track, resolution: f64) -> Finding {
    Finding::WindowFromMotion {
        channel: track.name.clone(),
        resolution,
    }
}
