//! ×4 decoding of the two phases of an incremental encoder.
//!
//! States are written BA. The order 00 → 01 → 11 → 10 → 00 (A leads B) counts
//! +1 a step, the reverse −1. If both phases change between two samples a state
//! has been missed and the direction is not known: such a transition is counted
//! and, unless asked, adds nothing.

use crate::encoder::phase_bits::{PhaseBits, phase_of_bytes, phase_of_volts};
use crate::error::Error;
use serde::Serialize;

/// Share of illegal transitions above which a decoding is doubtful; 1.
pub const ILLEGAL_SHARE: f64 = 1e-3;

/// What a transition in which both phases change does to the count.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum IllegalTransition {
    /// Nothing: the displacement then misses two counts.
    #[default]
    AddNothing,
    /// Adds two counts in the direction of the neighbouring steps, if these agree.
    FollowDirection,
}

/// A sample at which the count changes, or at which both phases do.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CountEdge {
    /// Index of the first sample with the new count.
    pub sample: usize,
    /// The new count.
    pub count: i64,
}

/// How a decoding went.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Tally {
    /// Samples in which the state changed, legal or not.
    pub transitions: usize,
    /// Samples in which both phases changed.
    pub illegal: usize,
    /// Index of the first of these.
    pub first_illegal: Option<usize>,
    /// A step immediately undone by the next sample: noise at an edge.
    pub glitch_pairs: usize,
    /// Counts added for illegal transitions, whatever their sign.
    pub added: i64,
}

/// The edges of a decoding: all that a count at every sample says, in less room.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct DecodedEdges {
    /// Samples decoded; the count at the first is 0.
    pub samples: usize,
    /// Where the state changes, in order; illegal transitions included.
    pub edges: Vec<CountEdge>,
    /// How it went.
    pub tally: Tally,
}

/// Counts, one per sample, and how well they were found.
#[derive(Clone, Debug, PartialEq)]
pub struct Decoded {
    /// Count at each sample, 0 at the first.
    pub counts: Vec<i64>,
    /// How it went.
    pub tally: Tally,
}

impl Tally {
    /// Illegal over all transitions; 1.
    pub fn illegal_share(&self) -> f64 {
        self.illegal as f64 / self.transitions.max(1) as f64
    }
}

/// Counts of an incremental encoder from its phases A and B.
///
/// * `a`, `b`: name and samples of the phases, as volts or logic levels. The two
///   levels of each are found from its samples; switching has hysteresis.
///
/// # Errors
/// [`Error::PhaseLevels`] if a phase shows no two levels,
/// [`Error::PhasesNotTogether`] if the phases differ in length.
pub fn decode_quadrature(
    a: (&str, &[f64]),
    b: (&str, &[f64]),
    illegal: IllegalTransition,
) -> Result<Decoded, Error> {
    let decoded = decode_volts(a, b, illegal)?;
    Ok(Decoded {
        counts: counts_at_samples(&decoded),
        tally: decoded.tally,
    })
}

/// Edges of the counts from phases in volts; as [`decode_quadrature`].
///
/// # Errors
/// Those of [`decode_quadrature`].
pub fn decode_volts(
    a: (&str, &[f64]),
    b: (&str, &[f64]),
    illegal: IllegalTransition,
) -> Result<DecodedEdges, Error> {
    if a.1.len() != b.1.len() {
        return Err(Error::PhasesNotTogether {
            a: a.0.to_owned(),
            b: b.0.to_owned(),
        });
    }
    let (a, b) = (phase_of_volts(a.0, a.1)?, phase_of_volts(b.0, b.1)?);
    Ok(decode_bits(&a, &b, illegal))
}

/// Edges of the counts from the bytes of a logic capture, each with both phases.
///
/// * `bit_a`, `bit_b`: which bits of a byte, 0 to 7
pub fn decode_bytes(
    bytes: &[u8],
    bit_a: u32,
    bit_b: u32,
    illegal: IllegalTransition,
) -> DecodedEdges {
    let (a, b) = (phase_of_bytes(bytes, bit_a), phase_of_bytes(bytes, bit_b));
    decode_bits(&a, &b, illegal)
}

/// The count at each sample, 0 at the first.
pub fn counts_at_samples(decoded: &DecodedEdges) -> Vec<i64> {
    let mut counts = vec![0; decoded.samples];
    fill_counts(decoded, &mut counts);
    counts
}

/// Writes the count at each sample.
pub fn fill_counts(decoded: &DecodedEdges, counts: &mut [i64]) {
    let (mut from, mut count) = (0, 0);
    for edge in &decoded.edges {
        let to = edge.sample.min(counts.len());
        counts[from..to].fill(count);
        (from, count) = (to, edge.count);
    }
    let to = decoded.samples.min(counts.len());
    if from < to {
        counts[from..to].fill(count);
    }
}

