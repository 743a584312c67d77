//! Filters without delay: forwards, then backwards.

use crate::filter::butterworth::{FilterError, Section};

/// Filters a signal forwards and backwards, so that nothing is delayed. The
/// gain of the filter applies twice.
///
/// Both ends are prolonged by an odd reflection of three times the filter's
/// length, and the filter starts in the state that a constant would have left.
///
/// # Source
/// Gustafsson (1996), IEEE Trans. Signal Process. 44:988, on start states; the
/// prolongation is that of scipy.signal.sosfiltfilt, with which a test compares.
///
/// # Errors
/// [`FilterError::TooFewSamples`].
pub fn filter_zero_phase(sections: &[Section], signal: &[f64]) -> Result<Vec<f64>, FilterError> {
    let pad = padding(sections);
    let n = signal.len();
    if n <= pad {
        return Err(FilterError::TooFewSamples {
            samples: n,
            least: pad,
        });
    }
    let (first, last) = (signal[0], signal[n - 1]);
    let mut long = Vec::with_capacity(n + 2 * pad);
    long.extend((1..=pad).rev().map(|i| 2.0 * first - signal[i]));
    long.extend_from_slice(signal);
    long.extend((1..=pad).map(|i| 2.0 * last - signal[n - 1 - i]));
    for section in sections {
        pass(section, &mut long);
    }
    long.reverse();
    for section in sections {
        pass(section, &mut long);
    }
    long.reverse();
    Ok(long[pad..pad + n].to_vec())
}

/// Samples by which either end is prolonged.
pub fn padding(sections: &[Section]) -> usize {
    let plain = |pick: fn(&Section) -> f64| sections.iter().filter(|s| pick(s) == 0.0).count();
    let short = plain(|s| s.forward[2]).min(plain(|s| s.back[1]));
    3 * (2 * sections.len() + 1 - short)
}

/// One section in place (direct form II transposed), in the steady state of the
/// constant that the sections before it make of the first sample.
fn pass(section: &Section, signal: &mut [f64]) {
    let [b0, b1, b2] = section.forward;
    let [a1, a2] = section.back;
    let Some(&first) = signal.first() else {
        return;
    };
    // y = g x for a constant x.
    let gain = (b0 + b1 + b2) / (1.0 + a1 + a2);
    let mut second_state = (b2 - a2 * gain) * first;
    let mut first_state = (b1 - a1 * gain) * first + second_state;
    for sample in signal {
        let x = *sample;
        let y = b0 * x + first_state;
        first_state = b1 * x - a1 * y + second_state;
        second_state = b2 * x - a2 * y;
        *sample = y;
    }
}
