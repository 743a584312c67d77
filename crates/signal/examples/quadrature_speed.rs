//! Speed of quadrature decoding on one core:
//!
//!     cargo run --release -p windfall-signal --example quadrature_speed
//!
//! Bytes are those of the samples of both phases: one byte of a logic capture
//! holds both, volts are two `f64`. The best of several passes, from samples in
//! memory to the edges (index and count) or to a count (`i64`) at every sample, in
//! memory that is there already.

#![allow(clippy::print_stdout)]

use std::time::Instant;
use windfall_signal::encoder::quadrature::{
    DecodedEdges, IllegalTransition, decode_bytes, decode_volts, fill_counts,
};

/// Samples decoded; 64 MB as bytes, 1 GB as volts.
const SAMPLES: usize = 64_000_000;

/// Passes, of which the best counts.
const PASSES: usize = 5;

fn main() {
    println!("GB/s of phase samples, one core, {SAMPLES} samples, best of {PASSES}");
    println!("samples per edge | bytes to edges | bytes to counts | volts to edges");
    for per_edge in [1000, 50, 5] {
        let bytes = capture(per_edge);
        let volts = |bit: u8| -> Vec<f64> {
            bytes
                .iter()
                .enumerate()
                .map(|(i, byte)| f64::from(byte >> bit & 1) * 5.0 + 1e-3 * (i % 97) as f64)
                .collect()
        };
        let (a, b) = (volts(0), volts(1));
        let nothing = IllegalTransition::AddNothing;
        let edges = gigabytes(SAMPLES, || decode_bytes(&bytes, 0, 1, nothing));
        let mut room = vec![0; SAMPLES];
        let counts = gigabytes(SAMPLES, || {
            let decoded = decode_bytes(&bytes, 0, 1, nothing);
            fill_counts(&decoded, &mut room);
            std::hint::black_box(&mut room);
            decoded
        });
        let of_volts = gigabytes(16 * SAMPLES, || {
            decode_volts(("A", &a), ("B", &b), nothing).unwrap_or_default()
        });
        println!("{per_edge:16} | {edges:14.2} | {counts:15.2} | {of_volts:14.2}");
    }
}

/// Forward at `per_edge` samples a count, with a reversal in the middle.
fn capture(per_edge: usize) -> Vec<u8> {
    const STATES: [u8; 4] = [0, 1, 3, 2];
    (0..SAMPLES)
        .map(|i| STATES[(i.min(SAMPLES - i) / per_edge) % 4])
        .collect()
}

fn gigabytes(bytes: usize, mut decode: impl FnMut() -> DecodedEdges) -> f64 {
    let seconds = (0..PASSES).map(|_| {
        let begin = Instant::now();
        let decoded = std::hint::black_box(decode());
        let seconds = begin.elapsed().as_secs_f64();
        assert!(decoded.tally.illegal == 0 && decoded.samples == SAMPLES);
        seconds
    });
    bytes as f64 * 1e-9 / seconds.fold(f64::INFINITY, f64::min)
}
