//! Linear mixed models fitted by restricted or plain maximum likelihood.

use crate::boundary::{Criterion, Estimate, estimate};
use crate::effects::{RandomEffects, fitted_values, random_effects};
use crate::error::MixedError;
use crate::evaluate::{State, evaluate};
use crate::finding::MixedFinding;
use crate::model::{MixedModel, prepare_mixed, prepare_weighted};
use crate::residual_levels::LevelVariances;
use crate::slope::{Projections, slopes};
use crate::term::RandomTerm;
use crate::theta::{blocks_of, relative_covariance, semidefinite_root};
use crate::weights::Weights;
use nalgebra::{DMatrix, DVector};
use std::borrow::Cow;

/// What is maximised.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum MixedMethod {
    /// Restricted maximum likelihood.
    #[default]
    Reml,
    /// Maximum likelihood: for comparing models with different fixed effects.
    MaximumLikelihood,
}

impl MixedMethod {
    /// Its usual abbreviation.
    pub fn name(self) -> &'static str {
        match self {
            Self::Reml => "REML",
            Self::MaximumLikelihood => "ML",
        }
    }
}

/// How a mixed model is fitted.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MixedOptions {
    /// What is maximised.
    pub method: MixedMethod,
}

/// Variances of one random term.
#[derive(Clone, Debug, PartialEq)]
pub struct TermVariance {
    /// The term.
    pub term: String,
    /// Names of its columns.
    pub columns: Vec<String>,
    /// Groups.
    pub groups: usize,
    /// Standard deviation of each column's effect.
    pub sds: Vec<f64>,
    /// Correlations of the effects; NaN without variance, zero where uncorrelated.
    pub correlations: DMatrix<f64>,
    /// Covariance of the effects.
    pub covariance: DMatrix<f64>,
}

/// A fitted linear mixed model.
#[derive(Clone, Debug)]
pub struct MixedFit {
    /// What was fitted.
    pub model: MixedModel,
    /// How.
    pub method: MixedMethod,
    /// Fixed coefficients.
    pub coefficients: Vec<f64>,
    /// Their covariance σ² (X'V⁻¹X)⁻¹, variances taken as known.
    pub covariance: DMatrix<f64>,
    /// Residual standard deviation σ of a row of weight 1.
    pub residual_sd: f64,
    /// Residual variances of levels, where they differ.
    pub levels: Option<LevelVariances>,
    /// Variances of each random term.
    pub variances: Vec<TermVariance>,
    /// Lower triangles (or diagonals) of the relative covariance factors, as in lme4.
    pub theta: Vec<f64>,
    /// -2 log of the (restricted) likelihood.
    pub criterion: f64,
    /// Log of the (restricted) likelihood.
    pub log_likelihood: f64,
    /// Number of parameters: coefficients, variances, correlations.
    pub parameters: usize,
    /// Akaike's criterion.
    pub aic: f64,
    /// Akaike's criterion for few rows (Hurvich and Tsai 1989).
    pub aicc: f64,
    /// Schwarz's criterion, with the number of rows.
    pub bic: f64,
    /// Conditional modes of the random effects, one entry per term.
    pub effects: Vec<RandomEffects>,
    /// X β + Z b.
    pub fitted: Vec<f64>,
    /// Response minus `fitted`.
    pub residuals: Vec<f64>,
    /// Evaluations of the criterion.
    pub evaluations: usize,
    /// What the reader should know.
    pub findings: Vec<MixedFinding>,
    /// The estimate in the model's own scale.
    pub(crate) estimate: Estimate,
    /// The factorisation there.
    pub(crate) state: State,
    /// Z'V⁻¹[X, residual] there.
    pub(crate) projections: Projections,
}

/// Fits a linear mixed model y = X β + Σ Zₜ bₜ + ε.
///
/// * `y`: response
/// * `x`: columns of the fixed effects, with the intercept; a row per observation
/// * `x_names`: their names
/// * `terms`: random terms
///
/// # Errors
/// Those of [`prepare_mixed`], and [`MixedError::NoCriterion`].
///
/// # Numerics
/// The profiled criterion is minimised with its exact gradient until Newton's step
/// vanishes; a variance at zero or a correlation at ±1 is found exactly and reported
/// as [`MixedFinding::Singular`]. One evaluation costs O(groups q² (p + q)) for one
/// grouping factor or nested ones, and the cube of the random effects of all factors
/// but the largest where groups are crossed.
///
/// # Source
/// Bates, Mächler, Bolker and Walker (2015), Fitting linear mixed-effects models
/// using lme4, J. Stat. Softw. 67(1), doi 10.18637/jss.v067.i01, eqs. 30-43.
///
/// # Example
/// Three fruit with two impacts each: the mean square within fruit is 2, that between
/// is 32, so that the variance between fruit is (32 - 2) / 2 = 15.
/// ```
/// use nalgebra::DMatrix;
/// use windfall_mixed::fit::{MixedOptions, fit_mixed};
/// use windfall_mixed::term::random_intercept;
///
/// let names = ["a", "b", "c"].map(str::to_owned);
/// let fruit = random_intercept("fruit", &[0, 0, 1, 1, 2, 2], &names);
/// let y = [1.0, 3.0, 5.0, 7.0, 9.0, 11.0];
/// let x = DMatrix::from_element(6, 1, 1.0);
/// let fit = fit_mixed(&y, &x, &["mean".to_owned()], &[fruit], &MixedOptions::default())?;
/// assert!((fit.variances[0].covariance[(0, 0)] - 15.0).abs() < 1e-9);
/// assert!((fit.residual_sd.powi(2) - 2.0).abs() < 1e-9);
/// # Ok::<(), windfall_mixed::error::MixedError>(())
/// ```
pub fn fit_mixed(
    y: &[f64],
    x: &DMatrix<f64>,
    x_names: &[String],
    terms: &[RandomTerm],
    options: &MixedOptions,
) -> Result<MixedFit, MixedError> {
    fit_mixed_model(prepare_mixed(y, x, x_names, terms)?, options)
}

