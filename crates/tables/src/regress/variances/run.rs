//! A residual variance for each level of a category: estimates, and what follows from them.

use crate::regress::outcome::{PredictionOutcome, original_prediction};
use crate::regress::request::RegressRequest;
use crate::regress::variances::outcome::{LevelVarianceOutcome, VariancesOutcome, VariancesTest};
use nalgebra::DMatrix;
use windfall_distribution::tail::chi_squared_upper;
use windfall_files::error::Error;
use windfall_files::option_value::unusable;
use windfall_files::table::data::Data;
use windfall_mixed::coefficient::Estimated;
use windfall_mixed::fit::MixedMethod;
use windfall_mixed::residual_levels::ResidualLevels;
use windfall_statistics::error::Error as StatisticsError;
use windfall_statistics::model::anova::{AnovaRow, hypothesis};
use windfall_statistics::model::linear_model::{
    LinearFit, Quality, WholeModel, small_sample, student_quantile,
};
use windfall_statistics::model::model_frame::prediction_rows;
use windfall_statistics::model::model_rows::FormulaRows;
use windfall_statistics::model::original_scale::OriginalScale;
use windfall_statistics::model::prediction::Prediction;
use windfall_statistics::model::reduced::Reduced;
use windfall_statistics::model::variance_groups::{
    LevelInference, LevelledRows, VarianceGroups, variance_groups,
};
use windfall_statistics::table::Cells;

/// Estimated variances, and the levels that they are of.
pub(crate) struct ByLevel {
    groups: VarianceGroups,
    levels: ResidualLevels,
    method: MixedMethod,
}

/// A model whose terms are tested: rows, their triangle and the fit of it.
pub(crate) type Tested<'a> = (&'a FormulaRows<'a>, &'a Reduced, &'a LinearFit);

/// Refuses what has no accepted meaning beside variances by level.
///
/// # Errors
/// Another option that says how rows vary, or that selects terms.
pub(crate) fn check_variance(request: &RegressRequest) -> Result<(), Error> {
    if request.variance.is_none() {
        return Ok(());
    }
    let problem = match request {
        own if own.weights.is_some() => {
            "rows have either weights of a column or variances that are estimated: leave out \
             --weights"
        }
        own if own.robust => {
            "variances by level are what makes the standard errors right: leave out --robust"
        }
        own if own.select.is_some() => {
            "terms are not selected while variances are estimated: select them first, then give \
             the formula that is left"
        }
        own if own.fold_by.is_some() => {
            "models with variances by level are not cross-validated: leave out --fold-by"
        }
        _ => return Ok(()),
    };
    Err(unusable("--variance", problem))
}

/// Gives each row the weight of its level, one over the variance, where variances by level are
/// asked for.
///
/// # Errors
/// A level whose rows tell no variance, a column with one level.
pub(crate) fn weigh_levels(
    request: &RegressRequest,
    data: &Data,
    rows: &mut FormulaRows,
) -> Result<Option<ByLevel>, Error> {
    let Some(column) = &request.variance else {
        return Ok(None);
    };
    let told = |error: StatisticsError| data.told(error);
    let levels = residual_levels(column, data, rows.kept.iter())?;
    let every: Vec<usize> = (0..rows.frame.names.len()).collect();
    let estimated = rows.reduced().map_err(told)?.solve(&every).columns;
    let x = columns(rows, &estimated).map_err(told)?;
    let groups = variance_groups(
        &LevelledRows {
            x: &x,
            y: &rows.y,
            levels: &levels,
        },
        request.likelihood,
    );
    let groups = groups.map_err(told)?;
    rows.weights = groups.weights();
    Ok(Some(ByLevel {
        groups,
        levels,
        method: request.likelihood,
    }))
}

