//! Which of the resonances in the taps of one fruit is its first spheroidal
//! mode, 0S2.

use crate::tap::resonance::Resonance;
use crate::uncertain::{Uncertain, mean_of_differing};

/// Rules by which the first spheroidal mode is accepted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FirstModeOptions {
    /// Quality that a mode of a fruit has at least; 1.
    pub least_quality: f64,
    /// Frequencies of two taps belong to one mode when they differ by less, as a
    /// part of the frequency; 1.
    pub agreement: f64,
    /// Part of the taps that must show a mode; 1.
    pub least_share: f64,
    /// A second peak up to this part above the first belongs to the same mode,
    /// split by the shape of the fruit; 1.
    pub doublet: f64,
}

impl Default for FirstModeOptions {
    fn default() -> Self {
        Self {
            least_quality: 4.0,
            agreement: 0.02,
            least_share: 0.6,
            doublet: 0.12,
        }
    }
}

/// What one tap shows.
#[derive(Clone, Debug, PartialEq)]
pub struct TapModes {
    /// Where the fruit was hit, where several places are told apart.
    pub orientation: String,
    /// Resonances.
    pub resonances: Vec<Resonance>,
}

/// Why a persistent resonance is not the first mode.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rejection {
    /// Too few taps show it.
    Inconstant,
    /// Its quality is too low: the hit, a rigid body on its support, or a fruit
    /// too soft to ring.
    Broad,
    /// The quiet before the taps has it too.
    InQuiet,
    /// All fruit have it at one frequency.
    Shared,
    /// A weak peak just below a strong one: torsional.
    Torsional,
    /// A higher mode.
    Higher,
}

impl Rejection {
    /// What a reader is told.
    pub fn reason(self) -> &'static str {
        match self {
            Self::Inconstant => "too few taps show it",
            Self::Broad => "its quality is too low for a mode of the fruit",
            Self::InQuiet => "the quiet before the taps shows it too: hum, support or microphone",
            Self::Shared => "all fruit show it at the same frequency: support or microphone",
            Self::Torsional => "a weak peak 3 to 8 % below a strong one: torsional mode",
            Self::Higher => "a higher mode",
        }
    }
}

/// A resonance as several taps show it.
#[derive(Clone, Debug, PartialEq)]
pub struct Persistent {
    /// Frequency, with the spread between taps; Hz.
    pub frequency: Uncertain,
    /// Mean quality.
    pub quality: f64,
    /// Mean height as a part of the highest peak; 1.
    pub level: f64,
    /// Taps that show it.
    pub taps: usize,
    /// Orientations in which it is seen.
    pub orientations: usize,
    /// Part of its taps whose quiet shows it too.
    pub in_quiet: f64,
}

/// How sure the first mode is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Confidence {
    /// No first mode was accepted.
    None,
    /// One tap, or a strong reason for doubt.
    Low,
    /// Some doubt.
    Medium,
    /// Three taps or more agree, and nothing speaks against it.
    High,
}

impl Confidence {
    /// The word in tables.
    pub fn word(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::Low => "low",
            Self::Medium => "medium",
            Self::High => "high",
        }
    }
}

/// The accepted mode of a fruit.
#[derive(Clone, Debug, PartialEq)]
pub struct FirstMode {
    /// Frequency; Hz. Of a doublet the mean of both.
    pub frequency: Uncertain,
    /// Quality.
    pub quality: f64,
    /// Taps that show it.
    pub taps: usize,
    /// The two frequencies of a doublet; Hz.
    pub doublet: Option<(f64, f64)>,
    /// Height as a part of the highest peak; 1.
    pub level: f64,
}

/// What was decided on a fruit.
#[derive(Clone, Debug, PartialEq)]
pub struct Decision {
    /// The first mode, where one is accepted.
    pub accepted: Option<FirstMode>,
    /// How sure it is.
    pub confidence: Confidence,
    /// What is there besides, in order of frequency, with why it is not the mode.
    pub rejected: Vec<(Persistent, Rejection)>,
}