/// [`fit_mixed`] of rows whose residual variance is σ² over their weight, as `weights` of R's
/// `lmer`.
///
/// # Errors
/// As [`fit_mixed`]; a number of weights other than that of rows.
pub fn fit_mixed_weighted(
    rows: (&[f64], &Weights),
    x: &DMatrix<f64>,
    x_names: &[String],
    terms: &[RandomTerm],
    options: &MixedOptions,
) -> Result<MixedFit, MixedError> {
    fit_mixed_model(prepare_weighted(rows, x, x_names, terms)?, options)
}

/// Fits a prepared model, or returns [`MixedError::NoCriterion`].
pub fn fit_mixed_model(model: MixedModel, options: &MixedOptions) -> Result<MixedFit, MixedError> {
    fit_from(model, options, &[1.0, 0.2, 5.0])
}

/// [`fit_mixed_model`] with effects of these sizes, over σ, at first.
pub(crate) fn fit_from(
    model: MixedModel,
    options: &MixedOptions,
    sizes: &[f64],
) -> Result<MixedFit, MixedError> {
    let criterion = Criterion::of_model(&model, options.method == MixedMethod::Reml);
    let (estimate, state) = estimate(&model, &criterion, sizes).ok_or(MixedError::NoCriterion)?;
    let moved = match model.at_levels(&estimate.logs) {
        Cow::Owned(moved) => Some(moved),
        Cow::Borrowed(_) => None,
    };
    let model = moved.unwrap_or(model);
    check_residual(&model, &state)?;
    let (_, projections) = slopes(&model, &state);

    let (n, p) = (model.rows() as f64, model.coefficients() as f64);
    let variance = state.squares / criterion.denominator;
    let residual_sd = variance.sqrt();
    let (coefficients, covariance) = fixed_effects(&model, &state, variance);
    let effects = random_effects(&model, &state, &projections, residual_sd);
    let weighted = fitted_values(&model, &coefficients, &effects);
    let rows = model.y.iter().zip(&weighted).enumerate();
    let residuals = rows.map(|(row, (y, fitted))| (y - fitted) / model.weights.root(row));
    let residuals = residuals.collect();
    let rows = weighted.iter().enumerate();
    let fitted = rows.map(|(row, fitted)| fitted / model.weights.root(row));
    let fitted = fitted.collect();
    let variances = (0..model.terms.len())
        .map(|term| term_variance(&model, &state, term, variance))
        .collect();

    let count = p + (estimate.entries.len() + model.free_levels()) as f64 + 1.0;
    let value = estimate.value;
    Ok(MixedFit {
        method: options.method,
        theta: theta_of(&model, &state),
        coefficients,
        covariance,
        residual_sd,
        variances,
        criterion: value,
        log_likelihood: -value / 2.0,
        parameters: count as usize,
        aic: value + 2.0 * count,
        aicc: value + 2.0 * count + 2.0 * count * (count + 1.0) / (n - count - 1.0),
        bic: value + count * n.ln(),
        effects,
        fitted,
        residuals,
        evaluations: estimate.evaluations,
        findings: findings_of(&model, &state, &estimate),
        levels: None,
        model,
        estimate,
        state,
        projections,
    })
}

/// An error where random effects leave nothing to the residual.
fn check_residual(model: &MixedModel, state: &State) -> Result<(), MixedError> {
    /// Share of the spread below which a residual is rounding.
    const NO_RESIDUAL: f64 = 1e-6;
    let ordinary = model.fixed.last().copied().unwrap_or_default();
    let residual = (state.squares / ordinary).sqrt();
    if residual > NO_RESIDUAL {
        return Ok(());
    }
    Err(MixedError::NoResidual {
        what: "fixed and random effects",
        residual,
    })
}