/// The level of each of some rows, and the names of those that have rows.
///
/// # Errors
/// There is no such column, or it has one level.
pub(crate) fn residual_levels(
    column: &str,
    data: &Data,
    kept: impl Iterator<Item = usize>,
) -> Result<ResidualLevels, Error> {
    let cells = data.table.column(column);
    let cells = &cells.map_err(|error| data.told(error))?.cells;
    let categories = cells.categories();
    let codes: Vec<usize> = kept.filter_map(|row| categories.codes[row]).collect();
    let mut known = codes.clone();
    known.sort_unstable();
    known.dedup();
    if known.len() < 2 {
        let problem = format!(
            "all rows of the model have the same {column}, so that there are no variances to \
             tell apart: leave the option out"
        );
        return Err(unusable("--variance", problem));
    }
    if matches!(cells, Cells::Numbers(_)) && 2 * known.len() > codes.len() {
        let problem = format!(
            "{column} holds {} different numbers in {} rows: it measures something, and names no \
             groups of rows",
            known.len(),
            codes.len()
        );
        return Err(unusable("--variance", problem));
    }
    let place = |code: &usize| known.binary_search(code).unwrap_or_default();
    let names = known.iter().map(|own| categories.levels[*own].clone());
    Ok(ResidualLevels {
        column: column.to_owned(),
        names: names.collect(),
        level: codes.iter().map(place).collect(),
    })
}

/// The level of each row of a table to be predicted.
///
/// # Errors
/// The table lacks the column of levels, or has others.
pub(crate) fn asked_levels(levels: &ResidualLevels, asked: &Data) -> Result<Vec<usize>, Error> {
    let told = |error| asked.told(error);
    let cells = &asked.table.column(&levels.column).map_err(told)?.cells;
    let categories = cells.categories();
    let found = (0..asked.table.rows()).map(|row| {
        let Some(code) = categories.codes[row] else {
            let problem = format!(
                "{}, line {}: {} is missing, whose level says how much a measurement scatters",
                asked.path.display(),
                asked.line(row),
                levels.column
            );
            return Err(unusable("--predict", problem));
        };
        let name = &categories.levels[code];
        let level = levels.names.iter().position(|own| own == name);
        level.ok_or_else(|| {
            told(StatisticsError::UnknownLevel {
                column: levels.column.clone(),
                level: name.clone(),
                row: row + 1,
                known: levels.names.join(", "),
            })
        })
    });
    found.collect()
}

/// Some columns of a model matrix.
fn columns(rows: &FormulaRows, wanted: &[usize]) -> Result<DMatrix<f64>, StatisticsError> {
    Ok(rows.x().whole()?.select_columns(wanted))
}

impl ByLevel {
    /// What tests of a fit with these weights need.
    pub(crate) fn inference(
        &self,
        rows: &FormulaRows,
        fit: &LinearFit,
    ) -> Result<LevelInference, StatisticsError> {
        let x = columns(rows, &fit.columns)?;
        Ok(self.groups.inference(fit, &x))
    }

    /// Puts tests that count the uncertainty of the variances in the place of those that take
    /// them as known.
    ///
    /// * `tested`: the model in the coding in which its terms are tested
    pub(crate) fn tests(
        &self,
        request: &RegressRequest,
        (rows, reduced, fit): Tested,
        (anova, model): (&mut [AnovaRow], &mut WholeModel),
    ) -> Result<VariancesOutcome, StatisticsError> {
        let own = self.inference(rows, fit)?;
        let terms: Vec<usize> = (0..rows.frame.terms.len()).collect();
        let mut anova_df = Vec::new();
        for (place, row) in anova.iter_mut().enumerate() {
            let sums = hypothesis((&rows.frame, reduced), &terms, place, request.anova);
            let test = own.test(&sums);
            (row.f, row.p) = test
                .as_ref()
                .map_or((f64::NAN, f64::NAN), |own| (own.f, own.p));
            anova_df.push(test.map_or(f64::NAN, |own| own.denominator));
        }
        let (f, p, model_df) = self.whole(rows, fit, &own);
        (model.f, model.p) = (f, p);
        Ok(VariancesOutcome {
            by: self.levels.column.clone(),
            method: self.method.name(),
            levels: self.levels(request.confidence),
            test: variances_test(
                self.groups.log_likelihood - self.groups.equal_log_likelihood,
                self.groups.variances.len(),
            ),
            anova_df,
            model_df,
        })
    }

