//! Derivatives of what `mixed::evaluate` gives, by the entries of Λ's blocks.
//!
//! With c = Z'V⁻¹(y - Xβ), B = Z'V⁻¹X, Φ = (X'V⁻¹X)⁻¹ and sums over the groups of a
//! factor with block T:
//!
//! ```text
//! ∂ log|V| / ∂T           =  2 Σ (T' Z'V⁻¹Z)'
//! ∂ log|X'V⁻¹X| / ∂T      = -2 Σ B Φ B' T
//! ∂ squares / ∂T          = -2 Σ c c' T
//! ```
//!
//! They follow from ∂V = Z (∂Λ Λ' + Λ ∂Λ') Z' and, for the squares, from their
//! being a minimum.

use crate::basis::{add_scaled, dot};
use crate::evaluate::{LeafScratch, State, between_blocks, eliminate, solve_upper};
use crate::model::MixedModel;
use nalgebra::DMatrix;

/// Derivatives by the entries of each factor's block.
#[derive(Clone, Debug)]
pub(crate) struct Slopes {
    /// Of log|V|.
    pub log_v: Vec<DMatrix<f64>>,
    /// Of log|X'V⁻¹X|.
    pub log_fixed: Vec<DMatrix<f64>>,
    /// Of the penalised squares.
    pub squares: Vec<DMatrix<f64>>,
}

/// Z'V⁻¹[X, residual] of each factor: rows of p + 1 numbers per group and column.
pub(crate) type Projections = Vec<Vec<f64>>;

/// Derivatives, and the projections they came from.
pub(crate) fn slopes(model: &MixedModel, state: &State) -> (Slopes, Projections) {
    let trunk = TrunkInverse::of(model, state);
    let mut traces: Vec<DMatrix<f64>> = model
        .factors
        .iter()
        .map(|factor| DMatrix::zeros(factor.width, factor.width))
        .collect();
    let leaf = leaf_projection(model, state, &trunk, &mut traces[0]);
    trunk_traces(model, state, &trunk, &mut traces);
    let projections = with_trunk(model, state, leaf);
    let (log_fixed, squares) = outer_products(model, state, &projections);
    let scaled = |sums: Vec<DMatrix<f64>>| -> Vec<DMatrix<f64>> {
        let blocks = sums.iter().zip(&state.blocks);
        blocks.map(|(sum, block)| -2.0 * sum * block).collect()
    };
    let slopes = Slopes {
        log_v: traces.iter().map(|trace| 2.0 * trace.transpose()).collect(),
        log_fixed: scaled(log_fixed),
        squares: scaled(squares),
    };
    (slopes, projections)
}

/// The trunk's inverse inside its envelope, plain and between Λ and Λ'.
pub(crate) struct TrunkInverse {
    /// (Λ' trunk Λ + I)⁻¹.
    pub plain: Vec<f64>,
    /// Λ (Λ' trunk Λ + I)⁻¹ Λ'.
    pub scaled: Vec<f64>,
}

impl TrunkInverse {
    pub fn of(model: &MixedModel, state: &State) -> Self {
        let plain = model.trunk.envelope.inverse(&state.trunk_factor);
        let scaled = between_blocks(model, &plain, |block| {
            state.blocks[block.factor].transpose()
        });
        Self { plain, scaled }
    }
}

