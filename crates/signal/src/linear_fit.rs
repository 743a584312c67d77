//! Least squares with a row of functions of time for each sample.

use crate::noise::colour::{mean_inflation, persistence};
use windfall_numerics::cholesky::inverse;

/// Coefficients that make a sum of functions fit samples.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct LinearFit<const P: usize> {
    pub coefficients: [f64; P],
    /// Standard uncertainties, with the correlation between successive residuals.
    pub deviations: [f64; P],
    /// (AᵀA)⁻¹ of the rows A.
    pub inverse: [[f64; P]; P],
    /// Factor from this inverse to the covariance of the coefficients.
    pub variance: f64,
    /// √(Σ residual² / (n − P)).
    pub scatter: f64,
}

/// Least squares of `values` on the functions that `row` gives at each time; `None` with
/// no more samples than functions, or where these depend on each other.
///
/// Residuals that follow each other are correlated (first-order autoregression), and
/// uncertainties are raised as that of a mean would be.
pub(crate) fn linear_fit<const P: usize>(
    times: &[f64],
    values: &[f64],
    row: impl Fn(f64) -> [f64; P],
) -> Option<LinearFit<P>> {
    let rows: Vec<[f64; P]> = times.iter().map(|&t| row(t)).collect();
    fit_rows(&rows, values)
}

/// [`linear_fit`] with the row of each value.
pub(crate) fn fit_rows<const P: usize>(rows: &[[f64; P]], values: &[f64]) -> Option<LinearFit<P>> {
    if values.len() <= P {
        return None;
    }
    let mut matrix = [[0.0; P]; P];
    let mut right = [0.0; P];
    // The lower triangle, which is all that the inverse reads.
    for (row, value) in rows.iter().zip(values) {
        for i in 0..P {
            right[i] += row[i] * value;
            for j in 0..=i {
                matrix[i][j] += row[i] * row[j];
            }
        }
    }
    // Its rows are scaled to one size there.
    let inverse = inverse(&matrix)?;
    let coefficients: [f64; P] =
        std::array::from_fn(|i| (0..P).map(|j| inverse[i][j] * right[j]).sum::<f64>());
    let residual = |(row, value): (&[f64; P], &f64)| value - sum(row, &coefficients);
    let residuals: Vec<f64> = rows.iter().zip(values).map(residual).collect();
    let square = residuals.iter().map(|r| r * r).sum::<f64>() / (residuals.len() - P) as f64;
    let inflation = mean_inflation(persistence(&residuals).unwrap_or(0.0)).max(1.0);
    let variance = square * inflation;
    Some(LinearFit {
        coefficients,
        deviations: std::array::from_fn(|i| (variance * inverse[i][i]).sqrt()),
        inverse,
        variance,
        scatter: square.sqrt(),
    })
}

/// Σ aᵢ bᵢ.
pub(crate) fn sum<const P: usize>(a: &[f64; P], b: &[f64; P]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn closed_form_line_through_three_points() {
        // Through (0, 0), (1, 1), (2, 5): slope 5/2, level −1/2; residuals ½, −1, ½.
        let found = linear_fit(&[0.0, 1.0, 2.0], &[0.0, 1.0, 5.0], |t| [1.0, t]).unwrap();
        assert!((found.coefficients[0] + 0.5).abs() < 1e-14);
        assert!((found.coefficients[1] - 2.5).abs() < 1e-14);
        assert!((found.scatter - 1.5f64.sqrt()).abs() < 1e-14);
        // Var(slope) = s²/Σ(t − 1)².
        assert!((found.deviations[1] - 0.75f64.sqrt()).abs() < 1e-14);
        assert_eq!(linear_fit(&[0.0, 1.0], &[0.0, 1.0], |t| [1.0, t]), None);
    }
}
