//! Tests of fixed effects with Satterthwaite's degrees of freedom.

use crate::coefficient::{Coefficient, Estimated};
use crate::error::MixedError;
use crate::evaluate::State;
use crate::finding::MixedFinding;
use crate::fit::{MixedFit, MixedMethod};
use crate::levels::level_slopes;
use crate::minimise::{FLAT, LEAST_SIZE, differences, directions};
use crate::model::MixedModel;
use crate::slope::slopes;
use crate::term::{check_finite, check_length};
use crate::theta::entries_from;
use nalgebra::{DMatrix, DVector};
use windfall_distribution::tail::{f_upper, t_two_sided, t_upper_quantile};

/// Eigenvalues of a contrast's covariance below this share of the largest are zero.
const RANK: f64 = 1e-10;

/// Covariance of the variance parameters, and how the coefficients' covariance
/// depends on them: all that Satterthwaite's method needs of a fit.
///
/// The parameters are the free entries of the relative covariance factors, logarithms of the
/// ratios of the levels' residual variances, then log σ.
#[derive(Clone, Debug)]
pub struct VarianceUncertainty {
    /// Covariance of the parameters, without flat directions.
    pub(crate) covariance: DMatrix<f64>,
    /// Derivative of the coefficients' covariance by each parameter.
    pub(crate) slopes: Vec<DMatrix<f64>>,
    /// What the reader should know.
    pub findings: Vec<MixedFinding>,
}

impl VarianceUncertainty {
    /// Of a model with these variance parameters.
    ///
    /// * `covariance`: of the parameters; `slopes`: derivative of the coefficients' covariance
    ///   by each
    pub fn of(covariance: DMatrix<f64>, slopes: Vec<DMatrix<f64>>) -> Self {
        Self {
            covariance,
            slopes,
            findings: Vec::new(),
        }
    }
}

/// Test that several combinations of coefficients are all zero.
#[derive(Clone, Debug, PartialEq)]
pub struct FTest {
    /// F.
    pub f: f64,
    /// Degrees of freedom of the numerator.
    pub numerator: usize,
    /// Degrees of freedom of the denominator.
    pub denominator: f64,
    /// p-value.
    pub p: f64,
}

/// What Satterthwaite's method needs of a fit.
///
/// The second derivative of the likelihood is taken by differences of fourth order
/// of its exact gradient, those of the covariance exactly as differences of it: both
/// are good to about 1e-9.
///
/// # Errors
/// [`MixedError::NoCriterion`] if the criterion is not finite near the estimate.
///
/// # Source
/// Kuznetsova, Brockhoff and Christensen (2017), lmerTest package, J. Stat. Softw.
/// 82(13), doi 10.18637/jss.v082.i13, sec. 2; Fai and Cornelius (1996).
pub fn variance_uncertainty(fit: &MixedFit) -> Result<VarianceUncertainty, MixedError> {
    let p = fit.model.coefficients();
    let sigma = fit.residual_sd;
    let here = fit.coordinates();
    let k = here.len();
    // outputs: gradient of -2 log likelihood by the coordinates, and the coefficients'
    // covariance over σ²
    let outputs = |at: &[f64]| -> Option<Vec<f64>> {
        let (model, state) = fit.at(at)?;
        let mut all = deviance_slope(fit, &model, &state)?;
        all.extend(covariance_of(fit, &state).as_slice());
        Some(all)
    };
    let rows = differences(&outputs, &here).ok_or(MixedError::NoCriterion)?;

    let mut second = DMatrix::zeros(k + 1, k + 1);
    for i in 0..k {
        for j in 0..k {
            second[(i, j)] = f64::midpoint(rows[i][j], rows[j][i]);
        }
    }
    // deviance = logs + denominator log(2πσ²) + squares / σ², by log σ
    let squares_slope = squares_slope(fit).ok_or(MixedError::NoCriterion)?;
    for i in 0..k {
        second[(i, k)] = -2.0 * squares_slope[i] / sigma.powi(2);
        second[(k, i)] = second[(i, k)];
    }
    second[(k, k)] = 4.0 * fit.state.squares / sigma.powi(2);

    let mut slopes: Vec<DMatrix<f64>> = rows
        .iter()
        .map(|row| DMatrix::from_column_slice(p, p, &row[k..]) * (sigma * sigma))
        .collect();
    slopes.push(&fit.covariance * 2.0);
    if second.iter().any(|value| !value.is_finite()) {
        return Err(MixedError::NoCriterion);
    }
    let mut sizes: Vec<f64> = here.iter().map(|own| own.abs().max(LEAST_SIZE)).collect();
    sizes.push(1.0);
    let (covariance, flat) = covariance_from(second, &sizes);
    let mut findings = Vec::new();
    if flat > 0 {
        findings.push(MixedFinding::FlatCriterion { directions: flat });
    }
    Ok(VarianceUncertainty {
        covariance,
        slopes,
        findings,
    })
}

