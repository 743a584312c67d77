//! Latin hypercubes whose nearest points are far apart.

use crate::error::DesignError;
use crate::finding::DesignFinding;
use crate::kind::{Design, Factor, Point, check_factors, check_numbers, check_runs, design_of};
use crate::random::{below, generator, shuffle};
use rand_chacha::ChaCha8Rng;

/// Most runs whose distances are improved; more are left as drawn.
pub const MOST_IMPROVED: usize = 2000;

/// Work of the search: distances looked at over all starts.
const WORK: usize = 20_000_000;

/// Stream of the seed.
const STREAM: u64 = 2;

/// A Latin hypercube in whole steps: `cells[factor][run]` from 0 below the runs.
type Cells = Vec<Vec<i32>>;

/// A Latin hypercube: every factor has as many evenly spaced levels as there
/// are runs, each used once; among those tried the one with the largest least
/// distance between two points.
///
/// Levels are the centres of equal cells: (2i + 1)/n − 1. Two levels of one
/// factor are exchanged as long as that lowers Σ d⁻²⁰ over all pairs, from as
/// many random starts as the work allows.
///
/// # Errors
/// No factor, categories, fewer than 2 runs or too many.
///
/// # Source
/// McKay, Beckman and Conover (1979), Technometrics 21, 239-245; Morris and
/// Mitchell (1995), Journal of Statistical Planning and Inference 43, 381-402,
/// for the criterion.
pub fn latin_hypercube(
    factors: Vec<Factor>,
    runs: usize,
    seed: u64,
) -> Result<Design, DesignError> {
    check_factors("Latin hypercube", &factors, 1)?;
    check_numbers("Latin hypercube", &factors)?;
    check_runs(runs as f64)?;
    if runs < 2 {
        let what = "a Latin hypercube".to_owned();
        return Err(DesignError::RunsTooFew {
            runs,
            least: 2,
            what,
        });
    }
    let mut generator = generator(seed, STREAM);
    let cells = match runs <= MOST_IMPROVED {
        true => spread_cells(&mut generator, factors.len(), runs),
        false => drawn(&mut generator, factors.len(), runs),
    };
    let level = |cell: i32| (f64::from(2 * cell + 1) - runs as f64) / runs as f64;
    let points = (0..runs).map(|run| {
        let coded = cells.iter().map(|column| level(column[run])).collect();
        (Point::Space, coded)
    });
    let mut design = design_of("Latin hypercube, maximin".into(), factors, points.collect());
    if runs > MOST_IMPROVED {
        design.kind = "Latin hypercube, random".to_owned();
        design.findings.push(DesignFinding::SpreadNotImproved {
            runs,
            most: MOST_IMPROVED,
        });
    }
    Ok(design)
}

/// A random Latin hypercube.
fn drawn(generator: &mut ChaCha8Rng, factors: usize, runs: usize) -> Cells {
    (0..factors)
        .map(|_| {
            let mut column: Vec<i32> = (0..runs as i32).collect();
            shuffle(generator, &mut column);
            column
        })
        .collect()
}

/// The best of many improved starts.
fn spread_cells(generator: &mut ChaCha8Rng, factors: usize, runs: usize) -> Cells {
    let mut work = WORK;
    let mut best: Option<(i32, f64, Cells)> = None;
    while best.is_none() || work > 0 {
        let mut search = Search::of(drawn(generator, factors, runs), runs);
        search.improve(generator, &mut work);
        let (least, sum) = search.merit();
        let better = best
            .as_ref()
            .is_none_or(|(found, total, _)| least > *found || (least == *found && sum < *total));
        if better {
            best = Some((least, sum, search.cells));
        }
        // One factor has all hypercubes alike.
        if factors == 1 || runs == 2 {
            break;
        }
    }
    best.map(|(_, _, cells)| cells).unwrap_or_default()
}

/// A hypercube with the squared distances of its points.
struct Search {
    cells: Cells,
    runs: usize,
    distances: Vec<i32>,
}

impl Search {
    fn of(cells: Cells, runs: usize) -> Self {
        let mut distances = vec![0; runs * runs];
        for i in 0..runs {
            for j in 0..runs {
                let steps = cells.iter().map(|column| (column[i] - column[j]).pow(2));
                distances[i * runs + j] = steps.sum();
            }
        }
        Self {
            cells,
            runs,
            distances,
        }
    }

    /// Exchanges levels of random runs until as many exchanges as there are failed in a row.
    fn improve(&mut self, generator: &mut ChaCha8Rng, work: &mut usize) {
        let exchanges = self.cells.len() * self.runs * (self.runs - 1) / 2;
        let mut in_vain = 0;
        while in_vain < exchanges && *work > 0 {
            let column = below(generator, self.cells.len());
            let first = below(generator, self.runs);
            let second = (first + 1 + below(generator, self.runs - 1)) % self.runs;
            *work = work.saturating_sub(self.runs);
            if self.change(column, first, second) < 0.0 {
                self.exchange(column, first, second);
                in_vain = 0;
            } else {
                in_vain += 1;
            }
        }
    }

    /// How much Σ d⁻²⁰ would change, relative to the nearest pair's part.
    fn change(&self, column: usize, first: usize, second: usize) -> f64 {
        let levels = &self.cells[column];
        let mut change = 0.0;
        for other in (0..self.runs).filter(|r| *r != first && *r != second) {
            let shift = self.shift(levels, first, second, other);
            let to_first = self.distances[first * self.runs + other];
            let to_second = self.distances[second * self.runs + other];
            change += part(to_first + shift) - part(to_first);
            change += part(to_second - shift) - part(to_second);
        }
        change
    }

