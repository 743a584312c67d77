//! From the force of a drop rig, or of any train of impacts, to its bounces.

use crate::bounce::contact::{ContactForce, contact_force, smoothed_force};
use crate::bounce::finding::BounceFinding;
use crate::bounce::measure::{
    Onset, Signals, alone, end, first_peak, impulse, largest_peak, movement, onset,
};
use crate::bounce::quality::{LevelSeen, quality};
use crate::bounce::segment::{Hysteresis, Segment, envelope, segments};
use crate::bounce::static_load::{
    Before, LEAST_SAMPLES, QuietBlock, before_contact, followed_level, moves, quiet_blocks,
};
use crate::bounce::train::{
    Bounce, BounceOptions, BounceTrain, PlateRinging, PooledRinging, StaticLevel,
};
use crate::clipping::clipping;
use crate::error::Error;
use crate::finding::Finding;
use crate::recording::Channel;
use crate::ringing::model::{Ringing, decay_rate};
use crate::ringing::search::find_ringing;
use crate::trigger::{Orientation, Threshold};
use crate::uncertain::Uncertain;
use crate::validate::checked_times;

/// Fewest samples of a recording.
const LEAST_RECORDING: usize = 30;
/// The ringing is removed up to this departure from even spacing; intervals.
const UNEVEN: f64 = 0.1;
/// Part of the ringing that its removal may leave, mostly of further modes; 1.
const LEAVES: f64 = 0.05;
/// The contact force is averaged over this part of the period, or of a rigid
/// support's pulse, at least and at most; 1.
const SMOOTHING: (f64, f64) = (0.125, 0.34);
/// … and as long as brings the threshold below this part of the peak; 1.
const SMOOTHING_AIM: f64 = 0.01;
/// A quiet stretch is as long as this many widths of the strongest pulse.
const LEVEL_WIDTHS: usize = 4;
/// Rounds of finding contacts and ringing by each other.
const ROUNDS: usize = 2;
/// The impulse is taken over at most this many periods after the contact.
const MOST_CYCLES: usize = 5;
/// Bounces below this part of the largest impulse are taken for a swinging mount; 1.
const LEAST_IMPULSE: f64 = 0.02;
/// An onset is visible above this many standard deviations of the noise; 1.
const VISIBLE: f64 = 6.0;
/// Part of an onset's shape uncertainty that the next, weaker impact does not share; 1.
const OWN_SHAPE: f64 = 0.4;
/// Ringing is over when the force scatters by this many times the noise; 1.
const DECAYED: f64 = 1.5;

/// Finds the bounces in a force.
///
/// * `channel`: support or contact force; N
///
/// # Errors
/// Samples or times that are no numbers, too few of them, or thresholds in the
/// wrong order. A recording without a bounce gives a finding.
///
/// # Numerics
/// The plate's ringing is identified from the recording ([`find_ringing`]) and
/// removed by the recurrence that it obeys ([`contact_force`]); contacts are found by
/// hysteresis in what is left.
pub fn find_bounces(channel: &Channel, options: &BounceOptions) -> Result<BounceTrain, Error> {
    let (times, _) = checked_times(channel)?;
    check(channel, options)?;
    let mut levelled = levelled(&channel.samples, options);
    let even = is_even(&times);
    let mut plate = match options.plate {
        PlateRinging::Known {
            period,
            damping_ratio,
        } => Some((period, damping_ratio)),
        PlateRinging::Find if even => first_ringing(&times, &levelled),
        _ => None,
    }
    .filter(|_| even);
    let mut found = contacts(&times, &levelled, plate, options);
    let mut rings = Vec::new();
    for _ in 0..ROUNDS {
        if options.plate != PlateRinging::Find || plate.is_none() {
            break;
        }
        rings = ringing_of(&times, &levelled, &found.segments);
        plate = pooled(&rings).map(|p| (p.period.value, p.damping_ratio.value));
        found = contacts(&times, &levelled, plate, options);
    }
    let ringing = match options.plate {
        PlateRinging::Find => pooled(&rings),
        _ => plate.map(|(period, damping_ratio)| PooledRinging {
            period: Uncertain::exact(period),
            damping_ratio: Uncertain::exact(damping_ratio),
            bounces: 0,
        }),
    };
    if plate.is_some() {
        rings = ringing_of(&times, &levelled, &found.segments);
    }
    rings.resize(found.segments.len(), None);
    let mut findings = Vec::new();
    if found.segments.is_empty() {
        findings.push(BounceFinding::NoBounce {
            largest: levelled.before.largest,
            threshold: found.thresholds.0,
        });
    }
    if !found.segments.is_empty()
        && levelled.reversed
        && options.orientation == Orientation::Correct
    {
        findings.push(BounceFinding::Reversed);
    }
    let level_sd = levelled.level.sd;
    let signals = Signals {
        times: &times,
        interval: interval(&times),
        force: &levelled.force,
        level_force: &levelled.followed,
        contact_force: &found.contact.values,
        noise: levelled.before.noise,
        level_sd,
        visible: VISIBLE * levelled.before.noise,
        blur: found.smoothing,
        plate,
    };
    let bounces = measured(&signals, &found.segments, &rings, channel, &mut findings);
    let level = LevelSeen {
        samples_before: levelled.before.samples,
        quiet: &levelled.quiet,
        followed: options.static_level == StaticLevel::Follow,
    };
    findings.extend(quality(&signals, &level, &bounces));
    let intervals = intervals(&bounces);
    let smoothing = found.smoothing as f64 * signals.interval;
    Ok(BounceTrain {
        channel: channel.name.clone(),
        force: std::mem::take(&mut levelled.force),
        contact_force: found.contact.values,
        times,
        smoothing,
        thresholds: found.thresholds,
        static_level: levelled.level,
        noise: levelled.before.noise,
        ringing,
        bounces,
        intervals,
        findings,
    })
}

