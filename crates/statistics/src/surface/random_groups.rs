//! Response surfaces of runs in random groups: days, operators, whole plots.

use crate::error::Error;
use crate::model::linear_model::{LinearFit, Quality, student_quantile};
use crate::model::prediction::Prediction;
use nalgebra::DMatrix;
use windfall_mixed::coefficient::{Coefficient, Estimated};
use windfall_mixed::fit::{MixedFit, MixedOptions, fit_mixed};
use windfall_mixed::inference::{
    FTest, VarianceUncertainty, picking_contrast, variance_uncertainty,
};
use windfall_mixed::kenward_roger::{
    KenwardRoger, kenward_roger, kenward_roger_estimate, kenward_roger_f, kenward_roger_tests,
};
use windfall_mixed::predict::{NewRows, NewTerm, predict_mixed};
use windfall_mixed::summary::variance_shares;
use windfall_mixed::term::RandomTerm;

/// Coefficients of a surface by restricted maximum likelihood, with the errors of Kenward and
/// Roger.
#[derive(Clone, Debug)]
pub struct RandomGroups {
    /// The groups: each has a mean of its own.
    pub terms: Vec<RandomTerm>,
    /// The fit.
    pub fit: MixedFit,
    /// What is known of its variances.
    pub uncertainty: VarianceUncertainty,
    /// Errors of its coefficients.
    pub adjusted: KenwardRoger,
    /// Columns of the model matrix that were estimated.
    pub columns: Vec<usize>,
    /// Level of the intervals.
    confidence: f64,
}

impl RandomGroups {
    /// Estimates the columns that least squares can tell apart.
    ///
    /// * `squares`: the model by least squares; `x`: its matrix
    ///
    /// # Errors
    /// Those of mixed models: variances that cannot be told apart, too few groups or rows.
    ///
    /// # Source
    /// Letsinger, Myers and Lentner (1996), Response surface methods for bi-randomization
    /// structures, J. Qual. Technol. 28, 381-397.
    pub(crate) fn of(
        squares: &LinearFit,
        x: &DMatrix<f64>,
        y: &[f64],
        terms: Vec<RandomTerm>,
    ) -> Result<Self, Error> {
        let columns = squares.columns.clone();
        let names = squares.coefficients.iter().map(|own| own.name.clone());
        let names: Vec<String> = names.collect();
        let own = x.select_columns(&columns);
        let fit = fit_mixed(y, &own, &names, &terms, &MixedOptions::default())?;
        Ok(Self {
            uncertainty: variance_uncertainty(&fit)?,
            adjusted: kenward_roger(&fit)?,
            terms,
            columns,
            confidence: squares.confidence,
            fit,
        })
    }

    /// Coefficients of `columns` with their tests.
    pub fn coefficients(&self) -> Vec<Coefficient> {
        kenward_roger_tests(&self.fit, &self.adjusted, self.confidence)
    }

    /// F test that the coefficients of these columns of the model matrix are zero; `None` where
    /// none of them was estimated.
    pub fn test(&self, wanted: &[usize]) -> Option<FTest> {
        let places = self.columns.iter().enumerate();
        let picked = places.filter(|(_, column)| wanted.contains(column));
        let picked: Vec<usize> = picked.map(|(place, _)| place).collect();
        let contrast = picking_contrast(self.columns.len(), &picked);
        kenward_roger_f(&self.fit, &self.adjusted, &contrast).ok()
    }

    /// Predictions for groups that were not measured, at rows of the model matrix. The interval
    /// of a further observation reckons with the variance between groups; its degrees of freedom
    /// are Satterthwaite's.
    pub fn predict(&self, x: &DMatrix<f64>) -> Vec<Prediction> {
        let own = x.select_columns(&self.columns);
        let means: Vec<Estimated> = own
            .row_iter()
            .map(|row| {
                let weights: Vec<f64> = row.iter().copied().collect();
                kenward_roger_estimate(&self.fit, &self.adjusted, &weights)
            })
            .collect();
        let count = own.nrows();
        let terms = self.terms.iter().map(|term| NewTerm {
            columns: vec![vec![1.0; count]; term.columns.len()],
            group: vec![None; count],
        });
        let rows = NewRows {
            level: Vec::new(),
            terms: terms.collect(),
            x: own,
        };
        let single = predict_mixed(&self.fit, &self.uncertainty, &rows, self.confidence);
        // The criterion was finite around the estimate when its uncertainty was found.
        let single = single.map_or_else(
            |_| vec![(f64::NAN, f64::NAN); count],
            |found| found.iter().map(|own| (own.low, own.high)).collect(),
        );
        let level = 0.5 + 0.5 * self.confidence;
        let both = means.iter().zip(single);
        both.map(|(mean, (low, high))| {
            let half = student_quantile(level, mean.df) * mean.se;
            Prediction {
                mean: mean.value,
                se: mean.se,
                mean_low: mean.value - half,
                mean_high: mean.value + half,
                low,
                high,
            }
        })
        .collect()
    }

    /// How good the surface is: R² is the part of the variance that it describes (Nakagawa and
    /// Schielzeth 2013, marginal), the likelihood is the restricted one, and what is defined by
    /// sums of squares is NaN.
    ///
    /// * `x`: model matrix
    pub fn quality(&self, x: &DMatrix<f64>) -> Quality {
        let fit = &self.fit;
        let own = x.select_columns(&self.columns);
        let expected = own.row_iter().map(|row| {
            let pairs = row.iter().zip(&fit.coefficients);
            pairs.map(|(x, b)| x * b).sum::<f64>()
        });
        let (low, high) = expected.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| {
            (l.min(v), h.max(v))
        });
        let variance = (&own * &self.adjusted.covariance).component_mul(&own).sum();
        Quality {
            r2: variance_shares(fit).r2_marginal,
            r2_adjusted: f64::NAN,
            r2_predicted: f64::NAN,
            press: f64::NAN,
            adequate_precision: (high - low) / (variance / own.nrows() as f64).sqrt(),
            sigma: fit.residual_sd,
            log_likelihood: fit.log_likelihood,
            aic: fit.aic,
            aicc: fit.aicc,
            bic: fit.bic,
        }
    }
}
