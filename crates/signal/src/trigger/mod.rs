//! Contact windows: when the force is above a threshold.

mod quiet_stretch;
pub(crate) mod scale;

use crate::contact_window::{LEAST_SAMPLES, RINGING_PEAK, windows};
use crate::error::{Error, Times};
use crate::noise::estimate::{baseline, median};
use crate::trigger::quiet_stretch::{LEVEL, quiet_stretch, usual_deviation, wander};
use crate::trigger::scale::{
    Level, PulseScale, RunningSums, THRESHOLD_AIM, largest, pulse_scale, quieter, white_noise,
};
use serde::Serialize;
use std::f64::consts::TAU;
use std::ops::Range;

pub use crate::contact_window::ContactWindow;

/// Samples from which the baseline is first guessed, as a part of the signal; 1.
const PILOT_SHARE: f64 = 0.05;

/// The first samples are in contact if their level changes by this many standard deviations; 1.
const PILOT_CLEAR: f64 = 6.0;

/// Fewest samples of a baseline that is worth the name.
const LEAST_BASELINE: usize = 5;

/// The baseline ends before the contact by this part of the contact's duration; 1.
const BASELINE_GUARD: f64 = 0.1;

/// Highest first threshold where the zero seems to wander; part of the largest force; 1.
const WANDERING_SHARE: f64 = 0.5;

/// A threshold that was given must be this many deviations of the averaged noise, or the
/// signal is averaged over more samples: noise alone crosses it else, and cuts a contact into
/// pieces; 1.
const FIXED_CLEAR: f64 = 3.0;

/// Averages that are noisier than those of white noise by this factor show noise that persists; 1.
const PERSISTS: f64 = 1.5;

/// The noise of an averaged signal is measured in this many independent averages, at least.
const LEAST_AVERAGES: usize = 40;

/// Above what a force counts as contact.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Threshold {
    /// A force above the baseline; N.
    Fixed(f64),
    /// Found from the noise of the baseline.
    Automatic {
        /// Standard deviations of the smoothed force before contact; 1.
        deviations: f64,
        /// Never less than this; N.
        least: f64,
        /// Never less than this part of the largest force; 1.
        share: f64,
    },
}

impl Default for Threshold {
    fn default() -> Self {
        Self::Automatic {
            deviations: 5.0,
            least: 0.0,
            share: 0.01,
        }
    }
}

impl Threshold {
    /// The force that counts as contact, for this noise and largest force; N.
    pub(crate) fn level(self, noise: f64, largest: f64) -> f64 {
        match self {
            Self::Fixed(force) => force,
            Self::Automatic {
                deviations,
                least,
                share,
            } => (deviations * noise).max(least).max(share * largest),
        }
    }

    /// Standard deviations between noise and threshold; 0 for a fixed one.
    fn deviations(self) -> f64 {
        match self {
            Self::Fixed(_) => 0.0,
            Self::Automatic { deviations, .. } => deviations,
        }
    }
}

/// What the force is measured from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Baseline {
    /// The mean before the first contact is subtracted.
    #[default]
    Remove,
    /// A straight line through the force before the first and after the last
    /// contact is subtracted.
    Drift,
    /// The force is used as recorded.
    Keep,
}

/// What is done about a channel whose sign is opposite to the convention.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Orientation {
    /// Change its sign, and report it.
    #[default]
    Correct,
    /// Use it as recorded, and report it.
    AsRecorded,
}

/// Which of several contacts is used.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum ContactChoice {
    /// The first.
    #[default]
    First,
    /// The one with the largest force.
    Strongest,
    /// The first that begins in a range of time; of its samples those in the range.
    Within {
        /// Begin of the range; s.
        from: f64,
        /// End of the range; s.
        to: f64,
    },
}

/// How contact windows are found.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct TriggerOptions {
    /// Above what a force counts as contact.
    pub threshold: Threshold,
    /// A contact is over when the force is below this part of the threshold; 1.
    pub release: f64,
    /// Contacts closer than this are one; s. `None`: a tenth of the longest.
    pub minimum_gap: Option<f64>,
    /// What the force is measured from.
    pub baseline: Baseline,
    /// Which of several contacts is used.
    pub choice: ContactChoice,
}

impl Default for TriggerOptions {
    fn default() -> Self {
        Self {
            threshold: Threshold::default(),
            release: 0.5,
            minimum_gap: None,
            baseline: Baseline::default(),
            choice: ContactChoice::default(),
        }
    }
}

