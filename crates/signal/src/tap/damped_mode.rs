//! Damped sinusoids in noise: frequency, decay and amplitude with standard
//! errors, from the complex spectrum near each of them.

use realfft::num_complex::Complex;
use std::f64::consts::{PI, TAU};
use windfall_numerics::cholesky::inverse;
use windfall_numerics::least_squares::{
    Bounds, LeastSquares, NormalEquations, Options, Stop, minimise,
};

/// A damped sinusoid
///
/// ```text
/// x(t) = amplitude · exp(−π f t / Q) · cos(2π f t − phase)
/// ```
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Mode {
    /// Frequency of the oscillation, f; Hz.
    pub frequency: f64,
    /// Its standard error; Hz.
    #[serde(deserialize_with = "number_or_infinity")]
    pub frequency_sd: f64,
    /// Quality Q; the width at half power is f/Q.
    pub quality: f64,
    /// Its standard error.
    #[serde(deserialize_with = "number_or_infinity")]
    pub quality_sd: f64,
    /// Amplitude at the first sample; unit of the samples.
    pub amplitude: f64,
    /// Its standard error.
    #[serde(deserialize_with = "number_or_infinity")]
    pub amplitude_sd: f64,
    /// Phase at the first sample; rad.
    pub phase: f64,
    /// Whether a minimum was reached, away from the bounds.
    pub converged: bool,
}

/// A standard error that is not known is `null` in JSON, which has no infinity.
fn number_or_infinity<'de, D: serde::Deserializer<'de>>(deserializer: D) -> Result<f64, D::Error> {
    let number = serde::Deserialize::deserialize(deserializer);
    number.map(|number: Option<f64>| number.unwrap_or(f64::INFINITY))
}

/// Samples of a mode from the first on.
///
/// * `interval`: sampling interval; s
pub fn mode_samples(mode: &Mode, interval: f64, count: usize) -> impl Iterator<Item = f64> {
    let (f, decay) = (mode.frequency, PI * mode.frequency / mode.quality);
    let (amplitude, phase) = (mode.amplitude, mode.phase);
    (0..count).map(move |i| {
        let t = i as f64 * interval;
        amplitude * (-decay * t).exp() * (TAU * f * t - phase).cos()
    })
}

/// Where a mode is looked for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ModeStart {
    /// Frequency; Hz.
    pub frequency: f64,
    /// Width of its peak at half power; Hz.
    pub width: f64,
}

/// The transform of a stretch of samples.
pub(crate) struct Transformed<'a> {
    /// Frequencies from 0 to half the sampling rate, without filling by zeros.
    pub values: &'a [Complex<f64>],
    /// Samples that were transformed.
    pub samples: usize,
    /// Sampling interval; s.
    pub interval: f64,
}

/// Half of the fitted band, in widths of the mode; holds 92 % of its energy.
const HALF_BAND_WIDTHS: f64 = 4.0;
/// Half of the fitted band at least, in frequencies of the transform.
const HALF_BAND_BINS: f64 = 8.0;
/// A peak's frequency moves by at most this many of its widths.
const FREQUENCY_RANGE: f64 = 1.5;
/// The decay is looked for within this factor of the peak's width.
const DECAY_RANGE: f64 = 30.0;
/// Rounds in which each mode is fitted with the others subtracted.
const MOST_ROUNDS: usize = 40;
/// The rounds end when no frequency moves by more than this part of its error.
const SETTLED: f64 = 1e-3;
/// Modes closer than this many mean widths are fitted together, in pairs.
const NEIGHBOURS: f64 = 3.0;

/// Parameters of a mode: phase step and decay per sample, cosine and sine.
type Parameters = [f64; 4];

