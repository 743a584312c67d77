//! Distribution of critical energies without a formula: Turnbull's estimate.

use crate::interval::EnergyInterval;
use windfall_signal::error::Error;

/// Steps stop when no probability moves more than this; 1.
const CONVERGED: f64 = 1e-13;

/// Most steps of self-consistency.
const MOST_STEPS: usize = 200_000;

/// An innermost interval and the share of fruit whose critical energy is in it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EnergyMass {
    /// Lower end, excluded; J.
    pub low: f64,
    /// Upper end, included; infinite for fruit that never changed; J.
    pub high: f64,
    /// Share of the fruit; 1.
    pub share: f64,
}

/// Share of fruit between energies, of largest likelihood over all
/// distributions.
///
/// The likelihood fixes shares of the innermost intervals only; where in them
/// the energies lie it cannot tell.
///
/// # Errors
/// [`Error::BadEnergyInterval`], [`Error::TooFewFruit`] with none.
///
/// # Source
/// Turnbull (1976), J. R. Stat. Soc. B 38, 290; innermost intervals of
/// half-open ones.
pub fn turnbull(intervals: &[EnergyInterval]) -> Result<Vec<EnergyMass>, Error> {
    check_intervals(intervals)?;
    let mut masses = innermost(intervals);
    let covers: Vec<Vec<usize>> = intervals
        .iter()
        .map(|each| {
            let inside = |m: &EnergyMass| m.low >= each.low && m.high <= each.high;
            (0..masses.len()).filter(|&j| inside(&masses[j])).collect()
        })
        .collect();
    for _ in 0..MOST_STEPS {
        let mut next = vec![0.0; masses.len()];
        for cover in &covers {
            let total: f64 = cover.iter().map(|&j| masses[j].share).sum();
            for &j in cover {
                next[j] += masses[j].share / total / intervals.len() as f64;
            }
        }
        let moved = masses.iter().zip(&next).map(|(m, n)| (m.share - n).abs());
        let moved = moved.fold(0.0, f64::max);
        for (mass, share) in masses.iter_mut().zip(next) {
            mass.share = share;
        }
        if moved < CONVERGED {
            break;
        }
    }
    Ok(masses)
}

/// Innermost interval in which the share of the fruit passes `probability`.
pub fn quantile_of(masses: &[EnergyMass], probability: f64) -> Option<EnergyInterval> {
    let mut sum = 0.0;
    for mass in masses {
        sum += mass.share;
        // A share reached exactly leaves the place open up to the next mass.
        if sum >= probability - 1e-9 {
            let low = mass.low;
            let beyond = masses.iter().find(|m| m.low >= mass.high && m.share > 1e-9);
            let high = match (sum <= probability + 1e-9, beyond) {
                (true, Some(next)) => next.high,
                _ => mass.high,
            };
            return Some(EnergyInterval { low, high });
        }
    }
    None
}

pub(crate) fn check_intervals(intervals: &[EnergyInterval]) -> Result<(), Error> {
    if intervals.is_empty() {
        return Err(Error::TooFewFruit { fruit: 0, least: 1 });
    }
    let good = |i: &EnergyInterval| i.low >= 0.0 && i.low.is_finite() && i.high > i.low;
    match intervals.iter().position(|interval| !good(interval)) {
        None => Ok(()),
        Some(fruit) => Err(Error::BadEnergyInterval {
            fruit,
            low: intervals[fruit].low,
            high: intervals[fruit].high,
        }),
    }
}

