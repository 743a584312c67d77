//! Decoding under any motion that an encoder can follow, and with any glitches.

#![allow(clippy::unwrap_used)]

use proptest::prelude::*;
use windfall_signal::encoder::quadrature::{
    Decoded, IllegalTransition, counts_at_samples, decode_bytes, decode_quadrature,
};

/// State (bit 0: A, bit 1: B) at a count, by the table 00 → 01 → 11 → 10.
fn state(count: i64) -> u8 {
    [0, 1, 3, 2][count.rem_euclid(4) as usize]
}

fn bytes_of(counts: &[i64]) -> Vec<u8> {
    counts.iter().map(|&count| state(count)).collect()
}

/// Both ways of decoding, which must agree; volts with noise within the levels.
fn decode(bytes: &[u8], illegal: IllegalTransition) -> Decoded {
    let volts = |bit: u8| -> Vec<f64> {
        let level = |i: usize, byte: &u8| {
            let noise = 0.6 * ((i * 7919 % 1000) as f64 / 1000.0 - 0.5);
            5.0 * f64::from(byte >> bit & 1) + noise
        };
        bytes.iter().enumerate().map(|(i, b)| level(i, b)).collect()
    };
    let decoded = decode_quadrature(("A", &volts(0)), ("B", &volts(1)), illegal).unwrap();
    let edges = decode_bytes(bytes, 0, 1, illegal);
    assert_eq!(counts_at_samples(&edges), decoded.counts);
    assert_eq!(edges.tally.glitch_pairs, decoded.tally.glitch_pairs);
    assert_eq!(edges.tally.illegal, decoded.tally.illegal);
    decoded
}

/// Counts of a motion with at most one count per sample, which passes through
/// all four states, so that both levels of both phases are seen.
fn motion() -> impl Strategy<Value = Vec<i64>> {
    prop::collection::vec((-1i64..=1, 1usize..40), 1..120).prop_map(|stretches| {
        let mut counts: Vec<i64> = vec![0, 1, 2, 3, 4, 4];
        for (step, length) in stretches {
            for _ in 0..length {
                counts.push(counts[counts.len() - 1] + step);
            }
        }
        counts
    })
}

/// A speed in counts per sample, swept through any amplitude and frequency.
fn swing() -> impl Strategy<Value = Vec<i64>> {
    (2.0..300.0f64, 0.05..1.0f64, 0.0..6.3f64).prop_map(|(amplitude, speed, phase)| {
        let position = |i: usize| amplitude * (speed / amplitude * i as f64 + phase).sin();
        let counts = (0..5000).map(|i| position(i).floor() as i64);
        let mut all = vec![0, 1, 2, 3, 4];
        let counts: Vec<i64> = counts.collect();
        // Walk from 4 to where the swing begins.
        while all[all.len() - 1] != counts[0] {
            let last = all[all.len() - 1];
            all.push(last + (counts[0] - last).signum());
        }
        all.extend(counts);
        all
    })
}

proptest! {
    // A failure prints its input; nothing is written beside the sources.
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn conserves_any_motion_below_one_count_per_sample(counts in motion()) {
        let decoded = decode(&bytes_of(&counts), IllegalTransition::AddNothing);
        prop_assert_eq!(&decoded.counts, &counts);
        prop_assert_eq!(decoded.tally.illegal, 0);
        let moves = counts.windows(2).filter(|c| c[0] != c[1]).count();
        prop_assert_eq!(decoded.tally.transitions, moves);
    }

    #[test]
    fn conserves_any_swing_below_the_speed_limit(counts in swing()) {
        let decoded = decode(&bytes_of(&counts), IllegalTransition::AddNothing);
        prop_assert_eq!(&decoded.counts, &counts);
        prop_assert_eq!(decoded.tally.illegal, 0);
    }

    // One phase flips for one sample while the encoder rests: a pair of steps
    // that cancel. Every one is counted and the count after it is right.
    #[test]
    fn conserves_the_count_over_glitch_pairs(
        gaps in prop::collection::vec((4usize..90, 0u8..2, any::<bool>()), 1..80)
    ) {
        let mut counts = vec![0, 1, 2, 3, 4];
        let mut flips = Vec::new();
        for &(gap, phase, forward) in &gaps {
            let last = counts[counts.len() - 1];
            counts.extend(std::iter::repeat_n(last, gap));
            flips.push((counts.len() - 3, phase));
            counts.push(if forward { last + 1 } else { last - 1 });
            counts.extend(std::iter::repeat_n(counts[counts.len() - 1], 2));
        }
        let mut bytes = bytes_of(&counts);
        for &(at, phase) in &flips {
            bytes[at] ^= 1 << phase;
        }
        let decoded = decode(&bytes, IllegalTransition::AddNothing);
        prop_assert_eq!(decoded.tally.glitch_pairs, flips.len());
        prop_assert_eq!(decoded.tally.illegal, 0);
        for (i, (found, truth)) in decoded.counts.iter().zip(&counts).enumerate() {
            let glitch = flips.iter().any(|&(at, _)| at == i);
            prop_assert_eq!((found - truth).abs(), i64::from(glitch));
        }
    }

    // A state is missed while moving steadily: every jump of two is counted, and
    // made good if asked.
    #[test]
    fn conserves_the_number_of_skipped_states(
        gaps in prop::collection::vec(2usize..90, 1..80), forward in any::<bool>()
    ) {
        let step = if forward { 1 } else { -1 };
        let mut counts: Vec<i64> = vec![0, step, 2 * step, 3 * step];
        for &gap in &gaps {
            for _ in 0..gap {
                counts.push(counts[counts.len() - 1] + step);
            }
            counts.push(counts[counts.len() - 1] + 2 * step);
        }
        counts.push(counts[counts.len() - 1] + step);
        let bytes = bytes_of(&counts);
        let plain = decode(&bytes, IllegalTransition::AddNothing);
        prop_assert_eq!(plain.tally.illegal, gaps.len());
        let lost = counts[counts.len() - 1] - plain.counts[counts.len() - 1];
        prop_assert_eq!(lost, 2 * step * gaps.len() as i64);
        let repaired = decode(&bytes, IllegalTransition::FollowDirection);
        prop_assert_eq!(&repaired.counts, &counts);
        prop_assert_eq!(repaired.tally.added, 2 * gaps.len() as i64);
    }
}
