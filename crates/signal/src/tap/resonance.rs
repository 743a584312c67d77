//! Resonances of one tap: peaks of its spectrum, each refined by a fit.

use crate::error::Error;
use crate::tap::damped_mode::{Mode, ModeStart, Transformed, fit_modes, mode_samples};
use crate::tap::spectrum::{
    Offset, Spectrum, SpectrumOptions, Window, periodogram, transform, welch,
};
use crate::tap::spectrum_peak::{parabolic_offset, peaks};
use std::f64::consts::PI;

/// Which peaks count.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ResonanceOptions {
    /// Lowest frequency; Hz.
    pub low: f64,
    /// Highest frequency; Hz.
    pub high: f64,
    /// Height of a peak, above those that are fitted already, as a part of the
    /// highest in the band, at least, in amplitude; 1.
    pub least_prominence: f64,
    /// Most peaks that are fitted; the highest.
    pub most: usize,
}

impl Default for ResonanceOptions {
    fn default() -> Self {
        Self {
            low: 150.0,
            high: 2500.0,
            least_prominence: 0.1,
            most: 6,
        }
    }
}

/// A resonance in one tap.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Resonance {
    /// The fitted mode.
    #[serde(flatten)]
    pub mode: Mode,
    /// Height of its peak as a part of the highest in the band, in amplitude.
    pub level: f64,
    /// Power of its peak over that of the noise at its frequency.
    pub over_noise: f64,
    /// Whether the quiet before the first tap has a peak there too.
    pub in_quiet: bool,
}

/// Length of the window in which peaks are found; s. Longer ones would show
/// more noise and no more of the fruit.
const FOUND_WITHIN: f64 = 0.06;
/// Least number of frequencies in a width of the peak of that window.
const PADDING: usize = 4;
/// Power of a peak over the mean power of the noise, at least: white noise alone
/// exceeds it at one frequency in 10⁸.
const OVER_NOISE: f64 = 18.0;
/// Segments of the quiet before the first tap; s.
const QUIET_SEGMENT: f64 = 0.05;
/// Power of a line over the middle of the quiet's spectrum from which it counts.
const LINE: f64 = 8.0;

/// Spectrum of a tap from the end of the hit on: power density of its first
/// 60 ms with the falling half of a Hann window, filled up with zeros.
///
/// A tap is strongest at its begin, where a whole Hann window would hide it.
///
/// # Errors
/// No sample, or a bad interval.
pub fn tap_spectrum(ringing: &[f64], interval: f64) -> Result<Spectrum, Error> {
    let count = ((FOUND_WITHIN / interval).round() as usize).min(ringing.len());
    let fall = |i: usize| {
        (0.5 * PI * (i as f64 + 0.5) / count.max(1) as f64)
            .cos()
            .powi(2)
    };
    let weights: Vec<f64> = (0..count).map(fall).collect();
    let weighted: Vec<f64> = ringing.iter().zip(&weights).map(|(x, w)| x * w).collect();
    let options = SpectrumOptions {
        window: Window::Rectangular,
        offset: Offset::Keep,
        length: Some((PADDING * count).next_power_of_two()),
        ..SpectrumOptions::default()
    };
    let mut spectrum = periodogram(&weighted, interval, &options)?;
    let squares: f64 = weights.iter().map(|w| w * w).sum();
    for power in &mut spectrum.power {
        *power *= count as f64 / squares;
    }
    Ok(spectrum)
}

/// Spectrum of the quiet before the first tap.
///
/// # Errors
/// No sample, or a bad interval.
pub fn quiet_spectrum(quiet: &[f64], interval: f64) -> Result<Spectrum, Error> {
    let segment = ((QUIET_SEGMENT / interval).round() as usize).min(quiet.len());
    welch(
        quiet,
        interval,
        segment,
        segment / 2,
        &SpectrumOptions::default(),
    )
}