/// Gradient by the coordinates, at fixed σ, of -2 log likelihood.
fn deviance_slope(fit: &MixedFit, model: &MixedModel, state: &State) -> Option<Vec<f64>> {
    let restricted = fit.method == MixedMethod::Reml;
    let (slopes, projections) = slopes(model, state);
    let variance = fit.residual_sd * fit.residual_sd;
    let mut sum = slopes.log_v;
    for (factor, sum) in sum.iter_mut().enumerate() {
        *sum += &slopes.squares[factor] / variance;
        if restricted {
            *sum += &slopes.log_fixed[factor];
        }
    }
    let mut slope = entries_from(&fit.estimate.entries, &sum);
    let levels = level_slopes(model, state, &projections)?;
    slope.extend(levels.deviance(restricted, variance));
    Some(slope)
}

/// Gradient by the coordinates of the penalised squares, at the estimate.
fn squares_slope(fit: &MixedFit) -> Option<Vec<f64>> {
    let (slopes, projections) = slopes(&fit.model, &fit.state);
    let mut slope = entries_from(&fit.estimate.entries, &slopes.squares);
    let levels = level_slopes(&fit.model, &fit.state, &projections)?;
    slope.extend(levels.squares.iter().skip(1));
    Some(slope)
}

/// Covariance of the coefficients over σ², in the columns as given.
fn covariance_of(fit: &MixedFit, state: &State) -> DMatrix<f64> {
    let inverse = fit.model.basis.inverse();
    &inverse * &state.covariance * inverse.transpose()
}

/// Twice the inverse of a second derivative over its curved directions, after scaling to
/// a unit diagonal, and the number of flat ones.
///
/// * `sizes`: of the coordinates; what is flat does not depend on their units
fn covariance_from(second: DMatrix<f64>, sizes: &[f64]) -> (DMatrix<f64>, usize) {
    let n = second.nrows();
    let second = DMatrix::from_fn(n, n, |i, j| second[(i, j)] * sizes[i] * sizes[j]);
    let largest = second.diagonal().amax();
    let scale = DVector::from_fn(n, |i, _| {
        let diagonal = second[(i, i)];
        if diagonal > FLAT * largest {
            diagonal.sqrt().recip()
        } else {
            largest.sqrt().recip()
        }
    });
    let scaled = DMatrix::from_fn(n, n, |i, j| second[(i, j)] * scale[i] * scale[j]);
    let eigen = scaled.symmetric_eigen();
    let mut inverse = DMatrix::zeros(n, n);
    let mut flat = 0;
    for (value, vector) in directions(&eigen) {
        if *value > FLAT {
            inverse += vector * vector.transpose() * (2.0 / value);
        } else {
            flat += 1;
        }
    }
    let scale = |i: usize| scale[i] * sizes[i];
    let covariance = DMatrix::from_fn(n, n, |i, j| inverse[(i, j)] * scale(i) * scale(j));
    (covariance, flat)
}

/// Satterthwaite's degrees of freedom 2 v² / (g' A g) of a variance with derivative g.
pub(crate) fn degrees_of_freedom(
    uncertainty: &VarianceUncertainty,
    variance: f64,
    slope: &DVector<f64>,
) -> f64 {
    2.0 * variance * variance / (slope.transpose() * &uncertainty.covariance * slope)[(0, 0)]
}

