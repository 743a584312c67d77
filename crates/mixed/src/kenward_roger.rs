//! Kenward and Roger's covariance of the coefficients and degrees of freedom.
//!
//! Kenward and Roger (1997), Small sample inference for fixed effects from
//! restricted maximum likelihood, Biometrics 53, 983-997; formulas as in Halekoh
//! and Højsgaard (2014), J. Stat. Softw. 59(9), doi 10.18637/jss.v059.i09.
//!
//! Everything is reduced from the rows to the random effects: with V the covariance
//! over σ², D = ΛΛ', M = Z'V⁻¹Z and B = Z'V⁻¹X,
//!
//! ```text
//! Z'V⁻²Z = M - M D M,  Z'V⁻²X = B - M D B,  X'V⁻²X = X'V⁻¹X - B'D B,
//! X'V⁻³X = X'V⁻²X - (Z'V⁻²X)'D B
//! ```

use crate::coefficient::{Coefficient, Estimated};
use crate::error::MixedError;
use crate::fit::{MixedFit, MixedMethod};
use crate::inference::{FTest, check_contrast, test_of};
use crate::minimise::directions;
use crate::theta::Entry;
use nalgebra::{DMatrix, DVector};
use windfall_distribution::tail::f_upper;

/// Most random effects of crossed factors: their matrices are dense.
pub const MOST_CROSSED_EFFECTS: usize = 1500;

/// Kenward and Roger's adjustment of a fit.
#[derive(Clone, Debug)]
pub struct KenwardRoger {
    /// Adjusted covariance of the coefficients.
    pub covariance: DMatrix<f64>,
    /// Covariance of the variance parameters over σ⁴.
    weights: DMatrix<f64>,
    /// -X'V⁻¹GᵣV⁻¹X of each parameter, X orthonormal.
    slopes: Vec<DMatrix<f64>>,
}

/// Adjusts a fit by restricted likelihood.
///
/// # Errors
/// [`MixedError::NeedsRestricted`] for a fit by plain maximum likelihood;
/// [`MixedError::ManyCrossedEffects`] beyond [`MOST_CROSSED_EFFECTS`] random effects
/// with several grouping factors (one factor has no bound);
/// [`MixedError::SingularInformation`] where the variances cannot be told apart.
pub fn kenward_roger(fit: &MixedFit) -> Result<KenwardRoger, MixedError> {
    if fit.method != MixedMethod::Reml {
        return Err(MixedError::NeedsRestricted);
    }
    let sums = sums_of(fit)?;
    let count = sums.slopes.len();
    let phi = &fit.state.covariance;
    let information = DMatrix::from_fn(count, count, |r, s| {
        let q = &sums.crossed[r.max(s)][r.min(s)];
        let p = (phi * &sums.slopes[r] * phi * &sums.slopes[s]).trace();
        sums.traces[(r, s)] - 2.0 * (phi * q).trace() + p
    });
    let weights = inverse(information)? * 2.0;
    let p = fit.model.coefficients();
    let mut middle = DMatrix::zeros(p, p);
    for r in 0..count {
        for s in 0..count {
            let q = if r >= s {
                sums.crossed[r][s].clone()
            } else {
                sums.crossed[s][r].transpose()
            };
            middle += (q - &sums.slopes[r] * phi * &sums.slopes[s]) * weights[(r, s)];
        }
    }
    let adjusted = phi + phi * middle * phi * 2.0;
    let basis = fit.model.basis.inverse();
    let mut covariance = &basis * adjusted * basis.transpose() * fit.residual_sd.powi(2);
    covariance = (&covariance + covariance.transpose()) * 0.5;
    Ok(KenwardRoger {
        covariance,
        weights,
        slopes: sums.slopes,
    })
}

/// Inverse of the information, scaled to a unit diagonal first.
fn inverse(information: DMatrix<f64>) -> Result<DMatrix<f64>, MixedError> {
    /// Condition beyond which parameters cannot be told apart.
    const CONDITION: f64 = 1e-11;
    let n = information.nrows();
    let scale: Vec<f64> = information
        .diagonal()
        .iter()
        .map(|d| d.abs().sqrt().recip())
        .collect();
    let scaled = DMatrix::from_fn(n, n, |i, j| information[(i, j)] * scale[i] * scale[j]);
    if !scaled.iter().all(|value| value.is_finite()) {
        return Err(MixedError::SingularInformation);
    }
    let eigen = scaled.symmetric_eigen();
    if eigen.eigenvalues.iter().any(|value| *value < CONDITION) {
        return Err(MixedError::SingularInformation);
    }
    let mut inverse = DMatrix::zeros(n, n);
    for (value, vector) in directions(&eigen) {
        inverse += vector * vector.transpose() / *value;
    }
    Ok(DMatrix::from_fn(n, n, |i, j| {
        inverse[(i, j)] * scale[i] * scale[j]
    }))
}

