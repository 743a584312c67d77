//! Sums in twice the precision of `f64`.
//!
//! Values that share many leading digits lose them in plain arithmetic: here sums are
//! pairs of numbers, and such values are read as the decimals they were written as.

use crate::as_written::as_written;
use windfall_numerics::double_double::DoubleDouble;

/// Sum of values.
pub fn sum(values: &[f64]) -> DoubleDouble {
    let read = reading_of(values);
    let zero = DoubleDouble::default();
    values.iter().fold(zero, |sum, value| sum + read(*value))
}

/// Values whose range is below this part of their size are read as decimals.
const SHARED_DIGITS: f64 = 0.01;

/// How values are read: as decimals where they share leading digits.
fn reading_of(values: &[f64]) -> fn(f64) -> DoubleDouble {
    let ends = (f64::INFINITY, f64::NEG_INFINITY);
    let (low, high) = values.iter().fold(ends, |(low, high), value| {
        (low.min(*value), high.max(*value))
    });
    match high - low < SHARED_DIGITS * low.abs().max(high.abs()) {
        true => as_written,
        false => DoubleDouble::from,
    }
}

/// Mean of values; NaN where there are none.
pub fn mean(values: &[f64]) -> DoubleDouble {
    sum(values) / DoubleDouble::from(values.len() as f64)
}

/// Sum of squared deviations from a centre, Σ (y - centre)².
pub fn squares_about(values: &[f64], centre: DoubleDouble) -> DoubleDouble {
    let read = reading_of(values);
    let zero = DoubleDouble::default();
    values.iter().fold(zero, |sum, value| {
        let deviation = read(*value) - centre;
        sum + deviation * deviation
    })
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

    #[test]
    fn closed_form_spread_of_values_far_from_zero() {
        // shifted by a power of two, so that the values are exact
        let shift = 2f64.powi(40);
        let values = [shift + 1.0, shift + 2.0, shift + 3.0, shift + 4.0];
        assert_eq!(variance(&values), 5.0 / 3.0);
    }
}
