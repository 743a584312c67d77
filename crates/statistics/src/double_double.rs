//! Numbers in twice the precision of `f64`.

use std::ops::{Add, Mul, Sub};

/// A number as the unevaluated sum of two.
///
/// # Source
/// Dekker (1971), A floating-point technique for extending the available
/// precision; Knuth, The art of computer programming 2, 4.2.2.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct DoubleDouble {
    /// The number, rounded.
    pub high: f64,
    /// What rounding left over.
    pub low: f64,
}

impl DoubleDouble {
    /// The rounded number.
    #[must_use]
    pub fn rounded(self) -> f64 {
        self.high + self.low
    }

    /// The quotient.
    #[must_use]
    pub fn divided_by(self, divisor: f64) -> Self {
        let high = self.high / divisor;
        let rest = self - product(high, divisor);
        exact_sum(high, rest.rounded() / divisor)
    }
}

impl From<f64> for DoubleDouble {
    fn from(high: f64) -> Self {
        Self { high, low: 0.0 }
    }
}

impl Add for DoubleDouble {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        let high = exact_sum(self.high, other.high);
        let low = exact_sum(self.low, other.low);
        let first = exact_sum(high.high, high.low + low.high);
        exact_sum(first.high, first.low + low.low)
    }
}

impl Sub for DoubleDouble {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        let negative = Self {
            high: -other.high,
            low: -other.low,
        };
        self + negative
    }
}

impl Mul for DoubleDouble {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        let high = product(self.high, other.high);
        let cross = self.high * other.low + self.low * other.high;
        exact_sum(high.high, high.low + cross)
    }
}

/// a + b with its rounding error.
fn exact_sum(a: f64, b: f64) -> DoubleDouble {
    let high = a + b;
    let part = high - a;
    let low = (a - (high - part)) + (b - part);
    DoubleDouble { high, low }
}

/// a × b with its rounding error.
fn product(a: f64, b: f64) -> DoubleDouble {
    let high = a * b;
    DoubleDouble {
        high,
        low: a.mul_add(b, -high),
    }
}

/// The shortest decimal number that reads as this double: "1000000000000.4"
/// where the double is 1000000000000.4000244.
///
/// Instruments and tables write decimal numbers; of values that share many
/// leading digits, reading them as doubles moves the last. Any decimal within
/// half a unit of the last place stands for the double as well as the double
/// itself does, and the shortest is the one that somebody wrote.
#[must_use]
pub fn as_written(value: f64) -> DoubleDouble {
    decimal(value).unwrap_or_else(|| value.into())
}

/// Digits and power of ten → twice the precision; `None` where that is not exact.
fn decimal(value: f64) -> Option<DoubleDouble> {
    let text = format!("{value:e}");
    let (mantissa, exponent) = text.split_once('e')?;
    let (whole, fraction) = mantissa.split_once('.').unwrap_or((mantissa, ""));
    let digits: i64 = format!("{whole}{fraction}").parse().ok()?;
    let power = exponent.parse::<i32>().ok()? - i32::try_from(fraction.len()).ok()?;
    // digits of at most 17 places, in two doubles without rounding
    let high = digits as f64;
    let low = (digits - high as i64) as f64;
    let digits = exact_sum(high, low);
    match power {
        // a whole number is its own double up to 2⁵³
        0..=22 => Some(digits * 10f64.powi(power).into()),
        -22..0 => Some(digits.divided_by(10f64.powi(-power))),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn closed_form_one_third_to_thirty_digits() {
        let third = DoubleDouble::from(1.0).divided_by(3.0);
        let three = DoubleDouble::from(3.0);
        let rest = third * three - DoubleDouble::from(1.0);
        assert!(rest.rounded().abs() < 1e-31, "{rest:?}");
    }

    #[test]
    fn closed_form_decimals_as_they_were_written() {
        // 1000000000000.4 - 1000000000000 - 0.4 is zero in decimals
        let left = as_written(1000000000000.4) - as_written(1000000000000.0) - as_written(0.4);
        assert!(left.rounded().abs() < 1e-19, "{left:?}");
        assert!((1000000000000.4_f64 - 1000000000000.0 - 0.4).abs() > 1e-5);
        for value in [
            0.1,
            -107.8681568,
            1e-300,
            1e300,
            0.0,
            123456789.0,
            1.0 / 3.0,
        ] {
            assert_eq!(as_written(value).high, value);
        }
    }
}
