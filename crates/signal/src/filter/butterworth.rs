//! Butterworth filters as second-order sections.

use num_complex::Complex;
use serde::Serialize;
use std::f64::consts::PI;

/// What a filter lets through.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Band {
    /// Frequencies below this; Hz.
    LowPass(f64),
    /// Frequencies above this; Hz.
    HighPass(f64),
    /// Frequencies between these; Hz.
    BandPass(f64, f64),
}

/// A filter of two poles and two zeros:
///
/// ```text
/// y_i = b0 x_i + b1 x_{i-1} + b2 x_{i-2} − a1 y_{i-1} − a2 y_{i-2}
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Section {
    /// b0, b1, b2.
    pub forward: [f64; 3],
    /// a1, a2.
    pub back: [f64; 2],
}

/// Largest order.
pub const MAX_ORDER: usize = 10;

/// Why there is no such filter.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[allow(missing_docs, reason = "each message names its fields")]
pub enum FilterError {
    #[error(
        "a cut-off of {cutoff} Hz: expected a frequency above 0 and below {limit} Hz, half the \
         sampling rate of {rate} Hz"
    )]
    Cutoff { cutoff: f64, limit: f64, rate: f64 },
    #[error("a pass band from {low} Hz to {high} Hz: the first must be below the second")]
    BandReversed { low: f64, high: f64 },
    #[error("a filter of order {order}: expected 1 to 10")]
    Order { order: usize },
    #[error(
        "{samples} samples are too few for this filter, which needs more than {least}; lower its \
         order"
    )]
    TooFewSamples { samples: usize, least: usize },
    #[error(
        "the samples are not evenly spaced in time, as a filter needs; resample the recording, or \
         use a smoothing spline"
    )]
    UnevenTimes,
}

/// A digital Butterworth filter by the bilinear transform, its cut-offs placed
/// exactly (prewarped). A band pass of order n has 2n poles.
///
/// * `rate`: sampling rate; Hz
///
/// # Source
/// Butterworth (1930), Experimental Wireless 7:536; Oppenheim and Schafer
/// (1989), Discrete-Time Signal Processing, section 7.1.
///
/// # Errors
/// See [`FilterError`].
///
/// # Example
/// ```
/// use windfall_signal::filter::butterworth::{Band, butterworth, gain};
/// let filter = butterworth(Band::LowPass(1000.0), 4, 200e3).unwrap();
/// // Half of the power at the cut-off, everything at zero.
/// assert!((gain(&filter, 1000.0, 200e3).powi(2) - 0.5).abs() < 1e-9);
/// assert!((gain(&filter, 0.0, 200e3) - 1.0).abs() < 1e-9);
/// ```
pub fn butterworth(band: Band, order: usize, rate: f64) -> Result<Vec<Section>, FilterError> {
    check(band, order, rate)?;
    // Frequencies of the analogue filter in units of twice the sampling rate.
    let warped = |frequency: f64| (PI * frequency / rate).tan();
    let poles = (0..order.div_ceil(2)).map(|k| {
        let angle = PI * (2 * k + order + 1) as f64 / (2 * order) as f64;
        Complex::from_polar(1.0, angle)
    });
    // One of each conjugate pair, with the real one of an odd order last.
    let mut sections = Vec::new();
    for (k, pole) in poles.enumerate() {
        let real = order % 2 == 1 && k == order / 2;
        match band {
            Band::LowPass(cutoff) => {
                let pole = digital(pole * warped(cutoff));
                sections.push(match real {
                    true => section([1.0, 1.0, 0.0], &[pole]),
                    false => section([1.0, 2.0, 1.0], &[pole, pole.conj()]),
                });
            }
            Band::HighPass(cutoff) => {
                let pole = digital(warped(cutoff) / pole);
                sections.push(match real {
                    true => section([1.0, -1.0, 0.0], &[pole]),
                    false => section([1.0, -2.0, 1.0], &[pole, pole.conj()]),
                });
            }
            Band::BandPass(low, high) => {
                let (low, high) = (warped(low), warped(high));
                let half = pole * (0.5 * (high - low));
                let root = (half * half - low * high).sqrt();
                let pair = [digital(half + root), digital(half - root)];
                let zeros = [1.0, 0.0, -1.0];
                match real {
                    true => sections.push(section(zeros, &pair)),
                    false => sections.extend(pair.map(|pole| section(zeros, &[pole, pole.conj()]))),
                }
            }
        }
    }
    let centre = match band {
        Band::LowPass(_) => 0.0,
        Band::HighPass(_) => 0.5 * rate,
        Band::BandPass(low, high) => rate / PI * (warped(low) * warped(high)).sqrt().atan(),
    };
    // Each section by itself, so that none overflows.
    for section in &mut sections {
        let own = gain(std::slice::from_ref(section), centre, rate);
        section.forward.iter_mut().for_each(|b| *b /= own);
    }
    Ok(sections)
}

fn check(band: Band, order: usize, rate: f64) -> Result<(), FilterError> {
    if !(1..=MAX_ORDER).contains(&order) {
        return Err(FilterError::Order { order });
    }
    let cutoffs = match band {
        Band::LowPass(cutoff) | Band::HighPass(cutoff) => [cutoff, cutoff],
        Band::BandPass(low, high) => [low, high],
    };
    for cutoff in cutoffs {
        let limit = 0.5 * rate;
        if !(cutoff > 0.0 && cutoff < limit) {
            return Err(FilterError::Cutoff {
                cutoff,
                limit,
                rate,
            });
        }
    }
    match band {
        Band::BandPass(low, high) if low >= high => Err(FilterError::BandReversed { low, high }),
        _ => Ok(()),
    }
}

/// Bilinear transform of a pole.
fn digital(pole: Complex<f64>) -> Complex<f64> {
    (1.0 + pole) / (1.0 - pole)
}

/// One or two poles whose polynomial is real.
fn section(forward: [f64; 3], poles: &[Complex<f64>]) -> Section {
    let back = match poles {
        [pole] => [-pole.re, 0.0],
        [first, second] => [-(first + second).re, (first * second).re],
        _ => [0.0, 0.0],
    };
    Section { forward, back }
}

/// Gain of a filter, passed once, at a frequency in Hz.
pub fn gain(sections: &[Section], frequency: f64, rate: f64) -> f64 {
    let delay = Complex::from_polar(1.0, -2.0 * PI * frequency / rate);
    sections
        .iter()
        .map(|section| {
            let [b0, b1, b2] = section.forward;
            let [a1, a2] = section.back;
            let above = b0 + delay * (b1 + delay * b2);
            let below = 1.0 + delay * (a1 + delay * a2);
            (above / below).norm()
        })
        .product()
}
