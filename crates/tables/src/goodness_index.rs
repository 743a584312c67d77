//! How far predictions lie from what was measured.

use windfall_statistics::accurate_sum::{mean, squares_about};
use windfall_statistics::sample::check_pairs;
use windfall_statistics::sample_error::SampleError;

/// What has to be said beside the two χ² of [`GoodnessIndex`].
pub const CHI_SQUARED_CAVEAT: &str = "the chi-square here is an index of distance and not a test: \
     it has no p-value and grows with the unit of the values (from N to mN a thousandfold, reduced \
     a millionfold)";

/// Distances between predicted and measured values.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GoodnessIndex {
    /// Number of values.
    pub n: usize,
    /// Σ (O - P)² / P; unit of the values. `None` with a prediction that is not positive.
    pub chi_squared: Option<f64>,
    /// Σ (O - P)² / (N - p); squared unit of the values. `None` without degrees of freedom.
    pub reduced_chi_squared: Option<f64>,
    /// √(Σ (O - P)² / N); unit of the values.
    pub root_mean_square: f64,
    /// Mean of P - O; unit of the values.
    pub bias: f64,
    /// Mean of |O - P|; unit of the values.
    pub mean_absolute: f64,
    /// Mean of |O - P| / |O|; a fraction. `None` where a measured value is zero.
    pub mean_absolute_relative: Option<f64>,
    /// 1 - Σ (O - P)² / Σ (O - Ō)². `None` where the measured values do not vary.
    pub r_squared: Option<f64>,
    /// Squared correlation of O and P. `None` where either does not vary.
    pub correlation_squared: Option<f64>,
}

/// Distances between measured (O) and predicted (P) values.
///
/// * `parameters`: p, how many parameters were fitted to these values; 0 for
///   predictions of new data
///
/// # Errors
/// Unequal lengths, missing values, or no values.
pub fn goodness_index(
    measured: &[f64],
    predicted: &[f64],
    parameters: usize,
) -> Result<GoodnessIndex, SampleError> {
    check_pairs("measured and predicted", measured, predicted, 1)?;
    let n = measured.len() as f64;
    let pairs = || measured.iter().zip(predicted);
    let misses: Vec<f64> = pairs().map(|(o, p)| p - o).collect();
    let squares = squares_about(&misses, 0.0.into()).value();
    let (centre, middle) = (mean(measured), mean(predicted));
    let total = squares_about(measured, centre).value();
    let spread = squares_about(predicted, middle).value();
    let product: f64 = pairs()
        .map(|(o, p)| (o - centre.value()) * (p - middle.value()))
        .sum();
    let absolute = |(o, p): (&f64, &f64)| (o - p).abs();
    Ok(GoodnessIndex {
        n: measured.len(),
        chi_squared: predicted
            .iter()
            .all(|p| *p > 0.0)
            .then(|| pairs().map(|(o, p)| (o - p) * (o - p) / p).sum()),
        reduced_chi_squared: (measured.len() > parameters)
            .then(|| squares / (measured.len() - parameters) as f64),
        root_mean_square: (squares / n).sqrt(),
        bias: mean(&misses).value(),
        mean_absolute: pairs().map(absolute).sum::<f64>() / n,
        mean_absolute_relative: measured
            .iter()
            .all(|o| *o != 0.0)
            .then(|| pairs().map(|(o, p)| ((o - p) / o).abs()).sum::<f64>() / n),
        r_squared: (total > 0.0).then(|| 1.0 - squares / total),
        correlation_squared: (total > 0.0 && spread > 0.0)
            .then(|| product * product / (total * spread)),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn closed_form_indices() {
        let found = goodness_index(&[1.0, 2.0, 3.0], &[1.0, 2.0, 4.0], 1).unwrap();
        assert_eq!(found.chi_squared, Some(0.25));
        assert_eq!(found.reduced_chi_squared, Some(0.5));
        assert_eq!(found.r_squared, Some(0.5));
        let found = goodness_index(&[2.0, 4.0, 6.0, 8.0], &[3.0, 5.0, 7.0, 9.0], 2).unwrap();
        assert_eq!(found.bias, 1.0);
        assert_eq!(found.root_mean_square, 1.0);
        assert_eq!(found.mean_absolute, 1.0);
        assert_eq!(found.reduced_chi_squared, Some(2.0));
        assert_eq!(found.r_squared, Some(0.8));
        assert_eq!(found.correlation_squared, Some(1.0));
        let relative = found.mean_absolute_relative.unwrap();
        assert!((relative - (0.5 + 0.25 + 1.0 / 6.0 + 0.125) / 4.0).abs() < 1e-15);
        let chi = found.chi_squared.unwrap();
        assert!((chi - (1.0 / 3.0 + 0.2 + 1.0 / 7.0 + 1.0 / 9.0)).abs() < 1e-15);
    }

    /// The caveat's claim: the index grows with the unit.
    #[test]
    fn closed_form_chi_squared_depends_on_the_unit() {
        let newton = goodness_index(&[1.0, 2.0], &[1.5, 2.5], 0).unwrap();
        let milli = goodness_index(&[1e3, 2e3], &[1.5e3, 2.5e3], 0).unwrap();
        let ratio = milli.chi_squared.unwrap() / newton.chi_squared.unwrap();
        assert!((ratio - 1000.0).abs() < 1e-9);
        assert_eq!(milli.r_squared, newton.r_squared);
    }

    #[test]
    fn rejects_what_an_index_cannot_hold() {
        let found = goodness_index(&[0.0, 1.0], &[-1.0, 1.0], 2).unwrap();
        assert_eq!(found.chi_squared, None);
        assert_eq!(found.reduced_chi_squared, None);
        assert_eq!(found.mean_absolute_relative, None);
        assert!(goodness_index(&[1.0], &[], 0).is_err());
    }
}
