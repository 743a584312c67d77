//! Which of several contacts is the impact.

use crate::error::{Error, Times};
use crate::finding::Finding;
use crate::kinematics::Motion;
use crate::measure::{Side, Surroundings, free_velocity};
use crate::options::ExtractOptions;
use crate::track::Tracks;
use crate::trigger::{ContactWindow, Contacts};

/// A contact changes the velocity by at least this part of what the largest does, for the
/// size of its force; 1.
const TURNS: f64 = 0.3;

/// Indices of the contacts in which the velocity changes, as far as a motion was measured;
/// all of them where none does. A force without that is a knock on the bench.
pub(crate) fn turning_contacts(
    contacts: &Contacts,
    tracks: &Tracks,
    findings: &mut Vec<Finding>,
) -> Vec<usize> {
    let windows = &contacts.windows;
    let all = || (0..windows.len()).collect();
    let motion = match (&tracks.position, &tracks.rate) {
        (Some(position), _) => (&position.track, Motion::Displacement),
        (None, Some(rate)) => (rate, Motion::Rate),
        (None, None) => return all(),
    };
    let Some(force) = tracks.force.as_ref().filter(|_| windows.len() > 1) else {
        return all();
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
    let largest = (0..windows.len()).max_by(|a, b| impulse(a).total_cmp(&impulse(b)));
    let Some(expected) = largest.and_then(|i| changes[i]) else {
        return all();
    };
    let turns = |i: &usize| changes[*i].is_none_or(|own| own / expected > TURNS);
    let (kept, knocks): (Vec<usize>, Vec<usize>) = (0..windows.len()).partition(turns);
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
