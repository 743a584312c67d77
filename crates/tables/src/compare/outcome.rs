//! What a comparison of groups finds.

use crate::rows::RowCount;
use serde::Serialize;
use windfall_files::found::FindingOutcome;
use windfall_statistics::compare::group_summary::GroupSummary;
use windfall_statistics::compare::one_way_anova::{FTest, OneWayAnova};

/// Groups compared.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct CompareOutcome {
    /// The column of values.
    pub value: String,
    /// Columns that group the rows.
    pub by: Vec<String>,
    /// The column that pairs them.
    pub paired: Option<String>,
    /// Rows with a value and a group, and those without.
    #[serde(flatten)]
    pub count: RowCount,
    /// Confidence of all intervals.
    pub confidence: f64,
    /// The groups.
    pub groups: Vec<LetteredGroup>,
    /// Analysis of variance, for groups that are not paired.
    pub anova: Option<OneWayAnova>,
    /// Welch's analysis of variance.
    pub welch: Option<FTest>,
    /// Levene's test of equal variances (about means).
    pub levene: Option<FTest>,
    /// Brown and Forsythe's (about medians).
    pub brown_forsythe: Option<FTest>,
    /// Bartlett's.
    pub bartlett: Option<StatisticTest>,
    /// Shapiro and Wilk's test of residuals, or of the differences of pairs.
    pub shapiro_wilk: Option<StatisticTest>,
    /// How pairs of groups are compared.
    pub method: &'static str,
    /// Every pair of groups.
    pub pairs: Vec<PairOutcome>,
    /// What has to be said beside the numbers.
    pub findings: Vec<FindingOutcome>,
}

/// A group with the letters that say from which it differs.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct LetteredGroup {
    /// What its values look like.
    #[serde(flatten)]
    pub group: GroupSummary,
    /// Groups that share a letter do not differ.
    pub letters: String,
}

/// A statistic and its probability.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct StatisticTest {
    /// The statistic.
    pub statistic: f64,
    /// Degrees of freedom, where it has any.
    pub df: Option<f64>,
    /// Its probability.
    pub p: f64,
}

/// Two groups.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct PairOutcome {
    /// The first group.
    pub first: String,
    /// The second.
    pub second: String,
    /// Mean of the second less mean of the first.
    pub difference: f64,
    /// Its standard error.
    pub se: f64,
    /// Student's t, or the studentised range for more than two groups.
    pub statistic: f64,
    /// Degrees of freedom.
    pub df: f64,
    /// Probability, adjusted for all pairs.
    pub p: f64,
    /// Lower end of the interval.
    pub low: f64,
    /// Upper end.
    pub high: f64,
    /// Hedges' g: the difference in standard deviations.
    #[schema(value_type = Option<f64>)]
    pub hedges_g: f64,
    /// Pairs behind a paired comparison.
    pub n_pairs: Option<usize>,
}
