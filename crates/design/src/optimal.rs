//! Designs that are optimal for a model: D and I, new or added to runs made.

use crate::error::DesignError;
use crate::exchange::{Criterion, Exchange, Exchanged, exchange};
use crate::kind::{Design, Factor, Point, check_factors, check_runs, design_of};
use crate::model::region_points;
use crate::quality::design_quality;
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

/// Row of a model matrix at coded values.
pub type ModelRow<'a> = dyn Fn(&[f64]) -> Vec<f64> + Sync + 'a;

/// Most candidates of a list.
pub const MOST_CANDIDATES: usize = 100_000;

/// Grids up to this size are searched as a list, which ends in fewer poor optima.
const LISTED_GRID: usize = 500;

/// Most terms of a model: with more, one start takes many minutes.
pub const MOST_TERMS: usize = 250;

/// Multiplications of all starts, and passes over the runs per start.
const WORK: f64 = 1e9;
const PASSES: f64 = 10.0;

/// Where runs may lie.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Candidates<'a> {
    /// Anywhere on these coded levels of each factor.
    Levels(&'a [Vec<f64>]),
    /// At these points, as often as wanted; coded.
    Points(&'a [Vec<f64>]),
}

/// What is asked of an optimal design.
#[derive(Clone, Debug, PartialEq)]
pub struct OptimalOptions {
    /// New runs.
    pub runs: usize,
    /// What is made good.
    pub criterion: Criterion,
    /// Random starts; `None` for 2 to 1000, as many as finish in seconds.
    pub starts: Option<usize>,
    /// Their seed.
    pub seed: u64,
}

impl Default for OptimalOptions {
    fn default() -> Self {
        Self {
            runs: 0,
            criterion: Criterion::D,
            starts: None,
            seed: 1,
        }
    }
}

/// The best design of many starts for a model.
///
/// * `existing`: coded runs already made; they are kept, as block 1, and the new
///   ones are block 2
///
/// The mean variance of [`Criterion::I`] is over the region −1 … 1 for levels,
/// over the candidates for points.
///
/// # Errors
/// Fewer runs than terms, candidates that cannot tell the terms apart, points of
/// the wrong length, a model that is undefined at a point.
pub fn optimal(
    factors: Vec<Factor>,
    row: &ModelRow,
    candidates: Candidates,
    existing: &[Vec<f64>],
    options: &OptimalOptions,
) -> Result<Design, DesignError> {
    check_factors("optimal", &factors, 1)?;
    let count = factors.len();
    check_points(existing, count)?;
    check_runs((existing.len() + options.runs) as f64)?;
    let region = region_of(&factors, candidates, row)?;
    let terms = region.first().map_or(0, |(_, row)| row.len());
    if terms > MOST_TERMS {
        let most = MOST_TERMS;
        return Err(DesignError::TermsTooMany { terms, most });
    }
    if options.runs + existing.len() < terms || options.runs == 0 {
        return Err(DesignError::RunsTooFew {
            runs: options.runs + existing.len(),
            least: terms.max(existing.len() + 1),
            what: format!("a model of {terms} terms"),
        });
    }
    let kept: Vec<Vec<f64>> = existing.iter().map(|point| row(point)).collect();
    check_defined(&kept, existing)?;
    let grid = small_grid(candidates);
    let candidates = grid.as_deref().map_or(candidates, Candidates::Points);
    let points = best_points(row, candidates, &kept, &moments(&region, terms), options);
    let rows: Vec<Vec<f64>> = kept
        .into_iter()
        .chain(points.iter().map(|p| row(p)))
        .collect();
    if design_quality(&rows, &[]).is_none() {
        let runs = options.runs;
        return Err(DesignError::ModelSingular { runs, terms });
    }
    let name = match options.criterion {
        Criterion::D => "D-optimal",
        Criterion::I => "I-optimal",
    };
    Ok(arranged(name, factors, existing, points))
}

/// Existing runs as block 1, new ones after them.
fn arranged(
    name: &str,
    factors: Vec<Factor>,
    existing: &[Vec<f64>],
    points: Vec<Vec<f64>>,
) -> Design {
    let kind = match existing.len() {
        0 => name.to_owned(),
        count => format!("{name}, {count} runs augmented by {}", points.len()),
    };
    let old = existing
        .iter()
        .map(|coded| (Point::Existing, coded.clone()));
    let new = points.into_iter().map(|coded| (Point::Optimal, coded));
    let mut design = design_of(kind, factors, old.chain(new).collect());
    if !existing.is_empty() {
        for run in design.runs.iter_mut().skip(existing.len()) {
            run.block = 2;
        }
    }
    design
}

/// The best of all starts; the first of equal ones.
fn best_points(
    row: &ModelRow,
    candidates: Candidates,
    kept: &[Vec<f64>],
    moments: &DMatrix<f64>,
    options: &OptimalOptions,
) -> Vec<Vec<f64>> {
    let point = |places: &[usize]| -> Vec<f64> {
        match candidates {
            Candidates::Points(points) => points[places[0]].clone(),
            Candidates::Levels(levels) => places
                .iter()
                .zip(levels)
                .map(|(place, levels)| levels[*place])
                .collect(),
        }
    };
    let listed: Vec<Vec<f64>> = match candidates {
        Candidates::Points(points) => points.iter().map(|point| row(point)).collect(),
        Candidates::Levels(_) => Vec::new(),
    };
    let choices: Vec<usize> = match candidates {
        Candidates::Points(points) => vec![points.len()],
        Candidates::Levels(levels) => levels.iter().map(Vec::len).collect(),
    };
    let rows = |places: &[usize]| match candidates {
        Candidates::Points(_) => listed[places[0]].clone(),
        Candidates::Levels(_) => row(&point(places)),
    };
    let problem = Exchange {
        rows: &rows,
        choices: &choices,
        kept,
        runs: options.runs,
        moments,
        criterion: options.criterion,
    };
    let starts = options
        .starts
        .unwrap_or_else(|| affordable_starts(&problem));
    let starts: Vec<Exchanged> = (0..starts.max(1) as u64)
        .into_par_iter()
        .map(|start| exchange(&problem, options.seed, start))
        .collect();
    let best = starts
        .into_iter()
        .reduce(|best, next| if next.cost < best.cost { next } else { best });
    let mut points: Vec<Vec<f64>> = best
        .map(|best| best.places.iter().map(|places| point(places)).collect())
        .unwrap_or_default();
    points.sort_by(|a, b| in_order(a, b));
    points
}

/// Standard order of coded points: the last factor changes slowest, as in a factorial.
pub(crate) fn in_order(a: &[f64], b: &[f64]) -> std::cmp::Ordering {
    let pairs = a.iter().rev().zip(b.iter().rev());
    pairs
        .map(|(a, b)| a.total_cmp(b))
        .find(|order| order.is_ne())
        .unwrap_or(std::cmp::Ordering::Equal)
}

/// Starts that take [`WORK`].
fn affordable_starts(problem: &Exchange) -> usize {
    let alternatives: usize = problem.choices.iter().sum();
    let terms = problem.moments.nrows();
    // Every replacement inverts X'X anew.
    let replacements = problem.choices.len() * terms;
    let step = ((alternatives + replacements) * terms * terms) as f64;
    let start = PASSES * problem.runs as f64 * step;
    ((WORK / start) as usize).clamp(2, 1000)
}

/// All points of a grid, if they are few.
fn small_grid(candidates: Candidates) -> Option<Vec<Vec<f64>>> {
    let Candidates::Levels(levels) = candidates else {
        return None;
    };
    let size: f64 = levels.iter().map(|levels| levels.len() as f64).product();
    let all = (size <= LISTED_GRID as f64).then(|| vec![Vec::new()])?;
    Some(levels.iter().fold(all, |points, levels| {
        let longer = points.iter().flat_map(|point| {
            levels.iter().map(move |level| {
                let mut longer: Vec<f64> = point.clone();
                longer.push(*level);
                longer
            })
        });
        longer.collect()
    }))
}

/// Weights and model rows of the region.
fn region_of(
    factors: &[Factor],
    candidates: Candidates,
    row: &ModelRow,
) -> Result<Vec<(f64, Vec<f64>)>, DesignError> {
    let weighted: Vec<(f64, Vec<f64>)> = match candidates {
        Candidates::Points(points) => {
            check_points(points, factors.len())?;
            if points.is_empty() || points.len() > MOST_CANDIDATES {
                return Err(DesignError::CandidateCount {
                    found: points.len(),
                    most: MOST_CANDIDATES,
                });
            }
            let weight = 1.0 / points.len() as f64;
            points.iter().map(|point| (weight, point.clone())).collect()
        }
        Candidates::Levels(levels) => {
            check_levels(factors, levels)?;
            region_points(factors)
        }
    };
    let (weights, points): (Vec<f64>, Vec<Vec<f64>>) = weighted.into_iter().unzip();
    let rows: Vec<Vec<f64>> = points.iter().map(|point| row(point)).collect();
    check_defined(&rows, &points)?;
    Ok(weights.into_iter().zip(rows).collect())
}

/// Mean of row · rowᵀ.
pub(crate) fn moments(region: &[(f64, Vec<f64>)], terms: usize) -> DMatrix<f64> {
    let mut moments = DMatrix::zeros(terms, terms);
    for (weight, row) in region {
        let row = DVector::from_column_slice(row);
        moments.ger(*weight, &row, &row, 1.0);
    }
    moments
}

pub(crate) fn check_levels(factors: &[Factor], levels: &[Vec<f64>]) -> Result<(), DesignError> {
    if levels.len() != factors.len() {
        return Err(DesignError::PointLength {
            point: 1,
            found: levels.len(),
            expected: factors.len(),
        });
    }
    match factors
        .iter()
        .zip(levels)
        .find(|(_, levels)| levels.len() < 2)
    {
        Some((factor, levels)) => Err(DesignError::LevelsTooFew {
            name: factor.name.clone(),
            found: levels.len(),
        }),
        None => Ok(()),
    }
}

fn check_points(points: &[Vec<f64>], expected: usize) -> Result<(), DesignError> {
    match points.iter().position(|point| point.len() != expected) {
        Some(place) => Err(DesignError::PointLength {
            point: place + 1,
            found: points[place].len(),
            expected,
        }),
        None => Ok(()),
    }
}

pub(crate) fn check_defined(rows: &[Vec<f64>], points: &[Vec<f64>]) -> Result<(), DesignError> {
    let undefined = |row: &Vec<f64>| row.iter().any(|value| !value.is_finite());
    match rows.iter().position(undefined) {
        Some(place) => Err(DesignError::ModelUndefined {
            point: points[place].clone(),
        }),
        None => Ok(()),
    }
}
