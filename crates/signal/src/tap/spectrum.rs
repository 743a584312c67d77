//! Power spectra: periodogram and Welch's average of periodograms.

use crate::error::Error;
use realfft::RealFftPlanner;
use realfft::num_complex::Complex;
use std::f64::consts::TAU;

/// How samples are weighted before the transform.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Window {
    /// All alike: for a signal that begins with the window and has decayed at
    /// its end.
    Rectangular,
    /// Raised cosine.
    #[default]
    Hann,
    /// Four terms, side lobes below −92 dB.
    ///
    /// # Source
    /// Harris (1978), Proc. IEEE 66:51.
    BlackmanHarris,
}

/// What the ordinates mean.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Scaling {
    /// Power per frequency; unit²/Hz. Its integral is the mean square.
    #[default]
    Density,
    /// Power; unit². A sinusoid of amplitude A stands at A²/2.
    Power,
}

/// What is done about the mean.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Offset {
    /// It is subtracted, from each segment.
    #[default]
    Remove,
    /// It is kept.
    Keep,
}

/// How a spectrum is made.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SpectrumOptions {
    /// Weights of the samples.
    pub window: Window,
    /// Meaning of the ordinates.
    pub scaling: Scaling,
    /// What is done about the mean.
    pub offset: Offset,
    /// Length of the transform, to which samples are filled up with zeros; the
    /// number of samples when `None`.
    pub length: Option<usize>,
}

/// A one-sided spectrum.
#[derive(Clone, Debug, PartialEq)]
pub struct Spectrum {
    /// Distance of neighbouring frequencies, the first of which is 0; Hz.
    pub step: f64,
    /// Ordinates; see [`Scaling`].
    pub power: Vec<f64>,
}

impl Spectrum {
    /// Index of the ordinate nearest to a frequency.
    pub fn nearest(&self, frequency: f64) -> usize {
        let index = (frequency / self.step).round().max(0.0) as usize;
        index.min(self.power.len().saturating_sub(1))
    }
}

/// Spectrum of a signal as one segment.
///
/// * `interval`: sampling interval; s
///
/// # Source
/// The conventions are those of scipy.signal.periodogram: periodic windows,
/// every frequency but 0 and half the sampling rate counted twice. A test
/// compares with it.
///
/// # Errors
/// No sample, an interval that is not positive, or a transform shorter than the
/// signal.
pub fn periodogram(
    samples: &[f64],
    interval: f64,
    options: &SpectrumOptions,
) -> Result<Spectrum, Error> {
    welch(samples, interval, samples.len(), 0, options)
}

/// Mean of the spectra of segments that overlap.
///
/// * `interval`: sampling interval; s
/// * `segment`: samples of a segment; `overlap`: samples that it shares with the next
///
/// # Source
/// Welch (1967), IEEE Trans. Audio Electroacoust. 15:70; conventions of
/// scipy.signal.welch, with which a test compares.
///
/// # Errors
/// As [`periodogram`]; also a segment longer than the signal, or an overlap as
/// long as the segment.
pub fn welch(
    samples: &[f64],
    interval: f64,
    segment: usize,
    overlap: usize,
    options: &SpectrumOptions,
) -> Result<Spectrum, Error> {
    let length = options.length.unwrap_or(segment);
    check(samples, interval, segment, overlap, length)?;
    let weights = window_weights(options.window, segment);
    let scale = match options.scaling {
        Scaling::Density => interval / weights.iter().map(|w| w * w).sum::<f64>(),
        Scaling::Power => weights.iter().sum::<f64>().powi(-2),
    };
    let mut power = vec![0.0; length / 2 + 1];
    let mut segments = 0.0;
    for part in samples.windows(segment).step_by(segment - overlap) {
        let mean = match options.offset {
            Offset::Remove => part.iter().sum::<f64>() / segment as f64,
            Offset::Keep => 0.0,
        };
        let weighted = part.iter().zip(&weights).map(|(x, w)| w * (x - mean));
        let transformed = transform(&weighted.collect::<Vec<f64>>(), length);
        for (sum, value) in power.iter_mut().zip(&transformed) {
            *sum += value.norm_sqr();
        }
        segments += 1.0;
    }
    for (k, sum) in power.iter_mut().enumerate() {
        let both_sides = if k == 0 || 2 * k == length { 1.0 } else { 2.0 };
        *sum *= both_sides * scale / segments;
    }
    Ok(Spectrum {
        step: 1.0 / (length as f64 * interval),
        power,
    })
}

fn check(
    samples: &[f64],
    interval: f64,
    segment: usize,
    overlap: usize,
    length: usize,
) -> Result<(), Error> {
    let bad = |option, value, expected| Error::bad_option(option, value, expected);
    if !(interval > 0.0 && interval.is_finite()) {
        let expected = "a sampling interval above zero, in s";
        return Err(bad("interval", interval, expected));
    }
    if segment == 0 || segment > samples.len() {
        let expected = "at least one sample and no more than the signal has";
        return Err(bad("segment", segment as f64, expected));
    }
    if overlap >= segment {
        let expected = "fewer samples than a segment has";
        return Err(bad("overlap", overlap as f64, expected));
    }
    if length < segment {
        let expected = "at least as many samples as a segment has";
        return Err(bad("length", length as f64, expected));
    }
    Ok(())
}

