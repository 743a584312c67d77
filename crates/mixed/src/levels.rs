//! Residual variances that differ by the level of a category.
//!
//! A row of level l has the residual variance σ² exp(δₗ), where δ of the first level is held. Rows
//! enter the model times exp(-δ/2), so that with sums over the rows of a level, e a row's
//! conditional residual, z its random columns, K = Λ(Λ'Z'ZΛ + I)⁻¹Λ' and d = x - X'V⁻¹ZΛΛ'z:
//!
//! ```text
//! ∂ log|V| / ∂δ       = -Σ z'Kz
//! ∂ log|X'V⁻¹X| / ∂δ  = -Σ d'(X'V⁻¹X)⁻¹d
//! ∂ squares / ∂δ      = -Σ e²
//! ```

use crate::basis::dot;
use crate::blocks::{fixed_square, leaf_of, trunk_of};
use crate::effects::scaled_effects;
use crate::evaluate::State;
use crate::model::MixedModel;
use crate::residual_levels::ResidualLevels;
use crate::row::{Row, RowWork};
use crate::slope::Projections;
use crate::weights::Weights;
use rayon::prelude::*;
use std::borrow::Cow;

/// Largest logarithm of a ratio of variances at which the criterion is evaluated.
const MOST_LOG: f64 = 32.0;

impl MixedModel {
    /// Logarithms of ratios of residual variances that are free: all levels' but the first's.
    pub(crate) fn free_levels(&self) -> usize {
        self.levels.as_ref().map_or(0, |own| own.names.len() - 1)
    }

    /// The model with the residual variances of levels after the first times exp(logs).
    pub(crate) fn at_levels(&self, logs: &[f64]) -> Cow<'_, Self> {
        let Some(levels) = &self.levels else {
            return Cow::Borrowed(self);
        };
        if logs.iter().all(|own| *own == 0.0) {
            return Cow::Borrowed(self);
        }
        Cow::Owned(self.with_levels(levels, &[&[0.0], logs].concat()))
    }

    /// The model with the residual variance of every level times exp(logs).
    pub(crate) fn with_levels(&self, levels: &ResidualLevels, logs: &[f64]) -> Self {
        let of_level: Vec<f64> = logs.iter().map(|log| (-0.5 * log).exp()).collect();
        let roots: Vec<f64> = levels.level.iter().map(|own| of_level[*own]).collect();
        let scale = |values: &mut [f64]| {
            let pairs = values.iter_mut().zip(&roots);
            pairs.for_each(|(value, root)| *value *= root);
        };
        let mut model = self.clone();
        scale(&mut model.y);
        scale(&mut model.residual);
        model.basis.q.iter_mut().for_each(|own| scale(own));
        for mut column in model.x.column_iter_mut() {
            let pairs = column.iter_mut().zip(&roots);
            pairs.for_each(|(value, root)| *value *= root);
        }
        let columns = model.terms.iter_mut().flat_map(|own| &mut own.columns);
        columns.for_each(|own| scale(own));
        for factor in &mut model.factors {
            let rows = factor.design.chunks_exact_mut(factor.width).zip(&roots);
            rows.for_each(|(row, root)| row.iter_mut().for_each(|value| *value *= root));
        }
        let weights = roots.iter().enumerate();
        let weights = weights.map(|(row, root)| self.weights.weight(row) * root * root);
        model.weights = Weights::of(weights);
        let mut fixed: Vec<&[f64]> = model.basis.q.iter().map(Vec::as_slice).collect();
        fixed.push(&model.residual);
        model.trunk = trunk_of(&model.factors, &fixed);
        model.leaf = leaf_of(&model.factors, &model.trunk, &fixed);
        model.fixed = fixed_square(&fixed);
        model
    }
}

/// Derivatives by the logarithm of each level's residual variance, also the first's.
#[derive(Clone, Debug)]
pub(crate) struct LevelSlopes {
    /// Rows of each level: minus the derivative of the sum of the logarithms of the weights.
    pub sizes: Vec<f64>,
    /// Of log|V| of the weighted rows.
    pub log_v: Vec<f64>,
    /// Of log|X'V⁻¹X|.
    pub log_fixed: Vec<f64>,
    /// Of the penalised squares.
    pub squares: Vec<f64>,
}

impl LevelSlopes {
    /// Derivative, at fixed σ², of -2 log likelihood by the free levels.
    pub(crate) fn deviance(&self, restricted: bool, variance: f64) -> Vec<f64> {
        let levels = 1..self.sizes.len();
        let of = |level| self.deviance_by(level, restricted, variance);
        levels.map(of).collect()
    }

    /// The same by one level.
    pub(crate) fn deviance_by(&self, level: usize, restricted: bool, variance: f64) -> f64 {
        let fixed = match restricted {
            true => self.log_fixed[level],
            false => 0.0,
        };
        self.sizes[level] + self.log_v[level] + fixed + self.squares[level] / variance
    }
}

/// Derivatives by levels; `None` where numbers overflow.
pub(crate) fn level_slopes(
    model: &MixedModel,
    state: &State,
    projections: &Projections,
) -> Option<LevelSlopes> {
    let Some(levels) = &model.levels else {
        return Some(LevelSlopes {
            sizes: vec![model.rows() as f64],
            log_v: Vec::new(),
            log_fixed: Vec::new(),
            squares: Vec::new(),
        });
    };
    let effects = scaled_effects(model, state, projections);
    let of_row = |(own, work): &mut (Row, RowWork), row: usize| {
        own.take(model, row);
        let (random, fixed) = own.variances(model, state, projections, work)?;
        let known = own.known.iter();
        let groups = known.map(|(factor, group, z)| {
            let own = effects[*factor].column(*group);
            z.iter().zip(own.iter()).map(|(z, b)| z * b).sum::<f64>()
        });
        let fitted = dot(&own.x, state.shift.as_slice()) + groups.sum::<f64>();
        Some([random, fixed, (model.residual[row] - fitted).powi(2)])
    };
    let rows = (0..model.rows()).into_par_iter();
    let rows: Option<Vec<[f64; 3]>> = rows.map_init(Default::default, of_row).collect();
    let mut sums = vec![[0.0; 3]; levels.names.len()];
    for (row, level) in rows?.iter().zip(&levels.level) {
        let pairs = sums[*level].iter_mut().zip(row);
        pairs.for_each(|(sum, own)| *sum -= own);
    }
    let part = |place: usize| sums.iter().map(|own| own[place]).collect();
    Some(LevelSlopes {
        sizes: levels.sizes().iter().map(|own| *own as f64).collect(),
        log_v: part(0),
        log_fixed: part(1),
        squares: part(2),
    })
}

/// Whether variances differ by no more than rounding of the criterion allows.
pub(crate) fn within_bounds(logs: &[f64]) -> bool {
    logs.iter().all(|own| own.abs() <= MOST_LOG)
}
