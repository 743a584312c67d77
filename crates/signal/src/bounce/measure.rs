//! Onset, end, peaks and impulse of one contact.

use crate::bounce::rise::time_before;
use crate::bounce::segment::Segment;
use crate::polynomial::fit_polynomial;
use crate::ringing::model::{Ringing, amplitude_at, ringing_at};
use crate::uncertain::Uncertain;
use std::f64::consts::TAU;

/// The signals that bounces are measured in, and what is known of them.
#[derive(Clone, Copy, Debug)]
pub struct Signals<'a> {
    /// Times; s.
    pub times: &'a [f64],
    /// Mean time between samples; s.
    pub interval: f64,
    /// Support force from the static level; N.
    pub force: &'a [f64],
    /// Support force from a level that follows drift; N.
    pub level_force: &'a [f64],
    /// Contact force, smoothed; N.
    pub contact_force: &'a [f64],
    /// Noise of a sample of the support force; N.
    pub noise: f64,
    /// Standard deviation of the static level; N.
    pub level_sd: f64,
    /// Force at which an onset is visible; N.
    pub visible: f64,
    /// Samples over which the contact force is blurred, to one side.
    pub blur: usize,
    /// Damped period and damping ratio of the plate; s, 1.
    pub plate: Option<(f64, f64)>,
}

/// First touch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Onset {
    /// Time; s.
    pub time: Uncertain,
    /// How far off it may be by the unknown shape of the rise; s.
    pub shape: f64,
    /// Whether the rise is in the recording.
    pub seen: bool,
}

/// A local maximum.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Peak {
    /// Nearest sample.
    pub sample: usize,
    /// Time; s.
    pub time: f64,
    /// Force; N.
    pub force: f64,
    /// Standard deviation by noise; N.
    pub sd: f64,
}

/// Exponents p of early contact forces, F ∝ t^p: Kuwabara-Kono 1/2, Hertz 3/2, ADAMS IMPACT 2.
const RISE: (f64, f64) = (0.5, 2.0);
/// Second level of the rise over the first; 1.
const LEVELS: f64 = 8.0;
/// … and at most this part of the first peak; 1.
const HIGHEST_LEVEL: f64 = 0.5;
/// A maximum is passed when the force has fallen by this part of it; 1.
const FALL: f64 = 0.03;
/// … and by this many standard deviations of the noise; 1.
const FALL_NOISE: f64 = 4.0;
/// Samples above this part of a maximum make the parabola; 1.
const TOP: f64 = 0.93;
/// Levels of the fall from which the end is found, as parts of the peak; 1.
const END_LEVELS: (f64, f64) = (0.3, 0.1);

/// The support force of one impact without the ringing of the impact before.
#[derive(Clone, Debug, PartialEq)]
pub struct Alone {
    /// Sample of the recording at which it begins.
    pub first: usize,
    /// Times; s.
    pub times: Vec<f64>,
    /// Force; N.
    pub force: Vec<f64>,
}

/// Takes the ringing of the impact before out of a range of the support force.
pub fn alone(signals: &Signals, range: (usize, usize), before: Option<&Ringing>) -> Alone {
    let rings = |i: usize| {
        let time = signals.times[i];
        before
            .filter(|ringing| amplitude_at(ringing, time) > 0.3 * signals.noise)
            .map_or(0.0, |ringing| ringing_at(ringing, time))
    };
    Alone {
        first: range.0,
        times: signals.times[range.0..range.1].to_vec(),
        force: (range.0..range.1)
            .map(|i| signals.level_force[i] - rings(i))
            .collect(),
    }
}

/// First local maximum of the force of one impact from a sample on.
pub fn first_peak(signals: &Signals, alone: &Alone, from: usize) -> Peak {
    let force = &alone.force;
    let (mut top, mut i) = (from - alone.first, from - alone.first);
    while i < force.len() {
        if force[i] > force[top] {
            top = i;
        }
        let fall = (FALL * force[top].abs()).max(FALL_NOISE * signals.noise);
        if i > top && force[top] > signals.visible && force[top] - force[i] > fall {
            break;
        }
        i += 1;
    }
    Peak {
        sample: top + alone.first,
        ..refined(&alone.times, force, top, signals.noise)
    }
}

/// Largest support force in a range.
pub fn largest_peak(signals: &Signals, from: usize, until: usize) -> Peak {
    let force = signals.force;
    let top = (from..until).fold(from, |top, i| if force[i] > force[top] { i } else { top });
    refined(signals.times, force, top, signals.noise)
}

/// A maximum by the parabola through the samples around it.
fn refined(times: &[f64], force: &[f64], top: usize, noise: f64) -> Peak {
    let largest = force[top];
    let above = |i: &usize| force[*i] >= TOP * largest - noise;
    let first = (0..=top).rev().take_while(above).last().unwrap_or(top);
    let last = (top..force.len()).take_while(above).last().unwrap_or(top);
    let plain = Peak {
        sample: top,
        time: times[top],
        force: largest,
        sd: noise,
    };
    if last - first < 4 {
        return plain;
    }
    let fit = fit_polynomial(&times[first..=last], &force[first..=last], times[top], 2);
    match fit.map(|fit| (fit.derivatives, fit.noise_gains)) {
        Some((d, gains)) if d[2] < 0.0 && (d[1] / d[2]).abs() <= times[last] - times[first] => {
            Peak {
                sample: top,
                time: times[top] - d[1] / d[2],
                force: d[0] - 0.5 * d[1] * d[1] / d[2],
                sd: noise * gains[0],
            }
        }
        _ => plain,
    }
}