/// Fits modes to a transform, each near its start.
///
/// # Numerics
/// Least squares in the frequency domain, where white noise is independent and
/// alike at all frequencies. The model is the exact transform of a damped
/// sinusoid cut off at the end of the samples, so that no window is needed and
/// leakage biases nothing. Each mode, or pair of close ones, is fitted in a band
/// around it with the others subtracted, in rounds until nothing moves; standard
/// errors are those of the mode or pair, with the variance of the residuals in
/// the band.
pub(crate) fn fit_modes(transformed: &Transformed, starts: &[ModeStart]) -> Vec<Mode> {
    let mut found: Vec<Parameters> = starts
        .iter()
        .map(|start| {
            let decay = PI * start.width * transformed.interval;
            [
                TAU * start.frequency * transformed.interval,
                decay,
                0.0,
                0.0,
            ]
        })
        .collect();
    let mut modes: Vec<Option<Mode>> = vec![None; starts.len()];
    for _ in 0..MOST_ROUNDS {
        let before = modes.clone();
        let mut first = 0;
        while first < starts.len() {
            let pair = first + 1 < starts.len() && are_close(&starts[first], &starts[first + 1]);
            match pair {
                true => fit_block::<8>(transformed, starts, first, &mut found, &mut modes),
                false => fit_block::<4>(transformed, starts, first, &mut found, &mut modes),
            }
            first += 1 + usize::from(pair);
        }
        let settled = |(now, before): (&Option<Mode>, &Option<Mode>)| match (now, before) {
            (Some(now), Some(before)) => {
                (now.frequency - before.frequency).abs() <= SETTLED * now.frequency_sd
            }
            _ => false,
        };
        if modes.iter().zip(&before).all(settled) {
            break;
        }
    }
    modes.into_iter().flatten().collect()
}

fn are_close(a: &ModeStart, b: &ModeStart) -> bool {
    (b.frequency - a.frequency).abs() <= NEIGHBOURS * 0.5 * (a.width + b.width)
}

/// Fits the P / 4 modes from `first` on, with the others subtracted.
fn fit_block<const P: usize>(
    transformed: &Transformed,
    starts: &[ModeStart],
    first: usize,
    found: &mut [Parameters],
    modes: &mut [Option<Mode>],
) {
    let range = first..first + P / 4;
    let block = &starts[range.clone()];
    let band = band(transformed, block);
    let rest = residual_values(transformed, found, range.clone(), band);
    let mut start = [0.0; P];
    for (place, mode) in start.chunks_exact_mut(4).zip(&found[range.clone()]) {
        place.copy_from_slice(mode);
    }
    let fit = fit_band(transformed, &rest, band, &start, block);
    for (number, index) in range.enumerate() {
        found[index].copy_from_slice(&fit.parameters[4 * number..4 * number + 4]);
        modes[index] = Some(mode_of(&fit, number, transformed.interval));
    }
}

/// The transform in a band without the modes, but for some of them.
fn residual_values(
    transformed: &Transformed,
    modes: &[Parameters],
    kept: std::ops::Range<usize>,
    band: (usize, usize),
) -> Vec<Complex<f64>> {
    let mut rest = transformed.values[band.0..=band.1].to_vec();
    for (index, mode) in modes.iter().enumerate() {
        if kept.contains(&index) || (mode[2], mode[3]) == (0.0, 0.0) {
            continue;
        }
        for (k, value) in (band.0..).zip(rest.iter_mut()) {
            *value -= transform_of(mode, k, transformed.samples).value;
        }
    }
    rest
}

/// First and last frequency of the band around starts, without 0 and half the
/// sampling rate.
fn band(transformed: &Transformed, starts: &[ModeStart]) -> (usize, usize) {
    let step = 1.0 / (transformed.samples as f64 * transformed.interval);
    let half = |start: &ModeStart| (HALF_BAND_WIDTHS * start.width).max(HALF_BAND_BINS * step);
    let low = starts.iter().map(|s| s.frequency - half(s));
    let high = starts.iter().map(|s| s.frequency + half(s));
    let low = low.fold(f64::INFINITY, f64::min) / step;
    let high = high.fold(0.0, f64::max) / step;
    let last = transformed.values.len().saturating_sub(2).max(1);
    (
        (low.max(1.0).round() as usize).min(last),
        (high.round() as usize).min(last),
    )
}

struct BandFit<const P: usize> {
    parameters: [f64; P],
    covariance: Option<[[f64; P]; P]>,
    converged: bool,
}

