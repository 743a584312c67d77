//! The likelihood with one standard deviation or correlation held.
//!
//! The columns of the term are put into an order in which the held quantity stands in
//! the first rows of a triangle: a standard deviation is the first row's only entry,
//! a correlation the direction of the second row. What remains is free.

use crate::boundary::Criterion;
use crate::evaluate::evaluate;
use crate::fit::{MixedFit, MixedMethod};
use crate::levels::{level_slopes, within_bounds};
use crate::minimise::{Sloped, descend};
use crate::slope::slopes;
use crate::theta::{Entry, blocks_of, place_of, relative_covariance, semidefinite_root};
use nalgebra::DMatrix;
use std::f64::consts::TAU;

/// Least starting value of diagonal entries: zero lies on a ridge.
const LEAST_START: f64 = 0.05;

/// Share of a level's residual deviation at which the likelihood is as without scatter.
const HARDLY: f64 = 1e-3;

/// A standard deviation or correlation of a mixed model.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum VarianceParameter {
    /// Standard deviation of a column's effect.
    Sd {
        /// Index of the term.
        term: usize,
        /// Index of its column.
        column: usize,
    },
    /// Correlation of the effects of two columns.
    Correlation {
        /// Index of the term.
        term: usize,
        /// Indices of the two columns.
        columns: [usize; 2],
    },
    /// Residual standard deviation of a level; level 0 without levels.
    ResidualSd {
        /// Index of the level.
        level: usize,
    },
}

/// What is minimised when a parameter is held.
pub(crate) struct Constrained<'a> {
    fit: &'a MixedFit,
    parameter: VarianceParameter,
    pub estimate: f64,
    /// Entries of terms whose covariance is free.
    others: Vec<Entry>,
    /// Their values at the estimate.
    others_start: Vec<f64>,
    /// The term whose parameter is held.
    held: Option<Held>,
}

/// The term whose parameter is held.
struct Held {
    factor: usize,
    /// First of its columns in the factor.
    offset: usize,
    /// Order of its columns: the held ones first.
    order: Vec<usize>,
    /// Root mean square of each ordered column, which scales its row.
    sizes: Vec<f64>,
    /// Triangle to the factor's own columns.
    basis: DMatrix<f64>,
    /// Entries (row, column) of the ordered triangle that are free.
    free: Vec<(usize, usize)>,
    /// Their scaled values at the estimate.
    start: Vec<f64>,
}

/// A point: Λ's blocks and log σ.
struct Point {
    blocks: Vec<DMatrix<f64>>,
    log_sigma: f64,
}

impl<'a> Constrained<'a> {
    pub fn of(fit: &'a MixedFit, parameter: VarianceParameter) -> Self {
        let (term, order) = match parameter {
            VarianceParameter::Sd { term, column } => (Some(term), vec![column]),
            VarianceParameter::Correlation { term, columns } => (Some(term), columns.to_vec()),
            VarianceParameter::ResidualSd { .. } => (None, Vec::new()),
        };
        let (others, others_start) = fit
            .estimate
            .entries
            .iter()
            .zip(&fit.estimate.theta)
            .filter(|(entry, _)| Some(entry.term) != term)
            .map(|(entry, value)| (*entry, at_least(*value, entry.row == entry.column)))
            .unzip();
        Self {
            fit,
            parameter,
            estimate: estimate_of(fit, parameter),
            others,
            others_start,
            held: term.map(|term| held_of(fit, term, order, parameter)),
        }
    }

    /// A name to print.
    pub(crate) fn name(&self) -> String {
        let terms = &self.fit.model.terms;
        match self.parameter {
            VarianceParameter::Sd { term, column } => {
                let given = &terms[term];
                format!("sd of {}, {}", given.column_names[column], given.name)
            }
            VarianceParameter::Correlation { term, columns } => {
                let given = &terms[term];
                let [first, second] = columns;
                let names = &given.column_names;
                format!(
                    "correlation of {} and {}, {}",
                    names[first], names[second], given.name
                )
            }
            VarianceParameter::ResidualSd { level } => match &self.fit.model.levels {
                None => "residual sd".to_owned(),
                Some(levels) => format!("residual sd of {}", levels.names[level]),
            },
        }
    }

    /// A standard deviation of this parameter that is small but visible.
    pub(crate) fn size(&self) -> f64 {
        let size = self.held.as_ref().map_or(1.0, |held| held.sizes[0]);
        0.1 * self.fit.residual_sd / size
    }