/// Edges of the counts from phases as bits, up to the shorter one.
///
/// With the old and new state as bits a, b, 64 samples at a time: a step is legal
/// if one of them changes, and counts up if (A changes) = (a ≠ b).
pub fn decode_bits(a: &PhaseBits, b: &PhaseBits, illegal: IllegalTransition) -> DecodedEdges {
    let samples = a.samples.min(b.samples);
    let (mut last_a, mut last_b) = match (a.words.first(), b.words.first()) {
        (Some(a), Some(b)) => (a & 1, b & 1),
        _ => return DecodedEdges::default(),
    };
    let mut steps = Steps::default();
    steps.edges.reserve_exact(changes(a, b));
    for (index, (&a, &b)) in a.words.iter().zip(&b.words).enumerate() {
        let first = 64 * index;
        let used = match samples.saturating_sub(first) {
            0 => break,
            64.. => u64::MAX,
            left => (1 << left) - 1,
        };
        let change_a = (a ^ (a << 1 | last_a)) & used;
        let change_b = (b ^ (b << 1 | last_b)) & used;
        (last_a, last_b) = (a >> 63, b >> 63);
        let moved = change_a | change_b;
        if moved != 0 {
            let skipped = change_a & change_b;
            let up = moved & !skipped & !(change_a ^ a ^ b);
            steps.push(first, moved, skipped, up);
        }
    }
    let mut decoded = steps.counted(illegal);
    decoded.samples = samples;
    decoded
}

/// Number of samples, at most, at which a phase changes.
fn changes(a: &PhaseBits, b: &PhaseBits) -> usize {
    let words = a.words.iter().zip(&b.words);
    words
        .map(|(a, b)| ((a ^ (a << 1)) | (b ^ (b << 1))).count_ones() as usize)
        .sum()
}

/// What happens at an edge: +1, −1, or [`SKIPPED`].
type Step = i8;

/// Both phases changed.
const SKIPPED: Step = 2;

/// Edges with their steps, before they are counted.
#[derive(Default)]
struct Steps {
    edges: Vec<CountEdge>,
    illegal: usize,
    first_illegal: Option<usize>,
    glitch_pairs: usize,
    last_up: u64,
    last_down: u64,
    last_word: usize,
    count: i64,
    /// Position among the edges and the edge of each illegal transition.
    skipped: Vec<usize>,
}

impl Steps {
    /// Steps of 64 samples from `first` on, in bits.
    fn push(&mut self, first: usize, moved: u64, skipped: u64, up: u64) {
        let down = moved & !skipped & !up;
        if first != self.last_word + 64 {
            (self.last_up, self.last_down) = (0, 0);
        }
        // A step that the next sample undoes.
        let undone = (up << 1 | self.last_up) & down | (down << 1 | self.last_down) & up;
        self.glitch_pairs += undone.count_ones() as usize;
        (self.last_up, self.last_down, self.last_word) = (up >> 63, down >> 63, first);

        let mut left = moved;
        while left != 0 {
            let bit = left.trailing_zeros();
            left &= left - 1;
            let sample = first + bit as usize;
            if skipped >> bit & 1 == 1 {
                self.illegal += 1;
                self.first_illegal.get_or_insert(sample);
                self.skipped.push(self.edges.len());
            } else {
                self.count += 2 * (up >> bit & 1) as i64 - 1;
            }
            let count = self.count;
            self.edges.push(CountEdge { sample, count });
        }
    }

    fn counted(mut self, illegal: IllegalTransition) -> DecodedEdges {
        let added = match illegal {
            IllegalTransition::AddNothing => 0,
            IllegalTransition::FollowDirection => self.add_skipped(),
        };
        let tally = Tally {
            transitions: self.edges.len(),
            illegal: self.illegal,
            first_illegal: self.first_illegal,
            glitch_pairs: self.glitch_pairs,
            added,
        };
        DecodedEdges {
            samples: 0,
            edges: self.edges,
            tally,
        }
    }

    /// Adds two counts for each illegal transition whose direction is agreed on.
    fn add_skipped(&mut self) -> i64 {
        let Some(&from) = self.skipped.first() else {
            return 0;
        };
        let steps: Vec<Step> = (0..self.edges.len()).map(|i| self.step(i)).collect();
        let mut after = vec![0; self.skipped.len()];
        let mut next = 0;
        for (slot, pair) in self.skipped.iter().enumerate().rev().map(|(k, &i)| (k, i)) {
            let end = self.skipped.get(slot + 1).copied().unwrap_or(steps.len());
            next = steps
                .get(pair + 1..end)
                .and_then(|s| s.first())
                .copied()
                .unwrap_or(next);
            after[slot] = next;
        }
        let (mut shift, mut total, mut direction, mut slot) = (0, 0, 0, 0);
        for (i, edge) in self.edges.iter_mut().enumerate() {
            if steps[i] == SKIPPED {
                let added = 2 * i64::from(agreed_direction(direction, after[slot]));
                slot += 1;
                shift += added;
                total += added.abs();
            } else {
                direction = steps[i];
            }
            if i >= from {
                edge.count += shift;
            }
        }
        total
    }