/// Projections of the leaf, and the sum of its blocks of Λ'Z'V⁻¹Z.
fn leaf_projection(
    model: &MixedModel,
    state: &State,
    trunk: &TrunkInverse,
    trace: &mut DMatrix<f64>,
) -> Vec<f64> {
    let leaf = &model.leaf;
    let (q, m) = (leaf.width, model.coefficients() + 1);
    let envelope = &model.trunk.envelope;
    let mut projection = vec![0.0; leaf.groups * q * m];
    let mut scratch = LeafScratch::default();
    let (mut left, mut product) = (Vec::new(), Vec::new());
    for group in 0..leaf.groups {
        // the same operations as in `evaluate`, which found them to be finite
        if eliminate(leaf, &state.blocks[0], group, &mut scratch).is_none() {
            continue;
        }
        let met = &leaf.met[leaf.met_start[group]..leaf.met_start[group + 1]];
        let wide = met.len() + m;
        let cross = &leaf.cross[leaf.cross_start[group]..leaf.cross_start[group + 1]];
        let rows = &mut projection[group * q * m..(group + 1) * q * m];

        // Zⱼ'Vₗ⁻¹[trunk columns, fixed columns] = cross - square' L⁻¹Λ'cross
        left.clear();
        left.extend_from_slice(cross);
        for k in 0..q {
            for a in 0..q {
                let s = scratch.square[k * q + a];
                let from = &scratch.cross[k * wide..(k + 1) * wide];
                let to = &mut left[a * wide..(a + 1) * wide];
                add_scaled(to, -s, from);
            }
        }
        for a in 0..q {
            let row = &mut rows[a * m..(a + 1) * m];
            row.copy_from_slice(&left[a * wide + met.len()..(a + 1) * wide]);
            for (place, column) in met.iter().enumerate() {
                let e = left[a * wide + place];
                let solved = &state.trunk_solved[column * m..(column + 1) * m];
                add_scaled(row, -e, solved);
            }
        }

        // A⁻¹Λ'ZʹZ - (A⁻¹Λ'Z'Zₜ) scaled (Zₜ'Vₗ⁻¹Zⱼ)
        solve_upper(&scratch.factor, q, &mut scratch.square, q);
        for i in 0..q {
            for j in 0..q {
                trace[(i, j)] += scratch.square[i * q + j];
            }
        }
        if met.is_empty() {
            continue;
        }
        solve_upper(&scratch.factor, q, &mut scratch.cross, wide);
        for column in 0..q {
            let e = &left[column * wide..column * wide + met.len()];
            envelope.multiply_part(&trunk.scaled, met, e, &mut product);
            for row in 0..q {
                trace[(row, column)] -= dot(&scratch.cross[row * wide..][..met.len()], &product);
            }
        }
    }
    projection
}

/// Sums of the trunk's blocks of Λ'Z'V⁻¹Z = (Λ' trunk Λ + I)⁻¹ Λ' trunk.
fn trunk_traces(
    model: &MixedModel,
    state: &State,
    trunk: &TrunkInverse,
    traces: &mut [DMatrix<f64>],
) {
    let envelope = &model.trunk.envelope;
    let blocks = &model.trunk.blocks;
    for (index, left) in blocks.iter().enumerate() {
        let first = envelope.first[left.offset];
        let start = blocks.partition_point(|block| block.offset < first);
        for right in &blocks[start..=index] {
            if left.width == 1 && right.width == 1 {
                let place = envelope.place(left.offset, right.offset);
                let sum = trunk.plain[place] * state.trunk[place];
                traces[left.factor][(0, 0)] += sum * state.blocks[right.factor][(0, 0)];
                if right.offset < left.offset {
                    traces[right.factor][(0, 0)] += sum * state.blocks[left.factor][(0, 0)];
                }
                continue;
            }
            let part = |values: &[f64]| {
                DMatrix::from_fn(left.width, right.width, |a, b| {
                    envelope.symmetric(values, left.offset + a, right.offset + b)
                })
            };
            let (inverse, matrix) = (part(&trunk.plain), part(&state.trunk));
            let lambda = &state.blocks[right.factor];
            traces[left.factor] += &inverse * lambda.tr_mul(&matrix.transpose());
            if right.offset < left.offset {
                let lambda = &state.blocks[left.factor];
                traces[right.factor] += inverse.tr_mul(&lambda.tr_mul(&matrix));
            }
        }
    }
}

