//! The profiled criterion, its minimum, and whether that lies on the boundary.

use crate::evaluate::{State, evaluate};
use crate::levels::{level_slopes, within_bounds};
use crate::minimise::{Minimum, Sloped, minimise};
use crate::model::MixedModel;
use crate::slope::slopes;
use crate::theta::{Entry, blocks_of, entries_from, entries_of, semidefinite_root, start_of};
use std::f64::consts::TAU;

/// Diagonal entries below this are tried at zero; parts of the residual deviation.
const NEAR_ZERO: f64 = 0.05;

/// Tolerance of the criterion at zero, absolute and relative.
const SAME: (f64, f64) = (1e-9, 1e-12);

/// The profiled criterion: -2 log likelihood at the best coefficients and residual variance.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Criterion {
    pub restricted: bool,
    /// n, or n - p.
    pub denominator: f64,
    /// log|X'X| of the given columns against the orthonormal ones.
    pub log_basis: f64,
    /// Sum of the logarithms of the weights.
    pub log_weights: f64,
}

impl Criterion {
    pub(crate) fn of_model(model: &MixedModel, restricted: bool) -> Self {
        let (n, p) = (model.rows() as f64, model.coefficients() as f64);
        Self {
            restricted,
            denominator: if restricted { n - p } else { n },
            log_basis: 2.0 * model.basis.r.diagonal().map(f64::ln).sum(),
            log_weights: model.weights.log_sum(),
        }
    }

    /// Value at a factorisation.
    pub(crate) fn value(&self, state: &State) -> f64 {
        let k = self.denominator;
        let restricted = if self.restricted {
            state.log_fixed + self.log_basis
        } else {
            0.0
        };
        state.log_v - self.log_weights + restricted + k * (1.0 + (TAU * state.squares / k).ln())
    }

    /// Derivatives by the free entries of Λ's blocks, then by the logarithms of the residual
    /// variances of levels; `None` where numbers overflow.
    pub(crate) fn slope(
        &self,
        model: &MixedModel,
        state: &State,
        entries: &[Entry],
    ) -> Option<Vec<f64>> {
        let (slopes, projections) = slopes(model, state);
        let weight = self.denominator / state.squares;
        let mut sum = slopes.log_v;
        for (factor, sum) in sum.iter_mut().enumerate() {
            *sum += &slopes.squares[factor] * weight;
            if self.restricted {
                *sum += &slopes.log_fixed[factor];
            }
        }
        let mut slope = entries_from(entries, &sum);
        let levels = level_slopes(model, state, &projections)?;
        slope.extend(levels.deviance(self.restricted, 1.0 / weight));
        Some(slope)
    }
}

/// The minimum.
#[derive(Clone, Debug)]
pub(crate) struct Estimate {
    /// The free entries of Λ's blocks.
    pub entries: Vec<Entry>,
    /// Their values.
    pub theta: Vec<f64>,
    /// Logarithms of the residual variances of levels, over those the model was prepared with.
    pub logs: Vec<f64>,
    /// Diagonal entries at zero, as places in `entries`.
    pub at_zero: Vec<usize>,
    /// The criterion.
    pub value: f64,
    pub evaluations: usize,
    /// Whether its gradient vanishes.
    pub converged: bool,
    /// Directions in which it is level.
    pub flat: usize,
}

/// Minimises the criterion, smooth at zero variances as entries may have any sign.
///
/// * `sizes`: of the effects, over σ, at which the search begins; the others where the first
///   ends on the edge
pub(crate) fn estimate(
    model: &MixedModel,
    criterion: &Criterion,
    sizes: &[f64],
) -> Option<(Estimate, State)> {
    let entries = entries_of(model);
    let (first, others) = sizes.split_first()?;
    let first = from_start(model, criterion, &entries, *first)?;
    let mut best = to_edge(model, criterion, &entries, first);
    if !best.at_zero.is_empty() || !best.converged {
        // a second basin, where there is one, is found from other starts
        for size in others {
            if let Some(other) = from_start(model, criterion, &entries, *size) {
                let other = to_edge(model, criterion, &entries, other);
                let evaluations = best.evaluations + other.evaluations;
                let lower = other.value < best.value - allowance(best.value);
                best = if lower { other } else { best };
                best.evaluations = evaluations;
            }
        }
    }
    let model = model.at_levels(&best.logs);
    let state = evaluate(&model, &blocks_of(&model, &entries, &best.theta))?;
    Some((best, state))
}

