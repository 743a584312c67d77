//! Symmetric matrices that are zero left of an envelope: Cholesky factor, solves
//! and the part of the inverse inside the envelope.
//!
//! The factor of such a matrix has the same envelope (George and Liu 1981,
//! Computer Solution of Large Sparse Positive Definite Systems, ch. 4). Groups
//! nested in groups give a narrow envelope, crossed groups a full one.

use crate::basis::{add_scaled, dot};

/// Where the rows of a lower triangle begin.
#[derive(Clone, Debug, Default)]
pub(crate) struct Envelope {
    /// First column of each row that may differ from zero.
    pub first: Vec<usize>,
    /// Place of each row's first entry among the values; one more at the end.
    pub start: Vec<usize>,
}

impl Envelope {
    pub(crate) fn of_first(first: Vec<usize>) -> Self {
        let mut start = Vec::with_capacity(first.len() + 1);
        let mut place = 0;
        for (row, first) in first.iter().enumerate() {
            start.push(place);
            place += row - first + 1;
        }
        start.push(place);
        Self { first, start }
    }

    pub(crate) fn rows(&self) -> usize {
        self.first.len()
    }

    pub(crate) fn entries(&self) -> usize {
        self.start[self.rows()]
    }

    /// Place of entry (i, j), first(i) ≤ j ≤ i.
    pub(crate) fn place(&self, i: usize, j: usize) -> usize {
        self.start[i] + j - self.first[i]
    }

    /// Entry (i, j) of a symmetric matrix, i and j inside the envelope in either order.
    pub(crate) fn symmetric(&self, values: &[f64], i: usize, j: usize) -> f64 {
        values[self.place(i.max(j), i.min(j))]
    }

    /// Entries of row i from column `from` up to, and without, column `to`.
    fn part<'a>(&self, values: &'a [f64], i: usize, from: usize, to: usize) -> &'a [f64] {
        let start = self.place(i, from);
        &values[start..start + to - from]
    }

    /// The Cholesky factor in place; `None` where a pivot is not positive.
    pub(crate) fn factor(&self, values: &mut [f64]) -> Option<()> {
        for i in 0..self.rows() {
            for j in self.first[i]..=i {
                let from = self.first[i].max(self.first[j]);
                let sum = dot(self.part(values, i, from, j), self.part(values, j, from, j));
                let left = values[self.place(i, j)] - sum;
                let value = if i == j {
                    if left <= 0.0 || !left.is_finite() {
                        return None;
                    }
                    left.sqrt()
                } else {
                    left / values[self.place(j, j)]
                };
                values[self.place(i, j)] = value;
            }
        }
        Some(())
    }

    /// Twice the sum of logarithms of a factor's diagonal.
    pub(crate) fn log_determinant(&self, factor: &[f64]) -> f64 {
        let logs = (0..self.rows()).map(|i| factor[self.place(i, i)].ln());
        2.0 * logs.sum::<f64>()
    }

    /// L x = b in place, for `width` right sides whose rows lie one after another.
    pub(crate) fn solve_lower(&self, factor: &[f64], right: &mut [f64], width: usize) {
        for i in 0..self.rows() {
            let (before, rest) = right.split_at_mut(i * width);
            let row = &mut rest[..width];
            for j in self.first[i]..i {
                let l = factor[self.place(i, j)];
                add_scaled(row, -l, &before[j * width..(j + 1) * width]);
            }
            let pivot = factor[self.place(i, i)];
            row.iter_mut().for_each(|value| *value /= pivot);
        }
    }

    /// Lᵀ x = b in place.
    pub(crate) fn solve_upper(&self, factor: &[f64], right: &mut [f64], width: usize) {
        for i in (0..self.rows()).rev() {
            let (before, rest) = right.split_at_mut(i * width);
            let row = &mut rest[..width];
            let pivot = factor[self.place(i, i)];
            row.iter_mut().for_each(|value| *value /= pivot);
            for j in self.first[i]..i {
                let l = factor[self.place(i, j)];
                add_scaled(&mut before[j * width..(j + 1) * width], -l, row);
            }
        }
    }

    /// Symmetric matrix times `width` columns.
    pub(crate) fn multiply(&self, values: &[f64], columns: &[f64], width: usize) -> Vec<f64> {
        let mut product = vec![0.0; columns.len()];
        for i in 0..self.rows() {
            for j in self.first[i]..=i {
                let value = values[self.place(i, j)];
                for k in 0..width {
                    product[i * width + k] += value * columns[j * width + k];
                    if j < i {
                        product[j * width + k] += value * columns[i * width + k];
                    }
                }
            }
        }
        product
    }

    /// Takes `vector` `vector`' from the rows and columns `at`, ascending.
    pub(crate) fn subtract_square(&self, values: &mut [f64], at: &[usize], vector: &[f64]) {
        let together = contiguous(at);
        for (a, (i, x)) in at.iter().zip(vector).enumerate() {
            if together {
                let from = self.place(*i, at[0]);
                let row = &mut values[from..=from + a];
                add_scaled(row, -*x, vector);
            } else {
                for (j, y) in at[..=a].iter().zip(vector) {
                    values[self.place(*i, *j)] -= x * y;
                }
            }
        }
    }

    /// The symmetric part in rows and columns `at`, ascending, times a vector.
    pub(crate) fn multiply_part(
        &self,
        values: &[f64],
        at: &[usize],
        vector: &[f64],
        product: &mut Vec<f64>,
    ) {
        product.clear();
        product.resize(at.len(), 0.0);
        let together = contiguous(at);
        for (a, (i, x)) in at.iter().zip(vector).enumerate() {
            let (before, rest) = product.split_at_mut(a);
            if together {
                let row = self.part(values, *i, at[0], *i + 1);
                rest[0] += dot(row, &vector[..=a]);
                add_scaled(before, *x, row);
            } else {
                for (b, j) in at[..a].iter().enumerate() {
                    let value = values[self.place(*i, *j)];
                    rest[0] += value * vector[b];
                    before[b] += value * x;
                }
                rest[0] += values[self.place(*i, *i)] * x;
            }
        }
    }

    /// (L Lᵀ)⁻¹ inside the envelope, last column first (Takahashi, Fagan and Chin 1973).
    pub(crate) fn inverse(&self, factor: &[f64]) -> Vec<f64> {
        let rows = self.rows();
        let mut inverse = vec![0.0; self.entries()];
        let mut below: Vec<usize> = Vec::with_capacity(rows);
        let (mut column, mut sums) = (Vec::with_capacity(rows), Vec::new());
        for j in (0..rows).rev() {
            below.clear();
            below.extend((j + 1..rows).filter(|i| self.first[*i] <= j));
            column.clear();
            column.extend(below.iter().map(|i| factor[self.place(*i, j)]));
            let pivot = factor[self.place(j, j)];
            self.multiply_part(&inverse, &below, &column, &mut sums);
            for (i, sum) in below.iter().zip(&sums) {
                inverse[self.place(*i, j)] = -sum / pivot;
            }
            inverse[self.place(j, j)] = (1.0 / pivot + dot(&column, &sums) / pivot) / pivot;
        }
        inverse
    }
}