fn interval(times: &[f64]) -> f64 {
    (times[times.len() - 1] - times[0]) / (times.len() - 1) as f64
}

fn is_even(times: &[f64]) -> bool {
    let step = interval(times);
    let off = |(i, t): (usize, &f64)| ((t - times[0]) / step - i as f64).abs() < UNEVEN;
    times.iter().enumerate().all(off)
}

fn check(channel: &Channel, options: &BounceOptions) -> Result<(), Error> {
    if channel.samples.len() < LEAST_RECORDING {
        return Err(Error::too_few_samples(
            channel.name.clone(),
            channel.samples.len(),
            LEAST_RECORDING,
        ));
    }
    let bad = |option, value, expected| Err(Error::bad_option(option, value, expected));
    let level = match options.threshold {
        Threshold::Fixed(force) => force,
        Threshold::Automatic { deviations, .. } => deviations,
    };
    if !(level > 0.0 && level.is_finite()) {
        return bad("threshold", level, "a number above 0");
    }
    if !(options.release > 0.0 && options.release <= 1.0) {
        let expected = "a part of the threshold, above 0 and up to 1";
        return bad("release", options.release, expected);
    }
    if let PlateRinging::Known {
        period,
        damping_ratio,
    } = options.plate
    {
        if !(period > 0.0 && period.is_finite()) {
            return bad("period", period, "a positive period in s");
        }
        if !(0.0..1.0).contains(&damping_ratio) {
            return bad("damping_ratio", damping_ratio, "a number from 0 to below 1");
        }
    }
    Ok(())
}

/// The force from its level, with what is known of it.
struct Levelled {
    before: Before,
    level: Uncertain,
    reversed: bool,
    force: Vec<f64>,
    followed: Vec<f64>,
    quiet: Vec<QuietBlock>,
}

fn levelled(samples: &[f64], options: &BounceOptions) -> Levelled {
    let mut before = before_contact(samples);
    let reversed = before.reversed;
    let sign = match options.orientation {
        Orientation::Correct if reversed => -1.0,
        _ => 1.0,
    };
    let width = half_width(samples, before.level.value);
    let block = (LEVEL_WIDTHS * width).max(LEAST_SAMPLES);
    let quiet = quiet_blocks(samples, before.noise, block);
    if before.samples < LEAST_SAMPLES
        && let Some(found) =
            crate::noise::estimate::median(&quiet.iter().map(|b| b.mean).collect::<Vec<_>>())
    {
        before.level.value = found;
    }
    let level = match options.static_level {
        StaticLevel::Given(value) => Uncertain::exact(value),
        StaticLevel::BeforeFirst => before.level,
        StaticLevel::Follow => {
            Uncertain::new(before.level.value, before.noise / (block as f64).sqrt())
        }
    };
    let follow = options.static_level == StaticLevel::Follow || moves(&quiet, before.noise);
    let levels = match follow {
        true => followed_level(&quiet, samples.len(), level.value),
        false => vec![before.level.value; samples.len()],
    };
    let followed: Vec<f64> = samples
        .iter()
        .zip(&levels)
        .map(|(v, level)| sign * (v - level))
        .collect();
    let force = match options.static_level {
        StaticLevel::Follow => followed.clone(),
        _ => samples.iter().map(|v| sign * (v - level.value)).collect(),
    };
    Levelled {
        before,
        level,
        reversed,
        force,
        followed,
        quiet,
    }
}

