//! The zero of a force where it does not stay: a drift, or the hum of the mains.
//!
//! A zero that stays needs nothing from here; its mean before contact is subtracted later.

use crate::error::Error;
use crate::finding::Finding;
use crate::linear_fit::{LinearFit, linear_fit, sum};
use crate::noise::estimate::{median, median_of};
use crate::track::Track;
use crate::trigger::{Baseline, ContactChoice, ContactWindow, Contacts, TriggerOptions};
use std::f64::consts::TAU;
use std::ops::Range;

/// Functions of time that make up a zero: level, slope, sine and cosine of the hum.
const TERMS: usize = 4;
/// Frequencies of the mains; Hz.
const MAINS: [f64; 2] = [50.0, 60.0];
/// Blocks whose means stand for a recording, and for the quiet samples on one side.
const BLOCKS: usize = 400;
const SIDE_BLOCKS: usize = 25;
/// Fewest samples on a side that tell anything.
const LEAST_QUIET: usize = 5;
/// Part of a contact's duration that is kept away from; 1.
const GUARD: f64 = 0.25;
/// Quiet samples that are used on either side; contact durations, and s, whichever is more.
const NEAR: (f64, f64) = (8.0, 0.04);
/// Part of a recording at either end that must not be in contact for a first guess; 1.
const ENDS: f64 = 0.05;
/// A first guess must bring the median departure down to this part; 1.
const GUESS_GAIN: f64 = 0.7;
/// Blocks farther than this from a first guess are in contact; robust deviations.
const IN_CONTACT: f64 = 5.0;
/// Square of how many deviations a further term must stand out by; 1.
const DECISIVE: f64 = 25.0;
/// Periods of the mains that quiet samples must span to tell a hum; 1.
const PERIODS: f64 = 1.0;
/// Means in a period of it; 1.
const MEANS_IN_PERIOD: f64 = 5.0;
/// A change of the zero over the contact that is told, as a part of the peak; 1.
const SHIFT: f64 = 0.01;
/// Ratio of standard deviation to median magnitude of Gaussian noise; 1.
const GAUSSIAN_OVER_MEDIAN: f64 = 1.482_602_218_505_602;

/// How a zero changes with time.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Shape {
    Constant,
    Line,
    /// A line and a sine of this frequency; Hz.
    Hum(f64),
}

impl Shape {
    fn all() -> impl Iterator<Item = Self> {
        [Self::Line].into_iter().chain(MAINS.map(Self::Hum))
    }

    /// Whether means at these times can show it: a hum needs a period, and five means in it.
    fn shows(self, times: &[f64], span: f64) -> bool {
        let Self::Hum(frequency) = self else {
            return true;
        };
        let interval = || median_of(times.windows(2).map(|t| t[1] - t[0])).unwrap_or(span);
        span * frequency >= PERIODS && interval() * frequency * MEANS_IN_PERIOD <= 1.0
    }

    /// Its functions at a time from the middle of `span`; those it lacks are 0.
    fn row(self, time: f64, middle: f64, span: f64) -> [f64; TERMS] {
        let line = (time - middle) / span;
        match self {
            Self::Constant => [1.0, 0.0, 0.0, 0.0],
            Self::Line => [1.0, line, 0.0, 0.0],
            Self::Hum(frequency) => {
                let (sine, cosine) = (TAU * frequency * (time - middle)).sin_cos();
                [1.0, line, sine, cosine]
            }
        }
    }
}

/// A zero as a function of time.
#[derive(Clone, Copy, Debug)]
struct Zero {
    shape: Shape,
    middle: f64,
    span: f64,
    fit: LinearFit<TERMS>,
}

impl Zero {
    /// Least squares through samples or means; `None` where they do not determine it.
    fn through(shape: Shape, times: &[f64], values: &[f64]) -> Option<Self> {
        let (first, last) = (*times.first()?, *times.last()?);
        let (middle, span) = (0.5 * (first + last), last - first);
        if span <= 0.0 {
            return None;
        }
        let row = |t: f64| shape.row(t, middle, span);
        let fit = match shape {
            Shape::Constant => widened(&linear_fit(times, values, |t| [row(t)[0]])?),
            Shape::Line => widened(&linear_fit(times, values, |t| [row(t)[0], row(t)[1]])?),
            Shape::Hum(_) => linear_fit(times, values, row)?,
        };
        Some(Self {
            shape,
            middle,
            span,
            fit,
        })
    }

    fn at(&self, time: f64) -> f64 {
        let row = self.shape.row(time, self.middle, self.span);
        sum(&row, &self.fit.coefficients)
    }

