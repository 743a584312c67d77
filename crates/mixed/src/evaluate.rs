//! Penalised least squares at given relative covariance factors.
//!
//! With V = I + Z Λ Λ' Z' (the covariance of the response over σ²) this gives
//! log|V|, log|X'V⁻¹X|, the penalised residual sum of squares and the coefficients:
//! Bates, Mächler, Bolker and Walker (2015), J. Stat. Softw. 67(1), eqs. 17-25,
//! with the sparse factorisation replaced by elimination of the leaf's groups and
//! an envelope factor of the rest.

use crate::basis::add_scaled;
use crate::blocks::{Leaf, TrunkBlock};
use crate::model::MixedModel;
use nalgebra::{DMatrix, DVector};

/// Penalised squares below this share of the ordinary ones are rounding.
const LEAST_SQUARES: f64 = 1e-15;

/// What the factorisation at one Λ gives.
#[derive(Clone, Debug)]
pub(crate) struct State {
    /// Λ's block of each factor, any square root of the relative covariance.
    pub blocks: Vec<DMatrix<f64>>,
    /// log|V|.
    pub log_v: f64,
    /// log|X'V⁻¹X| of the orthonormal columns.
    pub log_fixed: f64,
    /// Penalised residual sum of squares.
    pub squares: f64,
    /// Coefficients of the orthonormal columns beyond ordinary least squares.
    pub shift: DVector<f64>,
    /// (X'V⁻¹X)⁻¹ of the orthonormal columns.
    pub covariance: DMatrix<f64>,
    /// Trunk after the leaf's elimination, Z'Vₗ⁻¹Z.
    pub trunk: Vec<f64>,
    /// The same against fixed columns.
    pub trunk_fixed: Vec<f64>,
    /// Cholesky factor of Λ' trunk Λ + I.
    pub trunk_factor: Vec<f64>,
    /// Λ (Λ' trunk Λ + I)⁻¹ Λ' trunk_fixed.
    pub trunk_solved: Vec<f64>,
}

/// Small matrices of one leaf group, by rows.
#[derive(Clone, Debug, Default)]
pub(crate) struct LeafScratch {
    /// L of Λ'ZⱼʹZⱼΛ + I.
    pub factor: Vec<f64>,
    /// L⁻¹ Λ' cross.
    pub cross: Vec<f64>,
    /// L⁻¹ Λ' ZⱼʹZⱼ.
    pub square: Vec<f64>,
}

/// Factorises; `None` where numbers overflow.
pub(crate) fn evaluate(model: &MixedModel, blocks: &[DMatrix<f64>]) -> Option<State> {
    let m = model.coefficients() + 1;
    let mut trunk = model.trunk.square.clone();
    let mut trunk_fixed = model.trunk.fixed.clone();
    let mut fixed = model.fixed.clone();
    let mut log_v = 0.0;
    let mut scratch = LeafScratch::default();
    for group in 0..model.leaf.groups {
        log_v += eliminate(&model.leaf, &blocks[0], group, &mut scratch)?;
        subtract_leaf(
            model,
            group,
            &scratch.cross,
            &mut trunk,
            &mut trunk_fixed,
            &mut fixed,
        );
    }
    mirror(&mut fixed, m);

    let envelope = &model.trunk.envelope;
    let mut trunk_factor = scaled_trunk(model, blocks, &trunk);
    envelope.factor(&mut trunk_factor)?;
    log_v += envelope.log_determinant(&trunk_factor);
    let mut trunk_solved = times_blocks(model, blocks, &trunk_fixed, Side::Transposed);
    envelope.solve_lower(&trunk_factor, &mut trunk_solved, m);
    for row in trunk_solved.chunks_exact(m) {
        for a in 0..m {
            for b in 0..m {
                fixed[a * m + b] -= row[a] * row[b];
            }
        }
    }
    envelope.solve_upper(&trunk_factor, &mut trunk_solved, m);
    let trunk_solved = times_blocks(model, blocks, &trunk_solved, Side::Plain);

    let p = m - 1;
    let square = DMatrix::from_fn(p, p, |a, b| fixed[a * m + b]);
    let right = DVector::from_fn(p, |a, _| fixed[a * m + p]);
    let cholesky = square.cholesky()?;
    let shift = cholesky.solve(&right);
    let squares = fixed[p * m + p] - right.dot(&shift);
    let log_fixed = 2.0 * cholesky.l_dirty().diagonal().map(f64::ln).sum();
    let least = LEAST_SQUARES * model.fixed[p * m + p];
    let valid = squares > least && (log_v + log_fixed + squares).is_finite();
    valid.then(|| State {
        blocks: blocks.to_vec(),
        log_v,
        log_fixed,
        squares,
        shift,
        covariance: cholesky.inverse(),
        trunk,
        trunk_fixed,
        trunk_factor,
        trunk_solved,
    })
}

