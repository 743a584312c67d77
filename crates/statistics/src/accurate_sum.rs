//! Sums in twice the precision of `f64`.
//!
//! Values that share many leading digits lose them in plain arithmetic: here sums are
//! pairs of numbers, and such values are read as the decimals they were written as.

use rayon::prelude::*;
use windfall_numerics::as_written::as_written;
use windfall_numerics::double_double::DoubleDouble;

/// Sum of values.
pub fn sum(values: &[f64]) -> DoubleDouble {
    match share_digits(values) {
        true => total(values, as_written),
        false => total(values, DoubleDouble::from),
    }
}

/// Values that are added one after the other; longer samples are added in parts of as many.
const PART: usize = 1 << 16;

/// Sums that are made side by side within a part, so that none waits for another.
const LANES: usize = 4;

/// Sum of a term of each value, the same on any number of threads.
fn total(values: &[f64], term: impl Fn(f64) -> DoubleDouble + Sync) -> DoubleDouble {
    if values.len() <= PART {
        let zero = DoubleDouble::ZERO;
        return values.iter().fold(zero, |sum, value| sum + term(*value));
    }
    let parts = values.par_chunks(PART).map(|part| {
        let mut sums = [DoubleDouble::ZERO; LANES];
        let (fours, rest) = part.as_chunks::<LANES>();
        for four in fours {
            for (sum, value) in sums.iter_mut().zip(four) {
                *sum += term(*value);
            }
        }
        let rest = rest.iter().map(|value| term(*value));
        sums.into_iter().chain(rest).sum()
    });
    parts.collect::<Vec<DoubleDouble>>().into_iter().sum()
}

/// Values whose range is below this part of their size are read as decimals.
const SHARED_DIGITS: f64 = 0.01;

/// Whether values share leading digits, and are read as decimals therefore.
fn share_digits(values: &[f64]) -> bool {
    let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
    let share = |low: f64, high: f64| high - low < SHARED_DIGITS * low.abs().max(high.abs());
    // Once some are far apart, others bring them no nearer.
    let mut parts = values.chunks(1024);
    parts.all(|part| {
        for value in part {
            (low, high) = (low.min(*value), high.max(*value));
        }
        share(low, high) || low > high
    }) && share(low, high)
}

/// Mean of values; NaN where there are none.
pub fn mean(values: &[f64]) -> DoubleDouble {
    sum(values) / DoubleDouble::from(values.len() as f64)
}

/// Sum of squared deviations from a centre, Σ (y - centre)².
pub fn squares_about(values: &[f64], centre: DoubleDouble) -> DoubleDouble {
    let square = |value: DoubleDouble| {
        let deviation = value - centre;
        deviation * deviation
    };
    match share_digits(values) {
        true => total(values, |value| square(as_written(value))),
        false => total(values, |value| square(value.into())),
    }
}

/// Variance with n - 1 below; NaN for fewer than two values.
pub fn variance(values: &[f64]) -> f64 {
    if values.len() < 2 {
        return f64::NAN;
    }
    (squares_about(values, mean(values)) / DoubleDouble::from((values.len() - 1) as f64)).value()
}

/// Standard deviation with n - 1 below; NaN for fewer than two values.
pub fn standard_deviation(values: &[f64]) -> f64 {
    variance(values).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn closed_form_a_small_number_beside_a_large_one() {
        let values = [1e16, 1.0, -1e16, 1.0];
        assert_eq!(sum(&values).value(), 2.0);
        assert_eq!(mean(&values).value(), 0.5);
    }

    /// Parts of a long sample lose no digits.
    #[test]
    fn closed_form_sums_of_many_values() {
        let count = 3 * PART + 2;
        let values: Vec<f64> = (0..count).map(|own| own as f64 * 1e8 + 0.5).collect();
        let half = (count / 2) as f64;
        let expected = half * (count - 1) as f64 * 1e8 + half;
        assert_eq!(sum(&values).value(), expected);
        let near: Vec<f64> = (0..count).map(|own| 1e9 + (own % 2) as f64 * 0.2).collect();
        assert_eq!(mean(&near).value(), 1e9 + 0.1);
        let spread = squares_about(&near, mean(&near)).value();
        assert!((spread - 0.01 * count as f64).abs() < 1e-9, "{spread}");
        assert!(share_digits(&near) && !share_digits(&values));
    }

    #[test]
    fn closed_form_spread_of_values_far_from_zero() {
        // shifted by a power of two, so that the values are exact
        let shift = 2f64.powi(40);
        let values = [shift + 1.0, shift + 2.0, shift + 3.0, shift + 4.0];
        assert_eq!(variance(&values), 5.0 / 3.0);
    }
}
