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
//! V⁻¹Z = Z - Z D M,  V⁻¹X = X - Z D B,  V⁻¹ = I - Z K Z',  K = D - D M D
//! ```
//!
//! The residual variance of a level is the parameter of I over its rows, weighted as the model
//! is; without levels there is one, of all rows.

use crate::blocks::rows_by_group;
use crate::coefficient::{Coefficient, Estimated};
use crate::error::MixedError;
use crate::fit::{MixedFit, MixedMethod};
use crate::inference::{FTest, check_contrast, test_of};
use crate::minimise::directions;
use crate::model::MixedModel;
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

/// Sums over the random effects and rows; the last parameters are the residual variances.
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
    /// Its rows.
    rows: Vec<usize>,
    /// Z'V⁻¹X.
    projection: DMatrix<f64>,
}

fn sums_of(fit: &MixedFit) -> Result<Sums, MixedError> {
    let model = &fit.model;
    let p = model.coefficients();
    let parameters = &fit.estimate.entries;
    let count = parameters.len() + model.free_levels() + 1;
    let mut sums = Sums {
        traces: DMatrix::zeros(count, count),
        slopes: vec![DMatrix::zeros(p, p); count],
        crossed: (0..count)
            .map(|r| vec![DMatrix::zeros(p, p); r + 1])
            .collect(),
    };
    if model.factors.len() == 1 {
        let rows = rows_by_group(&model.factors[0]);
        for (group, rows) in rows.into_iter().enumerate() {
            add_piece(fit, parameters, &group_piece(fit, group, rows), &mut sums)?;
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
fn group_piece(fit: &MixedFit, group: usize, rows: Vec<usize>) -> Piece {
    let (leaf, p) = (&fit.model.leaf, fit.model.coefficients());
    let q = leaf.width;
    let effect = |column| Effect {
        factor: 0,
        column,
        group: 0,
    };
    Piece {
        effects: (0..q).map(effect).collect(),
        rows,
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
    let mut projection = Vec::new();
    for (factor, given) in model.factors.iter().enumerate() {
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
    Piece {
        projection: DMatrix::from_row_slice(effects.len(), p, &projection),
        effects,
        rows: (0..model.rows()).collect(),
    }
}

/// Sums over the rows of a level.
struct LevelSums {
    /// Rows.
    rows: f64,
    /// Z'Z.
    square: DMatrix<f64>,
    /// Z'V⁻¹X.
    cross: DMatrix<f64>,
    /// X'V⁻²X: the squares of V⁻¹X.
    fixed: DMatrix<f64>,
}

/// Sums over the rows of each level.
///
/// * `db`: D B
fn level_sums(model: &MixedModel, piece: &Piece, db: &DMatrix<f64>) -> Vec<LevelSums> {
    let (q, p) = (piece.effects.len(), model.coefficients());
    let empty = || LevelSums {
        rows: 0.0,
        square: DMatrix::zeros(q, q),
        cross: DMatrix::zeros(q, p),
        fixed: DMatrix::zeros(p, p),
    };
    let mut sums: Vec<LevelSums> = (0..=model.free_levels()).map(|_| empty()).collect();
    // One factor's group is the whole piece.
    let whole = model.factors.len() > 1;
    let mut starts = vec![0];
    for factor in &model.factors {
        starts.push(starts[starts.len() - 1] + factor.groups * factor.width);
    }
    let mut entries: Vec<(usize, f64)> = Vec::new();
    let mut rest = vec![0.0; p];
    for row in piece.rows.iter().copied() {
        entries.clear();
        for (factor, start) in model.factors.iter().zip(&starts) {
            let group = if whole { factor.group[row] } else { 0 };
            let first = start + group * factor.width;
            let design = &factor.design[row * factor.width..(row + 1) * factor.width];
            entries.extend(design.iter().enumerate().map(|(k, z)| (first + k, *z)));
        }
        for (column, own) in rest.iter_mut().enumerate() {
            let groups = entries.iter().map(|(k, z)| z * db[(*k, column)]);
            *own = model.basis.q[column][row] - groups.sum::<f64>();
        }
        let level = model.levels.as_ref().map_or(0, |own| own.level[row]);
        let sums = &mut sums[level];
        sums.rows += 1.0;
        for (i, a) in &entries {
            for (j, b) in &entries {
                sums.square[(*i, *j)] += a * b;
            }
            for (column, own) in rest.iter().enumerate() {
                sums.cross[(*i, column)] += a * own;
            }
        }
        for (column, own) in rest.iter().enumerate() {
            for (other, value) in rest.iter().enumerate() {
                sums.fixed[(other, column)] += own * value;
            }
        }
    }
    sums
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
    let b = &piece.projection;
    let db = &own * b;
    let levels = level_sums(&fit.model, piece, &db);
    let square: DMatrix<f64> = levels.iter().map(|own| &own.square).sum();
    // M = Z'Z - Z'ZΛ (Λ'Z'ZΛ + I)⁻¹ Λ'Z'Z
    let scaled = root.tr_mul(&square);
    let mut middle = &scaled * &root;
    (0..middle.nrows()).for_each(|i| middle[(i, i)] += 1.0);
    let cholesky = middle.cholesky().ok_or(MixedError::SingularInformation)?;
    let half = cholesky
        .l()
        .solve_lower_triangular(&scaled)
        .ok_or(MixedError::SingularInformation)?;
    let m = &square - half.tr_mul(&half);
    let dm = &own * &m;
    let inner = &own - &dm * &own;

    let moved: Vec<DMatrix<f64>> = parameters.iter().map(|e| apply(e, piece, &m)).collect();
    let moved_b: Vec<DMatrix<f64>> = parameters.iter().map(|e| apply(e, piece, b)).collect();
    for r in 0..last {
        for s in 0..=r {
            sums.traces[(r, s)] += moved[r].component_mul(&moved[s].transpose()).sum();
            sums.crossed[r][s] += moved_b[r].tr_mul(&m) * &moved_b[s];
        }
        sums.slopes[r] -= moved_b[r].tr_mul(b);
    }
    let taken: Vec<DMatrix<f64>> = levels.iter().map(|own| &inner * &own.square).collect();
    for (l, level) in levels.iter().enumerate() {
        let place = last + l;
        // Z'V⁻¹IₗV⁻¹Z and Z'V⁻¹IₗV⁻¹X
        let shared = dm.tr_mul(&level.square);
        let effects = &level.square - &shared - shared.transpose() + &shared * &dm;
        let fixed = &level.cross - dm.tr_mul(&level.cross);
        for r in 0..last {
            sums.traces[(place, r)] += apply(&parameters[r], piece, &effects).trace();
            sums.crossed[place][r] += fixed.tr_mul(&moved_b[r]);
        }
        for k in 0..=l {
            let both = taken[l].component_mul(&taken[k].transpose()).sum();
            sums.traces[(place, last + k)] += both;
            let solved = &inner * &levels[k].cross;
            sums.crossed[place][last + k] -= level.cross.tr_mul(&solved);
        }
        sums.traces[(place, place)] += level.rows - 2.0 * taken[l].trace();
        sums.crossed[place][place] += &level.fixed;
        sums.slopes[place] -= &level.fixed;
    }
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
