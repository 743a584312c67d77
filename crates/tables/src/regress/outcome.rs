//! Fitted linear models as JSON shows them.

use serde::Serialize;
use windfall_statistics::model::anova::{Anova, AnovaType, LackOfFit};
use windfall_statistics::model::expression::columns_of;
use windfall_statistics::model::formula::Formula;
use windfall_statistics::model::linear_model::{Coefficient, LinearFit, Prediction, Quality};
use windfall_statistics::residuals::diagnostics::{Inflation, RowInfluence};
use windfall_statistics::table::Table;

/// A step of a selection.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct StepOutcome {
    /// The term.
    pub term: String,
    /// "removed" or "entered".
    pub action: &'static str,
    /// F of the term.
    pub f: f64,
    /// Its probability.
    pub p: f64,
    /// The criterion after the step, where one decides.
    pub criterion: Option<f64>,
    /// R² after the step.
    pub r2: f64,
}

/// An estimate.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct TermOutcome {
    /// Its column.
    pub term: String,
    /// Its value.
    pub estimate: f64,
    /// Its standard error.
    pub se: f64,
    /// Estimate over standard error.
    pub t: f64,
    /// Probability of |t| or more if it were zero.
    pub p: f64,
    /// Lower end of its interval.
    pub low: f64,
    /// Upper end.
    pub high: f64,
    /// Degrees of freedom of t.
    pub df: f64,
}

/// In which range a column was.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
#[schema(as = ModelRange)]
pub struct RangeOutcome {
    /// The column.
    pub column: String,
    /// Its smallest value.
    pub low: f64,
    /// Its largest.
    pub high: f64,
}

/// Ranges of the columns of numbers on the right side of a formula.
///
/// * `kept`: rows that were used
#[must_use]
pub fn ranges_of(formula: &Formula, table: &Table, kept: &[usize]) -> Vec<RangeOutcome> {
    let mut names: Vec<String> = Vec::new();
    for atom in &formula.atoms {
        names.extend(columns_of(&atom.node));
    }
    names.sort();
    names.dedup();
    let numbers = names
        .iter()
        .filter_map(|name| Some((name, table.numbers(name).ok()?)));
    let range = |(name, values): (&String, &[f64])| {
        let own = kept.iter().map(|row| values[*row]);
        let (low, high) = own.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
            (low.min(value), high.max(value))
        });
        RangeOutcome {
            column: name.clone(),
            low,
            high,
        }
    };
    numbers.map(range).collect()
}

/// A row of an analysis of variance.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct AnovaOutcome {
    /// The term.
    pub term: String,
    /// Its sum of squares.
    #[schema(value_type = Option<f64>)]
    pub ss: f64,
    /// Its degrees of freedom.
    pub df: f64,
    /// Mean square over that of the residuals.
    pub f: f64,
    /// Probability of F or more without the term.
    pub p: f64,
}

/// A sum of squares with its degrees of freedom.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct SumOfSquares {
    /// Sum of squares.
    pub ss: f64,
    /// Degrees of freedom.
    pub df: f64,
}

/// The whole model against none.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct WholeModel {
    /// Sum of squares.
    pub ss: f64,
    /// Degrees of freedom.
    pub df: f64,
    /// Mean square over that of the residuals.
    pub f: f64,
    /// Probability of F or more without the model.
    pub p: f64,
}

/// Lack of fit against pure error.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct LackOfFitOutcome {
    /// What the model misses.
    pub lack: AnovaOutcome,
    /// Scatter of repeated rows.
    pub pure_error: SumOfSquares,
}

/// Variance inflation of a term.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct InflationOutcome {
    /// The term.
    pub term: String,
    /// Columns of it.
    pub df: usize,
    /// The factor.
    pub factor: f64,
}

/// What a row does to the fit.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct RowOutcome {
    /// Line of the table's file.
    pub line: usize,
    /// What was observed.
    pub observed: f64,
    /// What the model says.
    pub fitted: f64,
    /// Observed less fitted.
    pub residual: f64,
    /// Diagonal of the hat matrix.
    pub leverage: f64,
    /// Residual over its standard error.
    pub standardised: f64,
    /// The same with the variance of the other rows.
    #[schema(value_type = Option<f64>)]
    pub studentised: f64,
    /// Cook's distance.
    #[schema(value_type = Option<f64>)]
    pub cook: f64,
    /// Change of the prediction without the row, in standard errors.
    pub dffits: f64,
}

/// A prediction with intervals.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct PredictionOutcome {
    /// Line of the file that asks for it.
    pub line: usize,
    /// The mean there.
    pub predicted: f64,
    /// Its standard error.
    pub se: f64,
    /// Interval of the mean.
    pub mean_low: f64,
    /// Its upper end.
    pub mean_high: f64,
    /// Interval of one further observation.
    pub low: f64,
    /// Its upper end.
    pub high: f64,
}

