//! What is poor in a recording of bounces, told after they have been measured.

use crate::bounce::finding::BounceFinding;
use crate::bounce::measure::{Signals, movement};
use crate::bounce::static_load::{LEAST_SAMPLES, QuietBlock};
use crate::bounce::train::Bounce;

/// Fewest samples of a contact that is not slowly sampled.
const LEAST_CONTACT: f64 = 10.0;

/// What is known of the static level.
#[derive(Clone, Copy, Debug)]
pub struct LevelSeen<'a> {
    /// Samples before the first contact.
    pub samples_before: usize,
    /// Quiet stretches of the recording.
    pub quiet: &'a [QuietBlock],
    /// Whether forces are measured from a level that follows them.
    pub followed: bool,
}

/// Findings about the bounces of a recording.
pub fn quality(signals: &Signals, level: &LevelSeen, bounces: &[Bounce]) -> Vec<BounceFinding> {
    let mut found = Vec::new();
    let n = signals.times.len();
    let Some((first, last)) = bounces.first().zip(bounces.last()) else {
        return found;
    };
    if bounces.len() == 1 {
        found.push(BounceFinding::NotValid);
    }
    if level.samples_before < LEAST_SAMPLES || first.samples.0 == 0 {
        found.push(BounceFinding::BeginsInContact {
            samples: first.samples.0.min(level.samples_before),
        });
    }
    if last.samples.1 >= n || !last.complete {
        found.push(BounceFinding::EndsInContact {
            onset: last.onset.value,
        });
    }
    found.extend(ringing_findings(signals, bounces));
    for (k, bounce) in bounces.iter().enumerate() {
        let duration = bounce.end.value - bounce.onset.value;
        let samples = duration / signals.interval;
        if bounce.complete && samples < LEAST_CONTACT {
            found.push(BounceFinding::SlowSampling {
                bounce: k + 1,
                samples: samples as usize,
                needed: 2.0 * LEAST_CONTACT / duration,
            });
        }
    }
    if !level.followed {
        found.extend(drift(signals, level.quiet, bounces));
    }
    found
}

fn ringing_findings(signals: &Signals, bounces: &[Bounce]) -> Vec<BounceFinding> {
    let mut found = Vec::new();
    let Some((period, _)) = signals.plate else {
        return found;
    };
    let cycle = ((period / signals.interval) as usize).max(3);
    let margin = 2 * signals.blur + 2;
    for (k, bounce) in bounces.iter().enumerate().skip(1) {
        let until = bounce.samples.0.saturating_sub(margin);
        let amplitude = 2f64.sqrt() * movement(signals, until, cycle);
        if amplitude > 4.0 * signals.noise && amplitude > 0.01 * bounce.peak {
            found.push(BounceFinding::StillRinging {
                bounce: k + 1,
                onset: bounce.onset.value,
                amplitude,
                peak: bounce.peak,
            });
        }
    }
    if let Some(last) = bounces.last() {
        let left = 2f64.sqrt() * movement(signals, signals.times.len(), cycle) / signals.noise;
        if last.complete && !last.decayed && left > 4.0 {
            found.push(BounceFinding::EndsInRinging {
                onset: last.onset.value,
                amplitude: left,
            });
        }
    }
    let worst = bounces
        .iter()
        .filter_map(|b| b.ringing)
        .max_by(|a, b| a.misfit.total_cmp(&b.misfit));
    if let Some(worst) = worst.filter(|ringing| ringing.misfit > 3.0) {
        found.push(BounceFinding::RingingNotOneMode {
            misfit: worst.misfit,
            from: worst.from,
        });
    }
    found
}

/// The largest change of the quiet level after the first bounce, if it matters.
fn drift(signals: &Signals, quiet: &[QuietBlock], bounces: &[Bounce]) -> Option<BounceFinding> {
    let level = |from: usize, to: usize| {
        let inside: Vec<&QuietBlock> = quiet
            .iter()
            .filter(|b| b.middle > from as f64 && b.middle < to as f64)
            .collect();
        let count = inside.len() as f64;
        let samples: usize = inside.iter().map(|b| b.samples).sum();
        let centre = inside.iter().map(|b| b.middle).sum::<f64>() / count;
        let mean = inside.iter().map(|b| b.mean).sum::<f64>() / count;
        (!inside.is_empty()).then(|| (signals.times[centre as usize], mean, samples as f64))
    };
    let mut previous = 0;
    let mut levels = Vec::new();
    for bounce in bounces {
        levels.extend(level(previous, bounce.samples.0));
        previous = bounce.samples.1;
    }
    // After the last bounce the impactor rests on the plate, which is no drift;
    // unless it is the only stretch there is.
    let (&(from, first, before), later) = levels.split_first()?;
    let largest = bounces.iter().fold(0.0, |a: f64, b| a.max(b.peak));
    let least = (0.5 * signals.noise).max(0.002 * largest);
    later
        .iter()
        .map(|(to, mean, samples)| {
            let sd = signals.noise * (1.0 / before + 1.0 / samples).sqrt();
            (*to, mean - first, sd)
        })
        .filter(|(_, change, sd)| change.abs() > least && change.abs() > 4.0 * sd)
        .max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()))
        .map(|(to, change, _)| BounceFinding::StaticLevelDrifts { change, from, to })
}
