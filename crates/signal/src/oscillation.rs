//! Excursions of a signal that swings to both sides: it rings after a contact, or is shaken.

use crate::contact_window::ContactWindow;
use crate::error::Times;
use crate::finding::Finding;
use std::ops::Range;

/// Excursions that follow each other within this many durations of the first are one train; 1.
const CLOSE: f64 = 3.0;

/// No later excursion of a train that rings is larger than its first by this factor; 1.
const NO_LARGER: f64 = 1.05;

/// In it, the signal swings to the other side by this part of the largest excursion after the
/// first; 1. A force in contact does not.
const OTHER_SIDE: f64 = 0.15;

/// Fewest excursions that are shaking, and the part of them after which the signal swings to
/// the other side …
const SHAKEN: usize = 3;
const MOST: f64 = 0.6;

/// … by this part of their own peak; 1.
const AS_FAR: f64 = 0.3;

/// Indices of the contacts without those that are the ringing of one before them.
pub(crate) fn without_ringing(
    channel: &str,
    windows: &[ContactWindow],
    findings: &mut Vec<Finding>,
) -> Vec<usize> {
    let mut kept = Vec::new();
    let mut next = 0;
    while next < windows.len() {
        let train = train(windows, next);
        kept.push(next);
        if train.len() > 1 && swings(&windows[train.clone()]) {
            let first = windows[train.start];
            let later = &windows[train.start + 1..train.end];
            findings.push(Finding::Ringing {
                channel: channel.to_owned(),
                time: first.onset,
                swings: later.len(),
                until: windows[train.end - 1].end,
                share: largest(later) / first.peak,
            });
            next = train.end;
        } else {
            next += 1;
        }
    }
    kept
}

/// A contact and the excursions that follow it closely without outgrowing it.
fn train(windows: &[ContactWindow], start: usize) -> Range<usize> {
    let first = windows[start];
    let near = CLOSE * (first.end - first.onset);
    let follows = |pair: &&[ContactWindow]| {
        pair[1].onset - pair[0].end < near && pair[1].peak <= NO_LARGER * first.peak
    };
    let later = windows[start..].windows(2).take_while(follows).count();
    start..start + later + 1
}

/// Whether the signal swings to the other side in a train.
fn swings(train: &[ContactWindow]) -> bool {
    let lowest = train.iter().map(|w| w.low_after).fold(0.0, f64::min);
    -lowest >= OTHER_SIDE * largest(&train[1..])
}

fn largest(windows: &[ContactWindow]) -> f64 {
    windows.iter().map(|w| w.peak).fold(0.0, f64::max)
}

/// Excursions, ringing apart, after most of which the signal swings to the other side: the
/// sensor is moved to and fro, and none of them needs to be a contact.
pub(crate) fn shaking(
    channel: &str,
    windows: &[ContactWindow],
    candidates: &[usize],
) -> Option<Finding> {
    let far = |i: &&usize| -windows[**i].low_after >= AS_FAR * windows[**i].peak;
    let swinging = candidates.iter().filter(far).count();
    let shaken = candidates.len() >= SHAKEN && swinging as f64 >= MOST * candidates.len() as f64;
    shaken.then(|| Finding::Shaking {
        channel: channel.to_owned(),
        swings: candidates.len(),
        times: Times(candidates.iter().map(|&i| windows[i].onset).collect()),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn window(onset: f64, end: f64, peak: f64, low_after: f64) -> ContactWindow {
        ContactWindow {
            onset,
            end,
            peak,
            low_after,
            onset_seen: true,
            end_seen: true,
        }
    }

    /// A shock of 1 ms and swings of 2 ms period that lose a tenth each time.
    fn rings(count: i32) -> Vec<ContactWindow> {
        let swing = |i: i32| {
            let (begin, size) = (2e-3 * f64::from(i), 0.9f64.powi(i));
            window(begin, begin + 1e-3, size, -0.95 * size)
        };
        (0..count).map(swing).collect()
    }

    #[test]
    fn closed_form_a_decaying_oscillation_is_one_contact() {
        let mut findings = Vec::new();
        assert_eq!(without_ringing("a", &rings(20), &mut findings), [0]);
        let Finding::Ringing { swings, share, .. } = &findings[0] else {
            panic!("{findings:?}")
        };
        assert_eq!((findings.len(), *swings), (1, 19));
        assert!((share - 0.9).abs() < 1e-12);
    }

    #[test]
    fn closed_form_bounces_and_double_hits_do_not_ring() {
        let mut findings = Vec::new();
        // Four bounces, each half as high, on a zero that is a little off.
        let bounce = |i: i32| {
            let begin = f64::from(i);
            window(begin, begin + 0.2, 0.5f64.powi(i), -0.02)
        };
        let bounces: Vec<ContactWindow> = (0..4).map(bounce).collect();
        assert_eq!(without_ringing("F", &bounces, &mut findings), [0, 1, 2, 3]);
        // Two hits close together, without a swing to the other side.
        let double = [window(0.0, 1.0, 10.0, -0.1), window(1.5, 2.5, 8.0, -0.1)];
        assert_eq!(without_ringing("F", &double, &mut findings), [0, 1]);
        // A knock before a contact that is larger.
        let knock = [window(0.0, 1.0, 1.0, -0.5), window(1.5, 2.5, 8.0, -0.1)];
        assert_eq!(without_ringing("F", &knock, &mut findings), [0, 1]);
        assert!(findings.is_empty());
    }

    #[test]
    fn closed_form_to_and_fro_is_shaking() {
        let push = |i: i32| {
            let begin = f64::from(i);
            window(begin, begin + 0.1, 1.0 + 0.2 * f64::from(i % 3), -0.9)
        };
        let pushes: Vec<ContactWindow> = (0..8).map(push).collect();
        let all: Vec<usize> = (0..8).collect();
        assert!(shaking("a", &pushes, &all).is_some());
        let bounces: Vec<ContactWindow> = (0..8)
            .map(|i| ContactWindow {
                low_after: -0.05,
                ..push(i)
            })
            .collect();
        assert_eq!(shaking("a", &bounces, &all), None);
    }
}