/// Sums over the random effects; the last parameter is the residual variance.
struct Sums {
    /// tr(V⁻¹GᵣV⁻¹Gₛ).
    traces: DMatrix<f64>,
    /// Pᵣ = -X'V⁻¹GᵣV⁻¹X.
    slopes: Vec<DMatrix<f64>>,
    /// X'V⁻¹GᵣV⁻¹GₛV⁻¹X, s ≤ r.
    crossed: Vec<Vec<DMatrix<f64>>>,
}

/// One random effect of a piece.
#[derive(Clone, Copy, Debug)]
struct Effect {
    factor: usize,
    column: usize,
    /// Place of the group's first column in the piece.
    group: usize,
}

/// Random effects that are independent of all others.
struct Piece {
    effects: Vec<Effect>,
    /// Z'Z.
    square: DMatrix<f64>,
    /// Z'V⁻¹X.
    projection: DMatrix<f64>,
}

fn sums_of(fit: &MixedFit) -> Result<Sums, MixedError> {
    let model = &fit.model;
    let p = model.coefficients();
    let parameters = &fit.estimate.entries;
    let count = parameters.len() + 1;
    let phi_inverse = fit
        .state
        .covariance
        .clone()
        .try_inverse()
        .ok_or(MixedError::SingularInformation)?;
    let mut sums = Sums {
        traces: DMatrix::zeros(count, count),
        slopes: vec![DMatrix::zeros(p, p); count],
        crossed: (0..count)
            .map(|r| vec![DMatrix::zeros(p, p); r + 1])
            .collect(),
    };
    // the residual's own: tr V⁻² = n - Σ ..., X'V⁻²X = X'V⁻¹X - Σ ...
    let last = count - 1;
    sums.traces[(last, last)] = model.rows() as f64;
    sums.slopes[last] = -phi_inverse.clone();
    sums.crossed[last][last] = phi_inverse;
    if model.factors.len() == 1 {
        for group in 0..model.leaf.groups {
            add_piece(fit, parameters, &group_piece(fit, group), &mut sums)?;
        }
    } else {
        let effects = model.leaf.groups * model.leaf.width + model.trunk.envelope.rows();
        if effects > MOST_CROSSED_EFFECTS {
            return Err(MixedError::ManyCrossedEffects {
                effects,
                most: MOST_CROSSED_EFFECTS,
            });
        }
        add_piece(fit, parameters, &whole_piece(fit), &mut sums)?;
    }
    for r in 0..count {
        for s in 0..r {
            sums.traces[(s, r)] = sums.traces[(r, s)];
        }
    }
    Ok(sums)
}

/// One group of the only factor.
fn group_piece(fit: &MixedFit, group: usize) -> Piece {
    let (leaf, p) = (&fit.model.leaf, fit.model.coefficients());
    let q = leaf.width;
    let square = &leaf.square[group * q * q..(group + 1) * q * q];
    let effect = |column| Effect {
        factor: 0,
        column,
        group: 0,
    };
    Piece {
        effects: (0..q).map(effect).collect(),
        square: DMatrix::from_row_slice(q, q, square),
        projection: DMatrix::from_fn(q, p, |i, j| {
            fit.projections[0][(group * q + i) * (p + 1) + j]
        }),
    }
}

/// All random effects of all factors.
fn whole_piece(fit: &MixedFit) -> Piece {
    let model = &fit.model;
    let p = model.coefficients();
    let mut effects = Vec::new();
    let mut starts = Vec::new();
    let mut projection = Vec::new();
    for (factor, given) in model.factors.iter().enumerate() {
        starts.push(effects.len());
        for _ in 0..given.groups {
            let group = effects.len();
            effects.extend((0..given.width).map(|column| Effect {
                factor,
                column,
                group,
            }));
        }
        for row in fit.projections[factor].chunks_exact(p + 1) {
            projection.extend_from_slice(&row[..p]);
        }
    }
    let mut square = DMatrix::zeros(effects.len(), effects.len());
    let mut entries: Vec<(usize, f64)> = Vec::new();
    for row in 0..model.rows() {
        entries.clear();
        for (factor, start) in model.factors.iter().zip(&starts) {
            let first = start + factor.group[row] * factor.width;
            let design = &factor.design[row * factor.width..(row + 1) * factor.width];
            entries.extend(design.iter().enumerate().map(|(k, z)| (first + k, *z)));
        }
        for (i, a) in &entries {
            for (j, b) in &entries {
                square[(*i, *j)] += a * b;
            }
        }
    }
    Piece {
        projection: DMatrix::from_row_slice(effects.len(), p, &projection),
        effects,
        square,
    }
}