    /// The least value at which the likelihood is evaluated. Below it, a level's standard
    /// deviation is as good as zero.
    pub(crate) fn least(&self) -> f64 {
        match self.parameter {
            VarianceParameter::Correlation { .. } => -1.0,
            VarianceParameter::ResidualSd { .. } if self.fit.model.free_levels() > 0 => {
                HARDLY * self.estimate
            }
            _ => 0.0,
        }
    }

    /// Least -2 log likelihood with the parameter at this value.
    pub(crate) fn minimum(&self, value: f64) -> Option<f64> {
        let value = value.max(self.least());
        // Variances beside a held one stay as they are, not the ratios to it.
        let moved = match self.parameter {
            VarianceParameter::ResidualSd { level: 0 } if self.fit.model.free_levels() > 0 => {
                self.estimate / value
            }
            _ => 1.0,
        };
        let mut start = vec![self.fit.residual_sd.ln()];
        start.extend(self.others_start.iter().map(|own| own * moved));
        if let Some(held) = &self.held {
            start.extend(&held.start);
        }
        start.resize(start.len() + self.fit.model.free_levels(), 2.0 * moved.ln());
        let objective = |point: &[f64]| self.deviance(value, point);
        descend(&objective, start).map(|(found, _)| found.value)
    }

    /// -2 log likelihood and its gradient by log σ, other entries, held term's entries,
    /// logarithms of the residual variances of levels.
    fn deviance(&self, value: f64, free: &[f64]) -> Sloped {
        let levels = self.fit.model.free_levels();
        let (free, logs) = free.split_at(free.len() - levels);
        let mut logs = logs.to_vec();
        let held_level = match self.parameter {
            VarianceParameter::ResidualSd { level } => level.checked_sub(1),
            _ => None,
        };
        if let Some(place) = held_level {
            logs[place] = 2.0 * (value.ln() - free[0]) - self.fit.level_ratios()[place + 1].ln();
        }
        if !within_bounds(&logs) {
            return None;
        }
        let model = &*self.fit.model.at_levels(&logs);
        let point = self.point(value, free);
        let state = evaluate(model, &point.blocks)?;
        let variance = (2.0 * point.log_sigma).exp();
        let criterion = Criterion::of_model(model, self.fit.method == MixedMethod::Reml);
        let n = criterion.denominator;
        let mut deviance = state.log_v - criterion.log_weights
            + n * (TAU * variance).ln()
            + state.squares / variance;
        let (slopes, projections) = slopes(model, &state);
        let mut by_block: Vec<DMatrix<f64>> = slopes
            .log_v
            .iter()
            .zip(&slopes.squares)
            .map(|(log_v, squares)| log_v + squares / variance)
            .collect();
        if criterion.restricted {
            deviance += state.log_fixed + criterion.log_basis;
            by_block
                .iter_mut()
                .zip(&slopes.log_fixed)
                .for_each(|(sum, slope)| *sum += slope);
        }
        let mut gradient = vec![2.0 * n - 2.0 * state.squares / variance];
        gradient.extend(
            self.others
                .iter()
                .map(|e| by_block[e.factor][(e.row, e.column)]),
        );
        if let Some(held) = &self.held {
            let triangle = held.slope(&by_block[held.factor]);
            gradient.extend(held.free.iter().map(|place| triangle[*place]));
            match self.parameter {
                VarianceParameter::Sd { .. } => {
                    let entry = value * held.sizes[0] / point.log_sigma.exp();
                    gradient[0] -= triangle[(0, 0)] * entry;
                }
                VarianceParameter::Correlation { .. } => {
                    let place = held.free.iter().position(|place| *place == (1, 1))?;
                    let other = (1.0 - value * value).max(0.0).sqrt();
                    gradient[1 + self.others.len() + place] =
                        value * triangle[(1, 0)] + other * triangle[(1, 1)];
                }
                VarianceParameter::ResidualSd { .. } => {}
            }
        }
        let by_level = level_slopes(model, &state, &projections)?;
        gradient.extend(by_level.deviance(criterion.restricted, variance));
        match held_level {
            // The ratio to the first level follows from σ.
            Some(place) => {
                let own = gradient.len() - levels + place;
                gradient[0] -= 2.0 * gradient[own];
                gradient[own] = 0.0;
            }
            None if matches!(self.parameter, VarianceParameter::ResidualSd { .. }) => {
                gradient[0] = 0.0;
            }
            None => {}
        }
        deviance.is_finite().then_some((deviance, gradient))
    }

