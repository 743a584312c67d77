//! Conditional modes of random effects (BLUPs) and their standard deviations.

use crate::evaluate::{LeafScratch, State, eliminate, solve_upper};
use crate::model::MixedModel;
use crate::slope::{Projections, TrunkInverse};
use crate::theta::place_of;
use nalgebra::{DMatrix, DVector};

/// Random effects of one term.
#[derive(Clone, Debug, PartialEq)]
pub struct RandomEffects {
    /// The term.
    pub term: String,
    /// Conditional modes per group and column; zero for groups without rows.
    pub values: Vec<Vec<f64>>,
    /// Conditional standard deviations (lme4's `condVar`).
    pub sds: Vec<Vec<f64>>,
}

pub(crate) fn random_effects(
    model: &MixedModel,
    state: &State,
    projections: &Projections,
    residual_sd: f64,
) -> Vec<RandomEffects> {
    let variances = conditional_variances(model, state);
    let scaled = scaled_effects(model, state, projections);
    let terms = model.terms.iter().enumerate();
    terms
        .map(|(term, given)| {
            let (factor, place) = place_of(model, term);
            let width = model.factors[factor].width;
            let basis = model.factors[factor].basis.clone();
            let inverse = basis
                .try_inverse()
                .unwrap_or_else(|| DMatrix::zeros(width, width));
            let unseen = &state.blocks[factor] * state.blocks[factor].transpose();
            let mut values = Vec::with_capacity(given.groups);
            let mut sds = Vec::with_capacity(given.groups);
            for group in &model.group_place[term] {
                let (mode, variance) = match group {
                    Some(group) => (
                        &inverse * scaled[factor].column(*group),
                        &inverse
                            * variance_at(&variances[factor], *group, width)
                            * inverse.transpose(),
                    ),
                    None => (
                        DVector::zeros(width),
                        &inverse * &unseen * inverse.transpose(),
                    ),
                };
                let columns = place.offset..place.offset + place.width;
                values.push(columns.clone().map(|k| mode[k]).collect());
                sds.push(
                    columns
                        .map(|k| variance[(k, k)].sqrt() * residual_sd)
                        .collect(),
                );
            }
            RandomEffects {
                term: given.name.clone(),
                values,
                sds,
            }
        })
        .collect()
}

fn variance_at(variances: &[f64], group: usize, width: usize) -> DMatrix<f64> {
    let square = width * width;
    DMatrix::from_row_slice(
        width,
        width,
        &variances[group * square..(group + 1) * square],
    )
}

/// Modes in the factors' own columns: Λ Λ' c, a column per group.
pub(crate) fn scaled_effects(
    model: &MixedModel,
    state: &State,
    projections: &Projections,
) -> Vec<DMatrix<f64>> {
    let p = model.coefficients();
    let factors = model.factors.iter().zip(projections).zip(&state.blocks);
    factors
        .map(|((factor, projection), block)| {
            let left = DMatrix::from_fn(factor.width, factor.groups, |column, group| {
                let row = &projection[(group * factor.width + column) * (p + 1)..][..p + 1];
                row[p] - (0..p).map(|k| row[k] * state.shift[k]).sum::<f64>()
            });
            block * block.tr_mul(&left)
        })
        .collect()
}

/// Blocks of Λ (Λ'Z'ZΛ + I)⁻¹ Λ' of every group, one after another by rows.
fn conditional_variances(model: &MixedModel, state: &State) -> Vec<Vec<f64>> {
    let trunk = TrunkInverse::of(model, state);
    let envelope = &model.trunk.envelope;
    let mut variances = vec![leaf_variances(model, state, &trunk)];
    for (index, factor) in model.factors[1..].iter().enumerate() {
        let mut all = Vec::with_capacity(factor.groups * factor.width * factor.width);
        for group in 0..factor.groups {
            let first = model.trunk.offsets[index] + group * factor.width;
            for a in first..first + factor.width {
                all.extend(
                    (first..first + factor.width).map(|b| envelope.symmetric(&trunk.scaled, a, b)),
                );
            }
        }
        variances.push(all);
    }
    variances
}

fn leaf_variances(model: &MixedModel, state: &State, trunk: &TrunkInverse) -> Vec<f64> {
    let leaf = &model.leaf;
    let q = leaf.width;
    let block = &state.blocks[0];
    let envelope = &model.trunk.envelope;
    let mut scratch = LeafScratch::default();
    let mut all = Vec::with_capacity(leaf.groups * q * q);
    for group in 0..leaf.groups {
        let met = &leaf.met[leaf.met_start[group]..leaf.met_start[group + 1]];
        let wide = met.len() + model.coefficients() + 1;
        let mut sum = DMatrix::zeros(q, q);
        if eliminate(leaf, block, group, &mut scratch).is_some() {
            // (L L')⁻¹ and, for what the trunk leaves unknown, K scaled K'
            let mut inverse: Vec<f64> = DMatrix::<f64>::identity(q, q).as_slice().to_vec();
            crate::evaluate::solve_lower(&scratch.factor, q, &mut inverse, q);
            solve_upper(&scratch.factor, q, &mut inverse, q);
            sum = DMatrix::from_row_slice(q, q, &inverse);
            solve_upper(&scratch.factor, q, &mut scratch.cross, wide);
            for (a, i) in met.iter().enumerate() {
                for (b, j) in met.iter().enumerate() {
                    let d = envelope.symmetric(&trunk.scaled, *i, *j);
                    for r in 0..q {
                        for c in 0..q {
                            sum[(r, c)] +=
                                scratch.cross[r * wide + a] * d * scratch.cross[c * wide + b];
                        }
                    }
                }
            }
        }
        let variance = block * sum * block.transpose();
        for r in 0..q {
            all.extend((0..q).map(|c| variance[(r, c)]));
        }
    }
    all
}

/// X β + Z b.
pub(crate) fn fitted_values(
    model: &MixedModel,
    coefficients: &[f64],
    effects: &[RandomEffects],
) -> Vec<f64> {
    let mut fitted = vec![0.0; model.rows()];
    for (column, coefficient) in model.x.column_iter().zip(coefficients) {
        fitted
            .iter_mut()
            .zip(column.iter())
            .for_each(|(sum, x)| *sum += x * coefficient);
    }
    for (term, effects) in model.terms.iter().zip(effects) {
        for (row, group) in term.group.iter().enumerate() {
            let values = &effects.values[*group];
            for (column, value) in term.columns.iter().zip(values) {
                fitted[row] += column[row] * value;
            }
        }
    }
    fitted
}
