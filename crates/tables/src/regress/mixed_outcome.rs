//! Fitted mixed models as JSON shows them.

use crate::regress::means::outcome::MeansOutcome;
use crate::regress::outcome::{OriginalPrediction, RangeOutcome};
use crate::regress::variances::outcome::VariancesTest;
use crate::rows::RowCount;
use serde::Serialize;
use windfall_files::found::FindingOutcome;
use windfall_mixed::coefficient::Coefficient;
use windfall_mixed::predict::MixedPrediction;
use windfall_statistics::model::anova::AnovaRow;

/// A standard deviation between groups, or the correlation of two effects.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct VarianceOutcome {
    /// Groups: `specimen`; "residual".
    pub group: String,
    /// "sd" or "correlation".
    pub kind: &'static str,
    /// What varies between the groups; the level of a residual one.
    pub of: String,
    /// Its value.
    pub value: f64,
    /// Lower end of its profile interval.
    #[schema(value_type = Option<f64>)]
    pub low: f64,
    /// Upper end.
    #[schema(value_type = Option<f64>)]
    pub high: f64,
}

/// An effect of a group.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct EffectOutcome {
    /// What names the group: `specimen`.
    pub by: String,
    /// The group.
    pub group: String,
    /// What varies.
    pub of: String,
    /// Its deviation from the mean over groups.
    pub value: f64,
    /// Its standard deviation.
    pub sd: f64,
}

/// A prediction with the effects of known groups.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct MixedPredictionOutcome {
    /// Line of the file that asks for it.
    pub line: usize,
    /// Means and intervals.
    #[serde(flatten)]
    pub prediction: MixedPrediction,
    /// The same on the scale of the column that the response is a function of.
    pub original: Option<OriginalPrediction>,
}

/// Levels that have residual variances of their own; their standard deviations are among
/// `variances`.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct MixedLevelsOutcome {
    /// The category.
    pub by: String,
    /// Rows of each level.
    pub rows: Vec<(String, usize)>,
    /// Against one variance for all rows.
    pub test: VariancesTest,
}

/// A fitted mixed model.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct MixedOutcome {
    /// The formula.
    pub formula: String,
    /// What is modelled.
    pub response: String,
    /// "REML" or "ML".
    pub method: &'static str,
    /// "Satterthwaite" or "Kenward-Roger".
    pub df_method: &'static str,
    /// Rows that were used and left out, by the levels of the model's first category.
    #[serde(flatten)]
    pub count: RowCount,
    /// Groups of each random term.
    pub groups: Vec<(String, usize)>,
    /// Column of the weights of rows.
    pub weights: Option<String>,
    /// Levels that have residual variances of their own, where they have.
    pub level_variances: Option<MixedLevelsOutcome>,
    /// Fixed effects.
    pub terms: Vec<Coefficient>,
    /// Covariance of the fixed effects, in the order of `terms`.
    pub covariance: Vec<Vec<f64>>,
    /// In which ranges the columns of the model were.
    pub ranges: Vec<RangeOutcome>,
    /// F tests of the terms after all others.
    pub anova: Vec<MixedTest>,
    /// Standard deviations and correlations.
    pub variances: Vec<VarianceOutcome>,
    /// Part of the variance that fixed effects describe (marginal).
    pub r2: f64,
    /// Not defined for mixed models.
    pub r2_adjusted: Option<f64>,
    /// Part that fixed and random effects describe.
    pub r2_conditional: f64,
    /// Share of each random term in what fixed effects leave.
    pub intraclass: Vec<f64>,
    /// Log of the (restricted) likelihood.
    pub log_likelihood: f64,
    /// -2 times it.
    pub criterion: f64,
    /// Akaike's criterion.
    pub aic: f64,
    /// The same for small samples.
    pub aicc: f64,
    /// Schwarz' criterion.
    pub bic: f64,
    /// None: terms of mixed models are not selected.
    pub removed: Vec<String>,
    /// Effects of the groups.
    pub effects: Vec<EffectOutcome>,
    /// Predictions.
    pub predictions: Vec<MixedPredictionOutcome>,
    /// Marginal means.
    pub means: Vec<MeansOutcome>,
    /// What a reader must know.
    pub findings: Vec<FindingOutcome>,
}

/// An F test of a term.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct MixedTest {
    /// F with the degrees of freedom of the term; no sum of squares is defined.
    #[serde(flatten)]
    pub test: AnovaRow,
    /// Degrees of freedom of the denominator.
    #[schema(value_type = Option<f64>)]
    pub df_denominator: f64,
}