/// Whether numbers follow each other without a gap.
fn contiguous(at: &[usize]) -> bool {
    matches!((at.first(), at.last()), (Some(first), Some(last)) if last - first + 1 == at.len())
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::DMatrix;

    #[test]
    fn reference_factor_solves_and_inverse_agree_with_nalgebra() {
        let first = vec![0, 0, 2, 1, 2, 0];
        let envelope = Envelope::of_first(first);
        let n = envelope.rows();
        let mut values: Vec<f64> = (0..envelope.entries())
            .map(|k| ((k * 7 + 3) % 11) as f64 / 11.0 - 0.4)
            .collect();
        (0..n).for_each(|i| values[envelope.place(i, i)] += 3.0);
        let dense = DMatrix::from_fn(n, n, |i, j| {
            let (i, j) = (i.max(j), i.min(j));
            if j < envelope.first[i] {
                0.0
            } else {
                values[envelope.place(i, j)]
            }
        });
        let expected = dense.clone().try_inverse().unwrap();
        let columns: Vec<f64> = (0..2 * n).map(|k| k as f64 - 3.0).collect();
        let product = envelope.multiply(&values, &columns, 2);

        let mut factor = values;
        envelope.factor(&mut factor).unwrap();
        let inverse = envelope.inverse(&factor);
        for i in 0..n {
            for j in envelope.first[i]..=i {
                let found = inverse[envelope.place(i, j)];
                assert!((found - expected[(i, j)]).abs() < 1e-14, "{i} {j}");
            }
        }
        let mut back = product;
        envelope.solve_lower(&factor, &mut back, 2);
        envelope.solve_upper(&factor, &mut back, 2);
        for (found, expected) in back.iter().zip(&columns) {
            assert!((found - expected).abs() < 1e-13);
        }
        let determinant = dense.determinant().ln();
        assert!((envelope.log_determinant(&factor) - determinant).abs() < 1e-13);
    }

    #[test]
    fn closed_form_parts_with_and_without_gaps() {
        let envelope = Envelope::of_first(vec![0, 0, 0, 1]);
        let values = [2.0, 3.0, 5.0, 7.0, 11.0, 13.0, 17.0, 19.0, 23.0];
        let mut product = Vec::new();
        envelope.multiply_part(&values, &[0, 2], &[1.0, 10.0], &mut product);
        assert_eq!(product, [72.0, 137.0]);
        envelope.multiply_part(&values, &[1, 2, 3], &[1.0, 10.0, 100.0], &mut product);
        assert_eq!(product, [1815.0, 2041.0, 2507.0]);
        let mut gap = values;
        envelope.subtract_square(&mut gap, &[0, 2], &[1.0, 2.0]);
        assert_eq!(gap, [1.0, 3.0, 5.0, 5.0, 11.0, 9.0, 17.0, 19.0, 23.0]);
        let mut together = values;
        envelope.subtract_square(&mut together, &[1, 2], &[1.0, 2.0]);
        assert_eq!(together, [2.0, 3.0, 4.0, 7.0, 9.0, 9.0, 17.0, 19.0, 23.0]);
    }

    #[test]
    fn rejects_an_indefinite_matrix() {
        let envelope = Envelope::of_first(vec![0, 0]);
        assert!(envelope.factor(&mut [1.0, 2.0, 1.0]).is_none());
    }
}