struct BandProblem<'a> {
    values: &'a [Complex<f64>],
    first: usize,
    samples: usize,
}

impl<const P: usize> LeastSquares<P> for BandProblem<'_> {
    fn evaluate(&mut self, parameters: &[f64; P]) -> Option<NormalEquations<P>> {
        let mut equations = NormalEquations::ZERO;
        for (k, value) in (self.first..).zip(self.values) {
            let mut residual = -value;
            let mut slopes = [Complex::new(0.0, 0.0); P];
            for (mode, slopes) in parameters.chunks_exact(4).zip(slopes.chunks_exact_mut(4)) {
                let point = transform_of(mode, k, self.samples);
                residual += point.value;
                slopes.copy_from_slice(&point.slopes);
            }
            equations.add(1.0, residual.re, &slopes.map(|slope| slope.re));
            equations.add(1.0, residual.im, &slopes.map(|slope| slope.im));
        }
        Some(equations)
    }
}

fn fit_band<const P: usize>(
    transformed: &Transformed,
    values: &[Complex<f64>],
    band: (usize, usize),
    start: &[f64; P],
    starts: &[ModeStart],
) -> BandFit<P> {
    let interval = transformed.interval;
    let mut bounds = Bounds::<P>::NONE;
    for (mode, peak) in starts.iter().enumerate() {
        let reach = FREQUENCY_RANGE * peak.width;
        bounds.lower[4 * mode] = TAU * interval * (peak.frequency - reach).max(0.0);
        bounds.upper[4 * mode] = (TAU * interval * (peak.frequency + reach)).min(PI);
        bounds.lower[4 * mode + 1] = PI * interval * peak.width / DECAY_RANGE;
        bounds.upper[4 * mode + 1] = PI * interval * peak.width * DECAY_RANGE;
    }
    let mut problem = BandProblem {
        values,
        first: band.0,
        samples: transformed.samples,
    };
    let minimum = minimise(&mut problem, start, &bounds, &Options::default());
    let numbers = 2 * (band.1 + 1 - band.0.min(band.1));
    let covariance = inverse(&minimum.equations.normal)
        .filter(|_| numbers > P)
        .map(|inverse| {
            let variance = minimum.equations.cost / (numbers - P) as f64;
            inverse.map(|row| row.map(|entry| entry * variance))
        });
    BandFit {
        parameters: minimum.parameters,
        converged: minimum.stop == Stop::Converged
            && minimum.at_bound == [0; P]
            && covariance.is_some(),
        covariance,
    }
}

fn mode_of<const P: usize>(fit: &BandFit<P>, mode: usize, interval: f64) -> Mode {
    let at = 4 * mode;
    let [step, decay, cosine, sine] = std::array::from_fn(|i| fit.parameters[at + i]);
    let covariance = |i: usize, j: usize| match &fit.covariance {
        Some(matrix) => matrix[at + i][at + j],
        None => f64::INFINITY,
    };
    // Q = step / (2 decay); its relative variance with the covariance of both.
    let relative = covariance(0, 0) / (step * step) + covariance(1, 1) / (decay * decay)
        - 2.0 * covariance(0, 1) / (step * decay);
    let quality = step / (2.0 * decay);
    let amplitude = cosine.hypot(sine);
    let along = cosine * cosine * covariance(2, 2)
        + 2.0 * cosine * sine * covariance(2, 3)
        + sine * sine * covariance(3, 3);
    let known = fit.covariance.is_some();
    let sd = |variance: f64| {
        if known {
            variance.max(0.0).sqrt()
        } else {
            f64::INFINITY
        }
    };
    Mode {
        frequency: step / (TAU * interval),
        frequency_sd: sd(covariance(0, 0)) / (TAU * interval),
        quality,
        quality_sd: quality * sd(relative),
        amplitude,
        amplitude_sd: sd(along) / amplitude,
        phase: sine.atan2(cosine),
        converged: fit.converged,
    }
}

/// Transform of a damped sinusoid at one frequency, with its derivatives.
struct Point {
    value: Complex<f64>,
    slopes: [Complex<f64>; 4],
}