/// Variance and degrees of freedom of a combination of coefficients.
///
/// * `further`: a parameter that is the logarithm of a variance to be added, and that variance
pub fn contrast_df(
    uncertainty: &VarianceUncertainty,
    covariance: &DMatrix<f64>,
    weights: &DVector<f64>,
    further: Option<(usize, f64)>,
) -> (f64, f64) {
    let quadratic = |matrix: &DMatrix<f64>| (weights.transpose() * matrix * weights)[(0, 0)];
    let mut variance = quadratic(covariance);
    let mut slope = DVector::from_iterator(
        uncertainty.slopes.len(),
        uncertainty.slopes.iter().map(quadratic),
    );
    if let Some((parameter, more)) = further {
        variance += more;
        slope[parameter] += more;
    }
    (variance, degrees_of_freedom(uncertainty, variance, &slope))
}

/// A sum of coefficients with Satterthwaite's degrees of freedom.
pub fn estimate(fit: &MixedFit, uncertainty: &VarianceUncertainty, weights: &[f64]) -> Estimated {
    let weights = DVector::from_column_slice(weights);
    Estimated {
        value: weights.dot(&DVector::from_column_slice(&fit.coefficients)),
        se: (weights.transpose() * &fit.covariance * &weights)[(0, 0)].sqrt(),
        df: contrast_df(uncertainty, &fit.covariance, &weights, None).1,
    }
}

/// Tests of every coefficient, with intervals of this confidence (as 0.95).
pub fn coefficient_tests(
    fit: &MixedFit,
    uncertainty: &VarianceUncertainty,
    confidence: f64,
) -> Vec<Coefficient> {
    let p = fit.model.coefficients();
    let tests = (0..p).map(|k| {
        let weights = DVector::from_fn(p, |i, _| f64::from(u8::from(i == k)));
        let (_, df) = contrast_df(uncertainty, &fit.covariance, &weights, None);
        test_of(
            fit,
            &fit.covariance,
            &fit.model.x_names[k],
            &weights,
            df,
            confidence,
        )
    });
    tests.collect()
}

/// t, p and interval with these degrees of freedom.
pub(crate) fn test_of(
    fit: &MixedFit,
    covariance: &DMatrix<f64>,
    name: &str,
    weights: &DVector<f64>,
    df: f64,
    confidence: f64,
) -> Coefficient {
    let estimate = weights.dot(&DVector::from_column_slice(&fit.coefficients));
    let se = (weights.transpose() * covariance * weights)[(0, 0)].sqrt();
    let t = estimate / se;
    let half = half_width(confidence, df) * se;
    Coefficient {
        name: name.to_owned(),
        estimate,
        se,
        df,
        t,
        p: t_two_sided(t, df),
        low: estimate - half,
        high: estimate + half,
    }
}

/// F test that all rows of `contrast` times the coefficients are zero; with one row
/// per coefficient of a term, the term's test of type III.
///
/// # Errors
/// [`MixedError::WrongLength`] unless there is a column per coefficient;
/// [`MixedError::EmptyContrast`] if no row differs from zero.
///
/// # Source
/// lmerTest's `contestMD` (Kuznetsova et al. 2017, sec. 2.1): the contrast is turned
/// into independent ones, whose degrees of freedom are joined by the mean of F.
///
/// Where residual variances differ by level, the contrast is turned first as
/// [`independent_sums`] says, so that degrees of freedom do not depend on the coding.
pub fn f_test(
    fit: &MixedFit,
    uncertainty: &VarianceUncertainty,
    contrast: &DMatrix<f64>,
) -> Result<FTest, MixedError> {
    let own = (&fit.coefficients[..], &fit.covariance);
    if fit.model.levels.is_none() {
        return f_test_of(own, uncertainty, contrast);
    }
    check_length(
        "columns of the contrast",
        contrast.ncols(),
        fit.coefficients.len(),
    )?;
    check_contrast(contrast)?;
    let x = fit.model.weights.unweigh_columns(&fit.model.x);
    let ordinary = x.tr_mul(&x).try_inverse();
    let ordinary = ordinary.ok_or(MixedError::EmptyContrast)?;
    let turned = independent_sums(contrast, &ordinary).ok_or(MixedError::EmptyContrast)?;
    f_test_of(own, uncertainty, &turned)
}

