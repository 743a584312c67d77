//! ×4 decoding of the two phases of an incremental encoder.
//!
//! States are written BA. The order 00 → 01 → 11 → 10 → 00 (A leads B) counts
//! +1 a step, the reverse −1. If both phases change between two samples a state
//! has been missed and the direction is not known: such a transition is counted
//! and, unless asked, adds nothing.

use crate::error::Error;

/// Share of illegal transitions above which a decoding is doubtful; 1.
pub const ILLEGAL_SHARE: f64 = 1e-3;

/// Half-width of the switching band as a part of the distance between the two
/// levels; 1. A level must cross 30 % (falling) or 70 % (rising) to switch.
const HYSTERESIS: f64 = 0.2;

/// Two levels are distinct if they lie this many of their own standard
/// deviations apart; 1. Splitting one noisy level in two gives 2.6.
const DISTINCT_LEVELS: f64 = 5.0;

/// What a transition in which both phases change does to the count.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum IllegalTransition {
    /// Nothing: the displacement then misses two counts.
    #[default]
    AddNothing,
    /// Two counts in the direction of the nearest legal steps on both sides, if
    /// these agree; nothing otherwise.
    FollowDirection,
}

/// Counts, one per sample, and how well they were found.
#[derive(Clone, Debug, PartialEq)]
pub struct Decoded {
    /// Count at each sample, 0 at the first.
    pub counts: Vec<i64>,
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

impl Decoded {
    /// Illegal over all transitions; 1.
    #[must_use]
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
    if a.1.len() != b.1.len() {
        return Err(Error::PhasesNotTogether {
            a: a.0.to_owned(),
            b: b.0.to_owned(),
        });
    }
    let high_a = logic_levels(a.0, a.1)?;
    let high_b = logic_levels(b.0, b.1)?;
    let steps: Vec<i8> = (1..high_a.len())
        .map(|i| {
            step(
                place(high_a[i - 1], high_b[i - 1]),
                place(high_a[i], high_b[i]),
            )
        })
        .collect();
    Ok(count_steps(&steps, illegal))
}

/// Position of a state in the cycle 00, 01, 11, 10 (BA).
fn place(a: bool, b: bool) -> i8 {
    match (b, a) {
        (false, false) => 0,
        (false, true) => 1,
        (true, true) => 2,
        (true, false) => 3,
    }
}

/// −1, 0, 1, or 2 for an illegal transition.
fn step(before: i8, after: i8) -> i8 {
    match (after - before).rem_euclid(4) {
        3 => -1,
        step => step,
    }
}

fn count_steps(steps: &[i8], illegal: IllegalTransition) -> Decoded {
    let mut decoded = Decoded {
        counts: Vec::with_capacity(steps.len() + 1),
        transitions: 0,
        illegal: 0,
        first_illegal: None,
        glitch_pairs: 0,
        added: 0,
    };
    let mut count = 0;
    let mut direction = 0;
    decoded.counts.push(count);
    for (i, &step) in steps.iter().enumerate() {
        decoded.transitions += usize::from(step != 0);
        if step == 2 {
            decoded.illegal += 1;
            decoded.first_illegal.get_or_insert(i + 1);
            if illegal == IllegalTransition::FollowDirection {
                let added = 2 * agreed_direction(direction, &steps[i + 1..]);
                count += added;
                decoded.added += added.abs();
            }
        } else if step != 0 {
            let undone = steps.get(i + 1).is_some_and(|&next| next == -step);
            decoded.glitch_pairs += usize::from(undone);
            direction = i64::from(step);
            count += direction;
        }
        decoded.counts.push(count);
    }
    decoded
}

/// The direction before, if the next legal step has the same; 0 otherwise.
fn agreed_direction(before: i64, later: &[i8]) -> i64 {
    let after = later
        .iter()
        .find(|step| matches!(step, 1 | -1))
        .map_or(0, |&step| i64::from(step));
    match (before, after) {
        (0, after) => after,
        (before, 0) => before,
        (before, after) if before == after => before,
        _ => 0,
    }
}

/// High or low at each sample, with a switching band midway between the levels.
fn logic_levels(name: &str, samples: &[f64]) -> Result<Vec<bool>, Error> {
    let low = samples.iter().copied().fold(f64::INFINITY, f64::min);
    let high = samples.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let levels = two_levels(samples, low, high).ok_or_else(|| Error::PhaseLevels {
        channel: name.to_owned(),
        low,
        high,
    })?;
    let middle = 0.5 * (levels.0 + levels.1);
    let band = HYSTERESIS * (levels.1 - levels.0);
    let mut state = samples.first().is_some_and(|&first| first > middle);
    Ok(samples
        .iter()
        .map(|&sample| {
            if sample > middle + band {
                state = true;
            } else if sample < middle - band {
                state = false;
            }
            state
        })
        .collect())
}

/// Mean of the samples above and below a middle that lies midway between them.
fn two_levels(samples: &[f64], low: f64, high: f64) -> Option<(f64, f64)> {
    let mut levels = (low, high);
    let mut spread = 0.0;
    // A few rounds move the levels from the extremes to the means.
    for _ in 0..8 {
        let middle = 0.5 * (levels.0 + levels.1);
        let below = mean_and_square(samples.iter().copied().filter(|&s| s <= middle));
        let above = mean_and_square(samples.iter().copied().filter(|&s| s > middle));
        if below.0 == 0 || above.0 == 0 {
            return None;
        }
        levels = (below.1, above.1);
        let total = (below.0 + above.0) as f64;
        spread = ((below.2 + above.2) / total).sqrt();
    }
    (levels.1 - levels.0 > DISTINCT_LEVELS * spread).then_some(levels)
}

/// Number, mean and sum of squares about the mean.
fn mean_and_square(values: impl Iterator<Item = f64>) -> (usize, f64, f64) {
    values.fold((0, 0.0, 0.0), |(n, mean, square), value| {
        let n = n + 1;
        let delta = value - mean;
        let mean = mean + delta / n as f64;
        (n, mean, square + delta * (value - mean))
    })
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
        assert_eq!((decoded.transitions, decoded.illegal), (5, 0));
    }

