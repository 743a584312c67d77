//! The error of a prediction at one row.

use crate::basis::{add_scaled, dot};
use crate::evaluate::{LeafScratch, Side, State, eliminate, solve_lower, times_blocks};
use crate::model::MixedModel;
use crate::slope::Projections;
use nalgebra::DMatrix;

/// A row in the model's own columns.
#[derive(Clone, Debug, Default)]
pub(crate) struct Row {
    /// Fixed columns.
    pub x: Vec<f64>,
    /// Groups that were measured: factor, group, columns.
    pub known: Vec<(usize, usize, Vec<f64>)>,
    /// Groups that were not: factor, columns, each its own.
    pub new: Vec<(usize, Vec<f64>)>,
}

/// Memory for the errors of rows at one factorisation.
#[derive(Clone, Debug, Default)]
pub(crate) struct RowWork {
    /// Leaf group that is eliminated.
    group: Option<usize>,
    leaf: LeafScratch,
    /// Λ'z, then L⁻¹Λ'z.
    root: Vec<f64>,
    smooth: Vec<f64>,
    d: Vec<f64>,
    trunk: Vec<f64>,
}

impl Row {
    /// Takes a row that the model was fitted to.
    pub(crate) fn take(&mut self, model: &MixedModel, row: usize) {
        self.x.clear();
        self.x.extend(model.basis.q.iter().map(|own| own[row]));
        self.known
            .resize_with(model.factors.len(), Default::default);
        let factors = model.factors.iter().enumerate();
        for ((place, factor), known) in factors.zip(&mut self.known) {
            let design = &factor.design[row * factor.width..(row + 1) * factor.width];
            (known.0, known.1) = (place, factor.group[row]);
            known.2.clear();
            known.2.extend(design);
        }
    }

    /// Variances of the prediction's error over σ²: z'Λ A⁻¹ Λ'z with what new groups add, and
    /// d'(X'V⁻¹X)⁻¹d with d = x - X'V⁻¹Z Λ Λ' z.
    pub(crate) fn variances(
        &self,
        model: &MixedModel,
        state: &State,
        projections: &Projections,
        work: &mut RowWork,
    ) -> Option<(f64, f64)> {
        let p = model.coefficients();
        work.d.clone_from(&self.x);
        work.trunk.clear();
        work.trunk.resize(model.trunk.envelope.rows(), 0.0);
        let mut sum = 0.0;
        for (factor, group, z) in &self.known {
            let width = model.factors[*factor].width;
            let block = &state.blocks[*factor];
            times_transposed(block, z, &mut work.root);
            work.smooth.clear();
            work.smooth.extend(block.row_iter().map(|own| {
                let pairs = own.iter().zip(&work.root);
                pairs.map(|(a, b)| a * b).sum::<f64>()
            }));
            for (column, smooth) in work.smooth.iter().enumerate() {
                let row = &projections[*factor][(group * width + column) * (p + 1)..][..p];
                add_scaled(&mut work.d, -smooth, row);
            }
            if *factor == 0 {
                sum += work.leaf_variance(model, state, *group)?;
            } else {
                let first = model.trunk.offsets[factor - 1] + group * width;
                add_scaled(&mut work.trunk[first..first + width], 1.0, z);
            }
        }
        if !work.trunk.is_empty() {
            let mut solved = times_blocks(model, &state.blocks, &work.trunk, Side::Transposed);
            let envelope = &model.trunk.envelope;
            envelope.solve_lower(&state.trunk_factor, &mut solved, 1);
            sum += dot(&solved, &solved);
        }
        for (factor, z) in &self.new {
            times_transposed(&state.blocks[*factor], z, &mut work.root);
            sum += dot(&work.root, &work.root);
        }
        let columns = state.covariance.as_slice().chunks_exact(p);
        let fixed = columns.zip(&work.d).map(|(own, d)| d * dot(own, &work.d));
        Some((sum, fixed.sum()))
    }
}

/// Λ'z.
fn times_transposed(block: &DMatrix<f64>, z: &[f64], product: &mut Vec<f64>) {
    product.clear();
    let columns = block.as_slice().chunks_exact(z.len());
    product.extend(columns.map(|own| dot(own, z)));
}

impl RowWork {
    /// |L⁻¹Λ'z|² of a leaf group; takes K'L⁻¹Λ'z from the trunk's columns.
    fn leaf_variance(&mut self, model: &MixedModel, state: &State, group: usize) -> Option<f64> {
        let leaf = &model.leaf;
        if self.group != Some(group) {
            self.group = None;
            eliminate(leaf, &state.blocks[0], group, &mut self.leaf)?;
            self.group = Some(group);
        }
        solve_lower(&self.leaf.factor, leaf.width, &mut self.root, 1);
        let met = &leaf.met[leaf.met_start[group]..leaf.met_start[group + 1]];
        let wide = met.len() + model.coefficients() + 1;
        for (row, value) in self.leaf.cross.chunks_exact(wide).zip(&self.root) {
            for (column, k) in met.iter().zip(row) {
                self.trunk[*column] -= k * value;
            }
        }
        Some(dot(&self.root, &self.root))
    }
}