/// The contacts of a recording and what they were found with.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Contacts {
    /// In order of time; at least one.
    pub windows: Vec<ContactWindow>,
    /// The threshold, above the baseline; N.
    pub threshold: f64,
    /// Mean force before the first contact; N.
    pub offset: f64,
    /// Noise of one sample before the first contact; N. May be zero.
    pub deviation: f64,
    /// Samples before the first contact.
    pub before: usize,
    /// Those of them from which offset and noise come: the last ones, as many as are level;
    /// with none of them the offset is that of the end, if the signal rests there, or 0.
    pub quiet: Range<usize>,
    /// Standard uncertainty of the zero in contact, beside that of its mean: how far it wanders,
    /// and what a trend that was subtracted before leaves; N.
    pub trend_sd: f64,
    /// True if the force is negative in contact.
    pub reversed: bool,
    /// Samples over which the force was averaged to compare it.
    pub smoothing: usize,
}

impl Contacts {
    /// The contact that `choice` names.
    ///
    /// # Errors
    /// [`Error::NoContactInRange`] if none begins in the range asked for.
    pub fn choose(&self, choice: ContactChoice) -> Result<usize, Error> {
        let all: Vec<usize> = (0..self.windows.len()).collect();
        self.choose_among(&all, choice)
    }

    /// As [`Self::choose`], the first and the strongest of those given; at least one.
    pub(crate) fn choose_among(
        &self,
        candidates: &[usize],
        choice: ContactChoice,
    ) -> Result<usize, Error> {
        let first = candidates.first().copied().unwrap_or(0);
        let strongest = |best: usize, i: usize| {
            if self.windows[i].peak > self.windows[best].peak {
                i
            } else {
                best
            }
        };
        match choice {
            ContactChoice::First => Ok(first),
            ContactChoice::Strongest => Ok(candidates.iter().copied().fold(first, strongest)),
            ContactChoice::Within { from, to } => self
                .windows
                .iter()
                .position(|window| window.onset >= from && window.onset <= to)
                .ok_or_else(|| Error::NoContactInRange {
                    from,
                    to,
                    found: Times(self.windows.iter().map(|w| w.onset).collect()),
                }),
        }
    }
}

/// A signal that is large during contact, with its name and unit for messages.
#[derive(Clone, Copy, Debug)]
pub struct Signal<'a> {
    /// Name of the channel.
    pub name: &'a str,
    /// Unit of the values, for messages.
    pub unit: &'static str,
    /// Sampling times; s.
    pub times: &'a [f64],
    /// Samples, of either sign.
    pub values: &'a [f64],
}

