//! The rules by which a resonance is accepted as the first spheroidal mode.

#![allow(clippy::unwrap_used, clippy::print_stdout)]

use windfall_signal::tap::damped_mode::Mode;
use windfall_signal::tap::first_mode::{
    Confidence, Decision, FirstModeOptions, Rejection, TapModes, first_mode, persistent,
    shared_frequencies,
};
use windfall_signal::tap::resonance::Resonance;

/// Frequency (Hz), quality, level.
type Peak = (f64, f64, f64);

fn resonance(&(frequency, quality, level): &Peak) -> Resonance {
    Resonance {
        mode: Mode {
            frequency,
            frequency_sd: 0.3,
            quality,
            quality_sd: 0.5,
            amplitude: level,
            amplitude_sd: 0.01,
            phase: 0.0,
            converged: true,
        },
        level,
        over_noise: 1000.0,
        in_quiet: false,
    }
}

fn taps(peaks: &[impl AsRef<[Peak]>]) -> Vec<TapModes> {
    peaks
        .iter()
        .enumerate()
        .map(|(number, peaks)| TapModes {
            orientation: format!("place {}", number % 2),
            resonances: peaks.as_ref().iter().map(resonance).collect(),
        })
        .collect()
}

fn decide(taps: &[TapModes], shared: &[f64]) -> Decision {
    let options = FirstModeOptions::default();
    let found = persistent(taps, options.agreement);
    first_mode(&found, taps.len(), 2.min(taps.len()), shared, &options)
}

fn frequency(decision: &Decision) -> f64 {
    decision.accepted.as_ref().unwrap().frequency.value
}

/// Frequencies that are not taken, rounded, with the reason.
fn refused(decision: &Decision) -> Vec<(f64, Rejection)> {
    let of = decision.rejected.iter();
    of.map(|(mode, why)| (mode.frequency.value.round(), *why))
        .collect()
}

const FRUIT: Peak = (800.0, 20.0, 1.0);
const HIGHER: Peak = (1180.0, 25.0, 0.5);

#[test]
fn closed_form_the_lowest_lasting_mode_is_taken() {
    let decision = decide(&taps(&[&[FRUIT, HIGHER]; 4]), &[]);
    assert!((frequency(&decision) - 800.0).abs() < 1e-9);
    assert_eq!(decision.confidence, Confidence::High);
    assert_eq!(refused(&decision), [(1180.0, Rejection::Higher)]);
}

#[test]
fn closed_form_one_tap_is_little_and_two_are_some() {
    let confidence = |n: usize| decide(&taps(&vec![&[FRUIT][..]; n]), &[]).confidence;
    assert_eq!(confidence(1), Confidence::Low);
    assert_eq!(confidence(2), Confidence::Medium);
    assert_eq!(confidence(3), Confidence::High);
    assert_eq!(decide(&[], &[]).confidence, Confidence::None);
}

#[test]
fn closed_form_hit_transients_and_chance_peaks_are_left_out() {
    // Broad below the fruit; one tap with a peak of its own.
    let broad = (350.0, 1.5, 0.9);
    let chance = (520.0, 15.0, 0.4);
    let all = taps(&[
        vec![broad, chance, FRUIT],
        vec![broad, FRUIT],
        vec![broad, FRUIT],
        vec![broad, FRUIT],
    ]);
    let decision = decide(&all, &[]);
    assert!((frequency(&decision) - 800.0).abs() < 1e-9);
    let expected = [(350.0, Rejection::Broad), (520.0, Rejection::Inconstant)];
    assert_eq!(refused(&decision), expected);
}

#[test]
fn closed_form_a_soft_fruit_has_no_mode() {
    let decision = decide(&taps(&[&[(300.0, 2.5, 1.0)]; 4]), &[]);
    assert!(decision.accepted.is_none());
    assert_eq!(decision.confidence, Confidence::None);
}

#[test]
fn closed_form_a_split_mode_is_their_mean_and_covers_both() {
    let all = taps(&[&[(780.0, 20.0, 1.0), (840.0, 20.0, 0.6), HIGHER]; 4]);
    let decision = decide(&all, &[]);
    let mode = decision.accepted.unwrap();
    assert!((mode.frequency.value - 810.0).abs() < 1e-9);
    // A rectangular distribution of half width 30 Hz: 30/√3.
    assert!((mode.frequency.sd / (30.0 / 3.0_f64.sqrt()) - 1.0).abs() < 1e-3);
    let (low, high) = mode.doublet.unwrap();
    assert!((low - 780.0).abs() < 1e-9 && (high - 840.0).abs() < 1e-9);
    assert_eq!(decision.confidence, Confidence::Medium);
}

#[test]
fn closed_form_a_weak_peak_just_below_is_torsional() {
    // 0T2 over 0S2 at a Poisson's ratio of 0.25: 2.501/2.640 (Lamb 1882).
    let torsional = (800.0 * 2.501 / 2.640, 20.0, 0.15);
    let decision = decide(&taps(&[&[torsional, FRUIT]; 4]), &[]);
    assert!((frequency(&decision) - 800.0).abs() < 1e-9);
    assert_eq!(refused(&decision), [(758.0, Rejection::Torsional)]);
}

#[test]
fn closed_form_what_all_fruit_share_is_no_fruit() {
    let support = (430.0, 40.0, 0.7);
    let fruit = |f: f64| taps(&[&[support, (f, 20.0, 1.0)]; 3]);
    let options = FirstModeOptions::default();
    let all = [690.0, 745.0, 802.0, 860.0, 905.0].map(fruit);
    let found: Vec<_> = all
        .iter()
        .map(|taps| persistent(taps, options.agreement))
        .collect();
    let shared = shared_frequencies(&found, options.agreement);
    assert_eq!(shared.len(), 1);
    assert!((shared[0] - 430.0).abs() < 1e-9);
    let decision = decide(&all[2], &shared);
    assert!((frequency(&decision) - 802.0).abs() < 1e-9);
    assert_eq!(refused(&decision), [(430.0, Rejection::Shared)]);
    // Three fruit may agree by chance.
    assert!(shared_frequencies(&found[..3], options.agreement).is_empty());
}

#[test]
fn closed_form_what_the_quiet_shows_is_no_fruit() {
    let mut all = taps(&[&[(430.0, 40.0, 0.7), FRUIT]; 3]);
    for tap in &mut all {
        tap.resonances[0].in_quiet = true;
    }
    let decision = decide(&all, &[]);
    assert_eq!(refused(&decision), [(430.0, Rejection::InQuiet)]);
    assert!((frequency(&decision) - 800.0).abs() < 1e-9);
}

#[test]
fn closed_form_the_spread_between_taps_is_in_the_uncertainty() {
    // 796, 800, 804 Hz: mean 800, standard error 4/√3.
    let at = |f: f64| vec![(f, 20.0, 1.0)];
    let peaks = [at(796.0), at(800.0), at(804.0)];
    let decision = decide(&taps(&[&peaks[0], &peaks[1], &peaks[2]]), &[]);
    let found = decision.accepted.unwrap().frequency;
    assert!((found.value - 800.0).abs() < 1e-9);
    assert!((found.sd / (4.0 / 3.0_f64.sqrt()) - 1.0).abs() < 0.01);
}
