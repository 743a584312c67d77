//! Marginal means, slopes and their comparisons, as JSON shows them.

use serde::Serialize;

/// Means, or slopes, for levels of categories.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct MeansOutcome {
    /// Column of numbers on which these are slopes; none for means.
    pub slope_on: Option<String>,
    /// The categories.
    pub of: Vec<String>,
    /// Categories within whose levels they are compared.
    pub within: Vec<String>,
    /// Columns of numbers with the value at which they are held.
    pub at: Vec<(String, f64)>,
    /// The means.
    pub means: Vec<MeanOutcome>,
    /// The column that the response is a function of, where means are shown on its scale.
    pub original: Option<String>,
    /// What a mean on that scale is.
    pub meaning: Option<String>,
    /// Which means are compared: "pairs", "control", "mean", "polynomial", "custom".
    pub compared: &'static str,
    /// How the comparisons are adjusted for their number.
    pub adjusted: &'static str,
    /// Comparisons.
    pub differences: Vec<DifferenceOutcome>,
    /// Tests that all of these are equal, within each level where they are compared so.
    pub tests: Vec<EqualityOutcome>,
}

/// A marginal mean, or a slope.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct MeanOutcome {
    /// Levels, first of the categories within which they are compared.
    pub levels: Vec<String>,
    /// The mean on the scale of the model.
    pub mean: f64,
    /// Its standard error.
    #[schema(value_type = Option<f64>)]
    pub se: f64,
    /// Degrees of freedom.
    #[schema(value_type = Option<f64>)]
    pub df: f64,
    /// Lower end of its interval.
    #[schema(value_type = Option<f64>)]
    pub low: f64,
    /// Upper end.
    #[schema(value_type = Option<f64>)]
    pub high: f64,
    /// The same on the scale of the column that the response is a function of.
    pub original: Option<OnScale>,
}

/// A value with its interval on another scale than the model's.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct OnScale {
    /// The value.
    #[schema(value_type = Option<f64>)]
    pub value: f64,
    /// Lower end of its interval.
    #[schema(value_type = Option<f64>)]
    pub low: f64,
    /// Upper end; null where it has none.
    #[schema(value_type = Option<f64>)]
    pub high: f64,
}

/// A comparison of means.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct DifferenceOutcome {
    /// Levels of the categories within which means are compared.
    pub within: Vec<String>,
    /// What is compared: "Gala - Fuji", "linear".
    pub contrast: String,
    /// Its value.
    pub difference: f64,
    /// Its standard error.
    #[schema(value_type = Option<f64>)]
    pub se: f64,
    /// Degrees of freedom.
    #[schema(value_type = Option<f64>)]
    pub df: f64,
    /// Difference over its standard error.
    #[schema(value_type = Option<f64>)]
    pub t: f64,
    /// Probability, adjusted.
    #[schema(value_type = Option<f64>)]
    pub p: f64,
    /// Lower end of the interval, adjusted.
    #[schema(value_type = Option<f64>)]
    pub low: f64,
    /// Upper end.
    #[schema(value_type = Option<f64>)]
    pub high: f64,
    /// The ratio that it stands for, where the response is a logarithm.
    pub ratio: Option<OnScale>,
}

/// F test that means are all equal.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct EqualityOutcome {
    /// Levels of the categories within which means are compared.
    pub within: Vec<String>,
    /// F.
    #[schema(value_type = Option<f64>)]
    pub f: f64,
    /// Degrees of freedom of the numerator.
    pub df: usize,
    /// Of the denominator.
    #[schema(value_type = Option<f64>)]
    pub df_denominator: f64,
    /// Probability of F or more.
    #[schema(value_type = Option<f64>)]
    pub p: f64,
}
