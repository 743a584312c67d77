//! Linear models in which each level of a category has a residual variance of its own.

use crate::error::Error;
use crate::model::linear_model::{LinearFit, coefficient, student_quantile};
use nalgebra::{DMatrix, DVector};
use std::f64::consts::TAU;
use windfall_distribution::tail::chi_squared_upper_quantile;
use windfall_mixed::coefficient::{Coefficient, Estimated};
use windfall_mixed::error::MixedError;
use windfall_mixed::fit::MixedMethod;
use windfall_mixed::inference::{
    FTest, VarianceUncertainty, contrast_df, f_test_of, independent_sums,
};
use windfall_mixed::residual_levels::ResidualLevels;
use windfall_mixed::weights::Weights;

/// Steps of the search, and halvings of each.
const MOST_STEPS: usize = 200;
const MOST_HALVINGS: usize = 40;

/// Newton's step, in logarithms of variances, at which the search ends.
const SMALLEST_STEP: f64 = 1e-11;

/// Degrees of freedom of a level's residuals below which they tell no variance.
const NO_FREEDOM: f64 = 1e-8;

/// A level's standard deviation below this share of the residual one of all rows is rounding.
const NO_SCATTER: f64 = 1e-9;

/// Rows of a model, and the levels that decide on their variances.
#[derive(Clone, Copy, Debug)]
pub struct LevelledRows<'a> {
    /// Independent columns.
    pub x: &'a DMatrix<f64>,
    /// The response.
    pub y: &'a [f64],
    /// Level of each row.
    pub levels: &'a ResidualLevels,
}

/// Residual variances by level, with what follows from their uncertainty.
#[derive(Clone, Debug)]
pub struct VarianceGroups {
    /// Variance of each level.
    pub variances: Vec<f64>,
    /// Rows of each.
    pub rows: Vec<usize>,
    /// Degrees of freedom of each variance: 2 over the variance of its logarithm.
    pub freedom: Vec<f64>,
    /// Log of the (restricted) likelihood.
    pub log_likelihood: f64,
    /// The same with one variance for all.
    pub equal_log_likelihood: f64,
    /// Covariance of the logarithms of the variances.
    covariance: DMatrix<f64>,
    /// Level of each row.
    level: Vec<usize>,
}

/// The model at some variances.
struct Evaluated {
    /// -2 log likelihood.
    criterion: f64,
    /// Derivative of the log-likelihood by the logarithm of each variance.
    score: DVector<f64>,
    /// Minus its second derivative.
    observed: DMatrix<f64>,
    /// What is expected of that.
    expected: DMatrix<f64>,
    /// Degrees of freedom of the residuals of each level.
    left: Vec<f64>,
    /// Their sums of squares.
    squares: Vec<f64>,
}

