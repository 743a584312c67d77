//! What was achieved, as JSON shows it.

use serde::Serialize;
use windfall_files::found::FindingOutcome;
use windfall_tables::regress::mixed::VarianceOutcome;

/// Precision of one estimate.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct AchievedEstimate {
    /// "coefficient", "mean" or "difference of means".
    pub kind: &'static str,
    /// Which.
    pub name: String,
    /// Its value.
    pub estimate: f64,
    /// Its standard error.
    pub se: f64,
    /// Degrees of freedom.
    pub df: f64,
    /// Half-width of its interval.
    pub half_width: f64,
    /// Smallest true value that a study of this precision finds with the stated power; none for
    /// means and the intercept, which are not tested against zero.
    pub detectable: Option<f64>,
    /// Half-width that half as many fruit would have given, about; none where so few tell
    /// nothing.
    pub half_width_with_half: Option<f64>,
    /// Half-width that twice as many fruit would have given, about.
    pub half_width_with_twice: Option<f64>,
}

/// What a campaign has achieved.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct AchievedOutcome {
    /// The model.
    pub formula: String,
    /// What names the fruit.
    pub by: String,
    /// Fruit.
    pub fruit: usize,
    /// Impacts.
    pub impacts: usize,
    /// Level of the intervals.
    pub confidence: f64,
    /// Power of `detectable`.
    pub power: f64,
    /// Precision of coefficients, means and their differences.
    pub estimates: Vec<AchievedEstimate>,
    /// Standard deviations with profile intervals.
    pub variances: Vec<VarianceOutcome>,
    /// What a reader must know.
    pub findings: Vec<FindingOutcome>,
}