/// Adds what the effects of a piece contribute.
fn add_piece(
    fit: &MixedFit,
    parameters: &[Entry],
    piece: &Piece,
    sums: &mut Sums,
) -> Result<(), MixedError> {
    let (root, own) = roots_of(fit, piece);
    let last = parameters.len();
    // M = Z'Z - Z'ZΛ (Λ'Z'ZΛ + I)⁻¹ Λ'Z'Z
    let scaled = root.tr_mul(&piece.square);
    let mut middle = &scaled * &root;
    (0..middle.nrows()).for_each(|i| middle[(i, i)] += 1.0);
    let cholesky = middle.cholesky().ok_or(MixedError::SingularInformation)?;
    let half = cholesky
        .l()
        .solve_lower_triangular(&scaled)
        .ok_or(MixedError::SingularInformation)?;
    let m = &piece.square - half.tr_mul(&half);
    let b = &piece.projection;
    let (dm, db) = (&own * &m, &own * b);
    let m2 = &m - m.tr_mul(&dm);
    let b2 = b - m.tr_mul(&db);

    let moved: Vec<DMatrix<f64>> = parameters.iter().map(|e| apply(e, piece, &m)).collect();
    let moved_b: Vec<DMatrix<f64>> = parameters.iter().map(|e| apply(e, piece, b)).collect();
    for r in 0..last {
        for s in 0..=r {
            sums.traces[(r, s)] += moved[r].component_mul(&moved[s].transpose()).sum();
            sums.crossed[r][s] += moved_b[r].tr_mul(&m) * &moved_b[s];
        }
        sums.slopes[r] -= moved_b[r].tr_mul(b);
        sums.traces[(last, r)] += apply(&parameters[r], piece, &m2).trace();
        sums.crossed[last][r] += b2.tr_mul(&moved_b[r]);
    }
    sums.traces[(last, last)] -= dm.trace() + own.component_mul(&m2).sum();
    sums.slopes[last] += b.tr_mul(&db);
    sums.crossed[last][last] -= b.tr_mul(&db) + b2.tr_mul(&db);
    Ok(())
}

/// Λ and Λ Λ' of the effects of a piece.
fn roots_of(fit: &MixedFit, piece: &Piece) -> (DMatrix<f64>, DMatrix<f64>) {
    let n = piece.effects.len();
    let mut root = DMatrix::zeros(n, n);
    let mut own = DMatrix::zeros(n, n);
    for (i, effect) in piece.effects.iter().enumerate() {
        let block = &fit.state.blocks[effect.factor];
        for k in 0..block.ncols() {
            root[(i, effect.group + k)] = block[(effect.column, k)];
            own[(i, effect.group + k)] = block.row(effect.column).dot(&block.row(k));
        }
    }
    (root, own)
}

/// The symmetric pattern of one covariance entry times a matrix.
fn apply(entry: &Entry, piece: &Piece, matrix: &DMatrix<f64>) -> DMatrix<f64> {
    let mut product = DMatrix::zeros(matrix.nrows(), matrix.ncols());
    for (i, effect) in piece.effects.iter().enumerate() {
        if effect.factor != entry.factor {
            continue;
        }
        if effect.column == entry.row {
            product
                .row_mut(i)
                .copy_from(&matrix.row(effect.group + entry.column));
        } else if effect.column == entry.column {
            product
                .row_mut(i)
                .copy_from(&matrix.row(effect.group + entry.row));
        }
    }
    product
}

