//! A logic analyser's capture of a rotary encoder whose speed ramps up and down.
//!
//! The data are not part of windfall (sigrok-dumps, public domain).
//! `WINDFALL_DATA` names their folder; the capture is a zip, opened by `unzip`.

#![allow(clippy::unwrap_used, clippy::print_stdout)]

use std::process::Command;
use windfall_signal::encoder::quadrature::{
    IllegalTransition, counts_at_samples, decode_bytes, decode_quadrature,
};

fn capture() -> Option<Vec<u8>> {
    let file = windfall_test_data::find("encoder/sigrok_rotary-ramp.sr")?;
    let output = Command::new("unzip")
        .arg("-p")
        .arg(&file)
        .arg("logic-1-1")
        .output();
    match output {
        Ok(output) if output.status.success() => Some(output.stdout),
        _ => {
            windfall_test_data::note("unzip");
            None
        }
    }
}

#[test]
fn reference_rotary_ramp() {
    let Some(bytes) = capture() else { return };
    assert_eq!(bytes.len(), 600_000);
    let bit = |n: u8| -> Vec<f64> { bytes.iter().map(|b| f64::from((b >> n) & 1)).collect() };
    let (a, b) = (bit(0), bit(1));
    let decoded = decode_quadrature(("A", &a), ("B", &b), IllegalTransition::AddNothing).unwrap();
    // 12,732 changes of the byte in order 0, 1, 3, 2, counted by a script of a
    // few lines that shares nothing with windfall.
    assert_eq!(decoded.counts.last(), Some(&12_732));
    assert_eq!(
        (
            decoded.tally.transitions,
            decoded.tally.illegal,
            decoded.tally.glitch_pairs
        ),
        (12_732, 0, 0)
    );
    // The bytes of the capture as they are.
    let direct = decode_bytes(&bytes, 0, 1, IllegalTransition::AddNothing);
    assert_eq!(direct.edges.len(), 12_732);
    assert!(counts_at_samples(&direct) == decoded.counts);
    // Every 60th sample: too slow for the fastest part, and this shows.
    let slow = |phase: &[f64]| phase.iter().copied().step_by(60).collect::<Vec<_>>();
    let (a, b) = (slow(&a), slow(&b));
    let decoded = decode_quadrature(("A", &a), ("B", &b), IllegalTransition::AddNothing).unwrap();
    assert!(decoded.tally.illegal_share() > 0.1);
}
