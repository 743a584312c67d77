//! Filters and splines against SciPy on the same input.
//!
//! The reference values are those of `scipy/reference.py`; all agree to 1e-10.

#![allow(clippy::unwrap_used)]

#[path = "scipy/reference.rs"]
mod reference;

use windfall_signal::filter::butterworth::{Band, FilterError, butterworth, gain};
use windfall_signal::filter::smoothing_spline::{smoothing_spline, smoothing_spline_gcv};
use windfall_signal::filter::zero_phase::{filter_zero_phase, padding};
use windfall_signal::polynomial::local_polynomial;

const AGREES: f64 = 1e-10;

fn input() -> Vec<f64> {
    let of = |i: f64| (0.37 * i).sin() + 0.5 * (2.1 * i).cos() + 0.01 * i * i / 10.0;
    (0..64).map(|i| of(f64::from(i))).collect()
}

fn agree(found: &[f64], expected: &[f64], what: &str) {
    assert_eq!(found.len(), expected.len(), "{what}");
    let largest = expected.iter().map(|e| e.abs()).fold(0.0, f64::max);
    for (i, (found, expected)) in found.iter().zip(expected).enumerate() {
        assert!(
            (found - expected).abs() <= AGREES * largest,
            "{what}, sample {i}: {found} and {expected}"
        );
    }
}

/// Cut-offs in parts of half the sampling rate, as SciPy takes them.
#[test]
fn reference_zero_phase_butterworth() {
    let signal = input();
    for (name, band, order, expected) in [
        ("low 4", Band::LowPass(0.2), 4, &reference::LOW_4),
        ("low 3", Band::LowPass(0.35), 3, &reference::LOW_3),
        ("high 2", Band::HighPass(0.1), 2, &reference::HIGH_2),
        ("high 5", Band::HighPass(0.15), 5, &reference::HIGH_5),
        ("band 2", Band::BandPass(0.1, 0.4), 2, &reference::BAND_2),
        ("band 3", Band::BandPass(0.05, 0.6), 3, &reference::BAND_3),
    ] {
        let filter = butterworth(band, order, 2.0).unwrap();
        agree(
            &filter_zero_phase(&filter, &signal).unwrap(),
            expected,
            name,
        );
    }
}

#[test]
fn reference_savitzky_golay() {
    let signal = input();
    let times: Vec<f64> = (0..64).map(|i| 0.5 * f64::from(i)).collect();
    for (name, window, order, derivative, expected) in [
        ("11, 2, 0", 11, 2, 0, &reference::SAVGOL_11_2_0),
        ("11, 2, 1", 11, 2, 1, &reference::SAVGOL_11_2_1),
        ("9, 3, 0", 9, 3, 0, &reference::SAVGOL_9_3_0),
        ("15, 4, 2", 15, 4, 2, &reference::SAVGOL_15_4_2),
    ] {
        let found = local_polynomial(&times, &signal, window, order, derivative).unwrap();
        agree(&found, expected, name);
    }
}

fn uneven() -> Vec<f64> {
    (0..64)
        .map(|i| 0.5 * f64::from(i) + 0.1 * f64::from(i).sin())
        .collect()
}

#[test]
fn reference_smoothing_spline() {
    let (times, signal) = (uneven(), input());
    for (penalty, values, rates) in [
        (0.01, &reference::SPLINE_0_01, &reference::SPLINE_RATE_0_01),
        (1.0, &reference::SPLINE_1_0, &reference::SPLINE_RATE_1_0),
        (
            100.0,
            &reference::SPLINE_100_0,
            &reference::SPLINE_RATE_100_0,
        ),
    ] {
        let spline = smoothing_spline(&times, &signal, penalty).unwrap();
        agree(&spline.values, values, "values");
        agree(&spline.rates, rates, "rates");
        assert!(spline.parameters > 2.0 && spline.parameters < 64.0);
    }
}

/// SciPy finds its penalty to some digits only; both are near the minimum.
#[test]
fn reference_cross_validated_spline() {
    let signal: Vec<f64> = (0..64)
        .map(f64::from)
        .map(|i| (0.2 * i).sin() + 0.1 * (7.7 * i * i).cos())
        .collect();
    let spline = smoothing_spline_gcv(&uneven(), &signal).unwrap();
    for (found, expected) in spline.values.iter().zip(&reference::SPLINE_GCV) {
        assert!((found - expected).abs() < 2e-4, "{found} and {expected}");
    }
}

#[test]
fn closed_form_stiff_spline_is_the_regression_line() {
    let (times, signal) = (uneven(), input());
    let spline = smoothing_spline(&times, &signal, 1e12).unwrap();
    let n = 64.0;
    let (t, y) = (
        times.iter().sum::<f64>() / n,
        signal.iter().sum::<f64>() / n,
    );
    let xx: f64 = times.iter().map(|x| (x - t).powi(2)).sum();
    let xy: f64 = times
        .iter()
        .zip(&signal)
        .map(|(x, v)| (x - t) * (v - y))
        .sum();
    assert!((spline.parameters - 2.0).abs() < 1e-4);
    for rate in &spline.rates {
        assert!((rate - xy / xx).abs() < 1e-6);
    }
}

#[test]
fn closed_form_gains_of_butterworth() {
    // |H|² = 1/(1 + (tan(πf/r)/tan(πc/r))^2n).
    let filter = butterworth(Band::LowPass(5e3), 6, 200e3).unwrap();
    for frequency in [100.0, 4e3, 5e3, 8e3, 3e4] {
        let ratio = (std::f64::consts::PI * frequency / 200e3).tan()
            / (std::f64::consts::PI * 5e3 / 200e3).tan();
        let expected = 1.0 / (1.0 + ratio.powi(12)).sqrt();
        assert!((gain(&filter, frequency, 200e3) / expected - 1.0).abs() < 1e-9);
    }
}

#[test]
fn rejects_filters_that_cannot_be() {
    assert!(matches!(
        butterworth(Band::LowPass(1.2), 4, 2.0),
        Err(FilterError::Cutoff { .. })
    ));
    assert!(matches!(
        butterworth(Band::LowPass(f64::NAN), 4, 2.0),
        Err(FilterError::Cutoff { .. })
    ));
    assert!(matches!(
        butterworth(Band::BandPass(0.5, 0.2), 4, 2.0),
        Err(FilterError::BandReversed { .. })
    ));
    assert!(matches!(
        butterworth(Band::LowPass(0.5), 11, 2.0),
        Err(FilterError::Order { .. })
    ));
    let filter = butterworth(Band::LowPass(0.5), 4, 2.0).unwrap();
    let short = vec![1.0; padding(&filter)];
    assert!(filter_zero_phase(&filter, &short).is_err());
    assert!(smoothing_spline(&[0.0, 1.0, 1.0, 2.0, 3.0], &[0.0; 5], 1.0).is_none());
}