/// First touch before a peak, extrapolated from two levels of the rise as a power of time:
///
/// ```text
/// F = K (t − t₀)^q   ⟹   t_a − t₀ = (t_b − t_a) / ((b/a)^(1/q) − 1)
/// ```
///
/// q is in the middle of `RISE`, the rest of which is in `shape`. Behind a plate:
/// [`time_before`].
///
/// * `peak`: sample of the first peak
pub fn onset(signals: &Signals, alone: &Alone, peak: usize) -> Onset {
    let (times, force) = (&alone.times, &alone.force);
    let peak = peak - alone.first;
    let top = force[peak];
    let low = signals.visible.min(0.2 * top);
    let high = (LEVELS * low).min(HIGHEST_LEVEL * top);
    let crossing = |level: f64, from: usize| {
        let i = (0..from).rev().find(|i| force[*i] < level)?;
        let (a, b) = (force[i], force[i + 1]);
        let step = times[i + 1] - times[i];
        Some((i, times[i] + step * (level - a) / (b - a), (b - a) / step))
    };
    let found = crossing(high, peak).and_then(|high| Some((crossing(low, high.0 + 1)?, high)));
    let Some(((first, low_time, slope), (last, high_time, _))) = found else {
        return Onset {
            time: Uncertain::new(times[0], signals.interval),
            shape: 0.0,
            seen: false,
        };
    };
    let rise = high_time - low_time;
    let back = |q: f64| time_before(rise, high / low, q, signals.plate);
    let (short, long) = (back(RISE.0), back(RISE.1));
    // Between samples a line is drawn; in a rise of few samples it is a guess.
    let drawn = if last - first < 2 { 0.3 } else { 0.1 } * signals.interval;
    let coarse = if last - first < 2 { 1.0 } else { f64::INFINITY };
    let back = (0.5 * (short + long)).min(coarse * signals.interval);
    Onset {
        time: Uncertain::new(low_time - back, (signals.noise / slope).hypot(drawn)),
        shape: ((long - short) / 12f64.sqrt()).min(coarse * signals.interval),
        seen: true,
    }
}

/// End of a contact, by a line through two levels of the fall; `None` if it was not recorded.
pub fn end(signals: &Signals, segment: Segment, until: usize) -> Option<Uncertain> {
    let force = signals.contact_force;
    let top = (segment.0..segment.1).fold(
        segment.0,
        |top, i| {
            if force[i] > force[top] { i } else { top }
        },
    );
    let crossing = |level: f64, from: usize| {
        let last = (from..segment.1.max(from + 1))
            .rev()
            .find(|i| force[*i] >= level)?;
        let i = (last + 1..until).find(|i| force[*i] < level)?;
        let share = (force[i - 1] - level) / (force[i - 1] - force[i]);
        let times = signals.times;
        Some((i - 1, times[i - 1] + share * (times[i] - times[i - 1])))
    };
    let (sample, high) = crossing(END_LEVELS.0 * force[top], top)?;
    let (_, low) = crossing(END_LEVELS.1 * force[top], sample)?;
    let rest = (low - high) * END_LEVELS.1 / (END_LEVELS.0 - END_LEVELS.1);
    Some(Uncertain::new(
        low + rest,
        (0.5 * rest).hypot(0.3 * signals.interval),
    ))
}

/// Impulse of the contact force between two samples outside the contact:
///
/// ```text
/// ∫F_c dt = ∫F_s dt + [(2ζ/ω_n) F_s + F_s′/ω_n²]   from begin to end
/// ```
///
/// The bracket is the plate's momentum; it vanishes where the plate is quiet.
pub fn impulse(signals: &Signals, first: usize, last: usize) -> Uncertain {
    let (times, force) = (signals.times, signals.force);
    let area: f64 = (first..last)
        .map(|i| 0.5 * (force[i] + force[i + 1]) * (times[i + 1] - times[i]))
        .sum();
    let samples = (last - first) as f64;
    let white = signals.noise * signals.interval * samples.sqrt();
    let level = signals.level_sd * (times[last] - times[first]);
    let begin = momentum(signals, first);
    let end = momentum(signals, last);
    Uncertain::new(
        area + end.value - begin.value,
        white.hypot(level).hypot(begin.sd).hypot(end.sd),
    )
}

/// Momentum of the plate at a sample, as far as its support force tells.
fn momentum(signals: &Signals, at: usize) -> Uncertain {
    let Some((period, damping_ratio)) = signals.plate else {
        return Uncertain::default();
    };
    let natural = TAU / period / (1.0 - damping_ratio * damping_ratio).sqrt();
    let half = ((period / signals.interval / 8.0) as usize).max(2);
    let first = at.saturating_sub(half);
    let last = (at + half).min(signals.force.len() - 1);
    let times = &signals.times[first..=last];
    let fit = fit_polynomial(times, &signals.force[first..=last], signals.times[at], 3);
    fit.map_or(Uncertain::default(), |fit| {
        let weights = (2.0 * damping_ratio / natural, 1.0 / (natural * natural));
        Uncertain::new(
            weights.0 * fit.derivatives[0] + weights.1 * fit.derivatives[1],
            signals.noise * (weights.0 * fit.noise_gains[0]).hypot(weights.1 * fit.noise_gains[1]),
        )
    })
}

/// Root mean square of the support force about its mean, over the samples before one.
pub fn movement(signals: &Signals, until: usize, samples: usize) -> f64 {
    let part = &signals.level_force[until.saturating_sub(samples)..until];
    if part.is_empty() {
        return 0.0;
    }
    (part.iter().map(|v| v * v).sum::<f64>() / part.len() as f64).sqrt()
}
