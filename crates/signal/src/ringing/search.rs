//! Where in a force the plate rings freely: the lobes after an impact, and from
//! which of them on a damped cosine is all there is.

use crate::noise::estimate::median;
use crate::ringing::model::{Ringing, decay_rate, fit_ringing};

/// A lobe is one if it reaches this many standard deviations of the noise; 1.
const LOBE_LEVEL: f64 = 4.0;
/// The sign changes when the force is beyond this many standard deviations; 1.
const SIGN_LEVEL: f64 = 3.0;
/// A lobe that exceeds the one a period before by this part is a new impact; 1.
const GROWTH: f64 = 0.1;
/// Fewest lobes of a stretch that is fitted: two cycles.
const LEAST_LOBES: usize = 4;
/// Half periods that depart from their median by more than this part are none; 1.
const IRREGULAR: f64 = 0.35;
/// Most lobes tried as the begin of the free ringing.
const MOST_STARTS: usize = 12;
/// Residual over noise up to which a damped cosine is all there is, for many
/// samples; 1.
const ACCEPTED_MISFIT: f64 = 1.05;
/// Fewest samples in a period.
const LEAST_SAMPLES: f64 = 5.0;
/// A stretch ends where its amplitude is this many standard deviations of the
/// noise; what follows tells nothing.
const STRETCH_END: f64 = 1.0;

/// A stretch of force of one sign.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Lobe {
    /// First sample beyond the sign level.
    first: usize,
    /// Largest magnitude.
    height: f64,
}

/// Free ringing after an impact; `None` if the force does not ring.
///
/// * `times`: of all samples, evenly spaced; s
/// * `force`: from the static level; N
/// * `noise`: standard deviation of a sample; N
/// * `range`: from a sample in contact to one before the next impact
///
/// The stretch begins at the first lobe from which on a damped cosine leaves no
/// more than noise, and one lobe later, in case the contact's last remainder
/// hides in the noise; where none leaves so little, at the one that leaves least.
pub fn find_ringing(
    times: &[f64],
    force: &[f64],
    noise: f64,
    range: (usize, usize),
) -> Option<Ringing> {
    let lobes = lobes(force, noise, range);
    // The first lobe is the impact itself.
    let free = lobes.get(1..)?;
    if free.len() < LEAST_LOBES {
        return None;
    }
    let interval = (times[times.len() - 1] - times[0]) / (times.len() - 1) as f64;
    let mut best: Option<Ringing> = None;
    let last_start = (free.len() - LEAST_LOBES).min(MOST_STARTS);
    for start in 0..=last_start {
        let Some(found) = fit_from(times, force, noise, range, &free[start..], interval) else {
            continue;
        };
        if found.misfit <= accepted(&found, interval) {
            let later = (start < last_start)
                .then(|| fit_from(times, force, noise, range, &free[start + 1..], interval));
            return Some(later.flatten().unwrap_or(found));
        }
        if best.is_none_or(|best| found.misfit < best.misfit) {
            best = Some(found);
        }
    }
    // Ringing explains most of what is there, or it is none.
    best.filter(|ringing| ringing.misfit * noise < 0.2 * ringing.amplitude)
}

/// Root mean square of noise over n samples exceeds 1 by chance.
fn accepted(ringing: &Ringing, interval: f64) -> f64 {
    let samples = ((ringing.to - ringing.from) / interval).max(1.0);
    ACCEPTED_MISFIT + 3.0 / (2.0 * samples).sqrt()
}

fn fit_from(
    times: &[f64],
    force: &[f64],
    noise: f64,
    range: (usize, usize),
    lobes: &[Lobe],
    interval: f64,
) -> Option<Ringing> {
    let (period, decay) = rough(times, lobes)?;
    if period < LEAST_SAMPLES * interval {
        return None;
    }
    let first = lobes[0].first;
    let ends = (lobes[0].height / (STRETCH_END * noise)).ln() / decay.max(1e-3 / period);
    let samples = (ends / interval).max(0.0) as usize;
    // No farther than half a period beyond the last lobe: a new impact may follow.
    let seen = lobes[lobes.len() - 1].first + (0.5 * period / interval) as usize;
    let last = (first + samples).min(range.1).min(seen);
    if (last - first) as f64 * interval < 1.5 * period {
        return None;
    }
    let found = fit_ringing(
        times[first],
        interval,
        &force[first..last],
        noise,
        (period, decay.max(0.15 / period)),
    )?;
    // A fit that left the lobes is none.
    let ratio = found.period.value / period;
    let fits = (0.8..1.25).contains(&ratio)
        && decay_rate(found.period.value, found.damping_ratio.value) * period < 4.0;
    fits.then_some(found)
}

/// Period and decay from when the lobes begin and how high they are.
fn rough(times: &[f64], lobes: &[Lobe]) -> Option<(f64, f64)> {
    let halves: Vec<f64> = lobes
        .windows(2)
        .map(|pair| times[pair[1].first] - times[pair[0].first])
        .collect();
    let half = median(&halves)?;
    let regular = halves
        .iter()
        .filter(|h| (**h - half).abs() <= IRREGULAR * half)
        .count();
    if regular * 3 < halves.len() * 2 {
        return None;
    }
    let last = lobes.len() - 1;
    // The median is good to a sample; the mean to a sample over all lobes.
    let mean = (times[lobes[last].first] - times[lobes[0].first]) / last as f64;
    let half = if regular == halves.len() { mean } else { half };
    let decay = (lobes[0].height / lobes[last].height).ln() / (half * last as f64);
    Some((2.0 * half, decay.max(0.0)))
}

/// Lobes of alternating sign from the begin of the range, as long as they are
/// above noise and do not grow after the largest.
fn lobes(force: &[f64], noise: f64, range: (usize, usize)) -> Vec<Lobe> {
    let mut lobes: Vec<Lobe> = Vec::new();
    let mut sign = 0.0;
    let mut finished = 0;
    for (i, &value) in force.iter().enumerate().take(range.1).skip(range.0) {
        if value.abs() >= SIGN_LEVEL * noise && value.signum() != sign {
            if ends(&lobes, noise) {
                break;
            }
            finished = lobes.len();
            sign = value.signum();
            lobes.push(Lobe {
                first: i,
                height: 0.0,
            });
        }
        if let Some(lobe) = lobes.last_mut() {
            lobe.height = lobe.height.max(value * sign);
        }
    }
    // The last may be cut short.
    lobes.truncate(if ends(&lobes, noise) {
        finished
    } else {
        lobes.len()
    });
    lobes
}

/// Whether the last lobe is noise, or higher than the one of its sign before.
fn ends(lobes: &[Lobe], noise: f64) -> bool {
    let Some(last) = lobes.last() else {
        return false;
    };
    let before = lobes.len().checked_sub(3).map(|i| lobes[i].height);
    // Contact shapes the first lobes.
    let grows = lobes.len() > 4
        && before.is_some_and(|before| last.height > (1.0 + GROWTH) * before + LOBE_LEVEL * noise);
    last.height < LOBE_LEVEL * noise || grows
}
