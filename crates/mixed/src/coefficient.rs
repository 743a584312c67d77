//! A coefficient of a model with its test and interval.

use serde::Serialize;

/// An estimate. What needs residual degrees of freedom is NaN where there are none.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
#[schema(as = TermOutcome)]
pub struct Coefficient {
    /// Its column.
    #[serde(rename = "term")]
    pub name: String,
    /// Its value.
    pub estimate: f64,
    /// Its standard error.
    #[schema(value_type = Option<f64>)]
    pub se: f64,
    /// Estimate over standard error.
    #[schema(value_type = Option<f64>)]
    pub t: f64,
    /// Probability of |t| or more if the coefficient were zero.
    #[schema(value_type = Option<f64>)]
    pub p: f64,
    /// Lower end of its interval.
    #[schema(value_type = Option<f64>)]
    pub low: f64,
    /// Upper end.
    #[schema(value_type = Option<f64>)]
    pub high: f64,
    /// Degrees of freedom of t.
    #[schema(value_type = Option<f64>)]
    pub df: f64,
}

/// An estimate with its standard error and degrees of freedom.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimated {
    /// Its value.
    pub value: f64,
    /// Its standard error.
    pub se: f64,
    /// Degrees of freedom.
    pub df: f64,
}