    fn step(&self, index: usize) -> Step {
        let before = index.checked_sub(1).map_or(0, |i| self.edges[i].count);
        match self.edges[index].count - before {
            1 => 1,
            -1 => -1,
            _ => SKIPPED,
        }
    }
}

/// The direction before, if that after is the same or not known; 0 if they differ.
fn agreed_direction(before: Step, after: Step) -> Step {
    match (before, after) {
        (0, after) => after,
        (before, 0) => before,
        (before, after) if before == after => before,
        _ => 0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn phases(states: &[u8]) -> (Vec<f64>, Vec<f64>) {
        let a = states.iter().map(|s| f64::from(s & 1) * 5.0).collect();
        let b = states.iter().map(|s| f64::from(s >> 1) * 5.0).collect();
        (a, b)
    }

    fn decode(states: &[u8], illegal: IllegalTransition) -> Decoded {
        let (a, b) = phases(states);
        decode_quadrature(("A", &a), ("B", &b), illegal).unwrap()
    }

    // The state table of DOMAIN.md §2.1.
    #[test]
    fn closed_form_state_table() {
        let forward = [0, 1, 3, 2, 0, 0, 1];
        let decoded = decode(&forward, IllegalTransition::AddNothing);
        assert_eq!(decoded.counts, [0, 1, 2, 3, 4, 4, 5]);
        let mut backward = forward;
        backward.reverse();
        let decoded = decode(&backward, IllegalTransition::AddNothing);
        assert_eq!(decoded.counts, [0, -1, -1, -2, -3, -4, -5]);
        assert_eq!((decoded.tally.transitions, decoded.tally.illegal), (5, 0));
    }

    #[test]
    fn closed_form_illegal_transitions_are_counted_and_add_nothing() {
        // 01 → 10 skips a state while moving forward.
        let decoded = decode(&[0, 1, 2, 0, 1], IllegalTransition::AddNothing);
        assert_eq!(decoded.counts, [0, 1, 1, 2, 3]);
        assert_eq!((decoded.tally.illegal, decoded.tally.transitions), (1, 4));
        assert_eq!(decoded.tally.first_illegal, Some(2));
        let decoded = decode(&[0, 1, 2, 0, 1], IllegalTransition::FollowDirection);
        assert_eq!(decoded.counts, [0, 1, 3, 4, 5]);
        assert_eq!(decoded.tally.added, 2);
    }

    #[test]
    fn closed_form_no_direction_is_guessed_at_a_reversal() {
        // Forward, a missed state, then backward: the direction is not known.
        let decoded = decode(&[0, 1, 2, 3], IllegalTransition::FollowDirection);
        assert_eq!(decoded.counts, [0, 1, 1, 0]);
        assert_eq!(decoded.tally.added, 0);
    }

    #[test]
    fn closed_form_glitch_pairs() {
        let decoded = decode(&[0, 1, 0, 1, 3], IllegalTransition::AddNothing);
        assert_eq!(decoded.counts, [0, 1, 0, 1, 2]);
        assert_eq!(decoded.tally.glitch_pairs, 2);
    }

    #[test]
    fn closed_form_edges_of_bytes() {
        // Phases in bits 3 and 5, and noise in bit 0; edges across words of 64.
        let mut bytes = vec![1u8; 62];
        bytes.extend([0b1001, 0b10_1000, 0b10_1001, 0b10_0000, 0]);
        let decoded = decode_bytes(&bytes, 3, 5, IllegalTransition::AddNothing);
        let edge = |sample, count| CountEdge { sample, count };
        assert_eq!(
            decoded.edges,
            [edge(62, 1), edge(63, 2), edge(65, 3), edge(66, 4)]
        );
        let mut counts = vec![0; 62];
        counts.extend([1, 2, 2, 3, 4]);
        assert_eq!(counts_at_samples(&decoded), counts);
        let nothing = decode_bytes(&[], 0, 1, IllegalTransition::AddNothing);
        assert_eq!(nothing, DecodedEdges::default());
    }

    #[test]
    fn rejects_a_phase_that_never_changes() {
        let flat = [5.0; 8];
        let (a, _) = phases(&[0, 1, 3, 2, 0, 1, 3, 2]);
        let error = decode_quadrature(("A", &a), ("B", &flat), IllegalTransition::default());
        assert_eq!(
            error.unwrap_err().to_string(),
            "phase 'B' shows no two distinct levels (samples from 5 to 5); check the wiring and the column"
        );
    }
}
