//! Plans as JSON shows them.

use serde::Serialize;
use windfall_distribution::tail::normal_upper_quantile;
use windfall_files::found::FindingOutcome;

/// A probability; simulated ones with their error.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct ShareOutcome {
    /// The probability, or the share of the simulated studies.
    pub value: f64,
    /// Its binomial standard error; none where it is exact.
    pub se: Option<f64>,
    /// Lower end of its 95 % interval (Wilson).
    pub low: Option<f64>,
    /// Upper end.
    pub high: Option<f64>,
}

/// An exact probability.
pub(crate) fn exact(value: f64) -> ShareOutcome {
    ShareOutcome {
        value,
        se: None,
        low: None,
        high: None,
    }
}

/// A share of simulated studies with its error; the interval is Wilson's (1927), J. Am. Stat.
/// Assoc. 22, 209, which holds near 0 and 1 too.
pub(crate) fn simulated(found: usize, of: usize) -> ShareOutcome {
    let n = of as f64;
    let value = found as f64 / n;
    let z = normal_upper_quantile(0.025);
    let (square, centre) = (z * z / n, value + 0.5 * z * z / n);
    let half = z * (value * (1.0 - value) / n + 0.25 * square / n).sqrt();
    // at the ends rounding alone would lead beyond 0 and 1
    ShareOutcome {
        value,
        se: Some((value * (1.0 - value) / n).sqrt()),
        low: Some(((centre - half) / (1.0 + square)).max(0.0)),
        high: Some(((centre + half) / (1.0 + square)).min(1.0)),
    }
}

/// Precision of a further result.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct PrecisionOutcome {
    /// What it is.
    pub of: String,
    /// Its value.
    pub value: f64,
    /// Standard error of a simulated value.
    pub se: Option<f64>,
}

/// A study of one size.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct PlanRow {
    /// Fruit, in each group where there are groups.
    pub fruit: usize,
    /// Impacts on each fruit.
    pub impacts: usize,
    /// Fruit in all.
    pub fruit_in_all: usize,
    /// Impacts in all.
    pub impacts_in_all: usize,
    /// Probability of finding the effect.
    pub power: Option<ShareOutcome>,
    /// Half-width of the interval.
    pub half_width: Option<f64>,
    /// Error of a simulated half-width.
    pub half_width_se: Option<f64>,
    /// Degrees of freedom.
    pub df: Option<f64>,
    /// Smallest effect that is found with `detectable_power`.
    pub detectable: Option<f64>,
    /// Cost.
    pub cost: Option<f64>,
    /// Whether it tells what was wanted; none where nothing was.
    pub reached: Option<bool>,
    /// Whether its cost is within the budget; none without one.
    pub within_budget: Option<bool>,
    /// Whether no other that tells what was wanted costs less; without a wanted value, whether
    /// no other within the budget tells more.
    pub best: bool,
    /// Simulated studies.
    pub simulations: Option<usize>,
    /// Simulated studies that could not be evaluated; they count as not having found the effect.
    pub failed: usize,
    /// Why, and how often.
    pub failures: Vec<(String, usize)>,
    /// Simulated studies in which a variance was estimated as zero.
    pub singular: usize,
    /// Further precisions.
    pub also: Vec<PrecisionOutcome>,
}

/// A plan.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct PlanOutcome {
    /// "mean", "difference", "groups", "slope", "model", "population", "critical-energy",
    /// "surface".
    pub question: &'static str,
    /// What is asked, assumed and calculated.
    pub about: Vec<String>,
    /// What `fruit` counts.
    pub counted: &'static str,
    /// What half-widths are of.
    pub half_width_of: &'static str,
    /// Wanted power.
    pub wanted_power: Option<f64>,
    /// Wanted half-width.
    pub wanted_half_width: Option<f64>,
    /// Probability with which the half-width is kept; its mean is meant where there is none.
    pub assurance: Option<f64>,
    /// Level of the intervals.
    pub confidence: f64,
    /// 1 or 2.
    pub sides: u8,
    /// Power of `detectable`.
    pub detectable_power: f64,
    /// What the study may cost.
    pub budget: Option<f64>,
    /// Studies: the smallest for each number of impacts, or those that were asked for.
    pub rows: Vec<PlanRow>,
    /// Studies of more sizes, for a curve.
    pub curve: Vec<PlanRow>,
    /// What a reader must know.
    pub findings: Vec<FindingOutcome>,
}
