//! Columns made orthonormal, and which column depends on those before it.

use nalgebra::DMatrix;

/// Least length of a column's orthogonal part, relative to it (R's `lm` takes 1e-7; here
/// columns are orthogonalised twice).
const DEPENDENCE: f64 = 1e-10;

/// Least part of a column's length for a coefficient to be named in a dependence.
const NAMED: f64 = 1e-6;

/// Orthonormal columns q and upper triangular r with columns = q r.
#[derive(Clone, Debug)]
pub(crate) struct Basis {
    /// The orthonormal columns.
    pub q: Vec<Vec<f64>>,
    /// The triangle, positive on the diagonal.
    pub r: DMatrix<f64>,
}

impl Basis {
    /// Inverse of the triangle.
    pub fn inverse(&self) -> DMatrix<f64> {
        let p = self.r.nrows();
        let inverse = self.r.solve_upper_triangular(&DMatrix::identity(p, p));
        inverse.unwrap_or_else(|| DMatrix::zeros(p, p))
    }
}

/// A column that is a combination of columns before it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Dependent {
    pub column: usize,
    /// The columns it is made of; none when it is zero.
    pub on: Vec<usize>,
}

/// Gram-Schmidt, each column twice (Giraud, Langou and Rozložník 2005).
pub(crate) fn orthonormal_basis(columns: &[&[f64]]) -> Result<Basis, Dependent> {
    let p = columns.len();
    let mut r = DMatrix::zeros(p, p);
    let mut q: Vec<Vec<f64>> = Vec::with_capacity(p);
    for (j, column) in columns.iter().enumerate() {
        let length = norm(column);
        let mut rest = column.to_vec();
        for _ in 0..2 {
            for (i, earlier) in q.iter().enumerate() {
                let share = dot(earlier, &rest);
                r[(i, j)] += share;
                add_scaled(&mut rest, -share, earlier);
            }
        }
        let left = norm(&rest);
        if left <= DEPENDENCE * length || length == 0.0 {
            return Err(dependent(j, &r, columns));
        }
        rest.iter_mut().for_each(|value| *value /= left);
        r[(j, j)] = left;
        q.push(rest);
    }
    Ok(Basis { q, r })
}

/// Which columns the j-th is made of, from the triangle before it.
fn dependent(j: usize, r: &DMatrix<f64>, columns: &[&[f64]]) -> Dependent {
    let square = r.view((0, 0), (j, j)).into_owned();
    let right = r.view((0, j), (j, 1)).into_owned();
    let weights = square.solve_upper_triangular(&right);
    let length = norm(columns[j]);
    let on = weights.map_or_else(Vec::new, |weights| {
        (0..j)
            .filter(|i| weights[*i].abs() * norm(columns[*i]) > NAMED * length)
            .collect()
    });
    Dependent { column: j, on }
}

/// Sum of products, in eight running sums that the compiler keeps in registers.
pub(crate) fn dot(a: &[f64], b: &[f64]) -> f64 {
    let mut sums = [0.0; 8];
    let (a8, b8) = (a.chunks_exact(8), b.chunks_exact(8));
    let rest = a8.remainder().iter().zip(b8.remainder());
    let rest: f64 = rest.map(|(x, y)| x * y).sum();
    for (x, y) in a8.zip(b8) {
        for lane in 0..8 {
            sums[lane] += x[lane] * y[lane];
        }
    }
    let halves = [0, 1, 2, 3].map(|lane| sums[lane] + sums[lane + 4]);
    (halves[0] + halves[1]) + (halves[2] + halves[3]) + rest
}

/// Adds a multiple of values to sums.
pub(crate) fn add_scaled(sums: &mut [f64], factor: f64, values: &[f64]) {
    for (sum, value) in sums.iter_mut().zip(values) {
        *sum += factor * value;
    }
}

/// Length of a column, without overflow of squares for ordinary data.
pub(crate) fn norm(a: &[f64]) -> f64 {
    dot(a, a).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn closed_form_columns_are_orthonormal_and_multiply_back() {
        let one = vec![1.0; 50];
        let x: Vec<f64> = (0..50).map(|i| 2000.0 + f64::from(i) / 10.0).collect();
        let square: Vec<f64> = x.iter().map(|x| x * x).collect();
        let basis = orthonormal_basis(&[&one, &x, &square]).unwrap();
        for i in 0..3 {
            for j in 0..3 {
                let expected = f64::from(u8::from(i == j));
                assert!((dot(&basis.q[i], &basis.q[j]) - expected).abs() < 1e-14);
            }
        }
        for row in [0, 17, 49] {
            let made: f64 = (0..3).map(|k| basis.q[k][row] * basis.r[(k, 2)]).sum();
            assert!((made / square[row] - 1.0).abs() < 1e-13);
        }
    }

    #[test]
    fn rejects_a_combination_and_names_its_parts() {
        let one = [1.0; 4];
        let a = [1.0, 0.0, 1.0, 0.0];
        let other = [3.0, 1.0, 4.0, 1.5];
        let b = [0.0, 1.0, 0.0, 1.0];
        let found = orthonormal_basis(&[&one, &a, &other, &b]).unwrap_err();
        assert_eq!(
            found,
            Dependent {
                column: 3,
                on: vec![0, 1]
            }
        );
        let zero = orthonormal_basis(&[&one, &[0.0; 4]]).unwrap_err();
        assert_eq!(
            zero,
            Dependent {
                column: 1,
                on: vec![]
            }
        );
    }
}