    /// Standard uncertainty at a time.
    fn sd(&self, time: f64) -> f64 {
        let row = self.shape.row(time, self.middle, self.span);
        let product = self.fit.inverse.map(|own| sum(&own, &row));
        (self.fit.variance * sum(&row, &product).max(0.0)).sqrt()
    }

    fn slope(&self) -> (f64, f64) {
        let fit = &self.fit;
        (
            fit.coefficients[1] / self.span,
            fit.deviations[1] / self.span,
        )
    }

    fn squares(&self, times: &[f64], values: &[f64]) -> f64 {
        let pairs = times.iter().zip(values);
        pairs.map(|(t, v)| (v - self.at(*t)).powi(2)).sum()
    }
}

/// A fit of fewer functions as one of all.
fn widened<const P: usize>(fit: &LinearFit<P>) -> LinearFit<TERMS> {
    let at = |i: usize, values: &[f64; P]| values.get(i).copied().unwrap_or(0.0);
    LinearFit {
        coefficients: std::array::from_fn(|i| at(i, &fit.coefficients)),
        deviations: std::array::from_fn(|i| at(i, &fit.deviations)),
        inverse: std::array::from_fn(|i| {
            std::array::from_fn(|j| fit.inverse.get(i).map_or(0.0, |row| at(j, row)))
        }),
        variance: fit.variance,
        scatter: fit.scatter,
    }
}

/// What is known of a force whose zero is level.
#[derive(Debug, Default)]
pub(crate) struct Levelled {
    /// Standard uncertainty that levelling leaves in the zero during contact; N.
    pub sd: f64,
    /// Its contacts, if they were looked for in the force as it is now.
    pub contacts: Option<Contacts>,
}

/// Subtracts what the zero of a force does beside staying.
///
/// The zero is a constant, a line, or a line and a sine of the mains. The next is taken only
/// where the quiet samples near the contact ask for it decisively, so that a zero that stays
/// is left alone; under [`Baseline::Drift`] the line is always taken.
///
/// * `find`: contacts in a signal with the times of the track
///
/// # Errors
/// Those of `find`, where it finds no contact in the force as it is or less a first guess.
pub(crate) fn level_zero(
    track: &mut Track,
    trigger: &TriggerOptions,
    find: impl Fn(&Track) -> Result<Contacts, Error>,
    findings: &mut Vec<Finding>,
) -> Result<Levelled, Error> {
    if trigger.baseline == Baseline::Keep {
        return Ok(Levelled::default());
    }
    let forced = trigger.baseline == Baseline::Drift;
    let recorded = track.values.clone();
    let mut guess = first_guess(track, forced);
    subtract(track, guess.as_ref());
    let contacts = match (find(track), &guess) {
        (Ok(found), None) => found,
        (Ok(found), Some(_)) if whole(&found.windows) => found,
        (Err(error), None) => return Err(error),
        // The guess took the contact for the zero.
        (_, Some(_)) => {
            guess = None;
            track.values.clone_from(&recorded);
            find(track)?
        }
    };
    let used = match trigger.choice {
        ContactChoice::Within { .. } => contacts.choose(trigger.choice)?,
        choice => contacts.choose(choice).unwrap_or(0),
    };
    let quiet = quiet_samples(track, &contacts.windows, used, forced);
    let (early, late) = (quiet[0].len(), quiet[1].len());
    if forced && (early < LEAST_QUIET || late < LEAST_QUIET) {
        track.values = recorded;
        findings.push(Finding::DriftUnknown {
            channel: track.name.clone(),
            before: early,
            after: late,
        });
        return Ok(Levelled {
            sd: 0.0,
            contacts: guess.is_none().then_some(contacts),
        });
    }
    // The shape is chosen, and told, of the force as it was recorded.
    let window = contacts.windows[used];
    let (times, values) = means(&track.times, &recorded, &quiet);
    let zero = (early >= LEAST_QUIET)
        .then(|| chosen(&times, &values, forced))
        .flatten();
    match zero {
        Some(zero) if zero.shape != Shape::Constant => {
            let (from, until) = (times[0], times[times.len() - 1]);
            track.values = recorded;
            for (time, value) in track.times.iter().zip(&mut track.values) {
                *value -= match &guess {
                    // Far away the first guess follows the zero better.
                    Some(guess) if *time < from => guess.at(*time) + zero.at(from) - guess.at(from),
                    Some(guess) if *time > until => {
                        guess.at(*time) + zero.at(until) - guess.at(until)
                    }
                    _ if forced => zero.at(*time),
                    _ => zero.at(time.clamp(from, until)),
                };
            }
            tell(track, &zero, findings);
            Ok(Levelled {
                sd: zero.sd(0.5 * (window.onset + window.end)),
                contacts: None,
            })
        }
        _ => {
            findings.extend(shift(track, &recorded, &quiet, window.peak));
            track.values = recorded;
            Ok(Levelled {
                sd: 0.0,
                contacts: guess.is_none().then_some(contacts),
            })
        }
    }
}

