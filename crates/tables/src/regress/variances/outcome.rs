//! Residual variances by level, as JSON shows them.

use serde::Serialize;

/// Residual variances by the level of a category.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct VariancesOutcome {
    /// The category.
    pub by: String,
    /// "REML" or "ML".
    pub method: &'static str,
    /// Its levels.
    pub levels: Vec<LevelVarianceOutcome>,
    /// Against one variance for all rows.
    pub test: VariancesTest,
    /// Degrees of freedom of the denominator of F, one for each row of `anova`.
    #[schema(value_type = Vec<Option<f64>>)]
    pub anova_df: Vec<f64>,
    /// The same of the model against none.
    #[schema(value_type = Option<f64>)]
    pub model_df: f64,
}

/// Residual variance of a level.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct LevelVarianceOutcome {
    /// The level.
    pub level: String,
    /// Rows of it.
    pub rows: usize,
    /// Residual standard deviation.
    pub sd: f64,
    /// Lower end of its interval.
    #[schema(value_type = Option<f64>)]
    pub low: f64,
    /// Upper end.
    #[schema(value_type = Option<f64>)]
    pub high: f64,
    /// Degrees of freedom of the variance.
    #[schema(value_type = Option<f64>)]
    pub df: f64,
}

/// Likelihood-ratio test of several variances against one.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct VariancesTest {
    /// Twice the difference of the log-likelihoods.
    pub statistic: f64,
    /// Degrees of freedom.
    pub df: usize,
    /// Probability of as much or more with one variance.
    pub p: f64,
}