fn window_weights(window: Window, length: usize) -> Vec<f64> {
    let terms: &[f64] = match window {
        Window::Rectangular => &[1.0],
        Window::Hann => &[0.5, 0.5],
        Window::BlackmanHarris => &[0.35875, 0.48829, 0.14128, 0.01168],
    };
    let weight = |i: usize| {
        let angle = TAU * i as f64 / length as f64;
        let term = |(k, a): (usize, &f64)| {
            let sign = if k % 2 == 0 { 1.0 } else { -1.0 };
            sign * a * (k as f64 * angle).cos()
        };
        terms.iter().enumerate().map(term).sum()
    };
    (0..length).map(weight).collect()
}

/// Discrete Fourier transform of a real signal filled up with zeros, for the
/// frequencies from 0 to half the sampling rate.
pub(crate) fn transform(samples: &[f64], length: usize) -> Vec<Complex<f64>> {
    let plan = RealFftPlanner::<f64>::new().plan_fft_forward(length);
    let mut input = plan.make_input_vec();
    input[..samples.len()].copy_from_slice(samples);
    let mut output = plan.make_output_vec();
    // The lengths are those that the plan gave.
    match plan.process(&mut input, &mut output) {
        Ok(()) => output,
        Err(_) => Vec::new(),
    }
}

/// A signal with frequencies outside a band weakened, without delay.
///
/// The gain is 1 / (1 + (low/f)⁴) · 1 / (1 + (f/high)⁴), a half at both ends:
/// it has no edges, so that a tap does not ring before it begins. The mean is
/// removed, and zeros follow the signal so that its end does not touch its begin.
///
/// * `interval`: sampling interval; s
/// * `low`, `high`: ends of the band; Hz
pub fn band_limited(samples: &[f64], interval: f64, low: f64, high: f64) -> Vec<f64> {
    let mean = samples.iter().sum::<f64>() / samples.len().max(1) as f64;
    let centred: Vec<f64> = samples.iter().map(|x| x - mean).collect();
    // Several periods of the lowest frequency.
    let room = (4.0 / (low * interval)).ceil() as usize;
    let length = (samples.len() + room).next_power_of_two();
    let mut values = transform(&centred, length);
    for (k, value) in values.iter_mut().enumerate() {
        let frequency = k as f64 / (length as f64 * interval);
        let below = (frequency / low).powi(4);
        *value *= below / (1.0 + below) / (1.0 + (frequency / high).powi(4)) / length as f64;
    }
    let plan = RealFftPlanner::<f64>::new().plan_fft_inverse(length);
    let mut output = plan.make_output_vec();
    // The first and last value are real: those of a real signal times a real gain.
    match plan.process(&mut values, &mut output) {
        Ok(()) => output.truncate(samples.len()),
        Err(_) => output.clear(),
    }
    output
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn conserves_the_mean_square_of_a_signal() {
        // Parseval: the integral of the density is the mean square.
        for n in [64, 65] {
            let samples: Vec<f64> = (0..n).map(|i| f64::from(i * i % 17) - 3.0).collect();
            let options = SpectrumOptions {
                window: Window::Rectangular,
                offset: Offset::Keep,
                ..SpectrumOptions::default()
            };
            let spectrum = periodogram(&samples, 1e-3, &options).unwrap();
            let integral = spectrum.power.iter().sum::<f64>() * spectrum.step;
            let square = samples.iter().map(|x| x * x).sum::<f64>() / f64::from(n);
            assert!((integral / square - 1.0).abs() < 1e-13);
        }
    }

    #[test]
    fn closed_form_gain_of_a_band() {
        // Far from its ends a sinusoid is only scaled by the gain.
        let interval = 1e-4;
        for (frequency, gain) in [
            (200.0, 0.5),
            (600.0, 81.0 / 82.0 / 1.0081),
            (50.0, 1.0 / 257.0),
        ] {
            let wave = |i: usize| (TAU * frequency * i as f64 * interval).sin();
            let samples: Vec<f64> = (0..8000).map(wave).collect();
            let limited = band_limited(&samples, interval, 200.0, 2000.0);
            assert_eq!(limited.len(), 8000);
            for i in (3000..5000).step_by(37) {
                let high = (frequency / 2000.0_f64).powi(4);
                let expected = if frequency == 600.0 {
                    gain
                } else {
                    gain / (1.0 + high)
                };
                assert!(
                    (limited[i] - expected * wave(i)).abs() < 1e-3,
                    "{frequency} {i}"
                );
            }
        }
    }

    #[test]
    fn rejects_segments_that_do_not_fit() {
        let options = SpectrumOptions::default();
        let message = |segment, overlap, length| {
            let options = SpectrumOptions { length, ..options };
            welch(&[1.0, 2.0, 3.0], 0.1, segment, overlap, &options)
                .unwrap_err()
                .to_string()
        };
        assert!(message(4, 0, None).starts_with("segment = 4"));
        assert!(message(0, 0, None).starts_with("segment = 0"));
        assert!(message(2, 2, None).starts_with("overlap = 2"));
        assert!(message(3, 0, Some(2)).starts_with("length = 2"));
        assert!(periodogram(&[1.0], f64::NAN, &options).is_err());
        assert!(periodogram(&[], 0.1, &options).is_err());
    }
}