/// Tests of every coefficient with the adjusted standard errors.
pub fn kenward_roger_tests(
    fit: &MixedFit,
    adjusted: &KenwardRoger,
    confidence: f64,
) -> Vec<Coefficient> {
    let p = fit.model.coefficients();
    let tests = (0..p).map(|k| {
        let weights = DVector::from_fn(p, |i, _| f64::from(u8::from(i == k)));
        let contrast = DMatrix::from_row_slice(1, p, weights.as_slice());
        let (df, _) = denominator(fit, adjusted, &contrast, 1);
        let name = &fit.model.x_names[k];
        test_of(fit, &adjusted.covariance, name, &weights, df, confidence)
    });
    tests.collect()
}

/// A sum of coefficients with Kenward and Roger's standard error and degrees of freedom.
pub fn kenward_roger_estimate(
    fit: &MixedFit,
    adjusted: &KenwardRoger,
    weights: &[f64],
) -> Estimated {
    let row = DMatrix::from_row_slice(1, weights.len(), weights);
    let value = (&row * DVector::from_column_slice(&fit.coefficients))[(0, 0)];
    Estimated {
        value,
        se: (&row * &adjusted.covariance * row.transpose())[(0, 0)].sqrt(),
        df: denominator(fit, adjusted, &row, 1).0,
    }
}

/// F test that all rows of `contrast` times the coefficients are zero. `f` is scaled,
/// as the method asks.
///
/// # Errors
/// [`MixedError::WrongLength`] unless there is a column per coefficient;
/// [`MixedError::EmptyContrast`] if the rows follow from each other.
pub fn kenward_roger_f(
    fit: &MixedFit,
    adjusted: &KenwardRoger,
    contrast: &DMatrix<f64>,
) -> Result<FTest, MixedError> {
    let p = fit.model.coefficients();
    crate::term::check_length("columns of the contrast", contrast.ncols(), p)?;
    check_contrast(contrast)?;
    let q = contrast.nrows();
    let value = contrast * DVector::from_column_slice(&fit.coefficients);
    let covariance = contrast * &adjusted.covariance * contrast.transpose();
    let cholesky = covariance.cholesky().ok_or(MixedError::EmptyContrast)?;
    let wald = value.dot(&cholesky.solve(&value));
    let (df, scaling) = denominator(fit, adjusted, contrast, q);
    let f = scaling * wald / q as f64;
    Ok(FTest {
        f,
        numerator: q,
        denominator: df,
        p: f_upper(f, q as f64, df),
    })
}

/// Degrees of freedom and the scaling of F for `q` independent rows.
fn denominator(
    fit: &MixedFit,
    adjusted: &KenwardRoger,
    contrast: &DMatrix<f64>,
    q: usize,
) -> (f64, f64) {
    /// Below these, quotients of the formulas are 0/0, as in balanced designs (pbkrtest).
    const NOUGHT: (f64, f64) = (1e-10, 1e-14);
    let q = q as f64;
    let phi = &fit.state.covariance;
    let contrast = contrast * fit.model.basis.inverse();
    let inner = &contrast * phi * contrast.transpose();
    let Some(inner) = inner.try_inverse() else {
        return (f64::NAN, f64::NAN);
    };
    let theta = contrast.tr_mul(&inner) * &contrast * phi;
    let turned: Vec<DMatrix<f64>> = adjusted.slopes.iter().map(|p| &theta * p * phi).collect();
    let (mut a1, mut a2) = (0.0, 0.0);
    for (r, left) in turned.iter().enumerate() {
        for (s, right) in turned.iter().enumerate() {
            let w = adjusted.weights[(r, s)];
            a1 += w * left.trace() * right.trace();
            a2 += w * left.component_mul(&right.transpose()).sum();
        }
    }
    let b = (a1 + 6.0 * a2) / (2.0 * q);
    let g = ((q + 1.0) * a1 - (q + 4.0) * a2) / ((q + 2.0) * a2);
    let c = 3.0 * q + 2.0 * (1.0 - g);
    let v0 = 1.0 + g / c * b;
    let v0 = if v0.abs() < NOUGHT.0 { 0.0 } else { v0 };
    let v1 = 1.0 - (q - g) / c * b;
    let v2 = 1.0 - (q + 2.0 - g) / c * b;
    let mean = 1.0 - a2 / q;
    let ratio = if mean.abs() < NOUGHT.1 && v1.abs() < NOUGHT.1 {
        1.0
    } else {
        mean / v1
    };
    let rho = ratio * ratio * v0 / v2 / q;
    let df = 4.0 + (q + 2.0) / (q * rho - 1.0);
    let scaling = if (df - 2.0).abs() < 1e-2 {
        1.0
    } else {
        df * mean / (df - 2.0)
    };
    (df, scaling)
}
