//! An orthonormal basis of the columns of a matrix, and residuals of a regression on it.

use nalgebra::DMatrix;

/// Columns that projection shortens below this part are dependent.
const RANK_TOLERANCE: f64 = 1e-10;

/// An orthonormal basis of the span of columns.
///
/// Gram-Schmidt, each column twice (Giraud, Langou and Rozložník 2005).
pub fn orthonormal_basis(columns: &DMatrix<f64>) -> Vec<Vec<f64>> {
    let mut basis: Vec<Vec<f64>> = Vec::with_capacity(columns.ncols());
    for column in columns.column_iter() {
        let mut rest: Vec<f64> = column.iter().copied().collect();
        let length = dot(&rest, &rest).sqrt();
        for _ in 0..2 {
            take_out(&basis, &mut rest);
        }
        let left = dot(&rest, &rest).sqrt();
        if left > RANK_TOLERANCE * length {
            rest.iter_mut().for_each(|value| *value /= left);
            basis.push(rest);
        }
    }
    basis
}

/// Subtracts the part in the span of the basis, which leaves the residuals.
pub fn take_out(basis: &[Vec<f64>], values: &mut [f64]) {
    for vector in basis {
        let share = dot(vector, values);
        for (value, part) in values.iter_mut().zip(vector) {
            *value -= share * part;
        }
    }
}

/// Scalar product.
pub fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
