//! Critical impact energy of one fruit: between two energies.

use crate::equivalence::Verdict;

/// Where the critical energy of a fruit lies: above `low` and not above `high`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EnergyInterval {
    /// Largest energy below `high` at which nothing changed, or 0; J.
    pub low: f64,
    /// Least energy at which something changed; infinite where nothing did; J.
    pub high: f64,
}

/// Interval of a fruit's critical energy, and whether a larger energy than the
/// first change left the fruit unchanged.
///
/// An undecided energy says nothing: it widens the interval. Several verdicts at
/// one energy count as changed where one of them does.
///
/// * `verdicts`: energy and verdict, in any order; J
pub fn energy_interval(verdicts: &[(f64, Verdict)]) -> (EnergyInterval, bool) {
    let of = |wanted: Verdict| {
        verdicts
            .iter()
            .filter(move |(_, v)| *v == wanted)
            .map(|(e, _)| *e)
    };
    let high = of(Verdict::Changed).fold(f64::INFINITY, f64::min);
    // Unchanged only where all verdicts at that energy agree.
    let unchanged = |energy: &f64| {
        verdicts
            .iter()
            .all(|(e, v)| e != energy || *v == Verdict::Unchanged)
    };
    let low = of(Verdict::Unchanged)
        .filter(unchanged)
        .filter(|energy| *energy < high)
        .fold(0.0, f64::max);
    let contrary = of(Verdict::Unchanged)
        .filter(unchanged)
        .any(|energy| energy > high);
    (EnergyInterval { low, high }, contrary)
}

#[cfg(test)]
mod tests {
    use super::*;
    use Verdict::{Changed, Unchanged, Undecided};

    #[test]
    fn closed_form_intervals_of_verdicts() {
        let interval = |verdicts: &[(f64, Verdict)]| {
            let (found, contrary) = energy_interval(verdicts);
            (found.low, found.high, contrary)
        };
        let inf = f64::INFINITY;
        assert_eq!(
            interval(&[(0.1, Unchanged), (0.2, Changed)]),
            (0.1, 0.2, false)
        );
        assert_eq!(
            interval(&[(0.1, Unchanged), (0.2, Undecided), (0.3, Changed)]),
            (0.1, 0.3, false)
        );
        assert_eq!(
            interval(&[(0.1, Changed), (0.2, Changed)]),
            (0.0, 0.1, false)
        );
        assert_eq!(
            interval(&[(0.1, Unchanged), (0.2, Unchanged)]),
            (0.2, inf, false)
        );
        assert_eq!(
            interval(&[(0.1, Unchanged), (0.2, Changed), (0.3, Unchanged)]),
            (0.1, 0.2, true)
        );
        assert_eq!(interval(&[(0.1, Undecided)]), (0.0, inf, false));
        // First and second repeat at one energy.
        assert_eq!(
            interval(&[
                (0.1, Unchanged),
                (0.1, Undecided),
                (0.2, Changed),
                (0.2, Unchanged)
            ]),
            (0.0, 0.2, false)
        );
    }
}