/// Estimates a residual variance for each level.
///
/// * `method`: REML divides by what the coefficients leave, so that the variances of groups
///   with means of their own are the usual ones
///
/// # Errors
/// [`MixedError::LevelVariance`] for a level with one row, with coefficients of its own for all of
/// its rows, or without scatter about the model; [`MixedError::NoCriterion`] where the search
/// finds no maximum.
///
/// # Numerics
/// Newton's method on logarithms of variances with exact derivatives, on orthonormal columns;
/// Fisher's scoring where the likelihood is not concave. O(n p²) for each step.
///
/// # Source
/// Patterson and Thompson (1971), Biometrika 58, 545-554; Pinheiro and Bates (2000),
/// Mixed-Effects Models in S and S-PLUS, §5.1 (`varIdent`), §5.2.
pub fn variance_groups(rows: &LevelledRows, method: MixedMethod) -> Result<VarianceGroups, Error> {
    let (count, width) = (rows.levels.names.len(), rows.x.ncols());
    rows.levels.check(rows.y.len())?;
    if rows.y.len() <= width {
        return Err(Error::TooFewRows {
            rows: rows.y.len(),
            terms: width,
        });
    }
    let problem = Problem::new(rows, method);
    let equal = problem.at(&vec![0.0; count])?;
    if let Some(level) = equal.left.iter().position(|own| *own <= NO_FREEDOM) {
        let what = "has coefficients of its own for all of its rows";
        return Err(rows.levels.refused(level, what).into());
    }
    let total: f64 = equal.squares.iter().sum();
    let divisor = match method {
        MixedMethod::Reml => rows.y.len() - width,
        MixedMethod::MaximumLikelihood => rows.y.len(),
    };
    let common = (total / divisor as f64).ln();
    let one = problem.at(&vec![common; count])?;
    let least = common + 2.0 * NO_SCATTER.ln();
    let start = equal.squares.iter().zip(&equal.left);
    let start: Vec<f64> = start.map(|(own, left)| (own / left).ln()).collect();
    let without = |logs: &[f64]| logs.iter().position(|own| *own < least || own.is_nan());
    let no_scatter = |level: usize| {
        rows.levels
            .refused(level, "has no scatter about the model")
            .into()
    };
    if let Some(level) = without(&start) {
        return Err(no_scatter(level));
    }
    let (logs, found) = match problem.search(start, least) {
        Ok(found) => found,
        Err(Some(level)) => return Err(no_scatter(level)),
        Err(None) => return Err(MixedError::NoCriterion.into()),
    };
    let covariance = found.observed.clone().try_inverse();
    let covariance = covariance.ok_or(Error::Mixed(MixedError::NoCriterion))?;
    Ok(VarianceGroups {
        variances: logs.iter().map(|own| own.exp()).collect(),
        rows: rows.levels.sizes(),
        freedom: covariance.diagonal().iter().map(|own| 2.0 / own).collect(),
        log_likelihood: -0.5 * found.criterion,
        equal_log_likelihood: -0.5 * one.criterion,
        covariance,
        level: rows.levels.level.clone(),
    })
}

/// A model with orthonormal columns.
struct Problem<'a> {
    q: DMatrix<f64>,
    rows: &'a LevelledRows<'a>,
    restricted: bool,
    /// log|X'X|
    log_basis: f64,
}

impl<'a> Problem<'a> {
    fn new(rows: &'a LevelledRows<'a>, method: MixedMethod) -> Self {
        let qr = rows.x.clone().qr();
        let diagonal = qr.r().diagonal();
        Self {
            q: qr.q(),
            rows,
            restricted: method == MixedMethod::Reml,
            log_basis: 2.0 * diagonal.iter().map(|own| own.abs().ln()).sum::<f64>(),
        }
    }

    /// * `logs`: logarithms of the variances
    fn at(&self, logs: &[f64]) -> Result<Evaluated, Error> {
        let (count, width) = (logs.len(), self.q.ncols());
        let (level, y) = (&self.rows.levels.level, self.rows.y);
        let weights: Vec<f64> = logs.iter().map(|own| (-own).exp()).collect();
        // Cross-products of each level over its variance.
        let mut shares = vec![DMatrix::zeros(width, width); count];
        let mut right = DVector::zeros(width);
        for (row, own) in self.q.row_iter().enumerate() {
            let own = own.transpose();
            let weight = weights[level[row]];
            shares[level[row]].ger(weight, &own, &own, 1.0);
            right.axpy(weight * y[row], &own, 1.0);
        }
        let whole: DMatrix<f64> = shares.iter().sum();
        let factor = whole.cholesky();
        let factor = factor.ok_or(Error::Mixed(MixedError::NoCriterion))?;
        let covariance = factor.inverse();
        let beta = factor.solve(&right);
        let fitted = &self.q * beta;
        let (mut sums, mut pulls) = (vec![0.0; count], vec![DVector::zeros(width); count]);
        let mut squares = vec![0.0; count];
        for (row, own) in self.q.row_iter().enumerate() {
            let (residual, of) = (y[row] - fitted[row], level[row]);
            squares[of] += residual * residual;
            sums[of] += weights[of] * residual * residual;
            pulls[of].axpy(weights[of] * residual, &own.transpose(), 1.0);
        }
        let taken: Vec<DMatrix<f64>> = shares.iter().map(|own| &covariance * own).collect();
        let mut sizes = vec![0.0; count];
        level.iter().for_each(|own| sizes[*own] += 1.0);
        let left: Vec<f64> = (0..count)
            .map(|own| sizes[own] - taken[own].trace())
            .collect();
        let restricted = f64::from(u8::from(self.restricted));
        let pairs = |of: &dyn Fn(usize, usize, f64, f64) -> f64| {
            DMatrix::from_fn(count, count, |a, b| {
                let crossed = taken[a].component_mul(&taken[b].transpose()).sum();
                let pulled = (pulls[a].transpose() * &covariance * &pulls[b])[(0, 0)];
                0.5 * of(a, b, crossed, pulled)
            })
        };
        let same = |a: usize, b: usize| f64::from(u8::from(a == b));
        let observed = pairs(&|a, b, crossed, pulled| {
            let own = restricted * (sizes[a] - left[a]) + sums[a];
            same(a, b) * own - restricted * crossed - 2.0 * pulled
        });
        let expected = pairs(&|a, b, crossed, _| match self.restricted {
            true => same(a, b) * (2.0 * left[a] - sizes[a]) + crossed,
            false => same(a, b) * sizes[a],
        });
        let rows = y.len() as f64 - restricted * width as f64;
        let logarithms: f64 = sizes.iter().zip(logs).map(|(n, own)| n * own).sum();
        let log_fixed = factor
            .l()
            .diagonal()
            .iter()
            .map(|own| own.ln())
            .sum::<f64>();
        let fixed = restricted * (2.0 * log_fixed + self.log_basis);
        Ok(Evaluated {
            criterion: rows * TAU.ln() + logarithms + fixed + sums.iter().sum::<f64>(),
            score: DVector::from_fn(count, |own, _| {
                let freedom = if self.restricted {
                    left[own]
                } else {
                    sizes[own]
                };
                0.5 * (sums[own] - freedom)
            }),
            observed,
            expected,
            left,
            squares,
        })
    }