/// Samples of the strongest pulse above half its height.
fn half_width(samples: &[f64], level: f64) -> usize {
    let height = |i: usize| (samples[i] - level).abs();
    let top = (0..samples.len()).fold(0, |top, i| if height(i) > height(top) { i } else { top });
    let above = |i: &usize| height(*i) >= 0.5 * height(top);
    (top..samples.len()).take_while(above).count() + (0..top).rev().take_while(above).count()
}

/// Ringing after the strongest impact: period and damping ratio.
fn first_ringing(times: &[f64], levelled: &Levelled) -> Option<(f64, f64)> {
    let force = &levelled.followed;
    let top = (0..force.len()).fold(0, |top, i| if force[i] > force[top] { i } else { top });
    let found = find_ringing(times, force, levelled.before.noise, (top, force.len()))?;
    Some((found.period.value, found.damping_ratio.value))
}

/// Contacts in a recording, with the force they were found in.
struct Contacts {
    contact: ContactForce,
    smoothing: usize,
    thresholds: (f64, f64),
    segments: Vec<Segment>,
}

fn contacts(
    times: &[f64],
    levelled: &Levelled,
    plate: Option<(f64, f64)>,
    options: &BounceOptions,
) -> Contacts {
    let step = interval(times);
    let noise = levelled.before.noise;
    let sampled = plate.map(|(period, ratio)| (period / step, ratio));
    let scale = sampled.map_or_else(
        || half_width(&levelled.followed, 0.0) as f64,
        |(period, _)| period,
    );
    let odd = |samples: f64| (samples as usize) | 1;
    let mut smoothing = odd(SMOOTHING.0 * scale);
    let smoothed = |length| match sampled {
        Some(plate) => contact_force(&levelled.followed, plate, length),
        None => smoothed_force(&levelled.followed, length),
    };
    let largest = |contact: &ContactForce| contact.values.iter().fold(0.0, |a: f64, v| a.max(*v));
    let mut contact = smoothed(smoothing);
    while VISIBLE * noise * contact.noise_gain > SMOOTHING_AIM * largest(&contact)
        && smoothing + 2 <= odd(SMOOTHING.1 * scale)
    {
        smoothing += 2;
        contact = smoothed(smoothing);
    }
    let own = noise * contact.noise_gain;
    let on = options.threshold.level(own, largest(&contact));
    let hysteresis = Hysteresis {
        on,
        off: options.release * on,
        leaves: if plate.is_some() { LEAVES } else { 0.0 },
    };
    let decay = sampled.map_or(1.0, |(period, ratio)| decay_rate(period, ratio));
    let ringing = envelope(&levelled.followed, 2 * smoothing, decay);
    let gap = options.smallest_gap.map(|gap| gap / step);
    let mut segments = segments(&contact.values, &ringing, &hysteresis, gap);
    let area = |s: &Segment| contact.values[s.0..s.1].iter().sum::<f64>() * step;
    let most = segments.iter().map(area).fold(0.0, f64::max);
    segments.retain(|s| {
        let chance = 6.0 * own * step * ((s.1 - s.0) as f64 * smoothing as f64).sqrt();
        let least = chance.max(LEAST_IMPULSE * most);
        area(s) >= options.smallest_impulse.unwrap_or(least)
    });
    Contacts {
        contact,
        smoothing,
        thresholds: (hysteresis.on, hysteresis.off),
        segments,
    }
}

fn ringing_of(times: &[f64], levelled: &Levelled, segments: &[Segment]) -> Vec<Option<Ringing>> {
    let force = &levelled.followed;
    (0..segments.len())
        .map(|k| {
            let (from, to) = segments[k];
            let until = segments.get(k + 1).map_or(force.len(), |next| next.0);
            let top = (from..to).fold(from, |top, i| if force[i] > force[top] { i } else { top });
            find_ringing(times, force, levelled.before.noise, (top, until))
        })
        .collect()
}