    /// F, p and degrees of freedom of the noise of the test that all but the intercept is zero.
    fn whole(&self, rows: &FormulaRows, fit: &LinearFit, own: &LevelInference) -> (f64, f64, f64) {
        let columns = fit.columns.iter().filter(|own| !fit.intercept || **own > 0);
        let columns: Vec<usize> = columns.copied().collect();
        let sums = DMatrix::from_fn(columns.len(), rows.frame.names.len(), |row, column| {
            f64::from(u8::from(columns[row] == column))
        });
        let test = own.test(&sums);
        test.map_or((f64::NAN, f64::NAN, f64::NAN), |own| {
            (own.f, own.p, own.denominator)
        })
    }

    /// Likelihood and criteria that count the variances, and the root of their mean.
    pub(crate) fn qualify(&self, quality: &mut Quality, fit: &LinearFit) {
        let parameters = (fit.columns.len() + self.groups.variances.len()) as f64;
        let (rows, likelihood) = (fit.rows as f64, self.groups.log_likelihood);
        quality.sigma = self.groups.mean_sd();
        quality.log_likelihood = likelihood;
        quality.aic = 2.0 * parameters - 2.0 * likelihood;
        quality.aicc = small_sample(quality.aic, parameters, rows);
        quality.bic = parameters * rows.ln() - 2.0 * likelihood;
    }

    fn levels(&self, confidence: f64) -> Vec<LevelVarianceOutcome> {
        let levels = self.levels.names.iter().enumerate();
        let shown = levels.map(|(place, name)| {
            let (low, high) = self.groups.interval(place, confidence);
            LevelVarianceOutcome {
                level: name.clone(),
                rows: self.groups.rows[place],
                sd: self.groups.variances[place].sqrt(),
                low,
                high,
                df: self.groups.freedom[place],
            }
        });
        shown.collect()
    }

    /// Predictions, each observation with the variance of its own level.
    ///
    /// # Errors
    /// The table lacks the column of levels, or has others.
    pub(crate) fn predictions(
        &self,
        asked: &Data,
        scale: Option<&OriginalScale>,
        rows: &FormulaRows,
        (inference, confidence): (&LevelInference, f64),
    ) -> Result<Vec<PredictionOutcome>, Error> {
        let told = |error| asked.told(error);
        let x = prediction_rows(&rows.frame, &asked.table).map_err(told)?;
        let levels = asked_levels(&self.levels, asked)?;
        let lines = asked.lines.iter().zip(levels).enumerate();
        let shown = lines.map(|(row, (line, level))| {
            let weights: Vec<f64> = x.row(row).iter().copied().collect();
            let own = (level, self.groups.variances[level]);
            let mean = inference.estimate(&weights);
            let prediction = predicted(&mean, &inference.observation(&weights, own), confidence);
            PredictionOutcome {
                line,
                original: original_prediction(
                    scale,
                    prediction.mean,
                    (prediction.mean_low, prediction.mean_high),
                    (prediction.low, prediction.high),
                ),
                prediction,
            }
        });
        Ok(shown.collect())
    }
}

/// Likelihood-ratio test of variances by level against one for all rows.
///
/// * `rise`: of the log-likelihood
pub(crate) fn variances_test(rise: f64, levels: usize) -> VariancesTest {
    let (statistic, df) = ((2.0 * rise).max(0.0), levels - 1);
    VariancesTest {
        statistic,
        df,
        p: chi_squared_upper(statistic, df as f64),
    }
}

fn predicted(mean: &Estimated, observation: &Estimated, confidence: f64) -> Prediction {
    let half = |own: &Estimated| student_quantile(0.5 + 0.5 * confidence, own.df) * own.se;
    let (value, mean_half, half) = (mean.value, half(mean), half(observation));
    Prediction {
        mean: value,
        se: mean.se,
        mean_low: value - mean_half,
        mean_high: value + mean_half,
        low: value - half,
        high: value + half,
    }
}
