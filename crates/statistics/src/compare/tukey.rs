//! All pairs of groups at one level: Tukey's, and Games and Howell's for unequal variances.

use crate::accurate_sum::{mean, variance};
use crate::compare::one_way_anova::one_way_anova;
use crate::sample::{check_groups, check_probability};
use crate::sample_error::SampleError;
use std::f64::consts::SQRT_2;
use windfall_distribution::studentized_range::{
    studentized_range_upper, studentized_range_upper_quantile,
};

/// Two groups of several.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PairDifference {
    /// Place of the first group, from 0.
    pub first: usize,
    /// Place of the second, which comes later.
    pub second: usize,
    /// Mean of the second less mean of the first; unit of the values.
    pub difference: f64,
    /// Standard error of the difference.
    pub standard_error: f64,
    /// Degrees of freedom.
    pub df: f64,
    /// Studentised range |difference| / (standard error / √2).
    pub q: f64,
    /// P(Q ≥ q): adjusted for all pairs.
    pub p: f64,
    /// Lower end of the simultaneous interval.
    pub low: f64,
    /// Upper end.
    pub high: f64,
}

/// Tukey's comparison of all pairs; Kramer's for groups of unequal size.
///
/// # Errors
/// Fewer than two groups, an empty group, missing values, no spread within
/// groups, or a confidence outside (0, 1).
///
/// # Source
/// Kramer (1956), Extension of multiple range tests to group means with unequal
/// numbers of replications, Biometrics 12. Its intervals are conservative for
/// unequal sizes (Hayter 1984).
pub fn tukey_kramer<G: AsRef<[f64]>>(
    groups: &[G],
    confidence: f64,
) -> Result<Vec<PairDifference>, SampleError> {
    check_probability("the confidence", confidence)?;
    let anova = one_way_anova(groups)?;
    let noise = anova.within_ss / anova.within_df;
    let critical =
        studentized_range_upper_quantile(1.0 - confidence, groups.len(), anova.within_df);
    let size = |place: usize| groups[place].as_ref().len() as f64;
    let error = |a: usize, b: usize| Scale {
        standard_error: (noise * (1.0 / size(a) + 1.0 / size(b))).sqrt(),
        df: anova.within_df,
        critical,
    };
    Ok(all_pairs(groups, error))
}

/// Games and Howell's comparison of all pairs, each with its own variances and freedom.
///
/// # Errors
/// Fewer than two groups, a group of fewer than two values, missing values, two
/// groups without spread, or a confidence outside (0, 1).
///
/// # Source
/// Games and Howell (1976), Pairwise multiple comparison procedures with unequal
/// n's and/or variances, J. Educ. Stat. 1.
pub fn games_howell<G: AsRef<[f64]>>(
    groups: &[G],
    confidence: f64,
) -> Result<Vec<PairDifference>, SampleError> {
    check_groups(groups, 2)?;
    check_probability("the confidence", confidence)?;
    let parts: Vec<(f64, f64)> = groups
        .iter()
        .map(AsRef::as_ref)
        .map(|values| (variance(values) / values.len() as f64, values.len() as f64))
        .collect();
    if parts.iter().filter(|part| part.0 <= 0.0).count() > 1 {
        return Err(SampleError::NoSpread(
            "two or more of the groups".to_owned(),
        ));
    }
    let error = |first: usize, second: usize| {
        let ((a, n), (b, m)) = (parts[first], parts[second]);
        let df = (a + b) * (a + b) / (a * a / (n - 1.0) + b * b / (m - 1.0));
        Scale {
            standard_error: (a + b).sqrt(),
            df,
            critical: studentized_range_upper_quantile(1.0 - confidence, groups.len(), df),
        }
    };
    Ok(all_pairs(groups, error))
}

struct Scale {
    standard_error: f64,
    df: f64,
    critical: f64,
}

fn all_pairs<G: AsRef<[f64]>>(
    groups: &[G],
    scale_of: impl Fn(usize, usize) -> Scale,
) -> Vec<PairDifference> {
    let mut pairs = Vec::new();
    for first in 0..groups.len() {
        for second in first + 1..groups.len() {
            let means = [second, first].map(|place| mean(groups[place].as_ref()));
            let difference = (means[0] - means[1]).value();
            let scale = scale_of(first, second);
            let q = difference.abs() / scale.standard_error * SQRT_2;
            let reach = scale.critical * scale.standard_error / SQRT_2;
            pairs.push(PairDifference {
                first,
                second,
                difference,
                standard_error: scale.standard_error,
                df: scale.df,
                q,
                p: studentized_range_upper(q, groups.len(), scale.df),
                low: difference - reach,
                high: difference + reach,
            });
        }
    }
    pairs
}
