//! Contrasts of means: which are compared, and how p allows for their number.

use crate::compare::multiple_comparison::holm;
use crate::model::contrast::PolynomialBasis;
use nalgebra::{DMatrix, DVector};
use std::f64::consts::SQRT_2;
use windfall_distribution::largest_t::LargestT;
use windfall_distribution::studentized_range::{
    studentized_range_upper, studentized_range_upper_quantile,
};
use windfall_distribution::tail::{f_upper, t_two_sided, t_upper_quantile};
use windfall_mixed::coefficient::Estimated;

/// Which means are compared.
#[derive(Clone, Debug, PartialEq)]
pub enum Comparison {
    /// Each with every other.
    Pairs,
    /// Each with one, by its place.
    Control(usize),
    /// Each with the mean of all.
    Mean,
    /// Trends over equally spaced levels: linear, quadratic, …
    Polynomial,
    /// Sums with a name and a weight for each mean.
    Custom(Vec<(String, Vec<f64>)>),
}

/// A contrast of means.
#[derive(Clone, Debug, PartialEq)]
pub struct MeanContrast {
    /// What it says: "Gala - Fuji", "linear".
    pub name: String,
    /// What each mean is multiplied by.
    pub weights: Vec<f64>,
}

/// How p and intervals allow for the number of contrasts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Adjustment {
    /// Studentised range of all means (Tukey 1953; Kramer 1956), for all pairs.
    Tukey,
    /// Multivariate t with the contrasts' own correlation; against a control Dunnett's (1955).
    MultivariateT,
    /// Holm's p, Bonferroni's intervals.
    Holm,
    /// None.
    Single,
}

/// An estimated contrast.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Compared {
    /// The contrast.
    pub difference: Estimated,
    /// Difference over its standard error.
    pub t: f64,
    /// Its probability, adjusted.
    pub p: f64,
    /// Lower end of its interval, adjusted.
    pub low: f64,
    /// Upper end.
    pub high: f64,
}

/// F test that some sums of coefficients are all zero.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct JointTest {
    /// F.
    pub f: f64,
    /// Degrees of freedom of the numerator: the rank of the sums.
    pub df: usize,
    /// Of the denominator.
    pub df_denominator: f64,
    /// Probability of F or more.
    pub p: f64,
}

impl Comparison {
    /// Contrasts of means with these names.
    pub fn contrasts(&self, names: &[String]) -> Vec<MeanContrast> {
        let count = names.len();
        let less = |first: usize, second: usize| MeanContrast {
            name: format!("{} - {}", names[second], names[first]),
            weights: (0..count)
                .map(|own| f64::from(u8::from(own == second)) - f64::from(u8::from(own == first)))
                .collect(),
        };
        match self {
            Self::Pairs => {
                let pairs = (0..count).flat_map(|a| (a + 1..count).map(move |b| (a, b)));
                pairs.map(|(a, b)| less(a, b)).collect()
            }
            Self::Control(control) => {
                let others = (0..count).filter(|own| own != control);
                others.map(|own| less(*control, own)).collect()
            }
            Self::Mean if count < 2 => Vec::new(),
            Self::Mean => {
                let own = |mean: usize| MeanContrast {
                    name: format!("{} - mean of all", names[mean]),
                    weights: (0..count)
                        .map(|own| f64::from(u8::from(own == mean)) - 1.0 / count as f64)
                        .collect(),
                };
                (0..count).map(own).collect()
            }
            Self::Polynomial => polynomials(count),
            Self::Custom(sums) => {
                let own = sums.iter().map(|(name, weights)| MeanContrast {
                    name: name.clone(),
                    weights: weights.clone(),
                });
                own.collect()
            }
        }
    }
}

/// Highest degree of a trend.
const HIGHEST: usize = 5;

/// Orthogonal polynomials over equally spaced levels as the smallest whole numbers (Fisher and
/// Yates 1938, Statistical Tables, table XXIII).
fn polynomials(count: usize) -> Vec<MeanContrast> {
    let places: Vec<f64> = (0..count).map(|own| own as f64).collect();
    let degree = HIGHEST.min(count.saturating_sub(1));
    let values = PolynomialBasis::new(&places, degree).values(&places);
    let names = ["linear", "quadratic", "cubic", "quartic", "quintic"];
    let columns = values.column_iter().zip(names);
    columns
        .map(|(column, name)| {
            let sizes = column.iter().map(|own| own.abs());
            let least = sizes
                .filter(|own| *own > 1e-6)
                .fold(f64::INFINITY, f64::min);
            let own = column / least;
            let whole = |factor: &f64| {
                let scaled = own.iter().map(|own| own * factor);
                scaled.fold(0.0, |worst: f64, own| worst.max((own - own.round()).abs())) < 1e-6
            };
            let factor = (1..=1_000_u32).map(f64::from).find(whole);
            let scaled = own.iter().map(|own| match factor {
                Some(factor) => (own * factor).round(),
                None => *own,
            });
            MeanContrast {
                name: name.to_owned(),
                weights: scaled.collect(),
            }
        })
        .collect()
}

/// Interval of an estimate at a level of confidence.
pub fn interval(own: &Estimated, confidence: f64) -> (f64, f64) {
    let reach = own.se * t_upper_quantile(0.5 * (1.0 - confidence), own.df);
    (own.value - reach, own.value + reach)
}