    /// The maximum; a level whose variance vanishes on the way, or nothing, where there is none.
    fn search(
        &self,
        mut logs: Vec<f64>,
        least: f64,
    ) -> Result<(Vec<f64>, Evaluated), Option<usize>> {
        let mut now = self.at(&logs).map_err(|_| None)?;
        for _ in 0..MOST_STEPS {
            let curved = now.observed.clone().cholesky();
            let step = curved.or_else(|| now.expected.clone().cholesky());
            let step = step.ok_or(None)?.solve(&now.score);
            if step.amax() <= SMALLEST_STEP {
                return Ok((logs, now));
            }
            let mut part = (1.0_f64).min(2.0 / step.amax());
            let mut next = None;
            for _ in 0..MOST_HALVINGS {
                let tried: Vec<f64> = logs.iter().zip(&step).map(|(l, s)| l + part * s).collect();
                let found = self.at(&tried).ok();
                let room = 1e-12 * now.criterion.abs().max(1.0);
                let found = found.filter(|own| own.criterion <= now.criterion + room);
                if let Some(found) = found {
                    next = Some((tried, found));
                    break;
                }
                part *= 0.5;
            }
            let (tried, found) = next.ok_or(None)?;
            if let Some(level) = tried.iter().position(|own| *own < least) {
                return Err(Some(level));
            }
            // Steps as small as this are rounding.
            let still = part * step.amax() <= 1e-9 && found.score.amax() >= now.score.amax();
            (logs, now) = (tried, found);
            if still {
                return Ok((logs, now));
            }
        }
        Err(None)
    }
}

impl VarianceGroups {
    /// Weights of the rows: one over the variance of each.
    pub fn weights(&self) -> Weights {
        Weights::of(self.level.iter().map(|own| 1.0 / self.variances[*own]))
    }

    /// Root mean variance of the rows.
    pub fn mean_sd(&self) -> f64 {
        let rows = self.rows.iter().zip(&self.variances);
        let sum: f64 = rows.map(|(count, own)| *count as f64 * own).sum();
        (sum / self.level.len() as f64).sqrt()
    }

    /// Interval of a level's standard deviation: that of a variance with as many degrees of
    /// freedom. In groups with means of their own it is exact.
    pub fn interval(&self, level: usize, confidence: f64) -> (f64, f64) {
        let (variance, df) = (self.variances[level], self.freedom[level]);
        let end = |tail: f64| (variance * df / chi_squared_upper_quantile(tail, df)).sqrt();
        let tail = 0.5 * (1.0 - confidence);
        (end(tail), end(1.0 - tail))
    }

