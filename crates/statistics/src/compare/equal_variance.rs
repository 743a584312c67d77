//! Whether groups share a variance: Levene, Brown-Forsythe, Bartlett.

use crate::accurate_sum::{mean, variance};
use crate::compare::one_way_anova::{FTest, one_way_anova};
use crate::sample::check_groups;
use crate::sample_error::SampleError;
use windfall_distribution::quantile::median;
use windfall_distribution::tail::chi_squared_upper;

/// A χ² statistic and its probability.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ChiSquaredTest {
    /// The statistic.
    pub statistic: f64,
    /// Degrees of freedom.
    pub df: f64,
    /// P(X ≥ statistic).
    pub p: f64,
}

/// Levene's test: analysis of variance of the distances from the group means.
///
/// # Errors
/// Fewer than two groups, an empty group, missing values, or equal distances.
///
/// # Source
/// Levene (1960), Robust tests for equality of variances.
pub fn levene<G: AsRef<[f64]>>(groups: &[G]) -> Result<FTest, SampleError> {
    of_distances(groups, |values| mean(values).value())
}

/// The Brown-Forsythe test: analysis of variance of the distances from the group
/// medians, which holds its level for skewed values too; errors as in [`levene`].
///
/// # Source
/// Brown and Forsythe (1974), Robust tests for the equality of variances, JASA 69.
pub fn brown_forsythe<G: AsRef<[f64]>>(groups: &[G]) -> Result<FTest, SampleError> {
    of_distances(groups, median)
}

fn of_distances<G: AsRef<[f64]>>(
    groups: &[G],
    centre_of: impl Fn(&[f64]) -> f64,
) -> Result<FTest, SampleError> {
    check_groups(groups, 1)?;
    let distances: Vec<Vec<f64>> = groups
        .iter()
        .map(|group| {
            let centre = centre_of(group.as_ref());
            group.as_ref().iter().map(|y| (y - centre).abs()).collect()
        })
        .collect();
    let found = one_way_anova(&distances).map_err(|error| match error {
        SampleError::NoSpread(_) => SampleError::NoSpread(
            "the distances of the values from the centres of their groups".to_owned(),
        ),
        other => other,
    })?;
    Ok(FTest {
        f: found.f,
        df1: found.between_df,
        df2: found.within_df,
        p: found.p,
    })
}

/// Bartlett's test, the sharpest for normal values and misleading for others.
///
/// # Errors
/// Fewer than two groups, a group of fewer than two values or without spread,
/// missing values.
///
/// # Source
/// Bartlett (1937), Properties of sufficiency and statistical tests,
/// Proc. R. Soc. A 160.
pub fn bartlett<G: AsRef<[f64]>>(groups: &[G]) -> Result<ChiSquaredTest, SampleError> {
    check_groups(groups, 2)?;
    let mut pooled = 0.0;
    let mut logarithms = 0.0;
    let mut inverses = 0.0;
    let mut total_df = 0.0;
    for (place, values) in groups.iter().map(AsRef::as_ref).enumerate() {
        let df = values.len() as f64 - 1.0;
        let variance = variance(values);
        if variance <= 0.0 {
            return Err(SampleError::NoSpread(format!("group {}", place + 1)));
        }
        pooled += df * variance;
        logarithms += df * variance.ln();
        inverses += 1.0 / df;
        total_df += df;
    }
    let df = groups.len() as f64 - 1.0;
    let correction = 1.0 + (inverses - 1.0 / total_df) / (3.0 * df);
    let statistic = (total_df * (pooled / total_df).ln() - logarithms) / correction;
    Ok(ChiSquaredTest {
        statistic,
        df,
        p: chi_squared_upper(statistic, df),
    })
}