    /// Change of the squared distance of `first` from another run, minus that of `second`.
    fn shift(&self, levels: &[i32], first: usize, second: usize, other: usize) -> i32 {
        (levels[second] - levels[other]).pow(2) - (levels[first] - levels[other]).pow(2)
    }

    fn exchange(&mut self, column: usize, first: usize, second: usize) {
        let runs = self.runs;
        for other in (0..runs).filter(|r| *r != first && *r != second) {
            let shift = self.shift(&self.cells[column], first, second, other);
            for (run, shift) in [(first, shift), (second, -shift)] {
                self.distances[run * runs + other] += shift;
                self.distances[other * runs + run] += shift;
            }
        }
        self.cells[column].swap(first, second);
    }

    /// Least squared distance, and Σ d⁻²⁰.
    fn merit(&self) -> (i32, f64) {
        let pairs = (0..self.runs).flat_map(|i| (i + 1..self.runs).map(move |j| (i, j)));
        pairs.fold((i32::MAX, 0.0), |(least, sum), (i, j)| {
            let squared = self.distances[i * self.runs + j];
            (least.min(squared), sum + part(squared))
        })
    }
}

/// d⁻²⁰ from d².
fn part(squared: i32) -> f64 {
    f64::from(squared).powi(-10)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn factors(count: usize) -> Vec<Factor> {
        let name = |i: usize| Factor::between(&format!("x{i}"), "", 0.0, 1.0).unwrap();
        (0..count).map(name).collect()
    }

    fn squared(a: &[f64], b: &[f64]) -> f64 {
        a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum()
    }

    /// Least distance between two points, in coded units; 0 for fewer than two.
    fn least_distance(points: &[&[f64]]) -> f64 {
        let pairs = points.iter().enumerate();
        let least = pairs
            .flat_map(|(i, a)| points[i + 1..].iter().map(move |b| squared(a, b)))
            .fold(f64::INFINITY, f64::min);
        if least.is_finite() { least.sqrt() } else { 0.0 }
    }

    fn distance(count: usize, runs: usize, seed: u64) -> f64 {
        let design = latin_hypercube(factors(count), runs, seed).unwrap();
        let points: Vec<&[f64]> = design.runs.iter().map(|run| &run.coded[..]).collect();
        for factor in 0..count {
            let mut levels: Vec<f64> = points.iter().map(|point| point[factor]).collect();
            levels.sort_by(f64::total_cmp);
            for (place, level) in levels.iter().enumerate() {
                let expected = (2 * place + 1) as f64 / runs as f64 - 1.0;
                assert!((level - expected).abs() < 1e-15);
            }
        }
        least_distance(&points)
    }

    /// Whether a hypercube of two factors can have all squared distances at
    /// least `least`: all orders are searched, those too near left out early.
    fn exists(levels: &mut Vec<i32>, runs: i32, least: i32) -> bool {
        let place = levels.len() as i32;
        place == runs
            || (0..runs).any(|level| {
                let apart = (0..place).zip(levels.iter()).all(|(other, l)| {
                    (place - other).pow(2) + (level - l).pow(2) >= least && level != *l
                });
                if apart {
                    levels.push(level);
                }
                let found = apart && exists(levels, runs, least);
                if apart {
                    levels.pop();
                }
                found
            })
    }

    /// The largest least distances that any hypercube of two factors has; also
    /// in van Dam, Husslage, den Hertog and Melissen (2007), Operations Research
    /// 55, 158-169.
    #[test]
    fn reference_optimal_distances_of_two_factors() {
        let expected = [2, 2, 5, 5, 5, 8, 8, 10, 10, 10, 13];
        for (runs, squared) in (2..).zip(expected) {
            let sums = || (1..6).flat_map(|a| (1..6).map(move |b| a * a + b * b));
            let largest = sums().filter(|d| exists(&mut Vec::new(), runs, *d)).max();
            assert_eq!(largest, Some(squared), "{runs}");
            let found = distance(2, runs as usize, 1) * f64::from(runs) / 2.0;
            let found = found * found;
            assert!((found - f64::from(squared)).abs() < 1e-9, "{runs}: {found}");
        }
    }

    #[test]
    fn converges_beyond_the_best_of_random_ones() {
        let (count, runs) = (4, 25);
        let mut generator = generator(3, 0);
        let mut best: i32 = 0;
        for _ in 0..2000 {
            best = best.max(
                Search::of(drawn(&mut generator, count, runs), runs)
                    .merit()
                    .0,
            );
        }
        let found = distance(count, runs, 1) * runs as f64 / 2.0;
        assert!(
            found * found > 1.3 * f64::from(best),
            "{} {best}",
            found * found
        );
    }

    #[test]
    fn repeats_with_the_seed() {
        let make = |seed| latin_hypercube(factors(3), 9, seed).unwrap();
        assert_eq!(make(1), make(1));
        assert_ne!(make(1).runs, make(2).runs);
    }

    #[test]
    fn rejects_one_run() {
        let error = latin_hypercube(factors(3), 1, 1).unwrap_err();
        assert!(matches!(error, DesignError::RunsTooFew { least: 2, .. }));
    }
}
