//! Small positive definite systems against closed forms.
#![cfg_attr(test, allow(clippy::unwrap_used))]

use windfall_numerics::cholesky::{inverse, solve};

/// 1 / (i + j + 1), condition number 1.6e4.
fn hilbert() -> [[f64; 4]; 4] {
    std::array::from_fn(|i| std::array::from_fn(|j| 1.0 / (i + j + 1) as f64))
}

/// Integers, from the closed form of Choi (1983), Am. Math. Monthly 90:301.
const HILBERT_INVERSE: [[f64; 4]; 4] = [
    [16.0, -120.0, 240.0, -140.0],
    [-120.0, 1200.0, -2700.0, 1680.0],
    [240.0, -2700.0, 6480.0, -4200.0],
    [-140.0, 1680.0, -4200.0, 2800.0],
];

#[test]
fn closed_form_hilbert_inverse() {
    let found = inverse(&hilbert()).unwrap();
    for i in 0..4 {
        for j in 0..4 {
            let error = (found[i][j] / HILBERT_INVERSE[i][j] - 1.0).abs();
            assert!(error < 1e-11, "{i} {j}: {}", found[i][j]);
        }
    }
}

/// H x = first column of the identity plus twice the third.
#[test]
fn closed_form_hilbert_solution() {
    let found = solve(&hilbert(), &[1.0, 0.0, 2.0, 0.0]).unwrap();
    for i in 0..4 {
        let expected = HILBERT_INVERSE[i][0] + 2.0 * HILBERT_INVERSE[i][2];
        assert!((found[i] / expected - 1.0).abs() < 1e-11, "{found:?}");
    }
}

/// Rows and columns in other units: D H D with the powers of ten that stiffness,
/// damping and time bring, (D H D)⁻¹ = D⁻¹ H⁻¹ D⁻¹.
#[test]
fn closed_form_hilbert_in_other_units() {
    let scale = [1e-9, 1e6, 1.0, 1e-3];
    let mut matrix = hilbert();
    for i in 0..4 {
        for j in 0..4 {
            matrix[i][j] *= scale[i] * scale[j];
        }
    }
    let found = inverse(&matrix).unwrap();
    for i in 0..4 {
        for j in 0..4 {
            let expected = HILBERT_INVERSE[i][j] / (scale[i] * scale[j]);
            assert!((found[i][j] / expected - 1.0).abs() < 1e-11);
        }
    }
}

#[test]
fn rejects_matrices_that_are_not_positive_definite() {
    let right = [1.0, 1.0];
    for matrix in [
        [[1.0, 1.0], [1.0, 1.0]],
        [[1.0, 2.0], [2.0, 1.0]],
        [[0.0, 0.0], [0.0, 1.0]],
        [[-1.0, 0.0], [0.0, 1.0]],
        [[f64::NAN, 0.0], [0.0, 1.0]],
        [[1.0, f64::NAN], [f64::NAN, 1.0]],
        [[f64::INFINITY, 0.0], [0.0, 1.0]],
    ] {
        assert_eq!(solve(&matrix, &right), None, "{matrix:?}");
        assert_eq!(inverse(&matrix), None, "{matrix:?}");
    }
}