/// Weighted means over the bounces.
fn pooled(rings: &[Option<Ringing>]) -> Option<PooledRinging> {
    let known: Vec<Ringing> = rings.iter().flatten().copied().collect();
    let mean = |part: fn(&Ringing) -> Uncertain| {
        let parts: Vec<Uncertain> = known.iter().map(part).collect();
        crate::uncertain::weighted_mean(&parts)
    };
    Some(PooledRinging {
        period: mean(|r| r.period)?,
        damping_ratio: mean(|r| r.damping_ratio)?,
        bounces: known.len(),
    })
}

fn measured(
    signals: &Signals,
    segments: &[Segment],
    rings: &[Option<Ringing>],
    channel: &Channel,
    findings: &mut Vec<BounceFinding>,
) -> Vec<Bounce> {
    let n = signals.times.len();
    let mut bounces: Vec<Bounce> = Vec::new();
    for (k, &segment) in segments.iter().enumerate() {
        let previous = k.checked_sub(1).map(|k| segments[k]);
        let least = previous.map_or(0, |p| (p.1 + segment.0) / 2);
        let least = least.max(segment.0.saturating_sub(4 * signals.blur + 4));
        let until = segments.get(k + 1).map_or(n, |next| next.0);
        let before = k.checked_sub(1).and_then(|k| rings[k].as_ref());
        let alone = alone(signals, (least, until), before);
        let first = first_peak(signals, &alone, segment.0);
        let largest = largest_peak(signals, segment.0, until);
        let onset: Onset = onset(signals, &alone, first.sample);
        let end = end(signals, segment, until);
        let (from, to, decayed) = window(signals, segment, previous, until);
        let clip = clipping(
            &channel.name,
            signals.times,
            signals.force,
            (
                signals.times[segment.0],
                signals.times[segment.1.min(n - 1)],
            ),
            false,
        );
        if let Some(Finding::Clipped { value, samples, .. }) = clip {
            findings.push(BounceFinding::Clipped {
                bounce: k + 1,
                limit: value,
                samples,
            });
        }
        bounces.push(Bounce {
            onset: onset.time,
            onset_shape: onset.shape,
            end: end.unwrap_or(Uncertain::exact(signals.times[n - 1])),
            peak: largest.force,
            peak_time: largest.time,
            first_peak: first.force,
            peak_sd: first.sd,
            impulse: impulse(signals, from, to),
            ringing: rings[k],
            decayed,
            clipped: matches!(findings.last(), Some(BounceFinding::Clipped { bounce, .. }) if *bounce == k + 1),
            complete: onset.seen && end.is_some(),
            samples: segment,
        });
    }
    bounces
}

/// Samples of the impulse, from before the contact until quiet or the next contact;
/// and whether it became quiet.
fn window(
    signals: &Signals,
    segment: Segment,
    previous: Option<Segment>,
    until: usize,
) -> (usize, usize, bool) {
    let n = signals.times.len();
    let margin = 2 * signals.blur + 2 + (segment.1 - segment.0) / 10;
    let least = previous.map_or(0, |p| (p.1 + segment.0) / 2);
    let from = segment.0.saturating_sub(margin).max(least);
    let last = if until == n { n - 1 } else { until };
    let most = (segment.1 + last) / 2;
    let Some((period, _)) = signals.plate else {
        return (
            from,
            (segment.1 + margin).min(most.max(segment.1)).min(n - 1),
            true,
        );
    };
    let cycle = ((period / signals.interval) as usize).max(3);
    let is_quiet = |end: &usize| movement(signals, *end, cycle) <= DECAYED * signals.noise;
    // The longer the window, the more the level's uncertainty counts.
    let latest = last.saturating_sub(margin).max(segment.1).min(n - 1);
    let enough = (segment.1 + margin + MOST_CYCLES * cycle).min(latest);
    let mut ends = (segment.1 + cycle..=latest).step_by((cycle / 4).max(1));
    match ends.find(is_quiet) {
        Some(end) => (from, end.min(enough), true),
        None => (from, enough, is_quiet(&latest)),
    }
}

/// Times from onset to onset, free of what the shape of the rise does to both.
fn intervals(bounces: &[Bounce]) -> Vec<Uncertain> {
    bounces
        .windows(2)
        .map(|pair| {
            Uncertain::new(
                pair[1].onset.value - pair[0].onset.value,
                pair[0]
                    .onset
                    .sd
                    .hypot(pair[1].onset.sd)
                    .hypot(pair[1].onset_shape - pair[0].onset_shape)
                    .hypot(OWN_SHAPE * pair[0].onset_shape.max(pair[1].onset_shape)),
            )
        })
        .collect()
}