    /// What tests of a fit with these weights need.
    ///
    /// * `x`: its estimated columns
    pub fn inference(&self, fit: &LinearFit, x: &DMatrix<f64>) -> LevelInference {
        // 1, or with maximum likelihood what makes up for the coefficients, as in nlme.
        let scale = fit.variance();
        let covariance = &fit.unscaled_covariance * scale;
        let width = x.ncols();
        let mut shares = vec![DMatrix::zeros(width, width); self.variances.len()];
        for (row, own) in x.row_iter().enumerate() {
            let own = own.transpose();
            shares[self.level[row]].ger(1.0, &own, &own, 1.0);
        }
        let ordinary: DMatrix<f64> = shares.iter().sum();
        let slopes = shares.iter().zip(&self.variances);
        let slopes = slopes.map(|(own, v)| &covariance * own * &covariance / (v * scale));
        LevelInference {
            uncertainty: VarianceUncertainty::of(self.covariance.clone(), slopes.collect()),
            columns: fit.columns.clone(),
            estimates: fit.coefficients.iter().map(|own| own.estimate).collect(),
            ordinary: ordinary.try_inverse().unwrap_or_else(|| covariance.clone()),
            covariance,
        }
    }
}

/// Coefficients with Satterthwaite's degrees of freedom: the variances of levels are estimates.
///
/// For the difference of two means these are Welch's.
///
/// # Source
/// Satterthwaite (1946), Biometrics Bull. 2, 110-114; Welch (1947), Biometrika 34, 28-35; Fai
/// and Cornelius (1996), J. Stat. Comput. Simul. 54, 363-378 for several at once.
#[derive(Clone, Debug)]
pub struct LevelInference {
    uncertainty: VarianceUncertainty,
    columns: Vec<usize>,
    estimates: Vec<f64>,
    /// (X'X)⁻¹
    ordinary: DMatrix<f64>,
    /// Covariance of the estimates.
    pub covariance: DMatrix<f64>,
}

impl LevelInference {
    /// A sum of coefficients, with weights of all columns of the model.
    pub fn estimate(&self, weights: &[f64]) -> Estimated {
        self.observed(weights, None)
    }

    /// The same with a further observation of a level with this variance, its own.
    pub fn observation(&self, weights: &[f64], (level, variance): (usize, f64)) -> Estimated {
        self.observed(weights, Some((level, variance)))
    }

    fn observed(&self, weights: &[f64], further: Option<(usize, f64)>) -> Estimated {
        let own = self.columns.iter().map(|column| weights[*column]);
        let own = DVector::from_iterator(self.columns.len(), own);
        let (variance, df) = contrast_df(&self.uncertainty, &self.covariance, &own, further);
        Estimated {
            value: own.iter().zip(&self.estimates).map(|(a, b)| a * b).sum(),
            se: variance.sqrt(),
            df,
        }
    }

    /// The coefficients of a fit.
    pub fn coefficients(&self, fit: &LinearFit) -> Vec<Coefficient> {
        let last = self.columns.iter().max().map_or(0, |own| own + 1);
        let own = self.columns.iter().zip(&fit.coefficients);
        own.map(|(column, own)| {
            let mut weights = vec![0.0; last];
            weights[*column] = 1.0;
            let Estimated { value, se, df } = self.estimate(&weights);
            let quantile = student_quantile(0.5 + 0.5 * fit.confidence, df);
            coefficient(&own.name, value, se, df, quantile)
        })
        .collect()
    }

    /// F test that sums of coefficients are all zero; `None` where none of them is estimated.
    ///
    /// * `sums`: weights of all columns of the model, a row for each sum
    ///
    /// # Numerics
    /// The sums are turned into independent ones, [`independent_sums`].
    pub fn test(&self, sums: &DMatrix<f64>) -> Option<FTest> {
        let own = sums.select_columns(&self.columns);
        if own.is_empty() {
            return None;
        }
        let own = independent_sums(&own, &self.ordinary)?;
        f_test_of((&self.estimates, &self.covariance), &self.uncertainty, &own).ok()
    }
}