/// Resonances of a tap, in order of frequency.
///
/// * `ringing`: samples from the end of the hit on
/// * `interval`: sampling interval; s
/// * `quiet`: spectrum of what was there before the first tap, where known
///
/// # Numerics
/// The highest peak is fitted and subtracted, then the highest of what is left,
/// with all modes fitted again, until nothing stands out: noise on a broad peak
/// makes no second one, and two modes in one peak come apart.
///
/// # Errors
/// No sample, or a bad interval.
pub fn resonances(
    ringing: &[f64],
    interval: f64,
    quiet: Option<&Spectrum>,
    options: &ResonanceOptions,
) -> Result<Vec<Resonance>, Error> {
    let mean = ringing.iter().sum::<f64>() / ringing.len() as f64;
    let centred: Vec<f64> = ringing.iter().map(|x| x - mean).collect();
    let values = transform(&centred, ringing.len());
    let transformed = Transformed {
        values: &values,
        samples: ringing.len(),
        interval,
    };
    let mut rest = centred.clone();
    let mut found: Vec<(Mode, f64)> = Vec::new();
    let mut starts: Vec<ModeStart> = Vec::new();
    let mut without: Vec<ModeStart> = Vec::new();
    let mut highest = 0.0;
    while found.len() < options.most && without.len() < options.most {
        let spectrum = tap_spectrum(&rest, interval)?;
        let peak = highest_peak(&spectrum, quiet, &without, options);
        let Some((start, power, over_noise)) = peak else {
            break;
        };
        highest = f64::max(highest, power);
        let least = options.least_prominence * options.least_prominence * highest;
        if power < least {
            break;
        }
        let place = starts.partition_point(|other| other.frequency < start.frequency);
        let mut more = starts.clone();
        more.insert(place, start);
        let modes = fit_modes(&transformed, &more);
        if !modes.iter().all(|mode| mode.converged) {
            without.push(start);
            continue;
        }
        starts = more;
        rest.clone_from(&centred);
        for mode in &modes {
            let all = mode_samples(mode, interval, rest.len());
            rest.iter_mut().zip(all).for_each(|(left, x)| *left -= x);
        }
        found.insert(place, (modes[place], over_noise));
        for (known, mode) in found.iter_mut().zip(&modes) {
            known.0 = *mode;
        }
    }
    found.sort_by(|a, b| a.0.frequency.total_cmp(&b.0.frequency));
    let line = |mode: &Mode| mode.amplitude * mode.quality / mode.frequency;
    let strongest = found.iter().map(|(mode, _)| line(mode)).fold(0.0, f64::max);
    let resonance = |(mode, over_noise): (Mode, f64)| Resonance {
        mode,
        level: line(&mode) / strongest,
        over_noise,
        in_quiet: quiet.is_some_and(|quiet| has_line(quiet, mode.frequency, options)),
    };
    Ok(found.into_iter().map(resonance).collect())
}

/// The highest peak in the band that stands out of the noise (hum does not, as
/// the quiet has it too) and is none of `without`: start of a fit, power density,
/// power over noise.
fn highest_peak(
    spectrum: &Spectrum,
    quiet: Option<&Spectrum>,
    without: &[ModeStart],
    options: &ResonanceOptions,
) -> Option<(ModeStart, f64, f64)> {
    let first = spectrum.nearest(options.low);
    let band = &spectrum.power[first..=spectrum.nearest(options.high).max(first)];
    let everywhere = median(&spectrum.power) / std::f64::consts::LN_2;
    let measured = peaks(band).into_iter().map(|peak| {
        let at = peak.index as f64 + parabolic_offset(band, peak.index);
        let frequency = (first as f64 + at) * spectrum.step;
        let noise = quiet.map_or(everywhere, |quiet| {
            // A line's place is known to a frequency of the quiet's spectrum.
            let at = quiet.nearest(frequency);
            let near = at.saturating_sub(1)..(at + 2).min(quiet.power.len());
            quiet.power[near].iter().fold(0.0, |a: f64, b| a.max(*b))
        });
        let start = ModeStart {
            frequency,
            width: peak.width * spectrum.step,
        };
        (
            start,
            peak.height,
            peak.height / noise.max(f64::MIN_POSITIVE),
        )
    });
    let known = |start: &ModeStart| {
        let near = |other: &ModeStart| (other.frequency - start.frequency).abs() < other.width;
        without.iter().any(near)
    };
    let standing_out =
        measured.filter(|(start, _, over_noise)| *over_noise >= OVER_NOISE && !known(start));
    standing_out.max_by(|a, b| a.1.total_cmp(&b.1))
}

/// Whether the spectrum of the quiet has a line at a frequency.
fn has_line(quiet: &Spectrum, frequency: f64, options: &ResonanceOptions) -> bool {
    let (first, last) = (quiet.nearest(options.low), quiet.nearest(options.high));
    let middle = median(&quiet.power[first..=last]);
    let at = quiet.nearest(frequency);
    let near = at.saturating_sub(1)..(at + 2).min(quiet.power.len());
    let highest = quiet.power[near].iter().fold(0.0, |a: f64, b| a.max(*b));
    middle > 0.0 && highest > LINE * middle
}

fn median(values: &[f64]) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    sorted.get(sorted.len() / 2).copied().unwrap_or(0.0)
}