fn subtract(track: &mut Track, zero: Option<&Zero>) {
    if let Some(zero) = zero {
        for (time, value) in track.times.iter().zip(&mut track.values) {
            *value -= zero.at(*time);
        }
    }
}

fn whole(windows: &[ContactWindow]) -> bool {
    let ends = windows.first().zip(windows.last());
    ends.is_some_and(|(first, last)| first.onset_seen && last.end_seen)
}

/// A zero that changes, as most of the recording shows it; `None` where a constant does, or
/// where the recording begins or ends in contact.
fn first_guess(track: &Track, forced: bool) -> Option<Zero> {
    let n = track.times.len();
    let block = n.div_ceil(BLOCKS).max(1);
    let blocks: Vec<Range<usize>> = (0..n / block).map(|i| i * block..(i + 1) * block).collect();
    let (times, values) = block_means(&track.times, &track.values, &blocks);
    let middle = median(&values)?;
    let constant = median_of(values.iter().map(|v| (v - middle).abs()))?;
    let ends = ((ENDS * values.len() as f64) as usize).max(1);
    let span = times.last()? - times.first()?;
    let mut best: Option<(f64, Zero)> = None;
    for shape in Shape::all() {
        if !shape.shows(&times, span) {
            continue;
        }
        let Some((zero, departure)) = trimmed(shape, &times, &values) else {
            continue;
        };
        let limit = IN_CONTACT * GAUSSIAN_OVER_MEDIAN * departure;
        let quiet = |range: Range<usize>| {
            let far = range
                .clone()
                .filter(|&i| (values[i] - zero.at(times[i])).abs() > limit);
            2 * far.count() <= range.len()
        };
        let rests = quiet(0..ends) && quiet(values.len() - ends..values.len());
        let before = best.as_ref().map_or(constant, |own| own.0);
        let wanted = forced && shape == Shape::Line;
        if rests && (wanted || departure < GUESS_GAIN * before) {
            best = Some((departure, zero));
        }
    }
    best.map(|own| own.1)
}

/// A shape through most of the values, those left out that depart most; and the median
/// departure.
fn trimmed(shape: Shape, times: &[f64], values: &[f64]) -> Option<(Zero, f64)> {
    let mut kept: Vec<usize> = (0..values.len()).collect();
    let mut found = None;
    for _ in 0..12 {
        let part = |all: &[f64]| kept.iter().map(|&i| all[i]).collect::<Vec<f64>>();
        let zero = Zero::through(shape, &part(times), &part(values))?;
        let pairs = times.iter().zip(values);
        let far: Vec<f64> = pairs.map(|(t, v)| (v - zero.at(*t)).abs()).collect();
        let middle = median(&far)?;
        let limit = 3.0 * GAUSSIAN_OVER_MEDIAN * middle;
        let now: Vec<usize> = (0..values.len()).filter(|&i| far[i] <= limit).collect();
        found = Some((zero, middle));
        if now == kept || now.len() <= TERMS {
            break;
        }
        kept = now;
    }
    found
}

/// Samples near the used contact, before and after it, that belong to no contact. All
/// around all contacts, if `forced`.
fn quiet_samples(
    track: &Track,
    windows: &[ContactWindow],
    used: usize,
    forced: bool,
) -> [Range<usize>; 2] {
    let (first, last) = if forced {
        (windows[0], windows[windows.len() - 1])
    } else {
        (windows[used], windows[used])
    };
    let guard = |window: &ContactWindow| GUARD * (window.end - window.onset);
    let near = if forced {
        f64::INFINITY
    } else {
        (NEAR.0 * (first.end - first.onset)).max(NEAR.1)
    };
    let before = used.checked_sub(1).filter(|_| !forced).map(|i| &windows[i]);
    let after = windows.get(used + 1).filter(|_| !forced);
    let from = before.map_or(f64::NEG_INFINITY, |own| own.end + guard(own));
    let until = after.map_or(f64::INFINITY, |own| own.onset - guard(own));
    let at = |time: f64| track.times.partition_point(|t| *t < time);
    let ends = (first.onset - guard(&first), last.end + guard(&last));
    let early = at(from.max(first.onset - near)).min(at(ends.0))..at(ends.0);
    let late = at(ends.1)..at(until.min(last.end + near)).max(at(ends.1));
    [early, late]
}

