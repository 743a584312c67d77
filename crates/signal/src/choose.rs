//! Which of several contacts is the impact.

use crate::error::{Error, Times};
use crate::finding::Finding;
use crate::kinematics::Motion;
use crate::measure::{Side, Surroundings, free_velocity};
use crate::noise::estimate::median;
use crate::options::ExtractOptions;
use crate::oscillation::{shaking, without_ringing};
use crate::track::{Track, Tracks};
use crate::trigger::{ContactWindow, Contacts};

/// A contact changes the velocity by at least this part of what the largest does, for the
/// size of its force; 1.
const TURNS: f64 = 0.3;

/// Acceleration of free fall; m/s².
const GRAVITY: f64 = 9.806_65;

/// A contact with a larger peak than this is more than rest or free fall; gravity.
const MORE: f64 = 2.0;

/// A signal that stands still lies between its quartiles within this part of gravity, and its
/// middle as near to it; 1.
const STANDS: f64 = 0.08;

/// Indices of the contacts that may be the impact: without rest and free fall in an
/// acceleration, without what rings after a contact, without knocks on the bench.
///
/// # Errors
/// [`Error::OnlyGravity`] where rest or free fall is all that there is.
pub(crate) fn candidates(
    contacts: &Contacts,
    tracks: &Tracks,
    findings: &mut Vec<Finding>,
) -> Result<Vec<usize>, Error> {
    let windows = &contacts.windows;
    let motion = tracks.position.as_ref().map(|own| &own.track);
    let searched = [tracks.force.as_ref(), tracks.acceleration.as_ref(), motion];
    let searched = searched.into_iter().flatten().next();
    let name = searched
        .or(tracks.rate.as_ref())
        .map_or("", |own| &own.name);
    let mut kept = without_ringing(name, windows, findings);
    findings.extend(shaking(name, windows, &kept));
    if let (None, Some(track)) = (&tracks.force, &tracks.acceleration) {
        let still = |i: &usize| Some((windows[*i], stands(track, &windows[*i], contacts.offset)?));
        let standing: Vec<(ContactWindow, f64)> = kept.iter().filter_map(still).collect();
        kept.retain(|i| still(i).is_none());
        if let (Some((window, level)), true) = (standing.first(), kept.is_empty()) {
            return Err(Error::OnlyGravity {
                channel: track.name.clone(),
                level: *level,
                from: window.onset,
                until: window.end,
            });
        }
        findings.extend(
            standing
                .into_iter()
                .map(|(window, level)| Finding::Gravity {
                    channel: track.name.clone(),
                    level,
                    from: window.onset,
                    until: window.end,
                }),
        );
    }
    Ok(turning_contacts(contacts, tracks, kept, findings))
}

/// The level at which an acceleration stands throughout a contact, if that is gravity: as
/// recorded, or above the zero that was found.
fn stands(track: &Track, window: &ContactWindow, offset: f64) -> Option<f64> {
    if window.peak > MORE * GRAVITY {
        return None;
    }
    let first = track.times.partition_point(|&t| t < window.onset);
    let last = track.times.partition_point(|&t| t <= window.end);
    let mut values = track.values.get(first..last)?.to_vec();
    let middle = median(&values)?;
    values.sort_by(f64::total_cmp);
    let quarter = values.len() / 4;
    let spread = values[values.len() - 1 - quarter] - values[quarter];
    let near = |level: f64| (level.abs() - GRAVITY).abs() < STANDS * GRAVITY;
    // The contacts are those of the deceleration, whose zero has the other sign.
    let levels = [middle, middle + offset];
    let level = levels.into_iter().find(|level| near(*level))?;
    (spread < STANDS * GRAVITY).then_some(level)
}

/// Indices of those of `kept` in which the velocity changes, as far as a motion was measured;
/// all of them where none does. A force without that is a knock on the bench.
fn turning_contacts(
    contacts: &Contacts,
    tracks: &Tracks,
    all: Vec<usize>,
    findings: &mut Vec<Finding>,
) -> Vec<usize> {
    let windows = &contacts.windows;
    let motion = match (&tracks.position, &tracks.rate) {
        (Some(position), _) => (&position.track, Motion::Displacement),
        (None, Some(rate)) => (rate, Motion::Rate),
        (None, None) => return all,
    };
    let Some(force) = tracks.force.as_ref().filter(|_| all.len() > 1) else {
        return all;
    };
    // Change of velocity for the size of the force.
    let changes: Vec<Option<f64>> = (0..windows.len())
        .map(|i| {
            let (window, place) = (windows[i], surroundings(windows, i));
            let velocity = |side| {
                let samples = (&motion.0.times[..], &motion.0.values[..], motion.1);
                free_velocity(samples, 0.0, &place, side, 0.0).map(|own| own.value)
            };
            let change = velocity(Side::After)? - velocity(Side::Before)?;
            Some(change / (window.peak * place.duration()))
        })
        .collect();
    let impulse = |i: &usize| windows[*i].peak * (windows[*i].end - windows[*i].onset);
    let largest = all
        .iter()
        .copied()
        .max_by(|a, b| impulse(a).total_cmp(&impulse(b)));
    let Some(expected) = largest.and_then(|i| changes[i]) else {
        return all;
    };
    let turns = |i: &usize| changes[*i].is_none_or(|own| own / expected > TURNS);
    let (kept, knocks): (Vec<usize>, Vec<usize>) = all.into_iter().partition(turns);
    if !knocks.is_empty() {
        findings.push(Finding::Bump {
            channel: force.name.clone(),
            times: Times(knocks.iter().map(|&i| windows[i].onset).collect()),
        });
    }
    kept
}

/// A contact and the free motion up to its neighbours.
pub(crate) fn surroundings(windows: &[ContactWindow], index: usize) -> Surroundings {
    let before = index.checked_sub(1).map(|i| windows[i].end);
    let after = windows.get(index + 1).map(|w| w.onset);
    Surroundings {
        onset: windows[index].onset,
        end: windows[index].end,
        from: before.unwrap_or(f64::NEG_INFINITY),
        until: after.unwrap_or(f64::INFINITY),
    }
}

/// The contact that is used, up to its neighbours.
pub(crate) fn choose(
    contacts: &Contacts,
    turns: &[usize],
    options: &ExtractOptions,
    from_motion: Option<Finding>,
    findings: &mut Vec<Finding>,
) -> Result<Surroundings, Error> {
    findings.extend(from_motion);
    let windows = &contacts.windows;
    let chosen = contacts.choose_among(turns, options.trigger.choice)?;
    let window = windows[chosen];
    if turns.len() > 1 {
        findings.push(Finding::SeveralContacts {
            onsets: Times(turns.iter().map(|&i| windows[i].onset).collect()),
            used: window.onset,
        });
    }
    if !window.onset_seen {
        findings.push(Finding::ContactAtStart { time: window.onset });
    }
    if !window.end_seen {
        findings.push(Finding::ContactAtEnd { time: window.end });
    }
    Ok(surroundings(windows, chosen))
}