/// A first mode weaker than this part of the highest peak is in doubt.
const FAINT: f64 = 0.2;
/// Height of the second peak of a doublet, as a part of the first, at least.
const DOUBLET_LEVEL: f64 = 0.25;
/// Height of a torsional peak, as a part of the spheroidal, at most: it moves no
/// air and shows only by the unevenness of the fruit.
const TORSIONAL_LEVEL: f64 = 0.25;
/// Frequency of 0T2 over that of 0S2. In homogeneous spheres 0.947 at a Poisson's
/// ratio of 0.25 and 0.938 at 0.5 (Lamb 1882, Proc. London Math. Soc. 13:189).
const TORSIONAL: std::ops::Range<f64> = 0.92..0.97;
/// Spread between taps from which the confidence is not high; 1.
const SPREAD: f64 = 0.01;

/// Resonances that the taps of a fruit share, in order of frequency.
pub fn persistent(taps: &[TapModes], agreement: f64) -> Vec<Persistent> {
    let mut all: Vec<(usize, &Resonance)> = Vec::new();
    for (tap, modes) in taps.iter().enumerate() {
        let usable = modes.resonances.iter().filter(|r| r.mode.converged);
        all.extend(usable.map(|resonance| (tap, resonance)));
    }
    all.sort_by(|a, b| a.1.mode.frequency.total_cmp(&b.1.mode.frequency));
    // A group ends where the next frequency is far from its first, or its tap is
    // in the group already.
    let mut groups: Vec<Vec<(usize, &Resonance)>> = Vec::new();
    for (tap, resonance) in all {
        let frequency = resonance.mode.frequency;
        match groups.last_mut() {
            Some(group)
                if frequency <= group[0].1.mode.frequency * (1.0 + 2.0 * agreement)
                    && frequency <= group[group.len() - 1].1.mode.frequency * (1.0 + agreement)
                    && group.iter().all(|(other, _)| *other != tap) =>
            {
                group.push((tap, resonance));
            }
            _ => groups.push(vec![(tap, resonance)]),
        }
    }
    groups
        .iter()
        .filter_map(|group| summary(group, taps))
        .collect()
}

fn summary(group: &[(usize, &Resonance)], taps: &[TapModes]) -> Option<Persistent> {
    let n = group.len() as f64;
    let frequencies: Vec<Uncertain> = group
        .iter()
        .map(|(_, resonance)| Uncertain::new(resonance.mode.frequency, resonance.mode.frequency_sd))
        .collect();
    let mean = |of: &dyn Fn(&Resonance) -> f64| group.iter().map(|(_, r)| of(r)).sum::<f64>() / n;
    let mut orientations: Vec<&str> = group
        .iter()
        .map(|(tap, _)| taps[*tap].orientation.as_str())
        .collect();
    orientations.sort_unstable();
    orientations.dedup();
    Some(Persistent {
        frequency: mean_of_differing(&frequencies)?,
        quality: mean(&|r| r.mode.quality),
        level: mean(&|r| r.level),
        taps: group.len(),
        orientations: orientations.len(),
        in_quiet: mean(&|r| f64::from(u8::from(r.in_quiet))),
    })
}

/// Decides which resonance is the first spheroidal mode: the lowest that lasts
/// over taps, rings, and belongs to this fruit alone.
///
/// * `found`: from [`persistent`]
/// * `taps`: taps evaluated; `orientations`: places of the fruit that were hit
/// * `shared`: frequencies that all fruit show; Hz
pub fn first_mode(
    found: &[Persistent],
    taps: usize,
    orientations: usize,
    shared: &[f64],
    options: &FirstModeOptions,
) -> Decision {
    let mut rejected = Vec::new();
    let mut candidates: Vec<&Persistent> = Vec::new();
    for mode in found {
        match unfit(mode, taps, shared, options) {
            Some(reason) => rejected.push((mode.clone(), reason)),
            None => candidates.push(mode),
        }
    }
    // A weak peak just below a strong one.
    if let [first, second, ..] = candidates[..]
        && first.level < TORSIONAL_LEVEL * second.level
        && TORSIONAL.contains(&(first.frequency.value / second.frequency.value))
    {
        rejected.push((first.clone(), Rejection::Torsional));
        candidates.remove(0);
    }
    let Some(&first) = candidates.first() else {
        return Decision {
            accepted: None,
            confidence: Confidence::None,
            rejected,
        };
    };
    let partner = candidates.get(1).copied().filter(|second| {
        second.frequency.value <= first.frequency.value * (1.0 + options.doublet)
            && second.level >= DOUBLET_LEVEL * first.level
    });
    let higher = &candidates[1 + usize::from(partner.is_some())..];
    rejected.extend(
        higher
            .iter()
            .map(|mode| ((*mode).clone(), Rejection::Higher)),
    );
    rejected.sort_by(|a, b| a.0.frequency.value.total_cmp(&b.0.frequency.value));
    let accepted = accepted(first, partner);
    Decision {
        confidence: confidence(&accepted, first, taps, orientations),
        accepted: Some(accepted),
        rejected,
    }
}