/// Sums of coefficients that one variance for all rows would make independent and equally sure,
/// in place of sums of the same span; `None` where all are zero.
///
/// Fai and Cornelius' degrees of freedom depend on which sums stand for all that follow from
/// them: of these, the same question has the same answer however it is coded.
///
/// * `ordinary`: (X'X)⁻¹
pub fn independent_sums(sums: &DMatrix<f64>, ordinary: &DMatrix<f64>) -> Option<DMatrix<f64>> {
    let eigen = (sums * ordinary * sums.transpose()).symmetric_eigen();
    let least = RANK * eigen.eigenvalues.amax();
    let rows = directions(&eigen).filter(|(value, _)| **value > least);
    let rows: Vec<_> = rows
        .map(|(value, vector)| vector.transpose() * sums / value.sqrt())
        .collect();
    (!rows.is_empty()).then(|| DMatrix::from_rows(&rows))
}

/// [`f_test`] of estimates with their covariance; errors as there.
pub fn f_test_of(
    (estimates, variances): (&[f64], &DMatrix<f64>),
    uncertainty: &VarianceUncertainty,
    contrast: &DMatrix<f64>,
) -> Result<FTest, MixedError> {
    let p = estimates.len();
    check_length("columns of the contrast", contrast.ncols(), p)?;
    check_contrast(contrast)?;
    let covariance = contrast * variances * contrast.transpose();
    let eigen = covariance.symmetric_eigen();
    let largest = eigen.eigenvalues.amax();
    let beta = DVector::from_column_slice(estimates);
    let mut sum = 0.0;
    let mut dfs = Vec::new();
    for (value, vector) in directions(&eigen) {
        if *value <= RANK * largest || *value <= 0.0 {
            continue;
        }
        let weights = contrast.tr_mul(&vector);
        sum += weights.dot(&beta).powi(2) / value;
        dfs.push(contrast_df(uncertainty, variances, &weights, None).1);
    }
    if dfs.is_empty() {
        return Err(MixedError::EmptyContrast);
    }
    let f = sum / dfs.len() as f64;
    let denominator = joint_df(&dfs);
    Ok(FTest {
        f,
        numerator: dfs.len(),
        denominator,
        p: f_upper(f, dfs.len() as f64, denominator),
    })
}

/// A contrast of finite weights in at least one row.
pub(crate) fn check_contrast(contrast: &DMatrix<f64>) -> Result<(), MixedError> {
    if contrast.nrows() == 0 {
        return Err(MixedError::EmptyContrast);
    }
    for column in contrast.column_iter() {
        check_finite("contrast", column.as_slice())?;
    }
    Ok(())
}

/// Degrees of freedom of the mean of squared independent t's, from the mean of F.
fn joint_df(dfs: &[f64]) -> f64 {
    let first = dfs[0];
    if dfs.iter().all(|df| (df - first).abs() < 1e-8) {
        return dfs.iter().sum::<f64>() / dfs.len() as f64;
    }
    if dfs.iter().any(|df| *df <= 2.0) {
        return 2.0;
    }
    let mean: f64 = dfs.iter().map(|df| df / (df - 2.0)).sum();
    2.0 * mean / (mean - dfs.len() as f64)
}

/// Contrast that picks these coefficients.
pub fn picking_contrast(coefficients: usize, picked: &[usize]) -> DMatrix<f64> {
    DMatrix::from_fn(picked.len(), coefficients, |i, j| {
        f64::from(u8::from(picked[i] == j))
    })
}

/// Half width of an interval in standard errors; NaN for an invalid confidence.
pub(crate) fn half_width(confidence: f64, df: f64) -> f64 {
    if confidence > 0.0 && confidence < 1.0 {
        t_upper_quantile((1.0 - confidence) / 2.0, df)
    } else {
        f64::NAN
    }
}