/// Every lower end that is followed by an upper end, with no other end between.
fn innermost(intervals: &[EnergyInterval]) -> Vec<EnergyMass> {
    // At one energy upper ends come first: (a, b] and (b, c] share nothing.
    let mut ends: Vec<(f64, bool)> = intervals
        .iter()
        .flat_map(|each| [(each.low, true), (each.high, false)])
        .collect();
    ends.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    let found: Vec<(f64, f64)> = ends
        .windows(2)
        .filter(|pair| pair[0].1 && !pair[1].1)
        .map(|pair| (pair[0].0, pair[1].0))
        .collect();
    let share = 1.0 / found.len() as f64;
    let masses = found
        .into_iter()
        .map(|(low, high)| EnergyMass { low, high, share });
    masses.collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use windfall_signal::noise::gaussian::{noise_source, uniform};

    fn intervals(ends: &[(f64, f64)]) -> Vec<EnergyInterval> {
        ends.iter()
            .map(|&(low, high)| EnergyInterval { low, high })
            .collect()
    }

    fn shares(ends: &[(f64, f64)]) -> Vec<(f64, f64, f64)> {
        let masses = turnbull(&intervals(ends)).unwrap();
        masses.iter().map(|m| (m.low, m.high, m.share)).collect()
    }

    #[test]
    fn closed_form_single_nested_and_disjoint() {
        assert_eq!(shares(&[(0.1, 0.2)]), [(0.1, 0.2, 1.0)]);
        // Nested: all agree with the innermost.
        assert_eq!(
            shares(&[(0.0, 0.9), (0.1, 0.5), (0.2, 0.3)]),
            [(0.2, 0.3, 1.0)]
        );
        let apart = shares(&[(0.1, 0.2), (0.2, 0.3), (0.2, 0.3), (0.4, f64::INFINITY)]);
        for (found, expected) in apart.iter().zip([0.25, 0.5, 0.25]) {
            assert!((found.2 - expected).abs() < 1e-9);
        }
    }

    /// (0, 2], (1, 3], (2, 4] of sizes 1, 1, 1: with shares p of (1, 2] and 1 − p
    /// of (2, 3] the likelihood is p (1)(1 − p), so p = 1/2.
    #[test]
    fn closed_form_overlapping() {
        let found = shares(&[(0.0, 2.0), (1.0, 3.0), (2.0, 4.0)]);
        assert_eq!(found.len(), 2);
        assert!(
            found.iter().all(|each| (each.2 - 0.5).abs() < 1e-9),
            "{found:?}"
        );
    }

    /// At the largest likelihood no share may gain: Σᵢ [j in i]/Pᵢ ≤ n, with
    /// equality where there is a share (Karush, Kuhn and Tucker); the likelihood
    /// is concave, so this is enough.
    #[test]
    fn closed_form_optimality_of_random_intervals() {
        let mut source = noise_source(5, 0);
        for _ in 0..20 {
            let all: Vec<EnergyInterval> = (0..25)
                .map(|_| {
                    let low = (10.0 * uniform(&mut source)).floor();
                    let high = low + 1.0 + (6.0 * uniform(&mut source)).floor();
                    EnergyInterval {
                        low,
                        high: if high > 11.0 { f64::INFINITY } else { high },
                    }
                })
                .collect();
            let masses = turnbull(&all).unwrap();
            assert!((masses.iter().map(|m| m.share).sum::<f64>() - 1.0).abs() < 1e-9);
            let inside = |m: &EnergyMass, i: &EnergyInterval| m.low >= i.low && m.high <= i.high;
            let probability = |i: &EnergyInterval| {
                masses
                    .iter()
                    .filter(|m| inside(m, i))
                    .map(|m| m.share)
                    .sum::<f64>()
            };
            for mass in &masses {
                let gain: f64 = all
                    .iter()
                    .filter(|i| inside(mass, i))
                    .map(|i| 1.0 / probability(i))
                    .sum();
                let gain = gain / all.len() as f64;
                assert!(gain < 1.0 + 1e-4, "{mass:?}: {gain}");
                assert!(mass.share < 1e-3 || gain > 1.0 - 1e-4, "{mass:?}: {gain}");
            }
        }
    }

    #[test]
    fn rejects_intervals_that_are_none() {
        let message = turnbull(&intervals(&[(0.1, 0.2), (0.3, 0.3)]))
            .unwrap_err()
            .to_string();
        assert!(
            message.contains("fruit 1") && message.contains("0.3"),
            "{message}"
        );
        assert!(turnbull(&[]).is_err());
    }
}
