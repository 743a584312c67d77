//! Small symmetric positive definite systems.

/// Pivots below this fraction of the diagonal mean that the columns cannot be
/// told apart in double precision.
pub const SINGULAR: f64 = 1e-14;

/// Lower factor L of A = L Lᵀ with the matrix scaled to a unit diagonal, and
/// the scale; `None` when A is not positive definite to [`SINGULAR`].
fn factor<const P: usize>(matrix: &[[f64; P]; P]) -> Option<([[f64; P]; P], [f64; P])> {
    let scale: [f64; P] = std::array::from_fn(|i| matrix[i][i].sqrt());
    if scale.iter().any(|s| !s.is_finite() || *s <= 0.0) {
        return None;
    }
    let mut lower = [[0.0; P]; P];
    for i in 0..P {
        for j in 0..=i {
            let mut sum = matrix[i][j] / (scale[i] * scale[j]);
            for k in 0..j {
                sum -= lower[i][k] * lower[j][k];
            }
            if i == j {
                if sum.is_nan() || sum <= SINGULAR {
                    return None;
                }
                lower[i][i] = sum.sqrt();
            } else {
                lower[i][j] = sum / lower[j][j];
            }
        }
    }
    Some((lower, scale))
}

/// Lower factor L of A = L Lᵀ; `None` when A is not positive definite.
pub fn lower<const P: usize>(matrix: &[[f64; P]; P]) -> Option<[[f64; P]; P]> {
    let (mut lower, scale) = factor(matrix)?;
    for i in 0..P {
        for j in 0..=i {
            lower[i][j] *= scale[i];
        }
    }
    Some(lower)
}

/// Solution of A x = b; `None` when A is not positive definite.
///
/// # Example
/// ```
/// let x = windfall_numerics::cholesky::solve(&[[4.0, 2.0], [2.0, 3.0]], &[2.0, 5.0]).unwrap();
/// assert!((x[0] + 0.5).abs() < 1e-15 && (x[1] - 2.0).abs() < 1e-15);
/// ```
pub fn solve<const P: usize>(matrix: &[[f64; P]; P], right: &[f64; P]) -> Option<[f64; P]> {
    Some(solve_factored(&factor(matrix)?, right))
}

/// Solution of A x = b with the factors of A.
fn solve_factored<const P: usize>(
    (lower, scale): &([[f64; P]; P], [f64; P]),
    right: &[f64; P],
) -> [f64; P] {
    let mut x: [f64; P] = std::array::from_fn(|i| right[i] / scale[i]);
    for i in 0..P {
        for k in 0..i {
            x[i] -= lower[i][k] * x[k];
        }
        x[i] /= lower[i][i];
    }
    for i in (0..P).rev() {
        for k in i + 1..P {
            x[i] -= lower[k][i] * x[k];
        }
        x[i] /= lower[i][i];
    }
    std::array::from_fn(|i| x[i] / scale[i])
}

/// Inverse of a symmetric positive definite matrix; `None` when it is not.
pub fn inverse<const P: usize>(matrix: &[[f64; P]; P]) -> Option<[[f64; P]; P]> {
    let factored = factor(matrix)?;
    let mut out = [[0.0; P]; P];
    for j in 0..P {
        let unit = std::array::from_fn(|i| if i == j { 1.0 } else { 0.0 });
        let column = solve_factored(&factored, &unit);
        for i in 0..P {
            out[i][j] = column[i];
        }
    }
    Some(out)
}
