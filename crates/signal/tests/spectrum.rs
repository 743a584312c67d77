//! Spectra and peaks against scipy 1.17.1; `spectra/reference.py` makes the values.

#![allow(clippy::unwrap_used, clippy::print_stdout)]

use windfall_signal::tap::spectrum::{
    Offset, Scaling, SpectrumOptions, Window, periodogram, welch,
};
use windfall_signal::tap::spectrum_peak::peaks;

const REFERENCE: &str = include_str!("spectra/scipy.txt");

fn reference(name: &str) -> Vec<f64> {
    let mut lines = REFERENCE.lines().map(|line| line.split(' '));
    let mut line = lines
        .find(|words| words.clone().next() == Some(name))
        .unwrap_or_else(|| panic!("no {name}"));
    line.next();
    line.map(|word| word.parse().unwrap()).collect()
}

/// The signal of `reference.py`.
fn samples(n: usize) -> Vec<f64> {
    let mut state: u64 = 12345;
    (0..n)
        .map(|i| {
            state = (1_103_515_245 * state + 12345) % (1 << 31);
            let i = i as f64;
            (0.31 * i).sin() * (-0.01 * i).exp()
                + 0.5 * (1.7 * i + 0.3).sin()
                + 0.1
                + 0.2 * (state as f64 / f64::from(1u32 << 31) - 0.5)
        })
        .collect()
}

#[track_caller]
fn compare(name: &str, ours: &[f64]) {
    let theirs = reference(name);
    assert_eq!(ours.len(), theirs.len(), "{name}");
    let scale = theirs.iter().fold(0.0, |a: f64, b| a.max(b.abs()));
    for (i, (a, b)) in ours.iter().zip(&theirs).enumerate() {
        assert!(
            (a - b).abs() <= 1e-10 * b.abs() + 1e-15 * scale,
            "{name}[{i}]: {a} {b}"
        );
    }
}

#[test]
fn reference_spectra_agree_with_scipy() {
    let x = samples(151);
    for (window, window_name) in [
        (Window::Rectangular, "rectangular"),
        (Window::Hann, "hann"),
        (Window::BlackmanHarris, "blackman-harris"),
    ] {
        for (scaling, word) in [(Scaling::Density, "density"), (Scaling::Power, "power")] {
            let options = |length| SpectrumOptions {
                window,
                scaling,
                length,
                offset: Offset::Remove,
            };
            let name = |kind: &str| format!("{kind}-{window_name}-{word}");
            let whole = periodogram(&x, 1e-3, &options(None)).unwrap();
            compare(&name("periodogram"), &whole.power);
            let padded = periodogram(&x, 1e-3, &options(Some(256))).unwrap();
            compare(&name("padded"), &padded.power);
            let mean = welch(&x, 1e-3, 64, 32, &options(Some(128))).unwrap();
            compare(&name("welch"), &mean.power);
            assert!((mean.step - 1000.0 / 128.0).abs() < 1e-12);
        }
    }
    let options = SpectrumOptions {
        offset: Offset::Keep,
        ..SpectrumOptions::default()
    };
    compare("kept", &periodogram(&x, 1e-3, &options).unwrap().power);
}

#[test]
fn reference_peaks_agree_with_scipy() {
    let found = peaks(&samples(151));
    let index: Vec<f64> = found.iter().map(|p| p.index as f64).collect();
    let prominence: Vec<f64> = found.iter().map(|p| p.prominence).collect();
    let width: Vec<f64> = found.iter().map(|p| p.width).collect();
    compare("peak-index", &index);
    compare("peak-prominence", &prominence);
    compare("peak-width", &width);
}