fn from_start(
    model: &MixedModel,
    criterion: &Criterion,
    entries: &[Entry],
    size: f64,
) -> Option<Minimum> {
    let mut start = start_of(entries, size);
    start.resize(entries.len() + model.free_levels(), 0.0);
    let free: Vec<usize> = (0..start.len()).collect();
    search(model, criterion, entries, &free, start)
}

/// Minimum over the `free` coordinates, others held: entries, then logarithms of the residual
/// variances of levels.
fn search(
    model: &MixedModel,
    criterion: &Criterion,
    entries: &[Entry],
    free: &[usize],
    start: Vec<f64>,
) -> Option<Minimum> {
    let whole = |point: &[f64]| {
        let mut whole = start.clone();
        let pairs = free.iter().zip(point);
        pairs.for_each(|(place, value)| whole[*place] = *value);
        whole
    };
    let objective = |point: &[f64]| -> Sloped {
        let whole = whole(point);
        let (theta, logs) = whole.split_at(entries.len());
        if !within_bounds(logs) {
            return None;
        }
        let model = model.at_levels(logs);
        let criterion = Criterion::of_model(&model, criterion.restricted);
        let state = evaluate(&model, &blocks_of(&model, entries, theta))?;
        let slope = criterion.slope(&model, &state, entries)?;
        let slope = free.iter().map(|place| slope[*place]).collect();
        Some((criterion.value(&state), slope))
    };
    let point = free.iter().map(|place| start[*place]).collect();
    let mut found = minimise(&objective, point)?;
    found.point = whole(&found.point);
    Some(found)
}

/// Keeps small diagonal entries at zero where the criterion is no higher.
fn to_edge(
    model: &MixedModel,
    criterion: &Criterion,
    entries: &[Entry],
    found: Minimum,
) -> Estimate {
    let (theta, logs) = parted(entries, found.point);
    let mut best = Estimate {
        entries: entries.to_vec(),
        theta,
        logs,
        at_zero: Vec::new(),
        value: found.value,
        evaluations: found.evaluations,
        converged: found.converged,
        flat: found.flat,
    };
    for place in (0..entries.len()).rev() {
        let entry = entries[place];
        if entry.row != entry.column || best.theta[place].abs() > NEAR_ZERO {
            continue;
        }
        let mut at_zero = best.at_zero.clone();
        at_zero.push(place);
        let held = |other: &Entry| {
            at_zero.iter().any(|zero| {
                let zero = entries[*zero];
                zero.factor == other.factor && zero.column == other.column
            })
        };
        let free: Vec<usize> = (0..entries.len()).filter(|k| !held(&entries[*k])).collect();
        let free = [
            free,
            (entries.len()..entries.len() + best.logs.len()).collect(),
        ]
        .concat();
        let mut start = without_column(model, entries, &best.theta, entry);
        start.extend(&best.logs);
        let Some(other) = search(model, criterion, entries, &free, start) else {
            continue;
        };
        best.evaluations += other.evaluations;
        if other.value <= best.value + allowance(best.value) {
            (best.theta, best.logs) = parted(entries, other.point);
            best.value = other.value;
            best.converged = other.converged;
            best.flat = other.flat;
            best.at_zero = at_zero;
        }
    }
    best
}

/// Entries, their signs as usual, and logarithms of levels.
fn parted(entries: &[Entry], mut point: Vec<f64>) -> (Vec<f64>, Vec<f64>) {
    let logs = point.split_off(entries.len());
    (with_signs(entries, point), logs)
}

fn allowance(value: f64) -> f64 {
    SAME.0 + SAME.1 * value.abs()
}

/// The same covariances with one diagonal entry at zero.
fn without_column(model: &MixedModel, entries: &[Entry], theta: &[f64], zero: Entry) -> Vec<f64> {
    let mut blocks = blocks_of(model, entries, theta);
    let block = &mut blocks[zero.factor];
    block[(zero.row, zero.column)] = 0.0;
    let root = semidefinite_root(&(&*block * block.transpose()));
    *block = root;
    entries_from(entries, &blocks)
}

/// Columns with their diagonal entry not negative.
fn with_signs(entries: &[Entry], mut theta: Vec<f64>) -> Vec<f64> {
    let turned: Vec<Entry> = entries
        .iter()
        .zip(&theta)
        .filter(|(entry, value)| entry.row == entry.column && **value < 0.0)
        .map(|(entry, _)| *entry)
        .collect();
    for (entry, value) in entries.iter().zip(&mut theta) {
        let same = |t: &&Entry| t.factor == entry.factor && t.column == entry.column;
        if turned.iter().find(same).is_some() {
            *value = -*value;
        }
    }
    theta
}
