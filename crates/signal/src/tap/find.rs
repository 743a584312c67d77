//! Taps in a recording of sound: where each begins, and the stretch in which
//! the fruit rings alone.

use crate::error::Error;
use crate::recording::{Channel, Times};
use crate::tap::finding::TapFinding;
use crate::tap::spectrum::band_limited;
use std::ops::Range;

/// How taps are found and cut.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TapOptions {
    /// Lowest frequency of interest; Hz.
    pub low: f64,
    /// Highest frequency of interest; Hz.
    pub high: f64,
    /// Energy of a tap over that just before it, at least; 1.
    pub rise: f64,
    /// Amplitude of a tap as a part of the strongest, at least; 1.
    pub least_level: f64,
    /// Left out after the begin, while the hammer touches; s.
    pub hit: f64,
    /// Longest stretch that is evaluated; s.
    pub longest: f64,
    /// Shortest stretch that is evaluated; s.
    pub shortest: f64,
}

impl Default for TapOptions {
    fn default() -> Self {
        Self {
            low: 150.0,
            high: 2500.0,
            rise: 10.0,
            least_level: 0.1,
            hit: 2e-3,
            longest: 0.25,
            shortest: 0.02,
        }
    }
}

/// One tap.
#[derive(Clone, Debug, PartialEq)]
pub struct Tap {
    /// Begin; s.
    pub onset: f64,
    /// Samples in which the fruit rings, from the end of the hit on.
    pub ringing: Range<usize>,
    /// Largest sound in the band, in the first 10 ms; unit of the samples.
    pub peak: f64,
}

/// The taps of a recording.
#[derive(Clone, Debug, PartialEq)]
pub struct Taps {
    /// Sampling interval; s.
    pub interval: f64,
    /// The taps, in their order.
    pub taps: Vec<Tap>,
    /// Samples before the first tap, where there are enough of them.
    pub quiet: Option<Range<usize>>,
    /// What a reader must know.
    pub findings: Vec<TapFinding>,
}

/// Length of the blocks over which energy is taken; s.
const BLOCK: f64 = 2e-3;
/// A tap is at its strongest within this many blocks.
const PEAK_BLOCKS: usize = 5;
/// A tap exceeds twice the energy of every block as far back as this; beats of
/// two modes swell within it too, but not as high.
const MEMORY_BLOCKS: usize = 20;
/// Part of the blocks that is quieter than the noise floor.
const QUIET_PART: f64 = 0.1;
/// Part of the peak at which a tap begins.
const ONSET_LEVEL: f64 = 0.2;
/// Kept clear before the next tap, and after the quiet before the first; s.
const CLEARANCE: f64 = 3e-3;
/// Departure of a sampling time from even spacing that is tolerated, in intervals.
const UNEVEN: f64 = 0.25;
/// Samples at the largest value, of either sign, from which a tap is clipped.
const CLIPPED_SAMPLES: usize = 3;

/// Finds the taps of a channel.
///
/// # Errors
/// The channel is too short, not finite or not evenly sampled, the band does
/// not fit the sampling rate, or there is no tap.
pub fn find_taps(channel: &Channel, options: &TapOptions) -> Result<Taps, Error> {
    let interval = even_interval(channel)?;
    check(channel, interval, options)?;
    // Hum, drift and hiss would hide taps.
    let sound = band_limited(&channel.samples, interval, options.low, options.high);
    let mut taps = Taps {
        interval,
        taps: Vec::new(),
        quiet: None,
        findings: Vec::new(),
    };
    let onsets = onsets(&sound, interval, options, &mut taps.findings);
    let Some(&first) = onsets.first() else {
        let largest = sound.iter().fold(0.0, |a: f64, b| a.max(b.abs()));
        return Err(Error::NoTap {
            channel: channel.name.clone(),
            largest,
            rise: options.rise,
        });
    };
    let count = |time: f64| (time / interval).round() as usize;
    let clear = first.saturating_sub(count(CLEARANCE));
    taps.quiet = (clear >= count(options.shortest)).then_some(0..clear);
    for (index, &onset) in onsets.iter().enumerate() {
        let start = onset + count(options.hit);
        let next = onsets
            .get(index + 1)
            .map(|next| next.saturating_sub(count(CLEARANCE)));
        let end = next
            .unwrap_or(sound.len())
            .min(start + count(options.longest));
        let at = channel.times.at(onset);
        if end < start + count(options.shortest) {
            taps.findings.push(TapFinding::TapTooShort { time: at });
            continue;
        }
        let early = &sound[onset..end.min(onset + count(PEAK_BLOCKS as f64 * BLOCK))];
        if clipped(&channel.samples[onset..end]) {
            taps.findings.push(TapFinding::TapClipped { time: at });
        }
        taps.taps.push(Tap {
            onset: at,
            ringing: start..end,
            peak: early.iter().fold(0.0, |a: f64, b| a.max(b.abs())),
        });
    }
    Ok(taps)
}