impl MixedFit {
    /// Residual variance of each level over σ²; 1 for a model with one variance.
    pub fn level_ratios(&self) -> Vec<f64> {
        let Some(levels) = &self.model.levels else {
            return vec![1.0];
        };
        let mut ratios = vec![1.0; levels.names.len()];
        for (row, level) in levels.level.iter().enumerate() {
            ratios[*level] = 1.0 / self.model.weights.weight(row);
        }
        ratios
    }

    /// Coordinates of the criterion at the estimate: free entries of the relative covariance
    /// factors, then logarithms of the levels' residual variances over the estimated ones.
    pub(crate) fn coordinates(&self) -> Vec<f64> {
        let mut all = self.estimate.theta.clone();
        all.resize(all.len() + self.model.free_levels(), 0.0);
        all
    }

    /// The model and its factorisation at other coordinates; `None` where numbers overflow.
    pub(crate) fn at(&self, coordinates: &[f64]) -> Option<(Cow<'_, MixedModel>, State)> {
        let entries = &self.estimate.entries;
        let (theta, logs) = coordinates.split_at(entries.len());
        let model = self.model.at_levels(logs);
        let state = evaluate(&model, &blocks_of(&model, entries, theta))?;
        Some((model, state))
    }

    /// Covariance of the coefficients; rows.
    pub fn covariance_rows(&self) -> Vec<Vec<f64>> {
        let rows = self.covariance.row_iter();
        rows.map(|row| row.iter().copied().collect()).collect()
    }
}

/// Coefficients of the columns as given, and their covariance.
fn fixed_effects(model: &MixedModel, state: &State, variance: f64) -> (Vec<f64>, DMatrix<f64>) {
    let p = model.coefficients();
    let triangle = &model.basis.r;
    let own: DVector<f64> = &model.ordinary + &state.shift;
    // the basis has full rank: its diagonal is positive
    let coefficients = triangle.solve_upper_triangular(&own).unwrap_or(own);
    let inverse = triangle.solve_upper_triangular(&DMatrix::identity(p, p));
    let inverse = inverse.unwrap_or_else(|| DMatrix::zeros(p, p));
    let mut covariance = &inverse * &state.covariance * inverse.transpose() * variance;
    covariance.fill_upper_triangle_with_lower_triangle();
    (coefficients.as_slice().to_vec(), covariance)
}

fn term_variance(model: &MixedModel, state: &State, term: usize, variance: f64) -> TermVariance {
    let given = &model.terms[term];
    let covariance = relative_covariance(model, &state.blocks, term) * variance;
    let sds: Vec<f64> = covariance.diagonal().iter().map(|v| v.sqrt()).collect();
    let correlations = DMatrix::from_fn(sds.len(), sds.len(), |i, j| {
        if i == j {
            1.0
        } else if given.correlated {
            (covariance[(i, j)] / (sds[i] * sds[j])).clamp(-1.0, 1.0)
        } else {
            0.0
        }
    });
    TermVariance {
        term: given.name.clone(),
        columns: given.column_names.clone(),
        groups: given.groups,
        sds,
        correlations,
        covariance,
    }
}

/// The relative factors in the columns as given.
fn theta_of(model: &MixedModel, state: &State) -> Vec<f64> {
    let mut theta = Vec::new();
    for (term, given) in model.terms.iter().enumerate() {
        let root = semidefinite_root(&relative_covariance(model, &state.blocks, term));
        for column in 0..root.ncols() {
            let last = if given.correlated {
                root.nrows()
            } else {
                column + 1
            };
            theta.extend((column..last).map(|row| root[(row, column)]));
        }
    }
    theta
}

fn findings_of(model: &MixedModel, state: &State, estimate: &Estimate) -> Vec<MixedFinding> {
    let mut findings = Vec::new();
    if !estimate.converged {
        findings.push(MixedFinding::NoConvergence {
            evaluations: estimate.evaluations,
        });
    }
    if estimate.flat > 0 {
        findings.push(MixedFinding::FlatCriterion {
            directions: estimate.flat,
        });
    }
    for (term, given) in model.terms.iter().enumerate() {
        let mut at_zero = estimate
            .at_zero
            .iter()
            .map(|place| &estimate.entries[*place]);
        if at_zero.any(|entry| entry.term == term) {
            findings.push(MixedFinding::Singular {
                term: given.name.clone(),
                what: edge(given, &relative_covariance(model, &state.blocks, term)),
            });
        }
    }
    findings
}

/// What of a singular covariance is on the edge.
fn edge(term: &RandomTerm, covariance: &DMatrix<f64>) -> String {
    let zero: Vec<&str> = (0..covariance.nrows())
        .filter(|k| covariance[(*k, *k)] == 0.0)
        .map(|k| term.column_names[k].as_str())
        .collect();
    match zero.as_slice() {
        [] => "has effects that are combinations of each other (a correlation at its limit)"
            .to_owned(),
        names => format!("has no variance of {}", names.join(", ")),
    }
}
