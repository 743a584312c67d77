//! Simulated studies of one size, summed up.

use crate::outcome::{PrecisionOutcome, simulated};
use crate::question::{COVERAGE, Told};
use std::collections::BTreeMap;

/// Part of the studies that must have an interval for its mean half-width to be told.
const ENOUGH: f64 = 0.9;

/// Counts of failures with their words, mean half-width with its error, and the share of the
/// intervals that hold the truth.
///
/// * `interval`: half-width of a study's interval, and whether it holds the truth
///
/// Returns the studies that could be evaluated, and what they tell.
pub(crate) fn told_of<T>(
    found: Vec<Result<T, String>>,
    interval: impl Fn(&T) -> Option<(f64, bool)>,
) -> (Vec<T>, Told) {
    let simulations = found.len();
    let mut failures: BTreeMap<String, usize> = BTreeMap::new();
    let mut good = Vec::new();
    for own in found {
        match own {
            Ok(found) => good.push(found),
            Err(why) => *failures.entry(why).or_default() += 1,
        }
    }
    let intervals: Vec<(f64, bool)> = good.iter().filter_map(interval).collect();
    let n = intervals.len() as f64;
    let mean = intervals.iter().map(|(half, _)| half).sum::<f64>() / n;
    let squares: f64 = intervals
        .iter()
        .map(|(half, _)| (half - mean).powi(2))
        .sum();
    let holds = intervals.iter().filter(|(_, holds)| *holds).count();
    let coverage = (!intervals.is_empty()).then(|| {
        let share = simulated(holds, intervals.len());
        PrecisionOutcome {
            of: COVERAGE.to_owned(),
            value: share.value,
            se: share.se,
        }
    });
    let told = Told {
        half_width: (n >= ENOUGH * simulations as f64).then_some(mean),
        half_width_se: (intervals.len() > 1).then(|| (squares / (n - 1.0) / n).sqrt()),
        simulations: Some(simulations),
        failed: simulations - good.len(),
        failures: failures.into_iter().collect(),
        also: coverage.into_iter().collect(),
        ..Told::default()
    };
    (good, told)
}
