//! Contacts in a force: hysteresis above the noise and the remains of the ringing.

/// A stretch in contact: first sample, and the one behind the last.
pub type Segment = (usize, usize);

/// Above and below what a contact begins and ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hysteresis {
    /// Begin above; N.
    pub on: f64,
    /// End below; N.
    pub off: f64,
    /// Part of the ringing's amplitude that taking it out may leave; 1.
    pub leaves: f64,
}

/// Decaying amplitude of the support force before each sample.
///
/// * `lag`: samples by which it is late, so that a contact's own rise is not in it
/// * `decay`: of the ringing, per sample
pub fn envelope(force: &[f64], lag: usize, decay: f64) -> Vec<f64> {
    let keep = (-decay).exp();
    let mut amplitude = 0.0_f64;
    (0..force.len())
        .map(|i| {
            let late = i.checked_sub(lag).map_or(0.0, |j| force[j].abs());
            amplitude = late.max(keep * amplitude);
            amplitude
        })
        .collect()
}

/// Contacts of a contact force.
///
/// * `envelope`: amplitude of the ringing at each sample; zeros without
/// * `smallest_gap`: contacts closer than this are one; samples; `None`: a tenth
///   of the longest
pub fn segments(
    contact_force: &[f64],
    envelope: &[f64],
    hysteresis: &Hysteresis,
    smallest_gap: Option<f64>,
) -> Vec<Segment> {
    let n = contact_force.len();
    let mut found: Vec<Segment> = Vec::new();
    let mut i = 0;
    while i < n {
        let left = hysteresis.leaves * envelope[i];
        if contact_force[i] <= hysteresis.on + left {
            i += 1;
            continue;
        }
        let above = |j: &usize| contact_force[*j] > hysteresis.off + 0.5 * left;
        let before = found.last().map_or(0, |last| last.1);
        let from = (before..i).rev().take_while(above).last().unwrap_or(i);
        let over =
            |j: &usize| contact_force[*j] > hysteresis.off + 0.5 * hysteresis.leaves * envelope[*j];
        let to = i + (i..n).take_while(over).count().max(1);
        found.push((from, to));
        i = to;
    }
    let longest = found.iter().map(|s| s.1 - s.0).max().unwrap_or(0);
    let gap = smallest_gap.unwrap_or(0.1 * longest as f64);
    let mut merged: Vec<Segment> = Vec::new();
    for segment in found {
        match merged.last_mut() {
            Some(last) if ((segment.0 - last.1) as f64) < gap => last.1 = segment.1,
            _ => merged.push(segment),
        }
    }
    merged
}

#[cfg(test)]
mod tests {
    use super::*;

    const PLAIN: Hysteresis = Hysteresis {
        on: 2.0,
        off: 1.0,
        leaves: 0.0,
    };

    #[test]
    fn closed_form_hysteresis_and_gap() {
        let force = [0.0, 1.5, 3.0, 1.5, 0.5, 0.5, 1.5, 0.5, 5.0, 0.0, 2.5, 0.0];
        let flat = [0.0; 12];
        assert_eq!(
            segments(&force, &flat, &PLAIN, Some(0.0)),
            [(1, 4), (8, 9), (10, 11)]
        );
        assert_eq!(
            segments(&force, &flat, &PLAIN, Some(2.0)),
            [(1, 4), (8, 11)]
        );
    }

    #[test]
    fn closed_form_ringing_that_is_left_is_no_contact() {
        let force = [0.0, 3.0, 0.0, 3.0, 0.0];
        let ringing = [0.0, 0.0, 100.0, 100.0, 100.0];
        let leaves = Hysteresis {
            leaves: 0.05,
            ..PLAIN
        };
        assert_eq!(segments(&force, &ringing, &leaves, Some(0.0)), [(1, 2)]);
    }

    #[test]
    fn closed_form_envelope_decays() {
        let found = envelope(&[8.0, 0.0, 0.0, -1.0, 0.0], 1, 2f64.ln());
        for (found, expected) in found.iter().zip([0.0, 8.0, 4.0, 2.0, 1.0]) {
            assert!((found - expected).abs() < 1e-15);
        }
    }
}