    #[test]
    fn closed_form_illegal_transitions_are_counted_and_add_nothing() {
        // 01 → 10 skips a state while moving forward.
        let decoded = decode(&[0, 1, 2, 0, 1], IllegalTransition::AddNothing);
        assert_eq!(decoded.counts, [0, 1, 1, 2, 3]);
        assert_eq!((decoded.illegal, decoded.transitions), (1, 4));
        assert_eq!(decoded.first_illegal, Some(2));
        let decoded = decode(&[0, 1, 2, 0, 1], IllegalTransition::FollowDirection);
        assert_eq!(decoded.counts, [0, 1, 3, 4, 5]);
        assert_eq!(decoded.added, 2);
    }

    #[test]
    fn closed_form_no_direction_is_guessed_at_a_reversal() {
        // Forward, a missed state, then backward: the direction is not known.
        let decoded = decode(&[0, 1, 2, 3], IllegalTransition::FollowDirection);
        assert_eq!(decoded.counts, [0, 1, 1, 0]);
        assert_eq!(decoded.added, 0);
    }

    #[test]
    fn closed_form_glitch_pairs() {
        let decoded = decode(&[0, 1, 0, 1, 3], IllegalTransition::AddNothing);
        assert_eq!(decoded.counts, [0, 1, 0, 1, 2]);
        assert_eq!(decoded.glitch_pairs, 2);
    }

    #[test]
    fn closed_form_hysteresis_holds_the_state_near_the_middle() {
        let mut a = vec![0.0; 20];
        a.extend([2.6, 2.4, 2.6, 4.9, 2.4, 2.6, 2.4, 0.1]);
        a.extend([5.0; 20]);
        let levels = logic_levels("A", &a).unwrap();
        let high: Vec<u8> = levels[19..29].iter().map(|&h| u8::from(h)).collect();
        assert_eq!(high, [0, 0, 0, 0, 1, 1, 1, 1, 0, 1]);
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