/// Eliminates one group of the leaf; gives its share of log|V|.
pub(crate) fn eliminate(
    leaf: &Leaf,
    block: &DMatrix<f64>,
    group: usize,
    scratch: &mut LeafScratch,
) -> Option<f64> {
    let q = leaf.width;
    let square = &leaf.square[group * q * q..(group + 1) * q * q];
    let cross = &leaf.cross[leaf.cross_start[group]..leaf.cross_start[group + 1]];
    let wide = cross.len() / q;
    transposed_times(block, square, q, &mut scratch.square);
    transposed_times(block, cross, wide, &mut scratch.cross);

    // Λ'ZʹZΛ + I, its lower triangle, then its factor
    let factor = &mut scratch.factor;
    factor.clear();
    factor.resize(q * q, 0.0);
    let mut product = 1.0;
    for i in 0..q {
        for j in 0..=i {
            let mut value = f64::from(u8::from(i == j));
            for k in 0..q {
                value += scratch.square[i * q + k] * block[(k, j)];
            }
            for k in 0..j {
                value -= factor[i * q + k] * factor[j * q + k];
            }
            factor[i * q + j] = if i > j {
                value / factor[j * q + j]
            } else {
                product *= value;
                value.sqrt()
            };
        }
    }
    if !(product > 0.0 && product.is_finite()) {
        return None;
    }
    solve_lower(factor, q, &mut scratch.square, q);
    solve_lower(factor, q, &mut scratch.cross, wide);
    Some(product.ln())
}

/// Λ' times a matrix by rows.
fn transposed_times(block: &DMatrix<f64>, matrix: &[f64], wide: usize, product: &mut Vec<f64>) {
    product.clear();
    product.resize(matrix.len(), 0.0);
    let q = block.nrows();
    for i in 0..q {
        let row = &mut product[i * wide..(i + 1) * wide];
        for k in 0..q {
            let l = block[(k, i)];
            if l != 0.0 {
                let from = &matrix[k * wide..(k + 1) * wide];
                add_scaled(row, l, from);
            }
        }
    }
}

/// L⁻¹ times a matrix by rows, in place.
pub(crate) fn solve_lower(factor: &[f64], q: usize, matrix: &mut [f64], wide: usize) {
    for i in 0..q {
        let (before, rest) = matrix.split_at_mut(i * wide);
        let row = &mut rest[..wide];
        for k in 0..i {
            let l = factor[i * q + k];
            let from = &before[k * wide..(k + 1) * wide];
            add_scaled(row, -l, from);
        }
        let pivot = factor[i * q + i];
        row.iter_mut().for_each(|value| *value /= pivot);
    }
}

/// L⁻ᵀ times a matrix by rows, in place.
pub(crate) fn solve_upper(factor: &[f64], q: usize, matrix: &mut [f64], wide: usize) {
    for i in (0..q).rev() {
        let (before, rest) = matrix.split_at_mut(i * wide);
        let row = &mut rest[..wide];
        let pivot = factor[i * q + i];
        row.iter_mut().for_each(|value| *value /= pivot);
        for k in 0..i {
            let l = factor[i * q + k];
            let to = &mut before[k * wide..(k + 1) * wide];
            add_scaled(to, -l, row);
        }
    }
}