/// Projections of all factors: trunk_fixed - trunk trunk_solved for the trunk's.
fn with_trunk(model: &MixedModel, state: &State, leaf: Vec<f64>) -> Projections {
    let m = model.coefficients() + 1;
    let product = model
        .trunk
        .envelope
        .multiply(&state.trunk, &state.trunk_solved, m);
    let trunk: Vec<f64> = state
        .trunk_fixed
        .iter()
        .zip(&product)
        .map(|(a, b)| a - b)
        .collect();
    let mut projections = vec![leaf];
    for (factor, offset) in model.factors[1..].iter().zip(&model.trunk.offsets) {
        let begin = offset * m;
        projections.push(trunk[begin..begin + factor.groups * factor.width * m].to_vec());
    }
    projections
}

/// Σ B Φ B' and Σ c c' of each factor.
fn outer_products(
    model: &MixedModel,
    state: &State,
    projections: &Projections,
) -> (Vec<DMatrix<f64>>, Vec<DMatrix<f64>>) {
    let p = model.coefficients();
    let m = p + 1;
    let mut fixed = Vec::new();
    let mut squares = Vec::new();
    for (factor, projection) in model.factors.iter().zip(projections) {
        let q = factor.width;
        let mut cross = vec![0.0; q * q * p * p];
        let mut residual = DMatrix::zeros(q, q);
        let mut c = vec![0.0; q];
        for group in projection.chunks_exact(q * m) {
            for a in 0..q {
                let row = &group[a * m..(a + 1) * m];
                c[a] = row[p] - (0..p).map(|k| row[k] * state.shift[k]).sum::<f64>();
                for b in 0..=a {
                    residual[(a, b)] += c[a] * c[b];
                    let other = &group[b * m..b * m + p];
                    let sums = &mut cross[(a * q + b) * p * p..(a * q + b + 1) * p * p];
                    for (sums, value) in sums.chunks_exact_mut(p).zip(row) {
                        add_scaled(sums, *value, other);
                    }
                }
            }
        }
        let product = |a: usize, b: usize| {
            let sums = &cross[(a * q + b) * p * p..(a * q + b + 1) * p * p];
            sums.iter()
                .zip(state.covariance.iter())
                .map(|(x, y)| x * y)
                .sum::<f64>()
        };
        fixed.push(DMatrix::from_fn(q, q, |a, b| product(a.max(b), a.min(b))));
        residual.fill_upper_triangle_with_lower_triangle();
        squares.push(residual);
    }
    (fixed, squares)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evaluate::evaluate;
    use crate::model::prepare_mixed;
    use crate::term::RandomTerm;
    use nalgebra::DVector;

    /// Crossed and nested groups with an intercept and a slope, and a term of two
    /// uncorrelated columns.
    fn model() -> MixedModel {
        let n = 72;
        let wave = |i: usize, k: f64| ((i as f64 + 1.0) * k).sin();
        let x: Vec<f64> = (0..n).map(|i| wave(i, 1.3)).collect();
        let y: Vec<f64> = (0..n)
            .map(|i| {
                3.0 + x[i] + wave(i / 6, 2.1) + 0.7 * wave(i % 5, 0.9) * x[i] + 0.3 * wave(i, 7.7)
            })
            .collect();
        let term = |name: &str, columns: Vec<Vec<f64>>, correlated: bool, group: Vec<usize>| {
            let groups = group.iter().max().unwrap() + 1;
            RandomTerm {
                name: name.to_owned(),
                column_names: (0..columns.len()).map(|k| k.to_string()).collect(),
                columns,
                group,
                groups,
                group_names: (0..groups).map(|k| k.to_string()).collect(),
                correlated,
            }
        };
        let one = vec![1.0; n];
        let terms = [
            term(
                "fruit",
                vec![one.clone(), x.clone()],
                true,
                (0..n).map(|i| i / 6).collect(),
            ),
            term(
                "operator",
                vec![one.clone(), x.clone()],
                false,
                (0..n).map(|i| i % 5).collect(),
            ),
            term(
                "variety",
                vec![one.clone()],
                true,
                (0..n).map(|i| i / 18).collect(),
            ),
        ];
        let design = DMatrix::from_fn(n, 2, |i, j| if j == 0 { 1.0 } else { x[i] });
        let names = ["(Intercept)".to_owned(), "x".to_owned()];
        prepare_mixed(&y, &design, &names, &terms).unwrap()
    }

    fn blocks() -> Vec<DMatrix<f64>> {
        vec![
            DMatrix::from_row_slice(2, 2, &[0.9, 0.2, -0.3, 0.4]),
            DMatrix::from_row_slice(2, 2, &[0.5, 0.1, 0.0, 0.8]),
            DMatrix::from_row_slice(1, 1, &[0.6]),
        ]
    }

    /// The same by dense matrices and their definitions.
    fn dense(model: &MixedModel, blocks: &[DMatrix<f64>]) -> (f64, f64, f64) {
        let n = model.rows();
        let mut v = DMatrix::identity(n, n);
        for (factor, block) in model.factors.iter().zip(blocks) {
            let q = factor.width;
            let sigma = block * block.transpose();
            for i in 0..n {
                for j in 0..n {
                    if factor.group[i] == factor.group[j] {
                        let left = DVector::from_column_slice(&factor.design[i * q..(i + 1) * q]);
                        let right = DVector::from_column_slice(&factor.design[j * q..(j + 1) * q]);
                        v[(i, j)] += (left.transpose() * &sigma * right)[(0, 0)];
                    }
                }
            }
        }
        let inverse = v.clone().try_inverse().unwrap();
        let x = DMatrix::from_fn(n, model.coefficients(), |i, j| model.basis.q[j][i]);
        let y = DVector::from_column_slice(&model.y);
        let square = x.tr_mul(&inverse) * &x;
        let beta = square.clone().try_inverse().unwrap() * x.tr_mul(&inverse) * &y;
        let rest = &y - &x * beta;
        let squares = (rest.transpose() * inverse * rest)[(0, 0)];
        (v.determinant().ln(), square.determinant().ln(), squares)
    }

    #[test]
    fn closed_form_elimination_gives_what_dense_matrices_define() {
        let (model, blocks) = (model(), blocks());
        let state = evaluate(&model, &blocks).unwrap();
        let (log_v, log_fixed, squares) = dense(&model, &blocks);
        assert!(
            (state.log_v - log_v).abs() < 1e-11 * log_v.abs(),
            "{} {log_v}",
            state.log_v
        );
        assert!((state.log_fixed - log_fixed).abs() < 1e-11);
        assert!((state.squares / squares - 1.0).abs() < 1e-11);
    }

    #[test]
    fn derivative_of_every_entry_of_every_block() {
        let (model, blocks) = (model(), blocks());
        let state = evaluate(&model, &blocks).unwrap();
        let (slopes, _) = slopes(&model, &state);
        let step = 1e-4;
        for factor in 0..blocks.len() {
            for entry in 0..blocks[factor].len() {
                let moved = |by: f64| {
                    let mut moved = blocks.clone();
                    moved[factor][entry] += by * step;
                    let s = evaluate(&model, &moved).unwrap();
                    [s.log_v, s.log_fixed, s.squares]
                };
                let (a, b, c, d) = (moved(1.0), moved(-1.0), moved(2.0), moved(-2.0));
                let found = [&slopes.log_v, &slopes.log_fixed, &slopes.squares];
                for (k, found) in found.into_iter().enumerate() {
                    let found = found[factor][entry];
                    let expected = (8.0 * (a[k] - b[k]) - (c[k] - d[k])) / (12.0 * step);
                    assert!(
                        (found - expected).abs() < 1e-8 * (1.0 + expected.abs()),
                        "factor {factor}, entry {entry}, {k}: {found} {expected}"
                    );
                    assert!(found != 0.0);
                }
            }
        }
    }
}