/// The sampling interval of a channel whose samples are evenly spaced.
fn even_interval(channel: &Channel) -> Result<f64, Error> {
    let times = match &channel.times {
        Times::Uniform { interval, .. } => return Ok(*interval),
        Times::Listed(times) => times,
    };
    let few = Error::too_few_samples(channel.name.clone(), times.len(), 2);
    let (Some(first), Some(last), true) = (times.first(), times.last(), times.len() > 1) else {
        return Err(few);
    };
    let interval = (last - first) / (times.len() - 1) as f64;
    let jitter = |(i, time): (usize, &f64)| ((time - first) / interval - i as f64).abs();
    match times
        .iter()
        .enumerate()
        .map(jitter)
        .position(|jitter| jitter.is_nan() || jitter > UNEVEN)
    {
        None => Ok(interval),
        Some(sample) => Err(Error::UnevenSampling {
            channel: channel.name.clone(),
            sample,
            time: times[sample],
            expected: first + sample as f64 * interval,
        }),
    }
}

fn check(channel: &Channel, interval: f64, options: &TapOptions) -> Result<(), Error> {
    let bad = |option, value, expected| Err(Error::bad_option(option, value, expected));
    if !(interval > 0.0 && interval.is_finite()) {
        return Err(Error::BadInterval {
            channel: channel.name.clone(),
            interval,
        });
    }
    if !(options.low > 0.0 && options.low < options.high) {
        return bad(
            "band",
            options.low,
            "a lower end above 0 and below the upper end, in Hz",
        );
    }
    if options.high >= 0.45 / interval {
        let expected =
            "an upper end below 45 % of the sampling rate; narrow the band, or sample faster";
        return bad("band", options.high, expected);
    }
    if options.rise.is_nan() || options.rise <= 1.0 {
        return bad("rise", options.rise, "a number above 1");
    }
    let least = ((options.shortest + options.hit) / interval).ceil() as usize;
    if channel.samples.len() < least.max(100) {
        return Err(Error::too_few_samples(
            channel.name.clone(),
            channel.samples.len(),
            least.max(100),
        ));
    }
    match channel.samples.iter().position(|value| !value.is_finite()) {
        None => Ok(()),
        Some(sample) => Err(Error::NotFinite {
            channel: channel.name.clone(),
            sample,
            time: channel.times.at(sample),
            value: channel.samples[sample],
        }),
    }
}

/// Indices at which taps begin.
fn onsets(
    sound: &[f64],
    interval: f64,
    options: &TapOptions,
    findings: &mut Vec<TapFinding>,
) -> Vec<usize> {
    let block = ((BLOCK / interval).round() as usize).max(1);
    let energy = |part: &[f64]| part.iter().map(|x| x * x).sum::<f64>() / part.len() as f64;
    let energies: Vec<f64> = sound.chunks(block).map(energy).collect();
    let strongest = energies.iter().fold(0.0, |a: f64, b| a.max(*b));
    let mut sorted = energies.clone();
    sorted.sort_by(f64::total_cmp);
    let floor = sorted[(QUIET_PART * sorted.len() as f64) as usize];
    let least = (options.least_level * options.least_level * strongest).max(options.rise * floor);
    let largest = |range: Range<usize>| energies[range].iter().fold(0.0, |a: f64, b| a.max(*b));

    let mut found = Vec::new();
    let mut j = 1;
    while j < energies.len() {
        let peak = largest(j..(j + PEAK_BLOCKS).min(energies.len()));
        let just_before = energies[j.saturating_sub(2)].max(floor);
        let before = largest(j.saturating_sub(MEMORY_BLOCKS)..j);
        // The hit may fall anywhere in the block before.
        let rises = energies[j] > options.rise * just_before && peak > 2.0 * before;
        if strongest > 0.0 && rises && peak >= least {
            let from = (j - 1) * block;
            let to = ((j + PEAK_BLOCKS) * block).min(sound.len());
            let level = sound[from..to].iter().fold(0.0, |a: f64, b| a.max(b.abs()));
            let begins = sound[from..to]
                .iter()
                .position(|x| x.abs() >= ONSET_LEVEL * level);
            found.push(from + begins.unwrap_or(0));
            j += MEMORY_BLOCKS;
        } else {
            j += 1;
        }
    }
    // A recorder that is triggered by the tap has nothing before it.
    let begin = largest(0..PEAK_BLOCKS.min(energies.len()));
    let later = found
        .first()
        .is_none_or(|first| *first > 2 * MEMORY_BLOCKS * block);
    if later && begin >= least && begin > options.rise * floor && energies[0] > options.rise * floor
    {
        findings.push(TapFinding::BeginsInTap);
        found.insert(0, 0);
    }
    found
}

fn clipped(samples: &[f64]) -> bool {
    let at_limit = |limit: f64| samples.iter().filter(|x| **x == limit).count();
    let most = samples.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let least = samples.iter().copied().fold(f64::INFINITY, f64::min);
    most > least && at_limit(most).max(at_limit(least)) >= CLIPPED_SAMPLES && {
        // Coarse converters repeat values by chance; at the limit they do so in a row.
        let runs = |limit: f64| {
            samples
                .windows(CLIPPED_SAMPLES)
                .any(|w| w.iter().all(|x| *x == limit))
        };
        runs(most) || runs(least)
    }
}
