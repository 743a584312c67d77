//! Taps as a figure: spectrum of each with the fitted modes.

use crate::taps::document::TapsDocument;
use windfall_draw::xy::{Figure, Mark, Panel, Series, Side, Style};
use windfall_signal::tap::damped_mode::mode_samples;
use windfall_signal::tap::resonance::tap_spectrum;

/// Most taps of a recording that are drawn.
const MOST_TAPS: usize = 4;

/// Spectra of taps, each over its highest value in the band, with the fitted modes.
///
/// * `sounds`: samples of each tap from the end of the hit on
/// * `interval`: sampling interval; s
/// * `band`: lowest and highest frequency; Hz
/// * `accepted`: frequency of the first mode, where one is accepted; Hz
pub fn figure_of_taps(
    title: &str,
    sounds: &[&[f64]],
    interval: f64,
    band: (f64, f64),
    (taps, accepted): (&TapsDocument, Option<f64>),
) -> Figure {
    let mut panels = Vec::new();
    for (number, (sound, tap)) in sounds.iter().zip(&taps.taps).take(MOST_TAPS).enumerate() {
        let mean = sound.iter().sum::<f64>() / sound.len().max(1) as f64;
        let centred: Vec<f64> = sound.iter().map(|x| x - mean).collect();
        let mut fitted = vec![0.0; sound.len()];
        for resonance in &tap.resonances {
            let all = mode_samples(&resonance.mode, interval, sound.len());
            fitted.iter_mut().zip(all).for_each(|(sum, x)| *sum += x);
        }
        let measured = amplitudes(&centred, interval, band);
        let highest = measured.iter().fold(0.0, |a: f64, (_, y)| a.max(*y));
        let scaled = |points: Vec<(f64, f64)>| -> Vec<(f64, f64)> {
            let scale = highest.max(f64::MIN_POSITIVE);
            points.into_iter().map(|(x, y)| (x, y / scale)).collect()
        };
        let fitted = scaled(amplitudes(&fitted, interval, band));
        let near = |frequency: f64| {
            let distance = |point: &&(f64, f64)| (point.0 - frequency).abs();
            let nearest = fitted
                .iter()
                .min_by(|a, b| distance(a).total_cmp(&distance(b)));
            nearest.map_or(0.0, |(_, y)| *y)
        };
        let mark = |frequency: f64| Mark {
            label: format!("first mode of the fruit, {frequency:.1} Hz"),
            at: (frequency, near(frequency)),
            side: Side::BelowRight,
        };
        let marks = accepted.into_iter().map(mark).collect();
        let amplitude = format!("amplitude of tap {}", number + 1);
        let series = vec![
            Series::new("measured", Style::Broad, scaled(measured)),
            Series::new("fitted modes", Style::Line, fitted),
        ];
        let panel = Panel::new(("frequency", "Hz"), (&amplitude, ""), series);
        panels.push(Panel { marks, ..panel });
    }
    Figure::new(title, panels)
}

/// Amplitude spectrum in the band.
fn amplitudes(sound: &[f64], interval: f64, (low, high): (f64, f64)) -> Vec<(f64, f64)> {
    let Ok(spectrum) = tap_spectrum(sound, interval) else {
        return Vec::new();
    };
    let point = |(k, power): (usize, &f64)| (k as f64 * spectrum.step, power.sqrt());
    let all = spectrum.power.iter().enumerate().map(point);
    all.filter(|(f, _)| (0.5 * low..=high).contains(f))
        .collect()
}
