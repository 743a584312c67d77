//! One-way analysis of variance: the classic one, and Welch's for unequal variances.

use crate::accurate_sum::{mean, squares_about, sum, variance};
use crate::sample::check_groups;
use crate::sample_error::SampleError;
use windfall_distribution::tail::f_upper;
use windfall_numerics::double_double::DoubleDouble;

/// One-way analysis of variance.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, utoipa::ToSchema)]
pub struct OneWayAnova {
    /// Sum of squares between groups; squared unit of the values.
    pub between_ss: f64,
    /// Degrees of freedom between groups.
    pub between_df: f64,
    /// Sum of squares within groups; squared unit of the values.
    pub within_ss: f64,
    /// Degrees of freedom within groups.
    pub within_df: f64,
    /// Ratio of the mean squares.
    pub f: f64,
    /// P(F ≥ f) if all groups had one mean.
    pub p: f64,
    /// Share of the total sum of squares between groups, η² = R².
    pub eta_squared: f64,
    /// The same without its bias, ω²; below zero where groups explain nothing.
    pub omega_squared: f64,
    /// Standard deviation within groups; unit of the values.
    pub residual_sd: f64,
}

/// A ratio of variances and its probability.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, utoipa::ToSchema)]
pub struct FTest {
    /// The ratio.
    pub f: f64,
    /// Degrees of freedom above.
    pub df1: f64,
    /// Degrees of freedom below.
    pub df2: f64,
    /// P(F ≥ f).
    pub p: f64,
}

/// One-way analysis of variance of groups.
///
/// # Errors
/// Fewer than two groups, an empty group, missing values, no group with two
/// values, or no spread within groups.
///
/// # Numerics
/// Sums in twice the precision of `f64` ([`crate::accurate_sum`]).
pub fn one_way_anova<G: AsRef<[f64]>>(groups: &[G]) -> Result<OneWayAnova, SampleError> {
    check_groups(groups, 1)?;
    let count: usize = groups.iter().map(|group| group.as_ref().len()).sum();
    let within_df = (count - groups.len()) as f64;
    let between_df = (groups.len() - 1) as f64;
    if within_df == 0.0 {
        return Err(SampleError::too_few(
            "groups of one value each",
            count,
            count + 1,
        ));
    }
    let grand = groups.iter().fold(DoubleDouble::default(), |all, group| {
        all + sum(group.as_ref())
    }) / DoubleDouble::from(count as f64);
    let mut between = DoubleDouble::default();
    let mut within = DoubleDouble::default();
    for values in groups.iter().map(AsRef::as_ref) {
        let centre = mean(values);
        let apart = centre - grand;
        between += apart * apart * (values.len() as f64).into();
        within += squares_about(values, centre);
    }
    let (between, within) = (between.value(), within.value());
    if within <= 0.0 {
        return Err(SampleError::NoSpread(
            "the values within each group".to_owned(),
        ));
    }
    let noise = within / within_df;
    let f = between / between_df / noise;
    Ok(OneWayAnova {
        between_ss: between,
        between_df,
        within_ss: within,
        within_df,
        f,
        p: f_upper(f, between_df, within_df),
        eta_squared: between / (between + within),
        omega_squared: (between - between_df * noise) / (between + within + noise),
        residual_sd: noise.sqrt(),
    })
}

/// Welch's analysis of variance: equal means where variances differ.
///
/// # Errors
/// Fewer than two groups, a group of fewer than two values or without spread,
/// missing values.
///
/// # Source
/// Welch (1951), On the comparison of several mean values: an alternative
/// approach, Biometrika 38.
pub fn welch_anova<G: AsRef<[f64]>>(groups: &[G]) -> Result<FTest, SampleError> {
    check_groups(groups, 2)?;
    let mut weights = Vec::with_capacity(groups.len());
    for (place, values) in groups.iter().map(AsRef::as_ref).enumerate() {
        let variance = variance(values);
        if variance <= 0.0 {
            return Err(SampleError::NoSpread(format!("group {}", place + 1)));
        }
        weights.push(values.len() as f64 / variance);
    }
    let means: Vec<f64> = groups.iter().map(|g| mean(g.as_ref()).value()).collect();
    let total: f64 = weights.iter().sum();
    let weighted: f64 = weights.iter().zip(&means).map(|(w, m)| w * m).sum();
    let centre = weighted / total;
    let between: f64 = weights
        .iter()
        .zip(&means)
        .map(|(w, m)| w * (m - centre) * (m - centre))
        .sum();
    let unevenness: f64 = groups
        .iter()
        .zip(&weights)
        .map(|(g, w)| (1.0 - w / total).powi(2) / (g.as_ref().len() as f64 - 1.0))
        .sum();
    let k = groups.len() as f64;
    let lambda = unevenness / (k * k - 1.0);
    let df1 = k - 1.0;
    let df2 = 1.0 / (3.0 * lambda);
    let f = between / df1 / (1.0 + 2.0 * (k - 2.0) * lambda);
    Ok(FTest {
        f,
        df1,
        df2,
        p: f_upper(f, df1, df2),
    })
}