/// Transform of x_n = e^(−δ n) (a cos φn + b sin φn), n = 0 … N−1, at
/// frequency k: with z = e^(−δ + iφ), w = e^(−2πik/N), c = a − ib
///
/// ```text
/// X = ½ (c g(z) + c̄ g(z̄)),   g(z) = (1 − z^N) / (1 − z w)
/// ```
///
/// since w^N = 1.
fn transform_of(mode: &[f64], k: usize, samples: usize) -> Point {
    let (step, decay) = (mode[0], mode[1]);
    let amplitude = Complex::new(mode[2], -mode[3]);
    let z = Complex::from_polar((-decay).exp(), step);
    let whole = Complex::from_polar((-decay * samples as f64).exp(), step * samples as f64);
    let w = Complex::from_polar(1.0, -TAU * k as f64 / samples as f64);
    // g, and by it both derivatives:
    let one = Complex::new(1.0, 0.0);
    // z dg/dz = (−N z^N (1 − zw) + zw (1 − z^N)) / (1 − zw)²
    let sum = |z: Complex<f64>, whole: Complex<f64>| {
        let below = (one - z * w).inv();
        let g = (one - whole) * below;
        (g, z * w * g * below - whole * below * samples as f64)
    };
    let (g, slope) = sum(z, whole);
    let (h, hslope) = sum(z.conj(), whole.conj());
    let (c, d) = (0.5 * amplitude, 0.5 * amplitude.conj());
    Point {
        value: c * g + d * h,
        slopes: [
            Complex::<f64>::I * (c * slope - d * hslope),
            -(c * slope + d * hslope),
            0.5 * (g + h),
            -0.5 * Complex::<f64>::I * (g - h),
        ],
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tap::spectrum::transform;

    const MODE: Parameters = [0.31, 0.02, 0.8, -0.5];

    fn samples(mode: &Parameters, n: usize) -> Vec<f64> {
        (0..n)
            .map(|i| {
                let i = i as f64;
                (-mode[1] * i).exp()
                    * (mode[2] * (mode[0] * i).cos() + mode[3] * (mode[0] * i).sin())
            })
            .collect()
    }

    #[test]
    fn closed_form_transform_is_that_of_the_samples() {
        for n in [40, 101] {
            let values = transform(&samples(&MODE, n), n);
            for (k, value) in values.iter().enumerate() {
                let ours = transform_of(&MODE, k, n).value;
                assert!((ours - value).norm() < 1e-12, "{n} {k}: {ours} {value}");
            }
        }
    }

    #[test]
    fn derivative_of_the_transform() {
        for k in [0, 2, 7] {
            let slopes = transform_of(&MODE, k, 40).slopes;
            for p in 0..4 {
                let at = |h: f64| {
                    let mut mode = MODE;
                    mode[p] += h;
                    transform_of(&mode, k, 40).value
                };
                let difference = (at(1e-6) - at(-1e-6)) / 2e-6;
                assert!((difference - slopes[p]).norm() < 1e-6 * (1.0 + slopes[p].norm()));
                assert!(slopes[p].norm() > 1e-3);
            }
        }
    }

    #[test]
    fn recovers_two_close_modes_without_noise() {
        let interval = 1e-4;
        let second = [0.35, 0.015, 0.3, 0.4];
        let both = samples(&MODE, 800).into_iter().zip(samples(&second, 800));
        let both: Vec<f64> = both.map(|(a, b)| a + b).collect();
        let values = transform(&both, 800);
        let transformed = Transformed {
            values: &values,
            samples: 800,
            interval,
        };
        let start = |step: f64| ModeStart {
            frequency: step / (TAU * interval),
            width: 50.0,
        };
        let found = fit_modes(&transformed, &[start(0.313), start(0.348)]);
        for (mode, truth) in found.iter().zip([MODE, second]) {
            assert!(mode.converged);
            assert!((mode.frequency * TAU * interval / truth[0] - 1.0).abs() < 1e-7);
            assert!((mode.quality * 2.0 * truth[1] / truth[0] - 1.0).abs() < 1e-6);
            assert!((mode.amplitude - truth[2].hypot(truth[3])).abs() < 1e-6);
        }
    }
}