/// Means over blocks of the quiet samples of both sides.
fn means(times: &[f64], values: &[f64], quiet: &[Range<usize>; 2]) -> (Vec<f64>, Vec<f64>) {
    let longest = quiet[0].len().max(quiet[1].len());
    let block = longest.div_ceil(SIDE_BLOCKS).max(1);
    let split = |side: &Range<usize>| {
        let blocks = side.len() / block;
        let start = side.end - blocks * block;
        (0..blocks).map(move |i| start + i * block..start + (i + 1) * block)
    };
    let blocks: Vec<Range<usize>> = quiet.iter().flat_map(split).collect();
    block_means(times, values, &blocks)
}

fn block_means(times: &[f64], values: &[f64], blocks: &[Range<usize>]) -> (Vec<f64>, Vec<f64>) {
    let mean = |all: &[f64], block: &Range<usize>| {
        // About the first, which large times would blur.
        let first = all[block.start];
        let rest = all[block.clone()].iter().map(|v| v - first);
        first + rest.sum::<f64>() / block.len() as f64
    };
    let of = |all| blocks.iter().map(|block| mean(all, block)).collect();
    (of(times), of(values))
}

/// The simplest shape that the means do not contradict decisively.
fn chosen(times: &[f64], values: &[f64], forced: bool) -> Option<Zero> {
    let span = times.last()? - times.first()?;
    let mut best = Zero::through(Shape::Constant, times, values)?;
    for shape in Shape::all() {
        if !shape.shows(times, span) {
            continue;
        }
        let Some(zero) = Zero::through(shape, times, values) else {
            continue;
        };
        let freedom = times.len() as f64 - TERMS as f64;
        let (simple, own) = (best.squares(times, values), zero.squares(times, values));
        let terms = if shape == Shape::Line { 1.0 } else { 2.0 };
        // Of two frequencies the better.
        let other = matches!((best.shape, shape), (Shape::Hum(_), Shape::Hum(_)));
        let better = if other {
            own < simple
        } else {
            freedom > 0.0 && (simple - own) / terms > DECISIVE * own / freedom
        };
        let wanted = forced && shape == Shape::Line;
        if wanted || (better && !is_step(&zero, times, values)) {
            best = zero;
        }
    }
    Some(best)
}

/// Whether two levels, before and after the widest gap, fit better than a line.
fn is_step(zero: &Zero, times: &[f64], values: &[f64]) -> bool {
    if zero.shape != Shape::Line {
        return false;
    }
    let gap = |i: &usize| times[*i] - times[*i - 1];
    let Some(split) = (1..times.len()).max_by(|a, b| gap(a).total_cmp(&gap(b))) else {
        return false;
    };
    let level = |part: Range<usize>| {
        let mean = values[part.clone()].iter().sum::<f64>() / part.len() as f64;
        values[part].iter().map(|v| (v - mean).powi(2)).sum::<f64>()
    };
    level(0..split) + level(split..values.len()) < zero.squares(times, values)
}

fn tell(track: &Track, zero: &Zero, findings: &mut Vec<Finding>) {
    let (slope, slope_sd) = zero.slope();
    if zero.shape == Shape::Line || slope.abs() > DECISIVE.sqrt() * slope_sd {
        findings.push(Finding::DriftRemoved {
            channel: track.name.clone(),
            slope,
            slope_sd,
        });
    }
    if let Shape::Hum(frequency) = zero.shape {
        let [.., sine, cosine] = zero.fit.coefficients;
        findings.push(Finding::HumRemoved {
            channel: track.name.clone(),
            frequency,
            amplitude: sine.hypot(cosine),
            sd: zero.fit.deviations[2].max(zero.fit.deviations[3]),
        });
    }
}

/// A zero that is another after contact than before.
fn shift(track: &Track, values: &[f64], quiet: &[Range<usize>; 2], peak: f64) -> Option<Finding> {
    let side = |range: &Range<usize>| {
        let (times, values) = means(&track.times, values, &[range.clone(), 0..0]);
        Zero::through(Shape::Constant, &times, &values)
    };
    let (before, after) = (side(&quiet[0])?, side(&quiet[1])?);
    let change = after.fit.coefficients[0] - before.fit.coefficients[0];
    let sd = after.fit.deviations[0].hypot(before.fit.deviations[0]);
    (change.abs() > (SHIFT * peak).max(DECISIVE.sqrt() * sd)).then(|| Finding::ZeroShift {
        channel: track.name.clone(),
        change,
        sd,
        share: change.abs() / peak,
    })
}
