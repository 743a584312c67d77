//! One simulated study: drawn from the fitted model, fitted and tested.

use crate::power::Sides;
use crate::question::Levels;
use crate::study::{Resized, Study};
use nalgebra::{DMatrix, DVector};
use windfall_distribution::tail::{t_upper, t_upper_quantile};
use windfall_mixed::finding::MixedFinding;
use windfall_mixed::fit::{MixedOptions, fit_mixed};
use windfall_mixed::inference::{estimate, f_test, picking_contrast, variance_uncertainty};
use windfall_mixed::term::RandomTerm;
use windfall_signal::noise::gaussian::{noise_source, normal};

/// A study that is to be simulated.
pub(crate) struct Layout {
    /// Expected response of each row.
    mean: Vec<f64>,
    /// Fixed columns as they are tested.
    x: DMatrix<f64>,
    names: Vec<String>,
    random: Vec<RandomTerm>,
    /// Roots of the covariances of the random terms.
    roots: Vec<DMatrix<f64>>,
    residual_sd: f64,
}

/// What is tested.
pub(crate) struct Tested {
    /// Columns of the term.
    pub columns: Vec<usize>,
    /// Its coefficient, where it has one alone: weights, and the true value.
    pub coefficient: Option<(Vec<f64>, f64)>,
}

/// What one simulated study found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Found {
    pub rejected: bool,
    /// Half-width of the coefficient's interval, and whether it holds the truth.
    pub interval: Option<(f64, bool)>,
    /// A variance was estimated as zero.
    pub singular: bool,
}

/// Makes a study ready.
///
/// * `coefficients`: true ones, of the columns as they are told
pub(crate) fn layout(study: &Study, resized: &Resized, coefficients: &[f64]) -> Layout {
    let expected = &study.told.x * DVector::from_column_slice(coefficients);
    let roots = study.fit.variances.iter().map(|own| root(&own.covariance));
    Layout {
        mean: resized.rows.iter().map(|row| expected[*row]).collect(),
        x: study.tested.x.select_rows(&resized.rows),
        names: study.tested.names.clone(),
        random: study.random_of(resized),
        roots: roots.collect(),
        residual_sd: study.fit.residual_sd,
    }
}

/// Root of a covariance, which may be singular.
fn root(covariance: &DMatrix<f64>) -> DMatrix<f64> {
    let eigen = covariance.clone().symmetric_eigen();
    let scales = eigen.eigenvalues.map(|value| value.max(0.0).sqrt());
    &eigen.eigenvectors * DMatrix::from_diagonal(&scales)
}

impl Layout {
    /// A response drawn with a seed; each `stream` of a seed is another.
    fn draw(&self, seed: u64, stream: u64) -> Vec<f64> {
        let mut source = noise_source(seed, stream);
        let mut y = self.mean.clone();
        for (term, root) in self.random.iter().zip(&self.roots) {
            let effects: Vec<DVector<f64>> = (0..term.groups)
                .map(|_| root * DVector::from_fn(root.ncols(), |_, _| normal(&mut source)))
                .collect();
            for (row, value) in y.iter_mut().enumerate() {
                let columns = term.columns.iter().zip(effects[term.group[row]].iter());
                *value += columns
                    .map(|(column, effect)| column[row] * effect)
                    .sum::<f64>();
            }
        }
        for value in &mut y {
            *value += self.residual_sd * normal(&mut source);
        }
        y
    }

    /// Simulates one study.
    ///
    /// # Errors
    /// The words of the error with which it cannot be evaluated.
    pub fn simulate(
        &self,
        tested: &Tested,
        levels: &Levels,
        (seed, stream): (u64, u64),
    ) -> Result<Found, String> {
        let y = self.draw(seed, stream);
        let said = |error: windfall_mixed::error::MixedError| error.to_string();
        let options = MixedOptions::default();
        let fit = fit_mixed(&y, &self.x, &self.names, &self.random, &options).map_err(said)?;
        if let Some(why) = fit.findings.iter().find_map(lost) {
            return Err(why.to_owned());
        }
        let singular = |own: &MixedFinding| matches!(own, MixedFinding::Singular { .. });
        let uncertainty = variance_uncertainty(&fit).map_err(said)?;
        let alpha = levels.test().alpha;
        let mut interval = None;
        let mut one_sided = None;
        if let Some((weights, truth)) = &tested.coefficient {
            let found = estimate(&fit, &uncertainty, weights);
            let half = found.se * t_upper_quantile(0.5 * alpha, found.df);
            interval = Some((half, (found.value - truth).abs() <= half));
            one_sided = Some(t_upper(truth.signum() * found.value / found.se, found.df));
        }
        let p = match (levels.sides, one_sided) {
            (Sides::One, Some(p)) => p,
            _ => {
                let contrast = picking_contrast(self.names.len(), &tested.columns);
                f_test(&fit, &uncertainty, &contrast).map_err(said)?.p
            }
        };
        match p.is_finite() && interval.is_none_or(|(half, _)| half.is_finite()) {
            true => Ok(Found {
                rejected: p < alpha,
                interval,
                singular: fit.findings.iter().any(singular),
            }),
            false => Err("the test has no degrees of freedom".to_owned()),
        }
    }

    /// Whether the model can be fitted to this layout at all.
    pub fn is_estimable(&self) -> bool {
        let y = self.draw(0, 0);
        let options = MixedOptions::default();
        let fit = fit_mixed(&y, &self.x, &self.names, &self.random, &options);
        fit.is_ok_and(|fit| !fit.findings.iter().any(|own| lost(own).is_some()))
    }
}

/// Why a fit tells nothing of its variances, and so nothing of the errors of its coefficients.
fn lost(finding: &MixedFinding) -> Option<&'static str> {
    match finding {
        MixedFinding::NoConvergence { .. } => Some("the fit did not converge"),
        MixedFinding::FlatCriterion { .. } => Some("the variances cannot be told apart"),
        _ => None,
    }
}