/// Subtracts an eliminated group; of `fixed` only the upper triangle.
fn subtract_leaf(
    model: &MixedModel,
    group: usize,
    cross: &[f64],
    trunk: &mut [f64],
    trunk_fixed: &mut [f64],
    fixed: &mut [f64],
) {
    let m = model.coefficients() + 1;
    let met = &model.leaf.met[model.leaf.met_start[group]..model.leaf.met_start[group + 1]];
    let envelope = &model.trunk.envelope;
    for row in cross.chunks_exact(met.len() + m) {
        let (in_trunk, in_fixed) = row.split_at(met.len());
        envelope.subtract_square(trunk, met, in_trunk);
        for (i, value) in met.iter().zip(in_trunk) {
            let sums = &mut trunk_fixed[i * m..(i + 1) * m];
            add_scaled(sums, -*value, in_fixed);
        }
        for (a, value) in in_fixed.iter().enumerate() {
            let sums = &mut fixed[a * m + a..(a + 1) * m];
            add_scaled(sums, -*value, &in_fixed[a..]);
        }
    }
}

fn mirror(square: &mut [f64], m: usize) {
    for a in 0..m {
        for b in 0..a {
            square[a * m + b] = square[b * m + a];
        }
    }
}

/// Λ' trunk Λ + I.
fn scaled_trunk(model: &MixedModel, blocks: &[DMatrix<f64>], trunk: &[f64]) -> Vec<f64> {
    let envelope = &model.trunk.envelope;
    let mut scaled = between_blocks(model, trunk, |block| blocks[block.factor].clone());
    for i in 0..envelope.rows() {
        scaled[envelope.place(i, i)] += 1.0;
    }
    scaled
}

/// B' M B for a block diagonal B.
pub(crate) fn between_blocks(
    model: &MixedModel,
    matrix: &[f64],
    of: impl Fn(&TrunkBlock) -> DMatrix<f64>,
) -> Vec<f64> {
    let envelope = &model.trunk.envelope;
    let by_factor = by_factor(model, of);
    let mut product = vec![0.0; matrix.len()];
    for (index, left) in model.trunk.blocks.iter().enumerate() {
        let first = envelope.first[left.offset];
        let start = model
            .trunk
            .blocks
            .partition_point(|block| block.offset < first);
        for right in &model.trunk.blocks[start..=index] {
            if left.width == 1 && right.width == 1 {
                let place = envelope.place(left.offset, right.offset);
                let scale = by_factor[left.factor][(0, 0)] * by_factor[right.factor][(0, 0)];
                product[place] = matrix[place] * scale;
                continue;
            }
            let part = DMatrix::from_fn(left.width, right.width, |a, b| {
                envelope.symmetric(matrix, left.offset + a, right.offset + b)
            });
            let part = by_factor[left.factor].tr_mul(&part) * &by_factor[right.factor];
            for a in 0..left.width {
                for b in 0..right.width {
                    let (i, j) = (left.offset + a, right.offset + b);
                    if j <= i {
                        product[envelope.place(i, j)] = part[(a, b)];
                    }
                }
            }
        }
    }
    product
}

/// One matrix per factor, from any of its blocks; empty without trunk blocks.
fn by_factor(model: &MixedModel, of: impl Fn(&TrunkBlock) -> DMatrix<f64>) -> Vec<DMatrix<f64>> {
    let factors = 0..model.factors.len();
    factors
        .map(|factor| {
            let mut blocks = model.trunk.blocks.iter();
            let block = blocks.find(|block| block.factor == factor);
            block.map_or_else(|| DMatrix::zeros(0, 0), &of)
        })
        .collect()
}

/// Whether Λ or its transpose multiplies.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Side {
    /// Λ.
    Plain,
    /// Λ'.
    Transposed,
}

/// Λ or Λ' times trunk rows of `m` numbers.
pub(crate) fn times_blocks(
    model: &MixedModel,
    blocks: &[DMatrix<f64>],
    rows: &[f64],
    side: Side,
) -> Vec<f64> {
    let columns = model.trunk.envelope.rows().max(1);
    let m = rows.len() / columns;
    let mut product = vec![0.0; rows.len()];
    for block in &model.trunk.blocks {
        let lambda = &blocks[block.factor];
        for i in 0..block.width {
            for k in 0..block.width {
                let l = match side {
                    Side::Plain => lambda[(i, k)],
                    Side::Transposed => lambda[(k, i)],
                };
                let from = &rows[(block.offset + k) * m..(block.offset + k + 1) * m];
                let to = &mut product[(block.offset + i) * m..(block.offset + i + 1) * m];
                add_scaled(to, l, from);
            }
        }
    }
    product
}
