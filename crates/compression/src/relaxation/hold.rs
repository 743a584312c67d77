//! Stress relaxation: the part of a recording in which the position is held and the force falls.

use windfall_signal::compression::{SHORTEST_RUN, second_difference_noise};

/// Fewest samples of a hold.
pub const LEAST_SAMPLES: usize = 20;

/// A position is held while it stays within this part of the travel before it; 1.
const STILL: f64 = 0.005;

/// A hold without a position ends where the force falls faster, from one part of the hold to
/// the next, by this factor.
const FASTER: f64 = 3.0;

/// Parts of a hold between which falls of the force are compared.
const PARTS: usize = 40;

/// Where a fruit is held, and how it came to be.
#[derive(Clone, Debug, PartialEq)]
pub struct Hold {
    /// First sample of the hold: the machine stands.
    pub start: usize,
    /// Last sample.
    pub end: usize,
    /// From the first touch to the start of the hold; `None` where the recording begins with
    /// the hold. s.
    pub ramp: Option<f64>,
    /// What ends the hold.
    pub ended_by: HoldEnd,
    /// Standard deviation of a force sample's noise; N.
    pub force_noise: f64,
}

/// What ends a hold.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum HoldEnd {
    /// The recording.
    RecordingEnd,
    /// The position leaves its place.
    Moved,
    /// No position is recorded, and the force falls faster than before.
    ForceFell,
}

/// Why there is no hold.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[allow(missing_docs, reason = "each message names its fields")]
pub enum RelaxationError {
    #[error("{samples} samples of force; at least {least} are needed")]
    TooFewSamples { samples: usize, least: usize },
    #[error(
        "the force never rises above its noise ({noise:.4} N); if force is recorded as negative in \
         compression, set sign = -1 in [channels.force]"
    )]
    NoForce { noise: f64 },
    #[error(
        "the position is not held: after the largest force, at {time:.3} s, it stays within \
         {tolerance:.3e} m for only {samples} samples, and at least {least} are needed. For \
         loading without a hold set kind = \"compression\" in [rig]"
    )]
    NoHold {
        time: f64,
        tolerance: f64,
        samples: usize,
        least: usize,
    },
    #[error(
        "the force does not fall while the position is held, from {time:.3} s on ({first:.4} N to \
         {last:.4} N): nothing relaxes. If force is recorded as negative in compression, set \
         sign = -1 in [channels.force]; or choose the hold by from_s and to_s in impacts.csv"
    )]
    NoFall { time: f64, first: f64, last: f64 },
}

/// The hold of a recording: it begins when the position reaches the place where it stands at the
/// largest force.
///
/// * `times`, `force`: samples together; s, N. The force is positive in compression.
/// * `position`: at the same times; m; it may count either way. Without it the hold begins at the
///   largest force.
/// * `touch_force`: force above which the fruit is touched, from the noise when `None`; N
///
/// # Errors
/// See [`RelaxationError`].
pub fn find_hold(
    times: &[f64],
    force: &[f64],
    position: Option<&[f64]>,
    touch_force: Option<f64>,
) -> Result<Hold, RelaxationError> {
    let samples = times.len().min(force.len());
    if samples < LEAST_SAMPLES {
        let least = LEAST_SAMPLES;
        return Err(RelaxationError::TooFewSamples { samples, least });
    }
    let force = &force[..samples];
    let noise = second_difference_noise(&force[..samples.min(100)]);
    let peak = largest(force);
    let threshold = touch_force.unwrap_or(5.0 * noise).max(0.0);
    if force[peak] <= threshold {
        return Err(RelaxationError::NoForce { noise });
    }
    // The last sample before the peak that is not in contact.
    let touch = (0..peak).rev().find(|i| force[*i] <= threshold);
    let (start, end, ended_by) = match position {
        Some(position) => stand(times, &position[..samples], peak, touch)?,
        None => {
            let (end, ended_by) = until_faster(&force[peak..], noise);
            (peak, peak + end, ended_by)
        }
    };
    let hold = Hold {
        start,
        end,
        // Force from the first sample on: when it began is not recorded.
        ramp: touch.map(|touch| times[start] - times[touch]),
        ended_by,
        force_noise: second_difference_noise(&force[start..=end]),
    };
    check_fall(times, force, &hold)?;
    Ok(hold)
}

/// The sample of the largest force.
fn largest(force: &[f64]) -> usize {
    let all = force.iter().enumerate();
    all.fold(
        0,
        |best, (i, value)| if *value > force[best] { i } else { best },
    )
}

/// First and last sample around the largest force at which the position stands.
fn stand(
    times: &[f64],
    position: &[f64],
    peak: usize,
    touch: Option<usize>,
) -> Result<(usize, usize, HoldEnd), RelaxationError> {
    let noise = second_difference_noise(position);
    let before = touch.unwrap_or(0);
    let after = &position[peak..position.len().min(peak + SHORTEST_RUN)];
    let place = median(after);
    let travel = (place - position[before]).abs();
    let tolerance = (STILL * travel).max(5.0 * noise);
    let still = |i: &usize| (position[*i] - place).abs() <= tolerance;
    let start = (0..=peak).rev().take_while(still).last().unwrap_or(peak);
    let end = (peak..position.len())
        .take_while(still)
        .last()
        .unwrap_or(peak);
    let samples = end + 1 - start;
    if samples < LEAST_SAMPLES {
        return Err(RelaxationError::NoHold {
            time: times[peak],
            tolerance,
            samples,
            least: LEAST_SAMPLES,
        });
    }
    let ended_by = match end + 1 == position.len() {
        true => HoldEnd::RecordingEnd,
        false => HoldEnd::Moved,
    };
    Ok((start, end, ended_by))
}