/// All contacts of a recording.
///
/// The sign is that of the largest departure from the first samples (from the
/// last, if the first are in contact). Offset and noise come from the samples
/// before the first contact, from the last of them where the zero drifts. The signal is averaged
/// over 1/50 of the contact (not at all where that is less than a sample), over up to 1/5 of it
/// where the noise, white or not, asks for that, and compared with the threshold: a contact begins above
/// it and is over below `release` of it. Excursions that are small or short
/// against the largest are ringing and left out; contacts with a shorter gap
/// than the minimum are one.
///
/// Noise delays the onset: a threshold of 5 standard deviations of the averaged
/// force is crossed up to 1/10 of the contact after touch where the peak is
/// twice the noise of a sample, sooner where it is more.
///
/// # Errors
/// [`Error::NoContact`] with the largest force and the threshold,
/// [`Error::BadOption`], [`Error::TooFewSamples`].
pub fn find_contacts(signal: &Signal, options: &TriggerOptions) -> Result<Contacts, Error> {
    check(signal, options)?;
    let n = signal.values.len();

    // A first guess of zero and sign.
    let sample_noise = white_noise(signal.values);
    let (pilot, zero_from_end) = pilot_level(signal.values, sample_noise);
    let keeps = options.baseline == Baseline::Keep;
    let centre = if keeps { 0.0 } else { pilot };
    let sums = RunningSums::of(signal.values);
    let PulseScale {
        top,
        reversed,
        smoothing,
        visible,
    } = pulse_scale(
        &sums,
        Level {
            value: centre,
            samples: pilot_samples(n),
        },
        sample_noise,
        options.threshold.deviations(),
    );
    let sign = if reversed { -1.0 } else { 1.0 };
    let averaged = sums.means(smoothing);

    // Baseline, threshold and windows; once more when the first contact is known.
    // Where nothing stands out, all is baseline.
    let mut before = if visible {
        pre_contact(&averaged, top, centre, sign)
    } else {
        n
    };
    let mut contacts = Contacts {
        reversed,
        smoothing,
        ..Contacts::default()
    };
    let mut rise = signal.times[top] - signal.times[before.min(top)];
    let (mut first_pass, mut refused) = (true, None);
    loop {
        let height = averaged[top] - centre;
        let quiet = quiet_stretch(signal.times, signal.values, before, (height, rise));
        let own = &signal.values[quiet.clone()];
        let of_own = baseline(own);
        let (mean, deviation) = of_own.unwrap_or((if zero_from_end { pilot } else { 0.0 }, 0.0));
        let usual = usual_deviation(own, of_own).unwrap_or(0.0);
        contacts.deviation = deviation;
        contacts.before = before;
        contacts.trend_sd = wander(signal.values, &quiet, height.abs());
        contacts.quiet = quiet.clone();
        contacts.offset = if keeps { 0.0 } else { mean };
        let raised = raised(signal.values, contacts.offset, sign);
        let noise = |length: usize| averaged_noise(&sums, &quiet, usual.max(sample_noise), length);
        let raised_sums = RunningSums::of(&raised);
        let wanted = match options.threshold {
            Threshold::Fixed(force) => force / FIXED_CLEAR,
            Threshold::Automatic { deviations, .. } => {
                let white = sample_noise / (smoothing as f64).sqrt();
                (THRESHOLD_AIM * height.abs() / deviations).max(PERSISTS * white)
            }
        };
        contacts.smoothing = quieter(&raised_sums, smoothing, wanted, noise);
        let smoothing = contacts.smoothing;
        let smooth = raised_sums.means(smoothing);
        let largest = largest(&smooth, |v| v);
        contacts.threshold = level(&contacts, options, noise(smoothing), largest, first_pass);
        let release = options.release * contacts.threshold;
        contacts.windows = windows(
            signal.times,
            &smooth,
            contacts.threshold,
            release,
            options.minimum_gap,
        );
        // A second look, from less, needs a level zero to look from.
        let looked_again = refused.is_some();
        let first = contacts.windows.first().copied();
        let Some(first) = first.filter(|_| !looked_again || !quiet.is_empty()) else {
            let error = || no_contact(signal, &raised, contacts.threshold);
            let error = refused.take().unwrap_or_else(error);
            // Contacts as large as the strongest may lie before it, and pass for noise.
            let earlier = before_all(&averaged, top, centre, sign);
            if looked_again || !first_pass || earlier >= before {
                return Err(error);
            }
            refused = Some(error);
            before = earlier;
            continue;
        };
        if !first_pass {
            return Ok(contacts);
        }
        (first_pass, refused) = (false, None);
        let until = first.onset - BASELINE_GUARD * (first.end - first.onset);
        rise = 0.5 * (first.end - first.onset);
        before = signal.times.partition_point(|&t| t < until);
    }
}

/// A signal above its zero, positive in contact.
fn raised(values: &[f64], zero: f64, sign: f64) -> Vec<f64> {
    values.iter().map(|value| sign * (value - zero)).collect()
}

/// The error of a signal that does not reach its threshold.
///
/// * `raised`: the signal above its zero, positive in contact
fn no_contact(signal: &Signal, raised: &[f64], threshold: f64) -> Error {
    Error::NoContact {
        channel: signal.name.to_owned(),
        largest: largest(raised, |v| v),
        threshold,
        unit: signal.unit,
    }
}

/// The threshold above the baseline; N.
fn level(
    contacts: &Contacts,
    options: &TriggerOptions,
    noise: f64,
    largest: f64,
    first_pass: bool,
) -> f64 {
    let wandering = noise.hypot(contacts.trend_sd);
    let level = options.threshold.level(wandering, largest);
    // Before the largest contact there may be others, which look like a zero that wanders.
    let highest = if first_pass && contacts.trend_sd > 0.0 {
        WANDERING_SHARE * largest
    } else {
        f64::INFINITY
    };
    level.min(highest).max(f64::MIN_POSITIVE)
}