    fn point(&self, value: f64, free: &[f64]) -> Point {
        let log_sigma = match self.parameter {
            VarianceParameter::ResidualSd { level: 0 } => {
                value.max(f64::MIN_POSITIVE).ln() - 0.5 * self.fit.level_ratios()[0].ln()
            }
            _ => free[0],
        };
        let (others, held_values) = free[1..].split_at(self.others.len());
        let mut blocks = blocks_of(&self.fit.model, &self.others, others);
        if let Some(held) = &self.held {
            let q = held.order.len();
            let mut triangle = DMatrix::zeros(q, q);
            for (place, value) in held.free.iter().zip(held_values) {
                triangle[*place] = *value;
            }
            match self.parameter {
                VarianceParameter::Sd { .. } => {
                    triangle[(0, 0)] = value * held.sizes[0] / log_sigma.exp();
                }
                VarianceParameter::Correlation { .. } => {
                    let length = triangle[(1, 1)];
                    triangle[(1, 0)] = length * value;
                    triangle[(1, 1)] = length * (1.0 - value * value).max(0.0).sqrt();
                }
                VarianceParameter::ResidualSd { .. } => {}
            }
            held.put(&triangle, &mut blocks[held.factor]);
        }
        Point { blocks, log_sigma }
    }
}

impl Held {
    /// Writes the ordered triangle into the factor's block.
    fn put(&self, triangle: &DMatrix<f64>, block: &mut DMatrix<f64>) {
        let q = self.order.len();
        let mut root = DMatrix::zeros(q, q);
        for (row, column) in self.order.iter().enumerate() {
            root.row_mut(*column)
                .copy_from(&(triangle.row(row) / self.sizes[row]));
        }
        block
            .view_mut((self.offset, self.offset), (q, q))
            .copy_from(&(&self.basis * root));
    }

    /// Derivative by the ordered triangle, of that by the factor's block.
    fn slope(&self, block: &DMatrix<f64>) -> DMatrix<f64> {
        let q = self.order.len();
        let part = block.view((self.offset, self.offset), (q, q));
        let root = self.basis.tr_mul(&part);
        DMatrix::from_fn(q, q, |row, k| root[(self.order[row], k)] / self.sizes[row])
    }
}

fn at_least(value: f64, diagonal: bool) -> f64 {
    if diagonal {
        value.max(LEAST_START)
    } else {
        value
    }
}

fn estimate_of(fit: &MixedFit, parameter: VarianceParameter) -> f64 {
    match parameter {
        VarianceParameter::Sd { term, column } => fit.variances[term].sds[column],
        VarianceParameter::Correlation { term, columns } => {
            fit.variances[term].correlations[(columns[0], columns[1])]
        }
        VarianceParameter::ResidualSd { level } => {
            fit.residual_sd * fit.level_ratios()[level].sqrt()
        }
    }
}

fn held_of(
    fit: &MixedFit,
    term: usize,
    mut order: Vec<usize>,
    parameter: VarianceParameter,
) -> Held {
    let model = &fit.model;
    let given = &model.terms[term];
    let (factor, place) = place_of(model, term);
    let q = place.width;
    order.extend((0..q).filter(|k| !order.contains(k)).collect::<Vec<_>>());
    let rows = model.rows() as f64;
    let size = |k: &usize| (given.columns[*k].iter().map(|z| z * z).sum::<f64>() / rows).sqrt();
    let sizes: Vec<f64> = order.iter().map(size).collect();
    let covariance = relative_covariance(model, &fit.state.blocks, term);
    let root = semidefinite_root(&DMatrix::from_fn(q, q, |i, j| {
        covariance[(order[i], order[j])] * sizes[i] * sizes[j]
    }));

    let entries = (0..q).flat_map(|row| (0..=row).map(move |column| (row, column)));
    let free: Vec<(usize, usize)> = entries
        .filter(|(row, column)| given.correlated || row == column)
        .filter(|place| match parameter {
            VarianceParameter::Sd { .. } => *place != (0, 0),
            VarianceParameter::Correlation { .. } => *place != (1, 0),
            VarianceParameter::ResidualSd { .. } => true,
        })
        .collect();
    let start = free.iter().map(|(row, column)| {
        let value = match parameter {
            // the second row's length, whatever its direction
            VarianceParameter::Correlation { .. } if (*row, *column) == (1, 1) => {
                root[(1, 0)].hypot(root[(1, 1)])
            }
            _ => root[(*row, *column)],
        };
        at_least(value, row == column)
    });
    let start = start.collect();
    Held {
        factor,
        offset: place.offset,
        basis: model.factors[factor]
            .basis
            .view((place.offset, place.offset), (q, q))
            .into_owned(),
        order,
        sizes,
        free,
        start,
    }
}