fn median(values: &[f64]) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    sorted[sorted.len() / 2]
}

/// Last sample before the force falls faster than it did: a force that relaxes falls ever slower.
fn until_faster(force: &[f64], noise: f64) -> (usize, HoldEnd) {
    let length = force.len() / PARTS;
    if length < 2 {
        return (force.len() - 1, HoldEnd::RecordingEnd);
    }
    let levels: Vec<f64> = force.chunks_exact(length).map(median).collect();
    let faster = (2 * length..force.len()).find(|&i| {
        let part = i / length;
        let fall = (levels[part - 2] - levels[part - 1]).abs();
        let low = levels[part - 1] - FASTER * fall - 10.0 * noise;
        force[i..].iter().take(3).all(|own| *own < low)
    });
    match faster {
        Some(first) => (first - 1, HoldEnd::ForceFell),
        None => (force.len() - 1, HoldEnd::RecordingEnd),
    }
}

/// The force must be lower at the end than at the start, beyond its noise.
fn check_fall(times: &[f64], force: &[f64], hold: &Hold) -> Result<(), RelaxationError> {
    let held = &force[hold.start..=hold.end];
    let part = (held.len() / 10).max(2);
    let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
    let (first, last) = (mean(&held[..part]), mean(&held[held.len() - part..]));
    let error = hold.force_noise * (2.0 / part as f64).sqrt();
    match held.len() >= LEAST_SAMPLES && first - last > 5.0 * error {
        true => Ok(()),
        false => Err(RelaxationError::NoFall {
            time: times[hold.start],
            first,
            last,
        }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A ramp of 1 mm over 0.5 s from 1 s on, a hold of 8 s, then the machine goes back.
    fn recording(hold: impl Fn(f64) -> f64) -> (Vec<f64>, Vec<f64>, Vec<f64>) {
        let times: Vec<f64> = (0..1050).map(|i| 0.01 * f64::from(i)).collect();
        let path = |t: f64| match t {
            t if t < 9.5 => (2e-3 * (t - 1.0)).clamp(-5e-4, 1e-3),
            t => 1e-3 - 2e-3 * (t - 9.5),
        };
        let position: Vec<f64> = times.iter().map(|t| 0.05 - path(*t)).collect();
        let force = times.iter().map(|t| match t {
            t if *t < 1.5 => 2e4 * path(*t).max(0.0),
            t if *t < 9.5 => 20.0 * hold(t - 1.5),
            t => (20.0 * hold(8.0) - 4e4 * (t - 9.5)).max(0.0),
        });
        let force = force.collect();
        (times, position, force)
    }

    #[test]
    fn closed_form_hold_after_a_ramp() {
        let (times, position, force) = recording(|t| 0.6 + 0.4 * (-t / 2.0).exp());
        for held in [Some(&position[..]), None] {
            let hold = find_hold(&times, &force, held, None).unwrap();
            assert!((times[hold.start] - 1.5).abs() < 0.011, "{hold:?}");
            assert!((hold.ramp.unwrap() - 0.5).abs() < 0.011, "{hold:?}");
            let (late, why) = match held {
                Some(_) => (0.011, HoldEnd::Moved),
                None => (0.3, HoldEnd::ForceFell),
            };
            assert!((times[hold.end] - 9.5).abs() < late, "{}", times[hold.end]);
            assert_eq!(hold.ended_by, why);
        }
        // Only the hold is recorded: when the ramp began is not known.
        let held = 150..900;
        let hold = find_hold(
            &times[held.clone()],
            &force[held.clone()],
            Some(&position[held]),
            None,
        );
        let hold = hold.unwrap();
        assert_eq!((hold.start, hold.end, hold.ramp), (0, 749, None));
        assert_eq!(hold.ended_by, HoldEnd::RecordingEnd);
    }

    #[test]
    fn rejects_what_does_not_relax() {
        let (times, position, force) = recording(|_| 1.0);
        let refused = |force: &[f64], position: &[f64]| {
            let found = find_hold(&times, force, Some(position), None);
            found.unwrap_err().to_string()
        };
        assert!(refused(&force, &position).contains("nothing relaxes"));
        let (_, _, force) = recording(|t| 0.6 + 0.4 * (-t / 2.0).exp());
        let moving: Vec<f64> = times.iter().map(|t| 1e-3 * t).collect();
        assert!(refused(&force, &moving).contains("kind = \"compression\""));
        let pulled: Vec<f64> = force.iter().map(|own| -own).collect();
        assert!(refused(&pulled, &position).contains("sign = -1"));
        let few = find_hold(&times[..9], &force[..9], None, None).unwrap_err();
        assert!(few.to_string().starts_with("9 samples"));
    }
}