/// How good a model is.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct QualityOutcome {
    /// Part of the variation that is described.
    pub r2: f64,
    /// The same per degree of freedom.
    pub r2_adjusted: f64,
    /// Part that is predicted of rows left out one by one.
    pub r2_predicted: f64,
    /// Sum of squares of these predictions.
    pub press: f64,
    /// Range of predictions over their mean standard error.
    pub adequate_precision: f64,
    /// Residual standard deviation.
    pub sigma: f64,
    /// Log-likelihood.
    pub log_likelihood: f64,
    /// Akaike's criterion.
    pub aic: f64,
    /// The same for small samples.
    pub aicc: f64,
    /// Schwarz' criterion.
    pub bic: f64,
}

impl From<Quality> for QualityOutcome {
    fn from(quality: Quality) -> Self {
        Self {
            r2: quality.r2,
            r2_adjusted: quality.r2_adjusted,
            r2_predicted: quality.r2_predicted,
            press: quality.press,
            adequate_precision: quality.adequate_precision,
            sigma: quality.sigma,
            log_likelihood: quality.log_likelihood,
            aic: quality.aic,
            aicc: quality.aicc,
            bic: quality.bic,
        }
    }
}

/// Estimates as they are shown.
#[must_use]
pub fn terms_of(coefficients: &[Coefficient], df: f64) -> Vec<TermOutcome> {
    let shown = coefficients.iter().map(|coefficient| TermOutcome {
        term: coefficient.name.clone(),
        estimate: coefficient.estimate,
        se: coefficient.se,
        t: coefficient.t,
        p: coefficient.p,
        low: coefficient.low,
        high: coefficient.high,
        df,
    });
    shown.collect()
}

/// The rows of an analysis of variance as they are shown.
#[must_use]
pub fn anova_of(anova: &Anova) -> Vec<AnovaOutcome> {
    let rows = anova.rows.iter().map(|row| AnovaOutcome {
        term: row.term.clone(),
        ss: row.ss,
        df: row.df as f64,
        f: row.f,
        p: row.p,
    });
    rows.collect()
}

/// "I", "II" or "III".
#[must_use]
pub fn roman(kind: AnovaType) -> &'static str {
    match kind {
        AnovaType::Sequential => "I",
        AnovaType::Hierarchical => "II",
        AnovaType::Partial => "III",
    }
}

/// The whole model against none.
#[must_use]
pub fn whole_of(fit: &LinearFit) -> WholeModel {
    let (f, p) = fit.whole_test();
    WholeModel {
        ss: fit.model_ss(),
        df: fit.model_df() as f64,
        f,
        p,
    }
}

/// Lack of fit as it is shown.
#[must_use]
pub fn lack_of(found: &LackOfFit) -> LackOfFitOutcome {
    LackOfFitOutcome {
        lack: AnovaOutcome {
            term: found.lack.term.clone(),
            ss: found.lack.ss,
            df: found.lack.df as f64,
            f: found.lack.f,
            p: found.lack.p,
        },
        pure_error: SumOfSquares {
            ss: found.pure_ss,
            df: found.pure_df as f64,
        },
    }
}

/// Variance inflation as it is shown.
#[must_use]
pub fn inflation_of(found: &[Inflation]) -> Vec<InflationOutcome> {
    let shown = found.iter().map(|inflation| InflationOutcome {
        term: inflation.term.clone(),
        df: inflation.df,
        factor: inflation.factor,
    });
    shown.collect()
}

/// Rows with their influence.
///
/// * `lines`: lines of the rows in the file
#[must_use]
pub fn rows_of(influence: &[RowInfluence], observed: &[f64], lines: &[usize]) -> Vec<RowOutcome> {
    let rows = influence.iter().zip(observed).zip(lines);
    rows.map(|((row, observed), line)| RowOutcome {
        line: *line,
        observed: *observed,
        fitted: observed - row.residual,
        residual: row.residual,
        leverage: row.leverage,
        standardised: row.standardised,
        studentised: row.studentised,
        cook: row.cook,
        dffits: row.dffits,
    })
    .collect()
}

/// Predictions as they are shown.
#[must_use]
pub fn predictions_of(found: &[Prediction], lines: &[usize]) -> Vec<PredictionOutcome> {
    let rows = found.iter().zip(lines);
    rows.map(|(prediction, line)| PredictionOutcome {
        line: *line,
        predicted: prediction.mean,
        se: prediction.se,
        mean_low: prediction.mean_interval.0,
        mean_high: prediction.mean_interval.1,
        low: prediction.interval.0,
        high: prediction.interval.1,
    })
    .collect()
}