/// Why a resonance cannot be a mode of this fruit.
fn unfit(
    mode: &Persistent,
    taps: usize,
    shared: &[f64],
    options: &FirstModeOptions,
) -> Option<Rejection> {
    let frequency = mode.frequency.value;
    let is_shared = |other: &f64| (frequency / other - 1.0).abs() < 0.5 * options.agreement;
    if (mode.taps as f64) < options.least_share * taps as f64 {
        Some(Rejection::Inconstant)
    } else if mode.quality < options.least_quality {
        Some(Rejection::Broad)
    } else if mode.in_quiet > 0.5 {
        Some(Rejection::InQuiet)
    } else if shared.iter().any(is_shared) {
        Some(Rejection::Shared)
    } else {
        None
    }
}

/// A doublet's frequency is the mean of both, uncertain by a rectangular
/// distribution between them: which part of the split mode a tap excites is
/// chance.
fn accepted(first: &Persistent, partner: Option<&Persistent>) -> FirstMode {
    let Some(second) = partner else {
        return FirstMode {
            frequency: first.frequency,
            quality: first.quality,
            taps: first.taps,
            doublet: None,
            level: first.level,
        };
    };
    let (a, b) = (first.frequency, second.frequency);
    let half = 0.5 * (b.value - a.value);
    FirstMode {
        frequency: Uncertain::new(
            0.5 * (a.value + b.value),
            (0.5 * a.sd.hypot(b.sd)).hypot(half / 3.0_f64.sqrt()),
        ),
        quality: 0.5 * (first.quality + second.quality),
        taps: first.taps.min(second.taps),
        doublet: Some((a.value, b.value)),
        level: first.level.max(second.level),
    }
}

fn confidence(
    mode: &FirstMode,
    first: &Persistent,
    taps: usize,
    orientations: usize,
) -> Confidence {
    let doubts = [
        mode.taps < 3,
        mode.taps < taps,
        mode.doublet.is_some(),
        orientations > 1 && first.orientations < orientations,
        mode.frequency.sd > SPREAD * mode.frequency.value,
    ];
    let doubts = doubts.iter().filter(|doubt| **doubt).count();
    match doubts {
        _ if mode.taps < 2 || mode.level < FAINT => Confidence::Low,
        0 => Confidence::High,
        1 | 2 => Confidence::Medium,
        _ => Confidence::Low,
    }
}

/// Frequencies that nearly all fruit show alike, which fruit of different mass
/// and ripeness do not: those of support or microphone; Hz.
///
/// Empty for fewer than four fruit.
pub fn shared_frequencies(fruit: &[Vec<Persistent>], agreement: f64) -> Vec<f64> {
    if fruit.len() < FEWEST_FRUIT {
        return Vec::new();
    }
    let near = |a: f64, b: f64| (a / b - 1.0).abs() < 0.25 * agreement;
    let mut shared: Vec<f64> = Vec::new();
    for mode in fruit.iter().flatten() {
        let f = mode.frequency.value;
        let shows = |modes: &&Vec<Persistent>| modes.iter().any(|m| near(m.frequency.value, f));
        let share = fruit.iter().filter(shows).count() as f64 / fruit.len() as f64;
        if share >= SHARED_BY && !shared.iter().any(|known| near(*known, f)) {
            shared.push(f);
        }
    }
    shared
}

/// Fruit from which a common frequency can be no chance.
const FEWEST_FRUIT: usize = 4;
/// Part of the fruit that shows a common frequency.
const SHARED_BY: f64 = 0.8;
