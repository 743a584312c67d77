//! The free entries of Λ's blocks.

use crate::model::MixedModel;
use nalgebra::DMatrix;

/// One free entry of a lower triangle or, uncorrelated, of the diagonal.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Entry {
    pub factor: usize,
    pub term: usize,
    /// Row in the factor's block.
    pub row: usize,
    /// Column in the factor's block.
    pub column: usize,
}

/// Entries in lme4's order: term by term, column by column.
pub(crate) fn entries_of(model: &MixedModel) -> Vec<Entry> {
    let mut entries = Vec::new();
    for (term, given) in model.terms.iter().enumerate() {
        let (factor, place) = place_of(model, term);
        for column in 0..place.width {
            let last = if given.correlated {
                place.width
            } else {
                column + 1
            };
            entries.extend((column..last).map(|row| Entry {
                factor,
                term,
                row: place.offset + row,
                column: place.offset + column,
            }));
        }
    }
    entries
}

/// The factor of a term, and its place there.
pub(crate) fn place_of(model: &MixedModel, term: usize) -> (usize, crate::blocks::TermPlace) {
    let mut factors = model.factors.iter().enumerate();
    let found = factors.find_map(|(index, factor)| {
        let place = factor.terms.iter().find(|place| place.term == term)?;
        Some((index, *place))
    });
    let missing = crate::blocks::TermPlace {
        term,
        offset: 0,
        width: 0,
    };
    found.unwrap_or((0, missing))
}

/// Λ's blocks with these values of the entries.
pub(crate) fn blocks_of(model: &MixedModel, entries: &[Entry], theta: &[f64]) -> Vec<DMatrix<f64>> {
    let factors = model.factors.iter();
    let mut blocks: Vec<DMatrix<f64>> = factors
        .map(|factor| DMatrix::zeros(factor.width, factor.width))
        .collect();
    for (entry, value) in entries.iter().zip(theta) {
        blocks[entry.factor][(entry.row, entry.column)] = *value;
    }
    blocks
}

/// The part of a derivative by blocks that belongs to the entries.
pub(crate) fn entries_from(entries: &[Entry], blocks: &[DMatrix<f64>]) -> Vec<f64> {
    let values = entries.iter().map(|e| blocks[e.factor][(e.row, e.column)]);
    values.collect()
}

/// Where the search starts: effects as large as the residual.
pub(crate) fn start_of(entries: &[Entry], size: f64) -> Vec<f64> {
    let diagonal = |e: &Entry| if e.row == e.column { size } else { 0.0 };
    entries.iter().map(diagonal).collect()
}

/// Covariance of a term's effects over σ², in the term's own columns.
pub(crate) fn relative_covariance(
    model: &MixedModel,
    blocks: &[DMatrix<f64>],
    term: usize,
) -> DMatrix<f64> {
    let (factor, place) = place_of(model, term);
    let part = |matrix: &DMatrix<f64>| {
        matrix
            .view((place.offset, place.offset), (place.width, place.width))
            .into_owned()
    };
    let root = part(&blocks[factor]);
    let basis = part(&model.factors[factor].basis);
    // effects = basis⁻¹ · scaled effects; the diagonal of the basis is positive
    let root = basis.solve_upper_triangular(&root).unwrap_or(root);
    &root * root.transpose()
}

/// Lower triangle of a positive semidefinite matrix; zero columns where singular.
pub(crate) fn semidefinite_root(matrix: &DMatrix<f64>) -> DMatrix<f64> {
    /// A pivot below this share of its diagonal is rounding.
    const ZERO: f64 = 1e-14;
    let q = matrix.nrows();
    let mut root = DMatrix::zeros(q, q);
    for j in 0..q {
        let used: f64 = (0..j).map(|k| root[(j, k)] * root[(j, k)]).sum();
        let pivot = matrix[(j, j)] - used;
        if pivot <= ZERO * matrix[(j, j)] {
            continue;
        }
        root[(j, j)] = pivot.sqrt();
        for i in j + 1..q {
            let sum: f64 = (0..j).map(|k| root[(i, k)] * root[(j, k)]).sum();
            root[(i, j)] = (matrix[(i, j)] - sum) / root[(j, j)];
        }
    }
    root
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn closed_form_root_of_a_singular_matrix() {
        let matrix = DMatrix::from_row_slice(3, 3, &[4.0, 2.0, 0.0, 2.0, 1.0, 0.0, 0.0, 0.0, 9.0]);
        let root = semidefinite_root(&matrix);
        let expected =
            DMatrix::from_row_slice(3, 3, &[2.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 3.0]);
        assert!((root - expected).amax() < 1e-15);
    }
}