/// Adjusts estimated contrasts of a family of means for their number.
///
/// * `means`: how many means there are
/// * `covariance`: of the contrasts
pub fn compared(
    contrasts: &[Estimated],
    means: usize,
    covariance: &DMatrix<f64>,
    adjustment: Adjustment,
    confidence: f64,
) -> Vec<Compared> {
    let tail = 1.0 - confidence;
    let largest = match adjustment {
        Adjustment::MultivariateT if contrasts.len() > 1 => LargestT::of_covariance(covariance),
        _ => None,
    };
    // Degrees of freedom are mostly one number, and so are critical values.
    let mut known: Vec<(f64, f64)> = Vec::new();
    let mut critical_of = |df: f64, find: &dyn Fn(f64) -> f64| {
        let found = known.iter().find(|own| own.0 == df);
        found.map(|own| own.1).unwrap_or_else(|| {
            let critical = find(df);
            known.push((df, critical));
            critical
        })
    };
    let one = |own: &Estimated| {
        let t = own.value / own.se;
        let single = t_two_sided(t, own.df);
        let (p, critical) = match (adjustment, &largest) {
            (Adjustment::Tukey, _) if means > 2 => (
                studentized_range_upper(SQRT_2 * t.abs(), means, own.df),
                critical_of(own.df, &|df| {
                    studentized_range_upper_quantile(tail, means, df) / SQRT_2
                }),
            ),
            (Adjustment::MultivariateT, Some(largest)) => (
                largest.upper(t.abs(), own.df),
                critical_of(own.df, &|df| largest.upper_quantile(tail, df)),
            ),
            (Adjustment::Holm, _) => {
                let level = tail / contrasts.len() as f64;
                (single, t_upper_quantile(0.5 * level, own.df))
            }
            _ => (single, t_upper_quantile(0.5 * tail, own.df)),
        };
        Compared {
            difference: *own,
            t,
            p,
            low: own.value - critical * own.se,
            high: own.value + critical * own.se,
        }
    };
    let mut found: Vec<Compared> = contrasts.iter().map(one).collect();
    if adjustment == Adjustment::Holm {
        let single: Vec<f64> = found.iter().map(|own| own.p).collect();
        for (own, p) in found.iter_mut().zip(holm(&single)) {
            own.p = p;
        }
    }
    found
}

/// F test that sums of coefficients are zero; `None` where none of them varies.
///
/// * `covariance`: of the sums
/// * `df`: degrees of freedom of the residuals
pub fn joint_test(sums: &[f64], covariance: DMatrix<f64>, df: f64) -> Option<JointTest> {
    /// Eigenvalues below this share of the largest are zero.
    const RANK: f64 = 1e-10;
    if sums.is_empty() || covariance.iter().any(|own| !own.is_finite()) {
        return None;
    }
    let values = DVector::from_column_slice(sums);
    let eigen = covariance.symmetric_eigen();
    let largest = eigen.eigenvalues.amax();
    let pairs = eigen
        .eigenvalues
        .iter()
        .zip(eigen.eigenvectors.column_iter());
    let parts = pairs.filter(|(value, _)| **value > RANK * largest);
    let squares: Vec<f64> = parts
        .map(|(value, vector)| vector.dot(&values).powi(2) / value)
        .collect();
    let rank = squares.len();
    (rank > 0).then(|| {
        let f = squares.iter().sum::<f64>() / rank as f64;
        JointTest {
            f,
            df: rank,
            df_denominator: df,
            p: f_upper(f, rank as f64, df),
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn weights(comparison: &Comparison, count: usize) -> Vec<Vec<f64>> {
        let names: Vec<String> = (0..count).map(|own| own.to_string()).collect();
        let contrasts = comparison.contrasts(&names).into_iter();
        contrasts.map(|own| own.weights).collect()
    }

    /// Fisher and Yates' table.
    #[test]
    fn reference_polynomials_are_whole() {
        let five = weights(&Comparison::Polynomial, 5);
        assert_eq!(five[0], [-2.0, -1.0, 0.0, 1.0, 2.0]);
        assert_eq!(five[1], [2.0, -1.0, -2.0, -1.0, 2.0]);
        assert_eq!(five[2], [-1.0, 2.0, 0.0, -2.0, 1.0]);
        assert_eq!(five[3], [1.0, -4.0, 6.0, -4.0, 1.0]);
        let six = weights(&Comparison::Polynomial, 6);
        assert_eq!(six[2], [-5.0, 7.0, 4.0, -4.0, -7.0, 5.0]);
        assert_eq!(weights(&Comparison::Polynomial, 2), [[-1.0, 1.0]]);
    }

    #[test]
    fn closed_form_contrasts_sum_to_zero() {
        for comparison in [Comparison::Pairs, Comparison::Control(1), Comparison::Mean] {
            for own in weights(&comparison, 4) {
                assert!(own.iter().sum::<f64>().abs() < 1e-15, "{comparison:?}");
            }
        }
        assert!(weights(&Comparison::Mean, 1).is_empty());
        assert!(weights(&Comparison::Polynomial, 1).is_empty());
    }
}