fn check(signal: &Signal, options: &TriggerOptions) -> Result<(), Error> {
    let n = signal.values.len();
    if n < LEAST_SAMPLES {
        let name = signal.name.to_owned();
        return Err(Error::too_few_samples(name, n, LEAST_SAMPLES));
    }
    let bad = |option, value, expected| Err(Error::bad_option(option, value, expected));
    match options.threshold {
        Threshold::Fixed(force) if !(force > 0.0 && force.is_finite()) => {
            return bad("contact threshold", force, "a positive force");
        }
        Threshold::Automatic { deviations, .. } if deviations.is_nan() || deviations <= 0.0 => {
            return bad("threshold deviations", deviations, "a positive number");
        }
        _ => {}
    }
    if !(options.release > 0.0 && options.release <= 1.0) {
        return bad(
            "contact release",
            options.release,
            "a part of the threshold, above 0 and up to 1",
        );
    }
    if let Some(gap) = options.minimum_gap
        && (gap.is_nan() || gap < 0.0)
    {
        return bad("minimum gap", gap, "a time of 0 s or more");
    }
    Ok(())
}

/// Noise of a mean over `length` samples: that of white noise, or what is seen before contact
/// if that is more (noise that persists averages out less).
///
/// It is seen in means over `length`. Where fewer than [`LEAST_AVERAGES`] of them lie before
/// contact, shorter ones tell whether it persists: longer means are quieter by the root of their
/// length.
///
/// * `noise`: standard deviation of a sample
fn averaged_noise(sums: &RunningSums, quiet: &Range<usize>, noise: f64, length: usize) -> f64 {
    let white = noise / (length as f64).sqrt();
    let enough = (quiet.len() / LEAST_AVERAGES).min(length);
    let seen = enough.saturating_sub(1) | 1;
    let means = sums.means_in(quiet.clone(), seen);
    let own = usual_deviation(&means, baseline(&means)).unwrap_or(0.0);
    let own = own * (seen as f64 / length as f64).sqrt();
    let counts = seen == length || own > PERSISTS * white;
    if counts { own.max(white) } else { white }
}

/// Level of the signal outside contact, and whether it comes from the end: that
/// is so if the signal changes in its first samples and rests in its last.
///
/// * `noise`: standard deviation of a sample
fn pilot_level(values: &[f64], noise: f64) -> (f64, bool) {
    let n = values.len();
    let samples = pilot_samples(n);
    let middle = |part: &[f64]| median(part).unwrap_or(0.0);
    // Level, and by how much it changes from the first half to the second.
    let level = |part: &[f64]| {
        let (early, late) = part.split_at(part.len() / 2);
        (middle(part), (middle(late) - middle(early)).abs())
    };
    let (first, first_change) = level(&values[..samples]);
    let (last, last_change) = level(&values[n - samples..]);
    let (low, high) = (-largest(values, |v| -v), largest(values, |v| v));
    // Of the difference of two medians, each of half of the samples.
    let chance = noise * (TAU / samples as f64).sqrt();
    let changes = first_change > (LEVEL * (high - low)).max(PILOT_CLEAR * chance);
    if changes && last_change < first_change / 3.0 {
        return (last, true);
    }
    (first, false)
}

/// Samples of a recording of `n` from which its level is first guessed.
fn pilot_samples(n: usize) -> usize {
    ((PILOT_SHARE * n as f64) as usize).clamp(LEAST_BASELINE.min(n), n)
}

/// Samples before anything that reaches half of the strongest contact begins, less a guard.
fn before_all(values: &[f64], extreme: usize, centre: f64, sign: f64) -> usize {
    let half = 0.5 * sign * (values[extreme] - centre);
    let high = |v: &f64| sign * (v - centre) >= half;
    let first = values.iter().position(high).unwrap_or(extreme);
    pre_contact(values, first, centre, sign)
}

/// Samples before the strongest contact begins, less a guard.
fn pre_contact(values: &[f64], extreme: usize, centre: f64, sign: f64) -> usize {
    let level = RINGING_PEAK * sign * (values[extreme] - centre);
    let start = values[..extreme]
        .iter()
        .rposition(|v| sign * (v - centre) <= level)
        .map_or(0, |i| i + 1);
    let guard = BASELINE_GUARD * (extreme - start) as f64;
    start.saturating_sub(guard.ceil() as usize)
}
