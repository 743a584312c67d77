//! What a design lets a model be known to.

use nalgebra::DMatrix;

/// Diagonal elements of R below this part of the largest mean aliased terms; 1.
pub const RANK_TOLERANCE: f64 = 1e-9;

/// Figures of a design for a model; variances in units of that of one run.
#[derive(Clone, Debug, PartialEq, serde::Serialize, utoipa::ToSchema)]
pub struct DesignQuality {
    /// Runs, n.
    #[serde(skip)]
    pub runs: usize,
    /// Columns of the model matrix, p.
    #[serde(skip)]
    pub terms: usize,
    /// Variance of each coefficient.
    pub variances: Vec<f64>,
    /// |X'X|^(1/p) / n; 1 for an orthogonal design of ±1 levels.
    pub d_efficiency: f64,
    /// Largest leverage of a run.
    pub max_leverage: f64,
    /// Mean variance of prediction over the region.
    pub mean_variance: f64,
    /// Largest variance of prediction at the points of the region and the runs.
    pub max_variance: f64,
}

/// Figures of a model matrix; `None` where its terms cannot be told apart.
///
/// * `rows`: model rows of the runs
/// * `region`: weights and model rows of the region, weights summing to 1; rows
///   of weight 0 count for the largest variance alone
pub fn design_quality(rows: &[Vec<f64>], region: &[(f64, Vec<f64>)]) -> Option<DesignQuality> {
    let (runs, terms) = (rows.len(), rows.first()?.len());
    if runs < terms {
        return None;
    }
    let qr = DMatrix::from_fn(runs, terms, |i, j| rows[i][j]).qr();
    let (q, r) = (qr.q(), qr.r());
    let largest = r.diagonal().amax();
    if r.diagonal()
        .iter()
        .any(|d| d.abs() <= RANK_TOLERANCE * largest)
    {
        return None;
    }
    let inverse = r.solve_upper_triangular(&DMatrix::identity(terms, terms))?;
    let log_det: f64 = r.diagonal().iter().map(|d| 2.0 * d.abs().ln()).sum();
    let leverages = q.row_iter().map(|row| row.norm_squared());
    let max_leverage = leverages.fold(0.0, f64::max);
    // f' (X'X)⁻¹ f = |R⁻ᵀ f|².
    let variance = |row: &[f64]| -> f64 {
        let projected = inverse.tr_mul(&nalgebra::DVector::from_column_slice(row));
        projected.norm_squared()
    };
    let (mut mean_variance, mut max_variance) = (0.0, max_leverage);
    for (weight, row) in region {
        let here = variance(row);
        mean_variance += weight * here;
        max_variance = here.max(max_variance);
    }
    Some(DesignQuality {
        runs,
        terms,
        d_efficiency: (log_det / terms as f64).exp() / runs as f64,
        max_leverage,
        mean_variance,
        max_variance,
        variances: inverse.row_iter().map(|row| row.norm_squared()).collect(),
    })
}
